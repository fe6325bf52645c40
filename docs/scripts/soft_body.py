#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
r"""Measures what shells and solids of other programs are worth to a solver (samples/soft_body) and writes the tables of
docs/measurements/soft_body.md. Needs numpy.

    soft_body.py COMMAND SOFT_BODY MESH_FOLDER docs/measurements/soft_body.md \
        [--ours NAME="OPTIONS" ...] [--only NAME ...]

COMMAND is the vdb_shell binary, SOFT_BODY the sample's. The list of meshes and --ours are as for shape_figures.py. The
reference of a surface is TetGen's -pYq1.414/14 refined twice, or once where that would be more than --reference-tets.
Beside the page stands the same as JSON. Results are kept in --cache; other binaries are run again. With --keep-others
the rows of other programs are taken from that JSON, and the reference from its own row there: its compliance over its
ratio is the limit, so nothing is refined again.
"""
import argparse
import hashlib
import json
import math
import pathlib
import subprocess

from halves import HALVES, read_halves
from runs import replace_tables, table
from shape_figures import rows_of_others, ways_of
from tet_files import read_tets
import tet_makers
from tet_makers import TETGEN, Failed, Maker, digest

REFERENCE = "TetGen -pYq1.414/14"
COLUMNS = [("tets", "tets", "{:.0f}"), ("compliance / converged", "ratio", "{:.3f}"),
           ("of one refinement", "ratio_of_one", "{:.3f}"), ("skin held", "ratio_skin", "{:.3f}"), ("CG steps", "steps", "{:.0f}"),
           ("explicit step, us", "explicit_us", "{:.1f}"), ("over TetGen -pYq's", "explicit_ratio", "{:.3f}")]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=pathlib.Path)
    parser.add_argument("soft_body", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("page", type=pathlib.Path)
    tet_makers.add_arguments(parser, ["default="], 600)
    parser.add_argument("--others", nargs="*", choices=list(TETGEN), default=[REFERENCE])
    parser.add_argument("--up", choices=("x", "y", "z"), default="y")
    parser.add_argument("--keep-others", action="store_true")
    parser.add_argument("--reference-tets", type=float, default=4e6, help="most tets of a refined reference")
    return parser.parse_args()


def solve(options, tets, flags=()):
    """What soft_body prints, kept beside the tets."""
    words = ["--up", options.up, *flags]
    kept = tets.parent / f"soft_body-{digest(options.soft_body)[:12]}-{hashlib.sha256(' '.join(words).encode()).hexdigest()[:8]}.json"
    if not kept.exists():
        try:
            done = subprocess.run([str(options.soft_body), str(tets), *words], capture_output=True, text=True,
                                  timeout=options.seconds)
        except subprocess.TimeoutExpired:
            raise Failed(f"over {options.seconds:g} s") from None
        if done.returncode:
            raise Failed(done.stderr.strip().replace(str(tets.parent), "")[:120] or f"exit {done.returncode}")
        kept.write_text(done.stdout)
    return json.loads(kept.read_text())


def reference_of(options, maker, mesh):
    """The converged compliance; that of one refinement with the factor 4; the reference's own explicit step."""
    solid = maker.others(mesh, REFERENCE)
    refinements = 2 if 64 * len(read_tets(solid)[1]) <= options.reference_tets else 1
    found = solve(options, solid, ["--refinements", str(refinements), "--reference", str(solid)])
    skin = solve(options, solid, ["--hold", "skin", "--refinements", str(refinements), "--reference", str(solid)])
    first, second = found["refined_compliances_joule"][:2]
    return {"limit": found["limit_joule"], "limit_skin": skin["limit_joule"], "limit_of_one": second + (second - first) / 3,
            "refinements": refinements, "explicit": found["explicit_step_s"]}


def known_reference(options, maker, mesh, row):
    """What reference_of gave when the row was written."""
    solid = maker.others(mesh, REFERENCE)
    found, skin = solve(options, solid), solve(options, solid, ["--hold", "skin"])
    return {"limit": found["compliance_joule"] / row["ratio"], "limit_skin": skin["compliance_joule"] / row["ratio_skin"],
            "limit_of_one": found["compliance_joule"] / row["ratio_of_one"], "refinements": row["refinements"],
            "explicit": found["explicit_step_s"]}


def measure(options, maker, mesh, way, words, reference):
    try:
        tets = maker.ours(mesh, words, ".vdb")[0] if words is not None else maker.others(mesh, way)
        found, skin = solve(options, tets), solve(options, tets, ["--hold", "skin"])
        if not (found["converged"] and skin["converged"]):
            return {"failed": f"not converged in {max(found['steps'], skin['steps'])} steps"}
        return {"tets": found["tets"], "steps": found["steps"], "refinements": reference["refinements"],
                "ratio": found["compliance_joule"] / reference["limit"],
                "ratio_of_one": found["compliance_joule"] / reference["limit_of_one"],
                "ratio_skin": skin["compliance_joule"] / reference["limit_skin"],
                "explicit_us": 1e6 * found["explicit_step_s"],
                "explicit_ratio": found["explicit_step_s"] / reference["explicit"]}
    except Failed as error:
        return {"failed": str(error)}


def cells(figures):
    if "failed" in figures:
        return ["failed: " + figures["failed"]] + [""] * (len(COLUMNS) - 1)
    return [form.format(figures[key]) for _, key, form in COLUMNS]


def mean_of(runs, names, way):
    """Of ratios the mean; of tets, steps and time steps the geometric one, for they go by the size of a mesh."""
    rows = [runs[name][way] for name in names]
    return {key: sum(row[key] for row in rows) / len(rows) if key.startswith("ratio")
            else math.exp(sum(math.log(row[key]) for row in rows) / len(rows)) for _, key, _ in COLUMNS}


def means(runs, halves, ways):
    common = [name for name in runs if all("failed" not in runs[name][way] for way in ways)]
    rows = []
    for way in ways:
        for part in ("all", *HALVES):
            names = [name for name in common if part in ("all", halves[name])]
            if names:
                rows.append([way, part, str(len(names)), *cells(mean_of(runs, names, way))])
    return table(["way", "half", "meshes", *(head for head, _, _ in COLUMNS)], rows)


def write_page(options, runs, halves, ways):
    rows = [[name, halves[name], way, *cells(runs[name][way])] for name in runs for way in ways]
    lines = ["### Means of the meshes that every way could be solved on", "", *means(runs, halves, ways), "",
             "### Each mesh", "", *table(["mesh", "half", "way", *(head for head, _, _ in COLUMNS)], rows)]
    if not options.page.exists():
        options.page.write_text("<!-- tables: begin -->\n<!-- tables: end -->\n")
    replace_tables(options.page, lines)
    found = [{"mesh": name, "half": halves[name], "way": way, **runs[name][way]} for name in runs for way in ways]
    options.page.with_suffix(".json").write_text("[\n" + ",\n".join(map(json.dumps, found)) + "\n]\n")


def main():
    options = arguments()
    options.soft_body = options.soft_body.resolve()
    halves, ways = read_halves(options.meshes), ways_of(options)
    maker, runs = Maker(options.command.resolve(), options.cache, options.seconds), {}
    known = rows_of_others(options.page) if options.keep_others else {}
    for name in halves:
        if options.only and name not in options.only:
            continue
        mesh = (options.folder / f"{name}.obj").resolve()
        try:
            row = known.get((name, REFERENCE))
            reference = known_reference(options, maker, mesh, row) if row else reference_of(options, maker, mesh)
        except Failed as error:
            runs[name] = {way: {"failed": f"reference: {error}"} for way in ways}
        else:
            runs[name] = {way: known.get((name, way)) or measure(options, maker, mesh, way, words, reference)
                          for way, words in ways.items()}
        for way, found in runs[name].items():
            print(f"{name}, {way}: {' '.join(cells(found))}", flush=True)
        write_page(options, runs, halves, ways)


if __name__ == "__main__":
    main()
