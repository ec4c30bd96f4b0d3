#!/usr/bin/env bash
# Fuzzes: scripts/fuzz.sh MINUTES [TARGET...], or SECONDSs ("10s"), each target that long. Prints a table: executions,
# edges covered, features, crashes. What libFuzzer finds new is kept in $HWSIM_FUZZ_CORPORA (~/.cache/hwsim-fuzz), and runs
# of a minute or more leave it minimized. Inputs that crash go to the folder `crashes` there, and make the exit status 1.
# HWSIM_FUZZ_BIN names the folder of the programs; without it the preset asan-ubsan is built.
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  echo "usage: scripts/fuzz.sh MINUTES|SECONDSs [TARGET...]" >&2
  exit 2
}
case ${1:-} in
*[!0-9s]* | "" | s) usage ;;
*s) seconds=${1%s} ;;
*) seconds=$(($1 * 60)) ;;
esac
shift
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  for source in tests/fuzz/*.cpp; do targets+=("$(basename "$source" .cpp)"); done
fi

bin=${HWSIM_FUZZ_BIN:-}
if [ -z "$bin" ]; then
  bin=build/asan-ubsan/bin
  cmake --preset asan-ubsan
  cmake --build --preset asan-ubsan --parallel "${HWSIM_BUILD_JOBS:-$(nproc)}" --target "${targets[@]/#/fuzz_}"
fi
corpora=${HWSIM_FUZZ_CORPORA:-${XDG_CACHE_HOME:-$HOME/.cache}/hwsim-fuzz}
[ -w /dev/shm ] && export TMPDIR=/dev/shm # targets write their inputs to files
# Tracking of thread-local memory breaks clang 14's leak check.
export ASAN_OPTIONS=intercept_tls_get_addr=0 UBSAN_OPTIONS=print_stacktrace=1
limits=(-timeout=20 -rss_limit_mb=3072 -malloc_limit_mb=2048 -max_len=16384)

# Files of the product that are good beginnings, beside those of tests/fuzz/seeds.
seeds_of() {
  echo "tests/fuzz/seeds/$1"
  case $1 in
  gpu_toml) echo configs/gpus ;;
  overlay_toml) echo configs/overlays ;;
  published_tables) echo configs/published ;;
  esac
}

minimize() {
  local corpus=$1 seeds=("${@:3}") smaller
  smaller=$(mktemp -d "$corpus.XXXXXX")
  if "$bin/fuzz_$2" -merge=1 "${limits[@]}" "$smaller" "$corpus" "${seeds[@]}" >"$corpus.merge.log" 2>&1; then
    rm -rf "$corpus"
    mv "$smaller" "$corpus"
  else
    rm -rf "$smaller"
    return 1
  fi
}

failed=0
printf '%-18s %12s %8s %10s %8s\n' target executions edges features crashes
for target in "${targets[@]}"; do
  mapfile -t seeds < <(seeds_of "$target")
  corpus=$corpora/$target log=$corpora/$target.log crashes=0
  mkdir -p "$corpus" "$corpora/crashes"
  "$bin/fuzz_$target" "${limits[@]}" -max_total_time="$seconds" -print_final_stats=1 \
    -artifact_prefix="$corpora/crashes/$target-" "$corpus" "${seeds[@]}" >"$log" 2>&1 || crashes=1
  if [ "$seconds" -ge 60 ] && [ "$crashes" -eq 0 ]; then
    minimize "$corpus" "$target" "${seeds[@]}" || crashes=1
  fi
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -1)
  edges=$(sed -n 's/^#.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -1)
  features=$(sed -n 's/^#.* ft: \([0-9]*\) .*/\1/p' "$log" | tail -1)
  printf '%-18s %12s %8s %10s %8s\n' "$target" "${executions:-?}" "${edges:-?}" "${features:-?}" "$crashes"
  if [ "$crashes" -ne 0 ]; then
    failed=1
    tail -40 "$log" >&2
  fi
done
exit "$failed"
