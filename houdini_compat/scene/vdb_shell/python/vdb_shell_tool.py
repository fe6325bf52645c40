# SPDX-License-Identifier: Apache-2.0
"""Runs vdb_shell from Python: options, command line, files, errors. Nothing here needs Houdini.

What is called `geometry` only has to have saveToFile, loadFromFile and merge, as hou.Geometry has.
The program is `vdb_shell` on the PATH, or what VDB_SHELL_COMMAND names.

    python vdb_shell_tool.py work-item --index 2 --count 5 --from 0.05 --to 0.4 MESH FOLDER
    python vdb_shell_tool.py farm-item --index 2 JOB        a task of what `vdb_shell farm --engine tops` wrote
    python vdb_shell_tool.py farm-item --join JOB           what all of them have left
"""

import argparse
import collections
import functools
import json
import os
import subprocess
import sys
import tempfile
import time
import warnings

# kind: int, float, flag, menu, text. `unset` is the value that stands for none at all, which the
# command then gets no option for. `group` is the folder it stands in.
Parameter = collections.namedtuple("Parameter", "name label kind default choices flag negation help group low unset")

RESULT = Parameter("result", "Result", "menu", "shell", ("shell", "volumes", "both"), None, None,
                   "Tetrahedra and surfaces, the level set and depth volumes, or both", "Result", None, None)
KINDS = {"flag": "flag", "integer": "int", "unsigned": "int", "number": "float", "choice": "menu", "text": "text"}

# Houdini's own format keeps its orientation and every bit; text formats would round.
MESH_EXTENSION = ".bgeo.sc"
EXTENSIONS = {"shell": (".bgeo.sc",), "volumes": (".vdb",), "both": (".bgeo.sc", ".vdb")}


class ShellError(Exception):
    """The program refused or failed; the message is its own last line."""

    def __init__(self, message, status=None):
        super().__init__(message)
        self.status = status


class ShellWarning(UserWarning):
    """All was written, but a bound that was wanted was not met."""


def program():
    return os.environ.get("VDB_SHELL_COMMAND", "vdb_shell")


@functools.lru_cache(maxsize=None)
def schema():
    """What the program says of its options, once a session."""
    try:
        return json.loads(subprocess.run([program(), "options", "--json"], capture_output=True, check=True).stdout)
    except (OSError, subprocess.CalledProcessError, ValueError) as error:
        raise ShellError(f"{program()} does not tell its options: {error}") from error


def is_possible(option, value):
    limits = option["range"]
    return (limits.get("at_least", value) <= value <= limits.get("at_most", value)
            and not value <= limits.get("above", value - 1) and not value >= limits.get("below", value + 1))


def parameter_of(option):
    name = option["flag"].lstrip("-").replace("-", "_")
    kind, default, low, unset = KINDS[option["type"]], option["default"], None, None
    if kind in ("int", "float"):
        number = {"int": int, "float": float}[kind]
        limits = option["range"]
        low = limits.get("at_least", limits.get("above", 0 if option["type"] == "unsigned" else None))
        if option["may_be_unset"]:
            # Houdini's numbers cannot be empty: the first that is impossible means none.
            low = unset = number(-1 if is_possible(option, 0) else 0)
        default = unset if default is None else number(default)
        low = None if low is None else number(low)
    if kind == "text":
        default = default or ""
    return Parameter(name, name.replace("_", " ").title(), kind, default,
                     tuple(option["choices"]) or None, option["flag"], option["negation"], option["help"],
                     option["group"], low, unset)


@functools.lru_cache(maxsize=None)
def parameters():
    """All that a shell can be asked for: what `build` knows but for its files, which the node has itself."""
    options = schema()["commands"]["build"]["options"]
    return (RESULT, *(parameter_of(option) for option in options
                      if option["flag"] and (option["group"] != "Output" or option["flag"] == "--half")
                      and option["group"] != "Options"))


def defaults():
    return {parameter.name: parameter.default for parameter in parameters()}


def option_words(values):
    """The options that are not at their defaults, as words of the command line."""
    if not values:
        return []
    unknown = set(values) - {parameter.name for parameter in parameters()}
    if unknown:
        raise ValueError(f"no such parameters: {', '.join(sorted(unknown))}")
    words = []
    for parameter in parameters():
        value = values.get(parameter.name, parameter.default)
        if parameter.kind == "menu" and value not in parameter.choices:
            raise ValueError(f"{parameter.name} is {value!r}, expected one of {parameter.choices}")
        if parameter.flag is None or value == parameter.default or value == parameter.unset:
            continue
        if parameter.kind == "flag":
            words.append(parameter.flag if value else parameter.negation)
        else:
            words += [parameter.flag, repr(value) if parameter.kind == "float" else str(value)]
    return words


def command_line(mesh, outputs, values, report=None):
    """The whole command as a list of words, safe for any file name."""
    words = [program(), "build", "--quiet", *option_words(values)]
    for output in outputs:
        words += ["--output", os.path.abspath(output)]
    if report:
        words += ["--report", os.path.abspath(report)]
    # An absolute path does not begin with a dash.
    return [*words, os.path.abspath(mesh)]


