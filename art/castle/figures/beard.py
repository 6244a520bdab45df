# SPDX-License-Identifier: Apache-2.0
"""Beard and moustache: locks that grow out of the skin of the face. Head space; see face_form.py.

A lock follows the skin at its root with everything the face does (expressions.py asks the tag), so
that lips and jaw never come out through it.
"""
import random
from math import pi, sin

from face_form import MOUTH_HALF, MOUTH_Y, face, lower_lip_y, part_y, upper_lip_y
from form import (add, bell, clamp, cross, curve, dot, gradient, length, lerp, mad, mix, mul,
                  smoothstep, sub, unit)
from hair import ribbon
from patch import Patch
from rig import jaw_weight

# upper edge of the beard on the cheek: x -> y
CHEEK_EDGE = [(0.0, -0.0500), (0.0150, -0.0490), (0.0240, -0.0560), (0.0340, -0.0600),
              (0.0450, -0.0480), (0.0560, -0.0280),
              (0.0640, -0.0060), (0.0700, 0.0100)]


def mask(p):
    """0 bare skin .. 1 where hair grows."""
    x, y, z = abs(p[0]), p[1], p[2]
    if z < -0.005 or y > 0.015 or y < -0.150:
        return 0.0
    k = smoothstep(0.006, -0.007, y - curve(CHEEK_EDGE, x))
    k *= smoothstep(-0.140, -0.122, y - 0.30 * (0.05 - z))
    k *= smoothstep(-0.004, 0.012, z)
    # the lips, and the bare skin under them on both sides of the tuft
    if x < MOUTH_HALF * 1.06 and z > 0.05:
        top, low = upper_lip_y(x) + 0.0012, lower_lip_y(x) - 0.0012
        if low < y < top:
            return 0.0
        k *= 1 - 0.8 * smoothstep(-0.0045, 0.0, y - low) * (y < low) * bell(x - 0.0135, 0.0060)
    return k


def is_moustache(p):
    return p[1] > part_y(abs(p[0])) and abs(p[0]) < 0.034 and p[2] > 0.06


def flow(p):
    """(direction along the skin, length) of the hair that grows at p, x >= 0."""
    x, y, z = p
    if is_moustache(p):
        t = clamp(x / 0.030)
        return ((0.45 + 0.75 * t, -0.75 + 0.10 * t, 0.10),
                lerp(0.0085, 0.030, smoothstep(0.10, 0.75, t)))
    cheek = smoothstep(0.030, 0.055, x)
    front = smoothstep(0.030, 0.085, z)
    size = lerp(0.020, 0.062, front * smoothstep(-0.055, -0.095, y))
    return ((0.10 * cheek, -1.0, 0.10 + 0.20 * front),
            lerp(size, 0.026, cheek * smoothstep(-0.06, -0.02, y)))


def surface_points(skin, count, rng):
    """Random points of the left half of the face where hair grows: [(point, on the lower side of
    the mouth)]."""
    places = []
    for t in skin.triangles:
        a, b, c = (skin.rest[i] for i in t)
        m = tuple(sum(v) / 3 for v in zip(a, b, c))
        if m[0] < -0.0005 or mask(m) < 0.05:
            continue
        tags = [skin.tags[i][0] for i in t if skin.tags[i]]
        lower = "lower" in tags if ("lower" in tags) != ("upper" in tags) else m[1] < part_y(m[0])
        places.append((length(cross(sub(b, a), sub(c, a))) * (3.6 if is_moustache(m) else 1.0), a,
                       b, c, lower))
    total = sum(p[0] for p in places)
    reach, k, found = 0.0, 0, []
    for i in range(count):  # evenly over the area, in the order of the triangles
        goal = (i + rng.random()) / count * total
        while k + 1 < len(places) and reach + places[k][0] < goal:
            reach += places[k][0]
            k += 1
        _, a, b, c, lower = places[k]
        u, v = rng.random(), rng.random()
        if u + v > 1:
            u, v = 1 - u, 1 - v
        p = add(add(mul(a, 1 - u - v), mul(b, u)), mul(c, v))
        if p[0] >= 0 and mask(p) > rng.random():
            found.append((p, lower))
    return found


def lock_line(root, rng, n, lift):
    """Points of a lock that leaves the skin, bends down and keeps clear of face and neck."""
    normal = gradient(face, root)
    d, size = flow(root)
    d = unit(mad(d, normal, -dot(unit(d), normal) + 0.30))
    d = unit(add(d, tuple(rng.uniform(-0.20, 0.20) for _ in range(3))))
    size *= rng.uniform(0.72, 1.08)
    down = unit((-1.9 * root[0] if not is_moustache(root) else 0.5, -1.0,
                 0.16 if root[2] > 0.05 else 0.02))
    points = [mad(root, normal, -0.0008)]
    for k in range(n):
        t = (k + 1) / n
        p = mad(points[-1],
                unit(mix(d, down, t ** 1.2 * (0.65 if not is_moustache(root) else 0.40))), size / n)
        least = lift * sin(min(1.0, 2.2 * t) * pi / 2)
        near = face(p)
        if near < least:
            p = mad(p, gradient(face, p), least - near)
        points.append(off_the_lips(p) if is_moustache(root) else p)
    return points


def off_the_lips(p):
    """A moustache is combed aside: what would hang over the mouth lies along its edge, so that
    speech can be read."""
    edge = upper_lip_y(min(p[0], MOUTH_HALF)) - 0.0004
    over = (edge - p[1]) * smoothstep(1.25 * MOUTH_HALF, 0.95 * MOUTH_HALF, p[0])
    return (p[0] + 0.8 * over, p[1] + over, p[2]) if over > 0 else p


def make_beard(skin, look):
    patch = Patch("beard", look)
    rng = random.Random(17)
    for kind, count, width in (("under", 220, 0.0062), ("lock", 520, 0.0016),
                               ("hair", 110, 0.00036)):
        for root, lower in surface_points(skin, count, rng):
            moustache = is_moustache(root)
            lift = ({"under": 0.0020, "lock": 0.0046, "hair": 0.0060}[kind] * rng.uniform(0.7, 1.5)
                    * (0.6 if moustache else 1.0))
            n = {"under": 3, "lock": 3, "hair": 4}[kind]
            points = lock_line(root, rng, n, lift)
            axis = (0.0, root[1], 0.015)
            outs = [unit(mix(sub(p, (axis[0], p[1], axis[2])), gradient(face, root), 0.4))
                    for p in points]
            w = width * rng.uniform(0.75, 1.25) * (0.38 if moustache and kind == "under" else 1.0)
            u, jaw = rng.random(), jaw_weight(root, lower)
            weights = {j: v for j, v in (("skullbase", 1 - jaw), ("temporomandibular", jaw))
                       if v > 0.004}
            weights = {j: v / sum(weights.values()) for j, v in weights.items()}
            for side in (1, -1):
                tag = ("grown", (side * root[0], root[1], root[2]), lower)
                ribbon(patch, [(side * p[0], p[1], p[2]) for p in points],
                       [(side * o[0], o[1], o[2]) for o in outs], w,
                       0.0, u, weights, tag, 7.0 * w)
    return patch
