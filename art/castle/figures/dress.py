# SPDX-License-Identifier: Apache-2.0
"""The clothes: gown, sleeves, shoulder cape (the Goller of Bohemian and German women about 1530),
linen, belt, keys and shoes. Figure space."""
from math import asin, atan2, cos, pi, sin

from form import (bell, capsule, cast, circle, clamp, cross, curve, ellipsoid, join, length, lerp,
                  mad, mix,
                  noise, smoothstep, sub, unit)
from patch import Patch
from person import WHO
from rig import ELBOW, WRIST, arm_weights, blend, scaled, skirt_weights, spine, torso_weights

WAIST_Y = 1.062


def trunk(p):
    """The body under the clothes, without arms and head."""
    x, y, z = abs(p[0]), p[1], p[2]
    q = (x, y, z)
    d = ellipsoid(q, (0, 1.235, -0.028), (0.132, 0.190, 0.098))
    bust = (0.066, 1.232, 0.040), (0.060, 0.062, 0.056)
    if WHO.bust < 0.5:  # a man's chest
        bust = (0.062, 1.250, 0.018), (0.066, 0.060, 0.060)
    d = join(d, ellipsoid(q, *bust), 0.045)
    d = join(d, capsule(q, (0.0, 1.360, -0.034), (0.126, 1.346, -0.028), 0.050, 0.042), 0.045)
    w = WHO.waist
    d = join(d, ellipsoid(q, (0, 1.062, -0.018), (0.116 + w, 0.110, 0.088 + w)), 0.05)
    if WHO.belly:
        d = join(d, ellipsoid(q, (0, 1.075, 0.030), (0.100, 0.115, 0.035 + 0.055 * WHO.belly)),
                 0.05)
    d = join(d, ellipsoid(q, (0, 0.915, -0.018), (0.158, 0.120, 0.120)), 0.05)
    return d


def body(p):
    """Trunk, neck and the upper sleeves: what cape and veil lie on."""
    x, y, z = abs(p[0]), p[1], p[2]
    q = (x, y, z)
    d = join(trunk(q), capsule(q, (0, 1.32, -0.032), (0, 1.50, -0.010), 0.056, 0.050), 0.03)
    d = join(d, capsule(q, (0.0, 1.408, -0.042), (0.125, 1.366, -0.030), 0.036, 0.028), 0.05)
    return join(d, capsule(q, (0.146, 1.345, -0.022), (0.184, 1.150, -0.028), 0.053, 0.062), 0.035)


# ---- gown ----------------------------------------------------------------------------------------
HALF_WIDTH = [(0.0, 0.292), (0.02, 0.290), (0.30, 0.245), (0.60, 0.203), (0.80, 0.176),
              (0.92, 0.159), (1.0, 0.138),
              (1.062, 0.121)]
FRONT = [(0.0, 0.285), (0.30, 0.236), (0.60, 0.190), (0.80, 0.152), (0.92, 0.126), (1.0, 0.104),
         (1.062, 0.084)]
BACK = [(0.0, 0.325), (0.30, 0.272), (0.60, 0.222), (0.80, 0.184), (0.92, 0.160), (1.0, 0.132),
        (1.062, 0.108)]


def skirt_point(phi, y):
    """phi: 0 in front, growing to the figure's left."""
    a, f, b = curve(HALF_WIDTH, y), curve(FRONT, y), curve(BACK, y)
    s, c = sin(phi), cos(phi)
    wider = smoothstep(0.55, 0.98, y)
    a += WHO.waist * wider
    f += (WHO.waist + 0.022 * WHO.belly) * wider
    b += WHO.waist * wider
    depth = f if c > 0 else b
    below = (WAIST_Y - y) / WAIST_Y
    x, z = a * s, depth * c - 0.018
    n = unit((s / a, 0, c / depth))
    sway = 0.22 * noise((cos(phi) * 1.3, sin(phi) * 1.3, y * 0.7), 1.0, 3)
    w1 = phi * 42 + 1.2 * noise((cos(phi) * 2, sin(phi) * 2, 0.0), 1.0, 5)
    w2 = (phi + sway) * 9.5 + 0.9 * sin(2 * phi + 0.7)
    gather = 0.0030 * sin(w1) * smoothstep(0.0, 0.03, below) * smoothstep(0.34, 0.08, below)
    broad = ((abs(sin(w2)) ** 0.75 - 0.62) * (0.004 + 0.052 * below ** 1.15)
             * smoothstep(0.0, 0.16, below))
    fine = 0.006 * below * sin(phi * 31 + 4 * noise((cos(phi), sin(phi), y), 2.0, 9))
    r = gather + broad + fine + 0.006 * below * noise((x * 5, y * 3, z * 5), 1.0, 2)
    return (x + n[0] * r, y, z + n[2] * r)


