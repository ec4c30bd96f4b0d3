#!/usr/bin/env bash
# Installs what is missing, builds everything with warnings as errors, and runs every test: those of the Python package
# too where its packages are there (scripts/setup.sh --python).
# HWSIM_BUILD_JOBS and HWSIM_TEST_JOBS set how many run at a time.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
python=OFF
if [ -d /usr/include/pybind11 ] && /usr/bin/python3 -c 'import numpy, pytest, sysconfig, os
assert os.path.exists(sysconfig.get_path("include") + "/Python.h")' 2>/dev/null; then
  python=ON
fi
cmake --preset ci -D HWSIM_PYTHON=$python -D Python3_EXECUTABLE=/usr/bin/python3
cmake --build --preset ci --parallel "${HWSIM_BUILD_JOBS:-$(nproc)}"
ctest --preset ci --parallel "${HWSIM_TEST_JOBS:-$(nproc)}" "$@"
