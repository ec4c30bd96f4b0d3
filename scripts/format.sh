#!/usr/bin/env bash
# Shows where a C++ file differs from .clang-format, and fails then. --fix rewrites these files.
set -euo pipefail
cd "$(dirname "$0")/.."

tool=$(command -v clang-format-14 || command -v clang-format) || {
  echo "format: clang-format is missing; scripts/setup.sh --checks installs it" >&2
  exit 1
}
case $("$tool" --version) in
*"version 14."*) ;;
*)
  echo "format: $tool is not of version 14, and others format otherwise" >&2
  exit 1
  ;;
esac
how=(--dry-run -Werror)
[ "${1:-}" = --fix ] && how=(-i)
git ls-files -z '*.cpp' '*.h' | xargs -0 "$tool" "${how[@]}"
