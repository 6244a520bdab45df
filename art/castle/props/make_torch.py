# SPDX-License-Identifier: Apache-2.0
"""Writes torch.glb: a wooden torch with an iron basket, 0.65 m with its flame, and its light.

Metres, y up. Zero is where the hand grips it. Needs nothing but Python; the same bytes every time.

    python3 make_torch.py torch.glb
"""
import json
import math
import random
import struct
import sys
import zlib

LIGHT_PLACE = (0.0, 0.545, 0.0)  # above the flame, which would be in its way
CANDELA, WARM = 7.0, (1.0, 0.58, 0.24)


def png(width, height, pixel):
    """`pixel(u, v)` gives sRGB, 0 to 255; v grows downwards."""
    def chunk(kind, data):
        return (struct.pack('>I', len(data)) + kind + data
                + struct.pack('>I', zlib.crc32(kind + data)))
    rows = b''.join(b'\0' + bytes(max(0, min(255, round(c)))
                                  for x in range(width)
                                  for c in pixel((x + 0.5) / width, (y + 0.5) / height))
                    for y in range(height))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 2,
                                                              0, 0, 0))
            + chunk(b'IDAT', zlib.compress(rows, 9)) + chunk(b'IEND', b''))


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def ramp(stops, t):
    """Between colours [(place, colour), ...] in order of place."""
    for (t0, a), (t1, b) in zip(stops, stops[1:]):
        if t <= t1:
            return mix(a, b, max(0.0, (t - t0) / (t1 - t0)))
    return stops[-1][1]


def wave_noise(seed):
    """Smooth and periodic in u."""
    draw = random.Random(seed)
    waves = [(draw.randint(1, 7), draw.uniform(2, 30), draw.uniform(0, 2 * math.pi))
             for _ in range(12)]
    return lambda u, v: sum(math.sin(2 * math.pi * a * u + b * v + p)
                            for a, b, p in waves) / len(waves)


def wood_picture():
    """Grain along v, darker towards the top, where the fire was."""
    fibre, spot = wave_noise(1), wave_noise(2)
    draw = random.Random(3)
    lines = [draw.uniform(-1, 1) for _ in range(64)]

    def pixel(u, v):
        grain = lines[int(64 * ((u + 0.02 * fibre(u, v)) % 1))]
        tone = 0.55 + 0.16 * grain + 0.25 * spot(u, 0.4 * v)
        colour = mix((62, 40, 24), (134, 94, 58), max(0.0, min(1.0, tone)))
        burnt = max(0.0, min(1.0, (0.26 - v + 0.06 * spot(u, v)) / 0.22))
        return mix(colour, (22, 18, 16), burnt)
    return png(64, 128, pixel)


def flame_picture():
    """From the blue-grey foot at the bottom through yellow to the orange tip."""
    lick = wave_noise(5)
    stops = [(0.0, (70, 40, 38)), (0.08, (190, 92, 28)), (0.25, (255, 206, 120)),
             (0.5, (255, 222, 140)), (0.75, (255, 160, 60)), (1.0, (196, 62, 14))]
    return png(32, 64, lambda u, v: ramp(stops, max(0.0, min(1.0, 1 - v + 0.10 * lick(u, v)))))


class Part:
    """Triangles of one material."""

    def __init__(self, material):
        self.material = material
        self.points, self.uv, self.triangles = [], [], []

    def grid(self, rows, wrap=True):
        """Quads over rows[j][i], counter-clockwise from outside where rows run up and columns
        round y to the left. u runs along columns, v down the rows."""
        base, columns = len(self.points), len(rows[0]) + wrap
        for j, row in enumerate(rows):
            for i in range(columns):
                self.points.append(row[i % len(row)])
                self.uv.append((i / (columns - 1), 1 - j / (len(rows) - 1)))
        for j in range(len(rows) - 1):
            for i in range(columns - 1):
                a = base + j * columns + i
                b, c, d = a + 1, a + columns, a + columns + 1
                self.triangles += [(a, c, b), (b, c, d)]

    def turned(self, profile, segments, bend=lambda y: (0, 0)):
        """A profile [(radius, y), ...], listed upwards, turned about y."""
        rows = []
        for radius, y in profile:
            x0, z0 = bend(y)
            rows.append([(x0 + radius * math.cos(a), y, z0 - radius * math.sin(a))
                         for a in (2 * math.pi * i / segments for i in range(segments))])
        self.grid([row[::-1] for row in rows])

    def normals(self):
        """Means of the faces around; points that lie together count as one."""
        sums = {}
        key = [tuple(round(c, 6) for c in p) for p in self.points]
        for t in self.triangles:
            a, b, c = (self.points[i] for i in t)
            u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
            n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            for i in t:
                s = sums.setdefault(key[i], [0, 0, 0])
                for k in range(3):
                    s[k] += n[k]
        unit = []
        for k in key:
            n = sums.get(k, (0, 1, 0))
            length = math.sqrt(sum(c * c for c in n)) or 1
            unit.append(tuple(c / length for c in n))
        return unit


