#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A sequence through a real Slurm on this machine: one task has a frame that cannot be read, one is killed in the middle
and put back into the queue. Its files have the bytes of a local run, nothing is lost and nothing done twice; a second
run of the same job does only what was left.

    farm_slurm.py COMMAND

Ends with status 77 where Slurm or munge is not installed."""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parent))
from slurm_node import SlurmNode, missing_programs  # noqa: E402

READ_ERROR, SKIPPED = 3, 77
FRAMES, BAD, KILLED_AFTER = range(1, 7), 4, 5
OPTIONS = ["--voxel-size", "0.1", "--samples", "1000", "-q", "--frames-at-once", "1"]
# Stands for vdb_shell in the job: the first time that it is to do the last frames it is killed in the second of them.
PROGRAM = """#!/bin/bash
case "$*" in
*0-2.json*)
    if mkdir '{once}' 2>/dev/null; then
        '{command}' "$@" &
        until grep -q '"frame": {killed_after},' walk.tasks/0-2.json 2>/dev/null; do sleep 0.01; done
        kill -9 $!
        wait $!
        exit $?
    fi
    ;;
esac
exec '{command}' "$@"
"""


def require(condition, text):
    if not condition:
        raise SystemExit(f"NOT SO: {text}")


def icosphere(radius, rounds):
    """Points and triangles."""
    g = (1 + math.sqrt(5)) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1),
              (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
                 (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10),
                 (8, 6, 7), (9, 8, 1)]
    for _ in range(rounds):
        middles, finer = {}, []
        for triangle in triangles:
            middle = []
            for a, b in zip(triangle, triangle[1:] + triangle[:1]):
                if (key := (min(a, b), max(a, b))) not in middles:
                    middles[key] = len(points)
                    points.append(tuple((x + y) / 2 for x, y in zip(points[a], points[b])))
                middle.append(middles[key])
            a, b, c = triangle
            finer += [(a, middle[0], middle[2]), (middle[0], b, middle[1]), (middle[2], middle[1], c), tuple(middle)]
        triangles = finer
    scaled = [tuple(radius * x / math.dist(p, (0, 0, 0)) for x in p) for p in points]
    return scaled, triangles


def write_frame(folder, frame):
    # The last one takes long enough to be killed in it.
    points, triangles = icosphere(1 + 0.1 * frame, 5 if frame == FRAMES[-1] else 2)
    lines = ["v %r %r %r" % p for p in points] + ["f %d %d %d" % tuple(i + 1 for i in t) for t in triangles]
    (folder / f"s.{frame:04}.obj").write_text("\n".join(lines) + "\n")


def call(outputs):
    return ["build", "s.####.obj", "--frames", f"{FRAMES[0]}-{FRAMES[-1]}", "-o", f"{outputs}/t.####.vdb", "-o",
            f"{outputs}/t.####.vtu", *OPTIONS]


def files_in(folder):
    return {file.name: file.read_bytes() for file in folder.iterdir()}


def shown(slurm, job):
    """What Slurm knows of a task, "JobState": "FAILED" and so on."""
    status, out, error = slurm.run(["scontrol", "show", "job", job])
    require(status == 0, f"{job} is known: {error}")
    return dict(word.split("=", 1) for word in out.split() if "=" in word)


def first_run(slurm, farm, shot):
    status, out, error = slurm.run([*farm, "--submit", "--program", shot / "program", "--", *call("farm")], cwd=shot)
    require(status == 0 and len(out.splitlines()) == 2, f"it is written and submitted: {out} {error}")
    array, last = out.splitlines()[1].split()
    # sbatch --wait looks ever more rarely, and would take three times as long.
    slurm.wait_for("the last job", lambda: shown(slurm, last)["JobState"] not in ("PENDING", "RUNNING", "COMPLETING"), 120)
    messages = {name: (shot / "walk.tasks" / name).read_text() for name in ("0.log", "1.log", "2.log", "join.log")}
    at = f"{out}\n{error}\n{messages}\n{slurm.logs()}"
    require(shown(slurm, last)["ExitCode"] == f"{READ_ERROR}:0", f"the job that joins ends as the frame that failed: {at}")
    tasks = [shown(slurm, f"{array}_{task}") for task in range(3)]
    require([task["ExitCode"] for task in tasks] == ["0:0", f"{READ_ERROR}:0", "0:0"], f"tasks pass their status on: {at}")
    require([task["JobState"] for task in tasks] == ["COMPLETED", "FAILED", "COMPLETED"], f"Slurm knows: {tasks}")
    require([task["Restarts"] for task in tasks] == ["0", "0", "1"], f"the one that was killed ran again: {tasks}")
    require("back into the queue" in messages["2.log"], at)
    # It was noted before it was said.
    require(messages["2.log"].count("frame 5: done") <= 1 and messages["2.log"].count("frame 5: left out") == 1 and
            messages["2.log"].count("frame 6: done") == 1, f"what was noted before the kill is not done again: {messages['2.log']}")
    require(f"frame {BAD}: status {READ_ERROR}" in messages["join.log"] and "5 of 6 frames done" in messages["join.log"],
            f"the join says what failed, and why: {messages['join.log']}")


def second_run(slurm, shot):
    write_frame(shot, BAD)
    before = {file: file.stat().st_mtime_ns for file in (shot / "farm").iterdir()}
    status, out, error = slurm.run(["bash", "walk.sbatch", "wait"], cwd=shot)
    require(status == 0 and "6 of 6 frames done" in out, f"the same job does what was left: {out} {error}")
    require(all(file.stat().st_mtime_ns == time for file, time in before.items()), "and nothing else")


def local_run(command, shot, *more):
    return subprocess.run([command, *call("local"), "--keep-going", *more], cwd=shot, capture_output=True, text=True)


def main():
    missing = missing_programs()
    if missing:
        print("skipped, not installed:", *missing)
        return SKIPPED
    command = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as work:
        # Names are only names, whatever a shell could read in them.
        shot = pathlib.Path(work) / "shot 'a' \"b\" $(touch c) %j #"
        for folder in (shot, shot / "farm", shot / "local", shot.parent / "slurm"):
            folder.mkdir()
        for frame in FRAMES:
            write_frame(shot, frame)
        (shot / f"s.{BAD:04}.obj").write_text("v 0 0 zero\n")
        program = shot / "program"
        program.write_text(PROGRAM.format(once=pathlib.Path(work) / "once", command=command, killed_after=KILLED_AFTER))
        program.chmod(0o755)
        farm = [command, "farm", "--engine", "slurm", "-o", "walk.sbatch", "--chunk", "2", "--cpus", "1"]
        with SlurmNode(shot.parent / "slurm") as slurm:
            first_run(slurm, farm, shot)
            require(local_run(command, shot).returncode == READ_ERROR, "the local run fails the same way")
            require(files_in(shot / "farm") == files_in(shot / "local"), "the bytes are those of a local run")
            second_run(slurm, shot)
        again = subprocess.run([command, *call("farm"), "--resume", "--manifest", "walk.tasks/call-0.json"], cwd=shot,
                               capture_output=True, text=True)
        require("left out: 6" in again.stderr, f"a local run takes the farm's frames as done: {again.stderr}")
        steps = json.loads((shot / "walk.tasks" / "call-0.json").read_text())["steps"]
        require([step["frame"] for step in steps] == list(FRAMES), "each frame is noted once")
        require(not (shot / "c").exists() and not pathlib.Path("c").exists(), "no name became a command")
    return 0


if __name__ == "__main__":
    sys.exit(main())
