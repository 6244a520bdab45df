# SPDX-License-Identifier: Apache-2.0
"""Words to write a small glTF scene with: meshes of one material from quads, boxes, turned profiles
and spheres, cameras, lights. Metres, +Y up, linear colours. Only Python's own library is needed."""
import json
import math
import struct


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def subtract(a, b):
    return [x - y for x, y in zip(a, b)]


def scale(a, s):
    return [x * s for x in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def normalize(a):
    length = math.sqrt(sum(x * x for x in a)) or 1
    return [x / length for x in a]


class Mesh:
    def __init__(self):
        self.positions, self.normals, self.triangles = [], [], []

    def vertex(self, position, normal):
        self.positions.append(position)
        self.normals.append(normalize(normal))
        return len(self.positions) - 1

    def quad(self, a, u, v):
        """Over a, a+u, a+u+v, a+v; its front is where cross(u, v) points."""
        n = cross(u, v)
        i = [self.vertex(p, n) for p in (a, add(a, u), add(add(a, u), v), add(a, v))]
        self.triangles += [[i[0], i[1], i[2]], [i[0], i[2], i[3]]]
        return self

    def box(self, low, high, angle=0.0, faces="xXyYzZ"):
        """Axis-parallel, or turned by `angle` about the vertical through its middle."""
        middle = scale(add(low, high), 0.5)
        half = scale(subtract(high, low), 0.5)
        c, s = math.cos(angle), math.sin(angle)

        def turn(p):
            return [c * p[0] + s * p[2], p[1], -s * p[0] + c * p[2]]

        for axis, names in enumerate(("xX", "yY", "zZ")):
            for sign, name in zip((-1, 1), names):
                if name not in faces:
                    continue
                n, u, v = [0, 0, 0], [0, 0, 0], [0, 0, 0]
                n[axis] = sign * half[axis]
                u[(axis + 1) % 3] = half[(axis + 1) % 3]
                v[(axis + 2) % 3] = sign * half[(axis + 2) % 3]
                corner = subtract(subtract(n, u), v)
                self.quad(add(middle, turn(corner)), turn(scale(u, 2)), turn(scale(v, 2)))
        return self

    def turned(self, profile, center=(0, 0, 0), sides=48, closed=False, smooth=True, turn=0.0):
        """A profile of (radius, height) from bottom to top, outside to its right, turned about
        the vertical. `closed`: its end joins its beginning."""
        points = list(profile) + ([profile[0]] if closed else [])
        segments = []
        for (r0, y0), (r1, y1) in zip(points, points[1:]):
            segments.append(normalize([y1 - y0, -(r1 - r0), 0]))
        count = len(segments)
        for k in range(count):
            before = segments[k - 1] if (k > 0 or closed) else segments[k]
            after = segments[(k + 1) % count] if (k + 1 < count or closed) else segments[k]
            here = segments[k]

            def joined(other):
                bend = sum(a * b for a, b in zip(here, other))
                return add(here, other) if smooth and bend > 0.5 else here

            ends = (joined(before), joined(after))
            ring = []
            for i in range(sides + 1):
                phi = 2 * math.pi * i / sides + turn
                x, z = math.cos(phi), -math.sin(phi)
                ring.append([
                    self.vertex([center[0] + r * x, center[1] + y, center[2] + r * z],
                                [n[0] * x, n[1], n[0] * z])
                    for (r, y), n in zip((points[k], points[k + 1]), ends)])
            for (a, d), (b, c) in zip(ring, ring[1:]):
                if points[k][0] > 1e-9:
                    self.triangles.append([a, b, c])
                if points[k + 1][0] > 1e-9:
                    self.triangles.append([a, c, d])
        return self

    def sphere(self, center, radius, rings=48):
        profile = [(radius * math.sin(math.pi * i / rings), -radius * math.cos(math.pi * i / rings))
                   for i in range(rings + 1)]
        profile[0], profile[-1] = (0.0, -radius), (0.0, radius)
        first = len(self.positions)
        self.turned(profile, center, 2 * rings)
        for i in range(first, len(self.positions)):
            self.normals[i] = normalize(subtract(self.positions[i], center))
        return self


class Scene:
    def __init__(self):
        self.binary = b""
        self.json = {
            "asset": {"version": "2.0", "generator": "Wellspring benchmark scenes"},
            "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [],
            "accessors": [], "bufferViews": [], "cameras": []}
        self.extensions = set()

    def material(self, name, color, roughness=1.0, metallic=0.0, emission=None, extensions=None,
                 double_sided=False):
        m = {"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": [*color, 1], "metallicFactor": metallic,
            "roughnessFactor": roughness}}
        extensions = dict(extensions or {})
        if emission:
            strength = max(emission)
            m["emissiveFactor"] = [e / strength for e in emission]
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        if double_sided:
            m["doubleSided"] = True
        if extensions:
            m["extensions"] = extensions
            self.extensions |= set(extensions)
        self.json["materials"].append(m)
        return len(self.json["materials"]) - 1

    def matt(self, name, color):
        """Purely Lambertian: an index of refraction of 1 takes the gloss away."""
        return self.material(name, color, extensions={"KHR_materials_ior": {"ior": 1.0}})

    def _accessor(self, data, layout, components, kind, target, **more):
        while len(self.binary) % 4:
            self.binary += b"\0"
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary),
                                         "byteLength": len(data), "target": target})
        self.binary += data
        self.json["accessors"].append({
            "bufferView": len(self.json["bufferViews"]) - 1, "componentType": layout,
            "count": components, "type": kind, **more})
        return len(self.json["accessors"]) - 1

    def mesh(self, name, material, mesh):
        """Adds the mesh and one node of it."""
        self.json["meshes"].append(None)
        index = len(self.json["meshes"]) - 1
        count = len(mesh.positions)
        flat = [x for p in mesh.positions for x in p]
        low = [min(p[i] for p in mesh.positions) for i in range(3)]
        high = [max(p[i] for p in mesh.positions) for i in range(3)]

        def single(values):
            return [struct.unpack("f", struct.pack("f", v))[0] for v in values]

        position = self._accessor(struct.pack(f"<{3 * count}f", *flat), 5126, count, "VEC3", 34962,
                                  min=single(low), max=single(high))
        normal = self._accessor(
            struct.pack(f"<{3 * count}f", *[x for n in mesh.normals for x in n]), 5126, count,
            "VEC3", 34962)
        corners = [i for t in mesh.triangles for i in t]
        short = count < 65536
        indices = self._accessor(
            struct.pack(f"<{len(corners)}{'H' if short else 'I'}", *corners),
            5123 if short else 5125, len(corners), "SCALAR", 34963)
        self.json["meshes"][index] = {"name": name, "primitives": [{
            "attributes": {"POSITION": position, "NORMAL": normal}, "indices": indices,
            "material": material}]}
        self.node(name, {"mesh": index})
        return index

    def node(self, name, content):
        self.json["nodes"].append({"name": name, **content})
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)

    def camera(self, name, eye, target, fov_degrees):
        back = normalize(subtract(eye, target))
        right = normalize(cross([0, 1, 0], back))
        up = cross(back, right)
        self.json["cameras"].append({"type": "perspective", "perspective": {
            "yfov": math.radians(fov_degrees), "znear": 0.01}})
        self.node(name, {"camera": len(self.json["cameras"]) - 1,
                         "matrix": [*right, 0, *up, 0, *back, 0, *eye, 1]})

    def save(self, path):
        if self.extensions:
            self.json["extensionsUsed"] = sorted(self.extensions)
        while len(self.binary) % 4:
            self.binary += b"\0"
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        total = 12 + 8 + len(text) + 8 + len(self.binary)
        with open(path, "wb") as file:
            file.write(struct.pack("<III", 0x46546C67, 2, total))
            file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
            file.write(struct.pack("<II", len(self.binary), 0x004E4942) + self.binary)
        print(f"{path}: {total} bytes")
