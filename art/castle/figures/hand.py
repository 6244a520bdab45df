# SPDX-License-Identifier: Apache-2.0
"""The hands: a sculpture of blended rods, its skin found on a grid (surface nets) and thinned.

Hand space: a along the straight fingers (down, in the rest pose), b to the thumb's side (forward),
c to the back of the hand (outward). The left hand; the right one is its mirror image.
"""
from math import cos, sin

from form import capsule, carve, ellipsoid, gradient, join, mad, sub, unit
from patch import Patch
from rig import WRIST, ELBOW, blend

# knuckle, then lengths of the three phalanges, then radii at knuckle, joints and tip, then bend in
# rest
FINGERS = {
    2: ((0.0860, 0.0265, 0.0010), (0.0400, 0.0235, 0.0195), (0.0093, 0.0080, 0.0070, 0.0058), 0.10),
    3: ((0.0880, 0.0070, 0.0030), (0.0440, 0.0270, 0.0200), (0.0095, 0.0082, 0.0072, 0.0060), 0.15),
    4: ((0.0835, -0.0120, 0.0015), (0.0405, 0.0255, 0.0200), (0.0090, 0.0077, 0.0068, 0.0057),
        0.20),
    5: ((0.0765, -0.0290, -0.0025), (0.0320, 0.0185, 0.0180), (0.0080, 0.0068, 0.0060, 0.0051),
        0.24),
}
SPREAD = {2: 0.105, 3: 0.01, 4: -0.075, 5: -0.175}
THUMB = [(0.0180, 0.0200, -0.0080), (0.0530, 0.0430, -0.0190), (0.0815, 0.0530, -0.0225),
         (0.1060, 0.0590, -0.0235)]
THUMB_RADII = (0.0140, 0.0108, 0.0094, 0.0072)


def finger_line(k):
    """Knuckle, joints and tip of finger k in hand space; slightly bent towards the palm."""
    p, lengths, _, bend = FINGERS[k]
    points = [p]
    angle = bend * 0.6
    for size in lengths:
        d = (cos(angle) * cos(SPREAD[k]), sin(SPREAD[k]) * cos(angle), -sin(angle))
        p = mad(p, d, size)
        points.append(p)
        angle += bend
    return points


def to_figure(p):
    """Hand space to figure space (left hand): the hand continues the forearm."""
    down = unit(sub(WRIST, ELBOW))
    down = unit((down[0] * 0.4, down[1], down[2] * 0.4))
    forward = unit((0.10, 0.0, 1.0))
    d = forward[0] * down[0] + forward[1] * down[1] + forward[2] * down[2]
    forward = unit(mad(forward, down, -d))
    out = (down[1] * forward[2] - down[2] * forward[1], down[2] * forward[0] - down[0] * forward[2],
           down[0] * forward[1] - down[1] * forward[0])
    if out[0] < 0:
        out = (-out[0], -out[1], -out[2])
    return mad(mad(mad(WRIST, down, p[0]), forward, p[1]), out, p[2])


def finger_joints():
    """(name, parent, centre in figure space) for the left hand."""
    joints = []
    names = ["carpometacarpal_1", "metacarpophalangeal_1", "carpal_interphalangeal_1"]
    parent = "radiocarpal"
    for name, p in zip(names, THUMB):
        joints.append((name, parent, to_figure(p)))
        parent = name
    for k in FINGERS:
        line = finger_line(k)
        knuckle = line[0]
        root = (0.022, knuckle[1] * 0.55, knuckle[2] * 0.5)
        parent = "radiocarpal"
        for name, p in (("carpometacarpal_%d" % k, root), ("metacarpophalangeal_%d" % k, line[0]),
                        ("carpal_proximal_interphalangeal_%d" % k, line[1]),
                        ("carpal_distal_interphalangeal_%d" % k, line[2])):
            joints.append((name, parent, to_figure(p)))
            parent = name
    return joints


LINES = {k: finger_line(k) for k in FINGERS}


