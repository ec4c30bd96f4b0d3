#!/usr/bin/env bash
# Emulates every published run and writes what the accuracy test reads (tests/data/published.traces and
# fold_optima.csv). With --scenes=FOLDER, which holds sponza.glb, also what `hwsim validate --external` reads
# (configs/external/work.traces). To be run when a change of the emulator or of the model is meant to change work or times.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release >/dev/null
cmake --build --preset release --target keep_traces
build/release/bin/keep_traces tests/data "$@"
