"""A Slurm of two nodes on this machine, with a configuration of its own.

Needs slurmctld, slurmd, slurm-client and munge (scripts/install_deps.sh cluster).
Nothing of it is known to the system's services, and nothing of it is left.
"""

import os
import shutil
import signal
import socket
import subprocess
import time

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue", "sinfo", "scancel"]
NODES = ["one", "two"]
TIMEOUT = 120

CONFIG = """\
ClusterName=small
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=1,sched_interval=1,batch_sched_delay=0
JobAcctGatherType=jobacct_gather/none
KillWait=1
SlurmdTimeout=5
MinJobAge=600
ReturnToService=2
{nodes}
PartitionName=all Nodes={names} Default=YES MaxTime=INFINITE State=UP
"""


def what_is_missing():
    """Why there can be no Slurm here; empty: there can."""
    path = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"
    missing = [name for name in PROGRAMS if not shutil.which(name, path=path)]
    return "there is no %s; scripts/install_deps.sh cluster installs it" % missing[0] \
        if missing else ""


def _free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class SmallSlurm:

    def __init__(self, folder):
        self.folder = folder
        self._daemons = {}
        self.environment = dict(
            os.environ, SLURM_CONF=self.path("slurm.conf"),
            PATH=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self):
        os.makedirs(self.path("state"))
        # munge wants to be sure that nobody else writes where its socket is.
        os.chmod(self.folder, 0o755)
        with open(os.open(self.path("munge.key"), os.O_WRONLY | os.O_CREAT, 0o600), "wb") as file:
            file.write(os.urandom(128))
        ports = _free_ports(1 + len(NODES))
        with open(self.path("slurm.conf"), "w") as file:
            file.write(CONFIG.format(
                host=socket.gethostname(), folder=self.folder, controller_port=ports[0],
                user=subprocess.check_output(["id", "-un"], text=True).strip(),
                names=",".join(NODES), nodes="\n".join(
                    "NodeName=%s NodeHostname=%s NodeAddr=127.0.0.1 Port=%d CPUs=1 State=UNKNOWN"
                    % (name, socket.gethostname(), port)
                    for name, port in zip(NODES, ports[1:]))))
        self._start("munged", "--foreground", "--force", "--key-file=" + self.path("munge.key"),
                    "--socket=" + self.path("munge.socket"),
                    "--pid-file=" + self.path("munged.pid"),
                    "--log-file=" + self.path("munged.log"),
                    "--seed-file=" + self.path("munged.seed"))
        self._wait(lambda: os.path.exists(self.path("munge.socket")), "munged")
        self._start("slurmctld", "-D", "-i")
        for name in NODES:
            self.start_node(name)
        self._wait(lambda: self.run("sinfo", "-h", "-t", "idle", "-o", "%D").strip()
                   == str(len(NODES)), "nodes")

    def start_node(self, name):
        os.makedirs(self.path("spool-" + name), exist_ok=True)
        self._start("slurmd", "-D", "-N", name, key=name)

    def kill_node(self, name):
        """As if its power went: its daemon, and with it all of its jobs."""
        self._kill_jobs(self._daemons.pop(name), name)

    def stop(self):
        for name in list(self._daemons)[::-1]:
            self._kill_jobs(self._daemons.pop(name), name)

    def _kill_jobs(self, daemon, node):
        """First the daemons, lest they tell the controller how the jobs ended."""
        daemon.kill()
        daemon.wait()
        jobs = [number for number in map(int, filter(str.isdigit, os.listdir("/proc")))
                if self._is_job(number, node)]
        parents = {_parent(number) for number in jobs}
        for number in [each for each in parents if _name(each) == "slurmstepd"] + jobs:
            try:
                os.kill(number, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def _is_job(self, number, node):
        environment = _read("/proc/%d/environ" % number).split("\0")
        return "SLURM_CONF=" + self.path("slurm.conf") in environment and \
            "SLURMD_NODENAME=" + node in environment

    def run(self, *command):
        return subprocess.run(command, env=self.environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=TIMEOUT).stdout

    def _start(self, *command, key=None):
        with open(self.path((key or command[0]) + ".out"), "ab") as output:
            self._daemons[key or command[0]] = subprocess.Popen(
                command, env=self.environment, stdin=subprocess.DEVNULL, stdout=output,
                stderr=subprocess.STDOUT)

    def _wait(self, is_there, what):
        end = time.monotonic() + TIMEOUT
        while not is_there():
            if time.monotonic() > end:
                raise RuntimeError("%s did not start; see %s:\n%s" % (
                    what, self.folder, "\n".join(self._last_lines())))
            time.sleep(0.1)

    def _last_lines(self):
        for name in sorted(os.listdir(self.folder)):
            if name.endswith((".log", ".out")):
                with open(self.path(name), errors="replace") as file:
                    yield from ["%s: %s" % (name, line.rstrip()) for line in file][-5:]


def _read(path):
    """"" if the process has ended."""
    try:
        with open(path, "rb") as file:
            return file.read().decode(errors="replace")
    except OSError:
        return ""


def _name(process):
    return _read("/proc/%d/comm" % process).strip()


def _parent(process):
    fields = _read("/proc/%d/stat" % process).rpartition(")")[2].split()
    return int(fields[1]) if fields else 0
