#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Decodes Houdini geometry and holds the three forms of it against each other.

    decode_bgeo.py FILE                      the document as JSON
    decode_bgeo.py --same FILE.geo FILE...   every file says exactly what the first says

Written from the published tables of the binary form (docs/houdini.md lists them), and shares
nothing with the library: text is read by Python's json, Blosc chunks by libblosc through ctypes.
Exit status: 0 same, 1 different or damaged, 77 when a .bgeo.sc was asked for and libblosc is not
there.
"""

import ctypes
import ctypes.util
import json
import struct
import sys

FORWARD, BACKWARD = b"\x7fNSJb", b"\x7fbJSN"
NUMBERS = {0x11: "b", 0x12: "h", 0x13: "i", 0x14: "q", 0x21: "B", 0x22: "H", 0x18: "e", 0x19: "f", 0x1A: "d"}
WIDE_LENGTHS = {0xF2: "H", 0xF4: "I", 0xF8: "Q"}


class Damaged(Exception):
    pass


class BinaryJson:
    """Yields the values of a binary document; `order` is the struct module's sign for its bytes."""

    def __init__(self, data):
        if data[:5] not in (FORWARD, BACKWARD):
            raise Damaged(f"begins with {data[:5]!r}")
        self.data, self.at, self.tokens = data, 5, {}
        self.order = "<" if data[:5] == FORWARD else ">"

    def take(self, size):
        if self.at + size > len(self.data):
            raise Damaged(f"{size} bytes wanted at {self.at}, the document has {len(self.data)}")
        piece = self.data[self.at:self.at + size]
        self.at += size
        return piece

    def unpack(self, letter, count=1):
        layout = f"{self.order}{count}{letter}"
        return struct.unpack(layout, self.take(struct.calcsize(layout)))

    def length(self):
        first = self.take(1)[0]
        if first < 0xF1:
            return first
        if first not in WIDE_LENGTHS:
            raise Damaged(f"length of kind {first:#x} at {self.at - 1}")
        return self.unpack(WIDE_LENGTHS[first])[0]

    def text(self):
        return self.take(self.length()).decode()

    def kind(self):
        """The next kind that stands for a value or ends a container."""
        while True:
            kind = self.take(1)[0]
            if kind == 0x2B:
                key = self.length()
                self.tokens[key] = self.text()
            elif kind == 0x2D:
                del self.tokens[self.length()]
            else:
                return kind

    def uniform(self):
        kind, count = self.take(1)[0], self.length()
        if kind == 0x10:
            words = self.unpack("I", (count + 31) // 32)
            return [bool(words[i >> 5] >> (i & 31) & 1) for i in range(count)]
        if kind == 0x27:
            return [self.text() for _ in range(count)]
        return list(self.unpack(NUMBERS[kind], count))

    def value(self, kind):
        if kind in NUMBERS:
            return self.unpack(NUMBERS[kind])[0]
        if kind == 0x5B:
            return list(self.until(0x5D))
        if kind == 0x7B:
            flat = list(self.until(0x7D))
            return dict(zip(flat[0::2], flat[1::2]))
        fixed = {0x00: None, 0x30: False, 0x31: True}
        if kind in fixed:
            return fixed[kind]
        if kind == 0x10:
            return self.take(1) != b"\0"
        if kind == 0x26:
            return self.tokens[self.length()]
        if kind == 0x27:
            return self.text()
        if kind == 0x40:
            return self.uniform()
        raise Damaged(f"unknown kind {kind:#x} at {self.at - 1}")

    def until(self, end):
        kind = self.kind()
        while kind != end:
            yield self.value(kind)
            kind = self.kind()

    def document(self):
        result = self.value(self.kind())
        if self.at != len(self.data):
            raise Damaged(f"{len(self.data) - self.at} bytes after the document")
        return result


def load_blosc():
    name = ctypes.util.find_library("blosc")
    if name is None:
        print("libblosc is not there")
        sys.exit(77)
    return ctypes.CDLL(name)


def unpack_sc(data):
    """Chunks as the index at the file's end tells them."""
    if data[:12] != b"scf1" + bytes(8) or data[-4:] != b"1fcs":
        raise Damaged("no SCF file")
    index_size, = struct.unpack(">Q", data[-12:-4])
    index = data[-12 - index_size:-12]
    *starts, chunk, last = struct.unpack(f">{len(index) // 8}Q", index)
    body = data[12:-12 - index_size]
    bounds = [0, *starts, len(body)]
    blosc, whole = load_blosc(), b""
    for number, (begin, end) in enumerate(zip(bounds, bounds[1:])):
        wanted = last if end == len(body) else chunk
        out = ctypes.create_string_buffer(wanted)
        got = blosc.blosc_decompress_ctx(body[begin:end], out, ctypes.c_size_t(wanted), 1)
        if got != wanted:
            raise Damaged(f"chunk {number} gives {got} bytes, the index says {wanted}")
        whole += out.raw[:wanted]
    return whole


def read(path):
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] == b"scf1":
        data = unpack_sc(data)
    if data[:1] == b"\x7f":
        return BinaryJson(data).document()
    return json.loads(data)


def pairs(flat):
    return dict(zip(flat[0::2], flat[1::2]))


