#!/usr/bin/env python3
"""Fails or kills hwsim at its system calls, one a start, and looks at what is left.

faults.py PROGRAM [--every N] [SCENARIO...]: each scenario is a command in a folder of its own. Every call that changes a file
is made to fail with ENOSPC and with EIO, and the program is killed at every N-th call of any kind (strace injects both). After
each: earlier results are as they were, what exists is whole, and the same command ends well and leaves what it leaves without
a fault. Then 2 and 4 processes work on one cache and one database at the same time.
"""
import argparse
import collections
import hashlib
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile

CHANGES = ["write", "pwrite64", "rename", "renameat2", "mkdir", "link", "fsync", "fdatasync", "ftruncate", "fchmod"]
VIEW = ["grass:blades=10", "-g", "gtx980", "--resolution", "16x16"]
SWEEP = ["sweep", *VIEW, "-t", "none,msaa4x", "--db", "s.sqlite", "--resume", "--vary"]
FIT = ["fit", "--paper", "axaa", "--starts", "1", "--out"]
STATUSES = {0, 1, 3, 5}
CONFIGS = pathlib.Path(__file__).resolve().parents[2] / "configs"
FITTED = 4  # lines of the parameters that "fit" keeps: one paper has too few values for all


class Scenario:
    """A command, the commands that come before it, and those that look at what it made."""

    def __init__(self, command, before=(), again=None, keeps=(), result=(), look=()):
        self.command, self.before, self.again = command, before, again or command
        self.keeps = keeps    # files and folders that are never touched
        self.result = result  # files that are equal after every good end
        self.look = look      # a command whose output is equal after every good end


RUN = ["run", *VIEW, "-t", "none", "--no-image", "--out"]
SCENARIOS = {
    "run": Scenario([*RUN, "new"], [[*RUN, "old"], ["cache", "prune", "--all"]], [*RUN, "new", "--force"], ["old"],
                    ["new/passes.csv"]),
    "run_replaces": Scenario([*RUN, "old", "--force"], [[*RUN, "old"], [*RUN, "other"]], None, ["other"], ["old/passes.csv"]),
    "pictures": Scenario(["run", *VIEW, "-t", "none", "--out", "new", "--reference", "1"], [[*RUN, "old"]],
                         ["run", *VIEW, "-t", "none", "--out", "new", "--reference", "1", "--force"], ["old"],
                         ["new/passes.csv", "new/color.png"]),
    "sweep": Scenario([*SWEEP, "gpu.l2_size_kib=256,512,1024"], [[*SWEEP, "gpu.l2_size_kib=256"]],
                      look=["sweep", "--db", "s.sqlite", "--format", "csv"]),
    "merge": Scenario(["sweep", "--db", "s.sqlite", "--merge", "o.sqlite"],
                      [[*SWEEP, "gpu.l2_size_kib=256"], ["sweep", *VIEW, "-t", "none", "--db", "o.sqlite", "--vary",
                                                         "gpu.l2_size_kib=64,128"]],
                      keeps=["o.sqlite"], look=["sweep", "--db", "s.sqlite", "--format", "csv"]),
    "rank": Scenario(["rank", *VIEW, "-t", "none,msaa4x", "--reference", "1", "--out", "new"], [[*RUN, "old"]],
                     ["rank", *VIEW, "-t", "none,msaa4x", "--reference", "1", "--out", "new", "--force"], ["old"],
                     ["new/ranking.csv"]),
    "fit": Scenario([*FIT, "new"], [[*FIT, "old"]], [*FIT, "new", "--force"], ["old"],
                    ["new/calibration.json", "new/hd4600.toml"]),
    "prune": Scenario(["cache", "prune", "--all"], [[*RUN, "old"]], keeps=["old"]),
}


def digest(path):
    """What a file or folder holds, names included."""
    total = hashlib.sha256()
    for file in sorted([path, *path.rglob("*")]):
        total.update(str(file.relative_to(path)).encode() + b"\0")
        if file.is_file():
            total.update(file.read_bytes())
    return total.hexdigest()


def listing(folder):
    """Every name below a folder but those of durations, which come and go."""
    names = (str(f.relative_to(folder)) for f in folder.rglob("*"))
    return sorted(n for n in names if "durations" not in n)


