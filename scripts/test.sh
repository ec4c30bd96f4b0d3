#!/usr/bin/env bash
# Installs what is missing, builds everything with warnings as errors, and runs every test.
# HWSIM_BUILD_JOBS and HWSIM_TEST_JOBS set how many run at a time.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
cmake --preset ci
cmake --build --preset ci --parallel "${HWSIM_BUILD_JOBS:-$(nproc)}"
ctest --preset ci --parallel "${HWSIM_TEST_JOBS:-$(nproc)}" "$@"
