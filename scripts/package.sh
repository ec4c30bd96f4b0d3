#!/usr/bin/env bash
# Makes Debian packages in build/package: hwsim (the program and the Python package) and hwsim-dev (the library), and tries the
# first one, unpacked into a folder: hwsim doctor, and the same from Python.
# HWSIM_BUILD_DIR: a build folder that is there already, to be packed as it is.
set -euo pipefail
cd "$(dirname "$0")/.."

build=${HWSIM_BUILD_DIR:-build/package}
if [ -z "${HWSIM_BUILD_DIR:-}" ]; then
  scripts/setup.sh --python
  cmake --preset package
  cmake --build --preset package --parallel "${HWSIM_BUILD_JOBS:-$(nproc)}"
fi
(cd "$build" && cpack -G DEB -B packages >/dev/null)

root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
for package in "$build"/packages/hwsim_*.deb; do dpkg-deb -x "$package" "$root"; done
elsewhere=(env -i HOME="$root" PATH=/usr/bin:/bin)
(cd "$root" && "${elsewhere[@]}" "$root/usr/bin/hwsim" doctor)
python=$(find "$root/usr" -type d -path '*-packages/hwsim' -printf '%h\n')
if [ -n "$python" ]; then
  (cd "$root" && "${elsewhere[@]}" PYTHONPATH="$python" /usr/bin/python3 -c '
import hwsim
checks = hwsim.doctor()
print(checks)
assert all(check["ok"] for check in checks)')
fi
ls -l "$build"/packages/*.deb
