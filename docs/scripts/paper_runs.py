# SPDX-License-Identifier: Apache-2.0
"""What the parts of paper.py share: one run of the command with its report, and what the tables say of it."""
import json
import os
import pathlib
import subprocess
import tempfile

NOT_VALID = 7  # what `build` ends with when it has written a shell that overlaps or has inverted tets


def build(command, mesh, flags):
    """The report of a build on one thread, None where the shell has no tet, and the processor seconds it took."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        with open(pathlib.Path(folder) / "errors", "w+") as errors:
            child = subprocess.Popen([command, "--threads", "1", "build", "-q", str(mesh), "--report", str(report), *flags],
                                     stdout=subprocess.DEVNULL, stderr=errors)
            _, status, usage = os.wait4(child.pid, 0)  # the resources of this child alone
            child.returncode = os.waitstatus_to_exitcode(status)
            errors.seek(0)
            message = errors.read().strip()
        if "the shell has no tet" in message:  # each line stopped at once; then nothing is written
            return None, usage.ru_utime + usage.ru_stime
        if child.returncode not in (0, NOT_VALID):
            raise RuntimeError(f"{mesh} {flags}: {message}")
        return json.loads(report.read_text()), usage.ru_utime + usage.ru_stime


def with_tables(answer, **tables):
    """`tables`: name -> (head, rows), kept beside the numbers for paper_pages.py."""
    answer["tables"] = {name: {"head": head, "rows": rows} for name, (head, rows) in tables.items()}
    return answer


def stage_seconds(report, stage):
    return sum(s["seconds"] for s in report["stages"] if s["stage"] == stage)


def figures(report):
    """What the tables say of one shell; of one without a tet too."""
    if report is None:
        return {"fill": 0.0, "covered_percent": 0.0, "twice_percent": 0.0, "inverted": 0, "tets": 0, "overlapping_pairs": 0,
                "certified": False, "stuck_percent": 100.0, "pinned": 0, "demanded_pins": 0}
    overlaps, coverage = report["overlaps"], report["coverage"] or {"covered_share": 0, "overlap_share": 0}
    return {"fill": report["volume"]["fill"], "covered_percent": 100 * coverage["covered_share"],
            "twice_percent": 100 * coverage["overlap_share"], "inverted": report["tets"]["inverted"],
            "tets": report["tets"]["tets"], "overlapping_pairs": overlaps["pairs"]["count"] if overlaps else 0,
            "certified": report["certificate"]["certified"],
            "pinned": report["prisms"]["pinned_vertices"], "demanded_pins": report["prisms"]["demanded_pins"]["count"],
            "stuck_percent": 100 * report["prisms"]["pinned_vertices"] / report["mesh"]["points"]}


def triangles_of(mesh):
    """Of an OBJ file: polygons count as fans."""
    return sum(len(line.split()) - 3 for line in mesh.read_text().splitlines() if line.startswith("f "))
