# SPDX-License-Identifier: Apache-2.0
"""Eyeballs, the wet edge of the lids, lashes. Head space; see face_form.py."""
import random
from math import asin, atan2, cos, pi, sin

from face import LID_POINTS
from face_form import BROW_LINE, EYE, EYE_RADIUS, face, front_point
from form import circle, cross, curve, dot, gradient, lerp, mad, mix, rotate, smoothstep, sub, unit
from patch import Patch
from person import WHO

IRIS_ANGLE = 0.475  # radians from the eye's axis to the rim of the iris
CORNEA_RADIUS = 0.0092
MAP_ANGLE = 1.9  # radians from the axis shown at the rim of the eye's texture


def center(side):
    return (side * EYE[0], EYE[1], EYE[2])


def make_eyeball(side, look):
    """A ball with a slightly raised cornea; the texture is spread round the axis of sight."""
    patch = Patch("eyeball_" + ("l" if side > 0 else "r"), look)
    joint = ("l" if side > 0 else "r") + "_eyeball_joint"
    angles = [0.08, 0.16, 0.24, 0.32, 0.40, 0.475, 0.55, 0.68, 0.85, 1.1, 1.4, 1.8, 2.4]
    c = center(side)

    def put(a, phi):
        radius = EYE_RADIUS + 0.00055 * smoothstep(0.56, 0.16, a)
        r = 0.5 * min(a / MAP_ANGLE, 1)
        p = (c[0] + radius * sin(a) * cos(phi), c[1] + radius * sin(a) * sin(phi),
             c[2] + radius * cos(a))
        i = patch.vertex(p, (0.5 + r * cos(phi), 0.5 + r * sin(phi)), {joint: 1.0},
                         ("eyeball", side))
        # light glances off the steeper dome of the cornea, though the form stays low so that lids
        # pass over it
        dome = asin(min(EYE_RADIUS * sin(a) / CORNEA_RADIUS, 0.9)) if a < 1.2 else a
        b = lerp(dome, a, smoothstep(IRIS_ANGLE * 0.92, IRIS_ANGLE * 1.2, a))
        patch.normals[i] = (sin(b) * cos(phi), sin(b) * sin(phi), cos(b))
        return i

    front = put(0, 0)
    rows = [[put(a, phi) for phi in circle(24)] for a in angles]
    patch.fan(front, rows[0])
    patch.grid(rows, closed=True, flip=True)
    patch.fan(put(pi, 0), rows[-1], flip=True)
    return patch


def eye_points(skin, side):
    """The lid margin of the face mesh: points from the inner corner over the top."""
    ring = skin.eye_rings[0 if side > 0 else 1][0]
    return [skin.positions[i] for i in ring]


def make_lid_rims(skin, look):
    """The thickness of the lids: from the skin's edge back to the eyeball and under the lid."""
    patch = Patch("lid_rims", look)
    for side in (1, -1):
        c = center(side)
        rows = [[], [], []]
        for i, p in enumerate(eye_points(skin, side)):
            d = unit(sub(p, c))
            axis = unit(cross((0, 0, 1), d))
            away = rotate(d, (0, 0, 0), axis, 0.20)
            upper = 0 < i < LID_POINTS
            edge = EYE_RADIUS + (0.0001 if upper else 0.00025)
            for row, q in zip(rows, (p, mad(c, d, edge), mad(c, away, EYE_RADIUS - 0.0007))):
                row.append(patch.vertex(q, (0.5, 0.5), {"skullbase": 1.0}, ("rim", 0.0, i, side)))
        patch.grid(rows, closed=True, flip=side < 0)
        # the little red mound in the inner corner
        inner = eye_points(skin, side)[0]
        base = mad(inner, unit(sub(c, inner)), 0.0024)
        base = (base[0], base[1] - 0.0001, base[2] - 0.0012)
        tag = ("caruncle", side)
        top = patch.vertex((base[0], base[1], base[2] + 0.0016), (0.5, 0.5), {"skullbase": 1.0},
                           tag)
        rings = []
        for a in (0.55, 1.1, 1.6):
            rings.append([patch.vertex((base[0] + 0.0022 * sin(a) * cos(phi),
                                        base[1] + 0.0016 * sin(a) * sin(phi),
                                        base[2] + 0.0016 * cos(a)), (0.5, 0.5), {"skullbase": 1.0},
                                        tag)
                          for phi in circle(10)])
        patch.fan(top, rings[0])
        patch.grid(rings, closed=True, flip=True)
    return patch


