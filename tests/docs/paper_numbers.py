#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The numbers and tables of docs/paper are those of the files that docs/scripts/paper.py wrote.

    paper_numbers.py PROJECT_FOLDER
"""
import pathlib
import sys


def main():
    root = pathlib.Path(sys.argv[1])
    sys.path.insert(0, str(root / "docs" / "scripts"))
    from paper_pages import NUMBER, TABLE, load, rendered

    # The comparison itself: a changed digit has to show, and a number that no file has.
    data = {"file": {"a": {"b": 1.26}, "tables": {"t": {"head": ["x"], "rows": [["1"]]}}}}
    right = "<!--= file a/b .1f -->1.3<!--=-->"
    assert rendered(right, data) == right and rendered(right.replace("1.3", "1.2"), data) != right.replace("1.3", "1.2")
    spaced = {"file": {"tentacle, 70 degrees": {"gone": 9}, "tables": {}}}
    assert rendered("<!--= file tentacle, 70 degrees/gone d -->8<!--=-->", spaced) == "<!--= file tentacle, 70 degrees/gone d -->9<!--=-->"
    wrong_table = "<!-- table file t: begin -->\n\n| x |\n| --- |\n| 2 |\n\n<!-- table file t: end -->"
    assert rendered(wrong_table, data) == wrong_table.replace("2", "1")
    try:
        rendered("<!--= file a/c .1f -->1.3<!--=-->", data)
        raise AssertionError("a number that is in no file was accepted")
    except KeyError:
        pass

    data, faults, numbers, tables = load(root / "docs" / "paper"), [], 0, 0
    for page in sorted((root / "docs" / "paper").glob("*.md")):
        text = page.read_text()
        numbers += len(NUMBER.findall(text))
        tables += len(TABLE.findall(text))
        if text.count("<!--= ") != len(NUMBER.findall(text)) or text.count("<!-- table") != 2 * len(TABLE.findall(text)):
            faults.append(f"{page.name}: a mark without its end")
        wanted = rendered(text, data)
        faults += [f"{page.name}: {old}\n  the file says: {new}"
                   for old, new in zip(text.splitlines(), wanted.splitlines()) if old != new]
        if len(text.splitlines()) != len(wanted.splitlines()):
            faults.append(f"{page.name}: a table has other rows than its file")
    print(f"{numbers} numbers and {tables} tables of docs/paper compared with {len(data)} files")
    print("\n".join(faults))
    return 1 if faults or not numbers else 0


if __name__ == "__main__":
    sys.exit(main())
