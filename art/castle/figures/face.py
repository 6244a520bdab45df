# SPDX-License-Identifier: Apache-2.0
"""The skin of head and neck as a triangle mesh.

The sculpture is unrolled to a plane; rings of points run round the eyes and the mouth, finer points
lie on the nose, the rest is scattered evenly, coarser to the back. A constrained Delaunay
triangulation joins them, the lid slits and the parting of the lips stay open, and each point goes
back to its place in space.
"""
import random
from math import cos, hypot, pi, sin

from mathutils import Vector
from mathutils.geometry import delaunay_2d_cdt

import face_form as form
from form import bell, lerp, smoothstep
from patch import Patch
from person import WHO

LID_POINTS = 26  # along one lid, corner to corner
LIP_POINTS = 34  # along one lip
UNROLL = 0.085  # metres of the plane for one radian

# rings round the eye: 0 the lid margin .. 1 the rim of the socket
EYE_RINGS = [0.0, 0.045, 0.10, 0.17, 0.23, 0.29, 0.35, 0.42, 0.50, 0.60, 0.72, 0.86, 1.0]
# rings round the mouth: 0 the parting line, 1 the edge of the red, 2 the outermost
LIP_RINGS = [0.0, 0.07, 0.17, 0.30, 0.45, 0.62, 0.80, 0.93, 1.05, 1.20, 1.42, 1.70, 2.0]


def lid_opening(t, upper):
    """The lid margin in the eye's front view (x outwards from the eye centre); t: 0 inner .. 1
    outer corner."""
    x = lerp(-0.0153, 0.0148, t)
    base = lerp(-0.0019, 0.0011, t)
    arch = 4 * t * (1 - t)
    if upper:
        return x, base + 0.0055 * WHO.lid_open * arch ** 0.70 * (1 + 0.20 * (0.5 - t))
    return x, base - 0.0051 * arch ** 0.86 * (1 - 0.30 * (0.5 - t))


def eye_ring(s):
    """Points (x, y) of one ring round the left eye, from the inner corner over the top."""
    ring = []
    half = LID_POINTS
    for i in range(2 * half):
        upper = i <= half
        t = i / half if upper else (2 * half - i) / half
        x, y = lid_opening(0.5 - 0.5 * cos(pi * t), upper)
        a = pi * (1 - t) if upper else -pi * (1 - t)
        ox, oy = 0.0005 + 0.0230 * cos(a), 0.0015 + 0.0175 * sin(a)
        k = s ** 0.9
        ring.append((form.EYE[0] + lerp(x, ox, k), form.EYE[1] + lerp(y, oy, k)))
    return ring


def lip_ring(s, upper):
    """Points (x, y) of one ring half round the mouth, from the right corner to the left."""
    line = []
    for i in range(LIP_POINTS + 1):
        a = pi * (1 - i / LIP_POINTS)
        x = form.MOUTH_HALF * cos(a)
        ax = abs(x)
        inner = form.part_y(ax)
        edge = form.upper_lip_y(ax) if upper else form.lower_lip_y(ax)
        if s <= 1:
            k = s
            line.append((x * (1 + 0.06 * s * s), lerp(inner, edge, k)))
        else:
            k = s - 1
            ox = 0.0375 * cos(a)
            oy = (form.MOUTH_Y + (0.0175 if upper else -0.0215) * sin(a) ** 0.8
                  + 0.0030 * abs(cos(a)))
            line.append((lerp(x * 1.06, ox, k), lerp(edge, oy, k ** 0.9)))
    return line


def spacing(theta, v):
    """How far apart scattered points lie."""
    front = smoothstep(2.2, 0.9, abs(theta))
    d = lerp(0.016, 0.0052, front)
    if v < -0.18:
        d = lerp(d, 0.009, front)
    if v > 0.055:
        d = lerp(d, 0.010, smoothstep(0.055, 0.09, v))
    near = bell(theta * UNROLL, 0.032) * bell(v + 0.03, 0.045)
    d = lerp(d, 0.0031, near)
    cheek = bell(abs(theta) * UNROLL - 0.036, 0.014) * bell(v + 0.045, 0.020)  # where smiles fold
    return lerp(d, 0.0024, cheek)


