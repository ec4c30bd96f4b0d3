#!/bin/sh
# Builds the consumer by what hwsim.pc says, and runs it: pkg_config.sh PREFIX SOURCE OUT COMPILER
set -eu
PKG_CONFIG_PATH=$(dirname "$(find "$1" -name hwsim.pc)")
export PKG_CONFIG_PATH
[ "$(pkg-config --modversion hwsim)" = "$(sed -n 's/^Version: //p' "$PKG_CONFIG_PATH/hwsim.pc")" ]
mkdir -p "$3"
# shellcheck disable=SC2046
"$4" "$2/consumer.cpp" -o "$3/consumer" $(pkg-config --cflags --libs hwsim)
"$3/consumer" "$2/triangle.gltf"
