# SPDX-License-Identifier: Apache-2.0
"""Holds the pages of docs/paper to the files beside them: numbers and tables between marks are those of the files.

A number is <!--= FILE KEY/KEY/... FORMAT -->text<!--=-->, with FILE.json beside the page (or "total" or "shape", see load()) and
FORMAT as Python's format() has it. A table is what stands between <!-- table FILE NAME: begin --> and <!-- table FILE NAME: end -->. Standard library only.
"""
import json
import re

NUMBER = re.compile(r"<!--= (\S+) (.+?) (\S+) -->(.*?)<!--=-->")  # a key may have spaces: names of situations
TABLE = re.compile(r"(<!-- table (\S+) (\S+): begin -->\n).*?(<!-- table \2 \3: end -->)", re.S)


def load(folder):
    """The files beside the pages; "total": their seconds summed; "shape": means of ../measurements/shape.json."""
    data = {file.stem: json.loads(file.read_text()) for file in sorted(folder.glob("*.json"))}
    shape = folder.parent / "measurements" / "shape.json"
    minutes = {f"{clock}_minutes": sum(part.get(f"{clock}_seconds", 0) for part in data.values()) / 60 for clock in ("wall", "processor")}
    return data | {"total": minutes} | ({"shape": shape_means(json.loads(shape.read_text()))} if shape.exists() else {})


def shape_means(rows):
    """way -> half, or "all" -> mean tets a triangle, over the meshes that the way made. The file is shape_figures.py's."""
    answer = {}
    for row in rows:
        if row.get("tets"):
            for half in (row["half"], "all"):
                answer.setdefault(row["way"], {}).setdefault(half, []).append(row["tets_per_triangle"])
    return {way: {half: {"meshes": len(found), "tets_per_triangle": sum(found) / len(found)} for half, found in halves.items()}
            for way, halves in answer.items()}


def value_at(data, name, path):
    """Raises KeyError where the file has no such number."""
    value, keys = data[name], path.split("/")
    while keys:
        # A mesh's name has a slash itself: "paper/cow".
        taken = 2 if "/".join(keys[:2]) in value else 1
        value = value["/".join(keys[:taken])]
        keys = keys[taken:]
    return value


def rendered(text, data):
    """The page with all numbers and tables from the files."""
    def number(found):
        name, path, form, _ = found.groups()
        return f"<!--= {name} {path} {form} -->{value_at(data, name, path):{form}}<!--=-->"

    def table(found):
        about = data[found[2]]["tables"][found[3]]
        rows = [about["head"], ["---"] * len(about["head"]), *about["rows"]]
        return found[1] + "\n" + "\n".join("| " + " | ".join(row) + " |" for row in rows) + "\n\n" + found[4]
    return TABLE.sub(table, NUMBER.sub(number, text))


def write_pages(folder):
    data = load(folder)
    for page in sorted(folder.glob("*.md")):
        page.write_text(rendered(page.read_text(), data))
