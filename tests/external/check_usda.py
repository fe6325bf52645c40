#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads stages (.usda) that vdb_shell wrote with a parser of its own and holds them against what
USD's schemas ask for: types and counts, index ranges, orientation of triangles and tets, the
boundary of the tets, extents, the volume's fields and files, time samples.

    check_usda.py FILE...
    check_usda.py --make-with "COMMAND;build;MESH;..."
        for ctest: makes stages first, and afterwards spoils one in every way that is looked for

Exit status: 0 when everything holds, 1 when not.
"""

import collections
import os
import re
import struct
import subprocess
import sys
import tempfile

from usda_text import Parser

# Type and whether it is uniform, by prim type and attribute; what is not here must not be there.
SCHEMA = {
    "Xform": {},
    "Mesh": {"extent": "float3[]", "faceVertexCounts": "int[]", "faceVertexIndices": "int[]",
             "orientation": "uniform token", "points": "point3f[]",
             "subdivisionScheme": "uniform token", "primvars:stopReason": "int[]",
             "primvars:thickness": "float[]"},
    "TetMesh": {"extent": "float3[]", "orientation": "uniform token", "points": "point3f[]",
                "surfaceFaceVertexIndices": "int3[]", "tetVertexIndices": "int4[]",
                "primvars:depth": "float[]", "primvars:layer": "int[]",
                "primvars:sourceVertex": "int[]", "primvars:thickness": "float[]",
                "userProperties:prism": "custom int[]"},
    "Volume": {"extent": "float3[]", "field:depth": "rel", "field:surface": "rel"},
    "OpenVDBAsset": {"fieldClass": "token", "fieldDataType": "token", "fieldName": "token",
                     "filePath": "asset"},
}

# All of these or none, where there is more than one layer below the surface.
LAYERED = {"userProperties:layer": "custom int[]", "userProperties:layers": "custom int",
           "userProperties:skin": "custom int"}
# All of these or none, where there are surfaces inside that the shell was kept off.
CORES = {"primvars:core": "int[]", "primvars:coreDistance": "float[]",
         "primvars:coreTriangle": "int[]", "primvars:coreUvw": "float3[]"}
# Each where the shell is posed, and where it is known how fast it moves.
POSED = {"primvars:rest": "point3f[]"}
MOVING = {"velocities": "vector3f[]"}
BOTH_SIDED = {"primvars:stopReasonOuter": "int[]"}


def single(value):
    """The float32 that a reader makes of this number."""
    return struct.unpack("f", struct.pack("f", value))[0]


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def det(a, b, c):
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0]))


class Check:
    def __init__(self, path):
        self.path, self.failures, self.facts = path, [], []

    def that(self, holds, what):
        if not holds:
            self.failures.append(what)

    def schema(self, prim):
        known = dict(SCHEMA.get(prim.kind, {}))
        self.that(prim.kind in SCHEMA, f"{prim.name}: no schema {prim.kind}")
        if prim.kind == "TetMesh" and set(LAYERED) & set(prim.types):
            known.update(LAYERED)
        if prim.kind == "TetMesh" and set(CORES) & set(prim.types):
            known.update(CORES)
        if prim.kind == "Mesh" and set(BOTH_SIDED) & set(prim.types):
            known.update(BOTH_SIDED)
        for more in (POSED, MOVING):
            if prim.kind in ("Mesh", "TetMesh") and set(more) & set(prim.types):
                known.update(more)
        self.that(prim.types == known, f"{prim.name}: attributes {prim.types}, expected {known}")
        for name, declared in prim.types.items():
            values = prim.samples.get(name, {}).values() or [prim.values.get(name)]
            size = re.search(r"(?:int|float|point|vector)(\d)f?\[\]$", declared)
            for value in values:
                self.that(value is not None, f"{prim.name}.{name}: no value")
                if size and value is not None:
                    self.that(all(isinstance(v, tuple) and len(v) == int(size[1]) for v in value),
                              f"{prim.name}.{name}: not all are {declared}")
                if declared.split()[-1] == "int":
                    self.that(isinstance(value, int), f"{prim.name}.{name}: {value} is no int")
                elif declared.split()[-1].startswith("int") and value is not None:
                    flat = [x for v in value for x in (v if isinstance(v, tuple) else (v,))]
                    self.that(all(isinstance(x, int) and -2**31 <= x < 2**31 for x in flat),
                              f"{prim.name}.{name}: not all are int32")
            if name.startswith("primvars:"):
                self.that(prim.metadata[name].get("interpolation") == "vertex",
                          f"{prim.name}.{name}: interpolation {prim.metadata[name]}")
        for child in prim.children:
            self.schema(child)

    def extent(self, prim, time):
        points, extent = prim.at("points", time), prim.at("extent", time)
        if not points:
            return
        points = [tuple(map(single, p)) for p in points]
        tight = [tuple(f(p[axis] for p in points) for axis in range(3)) for f in (min, max)]
        self.that([tuple(map(single, e)) for e in extent] == tight,
                  f"{prim.name}: extent {extent}, the points span {tight}")

    def primvars(self, prim, time):
        for name in prim.types:
            if name.startswith("primvars:"):
                count, points = len(prim.at(name, time)), len(prim.at("points", time))
                self.that(count == points, f"{prim.name}.{name}: {count} values, {points} points")

    def mesh(self, mesh, time):
        points, corners = mesh.at("points", time), mesh.at("faceVertexIndices", time)
        counts = mesh.at("faceVertexCounts", time)
        self.that(set(counts) == {3} and len(corners) == 3 * len(counts), "surface: not triangles")
        self.that(all(0 <= c < len(points) for c in corners), "surface: an index is out of range")
        self.that(mesh.values["orientation"] == "rightHanded", "surface: orientation")
        self.that(mesh.values["subdivisionScheme"] == "none", "surface: it would be subdivided")
        triangles = list(zip(corners[::3], corners[1::3], corners[2::3]))
        edges = collections.Counter((t[i], t[i - 2]) for t in triangles for i in range(3))
        self.that(all(n == 1 and edges[b, a] == 1 for (a, b), n in list(edges.items())),
                  "surface: not closed or not oriented alike")
        volume = sum(det(points[a], points[b], points[c]) for a, b, c in triangles) / 6
        self.that(volume > 0, f"surface: it encloses {volume}, so it is inside out")
        self.facts.append(f"{len(triangles)} triangles enclosing {volume:.6g}")

    def tets(self, mesh, time):
        points, tets = mesh.at("points", time), mesh.at("tetVertexIndices", time)
        self.that(all(0 <= c < len(points) for t in tets for c in t), "tets: index out of range")
        self.that(len({c for t in tets for c in t}) == len(points), "tets: a point has no tet")
        self.that(mesh.values["orientation"] == "rightHanded", "tets: orientation")
        volumes = [det(*(sub(points[t[i]], points[t[0]]) for i in (1, 2, 3))) / 6 for t in tets]
        self.that(all(v > 0 for v in volumes), f"tets: {sum(v <= 0 for v in volumes)} left-handed")
        faces = collections.defaultdict(list)
        for t in tets:
            for a, b, c in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)):
                faces[tuple(sorted((t[a], t[b], t[c])))].append((t[a], t[b], t[c]))
        self.that(max(map(len, faces.values()), default=0) <= 2, "tets: a face has three tets")
        boundary = sorted(f[0] for f in faces.values() if len(f) == 1)
        surface = mesh.at("surfaceFaceVertexIndices", time)
        self.that(surface == boundary, f"tets: {len(surface)} surface faces, {len(boundary)} on the "
                  "boundary, or not in order")
        enclosed = sum(det(*(points[c] for c in f)) for f in surface) / 6
        total = sum(volumes)
        self.that(abs(enclosed - total) <= 1e-5 * abs(total),
                  f"tets: their volume is {total}, their surface faces enclose {enclosed}")
        self.that(len(mesh.at("userProperties:prism", time)) == len(tets), "tets: prisms")
        self.facts.append(f"{len(tets)} tets of volume {total:.6g} in {len(surface)} faces")

    def link(self, surface, tets, time):
        """What the tets say of the surface, which is surface `skin` of layers + 1."""
        skin_points, points = surface.at("points", time), tets.at("points", time)
        source, layer = tets.at("primvars:sourceVertex", time), tets.at("primvars:layer", time)
        depth, thickness = tets.at("primvars:depth", time), surface.at("primvars:thickness", time)
        layers = tets.at("userProperties:layers", time) or 1
        skin = tets.at("userProperties:skin", time) or 0
        self.that(layers >= 1 and 0 <= skin <= layers, f"tets: surface {skin} of {layers} layers")
        self.that(("primvars:stopReasonOuter" in surface.types) == (0 < skin < layers),
                  f"surface: reasons of {layers} layers, the surface is number {skin}")
        self.that(all(0 <= v < len(skin_points) for v in source), "tets: a source vertex is out of range")
        self.that(all(0 <= k <= layers and single(k / layers) == single(d) for k, d in zip(layer, depth)),
                  "tets: a depth is not that of its layer")
        for name in ("primvars:rest", "velocities"):
            self.that((name in surface.types) == (name in tets.types), f"one prim alone has {name}")
            if name in surface.types and name in tets.types:
                self.moved_alike(name, surface.at(name, time), tets.at(name, time), source, layer, skin)
        if self.failures:
            return
        pillars = collections.defaultdict(list)
        for i, v in enumerate(source):
            pillars[v].append(i)
            self.that(thickness[v] == tets.at("primvars:thickness", time)[i], f"tets: thickness {i}")
        for v, pillar in pillars.items():
            self.pillar(v, [layer[i] for i in pillar], [points[i] for i in pillar], thickness[v],
                        skin, skin_points[v])
        self.prisms(surface, tets, time, layers)
        self.feet(tets, time)
        self.facts.append(f"{layers} layers, the surface is number {skin}")

    def moved_alike(self, name, of_surface, of_tets, source, layer, skin):
        """Points of the tets that are vertices of the surface have its values."""
        self.that(len(of_tets) == len(source), f"tets: {len(of_tets)} of {name}, {len(source)} points")
        for value, v, k in zip(of_tets, source, layer):
            self.that(k != skin or value == of_surface[v], f"tets: {name} of vertex {v} is not the surface's")

    def pillar(self, v, layers, points, thickness, skin, skin_point):
        """Its points from the outermost on; pinned layers have none of their own."""
        self.that(all(a < b for a, b in zip(layers, layers[1:])), f"tets: vertex {v} in layers {layers}")
        # A decimal stands for the float next to it; between near points the rest of its digits would count.
        places = [[single(x) for x in point] for point in points]
        length = sum(sum(x * x for x in sub(a, b)) ** 0.5 for a, b in zip(places, places[1:]))
        self.that(abs(length - thickness) <= 1e-5 * (thickness + 1e-30),
                  f"tets: vertex {v} has {length} of pillars, stated {thickness}")
        at_skin = [p for k, p in zip(layers, points) if k <= skin][-1:]
        self.that(at_skin == [skin_point], f"tets: vertex {v} of the surface is not at {at_skin}")

    def feet(self, tets, time):
        """What points say of cores: none of those on the surface ended at one."""
        if "primvars:core" not in tets.types:
            return
        ended = 0
        for i, (core, triangle, uvw, far, layer) in enumerate(zip(
                tets.at("primvars:core", time), tets.at("primvars:coreTriangle", time),
                tets.at("primvars:coreUvw", time), tets.at("primvars:coreDistance", time),
                tets.at("primvars:layer", time))):
            self.that((core >= 0) == (triangle >= 0) and far >= 0, f"tets: core {core}, triangle {triangle} of {i}")
            self.that(abs(sum(uvw) - (core >= 0)) < 1e-5, f"tets: weights {uvw} of point {i}")
            self.that(core < 0 or layer > 0, f"tets: outer point {i} ended at a core")
            ended += core >= 0
        self.facts.append(f"{ended} points ended at cores")

    def prisms(self, surface, tets, time, layers):
        corners = surface.at("faceVertexIndices", time)
        source, layer = tets.at("primvars:sourceVertex", time), tets.at("primvars:layer", time)
        prism = tets.at("userProperties:prism", time)
        tet_layer = tets.at("userProperties:layer", time) or [0] * len(prism)
        self.that(len(tet_layer) == len(prism), f"tets: {len(tet_layer)} layers")
        for t, (tet, p, k) in enumerate(zip(tets.at("tetVertexIndices", time), prism, tet_layer)):
            self.that(0 <= k < layers and max(layer[c] for c in tet) == k + 1,
                      f"tets: tet {t} is in layer {k}")
            self.that({source[c] for c in tet} <= set(corners[3 * p:3 * p + 3]),
                      f"tets: tet {t} is not in prism {p}")

    def volume(self, volume, time):
        for name, kind in (("surface", "levelSet"), ("depth", "fogVolume")):
            field = volume.child(name)
            self.that(volume.values[f"field:{name}"] == f"/shell/grids/{name}", f"{name}: rel")
            self.that(field.values["fieldName"] == name and field.values["fieldClass"] == kind
                      and field.values["fieldDataType"] == "float", f"{name}: {field.values}")
            asset = field.at("filePath", time)
            self.that(not os.path.isabs(asset), f"{name}: {asset} is absolute")
            place = os.path.join(os.path.dirname(os.path.abspath(self.path)), asset)
            if not os.path.isfile(place):
                self.failures.append(f"{name}: there is no {place}")
                continue
            self.grid(place, name, volume.at("extent", time))

    def grid(self, place, name, extent):
        try:
            import openvdb as vdb
        except ImportError:
            try:
                import pyopenvdb as vdb
            except ImportError:
                return
        grid = vdb.read(place, name)
        box = grid.evalActiveVoxelBoundingBox()
        for corner, outside in zip(box, (-0.5, 0.5)):
            world = grid.transform.indexToWorld(tuple(c + outside for c in corner))
            self.that(all((e - w) * outside >= -1e-6 for e, w in zip(extent[outside > 0], world)),
                      f"{name}: extent {extent} leaves out {world}")
        self.facts.append(f"{name}: {grid.activeVoxelCount()} voxels in its extent")

    def run(self):
        with open(self.path, encoding="utf-8") as file:
            layer, prims = Parser(file.read()).stage()
        self.that(layer.get("upAxis") in ("Y", "Z") and layer.get("metersPerUnit", 0) > 0,
                  f"layer: {layer}")
        self.that([p.name for p in prims] == [layer.get("defaultPrim")], "the default prim")
        root = prims[0]
        self.schema(root)
        if self.failures:
            return
        surface, tets, grids = (root.child(n) for n in ("surface", "tets", "grids"))
        parts = [p for p in (surface, tets, grids, *(grids.children if grids else ())) if p]
        times = sorted({t for p in parts for s in p.samples.values() for t in s}) or [None]
        for time in times:
            for part in (surface, tets):
                self.extent(part, time)
                self.primvars(part, time)
            self.mesh(surface, time)
            self.tets(tets, time)
            self.link(surface, tets, time)
            if grids:
                self.volume(grids, time)
        if times != [None]:
            self.that([layer.get("startTimeCode"), layer.get("endTimeCode")] == [times[0], times[-1]],
                      f"layer: time codes {layer}, samples at {times}")
            for part in parts:
                for name, samples in part.samples.items():
                    self.that(sorted(samples) == list(samples) == times, f"{name}: times {samples.keys()}")


def examine(path):
    result = Check(path)
    try:
        result.run()
    except AssertionError as error:
        result.failures.append(str(error))
    return result


def check(path):
    result = examine(path)
    for failure in result.failures[:20]:
        print(f"{os.path.basename(path)}: FAILED: {failure}")
    print(f"{os.path.basename(path)}: {'; '.join(result.facts)}")
    return not result.failures


def spoil(text):
    """Changes of which each must be found out: what it is, and the changed stage."""
    def change(pattern, replacement):
        changed, count = re.subn(pattern, replacement, text, count=1, flags=re.DOTALL)
        assert count == 1 and changed != text, pattern
        return changed

    yield "a tet turned round", change(r"(tetVertexIndices = \[\()(\d+), (\d+)", r"\1\3, \2")
    yield "a triangle turned round", change(r"(faceVertexIndices = \[)(\d+), (\d+)", r"\1\3, \2")
    yield "an index out of range", change(r"(faceVertexIndices = \[)\d+", r"\g<1>999999")
    yield "a negative index", change(r"(tetVertexIndices = \[\()\d+", r"\1-1")
    yield "a surface face less", change(r"(surfaceFaceVertexIndices = \[)\([^)]*\), ", r"\1")
    yield "a surface face turned", change(r"(surfaceFaceVertexIndices = \[\()(\d+), (\d+)", r"\1\3, \2")
    yield "a wrong extent", change(r"(extent = \[\()[^,]*", r"\g<1>-77")
    yield "a thickness less", change(r"(primvars:thickness = \[)[^,]*, ", r"\1")
    yield "a wrong depth", change(r"(primvars:depth = \[)0", r"\g<1>0.5")
    yield "a tet of another prism", change(r"(userProperties:prism = \[)0", r"\g<1>7")
    if "userProperties:skin" in text:
        yield "another surface", change(r"(userProperties:skin = )\d+", r"\g<1>0")
        yield "a layer less", change(r"(userProperties:layers = )\d+", r"\g<1>1")
        yield "a tet of another layer", change(r"(userProperties:layer = \[)0", r"\g<1>1")
        yield "a point of another layer", change(r"(primvars:layer = \[)0", r"\g<1>1")
    if "primvars:coreUvw" in text:
        yield "a triangle of no core", change(r"(primvars:coreTriangle = \[)-1", r"\g<1>3")
        yield "weights that are not one", change(r"(primvars:coreUvw = \[)\([^)]*\)", r"\g<1>(1, 1, 1)")
    yield "a wrong type", change(r"TetMesh", "TetMesch")
    yield "a wrong attribute", change(r"int4\[\] tet", "int3[] tet")
    yield "no end", text[:text.rindex("}")]
    yield "no such grid file", change(r"asset filePath = @\.", "asset filePath = @./no_/.")
    yield "a wrong field", change(r'fieldName = "depth"', 'fieldName = "deep"')
    yield "a wrong axis", change(r'upAxis = "."', 'upAxis = "X"')


def finds_out(path):
    """True when every spoilt version of a good stage is refused."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    missed = []
    for what, changed in spoil(text):
        name = os.path.join(os.path.dirname(path), "spoilt.usda")
        with open(name, "w", encoding="utf-8") as file:
            file.write(changed)
        try:
            failures = examine(name).failures
        except (KeyError, IndexError, TypeError, AttributeError):
            failures = ["not the attributes that are expected"]
        if not failures:
            missed.append(what)
    print("spoilt stages not found out: " + (", ".join(missed) or "none"))
    return not missed


def main():
    paths = sys.argv[1:]
    if paths[:1] == ["--make-with"]:
        with tempfile.TemporaryDirectory() as folder:
            names = [os.path.join(folder, name) for name in ("shell.usda", "shell.vdb", "again.usda")]
            os.mkdir(os.path.join(folder, "stages"))
            names.append(os.path.join(folder, "stages", "below.usda"))
            outputs = [word for name in names for word in ("-o", name)]
            subprocess.run([*paths[1].split(";"), *outputs], check=True, capture_output=True)
            good = [check(name) for name in names if name.endswith(".usda")]
            return 0 if all(good) and finds_out(names[0]) else 1
    return 0 if all([check(path) for path in paths]) else 1


if __name__ == "__main__":
    sys.exit(main())
