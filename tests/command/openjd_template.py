# SPDX-License-Identifier: Apache-2.0
"""What a job template of Open Job Description may be, after its specification (2023-09, and TASK_CHUNKING), as far as
ours go: an unknown key is an error here. And a worker that runs one, a task after the other."""
import json
import pathlib
import re
import subprocess

IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,63}\Z")
CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f]")
EXPRESSION = re.compile(r"\{\{\s*([^{}]*?)\s*\}\}")
RANGE = re.compile(r"\s*(-?\d+)\s*(?:-\s*(-?\d+)\s*(?::\s*(-?\d+)\s*)?)?\Z")


class Invalid(Exception):
    pass


def require(holds, text):
    if not holds:
        raise Invalid(text)


def keys(what, at, required, optional=()):
    require(isinstance(what, dict), f"{at} is an object")
    require(set(required) <= set(what), f"{at} has {required}, not only {list(what)}")
    require(set(what) <= {*required, *optional}, f"{at} has no keys but {required} and {optional}: {list(what)}")


def text(value, at, most=None, least=1):
    require(isinstance(value, str) and len(value) >= least and not CONTROL.search(value), f"{at} is text: {value!r}")
    require(most is None or len(value) <= most, f"{at} has at most {most} characters")
    return value


def format_string(value, at, scopes, **limits):
    """Every expression is the dotted name of something known there."""
    text(value, at, **limits)
    for name in EXPRESSION.findall(value):
        require(name in scopes, f"{at}: {name} is one of {sorted(scopes)}")
    rest = EXPRESSION.sub("", value)
    require("{{" not in rest, f"{at}: an expression that does not end")


def range_of(expression):
    """The numbers of an <IntRangeExpr>: increasing, none twice."""
    found = []
    for part in expression.split(","):
        match = RANGE.match(part)
        require(match, f"{part!r} is a range")
        first, last, step = (None if group is None else int(group) for group in match.groups())
        last = first if last is None else last
        step = 1 if step is None else step
        require(step != 0, "a step is not 0")
        found.append(list(range(first, last + (1 if step > 0 else -1), step)))
    spans = sorted((min(f), max(f)) for f in found if f)
    require(all(a[1] < b[0] for a, b in zip(spans, spans[1:])), f"parts of {expression!r} do not overlap")
    return sorted(number for part in found for number in part)


def check_parameter(parameter):
    at = f"parameter {parameter.get('name')}"
    path = parameter.get("type") == "PATH"
    keys(parameter, at, ["name", "type"], ["description", "default", *(["objectType", "dataFlow"] if path else [])])
    require(IDENTIFIER.match(parameter["name"]), f"{at}: an identifier")
    require(parameter["type"] in ("STRING", "PATH"), f"{at}: a type that we use")
    require(len(parameter.get("default", "")) <= 1024, f"{at}: at most 1024 characters")
    if path:
        default = pathlib.PurePath(parameter.get("default", "."))
        require(not default.is_absolute() and ".." not in default.parts, f"{at}: below the template's folder: {default}")
        require(parameter["objectType"] in ("FILE", "DIRECTORY"), f"{at}: {parameter['objectType']}")
        require(parameter["dataFlow"] in ("NONE", "IN", "OUT", "INOUT"), f"{at}: {parameter['dataFlow']}")


def check_action(action, at, scopes):
    keys(action, at, ["command"], ["args", "timeout", "cancelation"])
    format_string(action["command"], at, scopes)
    for argument in action.get("args", []):
        format_string(argument, at, scopes, least=0)
    require(isinstance(action.get("timeout", 1), int) and action.get("timeout", 1) > 0, f"{at}: seconds above 0")
    cancelation = action.get("cancelation", {"mode": "TERMINATE"})
    keys(cancelation, at, ["mode"], ["notifyPeriodInSeconds"])
    require(cancelation["mode"] in ("TERMINATE", "NOTIFY_THEN_TERMINATE"), f"{at}: {cancelation}")
    require(0 < cancelation.get("notifyPeriodInSeconds", 1) <= 600, f"{at}: {cancelation}")


def check_space(space, at, scopes, extensions):
    """Names of the task's parameters."""
    keys(space, at, ["taskParameterDefinitions"], ["combination"])
    require(1 <= len(space["taskParameterDefinitions"]) <= 16, f"{at}: 1 to 16 parameters")
    for parameter in space["taskParameterDefinitions"]:
        chunked = parameter.get("type") == "CHUNK[INT]"
        keys(parameter, at, ["name", "type", "range", *(["chunks"] if chunked else [])])
        require(IDENTIFIER.match(parameter["name"]), f"{at}: an identifier")
        if chunked:
            require("TASK_CHUNKING" in extensions, f"{at}: CHUNK[INT] needs the extension")
            format_string(parameter["range"], at, scopes)
            keys(parameter["chunks"], at, ["defaultTaskCount", "rangeConstraint"], ["targetRuntimeSeconds"])
            require(parameter["chunks"]["defaultTaskCount"] >= 1, f"{at}: chunks of 1 or more")
            require(parameter["chunks"]["rangeConstraint"] in ("CONTIGUOUS", "NONCONTIGUOUS"), f"{at}: {parameter}")
        else:
            require(parameter["type"] == "STRING" and 1 <= len(parameter["range"]) <= 1024, f"{at}: 1 to 1024 strings")
            for value in parameter["range"]:
                format_string(value, at, scopes, most=1024)
    return [parameter["name"] for parameter in space["taskParameterDefinitions"]]


