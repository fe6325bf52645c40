#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Inspects, builds, repairs and wraps every mesh of a folder, and writes the table of docs/measurements/all_meshes.md.

    all_meshes.py COMMAND MESH_FOLDER docs/measurements/all_meshes.md [--quick] [--results FILE.json]

COMMAND is the vdb_shell binary. --quick leaves out the meshes of more than 5000 triangles. --results keeps the
finished runs in a file and takes them from there the next time; delete it when the command has changed.
"""
import json
import pathlib
import tempfile

from runs import Results, arguments, build, figures, replace_tables, run, table

FLAGS = ["--resolution", "64", "--samples", "20000"]
WRAP = ["--wrap", "--wrap-resolution", "64"]
QUICK_TRIANGLES = 5000
WORDS = {"boundary_loops": "holes", "boundary_edges": "boundary edges", "non_manifold_edges": "non-manifold edges",
         "non_manifold_vertices": "non-manifold points", "flipped_patches": "flipped patches",
         "one_sided_pieces": "one-sided pieces", "degenerate_triangles": "without area",
         "duplicate_triangles": "repeats", "self_intersections": "crossing pairs",
         "inside_out_components": "inside out", "flat_components": "flat", "nested_components": "nested",
         "blind_vertices": "blind points"}


def inspect(command, mesh):
    with tempfile.TemporaryDirectory() as folder:
        printed = pathlib.Path(folder) / "inspect.json"
        done = run(command, ["inspect", "--json", str(mesh)], printed, mesh)
        if done["exit"] in (0, 7):
            found = json.loads(printed.read_text())
            done.update(usable=found["usable"], triangles=found["triangles"],
                        findings={finding["kind"]: finding["count"] for finding in found["findings"]})
        return done


def repair_figures(repair):
    holes = repair["holes"]
    changes = {"welded": repair["welded_points"]["count"], "collapsed": repair["collapsed"]["count"],
               "without area": repair["degenerate"]["count"], "repeats dropped": repair["duplicates"]["count"],
               "of sheets dropped": repair["sheets"]["count"], "turned": repair["turned"]["count"],
               "points parted": repair["split_points"]["count"], "cut": repair["cut"]["count"],
               "holes closed": sum(hole["method"] != "none" for hole in holes),
               "holes left": sum(hole["method"] == "none" for hole in holes)}
    return {"changes": {kind: count for kind, count in changes.items() if count}, "kept": repair["kept_triangles"]}


def repair_alone(command, mesh, flags):
    with tempfile.TemporaryDirectory() as folder:
        printed = pathlib.Path(folder) / "repair.json"
        done = run(command, ["repair", "--json", *flags, str(mesh), "-o", str(pathlib.Path(folder) / "out.ply")],
                   printed, mesh)
        if done["exit"] in (0, 7):
            done.update(repair_figures(json.loads(printed.read_text())))
        return done


def built_figures(report):
    wrap = report["wrap"]
    picked = figures(report)
    if wrap:
        far = {way: [wrap[way]["mean"] / wrap["voxel_size"], wrap[way]["max"] / wrap["voxel_size"]]
               for way in ("input_to_wrap", "wrap_to_input")}
        picked.update(far, wrap_voxel=wrap["voxel_size"])
    return picked


def jobs_of(name, looked):
    """The ways of one mesh: `plain` where inspect finds it usable; else a repair, with cuts where that is needed."""
    jobs = [("plain", lambda c, m: build(c, m, FLAGS, built_figures)),
            ("repair", lambda c, m: repair_alone(c, m, [])),
            ("wrap", lambda c, m: build(c, m, [*FLAGS, *WRAP], built_figures))]
    if looked["usable"]:
        return jobs
    return [*jobs, ("cut", lambda c, m: repair_alone(c, m, ["--cut-crossings"])),
            ("repaired", lambda c, m: build(c, m, [*FLAGS, "--repair"], built_figures)),
            ("repaired, cut", lambda c, m: build(c, m, [*FLAGS, "--repair", "--cut-crossings"], built_figures))]


def needed(way, runs, name):
    """A cut is only for what repair leaves unusable, and a shell only for what repair left usable."""
    repaired = runs.get(f"{name}, repair")
    if way == "repaired":
        return repaired["exit"] == 0
    if way == "cut":
        return repaired["exit"] != 0
    if way == "repaired, cut":
        cut = runs.get(f"{name}, cut")
        return bool(cut) and cut["exit"] == 0
    return True


def shell_cells(done, refused):
    if done is None:
        return [refused, "", ""]
    if done["exit"] != 0:
        return [refused if done["exit"] == 4 and done["message"] else f"**FAILED, exit {done['exit']}**", "", ""]
    sound = done["certified"] and not done["in_several"]
    return ["yes" if sound else "**NO**", f"{done['fill']:.3f}", f"{done['seconds']:.0f}"]


def diagnosis(looked):
    if "findings" not in looked:
        return f"**FAILED, exit {looked['exit']}**"
    shown = [f"{count} {WORDS[kind]}" for kind, count in looked["findings"].items() if kind in WORDS]
    return ", ".join(shown) or "clean"


def repair_cell(runs, name):
    plain, cut = runs.get(f"{name}, repair"), runs.get(f"{name}, cut")
    if plain is None:
        return "not run"
    texts = []
    for found, option in ((plain, ""), (cut, "`--cut-crossings`: ")):
        if found and "changes" in found:
            # A hole that a cut took away is none that is left.
            done = ", ".join(f"{count} {kind}" for kind, count in found["changes"].items()
                             if found["exit"] or kind != "holes left") or "nothing"
            texts.append(f"{option}{done}; {found['kept']} kept" + (", left unusable" if found["exit"] else ""))
        elif found:
            texts.append(f"{option}**FAILED, exit {found['exit']}**")
    return " / ".join(texts)


def rows_of(runs, names):
    shells, repairs = [], []
    for name in names:
        looked = runs.get(f"{name}, inspect")
        if not looked:
            continue
        mended = runs.get(f"{name}, repaired") or runs.get(f"{name}, repaired, cut")
        wrap = runs.get(f"{name}, wrap")
        far = ["", ""]
        if wrap and "wrap_voxel" in wrap:
            far = [f"{wrap[way][0]:.2f}, {wrap[way][1]:.2f}" for way in ("input_to_wrap", "wrap_to_input")]
        shells.append([name, str(looked.get("triangles", "")), diagnosis(looked),
                       *shell_cells(runs.get(f"{name}, plain"), "refused"),
                       *shell_cells(mended, "" if looked.get("usable") else "not usable"),
                       *shell_cells(wrap, "refused"), *far])
        repairs.append([name, repair_cell(runs, name)])
    return shells, repairs


def sound(done):
    return bool(done) and done["exit"] == 0 and done.get("certified") and not done.get("in_several")


def summary(runs, names):
    seen = [name for name in names if f"{name}, inspect" in runs]
    ways = ("plain", "repaired", "repaired, cut", "wrap")
    without = [name for name in seen if not any(sound(runs.get(f"{name}, {way}")) for way in ways)]
    silent = [key for key, done in runs.items() if done["exit"] not in (0, 4, 7) or
              (done["exit"] in (4, 7) and not done["message"] and "findings" not in done)]
    return [f"{len(seen)} meshes; {len(seen) - len(without)} end in a certified shell on at least one way"
            + (f", all but {', '.join(without)}" if without else "") + ". "
            + (f"Silence or a crash: {', '.join(silent)}." if silent else "None ends in silence or a crash.")
            + f" {sum(done['seconds'] for done in runs.values()) / 60:.0f} CPU minutes in all.", ""]


def write_page(page, runs, names):
    shells, repairs = rows_of(runs, names)
    head = ["mesh", "triangles", "diagnosis", "plain", "fill", "s", "`--repair`", "fill", "s", "`--wrap`", "fill", "s",
            "input to wrap: mean, max", "wrap to input: mean, max"]
    replace_tables(page, summary(runs, names) + table(head, shells) + ["", "### What `--repair` did", ""]
                   + table(["mesh", "changes, and triangles kept bit for bit"], repairs))


def main():
    options = arguments(__doc__)
    results = Results(options.results)
    paths = sorted(options.folder.glob("*/*.obj"), key=lambda path: (path.parent.name != "paper", path.stat().st_size))
    names = [f"{path.parent.name}/{path.stem}" for path in paths]

    def finish(name, way, job, mesh):
        key = f"{name}, {way}"
        if key not in results.runs:
            done = job(options.command, mesh)
            results.keep(key, done)
            print(f"{key}: exit {done['exit']}, {done['seconds']:.1f} s {done['message'][:80]}", flush=True)
            write_page(options.page, results.runs, names)
        return results.runs[key]

    for name in sorted(names, key=lambda name: (options.folder / f"{name}.obj").stat().st_size):
        mesh = options.folder / f"{name}.obj"
        looked = finish(name, "inspect", inspect, mesh)
        if "usable" not in looked or (options.quick and looked["triangles"] > QUICK_TRIANGLES):
            continue
        for way, job in jobs_of(name, looked):
            if needed(way, results.runs, name):
                finish(name, way, job, mesh)
    write_page(options.page, results.runs, names)


if __name__ == "__main__":
    main()
