# SPDX-License-Identifier: Apache-2.0
"""What a learned man wore about 1530: a flat cap, a long gown with fur down its front and over the
shoulders, a doublet and a shirt under it, a chain with a small bell. Cap in head space, the rest in
figure space."""
from math import cos, pi, sin

from accessories import oval, tube
from dress import (WAIST_Y, cape_point, cape_weights, disc, neck_ring, neck_weights, skirt_point,
                   trunk)
from form import bell, cast, circle, cross, lerp, mad, noise, rotate, smoothstep, sub, unit
from hair import hair
from patch import Patch
from rig import skirt_weights, torso_weights

# ---- cap -----------------------------------------------------------------------------------------
CAP_CENTER = (0.0, 0.020, -0.014)


def cap_band(a, rise, lift):
    """On the hair round the head; a: 0 in front, to the figure's left; the band sits lower at the
    back."""
    y = lerp(0.026, 0.053, 0.5 + 0.5 * cos(a)) + rise - 0.005 * sin(a)
    d = unit((sin(a), 0.0, cos(a)))
    o = (0.0, min(y, 0.098), -0.012)
    reach = cast(hair, o, d, 0.17)
    return mad((reach[0], y, reach[2]), d, 0.0060 + lift)  # hair lies under it


def make_cap(cloth_look, brim_look):
    cloth, brim = Patch("cap", cloth_look), Patch("cap_brim", brim_look)
    n = 60
    weights = {"skullbase": 1.0}

    def ring(patch, row, v, tile):
        return [patch.vertex(row(2 * pi * (i % n) / n + pi), (i / n * tile, v), weights, ("cap",))
                for i in range(n + 1)]

    def crown(k):
        """k: 0 where the cloth leaves the band .. 1 the middle of the top; puffed, gathered, sunk
        to one side."""
        def row(a):
            base = cap_band(a, 0.026, 0.006)
            out = 0.026 * sin(min(k / 0.34, 1.0) * pi / 2) * (1 - 0.1 * cos(a))
            shrink = smoothstep(0.30, 1.0, k)
            height = (0.012 * min(k / 0.2, 1.0) + 0.046 * smoothstep(0.12, 0.55, k)
                      - 0.002 * smoothstep(0.5, 1.0, k))
            r = (lerp(base[0] + out * sin(a), -0.012, shrink),
                 lerp(base[2] + out * cos(a), -0.022, shrink))
            fold = (0.0042 * (1 - shrink) * sin(min(k / 0.3, 1.0) * pi * 0.55)
                    * (abs(sin(a * 11 + 1.5 * sin(3 * a))) - 0.5))
            soft = 0.006 * noise((r[0] * 14, r[1] * 14, k * 2), 1.0, 5) * smoothstep(0.05, 0.3, k)
            y = lerp(base[1], 0.073 + 0.004 * cos(a), min(k / 0.15, 1.0)) + height + soft
            p = (r[0] * (1 + 8 * fold), y, r[1] * (1 + 8 * fold))
            return rotate(p, CAP_CENTER, (0.0, 0.0, 1.0), -0.055 * smoothstep(0.0, 0.3, k))
        return row

    steps = (0.0, 0.05, 0.11, 0.17, 0.23, 0.29, 0.34, 0.39, 0.46, 0.56, 0.70, 0.84, 0.94)
    rows = [ring(cloth, crown(k), 2.2 * k, 4) for k in steps]
    cloth.grid(rows)
    top = crown(1.0)(0.0)
    cloth.fan(cloth.vertex(top, (0.5, 2.2), weights, ("cap",)), rows[-1][:-1])

    def flap(t, gap):
        """The turned-up brim, slit over the temples; t: 0 its fold below .. 1 its upper edge."""
        def row(a):
            slit = bell(abs(a if a < pi else a - 2 * pi) - 1.05, 0.20)
            rise = lerp(-0.006, 0.031 - 0.016 * slit, t)
            p = cap_band(a, rise, 0.0040 + 0.0200 * t ** 0.7 + gap)
            wave = 0.0030 * t * sin(5 * a + 0.7)
            return mad(p, (sin(a), 0.0, cos(a)), wave)
        return row

    inner = [ring(brim, cap_rise, 0.0, 8)
             for cap_rise in (lambda a: cap_band(a, 0.036, 0.0045),
                              lambda a: cap_band(a, 0.016, 0.001),
                              lambda a: cap_band(a, -0.004, 0.0022))]
    outer = [ring(brim, flap(t, 0.0), 0.3 + t, 8) for t in (0.0, 0.25, 0.55, 0.85, 1.0)]
    back = [ring(brim, flap(t, -0.0035), 1.3 + (1 - t), 8) for t in (1.0, 0.6, 0.2)]
    brim.grid(inner + outer + back)
    return cloth, brim


