#!/usr/bin/env bash
# On a fresh Debian 12: installs what is missing, builds, and compares five techniques on a scene that ships with hwsim.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh --report
cmake --preset release >/dev/null
cmake --build --preset release --target hwsim_cli hwsim_image_io hwsim_page

out=runs/demo
build/release/bin/hwsim run sponza_hall \
  --technique none,msaa4x,msaa8x,ssaa16x,deferred_simple_complex \
  --gpu gtx980 --reference 64 --out "$out" --force \
  --report "$out.html"
echo
echo "images, pass tables and traces, a folder for each technique:"
ls -d "$out"/*/
echo "first to look at: $out/msaa4x@gtx980/color.png, reference.png and flip.png beside it"
echo "all of it as one page, with hardware that can be moved: $out.html"
