#!/usr/bin/env bash
# Shows where a C++ file differs from .clang-format (clang-format 14), and fails then. --fix rewrites these files.
set -euo pipefail
cd "$(dirname "$0")/.."

tool=$(command -v clang-format-14 || command -v clang-format) || {
  echo "format: clang-format is missing; scripts/setup.sh --checks installs it" >&2
  exit 1
}
"$tool" --version | grep -q 'version 14\.' || {
  echo "format: $("$tool" --version); the style is that of version 14, other versions format otherwise" >&2
  exit 1
}
how=(--dry-run -Werror)
[ "${1:-}" = --fix ] && how=(-i)
git ls-files -z '*.cpp' '*.h' | xargs -0 "$tool" "${how[@]}"