# ---- gown ----------------------------------------------------------------------------------------
def gown_point(phi, y, lift=0.0):
    """The gown's surface, hem to neck."""
    d = (sin(phi), 0.0, cos(phi))
    if y <= WAIST_Y:
        return mad(skirt_point(phi, y), d, lift)
    chest = mad(cast(trunk, (0.0, y, -0.022), d, 0.3), d, 0.016 + lift)
    t = smoothstep(WAIST_Y, WAIST_Y + 0.16, y)
    waist = mad(skirt_point(phi, WAIST_Y), d, lift)
    waist = (waist[0], y, waist[2])
    p = tuple(lerp(a, b, t) for a, b in zip(waist, chest))
    return mad(p, d, 0.0035 * sin(9 * phi + 1.3 * sin(2 * phi)) * bell(y - 1.12, 0.12))


def gown_weights(p):
    return skirt_weights(p) if p[1] < 1.02 else torso_weights(p, 0.35)


def make_gown(cloth_look):
    cloth = Patch("gown", cloth_look)
    columns = 96
    ys = [0.012, 0.04, 0.09, 0.15, 0.22, 0.30, 0.38, 0.46, 0.54, 0.62, 0.70, 0.78, 0.85, 0.91, 0.96,
          1.00, 1.035, 1.062, 1.09,
          1.12, 1.15, 1.18, 1.21, 1.24, 1.27, 1.30, 1.33]
    rows = []
    for y in [0.012] + ys:
        inset = 0.05 if not rows else 0.0
        row = []
        for i in range(columns + 1):
            phi = 2 * pi * (i % columns) / columns + pi
            p = gown_point(phi, y)
            p = (p[0] * (1 - inset), y + 0.2 * inset, p[2] * (1 - inset))
            row.append(cloth.vertex(p, (i / columns * 6, y * 3.4), gown_weights(p),
                                    ("chest",) if y > 1.05 else ("skirt",)))
        rows.append(row)
    cloth.grid(rows)
    return (cloth,)


def front_place(x, y, lift):
    """The point of the gown's front at a given x."""
    phi = 0.0
    for _ in range(8):  # the front is nearly flat: a few steps find the angle
        p = gown_point(phi, y)
        phi += (x - p[0]) / max(p[2] + 0.02, 0.06)
    return gown_point(phi, y, lift)


def make_facings(fur_look, doublet_look, button_look):
    """Bands of fur down both edges of the gown, the doublet between them with its buttons."""
    fur, doublet, buttons = (Patch("facings", fur_look), Patch("doublet", doublet_look),
                             Patch("buttons", button_look))
    ys = [0.05, 0.14, 0.24, 0.34, 0.44, 0.54, 0.64, 0.73, 0.81, 0.88, 0.94, 0.99, 1.03, 1.07, 1.11,
          1.15, 1.19, 1.23, 1.27, 1.31,
          1.345]

    def inner_edge(y):
        return lerp(0.004, 0.036, smoothstep(0.98, 1.25, y)) + 0.010 * smoothstep(0.6, 0.0, y)

    profile = ((0.0, -0.001), (0.06, 0.010), (0.30, 0.0165), (0.60, 0.0165), (0.92, 0.011),
               (1.0, -0.001))
    for side in (1, -1):
        rows = []
        for y in ys:
            x0 = inner_edge(y)
            width = lerp(0.062, 0.085, smoothstep(0.9, 1.3, y)) + 0.012 * smoothstep(0.6, 0.0, y)
            row = []
            for t, h in profile:
                p = front_place(x0 + width * t, y,
                                h * (1 + 0.22 * noise((t * 5 + side, y * 40, 0.0), 1.0, 4)))
                p = (side * p[0], p[1], p[2])
                row.append(fur.vertex(p, (t * 3, y * 24), gown_weights(p),
                                      ("chest",) if y > 1.05 else ("skirt",)))
            rows.append(row)
        fur.grid(rows, flip=side < 0)
    rows = []
    for y in (0.94, 0.99, 1.04, 1.09, 1.14, 1.19, 1.24, 1.29, 1.34, 1.375):
        x1 = inner_edge(y) + 0.010
        row = []
        for k in range(7):
            x = lerp(-x1, x1, k / 6)
            p = front_place(abs(x), min(y, 1.345), 0.0035 + 0.0012 * cos(pi * x / x1))
            p = (p[0] if x >= 0 else -p[0], y, p[2] - 0.25 * max(0.0, y - 1.345))
            row.append(doublet.vertex(p, (x * 24, y * 12), gown_weights(p), ("chest",)))
        rows.append(row)
    doublet.grid(rows)
    for k in range(8):
        y = 1.035 + 0.042 * k
        p = front_place(0.0, min(y, 1.345), 0.0048)
        p = (0.0, y, p[2])
        disc(buttons, p, (0, 0.08, 1), 0.0062, 0.0042, gown_weights(p), 8)
    return fur, doublet, buttons


