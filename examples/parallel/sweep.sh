#!/usr/bin/env bash
# The sweep of ../slurm/sweep.sh by GNU parallel, on this machine or with --sshlogin on several that share this folder:
#   ./sweep.sh 4                                   # four tasks at a time here
#   PARALLEL="--sshlogin node1,node2 --workdir ." ./sweep.sh 8
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/../slurm/sweep.sh"
tasks=${1:-4}
shards=$(seq 1 "$tasks")
words=$(printf '%q ' "${SWEEP[@]}")
export HWSIM_JOBS=1
run() { # what comes behind the sweep's words; {} is the shard
  parallel --halt soon,fail=1 --retries 3 --jobs "$tasks" --env HWSIM_CACHE --env HWSIM_JOBS \
    "hwsim sweep $words $1" ::: $shards
}
run "--emulate-only --shard {}/$tasks"
run "--shard {}/$tasks --db part{}.sqlite --resume --alone -q --format csv=/dev/null"
hwsim sweep --db sweep.sqlite --merge 'part*.sqlite'
