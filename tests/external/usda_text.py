# SPDX-License-Identifier: Apache-2.0
"""A parser of USD's text format, of as much as check_usda.py has to know of a stage."""
import re

TOKEN = re.compile(r'''\s+|\#[^\n]*|(?P<text>"(?:[^"\\\n]|\\.)*")|(?P<asset>@@@.*?@@@|@[^@\n]*@)
    |(?P<path><[^>\n]*>)|(?P<number>-?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)
    |(?P<word>[A-Za-z_][\w:.]*)|(?P<mark>[][(){}=,:;])''', re.VERBOSE)


class Prim:
    def __init__(self, kind, name):
        self.kind, self.name = kind, name
        self.types, self.values, self.samples, self.metadata = {}, {}, {}, {}
        self.children = []

    def child(self, name):
        return next((c for c in self.children if c.name == name), None)

    def at(self, name, time):
        samples = self.samples.get(name)
        return samples[time] if samples and time in samples else self.values.get(name)


class Parser:
    def __init__(self, text):
        assert text.startswith("#usda 1.0\n"), "the first line is not #usda 1.0"
        self.tokens, place = [], 0
        while place < len(text):
            match = TOKEN.match(text, place)
            assert match, f"nothing of USD at {text[place:place + 40]!r}"
            if match.lastgroup:
                self.tokens.append((match.lastgroup, match.group()))
            place = match.end()
        self.place = 0

    def peek(self, ahead=0):
        i = self.place + ahead
        return self.tokens[i][1] if i < len(self.tokens) else None

    def next(self, wanted=None):
        assert self.place < len(self.tokens), "the file ends too early"
        kind, text = self.tokens[self.place]
        assert wanted in (None, text), f"expected {wanted!r}, found {text!r}"
        self.place += 1
        return kind, text

    def value(self):
        kind, text = self.next()
        if kind == "number":
            return float(text) if re.search(r"[.eE]", text) else int(text)
        if kind in ("text", "asset", "path"):
            return text.strip('"@<>')
        if text in "([":
            items = []
            while self.peek() != {"(": ")", "[": "]"}[text]:
                items.append(self.value())
                if self.peek() == ",":
                    self.next()
            self.next()
            return tuple(items) if text == "(" else items
        raise AssertionError(f"a value is expected, found {text!r}")

    def dictionary(self, end):
        result = {}
        while self.peek() != end:
            words = [self.next()[1]]
            while self.peek() != "=":
                words.append(self.next()[1])
            self.next("=")
            if self.peek() == "{":
                self.next()
                result[words[-1]] = self.dictionary("}")
            else:
                result[words[-1]] = self.value()
        self.next(end)
        return result

    def metadata(self):
        if self.peek() != "(":
            return {}
        self.next()
        return self.dictionary(")")

    def attribute(self, prim):
        words = []
        while True:
            kind, text = self.next()
            assert kind == "word", f"an attribute is expected, found {text!r}"
            words.append(text)
            if self.peek() == "[":
                self.next("[")
                self.next("]")
                words[-1] += "[]"
            if self.peek() in ("=", "("):
                break
        name, declared = words[-1], " ".join(words[:-1])
        sampled = name.endswith(".timeSamples")
        name = name.removesuffix(".timeSamples")
        assert prim.types.setdefault(name, declared) == declared, f"{name}: two types"
        if self.peek() == "=":
            self.next()
            if sampled:
                self.next("{")
                samples = {}
                while self.peek() != "}":
                    time = self.value()
                    self.next(":")
                    samples[time] = self.value()
                    self.next(",")
                self.next("}")
                prim.samples[name] = samples
            else:
                assert name not in prim.values, f"{name}: given twice"
                prim.values[name] = self.value()
        prim.metadata.setdefault(name, {}).update(self.metadata())

    def prim(self):
        self.next("def")
        prim = Prim(self.next()[1], self.next()[1].strip('"'))
        prim.metadata["prim"] = self.metadata()
        self.next("{")
        while self.peek() != "}":
            if self.peek() == "def":
                prim.children.append(self.prim())
            else:
                self.attribute(prim)
        self.next("}")
        return prim

    def stage(self):
        layer, prims = self.metadata(), []
        while self.peek() is not None:
            prims.append(self.prim())
        return layer, prims
