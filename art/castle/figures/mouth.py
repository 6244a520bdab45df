# SPDX-License-Identifier: Apache-2.0
"""Inside of the lips, mouth, teeth and tongue. Head space; see face_form.py."""
from math import cos, pi, sin

from face_form import MOUTH_Y, part_y
from form import bell, clamp, lerp, smoothstep
from patch import Patch
from rig import jaw_weight

SKULL, JAW = {"skullbase": 1.0}, {"temporomandibular": 1.0}


def share(w):
    return {"skullbase": 1 - w, "temporomandibular": w} if 0 < w < 1 else (JAW if w >= 1 else SKULL)


def make_lining(face, look):
    """From the parting of the lips inwards: the wet inside of the lips, then a dark bag round the
    teeth."""
    patch = Patch("mouth", look)
    up = [face.positions[i] for i in face.lip_rings[0][0]]
    down = [face.positions[i] for i in face.lip_rings[1][0]]
    n = len(up) - 1
    loop = ([(i / n, True, p) for i, p in enumerate(up)]
            + [(i / n, False, down[i]) for i in range(n - 1, 0, -1)])
    # depth behind the lips, half height above / below, width kept, height of the middle
    steps = [(0.0, 0.0, 1.0), (0.0016, 0.0006, 0.99), (0.0038, 0.0016, 0.98),
             (0.0060, 0.0060, 0.985),
             (0.0085, 0.0130, 1.0), (0.016, 0.0155, 1.02), (0.030, 0.0165, 0.98),
             (0.045, 0.0150, 0.85),
             (0.056, 0.0090, 0.55)]
    rows = []
    for depth, half, keep in steps:
        row = []
        for t, upper, p in loop:
            s = 1 if upper else -1
            # the cheek closes in behind the corners
            narrow = lerp(1.3, 0.6, smoothstep(0.004, 0.016, depth))
            lid = (4 * t * (1 - t)) ** narrow if 0 < t < 1 else 0.0
            x = p[0] * keep
            y = lerp(p[1], MOUTH_Y + 0.0004, smoothstep(0.004, 0.02, depth)) + s * half * lid
            w = jaw_weight((p[0], part_y(abs(p[0])), p[2]), not upper)
            w = lerp(w, 0.5 if lid == 0 else (0.0 if upper else 1.0),
                     smoothstep(0.006, 0.030, depth))
            row.append(patch.vertex((x, y, p[2] - depth), (0.5, clamp(depth / 0.03)), share(w),
                                    ("lining", t, upper, depth)))
        rows.append(row)
    patch.grid(rows, closed=True, flip=True)
    end = patch.vertex((0, MOUTH_Y, up[n // 2][2] - 0.060), (0.5, 1.0), share(0.5),
                       ("lining", 0.5, True, 0.06))
    patch.fan(end, rows[-1], flip=True)
    return patch


WIDTHS = [0.0089, 0.0071, 0.0081, 0.0075, 0.0073, 0.0100]  # from the middle to the back
LOWER_WIDTHS = [0.0058, 0.0063, 0.0072, 0.0075, 0.0077, 0.0105]


def arch(s, upper):
    """Point (x, z) of the dental arch at length s from the middle, and its outward direction."""
    front = 0.0934 if upper else 0.0909
    radius = 0.0262 if upper else 0.0244
    a = s / radius
    if a < pi / 2 * 0.86:
        return radius * sin(a), front - radius * (1 - cos(a)) * 1.08, sin(a), cos(a)
    a0 = pi / 2 * 0.86
    rest = (a - a0) * radius
    x, z = radius * sin(a0), front - radius * (1 - cos(a0)) * 1.08
    return x + 0.25 * rest, z - 0.97 * rest, sin(a0), cos(a0)


def make_teeth(upper, tooth_look, gum_look):
    """Single rounded teeth on their arch, and the gum they stand in."""
    name = "upper" if upper else "lower"
    teeth, gums = Patch(name + "_teeth", tooth_look), Patch(name + "_gums", gum_look)
    weights = SKULL if upper else JAW
    tag = (name + "_teeth",)
    grow = -1 if upper else 1  # direction from gum to edge
    edge_y = MOUTH_Y - 0.0040 if upper else MOUTH_Y - 0.0036
    widths = WIDTHS if upper else LOWER_WIDTHS
    heights = [0.0098, 0.0086, 0.0096, 0.0080, 0.0074, 0.0070, 0.0065] if upper else \
        [0.0078, 0.0080, 0.0088, 0.0078, 0.0072, 0.0068, 0.0065]
    drops = [0.0, -0.0007, 0.0003, -0.0006, -0.0010, -0.0012, -0.0016]
    for side in (1, -1):
        s = 0.0
        for w, h, drop in zip(widths, heights, drops):
            rows = []
            tip = edge_y + grow * drop
            thick = 0.0016 if w < 0.0072 else 0.0030
            for k in range(5):  # gum to edge
                v = k / 4
                row = []
                for q in range(8):
                    a = 2 * pi * (q + 0.5) / 8
                    ca, sa = cos(a), sin(a)
                    along = s + w / 2 + 0.512 * w * (0.88 + 0.12 * smoothstep(0, 0.6, v)
                                                     - 0.07 * max(0, v - 0.85) / 0.15) \
                        * (abs(ca) ** 0.6 * (1 if ca > 0 else -1))
                    x, z, nx, nz = arch(max(along, 0.0002), upper)
                    depth = thick * (abs(sa) ** 0.7 * (1 if sa > 0 else -1)) * (1 - 0.62 * v ** 3)
                    out = depth - 0.0012 * (1 - v) + 0.0004 * sin(pi * v) - thick
                    y = tip - grow * h * (1 - v) - grow * 0.0002 * ca * ca * v
                    row.append(teeth.vertex((side * (x + nx * out), y, z + nz * out), (0.5, v),
                                            weights, tag))
                rows.append(row)
            flip = (side > 0) == upper
            teeth.grid(rows, closed=True, flip=not flip)
            n = len(rows[-1])
            x = sum(teeth.positions[i][0] for i in rows[-1]) / n
            z = sum(teeth.positions[i][2] for i in rows[-1]) / n
            cap = teeth.vertex((x, tip + grow * 0.0003, z), (0.5, 1.0), weights, tag)
            teeth.fan(cap, rows[-1], flip=not flip)
            s += w
    # the gum: a tube along the arch, scalloped where teeth stand
    total = sum(widths)
    bounds = [0.0]
    for w in widths:
        bounds.append(bounds[-1] + w)
    rows = []
    profile = [(-0.0035, 0.62), (-0.0003, 0.72), (0.0002, 0.88), (0.0004, 1.12), (0.0008, 1.55)]
    for out, up in profile:
        row = []
        for i in range(-21, 22):
            s = abs(i) / 21 * total
            x, z, nx, nz = arch(max(s, 1e-4), upper)
            k = max(j for j in range(len(widths)) if bounds[j] <= s + 1e-9 or j == 0)
            t = (s - bounds[k]) / widths[k]
            scallop = 0.0013 * (1 - (4 * clamp(t * (1 - t), 0, 0.25))) * (1 if up < 1 else 0)
            y = edge_y - grow * (0.0092 if upper else 0.0082) * up + grow * scallop
            side = 1 if i >= 0 else -1
            row.append(gums.vertex((side * (x + nx * out), y, z + nz * out), (0.5, 0.5), weights,
                                   tag))
        rows.append(row)
    gums.grid(rows, flip=not upper)
    return teeth, gums


def make_tongue(look):
    patch = Patch("tongue", look)
    rows = []
    n = 14
    for k in range(11):
        v = k / 10
        row = []
        a = pi * (0.03 + 0.97 * v)
        z = 0.0868 - 0.040 * v
        w = 0.0190 * (sin(min(a * 0.9 + 0.12, pi / 2))) ** 0.7
        h = 0.0058 * (sin(min(a * 0.9 + 0.15, pi / 2))) ** 0.6
        y = MOUTH_Y - 0.0075 + 0.0050 * smoothstep(0.1, 0.6, v) - 0.010 * smoothstep(0.7, 1.0, v)
        for q in range(n):
            b = 2 * pi * q / n
            groove = -0.0012 * bell(cos(b), 0.25) if sin(b) > 0 else 0
            row.append(patch.vertex((w * cos(b), y + h * sin(b) + groove, z), (0.5, 0.5), JAW,
                                    ("tongue", v)))
        rows.append(row)
    tip = patch.vertex((0, MOUTH_Y - 0.0074, 0.0885), (0.5, 0.5), JAW, ("tongue", 0.0))
    patch.fan(tip, rows[0])
    patch.grid(rows, closed=True, flip=True)
    return patch
