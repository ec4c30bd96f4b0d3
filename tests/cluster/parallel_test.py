#!/usr/bin/env python3
"""examples/parallel with GNU parallel gives the database that one process gives. parallel_test.py PROGRAM EXAMPLES.

Ends with 77 where GNU parallel is not installed.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from slurm_test import SKIPPED, content, put_sweep, words_of

SWEEP = """
SWEEP=(
  -t none,fxaa --resolution 96x64
  --vary scene=grass:blades=500,wires
  --vary gpu.l2_size_kib=512..8192:5:log
)
"""


def run(program, examples, folder):
    shutil.copytree(examples / "slurm", folder / "slurm")
    shutil.copytree(examples / "parallel", folder / "parallel")
    put_sweep(folder / "slurm" / "sweep.sh", SWEEP)
    (folder / "bin").mkdir()
    (folder / "bin" / "hwsim").symlink_to(program)
    environment = {**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}", "HWSIM_CACHE": str(folder / "cache")}
    done = subprocess.run(["bash", str(folder / "parallel" / "sweep.sh"), "3"], cwd=folder, env=environment, check=False,
                          capture_output=True, text=True, timeout=500)
    print(done.stdout, done.stderr)
    assert done.returncode == 0, "sweep.sh failed"
    subprocess.run([program, "sweep", *words_of(folder / "slurm" / "sweep.sh"), "--db", "whole.sqlite", "-q"], cwd=folder,
                   env={**environment, "HWSIM_CACHE": str(folder / "other")}, check=True, stdout=subprocess.DEVNULL)
    here = content(folder / "whole.sqlite")
    assert len(here[0]) == 20, f"{len(here[0])} points"
    assert here == content(folder / "sweep.sqlite"), "the database of the shards is another one"


def main():
    if not shutil.which("parallel"):
        print("skipped: GNU parallel is not installed (Debian: apt-get install parallel)")
        return SKIPPED
    folder = pathlib.Path(tempfile.mkdtemp(prefix="hwsim_parallel_"))
    try:
        run(*(pathlib.Path(word).resolve() for word in sys.argv[1:3]), folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
