#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/schema/report.schema.json from reports of all kinds: those of tests/docs/report_keys.py.

    report_schema.py COMMAND PROJECT

What no report had but null stays open. A test (docs.report_keys) holds reports against what was written, so a key that
comes or goes is noticed; then `schema` in src/report/report.cpp is raised and this is run again.
"""
import json
import pathlib
import sys
import tempfile

project = pathlib.Path(sys.argv[2]).resolve()
sys.path.insert(0, str(project / "tests" / "docs"))
import report_keys  # noqa: E402


def type_of(value):
    for kind, name in ((bool, "boolean"), (int, "integer"), (float, "number"), (str, "string"), (list, "array"),
                       (dict, "object")):
        if isinstance(value, kind):
            return name
    return "null"


def schema_of(values):
    names = sorted({type_of(value) for value in values})
    if names in ([], ["null"]):
        return {}
    if "number" in names and "integer" in names:
        names.remove("integer")
    schema = {"type": names[0] if len(names) == 1 else names}
    objects = [value for value in values if isinstance(value, dict)]
    if objects:
        keys = list(dict.fromkeys(key for value in objects for key in value))
        schema["properties"] = {key: schema_of([v[key] for v in objects if key in v]) for key in keys}
        schema["required"] = [key for key in keys if all(key in value for value in objects)]
        schema["additionalProperties"] = False
    entries = [entry for value in values if isinstance(value, list) for entry in value]
    if entries:
        schema["items"] = schema_of(entries)
    return schema


def add_rare(schema):
    """Puts the keys that only reports of surfaces without use have after those that they are said of."""
    properties = {}
    for key, entry in schema.get("properties", {}).items():
        properties[key] = entry
        if key + "_at_least" in report_keys.RARE:
            properties[key + "_at_least"] = {"const": True}
        add_rare(entry)
    if properties:
        schema["properties"] = properties
    if "items" in schema:
        add_rare(schema["items"])


def lines(value, indent=""):
    """JSON with all that fits on a line on one."""
    short = json.dumps(value)
    if len(indent) + len(short) < 110 or not isinstance(value, dict):
        return short
    inner = indent + " "
    entries = [f"{inner}{json.dumps(key)}: {lines(entry, inner)}" for key, entry in value.items()]
    return "{\n" + ",\n".join(entries) + "\n" + indent + "}"


def main():
    with tempfile.TemporaryDirectory() as folder:
        reports = list(report_keys.reports(pathlib.Path(sys.argv[1]).resolve(), project / "samples" / "meshes",
                                           pathlib.Path(folder)))
    schema = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "Report of vdb_shell build",
              **schema_of(reports)}
    schema["properties"]["schema"] = {"const": reports[0]["schema"]}
    add_rare(schema)
    # In the .vdb the report is without times.
    schema["required"].remove("stages")
    path = project / "docs" / "schema" / "report.schema.json"
    path.write_text(lines(schema) + "\n")


main()
