"""SIGKILL at random moments, to the supervisor or to its worker; each time the sweep is resumed. In the end nothing is
lost, doubled or different from an undisturbed run."""
import argparse
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

import sweep


def children(pid):
    try:
        return [int(c) for c in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except (FileNotFoundError, ProcessLookupError):
        return []


def disturb(config, out, resume, delay, victim):
    """One run, killed after `delay` if it still goes on then. Returns whether it was killed."""
    process = subprocess.Popen(sweep.command(config, out, resume), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    time.sleep(delay)
    pids = [process.pid] if victim == "supervisor" else children(process.pid)
    killed = False
    if process.poll() is None:
        for pid in pids:
            os.kill(pid, signal.SIGKILL)
            killed = True
    errors = process.communicate(timeout=900)[1].decode()
    assert "internal error" not in errors, errors
    assert process.returncode in (0, 1, -signal.SIGKILL), (process.returncode, errors)
    return killed


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    rng = random.Random(arguments.seed)
    with tempfile.TemporaryDirectory() as base:
        base = pathlib.Path(base)
        config = sweep.write_config(base)
        start = time.monotonic()
        assert sweep.run(config, base / "calm").returncode == 0
        whole = time.monotonic() - start
        calm = sweep.outcome(base / "calm")
        kills, sweeps = {"supervisor": 0, "worker": 0}, 0
        while sum(kills.values()) < arguments.kills:
            out, sweeps, started = base / f"sweep{sweeps}", sweeps + 1, False
            for _ in range(rng.randint(2, 8)):
                if sum(kills.values()) >= arguments.kills:
                    break
                victim = rng.choice(("supervisor", "worker"))
                kills[victim] += disturb(config, out, started, rng.uniform(0, whole), victim)
                started = (out / "points.jsonl").exists()
            result = sweep.run(config, out, resume=started)
            assert result.returncode == 0, result.stderr
            disturbed = sweep.outcome(out)
            assert disturbed == calm, f"sweep {sweeps} differs from the undisturbed one"
        print(f"{kills['supervisor']} supervisors and {kills['worker']} workers killed in {sweeps} sweeps of {len(calm)} "
              "points, all results equal")
    return 0


if __name__ == "__main__":
    sys.exit(main())
