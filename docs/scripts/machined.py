#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The fill of public machined parts, for docs/measurements/machined.md.

    machined.py COMMAND docs/measurements/machined.md PREFIX=FOLDER ... [--before OTHER_COMMAND]

Takes every .obj, .off, .ply and .stl below the folders; its name is the prefix, the folder it lies in and its own. Left out:
what `build` refuses as it is, parts of fewer than 100 triangles, which are boxes, of more than 20,000, which take minutes,
and a part that was there before under another name. --before: of an earlier build too.
"""
import argparse
import hashlib
import pathlib
import re
import statistics

from halves import HALVES, half_of
from runs import build, replace_tables, table

SETTINGS = {"default": [], "for speed": ["--for", "speed"], "thickest": ["--thickest"]}
FEWEST_TRIANGLES, MOST_TRIANGLES = 100, 20000
COLUMNS = [(setting, when) for setting in SETTINGS for when in ("before", "now")]


def figures(report):
    growth = next(stage["seconds"] for stage in report["stages"] if stage["stage"] == "growth")
    return {"triangles": report["mesh"]["triangles"], "fill": report["volume"]["fill"], "growth": growth,
            "certified": report["certificate"]["certified"], "pins": report["prisms"]["pinned_vertices"],
            "demanded": report["prisms"]["demanded_pins"]["count"]}


def name_of(prefix, path):
    return re.sub(r"\W+", "_", f"{prefix}-{path.parent.name}-{path.stem}")


def parts(folders):
    seen = set()
    for prefix, folder in folders:
        for path in sorted(path for end in ("obj", "off", "ply", "stl") for path in pathlib.Path(folder).rglob(f"*.{end}")):
            content = hashlib.sha256(path.read_bytes()).digest()
            if content not in seen:
                seen.add(content)
                yield name_of(prefix, path), path


def shown(done):
    return f"{done['fill']:.4f}" + ("" if done["certified"] else ", NOT certified") if done else ""


def mean_row(half, rows):
    of_half = [row for row in rows if row["half"] == half]
    cells = [f"mean of {half} ({len(of_half)})", half, ""]
    for column in COLUMNS:
        fills = [row[column]["fill"] for row in of_half if row.get(column)]
        cells.append(f"{statistics.mean(fills):.4f}" if fills else "")
    return [*cells, "", ""]


def count_poor(rows, when):
    return sum(row["default", when]["fill"] < 0.9 for row in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("folders", nargs="+", type=lambda word: tuple(word.split("=", 1)))
    parser.add_argument("--before")
    a = parser.parse_args()
    rows = []
    for name, path in parts(a.folders):
        first = build(a.command, path, ["--samples", "0"], figures)
        if first["exit"] != 0 or not FEWEST_TRIANGLES <= first["triangles"] <= MOST_TRIANGLES:
            continue
        row = {"name": name, "half": half_of(name), "triangles": first["triangles"]}
        for setting, when in COLUMNS:
            command = a.command if when == "now" else a.before
            if command:
                flags = [*SETTINGS[setting], "--samples", "0"]
                row[setting, when] = first if (setting, when) == ("default", "now") else build(command, path, flags, figures)
        rows.append(row)
        print(name, *(shown(row.get(column)) for column in COLUMNS), flush=True)
    now = [row[setting, "now"] for row in rows for setting in SETTINGS]
    summary = (f"{len(rows)} parts, {len(now)} shells: {sum(done['certified'] for done in now)} certified; pins beyond those "
               f"demanded: {sum(done['pins'] - done['demanded'] for done in now)}. Less than .9 full by default: "
               f"{count_poor(rows, 'now')}" + (f", before {count_poor(rows, 'before')}." if a.before else "."))
    head = ["part", "half", "triangles", *(f"{setting}, {when}" for setting, when in COLUMNS), "pins", "demanded"]
    lines = [[row["name"], row["half"], f"{row['triangles']:,}", *(shown(row.get(column)) for column in COLUMNS),
              str(row["default", "now"]["pins"]), str(row["default", "now"]["demanded"])] for row in rows]
    replace_tables(a.page, [summary, "", *table(head, lines + [mean_row(half, rows) for half in HALVES])])


if __name__ == "__main__":
    main()
