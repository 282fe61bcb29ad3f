"""A Slurm cluster of one's own on loopback, in a temporary folder: munged, slurmctld and a slurmd for
each node, as this user. It needs no configuration of the system, and leaves nothing."""

import getpass
import os
import pathlib
import shutil
import signal
import socket
import subprocess

from harness import free_port

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol", "sinfo"]
PLACES = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/usr/local/sbin"])

NODE = "GOSHAWK_TEST_NODE"

CONFIGURATION = """\
ClusterName=goshawk
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmctldPort={controller_port}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SchedulerParameters=sched_interval=1,batch_sched_delay=0
SlurmdTimeout=5
KillWait=2
ReturnToService=2
{nodes}
PartitionName=flights Nodes=ALL Default=YES MaxTime=INFINITE State=UP OverSubscribe=YES
"""


def missing():
    """Names of Slurm's programs that are not installed."""
    return [p for p in PROGRAMS if shutil.which(p, path=PLACES) is None]


def free_ports(count):
    ports = set()
    while len(ports) < count:
        ports.add(free_port())
    return list(ports)


class Cluster:
    """Its commands are for those who have `env`."""

    def __init__(self, folder, env, nodes):
        self.folder = pathlib.Path(folder)
        self.processes = {}
        host = socket.gethostname().split(".")[0]
        ports = free_ports(nodes + 1)
        names = [f"node{k}" for k in range(1, nodes + 1)]
        (self.folder / "state").mkdir(parents=True)
        cpus = max(1, (os.cpu_count() or 1) // nodes)
        lines = [f"NodeName={n} NodeHostname={host} NodeAddr=127.0.0.1 Port={p} "
                 f"CPUs={cpus}" for n, p in zip(names, ports[1:])]
        self.conf = self.folder / "slurm.conf"
        self.conf.write_text(CONFIGURATION.format(
            host=host, user=getpass.getuser(), folder=self.folder, controller_port=ports[0],
            nodes="\n".join(lines)))
        self.env = {**env, "SLURM_CONF": str(self.conf), "PATH": PLACES}
        self.start_munge()
        self.start("slurmctld", "slurmctld", "-D", "-i")
        for name in names:
            self.start_node(name)

    def start_munge(self):
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        self.start("munged", "munged", "--foreground", "--force", f"--key-file={key}",
                   f"--socket={self.folder}/munge.socket", f"--pid-file={self.folder}/munge.pid",
                   f"--log-file={self.folder}/munge.log", f"--seed-file={self.folder}/munge.seed")

    def start_node(self, name):
        self.start(name, "slurmd", "-D", "-N", name, env={NODE: name})

    def start(self, name, *command, env=None):
        with open(self.folder / f"{name}.out", "ab") as out:
            self.processes[name] = subprocess.Popen(
                [shutil.which(command[0], path=PLACES), *command[1:]], env={**self.env, **(env or {})},
                stdin=subprocess.DEVNULL, stdout=out, stderr=out)

    def call(self, *command):
        """@return lines that a command prints; none if it fails"""
        done = subprocess.run([shutil.which(command[0], path=PLACES), *command[1:]], env=self.env,
                              text=True, capture_output=True)
        return done.stdout.splitlines() if done.returncode == 0 else []

    def nodes(self, state):
        return [name for name, told in (line.split() for line in
                                        self.call("sinfo", "-h", "-N", "-o", "%N %T"))
                if told == state]

    def jobs(self):
        return self.call("squeue", "-h", "-r", "-o", "%i %T %N")

    def running(self):
        """Names of the nodes that have a task."""
        return [line.split()[2] for line in self.jobs() if line.split()[1] == "RUNNING"]

    def lose_node(self, name):
        """Ends a node without a word, and all that runs on it; it does not come back."""
        self.processes[name].kill()
        self.processes[name].wait()
        # Its steps, and what Slurm calls a task's environment.
        marks = {f"{NODE}={name}".encode(), f"SLURMD_NODENAME={name}".encode()}
        for entry in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if marks & set((entry / "environ").read_bytes().split(b"\0")):
                    os.kill(int(entry.name), signal.SIGKILL)
            except OSError:
                continue  # it has ended, or belongs to another user
        self.call("scontrol", "update", f"NodeName={name}", "State=DOWN", "Reason=lost")

    def tails(self):
        return "\n".join(f"--- {path.name}\n{path.read_text(errors='replace')[-1500:]}"
                         for path in sorted(self.folder.glob("*.log")))

    def close(self):
        for process in reversed(self.processes.values()):
            process.terminate()
            try:
                process.wait(10.0)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