def make_skirt(gown, trim):
    columns = 104
    ys = [0.012, 0.050, 0.085, 0.108, 0.125, 0.19, 0.27, 0.35, 0.43, 0.51, 0.59, 0.67, 0.75, 0.82,
          0.88,
          0.93, 0.97, 1.00, 1.025, 1.045, 1.062]
    cloth, band = Patch("skirt", gown), Patch("skirt_trim", trim)

    def row(patch, y, v, tile, inset=0.0):
        ids = []
        for i in range(columns + 1):
            phi = 2 * pi * (i % columns) / columns + pi
            p = skirt_point(phi, y)
            if inset:
                p = (p[0] * (1 - inset), y + 0.012, p[2] * (1 - inset))
            ids.append(patch.vertex(p, (i / columns * tile, v), skirt_weights(p), ("skirt",)))
        return ids

    def is_trim(y):
        return 0.050 <= y < 0.085 - 1e-6 or 0.108 <= y < 0.125 - 1e-6

    cloth.grid([row(cloth, 0.012, -0.05, 9, 0.05), row(cloth, 0.012, 0.0, 9)])
    for low, high in zip(ys, ys[1:]):
        if is_trim(low):
            v0, v1 = ((low - 0.050) / 0.035, (high - 0.050) / 0.035) if low < 0.1 else (0.25, 0.75)
            band.grid([row(band, low, v0, 44), row(band, high, v1, 44)])
    # rows of cloth are shared between neighbours, so build each run once
    run = []
    for k, y in enumerate(ys):
        run.append(row(cloth, y, y * 5.2, 9))
        if k + 1 == len(ys) or is_trim(y):
            cloth.grid(run)
            run = []
        if k + 1 < len(ys) and is_trim(y):
            run = []
    return cloth, band


def make_bodice(gown, trim):
    """From the waist up to under the cape, laced flat; two embroidered bands run down the front."""
    columns = 56
    ys = [1.058, 1.085, 1.11, 1.14, 1.17, 1.195, 1.22, 1.245, 1.27, 1.295, 1.32, 1.345]
    cloth, band = Patch("bodice", gown), Patch("bodice_trim", trim)

    def point(phi, y, lift=0.0):
        o = (0.0, y, -0.022)
        d = (sin(phi), 0.0, cos(phi))
        p = mad(cast(trunk, o, d, 0.3), d, 0.007 + lift)
        crease = 0.0018 * noise((phi * 6, y * 26, 0.0), 1.0, 4) * smoothstep(1.20, 1.08, y)
        return mad(p, d, crease)

    rows = [[cloth.vertex(p, (i / columns * 5, y * 5.2), torso_weights(p, 0.35), ("chest",))
             for i in range(columns + 1) for p in [point(2 * pi * (i % columns) / columns + pi, y)]]
             for y in ys]
    cloth.grid(rows)
    for side in (1, -1):
        lines = []
        for y in ys[:-3]:  # they end under the cape
            x0 = lerp(0.014, 0.058, smoothstep(1.05, 1.30, y))
            line = []
            for e in range(4):
                x = x0 + 0.017 * e / 3
                phi = atan2(x, 0.105)
                p = point(side * phi, y, 0.0018 if 0 < e < 3 else 0.0003)
                line.append(band.vertex(p, (y * 22, e / 3), torso_weights(p, 0.35), ("chest",)))
            lines.append(line)
        band.grid(lines, flip=side < 0)
    return cloth, band


