#!/usr/bin/env bash
# Installs the packages of Debian 12 that the build needs and that are missing. Does nothing when all are there.
# --python: also what HWSIM_PYTHON and its tests need.
# --checks: also what the gate's checks need: that, clang, its sanitizers, clang-format.
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache git ca-certificates
  libglm-dev libtinygltf-dev libopenimageio-dev libembree-dev libtbb-dev libhwy-dev
  libceres-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev libfmt-dev libsqlite3-dev
  libbenchmark-dev libgtest-dev
  help2man pkg-config # manual pages; the test of hwsim.pc
  libegl-dev libgl-dev libopengl-dev libegl-mesa0 libgl1-mesa-dri # llvmpipe: the rasterizer's oracle
)
python=(
  pybind11-dev python3-dev python3-numpy            # the package
  python3-pandas python3-tqdm                       # what it imports when it is asked to
  python3-pytest mypy python3-nbclient python3-nbformat python3-ipykernel # its tests
)
case "${1:-}" in
--python) packages+=("${python[@]}") ;;
--checks) packages+=(clang libclang-rt-14-dev clang-format "${python[@]}") ;;
esac

installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

missing=()
for package in "${packages[@]}"; do
  installed "$package" || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  exit 0
fi

echo "setup: installing ${missing[*]}" >&2
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "setup: neither root nor sudo; please install: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q >&2
"${as_root[@]}" apt-get install -y -q --no-install-recommends "${missing[@]}" >&2
