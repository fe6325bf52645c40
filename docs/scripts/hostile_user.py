#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tries again, with the command itself, everything that a hostile user once found, and writes what happens now into
docs/reliability.md.

    hostile_user.py COMMAND MESH docs/reliability.md

MESH: a small closed .obj, for instance samples/meshes/box.obj. Each try gives a sentence of what was seen; where that is not
what is promised, the sentence begins with WRONG, and the status is 1. Works in a folder of its own; nothing else is touched.
"""
import argparse
import json
import os
import pathlib
import random
import re
import resource
import signal
import stat
import struct
import subprocess
import sys
import tempfile
import threading
import time

from runs import replace_tables, table

FLIPS, SPOILED = 200, 50
SMALL = ["--resolution", "12", "--samples", "0", "-q"]


class Bench:
    """A folder with the mesh, and the command to be run in it."""

    def __init__(self, command, mesh, folder):
        self.command, self.folder = str(pathlib.Path(command).resolve()), pathlib.Path(folder)
        self.mesh = pathlib.Path(mesh).read_text()
        self.wrong = False

    def clear(self):
        for file in self.folder.iterdir():
            file.unlink()
        (self.folder / "b.obj").write_text(self.mesh)

    def run(self, line, **more):
        words = line.split() if isinstance(line, str) else line
        return subprocess.run([self.command, *words], cwd=self.folder, timeout=600,
                              **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **more})

    def build(self, outputs, **more):
        return self.run(["build", "b.obj", *SMALL, *outputs.split()], **more)

    def path(self, name):
        return self.folder / name

    def names(self):
        return sorted(file.name for file in self.folder.iterdir())

    def say(self, right, text):
        self.wrong |= not right
        return text if right else "WRONG: " + text


def refused(bench, line, keep=(), status=2, build=True):
    """The call is refused with that status, files named in keep stay as they are, and there are no new ones."""
    before = {name: bench.path(name).read_bytes() for name in keep}
    names = bench.names()
    done = bench.build(line) if build else bench.run(line)
    same = all(bench.path(name).read_bytes() == data for name, data in before.items()) and bench.names() == names
    return bench.say(done.returncode == status and same,
                     f"`{line}`: {done.returncode}" + (", all files as before" if same else ", FILES CHANGED"))


def outputs_over_inputs(bench):
    bench.clear()
    bench.build("-o h.vdb --points beside")
    bench.build("-o g.vdb")
    return [refused(bench, "-o a.vtu --report b.obj", ["b.obj"]),
            refused(bench, "--thickness-grid g.vdb:depth -o g.vdb", ["g.vdb"]),
            refused(bench, "convert h.vdb -o h.points.vdb", ["h.vdb", "h.points.vdb"], build=False),
            refused(bench, "-o a.vdb -o ./a.vdb"), refused(bench, "-o a.vtu --report a.vtu"),
            refused(bench, "--points beside -o k.vdb -o k.points.vdb")]


def devices(bench):
    bench.clear()
    said = []
    os.mkfifo(bench.path("pipe"))
    read = []
    reader = threading.Thread(target=lambda: read.append(bench.path("pipe").read_bytes()), daemon=True)
    reader.start()
    done = bench.build("--report pipe")
    reader.join(60)
    fifo = stat.S_ISFIFO(bench.path("pipe").lstat().st_mode)
    said.append(bench.say(done.returncode == 0 and fifo and read and json.loads(read[0]), "a fifo gets the report and stays a fifo"))
    if os.geteuid() == 0:
        os.mknod(bench.path("null"), stat.S_IFCHR | 0o666, os.makedev(1, 3))
        done = bench.build("--report null")
        said.append(bench.say(done.returncode == 0 and stat.S_ISCHR(bench.path("null").lstat().st_mode),
                              "a character device, as superuser, stays one"))
    names = bench.names()
    done = bench.build("--report -")
    said.append(bench.say(done.returncode == 0 and json.loads(done.stdout) and bench.names() == names,
                          "`--report -`: JSON on standard output, no new file"))
    return said


def temporaries(bench):
    bench.clear()
    seen = set()
    for _ in range(2):
        process = subprocess.Popen([bench.command, "build", "b.obj", "-q", "--resolution", "60", "-o", "a.vdb", "-o", "a.vtu", "-o", "a.bgeo"],
                                   cwd=bench.folder, stderr=subprocess.DEVNULL)
        while process.poll() is None:
            seen |= {name for name in os.listdir(bench.folder) if name.startswith(".")}
    fits = all(re.fullmatch(r"\.vdb_shell-[0-9a-f]{24}(\.\w+)*", name) for name in seen)
    return [bench.say(fits and len(seen) > 1, f"names seen during two runs: {len(seen)}, all different, all 24 random digits")]


def damaged(bench, change, count, lines, wanted):
    """Copies of a .vdb, each changed, given to the lines of the command: counts of their answers."""
    bench.clear()
    bench.build("-o s.vdb")
    sound = bench.path("s.vdb").read_bytes()
    chance, counts = random.Random(1), {"refused": 0, "passed": 0, "crashed": 0}
    for _ in range(count):
        data = bytearray(sound)
        while data == sound:
            change(data, chance)
        bench.path("d.vdb").write_bytes(data)
        for line in lines:
            status = bench.run(line).returncode
            counts["crashed" if status < 0 or status > 128 else "refused" if status else "passed"] += 1
    return bench.say(wanted(counts), f"{count} files, {', '.join(f'`{line}`' for line in lines)}: " +
                     ", ".join(f"{value} {name}" for name, value in counts.items()))


def flip(data, chance):
    data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)


def spoil(data, chance):
    for _ in range(chance.randint(1, 8)):
        at = chance.randrange(len(data))
        data[at:at + 4] = struct.pack("<I", chance.choice([0, 1, 0x7fffffff, 0xffffffff, chance.getrandbits(32)]))[:len(data) - at]


def flipped(bench):
    return [damaged(bench, flip, FLIPS, ["check d.vdb"], lambda n: n["passed"] == n["crashed"] == 0)]


def spoiled(bench):
    lines = ["info d.vdb", "check d.vdb", "convert d.vdb -o d.vtu", "build d.vdb:surface --resolution 12 -o e.vdb"]
    return [damaged(bench, spoil, SPOILED, lines, lambda n: n["crashed"] == 0 and n["refused"] > 0)]


def byte_order_mark(bench):
    bench.clear()
    bench.path("m.obj").write_bytes(b"\xef\xbb\xbf" + bench.mesh.encode())
    plain, marked = (bench.run(f"inspect {name}").stdout.split(b"\n", 1)[1] for name in ("b.obj", "m.obj"))
    return [bench.say(plain == marked, "`inspect` says the same of the file with the mark as of the one without")]


def repeats(bench):
    bench.clear()
    said = []
    last = bench.mesh.rstrip().splitlines()[-1]
    seconds = []
    for n in (10000, 20000, 40000):
        bench.path("r.obj").write_text(bench.mesh + "\n" + (last + "\n") * n)
        before = os.times()
        bench.run(["build", "r.obj", *SMALL, "--repair", "-o", "r.vdb"])
        after = os.times()
        seconds.append(after.children_user + after.children_system - before.children_user - before.children_system)
    said.append(bench.say(seconds[-1] < 4 * seconds[0] + 1, "the same triangle 10, 20, 40 thousand times, `build --repair`: "
                          + ", ".join(f"{s:.1f}" for s in seconds) + " s of the processor"))
    process = subprocess.Popen([bench.command, "build", "r.obj", "--resolution", "600", "--repair", "--progress", "-o", "r.vdb"],
                               cwd=bench.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    process.stderr.readline()
    process.send_signal(signal.SIGINT)
    began = time.monotonic()
    status = process.wait(60)
    said.append(bench.say(status == 130, f"SIGINT in the middle of it: {status} after {time.monotonic() - began:.2f} s"))
    return said


def full_output(bench):
    bench.clear()
    bench.build("-o s.vdb")
    said = []
    for line in (f"build b.obj {' '.join(SMALL[:-1])} -o t.vdb", "inspect b.obj", "info s.vdb", "check s.vdb", "--help"):
        with open("/dev/full", "w") as full:
            said.append((line.split()[0], bench.run(line, stdout=full).returncode))
    return [bench.say(all(status == 5 for _, status in said), "`> /dev/full`: " + ", ".join(f"{name} {status}" for name, status in said))]


def together(bench):
    bench.clear()
    said = [refused(bench, "-o a.vdb -o missing/a.vtu", status=5)]
    bench.path("m.vdb").write_text("old")
    bench.path("m.vdb").chmod(0o600)
    bench.build("-o m.vdb")
    mode = stat.S_IMODE(bench.path("m.vdb").stat().st_mode)
    said.append(bench.say(mode == 0o600 and bench.path("m.vdb").read_bytes() != b"old", f"a replaced file of mode 600 has {mode:o}"))
    bench.path("r.vdb").write_text("old")
    bench.path("r.vdb").chmod(0o444)
    said.append("a read-only file: " + refused(bench, "-o r.vdb", ["r.vdb"], status=5))
    os.symlink("m.vdb", bench.path("l.vdb"))
    bench.path("m.vdb").write_text("old")
    bench.build("-o l.vdb")
    said.append(bench.say(bench.path("l.vdb").is_symlink() and bench.path("m.vdb").read_bytes() != b"old",
                          "a link stays, and the file that it leads to is new"))
    return said


def limits(bench):
    bench.clear()
    names = bench.names()

    def limited(what, value):
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
            resource.setrlimit(what, (value, value))
        return limit

    memory = bench.run("build b.obj --resolution 1000 -q -o a.vdb", preexec_fn=limited(resource.RLIMIT_AS, 500 << 20))
    said = [bench.say(memory.returncode == 9 and b"memory" in memory.stderr and bench.names() == names,
                      f"500 MB of addresses: {memory.returncode}, \"{memory.stderr.decode().strip().split(': ')[-1]}\"")]
    size = bench.build("-o a.vdb", preexec_fn=limited(resource.RLIMIT_FSIZE, 8192))
    said.append(bench.say(size.returncode == 5 and bench.names() == names, f"files of 8 kB at most: {size.returncode}, nothing left over"))
    process = subprocess.Popen([bench.command, "build", "b.obj", "--resolution", "600", "--progress", "-o", "a.vdb"],
                               cwd=bench.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL))
    process.stderr.readline()
    process.send_signal(signal.SIGHUP)
    status = process.wait(60)
    said.append(bench.say(status == 129 and bench.names() == names, f"SIGHUP: {status}, nothing left over"))
    return said


def without_tets(bench):
    bench.clear()
    said = [refused(bench, line + " -o a.vdb", status=4)
            for line in ("--thickness 1e-308", "--thickness-scale 1e-308", "--method raw --step 1e308")]
    done = bench.build("--layers 64 --layer-grading 2 -o a.vtu --report -")
    empty = json.loads(done.stdout)["cut"]["empty_layers"]
    return said + [bench.say(done.returncode == 0 and empty > 0, f"`--layers 64 --layer-grading 2`: the report has {empty} empty layers")]


def options(bench):
    bench.clear()
    said = [refused(bench, line + " -o a.vtu") for line in ("--samples -1", "--samples-seed -1", "--decimate-to -1")]
    return said + [refused(bench, line) for line in ("--half -o a.vtu", "--wrap-sheet 2 -o a.vtu", "--core stitched -o a.vtu",
                                                           "--contour-adaptivity 1 -o a.vtu")]


def file_names(bench):
    bench.clear()
    name = os.fsencode(bench.folder) + b"/\xe9.obj"
    with open(name, "w") as file:
        file.write(bench.mesh)
    done = subprocess.run([bench.command.encode(), b"build", name, *(word.encode() for word in SMALL), b"--report", b"-", b"-o", b"l.usda"],
                          cwd=bench.folder, capture_output=True, check=False)
    json.loads(done.stdout.decode("utf-8"))
    bench.path("l.usda").read_text("utf-8")
    os.unlink(name)
    return [bench.say(done.returncode == 0, "a Latin-1 name: the report is UTF-8 and JSON, and the .usda is UTF-8")]


def forms_of_files(bench):
    bench.clear()
    faces = [line for line in bench.mesh.splitlines() if line.startswith("f ")]
    said = []

    def inspected(text):
        bench.path("x.obj").write_text(text)
        return bench.run("inspect x.obj")

    plain = bench.run("inspect b.obj").stdout.split(b"\n", 1)[1]
    upper = inspected(bench.mesh.replace("f ", "F ", 1))
    said.append(bench.say(upper.returncode == 3, f"`F` for `f`: {upper.returncode}"))
    old = inspected(bench.mesh.replace(faces[0], "fo" + faces[0][1:], 1))
    said.append(bench.say(old.stdout.split(b"\n", 1)[1] == plain, "`fo`: read as a face"))
    comment = inspected(re.sub(r"^(v .*)$", r"\1#c", bench.mesh, flags=re.M))
    said.append(bench.say(comment.stdout.split(b"\n", 1)[1] == plain, "`v 0 0 0#c`: read"))
    triangle = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    bench.path("x.stl").write_bytes(b"\0" * 80 + struct.pack("<I", 4) + triangle * 4 + b"more")
    done = bench.run("inspect x.stl")
    said.append(bench.say(done.returncode == 3 and b"facet" in done.stderr.lower(),
                          f"binary STL with bytes behind it: {done.returncode}, by its counts"))
    return said


ROWS = [
    ("an output overwrites an input, or another output", outputs_over_inputs, "`command.FilePlans.NoOutputDestroysAnInputOrAnotherOutput`"),
    ("a device or fifo given as output is replaced; `--report -` writes a file named `-`", devices,
     "`DevicesAndFifosAreWrittenInto`, `AReportGoesToStandardOutput`"),
    ("the temporary file's name can be foretold, and is opened through a link that somebody left there", temporaries, "`core.OutputSets`"),
    ("`check` passes .vdb files in which single bits were flipped", flipped,
     "`command.flipped_bits`, `io.VdbSeal`, `write.FileDigests`, `write.VdbDamage`"),
    ("heap corruption on damaged .vdb", spoiled, "`io.VdbHeader`, `command.flipped_bits`, fuzzer `vdb`"),
    ("a byte-order mark makes the OBJ reader drop the first vertex", byte_order_mark, "`skips_a_byte_order_mark`"),
    ("repeated faces cost quadratic time, during which signals are ignored", repeats, "`repair.RepairCost`, `command.faults`"),
    ("standard output that fails is exit 0", full_output, "`StandardOutputThatFailsIsAnError`"),
    ("outputs of one call are not all or nothing; a replaced file loses its mode, a read-only file is replaced, a link is replaced", together,
     "`command.faults`, `AReadOnlyFileIsRefusedAndAModeKept`, `core.OutputSets`"),
    ("out of memory: exit 1, `std::bad_alloc`; SIGXFSZ: exit 153 with a file left over; SIGHUP: leftovers", limits,
     "`command.faults`, `ALimitOnTheSizeOfFilesIsAWriteError`"),
    ("a shell without a tet is a success; empty layers without a word", without_tets,
     "`AShellWithoutATetOrNotValidIsNoSuccess`, `CutLayers.LayersThinnerThanFloatsAreCountedAsEmpty`"),
    ("unsigned options take -1; options without their partner are accepted", options,
     "`UnsignedOptionsAreNotNegative`, `Options.OnesWithoutTheirPartnerAreRefused`"),
    ("names in Latin-1 make .usda and JSON invalid", file_names, "`NamesThatAreNoUtf8LeaveValidFilesOrAreRefused`"),
    ("upper-case keywords of OBJ, `fo`, `0 0#c`, binary STL with bytes behind it: refused or dropped", forms_of_files,
     "`loses_no_statement_of_obj_that_makes_a_surface`, `a_comment_of_obj_may_touch_the_value_before_it`, "
     "`refuses_bytes_behind_the_facets_of_binary_stl`"),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("mesh")
    parser.add_argument("page", type=pathlib.Path)
    given = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(given.command, given.mesh, folder)
        for then, walk, tests in ROWS:
            said = walk(bench)
            print(then, *said, sep="\n    ", flush=True)
            rows.append([then, "; ".join(said), tests])
    replace_tables(given.page, table(["then", "tried again, and what happens (numbers behind a colon: exit status)", "test"], rows), "hostile")
    return 1 if bench.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