# ---- sleeves -------------------------------------------------------------------------------------
SLEEVE = [(0.0, 0.040), (0.06, 0.050), (0.16, 0.056), (0.28, 0.061), (0.40, 0.057), (0.48, 0.051),
          (0.56, 0.053),
          (0.68, 0.059), (0.80, 0.060), (0.89, 0.053), (0.945, 0.037), (0.965, 0.0335),
          (1.0, 0.0335)]
ARM_TOP = (0.128, 1.372, -0.024)
CUFF_END = mad(WRIST, unit(sub(WRIST, ELBOW)), -0.006)


def arm_axis(t):
    if t < 0.5:
        p = mix(ARM_TOP, ELBOW, t / 0.5)
        bow = sin(pi * t / 0.5) * 0.010
        return (p[0] + bow, p[1], p[2])
    return mix(ELBOW, CUFF_END, (t - 0.5) / 0.5)


def sleeve_point(t, a, side):
    """a: 0 in front, growing outwards (away from the body)."""
    c = arm_axis(t)
    d = unit(sub(arm_axis(min(t + 0.02, 1.0)), arm_axis(max(t - 0.02, 0.0))))
    front = unit(mad((0, 0, 1), d, -d[2]))
    out = cross(front, d)
    if out[0] < 0:
        out = tuple(-v for v in out)
    r = (curve(SLEEVE, t)
         * lerp(1.0, WHO.sleeve, smoothstep(0.10, 0.35, t) * smoothstep(0.97, 0.85, t)))
    inner = 1 - 0.22 * max(0.0, -sin(a)) * smoothstep(0.25, 0.55, t)
    u, v = cos(a) * 2, sin(a) * 2
    loose = smoothstep(0.02, 0.15, t) * smoothstep(0.97, 0.88, t)
    gather = (sin(a * 17 + 3 * noise((u, v, t * 2), 0.7, 1)) * 0.0026
              * (bell(t - 0.93, 0.06) + 0.7 * bell(t - 0.02, 0.10)))
    elbow = (0.0050 * bell(t - 0.50, 0.10)
             * sin(t * 95 + 2.2 * u + noise((u, v, t * 4), 1.0, side)) * (0.45 + 0.55 * cos(a)))
    soft = (0.0065 * noise((u * 0.8, v * 0.8, t * 7), 1.0, 6 + side)
            + 0.003 * noise((u * 2, v * 2, t * 9), 1.0, 8))
    r = r * inner + loose * (elbow + soft) + gather
    p = mad(mad(c, front, r * cos(a)), out, r * sin(a))
    return (side * p[0], p[1], p[2])


def make_sleeves(gown, trim, linen):
    cloth, cuff, frill = Patch("sleeves", gown), Patch("cuffs", trim), Patch("frills", linen)
    n = 28
    ts = [0, .03, .06, .10, .14, .19, .24, .29, .34, .39, .43, .46, .49, .52, .55, .59, .64, .69,
          .74, .79, .83, .87, .90, .925,
          .945, .962]
    for side, name in ((1, "l"), (-1, "r")):
        def ring(patch, t, v, tile, grow=0.0, y_shift=0.0, wave=0.0):
            ids = []
            for i in range(n + 1):
                a = 2 * pi * (i % n) / n + pi * 1.5
                p = sleeve_point(t, a, side)
                c = arm_axis(t)
                c = (side * c[0], c[1], c[2])
                extra = grow + wave * (sin(a * 9) + 0.4 * sin(a * 5 + 1))
                p = mad(p, unit(sub(p, c)), extra)
                p = (p[0], p[1] + y_shift + 0.3 * wave * cos(a * 9), p[2])
                ids.append(patch.vertex(p, (i / n * tile, v), arm_weights(p, name), ("sleeve",)))
            return ids
        flip = side > 0
        cloth.grid([ring(cloth, t, t * 3.2, 2) for t in ts], flip=not flip)
        cuff.grid([ring(cuff, 0.958, 0.0, 5, 0.0005), ring(cuff, 0.962, 0.1, 5, 0.0030),
                   ring(cuff, 0.995, 0.9, 5, 0.0030),
                   ring(cuff, 1.0, 1.0, 5, 0.0)], flip=not flip)
        frill.grid([ring(frill, 0.99, 0.0, 3, -0.003), ring(frill, 1.0, 0.1, 3, -0.0015, -0.004),
                    ring(frill, 1.0, 0.25, 3, 0.0005, -0.012, 0.0012),
                    ring(frill, 1.0, 0.45, 3, 0.0025, -0.021, 0.0026)],
                   flip=not flip)
    return cloth, cuff, frill


