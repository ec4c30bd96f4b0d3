#!/usr/bin/env bash
# Installs the packages of Debian 12 that the build needs and that are missing. Does nothing when all are there.
# --checks: also what the gate's checks need (clang, its sanitizers, clang-format).
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache git ca-certificates
  libglm-dev libtinygltf-dev libopenimageio-dev libembree-dev libtbb-dev libhwy-dev
  libceres-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev libfmt-dev libsqlite3-dev
  libbenchmark-dev libgtest-dev
  libegl-dev libgl-dev libopengl-dev libegl-mesa0 libgl1-mesa-dri # llvmpipe: the rasterizer's oracle
)
[ "${1:-}" = --checks ] && packages+=(clang libclang-rt-14-dev clang-format)

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
