# What the sweep is: every job reads this file, so that all of them plan the same points. Change it here alone.
SWEEP=(
  -t none,msaa4x,fxaa,smaa
  --vary scene=car_body,grass,metal,wires
  --vary "gpu.dram_bandwidth_gb_s=x0.5,x0.75,x1,x2,x4"
  --vary "gpu.l2_size_kib=512..8192:5:log"
  --vary "gpu.core_clock_mhz=800..2000:5"
)
export HWSIM_CACHE=${HWSIM_CACHE:-$PWD/cache} # on a file system that every node sees
export HWSIM_JOBS=${SLURM_CPUS_PER_TASK:-1}

# A task whose program was killed (too little memory, a node that is needed elsewhere) comes again, three times.
or_again() {
  local status=0
  "$@" || status=$?
  if [ "$status" -gt 128 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt 3 ]; then
    scontrol requeue "$SLURM_JOB_ID"
    sleep 60 # Slurm ends this task meanwhile
  fi
  return "$status"
}
