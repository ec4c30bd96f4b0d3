#!/usr/bin/env bash
# Shows that g++ and clang, at -O1 and -O3, emulate every technique to the same bits: image, counters, reuse of blocks.
# scripts/compilers.sh [BUILD]: builds algos_tests four times below BUILD (build/compilers) and compares what each found.
# HWSIM_BUILD_JOBS sets how many jobs run at a time.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh --checks
root=${1:-build/compilers}
mkdir -p "$root"
signatures=$(realpath "$root")/signatures.txt
rm -f "$signatures"
for compiler in g++ clang++; do
  for level in 1 3; do
    build=$root/$compiler-O$level
    cmake -S . -B "$build" -G Ninja -D CMAKE_CXX_COMPILER="$compiler" -D CMAKE_BUILD_TYPE=Release -D HWSIM_SIMD=native \
      -D CMAKE_CXX_FLAGS_RELEASE="-O$level -DNDEBUG" -D HWSIM_BUILD_BENCHMARKS=OFF -D HWSIM_INSTALL=OFF >/dev/null
    cmake --build "$build" --parallel "${HWSIM_BUILD_JOBS:-$(nproc)}" --target algos_tests
    HWSIM_SIGNATURE_FILE=$signatures "$build/bin/algos_tests" --gtest_brief=1 --gtest_filter='*ThreadsChangeNothing*'
    echo "compilers: $compiler -O$level gives what those before it gave ($(wc -l <"$signatures") numbers)"
  done
done
