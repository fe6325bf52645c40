# SPDX-License-Identifier: Apache-2.0
"""Holds JSON against a schema of the few words that docs/schema uses; and against python3-jsonschema too, where it is there."""
try:
    import jsonschema
except ImportError:
    jsonschema = None

TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None)}


def is_of(value, name):
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if name in ("number", "integer"):
        return number and (name == "number" or float(value).is_integer())
    return isinstance(value, TYPES[name])


def faults(value, schema, path="$"):
    """What of the value the schema does not allow, one text each."""
    names = schema.get("type", [])
    names = [names] if isinstance(names, str) else names
    if names and not any(is_of(value, name) for name in names):
        yield f"{path}: is {value!r:.40}, must be {' or '.join(names)}"
        return
    if "const" in schema and value != schema["const"]:
        yield f"{path}: is {value!r}, must be {schema['const']!r}"
    if "enum" in schema and value not in schema["enum"]:
        yield f"{path}: is {value!r}, must be one of {schema['enum']}"
    if isinstance(value, dict):
        known = schema.get("properties", {})
        for key in schema.get("required", []):
            if key not in value:
                yield f"{path}: has no {key}"
        for key, entry in value.items():
            if key in known:
                yield from faults(entry, known[key], f"{path}.{key}")
            elif schema.get("additionalProperties") is False:
                yield f"{path}: has {key}, which the schema does not know"
    if isinstance(value, list) and "items" in schema:
        for i, entry in enumerate(value):
            yield from faults(entry, schema["items"], f"{path}[{i}]")


def all_faults(value, schema):
    found = list(faults(value, schema))
    if jsonschema:
        found += [f"jsonschema: {error.json_path}: {error.message:.80}"
                  for error in jsonschema.Draft202012Validator(schema).iter_errors(value)]
    return found
