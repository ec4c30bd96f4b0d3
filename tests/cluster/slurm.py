"""A Slurm of one node on the loopback, for as long as a test takes: munge, a controller and a daemon in a folder of their own.

As Debian packages it (slurm-wlm, munge). Whoever has no right to start it (the daemons want root), or has no such
packages, is told by Missing.
"""
import os
import pathlib
import shutil
import socket
import subprocess
import time

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo"]
CONFIG = """
ClusterName=loopback
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={daemon}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
ReturnToService=2
JobRequeue=1
MpiDefault=none
SlurmdParameters=config_overrides
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


class Missing(Exception):
    """Why there can be no Slurm here."""


def program(name):
    found = shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin:/sbin")
    if not found:
        raise Missing(f"`{name}` is not installed (Debian: apt-get install slurm-wlm munge)")
    return found


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Slurm:
    """A node with `cpus` CPUs, whatever the machine has. Use it as a context."""

    def __init__(self, folder, cpus):
        self.programs = {name: program(name) for name in PROGRAMS}
        if os.geteuid() != 0:
            raise Missing("Slurm's daemons are started by root")
        self.folder = pathlib.Path(folder)
        self.cpus = cpus
        self.started = []
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}

    def __enter__(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        host = socket.gethostname().split(".")[0]
        (self.folder / "slurm.conf").write_text(CONFIG.format(
            host=host, folder=self.folder, cpus=self.cpus, controller=free_port(), daemon=free_port()))
        self.host = host
        try:
            self.start_munge()
            self.start("slurmctld", "-D", "-c", "-i")
            self.start("slurmd", "-D", "-c", "-N", host)
            self.wait_for_node()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for process in reversed(self.started):
            process.terminate()
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()

    def start_munge(self):
        """With a key of its own; munged refuses places that others may write to."""
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        self.start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.folder}/munge.socket",
                   f"--pid-file={self.folder}/munge.pid", f"--log-file={self.folder}/munge.log",
                   f"--seed-file={self.folder}/munge.seed")
        self.wait_until(lambda: (self.folder / "munge.socket").exists(), "munged")

    def start(self, name, *arguments):
        log = open(self.folder / f"{name}.out", "wb")
        self.started.append(subprocess.Popen([self.programs[name], *arguments], env=self.environment, stdout=log,
                                             stderr=log, stdin=subprocess.DEVNULL, start_new_session=True))

    def ask(self, name, *arguments, cwd=None):
        return subprocess.run([self.programs[name], *arguments], env=self.environment, cwd=cwd, capture_output=True,
                              text=True, check=False, timeout=60)

    def wait_until(self, holds, what, seconds=60):
        for _ in range(seconds * 5):
            if holds():
                return
            for process in self.started:
                if process.poll() is not None:
                    raise Missing(f"{process.args[0]} ended with {process.returncode}:\n{self.logs()}")
            time.sleep(0.2)
        raise Missing(f"{what} does not answer:\n{self.logs()}")

    def wait_for_node(self):
        self.wait_until(lambda: self.ask("sinfo", "-h", "-o", "%T").stdout.strip() == "idle", "slurmctld")

    def logs(self):
        """The last lines of each log."""
        return "\n".join(f"{file.name}: " + " | ".join(file.read_text(errors="replace").splitlines()[-6:])
                         for file in sorted(self.folder.glob("*.log")) + sorted(self.folder.glob("*.out")))


