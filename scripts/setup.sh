#!/usr/bin/env bash
# Installs the packages of Debian 12 that the build needs and that are missing. Does nothing when all are there.
# --python: also what HWSIM_PYTHON and its tests need.
# --report: also what the page of `hwsim report` is built of: clang for WebAssembly; Node, and the packages that
# page/package-lock.json pins.
# --plots: also what scripts/plots.py draws the plots of the documents with.
# --checks: also what the gate's checks need: Python's, clang, its sanitizers, clang-format, a browser without a screen.
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache git ca-certificates
  libglm-dev libtinygltf-dev libopenimageio-dev libembree-dev libtbb-dev libhwy-dev
  libceres-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev libfmt-dev libsqlite3-dev libnlopt-dev
  libbenchmark-dev libgtest-dev libturbojpeg0-dev zlib1g-dev
  help2man pkg-config # manual pages; the test of hwsim.pc
  libegl-dev libgl-dev libopengl-dev libegl-mesa0 libgl1-mesa-dri # llvmpipe: the rasterizer's oracle
)
python=(
  pybind11-dev python3-dev python3-numpy            # the package
  python3-pandas python3-tqdm                       # what it imports when it is asked to
  python3-pytest mypy python3-nbclient python3-nbformat python3-ipykernel # its tests
)
report=false
for option in "$@"; do
  case $option in
    --python) packages+=("${python[@]}") ;;
    --checks) packages+=(clang libclang-rt-14-dev clang-format chromium fonts-dejavu-core "${python[@]}") ;;
    --plots) packages+=(python3-matplotlib) ;;
    --report)
      report=true
      packages+=(clang-14 lld-14 wasi-libc libc++-14-dev-wasm32 libclang-rt-14-dev-wasm32)
      command -v node >/dev/null || packages+=(nodejs)
      command -v npm >/dev/null || packages+=(npm)
      ;;
    *)
      echo "setup: unknown option $option" >&2
      exit 2
      ;;
  esac
done

installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

missing=()
for package in "${packages[@]}"; do
  installed "$package" || missing+=("$package")
done
# What the lock file says, unless it is there already.
page_packages() {
  local page lock
  page=$(cd "$(dirname "$0")/../page" && pwd)
  lock=$page/node_modules/.package-lock.json
  if ! $report || { [ -e "$lock" ] && [ ! "$page/package-lock.json" -nt "$lock" ]; }; then return 0; fi
  echo "setup: fetching the packages of page/package-lock.json" >&2
  (cd "$page" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error >&2)
}

if [ ${#missing[@]} -eq 0 ]; then
  page_packages
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
page_packages