# ---- shoulder cape and collar --------------------------------------------------------------------
CAPE_CENTER = (0.0, 1.235, -0.030)


def cape_edges(phi):
    """Elevations of its lower edge and of its neck, seen from its centre."""
    c = cos(phi)
    return (0.145 + 0.10 * sin(phi) ** 2 + (0.02 if c < 0 else -0.02) * c * c,
            1.22 + 0.06 * sin(phi) ** 2)


def cape_point(phi, s, lift=0.0):
    """s: 0 at the neck .. 1 at the lower edge; phi: 0 in front."""
    c = cos(phi)
    low, high = cape_edges(phi)
    e = lerp(high, low, s ** 0.85)
    d = (sin(phi) * cos(e), sin(e), c * cos(e))
    p = mad(cast(body, CAPE_CENTER, d, 0.35), d, lerp(0.006, 0.0155, smoothstep(0, 0.35, s)) + lift)
    turn = phi * 8 + 0.9 * sin(2 * phi + 0.4) + 0.5 * noise((cos(phi) * 2, sin(phi) * 2, s), 1.0, 7)
    # rounded ridges, sharp valleys
    fold = (abs(sin(turn)) ** 0.7 - 0.55) * (0.55 + 0.45 * sin(3 * phi + 1.0))
    wave = (0.0105 * s ** 1.6 * fold * (1 - 0.55 * bell(phi, 0.45))
            + 0.0022 * s * noise((p[0] * 16, p[1] * 9, p[2] * 16), 1.0, 3))
    return mad(p, unit((d[0], 0.2, d[2])), wave)


def cape_weights(p):
    return torso_weights(p, 0.97)


def cape_under(p):
    """What of the cape lies on the way to p from within the chest, and how far (m) p is above cloth
    and fur."""
    out = sub(p, CAPE_CENTER)
    d = unit(out)
    phi = atan2(d[0], d[2])
    low, high = cape_edges(phi)
    s = clamp((high - asin(clamp(d[1], -1.0, 1.0))) / (high - low), 0.0, 1.0) ** (1 / 0.85)
    under = cape_point(phi, s)
    fur = 0.012 * smoothstep(0.80, 0.96, s)
    return under, length(out) - length(sub(under, CAPE_CENTER)) - fur


def make_cape(velvet, trim, fur):
    cloth, band, edge = Patch("cape", velvet), Patch("cape_trim", trim), Patch("cape_fur", fur)
    n = 72

    def row(patch, s, v, tile, lift=0.0):
        ids = []
        for i in range(n + 1):
            phi = 2 * pi * (i % n) / n + pi
            p = cape_point(phi, s, lift)
            ids.append(patch.vertex(p, (i / n * tile, v), cape_weights(p), ("chest",)))
        return ids

    steps = [1.0, 0.92, 0.83, 0.73, 0.63, 0.53, 0.43, 0.33, 0.23, 0.14, 0.07, 0.0]
    cloth.grid([row(cloth, s, s * 1.5, 6) for s in steps])
    band.grid([row(band, s, v, 26, lift) for s, v, lift in
               ((0.945, 0.0, 0.0004), (0.925, 0.1, 0.0020), (0.845, 0.9, 0.0020),
                (0.825, 1.0, 0.0004))])
    # a soft roll of fur closes the lower edge
    rolls = []
    for k in range(6):
        b = 2 * pi * k / 5
        rolls.append([])
        for i in range(n + 1):
            phi = 2 * pi * (i % n) / n + pi
            p = cape_point(phi, 0.985)
            d = unit((sin(phi), 0.0, cos(phi)))
            r = 0.0095 * (1 + 0.16 * noise((p[0] * 90, p[1] * 90 + b, p[2] * 90), 1.0, 4))
            q = (p[0] + d[0] * r * cos(b), p[1] + r * sin(b), p[2] + d[2] * r * cos(b))
            rolls[-1].append(edge.vertex(q, (i / n * 24, k / 5), cape_weights(p), ("chest",)))
    edge.grid(rolls)
    return cloth, band, edge