def hand(p):
    flat = (p[0], p[1], p[2])
    d = capsule(p, (-0.050, 0.004, 0.0), (0.006, 0.004, 0.0), 0.0215, 0.0195)
    d = join(d, capsule(p, (-0.050, -0.006, 0.0), (0.006, -0.006, 0.0), 0.0205, 0.0180), 0.01)
    for k, (knuckle, lengths, radii, _) in FINGERS.items():
        root = (0.012, knuckle[1] * 0.55, knuckle[2] * 0.4)
        d = join(d, capsule(flat, root, mad(knuckle, (1, 0, 0), -0.004), 0.0135, 0.0108), 0.014)
    # ball of thumb
    d = join(d, capsule(p, (0.026, 0.024, -0.010), (0.050, 0.036, -0.016), 0.0150, 0.0120), 0.016)
    d = join(d, ellipsoid(p, (0.040, -0.022, -0.007), (0.028, 0.011, 0.012)), 0.016)
    # hollow of the palm
    d = carve(d, ellipsoid(p, (0.058, 0.003, -0.024), (0.026, 0.020, 0.0085)), 0.014)
    for k, (_, _, radii, _) in FINGERS.items():
        line = LINES[k]
        f = 1.0
        for i in range(3):
            rod = capsule(p, line[i], line[i + 1] if i < 2
                          else mad(line[3], unit(sub(line[3], line[2])), -radii[3]),
                          radii[i], radii[i + 1])
            f = rod if i == 0 else join(f, rod, 0.003)
        d = join(d, ellipsoid(p, mad(line[0], (0, 0, 1), 0.003), (0.009, 0.0075, 0.0085)), 0.008)
        d = join(d, f, 0.0042)
    t = capsule(p, THUMB[0], THUMB[1], THUMB_RADII[0], THUMB_RADII[1])
    t = join(t, capsule(p, THUMB[1], THUMB[2], THUMB_RADII[1], THUMB_RADII[2]), 0.004)
    t = join(t,
             capsule(p, THUMB[2], mad(THUMB[3], unit(sub(THUMB[3], THUMB[2])), -0.007),
                     THUMB_RADII[2], 0.0072), 0.004)
    return join(d, t, 0.011)


