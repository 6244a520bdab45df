# SPDX-License-Identifier: Apache-2.0
"""Belt with the keys of the castle, shoes. Figure space."""
from math import cos, pi, sin

from dress import WAIST_Y, disc, skirt_point
from form import circle, cross, dot, lerp, mad, smoothstep, sub, unit
from patch import Patch
from rig import blend, skirt_weights


def tube(patch, points, radius, weights, segments=8, closed=False):
    """A round rod along points."""
    n = len(points)
    rows = []
    side = None
    for i, p in enumerate(points):
        a = points[i - 1] if i or closed else p
        b = points[(i + 1) % n] if i + 1 < n or closed else p
        t = unit(sub(b, a))
        side = (unit(cross(t, (0.31, 0.23, 0.92))) if side is None
                else unit(mad(side, t, -dot(side, t))))
        up = cross(t, side)
        r = radius(i / max(n - 1, 1)) if callable(radius) else radius
        rows.append([patch.vertex(mad(mad(p, side, r * cos(b)), up, r * sin(b)),
                                  (i * 0.3, j / segments), weights)
                     for j, b in enumerate(circle(segments))])
    if closed:
        rows.append(rows[0])
    patch.grid(rows, closed=True, flip=False)
    if not closed:
        patch.fan(patch.vertex(points[0], (0, 0), weights), rows[0], flip=True)
        patch.fan(patch.vertex(points[-1], (0, 0), weights), rows[-1])


def oval(c, u, a, v, b, count):
    return [mad(mad(c, u, a * cos(t)), v, b * sin(t)) for t in circle(count)]


def belt_point(phi, y, lift):
    y = y - 0.010 * max(0.0, cos(phi)) ** 2
    p = skirt_point(phi, WAIST_Y)
    d = unit((sin(phi), 0, cos(phi)))
    return (p[0] + d[0] * lift, y, p[2] + d[2] * lift)


def make_belt(leather, gold):
    strap, metal = Patch("belt", leather), Patch("belt_metal", gold)
    n = 96
    rows = []
    for y, lift in ((1.045, 0.004), (1.047, 0.0085), (1.0715, 0.0085), (1.0735, 0.004)):
        rows.append([strap.vertex(p, (i / n * 20, (y - 1.045) / 0.0285),
                                  skirt_weights((p[0], 1.0, p[2])), ("belt",))
                     for i in range(n + 1)
                     for p in [belt_point(2 * pi * (i % n) / n + pi, y, lift)]])
    strap.grid(rows)
    c = belt_point(0, 1.0595, 0.0105)
    disc(metal, c, (0, 0, 1), 0.0205, 0.005, skirt_weights((0, 1.0, 0.1)))
    for k in range(-9, 10):
        if k:
            phi = 0.30 * k
            c = belt_point(phi, 1.0595, 0.0085)
            disc(metal, c, unit((sin(phi), 0, cos(phi))), 0.0065, 0.003,
                 skirt_weights((c[0], 1.0, c[2])), 7)
    return strap, metal


def make_keys(metal_look):
    """Three keys on a ring and a chain, at the left of the front."""
    patch = Patch("keys", metal_look)
    phi = 0.62
    top = belt_point(phi, 1.048, 0.012)
    weights = blend([("sacroiliac", 0.72), ("l_hip", 0.28)])
    links = 9
    y0 = top[1]
    out = unit((sin(phi), 0, cos(phi)))
    across = unit(cross((0, 1, 0), out))

    def hang(y):
        p = skirt_point(phi, y)
        lift = 0.014 + 0.006
        return (p[0] + out[0] * lift, y, p[2] + out[2] * lift)

    def front(y):  # a chain hangs straight: keep in front of everything above
        above = [hang(y0 - 0.01 * i) for i in range(int((y0 - y) / 0.01) + 1)]
        best = max(above, key=lambda q: dot(q, out))
        p = hang(y)
        s = (best[0] - p[0]) * out[0] + (best[2] - p[2]) * out[2]
        return mad(p, out, s)

    for k in range(links):
        c = front(y0 - 0.0065 - 0.0135 * k)
        u = across if k % 2 else out
        tube(patch, oval(c, (0, 1, 0), 0.0090, u, 0.0048, 8), 0.0014, weights, 4, True)
    y = y0 - 0.0065 - 0.0135 * links - 0.014
    c = front(y)
    tube(patch, oval(c, (0, 1, 0), 0.018, across, 0.018, 16), 0.0018, weights, 5, True)
    for angle, size, fan_out in ((-0.22, 0.105, -0.004), (0.04, 0.125, 0.002),
                                 (0.26, 0.092, 0.007)):
        slope = sub(skirt_point(phi, c[1] - 0.12), skirt_point(phi, c[1]))
        lean = (slope[0] * out[0] + slope[2] * out[2]) / 0.12
        d = unit(mad(mad((0, -1, 0), across, angle), out, lean + 0.05))
        s = unit(cross(d, out))
        p = mad(mad(c, d, 0.017), out, fan_out)
        bow = mad(p, d, 0.012)
        tube(patch, oval(bow, d, 0.0125, s, 0.0105, 11), 0.0021, weights, 5, True)
        end = mad(p, d, size)
        shank = [mad(p, d, 0.0245), mad(p, d, 0.028), mad(p, d, 0.030), end]
        tube(patch, shank, lambda t: 0.0036 if 0.2 < t < 0.5 else 0.0024, weights, 6)
        for q, wide in ((0.86, 0.014), (0.95, 0.017)):  # the bit
            base = mad(p, d, size * q)
            tube(patch, [base, mad(base, s, wide)], 0.0027, weights, 6)
        base = mad(mad(p, d, size * 0.905), s, 0.0095)
        tube(patch, [mad(base, d, -0.006), mad(base, d, 0.006)], 0.0022, weights, 6)
    return patch


def make_shoes(leather):
    patch = Patch("shoes", leather)
    for side, name in ((1, "l"), (-1, "r")):
        rows = []
        for k in range(15):
            t = k / 14
            z = lerp(-0.065, 0.168, t)
            w = (0.037 * (max(1e-3, 1 - abs(2 * t - 1) ** 3.2)) ** 0.5
                 * (0.84 + 0.2 * smoothstep(0.3, 0.7, t)))
            h = (lerp(0.085, 0.030, smoothstep(0.25, 0.9, t))
                 * (max(1e-3, 1 - abs(2 * t - 1) ** 4)) ** 0.5)
            row = []
            for q in range(14):
                b = 2 * pi * q / 14
                x = 0.096 + 0.012 * t + w * cos(b)
                y = max(0.0, h * (0.42 + 0.58 * sin(b)))
                toe = smoothstep(0.075, 0.105, z)
                row.append(patch.vertex((side * x, y, z), (t, q / 14),
                                        blend([(name + "_talocrural", 1 - toe),
         (name + "_metatarsophalangeal_2", toe)]), ("shoe",)))
            rows.append(row)
        patch.grid(rows, closed=True, flip=side < 0)
        for r, flip in ((rows[0], side > 0), (rows[-1], side < 0)):
            m = tuple(sum(patch.positions[i][a] for i in r) / 14 for a in range(3))
            patch.fan(patch.vertex(m, (0, 0), patch.weights[r[0]]), r, flip=not flip)
    return patch