def make_lashes(skin, look):
    """Single tapering hairs; longer towards the outer corner, the lower ones short and sparse."""
    patch = Patch("lashes", look)
    rng = random.Random(11)
    for side in (1, -1):
        c = center(side)
        ring = eye_points(skin, side)
        for upper, count, size in ((True, 58, 0.0075), (False, 30, 0.0038)):
            for k in range(count):
                t = (k + rng.uniform(0.2, 0.8)) / count
                t = lerp(0.10 if upper else 0.22, 0.985, t)
                place = t * LID_POINTS if upper else 2 * LID_POINTS - t * LID_POINTS
                i = int(place) % (2 * LID_POINTS)
                j = (i + 1) % (2 * LID_POINTS)
                root = mix(ring[i], ring[j], place - int(place))
                out = unit(sub(root, c))
                root = mad(root, out, -0.0003)
                sideways = side * lerp(-0.35, 0.95, t) + rng.uniform(-0.12, 0.12)
                up = 1.0 if upper else -1.0
                length = (size * WHO.lashes * (0.62 + 0.38 * sin(pi * min(1, t * 0.75 + 0.1)))
                          * rng.uniform(0.8, 1.1))
                start = unit((sideways * 0.75, up * (0.12 if upper else 0.45), 1.0))
                end = unit((sideways * 1.0, up * (1.15 if upper else 1.1), 0.62))
                p1 = mad(root, start, length * 0.42)
                p2 = mad(p1, unit(mix(start, end, 0.6)), length * 0.34)
                p3 = mad(p2, end, length * 0.30)
                across = unit(cross(start, (0, up, 0.3)))
                width = 0.00019 if upper else 0.00012
                tag = ("lash", place, side)
                ids = []
                for q, w in ((root, 1.0), (p1, 0.8), (p2, 0.5)):
                    for s in (-1, 1):
                        ids.append(patch.vertex(mad(q, across, s * w * width), (0.5, 0.5),
                                                {"skullbase": 1.0}, tag))
                tip = patch.vertex(p3, (0.5, 0.5), {"skullbase": 1.0}, tag)
                patch.quad(ids[0], ids[1], ids[3], ids[2])
                patch.quad(ids[2], ids[3], ids[5], ids[4])
                patch.triangle(ids[4], ids[5], tip)
    return patch


def make_brows(look):
    """Single hairs over the painted brow: upright at the nose, lying outwards towards the
    temple."""
    patch = Patch("brows", look)
    rng = random.Random(5)
    knots = [[(k[0], k[j]) for k in BROW_LINE] for j in (1, 2)]
    bushy = WHO.brow_thick
    for _ in range(int(135 * bushy)):
        t = rng.random() ** 1.15
        x = lerp(0.0095, 0.0495, t)
        half = curve(knots[1], x) * bushy
        off = rng.uniform(-1, 1)
        y = curve(knots[0], x) + half * off
        lie = lerp(1.15, -0.12, smoothstep(0.0, 0.45, t)) - 0.35 * off + rng.uniform(-0.18, 0.18)
        root = front_point(x, y - 0.0020 * max(0.0, sin(lie)))
        n = gradient(face, root)
        d = (cos(lie), sin(lie), 0.0)
        d = unit(mad(d, n, -dot(d, n)))
        size = lerp(0.0050, 0.0076, bell_middle(t)) * lerp(1.0, bushy, 0.6) * rng.uniform(0.75, 1.1)
        rise = 0.30 + 0.25 * (bushy - 1) * rng.random()
        p1 = mad(mad(root, d, 0.5 * size), n, rise * 0.5 * size)
        p2 = mad(mad(p1, unit(mad(d, (0.25, -0.25, 0.0), 1.0)), 0.5 * size), n, 0.02 * size)
        across = unit(cross(d, n))
        root = mad(root, n, -0.0004)
        tint = rng.random()
        for side in (1, -1):
            ids = [patch.vertex((side * q[0], q[1], q[2]), (tint, 0.5), {"skullbase": 1.0},
                                ("brow",))
                   for p, w in ((root, 1.0), (p1, 0.75))
                   for q in (mad(p, across, -w * 0.00010), mad(p, across, w * 0.00010))]
            tip = patch.vertex((side * p2[0], p2[1], p2[2]), (tint, 0.5), {"skullbase": 1.0},
                               ("brow",))
            patch.quad(ids[0], ids[1], ids[3], ids[2])
            patch.triangle(ids[2], ids[3], tip)
    return patch


def bell_middle(t):
    return 4 * t * (1 - t)


def elevation(p, c):
    """Angle of p about the left-right axis through the eye's centre; 0 straight ahead, up
    positive."""
    return atan2(p[1] - c[1], p[2] - c[2])
