# SPDX-License-Identifier: Apache-2.0
"""Slurm on this machine alone, without systemd and without touching one that may be installed: ordinary processes with a
key, ports and folders of their own, ended when the object is left.

    with SlurmNode(folder) as slurm: slurm.run(["sbatch", ...])
"""
import os
import pathlib
import pwd
import shutil
import socket
import subprocess
import time

DAEMONS = ["munged", "slurmctld", "slurmd"]
CLIENTS = ["sbatch", "scontrol", "squeue", "sinfo"]
CONFIGURATION = """ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={daemon}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SchedulerParameters=sched_interval=1,batch_sched_delay=0,sched_min_interval=0
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
JobRequeue=1
KillWait=2
MailProg=/bin/true
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=60 State=UP
"""


def missing_programs():
    """The daemons stand in folders that are not everybody's."""
    os.environ["PATH"] += os.pathsep + "/usr/sbin" + os.pathsep + "/sbin"
    return [program for program in [*DAEMONS, *CLIENTS] if shutil.which(program) is None]


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class SlurmNode:
    def __init__(self, folder, cpus=2):
        self.folder = pathlib.Path(folder).resolve()
        self.children = []
        controller, daemon = free_ports(2)
        self.configuration = self.folder / "slurm.conf"
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        self.configuration.write_text(CONFIGURATION.format(
            host=socket.gethostname().split(".")[0], controller=controller, daemon=daemon, folder=self.folder, cpus=cpus,
            memory=os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2 ** 21,
            user=pwd.getpwuid(os.getuid()).pw_name))
        self.environment = {**{k: v for k, v in os.environ.items() if not k.startswith(("SLURM_", "SBATCH_"))},
                            "SLURM_CONF": str(self.configuration)}

    def __enter__(self):
        try:
            key = self.folder / "munge.key"
            key.write_bytes(os.urandom(128))
            key.chmod(0o600)
            # munged refuses folders that others may write into.
            self.folder.chmod(0o755)
            self.start(["munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.folder}/munge.socket",
                        f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log",
                        f"--seed-file={self.folder}/munge.seed"])
            self.wait_for("munged's socket", (self.folder / "munge.socket").exists)
            self.start(["slurmctld", "-D", "-f", str(self.configuration)])
            self.start(["slurmd", "-D", "-f", str(self.configuration)])
            self.wait_for("the node", lambda: "idle" in self.run(["sinfo", "-h", "-o", "%T"])[1])
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        # The last one first; what slurmd started ends with it or is killed by it.
        for child in reversed(self.children):
            child.terminate()
            try:
                child.wait(10)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()

    def start(self, line):
        output = open(self.folder / (line[0] + ".out"), "w")
        self.children.append(subprocess.Popen(line, env=self.environment, stdout=output, stderr=output,
                                              stdin=subprocess.DEVNULL))

    def wait_for(self, what, holds, seconds=20):
        end = time.monotonic() + seconds
        while not holds():
            dead = [child.args[0] for child in self.children if child.poll() is not None]
            if dead or time.monotonic() > end:
                raise RuntimeError(f"{what} did not come, ended: {dead}\n{self.logs()}")
            time.sleep(0.05)

    def logs(self):
        return "\n".join(f"--- {log.name}\n{log.read_text()[-3000:]}"
                         for log in sorted([*self.folder.glob("*.log"), *self.folder.glob("*.out")]))

    def run(self, line, **more):
        """(status, standard output, standard error)"""
        done = subprocess.run([str(word) for word in line], env=self.environment, capture_output=True, text=True,
                              timeout=120, **more)
        return done.returncode, done.stdout, done.stderr