def make_fur_collar(fur_look):
    """Broad fur over the shoulders, open in front, thick and uneven."""
    fur = Patch("fur_collar", fur_look)
    n = 84
    gap = 0.26
    rows = []
    for s, lift in ((0.80, 0.002), (0.80, 0.014), (0.72, 0.019), (0.60, 0.020), (0.48, 0.019),
                    (0.36, 0.018), (0.24, 0.018), (0.13, 0.019),
                    (0.05, 0.018), (0.0, 0.012), (-0.01, 0.002)):
        row = []
        for i in range(n + 1):
            phi = (gap * (1 + 0.55 * max(s, 0.0))
                   + (2 * pi - 2 * gap * (1 + 0.55 * max(s, 0.0))) * i / n)
            edge = smoothstep(0.0, 0.06, min(i, n - i) / n)
            tuft = 1 + 0.20 * noise((i * 0.45, s * 30, 0.0), 1.0, 6)
            p = cape_point(phi, max(s, 0.0), lift * (0.25 + 0.75 * edge) * tuft)
            row.append(fur.vertex(p, (i / n * 26, s * 7), cape_weights(p), ("chest",)))
        rows.append(row)
    fur.grid(rows)
    return fur


def make_shirt(linen_look):
    """Pleated linen with a narrow ruffle at the neck."""
    shirt = Patch("shirt", linen_look)
    n = 112
    rows = []
    for t, grow, wave, v in ((-0.35, 0.006, 0, 0), (0.2, 0.002, 0.0005, 0.3),
                             (0.55, 0.0015, 0.0006, 0.5), (0.82, 0.002, 0.0007, 0.7),
                             (0.92, 0.0030, 0.0012, 0.8), (0.97, 0.0045, 0.0016, 0.9),
                             (0.98, 0.0056, 0.0016, 1.0)):
        row = []
        for i in range(n + 1):
            phi = 2 * pi * (i % n) / n + pi
            wide = 0.0050 + 0.0065 * max(0.0, cos(phi))  # a man's neck, its larynx in front
            p = neck_ring(phi, t, grow + wide + wave * sin(phi * 14))
            row.append(shirt.vertex((p[0], p[1] + (0.5 * wave * cos(phi * 14) if t > 0.9 else 0.0),
                                     p[2]), (i / n * 8, v),
                                    neck_weights(p), ("linen",)))
        rows.append(row)
    shirt.grid(rows)
    return shirt


# ---- chain ---------------------------------------------------------------------------------------
def make_chain(metal_look):
    """A chain over the fur with a small bell: he has cast many."""
    patch = Patch("chain", metal_look)
    links = []
    for i in range(-16, 17):
        t = i / 16
        phi = 1.02 * t
        s = 0.30 + 0.46 * (1 - t * t) ** 0.75
        c = cape_point(phi, min(s, 0.80), 0.0255)
        if s > 0.70:
            c = (c[0], c[1] - 0.05 * (s - 0.70), c[2])
        links.append(c)
    for k, c in enumerate(links):
        ahead, behind = links[min(k + 1, len(links) - 1)], links[max(k - 1, 0)]
        along = unit(sub(ahead, behind))
        out = unit((sin(1.0 * c[0] * 8), 0.35, cos(c[0] * 8)))
        across = unit(cross(along, out))
        u = across if k % 2 else unit(cross(along, across))
        tube(patch, oval(c, along, 0.0104, u, 0.0056, 8), 0.0014, cape_weights(c), 4, True)
    c = links[len(links) // 2]
    weights = cape_weights(c)
    rows = []
    for y, r in ((-0.004, 0.0020), (-0.007, 0.0060), (-0.011, 0.0082), (-0.022, 0.0098),
                 (-0.028, 0.0125), (-0.0315, 0.0150), (-0.0320, 0.0140)):
        rows.append([patch.vertex((c[0] + r * sin(a), c[1] + y, c[2] + r * cos(a) + 0.004),
                                  (0.5, 0.5), weights) for a in circle(14)])
    patch.grid(rows[::-1], closed=True)
    patch.fan(patch.vertex((c[0], c[1] - 0.003, c[2] + 0.004), (0.5, 0.5), weights), rows[0])
    return patch
