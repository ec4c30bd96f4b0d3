#!/bin/sh
# Writes docs/reference/ (keys of GPU files, counters, parameters of techniques, sources and codes of messages) and the
# rows of README.md's tables, as the program prints them.
#
# scripts/reference.sh [BUILD]        BUILD: build/dev, with the targets hwsim_cli and cli_tests built
set -eu
cd "$(dirname "$0")/.."
HWSIM_WRITE_REFERENCE=1 "${1:-build/dev}/bin/cli_tests" --gtest_filter='Reference.*:Readme.*'
git --no-pager diff --stat -- docs/reference README.md