class Bench:
    def __init__(self, program, name, every):
        self.program, self.name, self.every = os.path.abspath(program), name, every
        self.scenario = SCENARIOS[name]
        base = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="hwsim_stress_", dir=base))
        self.work, self.template = self.root / "work", self.root / "template"
        self.configs = self.root / "configs"
        shutil.copytree(CONFIGS, self.configs)
        parameters = self.configs / "calibration" / "parameters.csv"
        parameters.write_text("".join(parameters.read_text().splitlines(keepends=True)[:FITTED]))
        self.faults = self.failures = 0

    def hwsim(self, words, inject=(), log=None):
        environment = {**os.environ, "HWSIM_CACHE": "cache", "HWSIM_JOBS": "1", "HWSIM_CONFIG_DIR": str(self.configs)}
        trace = ["strace", "-f", "-qq", "-o", str(log or self.root / "strace.log"), *inject] if inject or log else []
        try:
            return subprocess.run([*trace, self.program, *words], cwd=self.work, env=environment, capture_output=True,
                                  timeout=120, check=False)
        except subprocess.TimeoutExpired as late:
            return subprocess.CompletedProcess(words, 124, late.stdout or b"", (late.stderr or b"") + b"hangs\n")

    def fresh(self):
        shutil.rmtree(self.work, ignore_errors=True)
        shutil.copytree(self.template, self.work)

    def prepare(self):
        """The folder as the command finds it, and what it leaves without a fault."""
        self.work.mkdir()
        for words in self.scenario.before:
            done = self.hwsim(words)
            assert done.returncode == 0, done.stderr.decode()
        self.work.rename(self.template)
        self.kept = {name: digest(self.template / name) for name in self.scenario.keeps}
        self.fresh()
        log = self.root / "calls.log"
        done = self.hwsim(self.scenario.command, log=log)
        assert done.returncode == 0, done.stderr.decode()
        self.found = self.outcome()
        self.names = listing(self.work)
        by_thread = collections.Counter(tuple(line.split("(")[0].split()[:2]) for line in open(log, encoding="latin1")
                                        if "(" in line and not line.split()[1].startswith(("<", "+", "-")))
        self.calls = collections.Counter()
        for (_, call), count in by_thread.items():
            self.calls[call] = max(self.calls[call], count)

    def outcome(self):
        files = [(self.work / f).read_bytes() for f in self.scenario.result]
        return files + ([self.hwsim(self.scenario.look).stdout] if self.scenario.look else [])

    def complain(self, what, done):
        self.failures += 1
        print(f"{self.name}: {self.fault}: {what} (status {done.returncode})\n{done.stderr.decode(errors='replace')}",
              flush=True)

    def check(self, done, killed):
        if not killed and done.returncode not in STATUSES:
            self.complain("ended in another way than it may", done)
        if b"X001" in done.stderr or b"Sanitizer" in done.stderr:
            self.complain("took a fault for a mistake of its own", done)
        for name, before in self.kept.items():
            if digest(self.work / name) != before:
                self.complain(f"`{name}` is not as it was", done)
        if done.returncode == 0 and self.outcome() != self.found:
            self.complain("ended well, and its result is another one", done)
        for name in self.scenario.result:  # never half a file under a result's name
            file = self.work / name
            if file.exists() and file.read_bytes() != self.found[self.scenario.result.index(name)]:
                self.complain(f"`{name}` is not whole", done)

    def start_again(self):
        done = self.hwsim(self.scenario.again)
        if done.returncode != 0:
            self.complain("the next start fails", done)
        elif self.outcome() != self.found:
            self.complain("the next start has another result", done)
        extra = sorted(set(listing(self.work)) - set(self.names))
        if extra:
            self.complain(f"after the next start there still are {extra[:6]}", done)

    def inject(self, call, fault, number):
        self.fault = f"{call}:{fault} at {number}"
        self.fresh()
        done = self.hwsim(self.scenario.command,
                          ["-e", f"trace={call}", "-e", f"inject={call}:{fault}:when={number}"])
        self.faults += 1
        self.check(done, killed=done.returncode in (-signal.SIGKILL, 128 + signal.SIGKILL))
        self.start_again()

    def run(self):
        self.prepare()
        for call in CHANGES:
            for number in range(1, self.calls[call] + 1):
                for fault in ("error=ENOSPC", "error=EIO"):
                    self.inject(call, fault, number)
        steps = [(call, n) for call in sorted(self.calls) if call != "execve" for n in range(1, self.calls[call] + 1)]
        for call, number in steps[::self.every]:
            self.inject(call, "signal=SIGKILL", number)
        print(f"{self.name}: {self.faults} faults, {self.failures} failures", flush=True)
        shutil.rmtree(self.root)
        return self.faults, self.failures


def start_together(bench, commands):
    """Starts all commands at once in the bench's folder; returns how they ended."""
    environment = {**os.environ, "HWSIM_CACHE": "cache", "HWSIM_JOBS": "1", "HWSIM_CONFIG_DIR": str(bench.configs)}
    running = [subprocess.Popen([bench.program, *words], cwd=bench.work, env=environment, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE) for words in commands]
    ends = [process.communicate(timeout=300) for process in running]
    return [subprocess.CompletedProcess(p.args, p.returncode, *e) for p, e in zip(running, ends)]


def run_beside_each_other(program, rounds=10):
    """Several processes on a cold cache and one database: each ends well, all have the same results."""
    faults = failures = 0
    for count in (2, 4):
        for round_ in range(rounds):
            bench = Bench(program, "run", 1)
            bench.work.mkdir()
            bench.fault = f"{count} processes, round {round_}"
            runs = start_together(bench, [[*RUN, f"new{i}"] for i in range(count)])
            words = [*SWEEP, "gpu.l2_size_kib=256,512,1024"]
            sweeps = start_together(bench, [words] * count)
            for done in [*runs, *sweeps]:
                faults += 1
                if done.returncode != 0:
                    bench.complain("a process beside others fails", done)
            results = {(bench.work / f"new{i}" / "passes.csv").read_bytes() for i in range(count)}
            states = bench.hwsim(["sweep", "--db", "s.sqlite", "--format", "csv"]).stdout.decode().count(",done,")
            if len(results) != 1 or states != 6:
                bench.complain(f"{len(results)} different results, {states} of 6 points done", runs[0])
            failures += bench.failures
            shutil.rmtree(bench.root)
    print(f"beside each other: {faults} processes, {failures} failures", flush=True)
    return faults, failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--every", type=int, default=1, help="kill at every N-th call only")
    parser.add_argument("scenarios", nargs="*", default=list(SCENARIOS))
    options = parser.parse_intermixed_args()
    results = [Bench(options.program, name, options.every).run() for name in options.scenarios]
    results.append(run_beside_each_other(options.program))
    faults, failures = (sum(column) for column in zip(*results))
    print(f"{faults} faults, {failures} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