def make_shaft():
    wood = Part('Wood')
    draw = random.Random(7)
    lean = [(draw.uniform(-1, 1) * 0.0015, draw.uniform(-1, 1) * 0.0015) for _ in range(12)]
    profile = [(0.001, -0.172), (0.0125, -0.172)]
    profile += [(0.0145 + 0.0045 * j / 11 + draw.uniform(-1, 1) * 0.0006, -0.168 + 0.44 * j / 11)
                for j in range(12)]

    def bend(y):
        return lean[max(0, min(11, round((y + 0.168) / 0.44 * 11)))]
    wood.turned(profile, 10, bend)
    return wood


def make_iron():
    iron = Part('Iron')

    def band(y, height, inner, outer):
        iron.turned([(inner, y), (outer, y + 0.15 * height), (outer, y + 0.85 * height),
                     (inner, y + height)], 12)
    band(-0.176, 0.026, 0.011, 0.0175)  # the foot
    band(0.085, 0.012, 0.016, 0.0195)   # above the hand
    band(0.228, 0.022, 0.016, 0.0225)   # what the basket stands in
    band(0.345, 0.012, 0.0355, 0.0400)  # its rim
    for k in range(6):  # its bars
        a = 2 * math.pi * k / 6
        out, side = (math.cos(a), -math.sin(a)), (math.sin(a), math.cos(a))
        rows = []
        for radius, y in [(0.019, 0.236), (0.029, 0.262), (0.0375, 0.300), (0.0385, 0.352),
                          (0.043, 0.378), (0.050, 0.392)]:
            wide = 0.0042 if y < 0.36 else 0.0028
            ring = []
            for r, w in [(radius - 0.0025, -wide), (radius + 0.0025, -wide),
                         (radius + 0.0025, wide), (radius - 0.0025, wide)]:
                ring.append((out[0] * r + side[0] * w, y, out[1] * r + side[1] * w))
            rows.append(ring)
        rows.append([rows[-1][0]] * 4)
        iron.grid([row[::-1] for row in rows])
    return iron


def make_head():
    """Cloth and pitch, charred."""
    cloth = Part('Charred cloth')
    bulge = wave_noise(11)
    rows = []
    for radius, y in [(0.018, 0.242), (0.0265, 0.258), (0.033, 0.290), (0.0345, 0.325),
                      (0.031, 0.356), (0.020, 0.374), (0.001, 0.380)]:
        row = []
        for i in range(12):
            r = radius * (1 + 0.10 * bulge(i / 12, 40 * y))
            a = 2 * math.pi * i / 12
            row.append((r * math.cos(a), y, -r * math.sin(a)))
        rows.append(row[::-1])
    cloth.grid(rows)
    return cloth


def make_flame():
    flame = Part('Flame')

    def tongue(foot, lean, low, high, wide, twist, segments=7, rows=6):
        shape = []
        for j in range(rows + 1):
            t = j / rows
            radius = wide * (math.sin(math.pi * t ** 0.62) ** 0.85 if 0 < t < 1 else 0.02)
            x = foot[0] + lean[0] * t * t + 0.007 * math.sin(5 * t + twist) * t
            z = foot[1] + lean[1] * t * t + 0.007 * math.cos(4 * t + twist) * t
            row = []
            for i in range(segments):
                a = 2 * math.pi * i / segments + twist * t
                r = radius * (1 + 0.18 * math.cos(3 * a + twist))
                row.append((x + r * math.cos(a), low + (high - low) * t, z - r * math.sin(a)))
            shape.append(row[::-1])
        flame.grid(shape)
    tongue((0, 0), (0.006, -0.004), 0.338, 0.515, 0.036, 0.7, 9, 8)
    tongue((0.014, 0.006), (0.022, 0.008), 0.345, 0.462, 0.021, 2.1)
    tongue((-0.013, 0.008), (-0.018, 0.010), 0.345, 0.480, 0.021, 4.0)
    tongue((0.000, -0.016), (0.004, -0.020), 0.345, 0.452, 0.019, 5.2)
    return flame


