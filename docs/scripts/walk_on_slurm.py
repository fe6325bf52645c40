#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The walk of the sample creature, 100 frames, posed by a Slurm of its own on this machine, with one task killed in the
middle; then the same here. Says whether the bytes are the same and what was done twice.

    walk_on_slurm.py BUILD_FOLDER docs/farm.md

BUILD_FOLDER is that of a release build. Needs Debian's slurm-wlm and munge; takes some three minutes on two cores.
"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests" / "command"))
from runs import replace_tables, table  # noqa: E402
from slurm_node import SlurmNode, missing_programs  # noqa: E402

FRAMES, CHUNK, KILLED_IN = 100, 10, 4
CALL = ["pose", "rest.vdb", "walk.####.obj", "--mesh-before", "walk.####.obj", "--mesh-after", "walk.####.obj", "--frames",
        f"1-{FRAMES}", "-q"]


def kill_once(shot, killed):
    """The process of one task, as soon as it has noted a frame."""
    notes = shot / "walk.tasks" / f"0-{KILLED_IN}.json"
    while not killed:
        if notes.exists() and '"frame"' in notes.read_text():
            for folder in pathlib.Path("/proc").glob("[0-9]*"):
                try:
                    words = (folder / "cmdline").read_bytes().split(b"\0")
                    state = (folder / "stat").read_text().rsplit(")", 1)[1].split()[0]
                except OSError:
                    continue
                if words[0].endswith(b"/vdb_shell") and any(w.endswith(f"0-{KILLED_IN}.json".encode()) for w in words) \
                        and state != "Z":
                    os.kill(int(folder.name), signal.SIGKILL)
                    killed.append(int(folder.name))
        time.sleep(.01)


def run(line, **more):
    return subprocess.run([str(word) for word in line], capture_output=True, text=True, **more)


def main():
    build, page = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    command, mesh = build / "src/vdb_shell", ROOT / "samples/meshes/creature.obj"
    if missing_programs():
        sys.exit("slurm-wlm and munge are needed")
    with tempfile.TemporaryDirectory() as work:
        shot = pathlib.Path(work) / "shot"
        for folder in (shot, shot / "farm", shot / "here", shot.parent / "slurm"):
            folder.mkdir()
        run([build / "samples/make_motion", mesh, "walk", FRAMES, shot], check=True)
        run([command, "build", mesh, "-q", "-o", shot / "rest.vdb"], check=True)
        run([command, "farm", "--engine", "slurm", "-o", "walk.sbatch", "--program", command, "--chunk", CHUNK, "--cpus", "2",
             "--", *CALL, "-o", "farm/p.####.vdb", "-o", "farm/p.####.vtu", "--manifest", "walk.json"], cwd=shot, check=True)
        killed = []
        with SlurmNode(shot.parent / "slurm") as slurm:
            threading.Thread(target=kill_once, args=(shot, killed), daemon=True).start()
            # Not `wait`: it looks ever more rarely.
            status, out, error = slurm.run(["bash", "walk.sbatch", "submit"], cwd=shot)
            last = out.split()[-1]
            state = lambda: slurm.run(["scontrol", "show", "job", last])[1]  # noqa: E731
            slurm.wait_for("the last job", lambda: not re.search("JobState=(PENDING|RUNNING|COMPLETING)", state()), 900)
        log = "".join((shot / "walk.tasks" / f"{task}.log").read_text() for task in range(FRAMES // CHUNK))
        done = [int(frame) for frame in re.findall(r"frame (\d+): (?:done|ended)", log)]
        left = len(re.findall(r"frame \d+: left out", log))
        local = run([command, *CALL, "-o", "here/p.####.vdb", "-o", "here/p.####.vtu", "--keep-going"], cwd=shot)
        same = [sum((shot / "farm" / f"p.{frame:04}.{kind}").read_bytes() == (shot / "here" / f"p.{frame:04}.{kind}").read_bytes()
                    for frame in range(1, FRAMES + 1)) for kind in ("vdb", "vtu")]
        again = run([command, *CALL, "-o", "farm/p.####.vdb", "-o", "farm/p.####.vtu", "--resume", "--manifest", "walk.json",
                     "--keep-going"], cwd=shot)
    rows = [["frames, tasks", f"{FRAMES}, {FRAMES // CHUNK}"],
            ["processes killed by SIGKILL in the middle of a task", str(len(killed))],
            ["frames done, of these twice", f"{len(set(done))}, {len(done) - len(set(done))}"],
            ["frames that the task left out when it ran again", str(left)],
            ["`.vdb` and `.vtu` with the bytes of a local run", f"{same[0]} and {same[1]} of {FRAMES}"],
            ["exit status of the local run", str(local.returncode)],
            ["frames that the same call, resumed with the joined manifest, leaves out",
             str(len(re.findall(r"frame \d+: left out", again.stderr)))]]
    replace_tables(page, table(["", ""], rows), "walk")
    print("\n".join(": ".join(row) for row in rows))


if __name__ == "__main__":
    main()
