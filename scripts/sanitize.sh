#!/usr/bin/env bash
# Builds with a sanitizer (clang) and runs tests under it: scripts/sanitize.sh asan-ubsan|tsan [all]
# Without `all`: the subset that CI runs, a few minutes. HWSIM_BUILD_JOBS and HWSIM_TEST_JOBS set how many run at a time.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:?asan-ubsan or tsan}
jobs=${HWSIM_BUILD_JOBS:-$(nproc)}
export UBSAN_OPTIONS=print_stacktrace=1

scripts/setup.sh --checks
cmake --preset "$preset"
if [ "${2:-}" = all ]; then
  cmake --build --preset "$preset" --parallel "$jobs"
  exec ctest --preset "$preset" --parallel "${HWSIM_TEST_JOBS:-$(nproc)}"
fi