def float32(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def numbers(values, storage):
    convert = {"fpreal32": float32, "fpreal64": float}.get(storage, lambda whole: whole)
    return [convert(value) for value in values]


def column(values, elements):
    """One tuple an element, from any of the ways to store a numeric array."""
    values = pairs(values)
    size, storage = values["size"], values["storage"]
    if "tuples" in values:
        rows = [tuple(row) for row in values["tuples"]]
    elif "arrays" in values:
        rows = list(zip(*values["arrays"]))
    else:
        rows = paged(values, size, elements)
    return [tuple(numbers(row, storage)) for row in rows]


def paged(values, size, elements):
    raw, page_size = iter(values["rawpagedata"]), values["pagesize"]
    packing = values.get("packing", [size])
    constant = values.get("constantpageflags", [[]] * len(packing))
    rows = []
    for page in range(-(-elements // page_size)):
        count = min(page_size, elements - page * page_size)
        parts = []
        for width, flags in zip(packing, constant):
            same = bool(flags) and flags[page]
            stored = [[next(raw) for _ in range(width)] for _ in range(1 if same else count)]
            parts.append(stored * count if same else stored)
        rows += [sum(row, []) for row in zip(*parts)]
    if next(raw, None) is not None:
        raise Damaged("values are left over after the last page")
    return [tuple(row) for row in rows]


def plain_attribute(entry, elements):
    head, data = pairs(entry[0]), pairs(entry[1])
    if head["type"] == "string":
        indices = [row[0] for row in column(data["indices"], elements)]
        values = [data["strings"][i] if i >= 0 else "" for i in indices]
    else:
        values = column(data["values"], elements)
    about = {key: data[key] for key in ("size", "storage") if key in data}
    if "defaults" in data:
        defaults = pairs(data["defaults"])
        about["defaults"] = numbers(defaults["values"], defaults["storage"])
    return head, about, values


def plain_group(entry, elements):
    kind, stored = pairs(pairs(entry[1])["selection"])["unordered"]
    if kind == "i8":
        return [bool(x) for x in stored]
    counts, values = stored[0::2], stored[1::2]
    members = [value for count, value in zip(counts, values) for _ in range(count)]
    if len(members) != elements:
        raise Damaged(f"a group of {len(members)} of {elements} elements")
    return members


def plain(document):
    """The document with every array spelt out, the same for all three forms."""
    parts = pairs(document)
    counts = {"vertexattributes": parts["vertexcount"], "pointattributes": parts["pointcount"],
              "primitiveattributes": parts["primitivecount"], "globalattributes": 1}
    result = {key: parts[key] for key in ("fileversion", "pointcount", "vertexcount", "primitivecount")}
    result["info"] = {key: [float(x) for x in value] if key == "bounds" else value
                      for key, value in parts["info"].items()}
    result["topology"] = list(pairs(pairs(parts["topology"])["pointref"])["indices"])
    for kind, entries in pairs(parts["attributes"]).items():
        result[kind] = [plain_attribute(entry, counts[kind]) for entry in entries]
    short = {"s_v": "startvertex", "n_p": "nprimitives", "r_v": "nvertices_rle", "n_v": "nvertices"}
    kinds = {"t_r": "Tetrahedron_run", "p_r": "Polygon_run"}
    result["primitives"] = [(kinds.get(pairs(head)["type"], pairs(head)["type"]),
                             {short.get(key, key): value for key, value in pairs(body).items()})
                            for head, body in parts["primitives"]]
    for kind, count in (("pointgroups", "pointcount"), ("vertexgroups", "vertexcount"),
                        ("primitivegroups", "primitivecount")):
        result[kind] = {pairs(entry[0])["name"]: plain_group(entry, parts[count]) for entry in parts.get(kind, [])}
    return result


def bits(value):
    """Equal only for the same bits: -0.0 is not 0.0, 1 is not 1.0."""
    return json.dumps(value)


def difference(first, second, where=""):
    if type(first) is not type(second) and not {type(first), type(second)} <= {list, tuple}:
        return f"{where}: {first!r} and {second!r}"
    if isinstance(first, dict):
        if list(first) != list(second):
            return f"{where}: keys {list(first)} and {list(second)}"
        return next((d for key in first if (d := difference(first[key], second[key], f"{where}/{key}"))), None)
    if isinstance(first, (list, tuple)):
        if len(first) != len(second):
            return f"{where}: {len(first)} and {len(second)} entries"
        return next((d for i, pair in enumerate(zip(first, second)) if (d := difference(*pair, f"{where}/{i}"))), None)
    return None if bits(first) == bits(second) else f"{where}: {first!r} and {second!r}"


def main(arguments):
    if arguments and arguments[0] == "--same":
        first = plain(read(arguments[1]))
        for path in arguments[2:]:
            found = difference(first, plain(read(path)))
            if found:
                print(f"{path} differs from {arguments[1]}: {found}")
                return 1
        print(f"{len(arguments) - 1} files: {first['pointcount']} points, {first['primitivecount']} primitives, same")
        return 0
    json.dump(read(arguments[0]), sys.stdout)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (Damaged, KeyError, ValueError, IndexError, struct.error) as error:
        print(f"damaged: {error!r}")
        sys.exit(1)