def neck_ring(phi, t, grow=0.0, rise=0.0):
    """Round the neck; t: 0 at its root .. 1 under the chin (lower in front)."""
    c = cos(phi)
    y = lerp(1.386, 1.434, t) - 0.010 * t * c - 0.012 * (1 - t) * c
    o = (0.0, y, -0.026 + 0.25 * (y - 1.40))
    y += rise * max(t, 0.0) * sin(phi) ** 2  # the shoulders rise towards the neck
    r = 0.0505 + 0.005 * (1 - t) + 0.006 * t + grow
    return (o[0] + r * 0.98 * sin(phi), y, o[2] + r * 1.02 * c)


def make_collar(linen, velvet, gold):
    """Velvet stand-up collar open in front, pleated linen inside with a small ruffle, a gold
    clasp."""
    shirt, collar, clasp = Patch("chemise", linen), Patch("collar", velvet), Patch("clasp", gold)
    n = 128
    rows = []
    for t, grow, wave, v in ((-0.35, 0.004, 0, 0), (0.2, -0.001, 0.0004, 0.3),
                             (0.55, -0.001, 0.0005, 0.5), (0.86, 0.000, 0.0006, 0.7),
                             (1.00, 0.0030, 0.0016, 0.8), (1.14, 0.0065, 0.0024, 0.9),
                             (1.24, 0.0110, 0.0028, 1.0)):
        row = []
        for i in range(n + 1):
            phi = 2 * pi * (i % n) / n + pi
            p = neck_ring(phi, t, grow + wave * sin(phi * 16), 0.010)
            p = (p[0], p[1] + 0.5 * wave * cos(phi * 16) * (1 if t > 0.9 else 0), p[2])
            row.append(shirt.vertex(p, (i / n * 8, v), neck_weights(p), ("linen",)))
        rows.append(row)
    shirt.grid(rows)
    m = 64
    rows = []
    for t, grow in ((-0.45, 0.004), (-0.10, 0.0060), (0.25, 0.0065), (0.50, 0.0080), (0.66, 0.0100),
                    (0.70, 0.0085), (0.66, 0.0062),
                    (0.30, 0.0030)):
        row = []
        for i in range(m + 1):
            phi = lerp(0.16 + 0.30 * max(t, 0), 2 * pi - 0.16 - 0.30 * max(t, 0), i / m)
            p = neck_ring(phi, t, grow, 0.010)
            row.append(collar.vertex(p, (i / m * 4, t), neck_weights(p), ("linen",)))
        rows.append(row)
    collar.grid(rows)
    c = cape_point(0.0, 0.12, 0.006)
    disc(clasp, c, unit((0, 0.35, 1)), 0.0135, 0.0045, torso_weights(c))
    return shirt, collar, clasp


def neck_weights(p):
    t = smoothstep(1.37, 1.43, p[1])
    return blend(scaled(torso_weights(p), 1 - t) + scaled(spine(min(p[1] - 0.015, 1.45)), t))


def disc(patch, c, n, r, h, weights, segments=12):
    u = unit(cross((0, 1, 0), n))
    v = cross(n, u)
    rows = []
    rings = ((1.0, -0.2), (1.0, 0.35), (0.85, 0.7), (0.72, 0.45), (0.50, 0.55),
             (0.3, 1.0)) if r > 0.01 else \
        ((1.0, -0.2), (0.9, 0.6), (0.5, 1.0))
    for k, lift in rings:
        rows.append([patch.vertex(mad(mad(mad(c, u, r * k * cos(a)), v, r * k * sin(a)), n,
                                      h * lift), (0.5, 0.5), weights)
                     for a in circle(segments)])
    patch.grid(rows, closed=True)
    patch.fan(patch.vertex(mad(c, n, h * 1.15), (0.5, 0.5), weights), rows[-1])