def check_step(step, known, scopes, extensions):
    at = f"step {step.get('name')}"
    keys(step, at, ["name", "script"], ["dependencies", "hostRequirements", "parameterSpace"])
    text(step["name"], at, most=64)
    require(step["name"] not in known, f"{at}: a name of its own")
    for dependency in step.get("dependencies", []):
        keys(dependency, at, ["dependsOn"])
        require(dependency["dependsOn"] in known, f"{at} depends on a step before it: {dependency}")
    require(step.get("dependencies", [1]), f"{at}: dependencies are left out where there are none")
    if "hostRequirements" in step:
        keys(step["hostRequirements"], at, ["amounts"])
        for amount in step["hostRequirements"]["amounts"]:
            keys(amount, at, ["name", "min"])
            require(re.match(r"amount(\.[A-Za-z_]\w*)+\Z", amount["name"]) and amount["min"] > 0, f"{at}: {amount}")
    names = check_space(step["parameterSpace"], at, scopes, extensions) if "parameterSpace" in step else []
    keys(step["script"], at, ["actions"])
    keys(step["script"]["actions"], at, ["onRun"])
    check_action(step["script"]["actions"]["onRun"], at, scopes | {f"Task.Param.{name}" for name in names})


def check(template):
    """Throws Invalid."""
    keys(template, "the template", ["specificationVersion", "name", "steps"],
         ["extensions", "description", "parameterDefinitions", "jobEnvironments"])
    require(template["specificationVersion"] == "jobtemplate-2023-09", template["specificationVersion"])
    text(template.get("description", "x"), "the description", most=2048)
    extensions = template.get("extensions", [])
    require(extensions in ([], ["TASK_CHUNKING"]), f"extensions: {extensions}")
    parameters = template.get("parameterDefinitions", [])
    require(len(parameters) <= 50, "at most 50 parameters")
    for parameter in parameters:
        check_parameter(parameter)
    names = [parameter["name"] for parameter in parameters]
    require(len(set(names)) == len(names), f"each parameter has a name of its own: {names}")
    scopes = {f"{kind}.{name}" for name in names for kind in ("Param", "RawParam")}
    format_string(template["name"], "the name", {scope for scope in scopes}, most=128)
    for environment in template.get("jobEnvironments", []):
        keys(environment, "environment", ["name", "script"])
        keys(environment["script"], "environment", ["actions"])
        keys(environment["script"]["actions"], "environment", ["onEnter"], ["onExit"])
        for action in environment["script"]["actions"].values():
            check_action(action, "environment", scopes | {"Session.WorkingDirectory"})
    known = set()
    require(template["steps"], "a template has steps")
    for step in template["steps"]:
        check_step(step, known, scopes, extensions)
        known.add(step["name"])


def tasks_of(step, resolve):
    """The values of the only parameter, or one task without."""
    if "parameterSpace" not in step:
        return [{}]
    parameter, = step["parameterSpace"]["taskParameterDefinitions"]
    name = "Task.Param." + parameter["name"]
    if parameter["type"] == "STRING":
        return [{name: resolve(value)} for value in parameter["range"]]
    numbers, size = range_of(resolve(parameter["range"])), parameter["chunks"]["defaultTaskCount"]
    chunks = [numbers[begin:begin + size] for begin in range(0, len(numbers), size)]
    return [{name: ",".join(str(number) for number in chunk)} for chunk in chunks]


def run(template, home, session, **values):
    """`home`: the folder of the template. Every task in a folder of its own; (step, status, what it said) for each. A step is left out where one that it
    depends on has failed."""
    known = {}
    for p in template["parameterDefinitions"]:
        value = values.get(p["name"], p.get("default"))
        known["Param." + p["name"]] = str(pathlib.Path(home) / value) if p["type"] == "PATH" else value
    done, failed = [], set()

    def act(action, more):
        def resolve(value):
            return EXPRESSION.sub(lambda match: {**known, **more}[match.group(1)], value)
        folder = pathlib.Path(session) / str(len(done))
        folder.mkdir(parents=True)
        ended = subprocess.run([resolve(action["command"]), *map(resolve, action.get("args", []))], cwd=folder,
                               capture_output=True, text=True, timeout=action.get("timeout"))
        return ended.returncode, ended.stdout + ended.stderr

    for environment in template.get("jobEnvironments", []):
        done.append((environment["name"], *act(environment["script"]["actions"]["onEnter"], {})))
    for step in template["steps"]:
        if any(dependency["dependsOn"] in failed for dependency in step.get("dependencies", [])):
            failed.add(step["name"])
            continue
        for task in tasks_of(step, lambda value: EXPRESSION.sub(lambda m: known[m.group(1)], value)):
            done.append((step["name"], *act(step["script"]["actions"]["onRun"], task)))
            if done[-1][1] != 0:
                failed.add(step["name"])
    return done


def load(path):
    return json.loads(pathlib.Path(path).read_text())
