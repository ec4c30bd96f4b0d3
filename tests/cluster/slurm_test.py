#!/usr/bin/env python3
"""examples/slurm on a Slurm of one node: 2,000 points over four scenes, a task killed on the way, give the database that one
machine gives.

slurm_test.py PROGRAM EXAMPLES. Ends with 77 where there can be no Slurm, and says why.
"""
import os
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import time

import slurm

SKIPPED = 77
TASKS = 4
SWEEP = """
SWEEP=(
  -t none,msaa4x,fxaa,smaa --resolution 160x90
  --vary scene=car_body,grass:blades=2000,metal,wires
  --vary gpu.dram_bandwidth_gb_s=x0.5,x0.75,x1,x2,x4
  --vary gpu.l2_size_kib=512..8192:5:log
  --vary gpu.core_clock_mhz=800..2000:5
)
"""
# Stands for `hwsim`: kills the second task's points once, when some of them run or are done.
WRAPPER = """#!{python}
import os, pathlib, sqlite3, subprocess, sys, time
program, words = {program!r}, sys.argv[1:]
mark = pathlib.Path({folder!r}) / "killed"
if "part2.sqlite" not in words or mark.exists():
    os.execv(program, [program, *words])
mark.write_text("not yet")
process = subprocess.Popen([program, *words])
def begun():
    try:
        with sqlite3.connect("file:part2.sqlite?mode=ro", uri=True) as database:
            return database.execute("SELECT count(*) FROM point WHERE state != 'pending'").fetchone()[0]
    except sqlite3.Error:
        return 0
while process.poll() is None and not begun():
    time.sleep(0.005)
process.kill()
mark.write_text(str(process.wait()))
sys.exit(137)
"""


def content(database):
    """Every point and pass, without what says where and when it was computed."""
    with sqlite3.connect(database) as opened:
        points = opened.execute(
            "SELECT id, number, scene, technique, gpu, engine, width_px, height_px, settings, run_file, gpu_file, state, "
            "message, time_ms, lo_ms, hi_ms, support, limiter, dram_mb, memory_mib, shaded_samples FROM point ORDER BY id")
        passes = opened.execute("SELECT * FROM pass ORDER BY point_id, ordinal")
        return points.fetchall(), passes.fetchall()


def put_sweep(file, words):
    """Writes another sweep into an example's file, and leaves the rest of it."""
    text = file.read_text()
    begin, end = text.index("SWEEP=("), text.index("\n)\n") + 3
    file.write_text(text[:begin] + words.strip() + "\n" + text[end:])


def words_of(sweep_file):
    script = f'source {sweep_file}; printf "%s\\0" "${{SWEEP[@]}}"'
    return subprocess.run(["bash", "-c", script], capture_output=True, check=True).stdout.decode().split("\0")[:-1]


def wait_for_jobs(cluster, seconds=480):
    """Requeued tasks wait two minutes for their nodes to come to rest, unless somebody says otherwise."""
    for _ in range(seconds):
        lines = cluster.ask("squeue", "-h", "-r", "-o", "%i %T %r").stdout.splitlines()
        if not lines:
            return
        for line in lines:
            job, _, reason = line.split(maxsplit=2)
            if reason == "BeginTime":
                cluster.ask("scontrol", "update", f"JobId={job}", "StartTime=now")
        time.sleep(1.0)
    raise AssertionError("jobs are still there:\n" + "\n".join(lines) + "\n" + cluster.logs())


def run(program, examples, folder):
    work = folder / "work"
    shutil.copytree(examples, work)
    put_sweep(work / "sweep.sh", SWEEP)
    wrapper = folder / "bin" / "hwsim"
    wrapper.parent.mkdir()
    wrapper.write_text(WRAPPER.format(python=sys.executable, program=str(program), folder=str(folder)))
    wrapper.chmod(0o755)
    with slurm.Slurm(folder, cpus=TASKS) as cluster:
        environment = {**cluster.environment, "PATH": f"{wrapper.parent}:{os.environ['PATH']}", "HWSIM_CACHE": str(folder / "cache")}
        submitted = subprocess.run(["bash", str(work / "submit.sh"), str(TASKS)], env=environment, capture_output=True,
                                   text=True, check=False, timeout=300)
        print(submitted.stdout, submitted.stderr, flush=True)
        assert submitted.returncode == 0, "submit.sh failed"
        wait_for_jobs(cluster)
    for log in sorted(work.glob("*.log")):
        print(f"--- {log.name}\n{log.read_text()}", flush=True)
    killed = (folder / "killed").read_text()
    assert killed == "-9", f"the second task was not killed on its way: {killed}"
    whole = subprocess.run([program, "sweep", *words_of(work / "sweep.sh"), "--db", "whole.sqlite", "-q"], cwd=work, check=False,
                           env={**os.environ, "HWSIM_CACHE": str(folder / "other-cache")}, stdout=subprocess.DEVNULL)
    assert whole.returncode == 0, "the sweep on one machine failed"
    here, there = content(work / "whole.sqlite"), content(work / "sweep.sqlite")
    assert len(here[0]) == 2000 and {point[11] for point in here[0]} == {"done"}, "not every point is done on one machine"
    assert here == there, "the cluster's database is another one"
    print(f"{len(here[0])} points and {len(here[1])} passes are equal, one task of {TASKS} was killed and came again")


def main():
    program, examples = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    folder = pathlib.Path(tempfile.mkdtemp(prefix="hwsim_slurm_"))
    try:
        run(program, examples, folder)
    except slurm.Missing as missing:
        print(f"skipped: {missing}")
        return SKIPPED
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
