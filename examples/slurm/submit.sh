#!/usr/bin/env bash
# submit.sh [TASKS]: plans the sweep of ./sweep.sh, then hands emulations, points and the merge to Slurm, each after the
# one before it. More options of sbatch stand in SBATCH_OPTIONS: SBATCH_OPTIONS="--partition=short --time=30" ./submit.sh 8
set -euo pipefail
cd "$(dirname "$0")"
tasks=${1:-8}
source ./sweep.sh
read -r -a options <<<"${SBATCH_OPTIONS:-}"
hwsim sweep "${SWEEP[@]}" --plan plan.json --force --shard "1/$tasks"
submit() { sbatch --parsable --output=%x-%a.log "${options[@]}" "$@"; }
emulate=$(submit --array="1-$tasks" emulate.sbatch)
points=$(submit --array="1-$tasks" --dependency="afterok:$emulate" points.sbatch)
merge=$(submit --dependency="afterok:$points" merge.sbatch)
echo "submitted: emulations $emulate, points $points, merge $merge (hwsim-merge-*.log has the answer)"
