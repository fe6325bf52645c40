#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What `build --mend` makes of whole collections of public meshes, for docs/measurements/unseen.md.

    unseen.py COMMAND docs/measurements/unseen.md PREFIX=FOLDER ...

Takes each .obj, .off and .ply in the folders; PREFIX comes before its name in the table and in unseen_meshes.txt, for names
of other collections are the same. Each build is one run on one thread without a file; where one fails the table says so.
"""
import argparse
import pathlib
import statistics

from halves import half_of
from runs import build, replace_tables, table


def figures(report):
    taken = report["mend"][-1]["tried"]
    return {"taken": taken, "read": report["read"]["file_faces"], "triangles": report["mesh"]["triangles"],
            "kept": report["repair"]["kept_triangles"] if report["repair"] else None,
            "fill": report["volume"]["fill"], "certified": report["certificate"]["certified"],
            "pins": report["prisms"]["pinned_vertices"], "demanded": report["prisms"]["demanded_pins"]["count"]}


def row(name, done):
    if done["exit"] != 0:
        return [name, half_of(name), "", f"exit {done['exit']}: {done['message'][:80]}", *[""] * 6]
    kept = f"{done['kept']:,}" if done["kept"] is not None else "all" if done["taken"] == "as-it-is" else "none"
    return [name, half_of(name), f"{done['read']:,}", done["taken"], f"{done['triangles']:,}", kept,
            f"{done['fill']:.4f}" + ("" if done["certified"] else ", NOT certified"), str(done["pins"]),
            str(done["demanded"]), f"{done['seconds']:.1f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("folders", nargs="+")
    a = parser.parse_args()
    rows, made = [], []
    for prefix, folder in (word.split("=", 1) for word in a.folders):
        for mesh in sorted(path for end in ("obj", "off", "ply") for path in pathlib.Path(folder).glob(f"*.{end}")):
            name = prefix + mesh.stem
            done = build(a.command, mesh, ["--mend", "--samples", "0"], figures)
            made += [done] if done["exit"] == 0 else []
            rows.append(row(name, done))
            print(" | ".join(rows[-1]), flush=True)
    fills = [done["fill"] for done in made]
    summary = (f"{len(rows)} meshes: {sum(done['certified'] for done in made)} certified; fill {statistics.mean(fills):.4f} in the "
               f"mean, {min(fills):.4f} at least; pins beyond those demanded: {sum(done['pins'] - done['demanded'] for done in made)}.")
    head = ["mesh", "half", "faces", "taken", "triangles", "of the input", "fill", "pins", "demanded", "s"]
    replace_tables(a.page, [summary, "", *table(head, rows)])


if __name__ == "__main__":
    main()