def surface_net(field, low, high, step):
    """Vertices and quads of the zero set of `field` in a box: one vertex a crossed cell."""
    size = [int((h - l) / step) + 2 for l, h in zip(low, high)]
    values = {}
    far = 2.0 * step

    def coarse(i, j, k):
        return (low[0] + i * step, low[1] + j * step, low[2] + k * step)

    block = 4  # skip blocks the surface cannot reach
    for bi in range(0, size[0] + 1, block):
        for bj in range(0, size[1] + 1, block):
            for bk in range(0, size[2] + 1, block):
                c = coarse(bi + block / 2, bj + block / 2, bk + block / 2)
                d = field(c)
                if abs(d) > block * step * 1.3 + far:
                    continue
                for i in range(bi, bi + block):
                    for j in range(bj, bj + block):
                        for k in range(bk, bk + block):
                            values[(i, j, k)] = field(coarse(i, j, k))
    corners = [(a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)]
    pairs = [(m, n) for m in range(8) for n in range(m + 1, 8)
             if sum(abs(x - y) for x, y in zip(corners[m], corners[n])) == 1]
    index, vertices, quads = {}, [], []
    for (i, j, k) in sorted(values):
        v = [values.get((i + a, j + b, k + c)) for a, b, c in corners]
        if None in v or all(x < 0 for x in v) or all(x >= 0 for x in v):
            continue
        total, n = [0.0, 0.0, 0.0], 0
        for m, o in pairs:
            if (v[m] < 0) != (v[o] < 0):
                t = v[m] / (v[m] - v[o])
                for axis in range(3):
                    total[axis] += corners[m][axis] + (corners[o][axis] - corners[m][axis]) * t
                n += 1
        index[(i, j, k)] = len(vertices)
        vertices.append((low[0] + (i + total[0] / n) * step, low[1] + (j + total[1] / n) * step,
                         low[2] + (k + total[2] / n) * step))
    axes = [((1, 0, 0), (0, 1, 0), (0, 0, 1)), ((0, 1, 0), (0, 0, 1), (1, 0, 0)),
            ((0, 0, 1), (1, 0, 0), (0, 1, 0))]
    for (i, j, k), v in sorted(values.items()):
        for axis, u, w in axes:
            o = values.get((i + axis[0], j + axis[1], k + axis[2]))
            if o is None or (v < 0) == (o < 0):
                continue
            cells = [(i - a * u[0] - b * w[0], j - a * u[1] - b * w[1], k - a * u[2] - b * w[2])
                     for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            if all(c in index for c in cells):
                q = [index[c] for c in cells]
                quads.append(q if v < 0 else q[::-1])
    return vertices, quads


def thin(vertices, quads, ratio):
    """Fewer triangles, more where the form bends: Blender's collapse decimation."""
    import bpy
    mesh = bpy.data.meshes.new("thin")
    mesh.from_pydata(vertices, [], quads)
    thing = bpy.data.objects.new("thin", mesh)
    bpy.context.scene.collection.objects.link(thing)
    modifier = thing.modifiers.new("decimate", "DECIMATE")
    modifier.ratio = ratio
    modifier.use_collapse_triangulate = True
    done = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    points = [tuple(v.co) for v in done.vertices]
    triangles = [tuple(p.vertices) for p in done.polygons]
    bpy.data.objects.remove(thing)
    bpy.data.meshes.remove(mesh)
    return points, triangles


def segment_distance(p, a, b):
    d = sub(b, a)
    h = sum((x - y) * z for x, y, z in zip(p, a, d)) / sum(x * x for x in d)
    h = min(max(h, 0.0), 1.0)
    q = mad(a, d, h)
    return sum((x - y) ** 2 for x, y in zip(p, q)) ** 0.5


def hand_weights(p, side):
    """Nearest bones win, softly."""
    s = side + "_"
    bones = [(s + "elbow", (-0.06, 0, 0), (-0.012, 0, 0), 0.020)]
    bones.append((s + "radiocarpal", (0.0, 0, 0), (0.030, 0.002, 0), 0.020))
    names = ["carpometacarpal_1", "metacarpophalangeal_1", "carpal_interphalangeal_1"]
    for i, name in enumerate(names):
        bones.append((s + name, THUMB[i], THUMB[i + 1], THUMB_RADII[i]))
    for k, (knuckle, _, radii, _) in FINGERS.items():
        line = LINES[k]
        root = (0.022, knuckle[1] * 0.55, knuckle[2] * 0.5)
        bones.append((s + "carpometacarpal_%d" % k, root, line[0], 0.012))
        bones.append((s + "metacarpophalangeal_%d" % k, line[0], line[1], radii[0]))
        bones.append((s + "carpal_proximal_interphalangeal_%d" % k, line[1], line[2], radii[1]))
        bones.append((s + "carpal_distal_interphalangeal_%d" % k, line[2], line[3], radii[2]))
    near = [(name, segment_distance(p, a, b) / r) for name, a, b, r in bones]
    best = min(d for _, d in near)
    return blend([(name, max(0.0, 1 - (d - best) / 0.38) ** 2) for name, d in near])


def make_hands(look):
    vertices, quads = surface_net(hand, (-0.045, -0.062, -0.052), (0.192, 0.078, 0.030), 0.0024)
    points, triangles = thin(vertices, quads, 0.12)
    exact = []
    for p in points:  # back onto the sculpture
        for _ in range(2):
            p = mad(p, gradient(hand, p), -hand(p))
        exact.append(p)
    patches = []
    for side, s in (("l", 1), ("r", -1)):
        patch = Patch("hand_" + side, look)
        normals = [gradient(hand, p) for p in exact]
        made = {}

        def corner(i, back):
            """Vertex i in the chart of the back or of the palm."""
            if (i, back) not in made:
                p = exact[i]
                q = to_figure(p)
                u = (p[1] + 0.062) / 0.145 * 0.48 + (0.01 if back else 0.51)
                made[(i, back)] = patch.vertex((s * q[0], q[1], q[2]), (u, (p[0] + 0.05) / 0.25),
                                               hand_weights(p, side),
                                               ("hand", p))
            return made[(i, back)]

        for t in triangles:
            back = sum(normals[i][2] for i in t) > -0.3
            patch.triangles.append(tuple(corner(i, back) for i in t))
        orient(patch)
        patches.append(patch)
    return patches


def orient(patch):
    """Turns all triangles outwards (by the sign of the enclosed volume)."""
    volume = 0.0
    p = patch.positions
    for a, b, c in patch.triangles:
        volume += (p[a][0] * (p[b][1] * p[c][2] - p[b][2] * p[c][1])
                   - p[a][1] * (p[b][0] * p[c][2] - p[b][2] * p[c][0])
                   + p[a][2] * (p[b][0] * p[c][1] - p[b][1] * p[c][0]))
    # the origin lies outside, so subtract the open wrist: compare against the centroid instead
    n = len(p)
    m = tuple(sum(q[i] for q in p) / n for i in range(3))
    volume = 0.0
    for a, b, c in patch.triangles:
        u, v, w = sub(p[a], m), sub(p[b], m), sub(p[c], m)
        volume += (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
                   + u[2] * (v[0] * w[1] - v[1] * w[0]))
    if volume < 0:
        patch.triangles = [(a, c, b) for a, b, c in patch.triangles]