MATERIALS = [
    {'name': 'Wood', 'pbrMetallicRoughness': {
        'baseColorTexture': {'index': 0}, 'metallicFactor': 0, 'roughnessFactor': 0.75}},
    {'name': 'Iron', 'pbrMetallicRoughness': {
        'baseColorFactor': [0.09, 0.085, 0.08, 1], 'metallicFactor': 0.6, 'roughnessFactor': 0.5}},
    {'name': 'Charred cloth', 'pbrMetallicRoughness': {
        'baseColorFactor': [0.018, 0.014, 0.012, 1], 'metallicFactor': 0,
        'roughnessFactor': 0.95}},
    {'name': 'Flame', 'pbrMetallicRoughness': {
        'baseColorFactor': [0, 0, 0, 1], 'metallicFactor': 0, 'roughnessFactor': 1},
     'emissiveFactor': [1, 0.62, 0.2], 'emissiveTexture': {'index': 1},
     'extensions': {'KHR_materials_emissive_strength': {'emissiveStrength': 5}}},
]


def write(path):
    parts = [make_shaft(), make_iron(), make_head(), make_flame()]
    data, views, accessors, meshes, nodes = b'', [], [], [], []

    def view(content, target=None):
        nonlocal data
        data += b'\0' * (-len(data) % 4)
        views.append({'buffer': 0, 'byteOffset': len(data), 'byteLength': len(content)})
        if target:
            views[-1]['target'] = target
        data += content
        return len(views) - 1

    def accessor(rows, kind, code, component, bounds=False):
        flat = [c for row in rows for c in row]
        size = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3}[kind]
        found = {'bufferView': view(struct.pack(f'<{len(flat)}{code}', *flat),
                                    34963 if kind == 'SCALAR' else 34962),
                 'componentType': component, 'count': len(flat) // size, 'type': kind}
        if bounds:
            single = [[struct.unpack('<f', struct.pack('<f', c))[0] for c in row] for row in rows]
            found['min'] = [min(c) for c in zip(*single)]
            found['max'] = [max(c) for c in zip(*single)]
        accessors.append(found)
        return len(accessors) - 1

    for part in parts:
        primitive = {'attributes': {
            'POSITION': accessor(part.points, 'VEC3', 'f', 5126, True),
            'NORMAL': accessor(part.normals(), 'VEC3', 'f', 5126),
            'TEXCOORD_0': accessor(part.uv, 'VEC2', 'f', 5126)},
            'indices': accessor(part.triangles, 'SCALAR', 'H', 5123),
            'material': [m['name'] for m in MATERIALS].index(part.material)}
        meshes.append({'name': part.material, 'primitives': [primitive]})
        nodes.append({'name': part.material, 'mesh': len(meshes) - 1})
    nodes.append({'name': 'Light', 'translation': LIGHT_PLACE,
                  'extensions': {'KHR_lights_punctual': {'light': 0}}})
    images = [{'mimeType': 'image/png', 'bufferView': view(picture)}
              for picture in (wood_picture(), flame_picture())]
    data += b'\0' * (-len(data) % 4)
    document = {
        'asset': {'version': '2.0', 'generator': 'art/castle/props/make_torch.py',
                  'copyright': 'The Wellspring authors, Apache License 2.0'},
        'extensionsUsed': ['KHR_lights_punctual', 'KHR_materials_emissive_strength'],
        'extensions': {'KHR_lights_punctual': {'lights': [
            {'name': 'Light', 'type': 'point', 'color': WARM, 'intensity': CANDELA}]}},
        'scene': 0, 'scenes': [{'nodes': list(range(len(nodes)))}], 'nodes': nodes,
        'meshes': meshes, 'materials': MATERIALS,
        'textures': [{'source': 0}, {'source': 1}], 'images': images,
        'accessors': accessors, 'bufferViews': views, 'buffers': [{'byteLength': len(data)}]}
    text = json.dumps(document, separators=(',', ':')).encode()
    text += b' ' * (-len(text) % 4)
    with open(path, 'wb') as file:
        file.write(struct.pack('<4sII', b'glTF', 2, 28 + len(text) + len(data))
                   + struct.pack('<I4s', len(text), b'JSON') + text
                   + struct.pack('<I4s', len(data), b'BIN\0') + data)
    print(f'{path}: {28 + len(text) + len(data)} bytes, '
          f'{sum(len(part.triangles) for part in parts)} triangles')


if __name__ == '__main__':
    write(sys.argv[1] if len(sys.argv) > 1 else 'torch.glb')
