#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Templates of Open Job Description that `farm` writes are what the specification allows, and what their tasks write has
the bytes of a local run.

    farm_openjd.py COMMAND"""
import copy
import pathlib
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parent))
import openjd_template as openjd  # noqa: E402
from farm_slurm import files_in, icosphere, require  # noqa: E402

OPTIONS = ["-q", "--samples", "0", "--voxel-size", "0.2"]


def frame(folder, number):
    points, triangles = icosphere(1 + 0.1 * abs(number), 2)
    lines = ["v %r %r %r" % p for p in points] + ["f %d %d %d" % tuple(i + 1 for i in t) for t in triangles]
    (folder / f"s.{number}.obj").write_text("\n".join(lines) + "\n")


def call(outputs, frames):
    return ["build", "in/s.#.obj", "-o", f"{outputs}/t.#.vdb", "-o", f"{outputs}/t.#.ele", "--frames", frames, *OPTIONS]


def farm(command, shot, *words):
    done = subprocess.run([command, "farm", "--engine", "openjd", "-o", "job.json", *words], cwd=shot, capture_output=True,
                          text=True)
    return done.returncode, done.stderr


def require_refused(template, text, change):
    """The checks of this test can fail."""
    broken = copy.deepcopy(template)
    change(broken)
    try:
        openjd.check(broken)
    except openjd.Invalid:
        return
    raise SystemExit(f"NOT SO: {text} is refused")


def mutations(template):
    require_refused(template, "an unknown key", lambda t: t.update(more=1))
    require_refused(template, "a missing command", lambda t: t["steps"][0]["script"]["actions"]["onRun"].pop("command"))
    require_refused(template, "an unknown name", lambda t: t["steps"][0]["script"]["actions"]["onRun"]["args"].append("{{Param.X}}"))
    require_refused(template, "a step that is not there", lambda t: t["steps"][1]["dependencies"].append({"dependsOn": "x"}))
    require_refused(template, "two steps of a name", lambda t: t["steps"].append(t["steps"][0]))


def sequence(command, shot, frames, chunking):
    outputs = "chunked" if chunking else "farm"
    (shot / outputs).mkdir()
    more = ["--task-chunking"] if chunking else []
    status, error = farm(command, shot, "--chunk", "2", "--cpus", "1", "--memory", "1", "--minutes", "3", *more, "--",
                         *call(outputs, frames))
    require(status == 0, error)
    template = openjd.load(shot / "job.json")
    openjd.check(template)
    mutations(template)
    done = openjd.run(template, shot, shot.parent / ("session-" + outputs), Program=command)
    require(all(status == 0 for _, status, _ in done), f"all tasks end well: {done}")
    require([name for name, _, _ in done] == ["folder", *["call-0"] * 3, "join-0"], f"tasks: {done}")
    require("5 of 5 frames done" in done[-1][2], f"the join has all frames: {done[-1]}")
    require(files_in(shot / outputs) == files_in(shot / "local"), f"{outputs}: the bytes are those of a local run")
    flows = {p["default"]: p["dataFlow"] for p in template["parameterDefinitions"] if p["type"] == "PATH"}
    require(flows == {"in": "IN", outputs: "OUT", "job.tasks": "INOUT"}, f"{flows}")
    for file in (shot / "job.tasks").iterdir():
        file.unlink()


def failing(command, shot):
    """A frame that fails fails its task, and the join is not reached."""
    (shot / "in" / "s.1.obj").write_text("v 0 0 zero\n")
    status, error = farm(command, shot, "--chunk", "3", "--", *call("farm", "-3-1"))
    require(status == 0, error)
    done = openjd.run(openjd.load(shot / "job.json"), shot, shot.parent / "session-failing", Program=command)
    require([status for _, status, _ in done] == [0, 0, 3], f"the status of the frame is the task's: {done}")


def list_of_calls(command, shot):
    (shot / "list.txt").write_text("".join(f"build in/s.-{i}.obj -o one.{i}.vtu --report=r.{i}.json -q --samples 0\n" for i in (1, 2)))
    status, error = farm(command, shot, "--calls", "list.txt")
    require(status == 0, error)
    template = openjd.load(shot / "job.json")
    openjd.check(template)
    done = openjd.run(template, shot, shot.parent / "session-list", Program=command)
    require(all(status == 0 for _, status, _ in done) and len(done) == 3, f"{done}")
    require(all((shot / f"{name}.{i}.{end}").exists() for i in (1, 2) for name, end in (("one", "vtu"), ("r", "json"))),
            "outputs are where they were named")


def main():
    command = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as work:
        shot = pathlib.Path(work).resolve() / "shot a$b 'c'"
        for folder in (shot, shot / "in", shot / "local"):
            folder.mkdir()
        frames = "-3-1"
        for number in range(-3, 2):
            frame(shot / "in", number)
        subprocess.run([command, *call("local", frames)], cwd=shot, check=True, capture_output=True)
        sequence(command, shot, frames, False)
        sequence(command, shot, "1--3", True)
        list_of_calls(command, shot)
        failing(command, shot)
        status, error = farm(command, shot, "--", *call("local", frames), "-o", "local/{{Param.X}}.#.vtu")
        require(status == 2 and "{{" in error, f"expressions are refused: {error}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
