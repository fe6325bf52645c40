# SPDX-License-Identifier: Apache-2.0
"""The commands that benchmarks.py compares, and one run of one of them with its wall and CPU seconds and memory."""
import json
import os
import resource
import shutil
import signal
import subprocess
import threading
import time

OURS, LEVEL_SET, TETGEN, GMSH, DEEP = "vdb_shell", "vdb_tool", "tetgen", "gmsh", "deep band"
RIVALS = [LEVEL_SET, TETGEN, GMSH, DEEP]
NOT_INSTALLED = "not installed"


class Job:
    """One surface and how to work on it. `mesh` is what OBJ readers get; `folder` has it in the other formats."""

    def __init__(self, command, mesh, folder, resolution=256, threads=0, options=()):
        self.command, self.mesh, self.folder, self.options = command, mesh, folder, options
        self.resolution, self.threads = str(resolution), str(threads)


def arguments_of(name, job):
    """The command line and the files that a success leaves."""
    if name == OURS:
        return [job.command, "--threads", job.threads, "build", "-q", str(job.mesh), "-o", "ours.vdb", "--resolution",
                job.resolution, "--report", "ours.json", *job.options], ["ours.vdb", "ours.json"]
    if name == DEEP:
        return [job.command, "build", "-q", str(job.mesh), "--no-free-moves", "--samples", "0", "--field", "dense",
                "--resolution", job.resolution, "--report", "deep.json"], ["deep.json"]
    if name == LEVEL_SET:
        return ["vdb_tool", "-read", str(job.mesh), "-mesh2ls", f"dim={job.resolution}", "-write",
                "level_set.vdb"], ["level_set.vdb"]
    if name == TETGEN:
        return ["tetgen", "-pY", "surface.off"], ["surface.1.node", "surface.1.ele"]
    return ["gmsh", "-3", "surface.geo", "-o", "gmsh.msh"], ["gmsh.msh"]


def timed(arguments, folder, log, seconds):
    """(wall, CPU, peak bytes, exit status, whether it was stopped). Stopped after `seconds`."""
    stopped = threading.Event()
    with log.open("w") as stream:
        begin = time.perf_counter()
        child = subprocess.Popen(arguments, cwd=folder, stdout=stream, stderr=subprocess.STDOUT)

        def stop():
            stopped.set()
            os.kill(child.pid, signal.SIGKILL)
        timer = threading.Timer(seconds, stop)
        timer.start()
        # wait4 and not wait: only it tells the resources of this child alone.
        _, status, usage = os.wait4(child.pid, 0)
        wall = time.perf_counter() - begin
        timer.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024, child.returncode, stopped.is_set()


def why_failed(exit_status, stopped, seconds, outputs, text):
    if stopped:
        return f"over {seconds:g} s"
    # 7: written, but not valid, as the raw method may be.
    if exit_status not in (0, 7):
        return f"exit {exit_status}"
    if not all(output.exists() and output.stat().st_size for output in outputs):
        return "no result"
    # gmsh says so and leaves with status 0 all the same.
    return "error" if "Error   :" in text else None


def run_once(name, job, seconds):
    """{"wall", "cpu", "peak", "floor"} and more from our report, or {"failed": why}. The memory that a child inherits
    from this process before it becomes the command counts as its own: a peak at the floor says "at most"."""
    arguments, outputs = arguments_of(name, job)
    if shutil.which(arguments[0]) is None:
        return {"failed": NOT_INSTALLED}
    outputs = [job.folder / output for output in outputs]
    for output in outputs:
        output.unlink(missing_ok=True)
    floor = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    log = job.folder / "log.txt"
    wall, cpu, peak, exit_status, stopped = timed(arguments, job.folder, log, seconds)
    failed = why_failed(exit_status, stopped, seconds, outputs, log.read_text(errors="replace"))
    if failed:
        return {"failed": failed, "wall": wall}
    run = {"wall": wall, "cpu": cpu, "peak": peak, "floor": floor}
    if name in (OURS, DEEP):
        run.update(from_report(name, json.loads(outputs[-1].read_text())))
    return run


def from_report(name, report):
    stages = {}
    for cost in report["stages"]:
        stages[cost["stage"]] = stages.get(cost["stage"], 0) + cost["seconds"]
    if name == DEEP:
        # Of the whole command only the level set is what is compared.
        cost = next(cost for cost in report["stages"] if cost["stage"] == "level set")
        return {"wall": cost["seconds"], "cpu": None, "peak": cost["peak_memory_bytes"]}
    return {"stages": stages, "fill": report["volume"]["fill"], "certified": report["certificate"]["certified"]}
