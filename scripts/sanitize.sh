#!/usr/bin/env bash
# Builds with a sanitizer (clang) and runs tests under it: scripts/sanitize.sh asan-ubsan|tsan [all]
# Without `all`, a subset that takes minutes: asan-ubsan reads damaged files of every kind, draws small frames, and fuzzes
# each kind of input for ten seconds; tsan runs nine techniques on several threads. HWSIM_BUILD_JOBS and HWSIM_TEST_JOBS set
# how many jobs run at a time.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-}
case $preset in
asan-ubsan)
  programs=(hwsim_tests pipeline_tests cost_models_tests)
  targets=(hwsim_fuzzers)
  filter='-Accuracy.*:/Accuracy.*:*Tiles*:SceneCounts*:*Conformance*:Compare*:*GroundTruth*:Reference*'
  ;;
tsan)
  programs=(algos_tests)
  targets=()
  filter='*ThreadsChangeNothing*'
  ;;
*)
  echo "usage: scripts/sanitize.sh asan-ubsan|tsan [all]" >&2
  exit 2
  ;;
esac

scripts/setup.sh --checks
jobs=${HWSIM_BUILD_JOBS:-$(nproc)}
export UBSAN_OPTIONS=print_stacktrace=1
# The leak check of clang 14 walks tables of thread-local memory that threads which have ended may have left half freed, and
# crashes now and then ("Tracer caught signal 11", mended by https://reviews.llvm.org/D147459). It does not without the tables.
export ASAN_OPTIONS=intercept_tls_get_addr=0
export TSAN_OPTIONS=suppressions=$PWD/tests/support/tsan.supp
cmake --preset "$preset"
if [ "${2:-}" = all ]; then
  cmake --build --preset "$preset" --parallel "$jobs"
  exec ctest --preset "$preset" --parallel "${HWSIM_TEST_JOBS:-$jobs}"
fi
cmake --build --preset "$preset" --parallel "$jobs" --target "${programs[@]}" "${targets[@]}"
run_shards() { # PROGRAM: its tests in as many processes as jobs; fails when one of them does
  local processes=() failed=0
  for ((i = 0; i < jobs; ++i)); do
    GTEST_TOTAL_SHARDS=$jobs GTEST_SHARD_INDEX=$i "build/$preset/bin/$1" --gtest_brief=1 --gtest_filter="$filter" &
    processes+=($!)
  done
  for process in "${processes[@]}"; do wait "$process" || failed=1; done
  return $failed
}
for program in "${programs[@]}"; do run_shards "$program"; done
if [ ${#targets[@]} -gt 0 ]; then
  ctest --preset "$preset" --tests-regex '^Fuzz\.' --parallel 2
fi
