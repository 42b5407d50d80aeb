"""A Slurm of one controller and two nodes on this machine's loopback, for the life of a test."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Cluster:
    NODES = ("node1", "node2")

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.processes = {}
        self.env = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"))

    def start(self):
        key, socket_path = self.folder / "munge.key", self.folder / "munge.socket"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        self.folder.chmod(0o755)
        host = socket.gethostname()
        nodes = "\n".join(f"NodeName={n} NodeHostname={host} NodeAddr=127.0.0.1 Port={free_port()} CPUs=1 State=UNKNOWN"
                          for n in self.NODES)
        (self.folder / "slurm.conf").write_text(f"""ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={free_port()}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={socket_path}
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/linear
SchedulerType=sched/backfill
ReturnToService=2
SlurmdTimeout=5
SlurmctldTimeout=5
KillWait=2
MinJobAge=600
JobRequeue=1
SlurmctldParameters=enable_configless
StateSaveLocation={self.folder}/state
SlurmdSpoolDir={self.folder}/spool-%n
SlurmctldPidFile={self.folder}/slurmctld.pid
SlurmdPidFile={self.folder}/slurmd-%n.pid
SlurmctldLogFile={self.folder}/slurmctld.log
SlurmdLogFile={self.folder}/slurmd-%n.log
{nodes}
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""", encoding="utf-8")
        (self.folder / "state").mkdir()
        self.spawn("munged", ["/usr/sbin/munged", "-F", "--force", f"--key-file={key}", f"--socket={socket_path}",
                              f"--log-file={self.folder}/munged.log", f"--pid-file={self.folder}/munged.pid",
                              f"--seed-file={self.folder}/munged.seed"])
        self.wait(socket_path.exists, "munged", 20)
        self.spawn("slurmctld", ["/usr/sbin/slurmctld", "-D", "-i"])
        for node in self.NODES:
            self.start_node(node)
        self.wait(lambda: self.states() == {n: "idle" for n in self.NODES}, "the nodes", 60)

    def spawn(self, name, command):
        with open(self.folder / f"{name}.out", "ab") as log:
            self.processes[name] = subprocess.Popen(command, stdout=log, stderr=log, env=self.env, start_new_session=True)

    def start_node(self, node):
        self.spawn(node, ["/usr/sbin/slurmd", "-D", "-N", node])

    def kill_node(self, node):
        """The node dies: its daemon, and every process that it started, at once."""
        steps = step_daemons(self.env["SLURM_CONF"], node)
        victims = [self.processes[node].pid] + steps + [p for s in steps for p in descendants(s)]
        for pid in victims:  # those that would report the end of others first
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        self.processes[node].wait()

    def states(self):
        out = self.call("sinfo", "-h", "-N", "-o", "%N %t", check=False)
        return dict(line.split() for line in out.splitlines())

    def call(self, *command, check=True, env=None):
        result = subprocess.run(command, capture_output=True, text=True, check=False, env={**self.env, **(env or {})},
                                timeout=60)
        if check and result.returncode != 0:
            raise AssertionError(f"{command}: {result.stderr}\n{self.logs()}")
        return result.stdout

    def wait(self, condition, what, seconds):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                raise AssertionError(f"{what}: not in {seconds} s\n{self.logs()}")
            time.sleep(0.2)

    def logs(self):
        return "\n".join(f"--- {p.name}\n{p.read_text(errors='replace')[-3000:]}"
                         for p in sorted(self.folder.glob("*.log")) + sorted(self.folder.glob("*.out")))

    def stop(self):
        for node in self.NODES:
            if node in self.processes:
                self.kill_node(node)
        for name in ("slurmctld", "munged"):
            if name in self.processes:
                self.processes[name].kill()
                self.processes[name].wait()


def parents():
    out = {}
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            text = stat.read_text()
        except OSError:
            continue
        out[int(stat.parent.name)] = int(text.rpartition(")")[2].split()[1])
    return out


def descendants(pid):
    of, found = parents(), [pid]
    for p in found:
        found += [c for c, parent in of.items() if parent == p]
    return found[1:]


def step_daemons(conf, node):
    """The slurmstepd processes of a node, which have left their daemon: parents of what runs there."""
    of, found = parents(), set()
    for pid in of:
        try:
            environ = pathlib.Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
        except OSError:
            continue
        if f"SLURM_CONF={conf}".encode() not in environ or f"SLURMD_NODENAME={node}".encode() not in environ:
            continue
        while pid in of and pid > 1:
            if name_of(pid).startswith("slurmstepd"):
                found.add(pid)
            pid = of[pid]
    return sorted(found)


def name_of(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/comm").read_text()
    except OSError:
        return ""


def installed():
    return all(shutil.which(p, path="/usr/sbin:/usr/bin") for p in ("munged", "slurmctld", "slurmd", "sbatch"))
