"""A Slurm of this machine's own in a folder, for tests: munged, slurmctld and one slurmd, as
root and without systemd."""

import os
import secrets
import socket
import subprocess
import time
from pathlib import Path

CONFIGURATION = """ClusterName=tress
SlurmctldHost={name}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CredType=cred/munge
SlurmctldPort={port}
SlurmdPort={next_port}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerParameters=sched_min_interval=200000,bf_interval=1
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
KillWait=5
MinJobAge=300
NodeName={name} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory_mb} State=UNKNOWN
PartitionName=short Nodes={name} Default=YES MaxTime=60 State=UP
"""
START_S = 20


def until(seconds, condition):
    """Waits until a condition is true. Returns false if it was not within this time."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.2)
    return True


def said(*command):
    """Returns what a command of Slurm prints, "" if it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else ""


class Slurm:
    """The daemons. start() returns false if they do not start on this machine."""

    def __init__(self, folder):
        # A socket's path may have 107 bytes only.
        self.folder = Path(folder)
        self.daemons = []

    def _daemon(self, *command):
        with (self.folder / f"{command[0]}.out").open("wb") as out:
            self.daemons.append(subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT))

    def start(self):
        munge = self.folder / "munge"
        for folder in (munge, self.folder / "state", self.folder / "spool"):
            folder.mkdir(parents=True)
        for folder in (self.folder, munge):
            folder.chmod(0o755)
        key = munge / "key"
        key.write_bytes(secrets.token_bytes(1024))
        key.chmod(0o400)
        name, port = socket.gethostname().partition(".")[0], 20000 + os.getpid() % 20000
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20 - 512
        configuration = self.folder / "slurm.conf"
        configuration.write_text(CONFIGURATION.format(
            name=name, folder=self.folder, port=port, next_port=port + 1,
            cpus=len(os.sched_getaffinity(0)), memory_mb=memory))
        os.environ["SLURM_CONF"] = str(configuration)
        self._daemon("munged", "--foreground", "--force", f"--socket={munge}/socket",
                     f"--key-file={key}", f"--pid-file={munge}/pid", f"--log-file={munge}/log",
                     f"--seed-file={munge}/seed")
        until(5, (munge / "socket").is_socket)
        self._daemon("slurmctld", "-D", "-i")
        self._daemon("slurmd", "-D", "-N", name)
        return until(START_S, lambda: said("sinfo", "-h", "-o", "%t") == "idle")

    def logs(self):
        """Returns the ends of the daemons' logs."""
        return "\n".join("\n".join(path.read_text(errors="replace").splitlines()[-5:])
                         for path in sorted([*self.folder.glob("*.log"),
                                             *self.folder.glob("*.out")]))

    def idle(self):
        """Waits until no job is left."""
        return until(180, lambda: said("squeue", "-h") == "")

    def stop(self):
        subprocess.run(["scancel", f"--user={os.getuid()}"], capture_output=True, check=False)
        # The last one first: slurmd, which ends its tasks.
        for daemon in reversed(self.daemons):
            daemon.terminate()
            daemon.wait()
