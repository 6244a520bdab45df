# SPDX-License-Identifier: Apache-2.0
"""Patches of surface and the figure they make up together.

A patch has one look and its own vertices; each vertex has a place, a texture coordinate and the
joints that move it. A figure strings all patches together into the one vertex list an H-Anim skin
shares.
"""
from form import add, cross, sub, unit


class Patch:
    def __init__(self, name, look):
        self.name = name
        self.look = look
        self.positions = []
        self.uv = []
        self.weights = []  # one {joint: weight} a vertex
        self.triangles = []
        # of single vertices, where the maker knows better than the faces around them
        self.normals = {}
        self.tags = []  # what the maker wants to remember about a vertex (displacers ask)

    def vertex(self, position, uv=(0.0, 0.0), weights=None, tag=None):
        self.positions.append(tuple(position))
        self.uv.append(tuple(uv))
        self.weights.append(weights or {})
        self.tags.append(tag)
        return len(self.positions) - 1

    def triangle(self, a, b, c):
        if a != b and b != c and c != a:
            self.triangles.append((a, b, c))

    def quad(self, a, b, c, d):
        """Corners counter-clockwise seen from outside; split along the shorter diagonal."""
        p = self.positions
        ac, bd = sub(p[a], p[c]), sub(p[b], p[d])
        if sum(x * x for x in ac) <= sum(x * x for x in bd):
            self.triangle(a, b, c)
            self.triangle(a, c, d)
        else:
            self.triangle(a, b, d)
            self.triangle(b, c, d)

    def grid(self, rows, closed=False, flip=False):
        """Joins rows of vertex indices. Rows go up, vertices go right (seen from outside)."""
        for low, high in zip(rows, rows[1:]):
            n = len(low)
            for i in range(n if closed else n - 1):
                j = (i + 1) % n
                if flip:
                    self.quad(low[j], low[i], high[i], high[j])
                else:
                    self.quad(low[i], low[j], high[j], high[i])

    def fan(self, center, ring, flip=False):
        for a, b in zip(ring, ring[1:] + ring[:1]):
            self.triangle(*((center, b, a) if flip else (center, a, b)))

    def append(self, other):
        base = len(self.positions)
        self.positions += other.positions
        self.uv += other.uv
        self.weights += other.weights
        self.tags += other.tags
        self.triangles += [(a + base, b + base, c + base) for a, b, c in other.triangles]
        self.normals.update({i + base: n for i, n in other.normals.items()})

    def drop_unused(self):
        """Forgets vertices no triangle uses; {old index: new index}."""
        used = sorted({i for t in self.triangles for i in t})
        new = {old: i for i, old in enumerate(used)}
        self.positions = [self.positions[i] for i in used]
        self.uv = [self.uv[i] for i in used]
        self.weights = [self.weights[i] for i in used]
        self.tags = [self.tags[i] for i in used]
        self.normals = {new[i]: n for i, n in self.normals.items() if i in new}
        self.triangles = [(new[a], new[b], new[c]) for a, b, c in self.triangles]
        return new


def vertex_normals(positions, triangles):
    """Area-weighted normals; vertices at the same place (texture seams) share one."""
    key = [(round(p[0], 6), round(p[1], 6), round(p[2], 6)) for p in positions]
    total = {}
    for a, b, c in triangles:
        n = cross(sub(positions[b], positions[a]), sub(positions[c], positions[a]))
        for i in (a, b, c):
            total[key[i]] = add(total.get(key[i], (0, 0, 0)), n)
    return [unit(total.get(k, (0, 0, 1))) for k in key]


class Look:
    def __init__(self, name, color=(0.8, 0.8, 0.8), roughness=0.7, metallic=0.0, texture=None,
                 double_sided=False):
        self.name = name
        self.color = color  # linear
        self.roughness = roughness
        self.metallic = metallic
        self.texture = texture
        self.normal_map = None  # picture of the finest relief
        self.double_sided = double_sided


class Figure:
    def __init__(self):
        self.looks = {}
        self.patches = []
        self.displacers = []  # (owner joint, name, {vertex: displacement})

    def look(self, look):
        self.looks[look.name] = look
        return look.name

    def add(self, patch):
        if not hasattr(patch, "rest"):
            patch.drop_unused()
        patch.first = sum(len(p.positions) for p in self.patches)
        self.patches.append(patch)

    def patch(self, name):
        return next(p for p in self.patches if p.name == name)

    def vertices(self):
        """(patch, index in the patch, index in the figure) of every vertex."""
        for patch in self.patches:
            for i in range(len(patch.positions)):
                yield patch, i, patch.first + i
