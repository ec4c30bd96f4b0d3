#!/bin/sh
# Writes docs/conformance.md: what emulation and reference show of the conformance scenes.
#
# scripts/conformance.sh [BUILD]        BUILD: build/dev, with the target algos_tests built
set -eu
cd "$(dirname "$0")/.."
HWSIM_WRITE_CONFORMANCE=1 "${1:-build/dev}/bin/algos_tests" --gtest_filter='Conformance.*'
git --no-pager diff --stat -- docs/conformance.md