def run(words, poll=None):
    """Runs a command to its end. `poll` is called now and then; what it raises ends the command."""
    with tempfile.TemporaryFile() as errors:
        try:
            process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=errors)
        except OSError as error:
            raise ShellError(f"{words[0]} cannot be started: {error.strerror}") from error
        try:
            while process.poll() is None:
                if poll:
                    poll()
                time.sleep(0.02)
        finally:
            if process.poll() is None:
                process.terminate()
                process.wait()
        errors.seek(0)
        lines = errors.read().decode(errors="replace").strip().splitlines()
    # 6: all was written, but a bound that was wanted was not met; 7: all was written, but the shell is not valid, as one of the
    # raw method may be. The report says so, which the program itself does not when it is quiet.
    if process.returncode not in (0, 6, 7):
        said = lines[-1] if lines else f"it ended with status {process.returncode}"
        raise ShellError(said, process.returncode)


def build(mesh, outputs, values, poll=None):
    """Builds and returns the report's figures. Bounds that were wanted and not met are told by a ShellWarning."""
    with tempfile.TemporaryDirectory(prefix="vdb_shell_") as folder:
        report = os.path.join(folder, "report.json")
        run(command_line(mesh, outputs, values, report), poll)
        with open(report, encoding="utf-8") as file:
            figures = json.load(file)
    missed = missed_bounds(figures)
    if missed:
        warnings.warn(f"{os.path.basename(mesh)}: {missed}", ShellWarning, stacklevel=2)
    return figures


def missed_bounds(report):
    """Each bound that was wanted and not met, in words."""
    return ", ".join(f"wanted {bound['bound']} {bound['asked']:.6g}, reached {bound['reached']:.6g}"
                     for bound in (report.get("wanted") or {}).get("bounds", []) if not bound["met"])


def replace_by_shell(geometry, values, new_geometry, poll=None):
    """Puts the shell of `geometry` in its place; new_geometry() makes an empty one to load into.

    Nothing is changed when the program fails."""
    with tempfile.TemporaryDirectory(prefix="vdb_shell_") as folder:
        mesh = os.path.join(folder, "mesh" + MESH_EXTENSION)
        geometry.saveToFile(mesh)
        result = values.get("result", "shell")
        if result not in EXTENSIONS:
            raise ValueError(f"result is {result!r}, expected one of {tuple(EXTENSIONS)}")
        outputs = [os.path.join(folder, "shell" + extension) for extension in EXTENSIONS[result]]
        report = build(mesh, outputs, values, poll)
        geometry.loadFromFile(outputs[0])
        for output in outputs[1:]:
            more = new_geometry()
            more.loadFromFile(output)
            geometry.merge(more)
        return report


def summary(report):
    """One line for a node's comment or a log."""
    certificate = report.get("certificate", {})
    parts = [f"{report['tets']['tets']} tets", f"{report['volume']['fill']:.1%} of the solid",
             "certified" if certificate.get("certified") else "not certified", missed_bounds(report)]
    return ", ".join(part for part in parts if part)


def thickness_of(index, count, low, high):
    return low if count < 2 else low + (high - low) * index / (count - 1)


def work_item(arguments):
    """One thickness of several; the output's name has the index."""
    if not 0 <= arguments.index < arguments.count:
        raise ValueError(f"index {arguments.index} is not in 0 to {arguments.count - 1}")
    thickness = thickness_of(arguments.index, arguments.count, arguments.low, arguments.high)
    os.makedirs(arguments.folder, exist_ok=True)
    output = os.path.join(arguments.folder, f"shell.{arguments.index:04d}{arguments.extension}")
    report = build(arguments.mesh, [output], {"thickness": thickness, "resolution": arguments.resolution})
    print(f"{output}: thickness {thickness:.6g}, {summary(report)}")


def farm_list(path):
    """What `vdb_shell farm --engine tops` wrote."""
    with open(path, encoding="utf-8") as file:
        job = json.load(file)
    if job.get("schema") != 1:
        raise ValueError(f"{path}: schema is {job.get('schema')}, must be 1")
    return job


def farm_item(arguments):
    """Runs the commands of a task, or those that join, and says as they say: the first status that is not 0."""
    job = farm_list(arguments.job)
    if not arguments.join and not 0 <= arguments.index < len(job["tasks"]):
        raise ValueError(f"index {arguments.index} is not in 0 to {len(job['tasks']) - 1}")
    os.makedirs(job["folder"], exist_ok=True)
    first = 0
    for name, *words in job["join"] if arguments.join else job["tasks"][arguments.index]:
        status = subprocess.run([program() if name == "vdb_shell" else name, *words], cwd=job["home"]).returncode
        first = first or status
    # A signal is told as a shell tells it.
    return 128 - first if first < 0 else first


def main(words=None):
    parser = argparse.ArgumentParser(prog="vdb_shell_tool.py")
    commands = parser.add_subparsers(required=True)
    farm = commands.add_parser("farm-item", help="a task of a farm")
    which = farm.add_mutually_exclusive_group(required=True)
    which.add_argument("--index", type=int)
    which.add_argument("--join", action="store_true")
    farm.add_argument("job")
    farm.set_defaults(run=farm_item)
    item = commands.add_parser("work-item", help="one thickness of several")
    item.set_defaults(run=work_item)
    item.add_argument("--index", type=int, required=True)
    item.add_argument("--count", type=int, required=True)
    item.add_argument("--from", dest="low", type=float, required=True)
    item.add_argument("--to", dest="high", type=float, required=True)
    item.add_argument("--resolution", type=int, default=256)
    item.add_argument("--extension", default=".bgeo.sc")
    item.add_argument("mesh")
    item.add_argument("folder")
    try:
        arguments = parser.parse_args(words)
        return arguments.run(arguments) or 0
    except (ShellError, ValueError, OSError) as error:
        print(error, file=sys.stderr)
        return getattr(error, "status", None) or 1


if __name__ == "__main__":
    sys.exit(main())
