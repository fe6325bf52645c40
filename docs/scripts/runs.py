# SPDX-License-Identifier: Apache-2.0
"""What the scripts that measure share: the clean meshes, the arguments, one run of the command, the page's table."""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

CLEAN_MESHES = [
    "paper/box", "paper/support_box", "paper/cylinder", "paper/pointy", "paper/diku", "paper/tube", "paper/lamp",
    "paper/sphere", "paper/teapot", "paper/glass", "paper/propella", "paper/funnel", "paper/jack",
    "paper/dragon_small_resolution", "paper/cow", "paper/bunny_low_resolution", "paper/bend", "paper/bowl",
    "paper/torus", "paper/knot", "artist/fandisk", "artist/cheburashka", "artist/rocker-arm"]
METHODS = ["certified", "thickest"]


def arguments(description, tables=None, options=()):
    """`tables`: names that --tables may list; without it the option does not exist. `options`: more of them, each with
    what argparse wants to know about it."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--results")
    if tables:
        parser.add_argument("--tables", nargs="+", choices=tables, default=tables)
    for name, about in options:
        parser.add_argument(name, **about)
    return parser.parse_args()


def usage_of(words, **more):
    """Exit status and resources (user and system time among them) of one program; `more` goes to Popen."""
    child = subprocess.Popen([str(word) for word in words], **more)
    # wait4 and not wait: only it tells the resources of this child alone.
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return child.returncode, usage


def run(command, flags, output, hidden):
    """One run on one thread: exit status, message (without the path `hidden`) and CPU seconds of the child.
    What it prints goes to the file `output`."""
    with tempfile.TemporaryFile("w+") as errors, open(output, "w") as printed:
        status, usage = usage_of([command, "--threads", "1", *flags], stdout=printed, stderr=errors)
        errors.seek(0)
        return {"exit": status, "message": errors.read().strip().replace(str(hidden), "MESH"),
                "seconds": usage.ru_utime + usage.ru_stime}


def build(command, mesh, flags, read=None, written=(0,)):
    """One build: the run, with the figures of its report; `read` picks them. `written`: statuses with a report."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        done = run(command, ["build", "-q", *flags, "--report", str(report), str(mesh)], os.devnull, mesh)
        if done["exit"] in written:
            done.update((read or figures)(json.loads(report.read_text())))
        return done


def figures(report):
    certificate = report["certificate"]
    # null without samples, as with --for speed.
    coverage = report["coverage"] or {"samples": 0, "in_several": 0, "in_none": 0}
    scale, cut, growth = report.get("scale") or {}, report.get("cut") or {}, report.get("growth") or {}
    failed = {name: value for name, value in certificate.items() if isinstance(value, dict) and value.get("count")}
    return {"certified": certificate["certified"], "failed": failed, "fill": report["volume"]["fill"],
            "inverted": report["tets"]["inverted"], "triangles": report["mesh"]["triangles"],
            "samples": coverage["samples"], "in_several": coverage["in_several"], "in_none": coverage["in_none"],
            "pinned": report["prisms"]["pinned_vertices"],
            "demanded_pins": report["prisms"]["demanded_pins"]["count"],
            "without_tet": report["prisms"]["triangles_without_tet"]["count"], "tets": report["tets"]["tets"],
            "min_ratio": report["quality"]["mean_ratio"]["min"],
            "p1_ratio": report["quality"]["mean_ratio"]["p1"], "moved": cut.get("moved_points"),
            "uncut": cut.get("uncut_pillars"), "shortened": scale.get("shortened_pillars"),
            "scaled_pins": scale.get("pinned_pillars"), "tets_below": growth.get("tets_below_quality")}


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)] + ["| " + " | ".join(row) + " |" for row in rows]


def replace_tables(page, lines, section="tables"):
    begin, end = f"<!-- {section}: begin -->", f"<!-- {section}: end -->"
    old = page.read_text()
    before, after = old[:old.index(begin) + len(begin)], old[old.index(end):]
    page.write_text(before + "\n\n" + "\n".join(lines) + "\n\n" + after)


class Results:
    """Finished runs, kept in a file when one is named, so that a long series can be continued."""

    def __init__(self, path):
        self.path = pathlib.Path(path) if path else None
        self.runs = json.loads(self.path.read_text()) if self.path and self.path.exists() else {}

    def keep(self, key, run):
        self.runs[key] = run
        if self.path:
            scratch = self.path.with_suffix(".new")
            scratch.write_text(json.dumps(self.runs, indent=1))
            scratch.replace(self.path)