class Points:
    """Points of the left half plane (and the middle line), mirrored at the end; no two too
    close."""

    def __init__(self):
        self.plane, self.space, self.tags = [], [], []
        self.cells = {}

    def put(self, uv, p, tag=None):
        self.plane.append(uv)
        self.space.append(p)
        self.tags.append(tag)
        self.cells.setdefault((int(uv[0] // 0.02), int(uv[1] // 0.02)), []).append(uv)
        return len(self.plane) - 1

    def free(self, uv, d):
        cx, cy = int(uv[0] // 0.02), int(uv[1] // 0.02)
        for i in (cx - 1, cx, cx + 1):
            for j in (cy - 1, cy, cy + 1):
                for q in self.cells.get((i, j), ()):
                    if hypot(uv[0] - q[0], uv[1] - q[1]) < d:
                        return False
        return True


def to_plane(p):
    theta, v = form.unroll(p)
    return theta * UNROLL, v


def make_face(look):
    points = Points()

    def front(x, y, tag):
        p = form.front_point(x, y)
        return points.put(to_plane(p), p, tag)

    # eye: left, then mirrored to the right
    eye = []
    for s in EYE_RINGS:
        eye.append([front(x, y, ("lid", s, i)) for i, (x, y) in enumerate(eye_ring(s))])
    # mouth: whole, corners shared between the two lips
    upper, lower = [], []
    for s in LIP_RINGS:
        a = [front(x, y + (5e-5 if s == 0 else 0), ("upper", s, i))
             for i, (x, y) in enumerate(lip_ring(s, True)) if i >= LIP_POINTS // 2]
        b = [front(x, y - (5e-5 if s == 0 else 0), ("lower", s, i + LIP_POINTS // 2))
             for i, (x, y) in enumerate(lip_ring(s, False)[LIP_POINTS // 2:-1])] + [a[-1]]
        upper.append(a)
        lower.append(b)
    # nose: a fine even grid in the front view
    step = 0.00125
    for j in range(-40, 10):
        for i in range(0, 17):
            x, y = i * step + (0.5 * step if j % 2 and i else 0), j * step
            width = 0.0215 - 0.010 * smoothstep(-0.03, 0.0, y)
            if y > -0.0495 and x < width:
                p = form.front_point(x, y)
                uv = to_plane(p)
                if points.free(uv, 0.00075):
                    points.put(uv, p, ("nose", 0, 0))
    # everything else, scattered
    rng = random.Random(7)
    border = pi * UNROLL
    v = form.LOW
    # the seam at the back and the middle line in front come first: they must be straight
    while v < form.HIGH:
        for theta in (0.0, pi):
            uv = (theta * UNROLL, v)
            if points.free(uv, 0.6 * spacing(theta, v)):
                points.put(uv, form.sweep(theta, v))
        v += 0.004
    for theta_i in range(1, 48):
        for v in (form.LOW, form.HIGH):
            theta = pi * theta_i / 48
            if points.free((theta * UNROLL, v), 0.003):
                points.put((theta * UNROLL, v), form.sweep(theta, v))
    eye_border = [points.plane[i] for i in eye[-1]]
    mouth_border = ([points.plane[i] for i in upper[-1]]
                    + [points.plane[i] for i in reversed(lower[-1])])
    for _ in range(60000):
        uv = (rng.uniform(0, border), rng.uniform(form.LOW, form.HIGH))
        d = spacing(uv[0] / UNROLL, uv[1])
        if uv[0] < 0.4 * d or uv[0] > border - 0.4 * d:
            continue
        if inside(uv, eye_border) or inside(uv, mouth_border) or not points.free(uv, d):
            continue
        points.put(uv, form.sweep(uv[0] / UNROLL, uv[1]))
    return triangulate(points, eye, upper, lower, look)


def inside(uv, polygon):
    x, y = uv
    odd = False
    for (ax, ay), (bx, by) in zip(polygon, polygon[1:] + polygon[:1]):
        if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
            odd = not odd
    return odd


def triangulate(points, eye, upper, lower, look):
    """Mirrors the half, triangulates the whole and opens lids and lips."""
    plane, space, tags = list(points.plane), list(points.space), list(points.tags)
    mirror = {}
    for i, (u, v) in enumerate(points.plane):
        if u < 1e-6:
            mirror[i] = i
            plane[i] = (0.0, v)
            space[i] = (0.0, space[i][1], space[i][2])
            continue
        mirror[i] = len(plane)
        plane.append((-u, v))
        p = points.space[i]
        space.append((-p[0], p[1], p[2]))
        tag = tags[i]
        if tag and tag[0] == "lid":
            tag = ("lid", tag[1], tag[2])
        elif tag and tag[0] in ("upper", "lower"):
            tag = (tag[0], tag[1], LIP_POINTS - tag[2])
        tags.append(tag)
    left_eye = eye[0]
    right_eye = [mirror[i] for i in left_eye]

    def across(half):
        return [mirror[i] for i in reversed(half)] + half[1:]

    lips_up, lips_down = across(upper[0]), across(lower[0])
    mouth = lips_up + lips_down[-2:0:-1]
    edges = []
    for loop in (left_eye, right_eye, mouth):
        edges += list(zip(loop, loop[1:] + loop[:1]))
    for rows in (eye, [[mirror[i] for i in r] for r in eye]):  # keep the rings: clean lids
        for r in rows[1:-1]:
            edges += list(zip(r, r[1:] + r[:1]))
    for rows in (upper, lower):
        for r in rows[1:-1]:
            line = across(r)
            edges += list(zip(line, line[1:]))
    coords, _, faces, origins, _, _ = delaunay_2d_cdt([Vector(p) for p in plane], edges, [], 0,
                                                      1e-7)
    holes = [[plane[i] for i in loop] for loop in (left_eye, right_eye, mouth)]
    patch = Patch("face", look)
    for i, co in enumerate(coords):
        if origins[i]:
            o = origins[i][0]
            patch.vertex(space[o], (co[0], co[1]), tag=tags[o])
        else:  # two constraint lines crossed
            patch.vertex(form.sweep(co[0] / UNROLL, co[1]), (co[0], co[1]))
    new = {o: i for i, origin in enumerate(origins) for o in origin}
    for a, b, c in faces:
        center = ((coords[a][0] + coords[b][0] + coords[c][0]) / 3,
                  (coords[a][1] + coords[b][1] + coords[c][1]) / 3)
        if any(inside(center, hole) for hole in holes):
            continue
        if abs(center[0]) > 1.95 * UNROLL and center[1] > -0.02:  # under hair and veil
            continue
        u, w = coords[b] - coords[a], coords[c] - coords[a]
        patch.triangles.append((a, b, c) if u[0] * w[1] - u[1] * w[0] > 0 else (a, c, b))
    kept = patch.drop_unused()
    new = {o: kept.get(i) for o, i in new.items()}
    patch.eye_rings = [[[new[i] for i in r] for r in eye],
                       [[new[mirror[i]] for i in r] for r in eye]]
    patch.lip_rings = ([[new[i] for i in across(r)] for r in upper],
                       [[new[i] for i in across(r)] for r in lower])
    return patch
