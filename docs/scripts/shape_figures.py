#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the tets of this project's command beside those of TetGen and gmsh of the same surfaces, by a code of its
own on the files that were written, and writes the tables of docs/measurements/shape.md. Needs numpy.

    shape_figures.py COMMAND MESH_FOLDER docs/measurements/shape.md [--ours NAME="OPTIONS" ...] [--quick]

COMMAND is the vdb_shell binary. --ours adds rows of the command, each with a list of options; the row `default` has
none. --meshes is a list of "tuning NAME" and "judging NAME" lines. --quick leaves out the surfaces of more than 5000
triangles. A page that does not exist gets the tables alone. Beside it stands the same as JSON. What a program made is
kept in --cache, a failure too; a new COMMAND is run again. With --keep-others rows of the other programs, which depend
on the surface alone, are taken from the JSON beside the page.
"""
import argparse
import json
import pathlib
import shlex

from halves import HALVES, read_halves
from runs import replace_tables, table
from tet_files import read_obj, read_tets
import tet_makers
from tet_makers import GMSH, TETGEN, Failed, Maker
from tet_shapes import shape_figures

OTHERS = [*TETGEN, *GMSH]
QUICK_TRIANGLES = 5000
# Head, key and how it is written.
COLUMNS = [("tets / triangle", "tets_per_triangle", "{:.2f}"), ("fill", "fill", "{:.4f}"),
           ("under 5 degrees", "under_5_degrees", "{:.2%}"), ("SOFA-bad", "sofa_bad", "{:.1%}"),
           ("AMIPS mean", "amips_mean", "{:.2f}"), ("AMIPS worst", "amips_worst", "{:.3g}"),
           ("smallest angle", "smallest_degrees", "{:.3g}"), ("not positive", "not_positive", "{:.0f}")]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("page", type=pathlib.Path)
    tet_makers.add_arguments(parser, ["default="], 300)
    parser.add_argument("--others", nargs="*", choices=OTHERS, default=OTHERS)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--keep-others", action="store_true")
    return parser.parse_args()


def ways_of(options):
    """{name of the row: the command's options, or None for another program}"""
    ours = dict(one.partition("=")[::2] for one in options.ours)
    return {name: shlex.split(words) for name, words in ours.items()} | {name: None for name in options.others}


def rows_of_others(page):
    """{(mesh, program): its figures} of an earlier run."""
    rows = json.loads(page.with_suffix(".json").read_text())
    return {(row["mesh"], row["way"]): {key: value for key, value in row.items() if key not in ("mesh", "half", "way")}
            for row in rows if row["way"] in OTHERS}


def measure(maker, mesh, way, words):
    try:
        made = maker.ours(mesh, words)[0] if words is not None else maker.others(mesh, way)
        return shape_figures(*read_tets(made), *read_obj(mesh))
    except (Failed, ValueError) as error:
        return {"failed": str(error)}


def cells(figures):
    return [form.format(figures[key]) for _, key, form in COLUMNS]


def mean_of(runs, names, way):
    """The mean of each figure; of angles and AMIPS's worst the worst, of what is not positive the sum."""
    rows = [runs[name][way] for name in names]
    found = {key: sum(row[key] for row in rows) / len(rows) for _, key, _ in COLUMNS}
    return found | {"amips_worst": max(row["amips_worst"] for row in rows),
                    "smallest_degrees": min(row["smallest_degrees"] for row in rows),
                    "not_positive": sum(row["not_positive"] for row in rows)}


def means_table(runs, halves, ways):
    """Means over the meshes that every way made tets of, for otherwise they would be of different surfaces; and over
    those that one way made more of."""
    common = [name for name in runs if all("failed" not in runs[name][way] for way in ways)]
    rows = []
    for way in ways:
        own = [name for name in runs if "failed" not in runs[name][way]]
        for part in ("all", *HALVES, *(["all it made"] if own != common else [])):
            names = own if part == "all it made" else [name for name in common if part in ("all", halves[name])]
            if names:
                mean = mean_of(runs, names, way)
                worst = max(runs[name][way]["tets_per_triangle"] for name in names)
                least = min(runs[name][way]["fill"] for name in names)
                rows.append([way, part, str(len(names)), *cells(mean), f"{worst:.2f}", f"{least:.4f}"])
    head = ["way", "half", "meshes", *(head for head, _, _ in COLUMNS), "most tets / triangle", "least fill"]
    left_out = sorted(set(runs) - set(common))
    return ["### Means", "", f"Of the {len(common)} meshes that every way made tets of"
            + (f"; without {', '.join(left_out)}." if left_out else "."), "", *table(head, rows)]


def way_table(runs, halves, way):
    rows = [[name, halves[name], *(["failed: " + runs[name][way]["failed"]] + [""] * len(COLUMNS)
                                   if "failed" in runs[name][way]
                                   else [str(runs[name][way]["triangles"]), *cells(runs[name][way])])]
            for name in runs]
    return ["", f"### {way}", "", *table(["mesh", "half", "triangles", *(head for head, _, _ in COLUMNS)], rows)]


def write_page(options, runs, halves, ways):
    lines = means_table(runs, halves, ways)
    named = [f"`{way}`: `vdb_shell build {shlex.join(words)}`" for way, words in ways.items() if words]
    lines = (named + [""] if named else []) + lines
    for way in ways:
        lines += way_table(runs, halves, way)
    if not options.page.exists():
        options.page.write_text("<!-- tables: begin -->\n<!-- tables: end -->\n")
    replace_tables(options.page, lines)
    rows = [{"mesh": name, "half": halves[name], "way": way, **runs[name][way]} for name in runs for way in ways]
    options.page.with_suffix(".json").write_text(
        "[\n" + ",\n".join(json.dumps(row) for row in rows) + "\n]\n")


def main():
    options = arguments()
    halves, ways = read_halves(options.meshes), ways_of(options)
    maker, runs = Maker(options.command.resolve(), options.cache, options.seconds), {}
    known = rows_of_others(options.page) if options.keep_others else {}
    for name in halves:
        mesh = (options.folder / f"{name}.obj").resolve()
        if options.only and name not in options.only:
            continue
        if options.quick and len(read_obj(mesh)[1]) > QUICK_TRIANGLES:
            continue
        runs[name] = {way: known.get((name, way)) or measure(maker, mesh, way, words) for way, words in ways.items()}
        for way, found in runs[name].items():
            print(f"{name}, {way}: {found.get('failed') or ' '.join(cells(found))}", flush=True)
    write_page(options, runs, halves, ways)


if __name__ == "__main__":
    main()
