#!/usr/bin/env bash
# Fails and kills hwsim at its system calls, and looks at what is left: scripts/stress.sh [BUILD] [ARGUMENTS of
# tests/stress/faults.py], as in `scripts/stress.sh build/dev --every 5 run sweep`. Needs strace, and a build of the program.
set -euo pipefail
cd "$(dirname "$0")/.."

build=build/release
case ${1:-} in
"" | -*) ;;
*)
  build=$1
  shift
  ;;
esac
command -v strace >/dev/null || {
  echo "stress: strace is not installed (Debian: apt-get install strace)" >&2
  exit 2
}
exec python3 tests/stress/faults.py "$build/bin/hwsim" "$@"
