# SPDX-License-Identifier: Apache-2.0
"""Hair parted in the middle and combed over the ears, the padded roll, the linen veil. Head
space."""
import random
from math import cos, pi, sin

from dress import CAPE_CENTER, body, cape_under, cape_weights
from face_form import HEAD, face
from form import (add, cast, circle, cross, curve, dot, ellipsoid, gradient, join, length, lerp,
                  mad, mix, noise, rotate,
                  smoothstep, sub, unit)
from patch import Patch
from rig import blend, scaled

CENTER = (0.0, 0.005, -0.010)

# edges of the left half of the hair, from the parting to the nape: along the forehead, and over the
# crown
HAIRLINE = [(0.0, 0.0630, 0.083), (0.014, 0.0625, 0.082), (0.029, 0.0570, 0.076),
            (0.042, 0.0460, 0.066),
            (0.0515, 0.0315, 0.055), (0.0575, 0.0110, 0.047), (0.0625, -0.0090, 0.038),
            (0.0660, -0.0270, 0.023),
            (0.0650, -0.0410, 0.000), (0.058, -0.0460, -0.032), (0.042, -0.0470, -0.070)]
CROWN = [(0.0, 0.1120, -0.040), (0.018, 0.1100, -0.044), (0.036, 0.1000, -0.050),
         (0.052, 0.0840, -0.056),
         (0.064, 0.0620, -0.062), (0.070, 0.0400, -0.066), (0.070, 0.0200, -0.068),
         (0.066, 0.0000, -0.074),
         (0.060, -0.0180, -0.078), (0.050, -0.0300, -0.080), (0.040, -0.0400, -0.080)]


def hair(p):
    q = (abs(p[0]), p[1], p[2])
    d = ellipsoid(q, (0, 0.028, -0.008), (0.0745, 0.0860, 0.1010))
    return join(d, ellipsoid(q, (0.0610, -0.0080, -0.0040), (0.0180, 0.0370, 0.0340)), 0.024)


def along(points, s):
    x = s * (len(points) - 1)
    i = min(int(x), len(points) - 2)
    t = x - i
    a = points[max(i - 1, 0)]
    b, c = points[i], points[i + 1]
    d = points[min(i + 2, len(points) - 1)]
    return tuple(0.5 * (2 * q + (r - p) * t + (2 * p - 5 * q + 4 * r - e) * t * t
                        + (3 * q - p - 3 * r + e) * t ** 3)
                 for p, q, r, e in zip(a, b, c, d))


def strand_point(side, c, s):
    """Point of the hair's surface; c: 0 at the hairline .. 1 over the crown, s: 0 parting .. 1
    nape."""
    p = mix(along(HAIRLINE, s), along(CROWN, s), c)
    d = unit(sub(p, CENTER))
    lay = cast(face, CENTER, d, 0.16)
    top = cast(hair, CENTER, d, 0.16)
    wave = 0.0011 * sin(19 * s + 5 * c + side) * smoothstep(0.1, 0.35, s)
    wave += (0.0007 * noise((c * 16 + side * 40, s * 1.8, 0.3), 1.0)
             + 0.0002 * noise((c * 70, s * 3.0, side), 1.0))
    full = max(dot(sub(top, CENTER), d), dot(sub(lay, CENTER), d) + 0.0045) + 0.002 + wave
    skin = dot(sub(lay, CENTER), d)
    rise = smoothstep(0.0, 0.13, c) ** 0.7
    part = 0.35 + 0.65 * smoothstep(0.0, 0.13, s)
    r = lerp(skin - 0.0016, full, rise * part if rise * part < 1 else 1)
    p = mad(CENTER, d, r)
    return (side * p[0], p[1], p[2])


def make_hair(look):
    """The closed ground that strands lie on."""
    patch = Patch("hair", look)
    nc, ns = 16, 22
    for side in (1, -1):
        rows = []
        for i in range(nc + 1):
            c = (i / nc) ** 1.35
            row = []
            for j in range(ns + 1):
                s = j / ns
                p = strand_point(side, c, s ** 1.15)
                row.append(patch.vertex(p, (0.5 * c + (0.5 if side < 0 else 0.0), s),
                                        {"skullbase": 1.0}, ("hair",)))
            rows.append(row)
        patch.grid(rows, flip=side < 0)
    return patch


def ribbon(patch, points, outs, width, height, u, weights, tag, span=0.026):
    """A lock: a strip with a raised middle that tapers towards its ends; `u`, `span`: its place
    across the texture."""
    rows = []
    n = len(points) - 1
    for k, (p, out) in enumerate(zip(points, outs)):
        t = k / n
        along = unit(sub(points[min(k + 1, n)], points[max(k - 1, 0)]))
        across = unit(cross(along, out))
        w = width * min(1.0, 0.25 + 4 * t, 2.2 * (1 - t) + 0.06)
        row = []
        for e, lift in (((-1, 0.0), (0, 1.0), (1, 0.0)) if height else ((-1, 0.0), (1, 0.0))):
            q = mad(mad(p, across, 0.5 * w * e), out, height * lift * (w / width))
            row.append(patch.vertex(q, (u + span * e, t),
                                    weights(p) if callable(weights) else weights, tag))
        rows.append(row)
    patch.grid(rows)


def make_strands(look):
    """Locks that break up the combed surface, and the fine hairs that never stay in place."""
    patch = Patch("strands", look)
    rng = random.Random(3)
    for side in (1, -1):
        for kind, count in (("lock", 32), ("hair", 36), ("wisp", 80)):
            for k in range(count):
                lock = kind == "lock"
                if kind == "wisp":
                    wisp(patch, rng, side)
                    continue
                c = ((k + rng.random()) / count) ** 1.3 * 0.92
                s0 = rng.uniform(0.0, 0.12) if lock else rng.uniform(0.05, 0.55)
                s1 = min(1.0, s0 + (rng.uniform(0.70, 1.0) if lock else rng.uniform(0.22, 0.5)))
                if not lock and k % 3 == 0:
                    c = rng.uniform(-0.012, 0.03)  # at the hairline they are finest and loosest
                drift, astray = rng.uniform(-0.05, 0.05), rng.uniform(0.0008, 0.0042)
                points, outs = [], []
                n = 7 if lock else 5
                for i in range(n + 1):
                    t = i / n
                    p = strand_point(1, max(c + drift * t, -0.015), (s0 + (s1 - s0) * t) ** 1.15)
                    out = unit(sub(p, CENTER))
                    lift = 0.0002 + 0.0006 * sin(pi * t) if lock else 0.0004 + astray * t * t
                    p = mad(p, out, lift)
                    points.append((side * p[0], p[1], p[2]))
                    outs.append((side * out[0], out[1], out[2]))
                u = 0.5 * max(c, 0.0) + (0.5 if side < 0 else 0.0) + rng.uniform(-0.02, 0.02)
                ribbon(patch, points, outs,
                       rng.uniform(0.0030, 0.0065) if lock else rng.uniform(0.00024, 0.00042),
                       rng.uniform(0.0002, 0.0006) if lock else 0.0, u, {"skullbase": 1.0},
                       ("hair",))
    return patch


def wisp(patch, rng, side):
    """A fine hair that grows out of the skin before the hairline and lies down on the combed hair:
    no edge is sharp."""
    s = rng.uniform(0.03, 0.80)
    ahead, reach, turn = rng.uniform(0.006, 0.050), rng.uniform(0.05, 0.12), rng.uniform(0.03, 0.09)
    points, outs = [], []
    n = 3
    for i in range(n + 1):
        t = i / n
        p = strand_point(1, reach * t - ahead * (1 - t), s + turn * t)
        out = unit(sub(p, CENTER))
        p = mad(p, out, 0.0016 * (1 - smoothstep(0.0, 0.6, t)) + 0.0007 * sin(pi * t) + 0.0003)
        points.append((side * p[0], p[1], p[2]))
        outs.append((side * out[0], out[1], out[2]))
    ribbon(patch, points, outs, rng.uniform(0.00022, 0.00040), 0.0,
           rng.uniform(0.02, 0.15) + (0.5 if side < 0 else 0.0),
           {"skullbase": 1.0}, ("hair",))


def make_fall(look):
    """Loose hair from behind the ears down to the collar."""
    patch = Patch("fall", look)
    rng = random.Random(29)
    for kind, count in (("under", 28), ("lock", 72)):
        for k in range(count):
            c = 0.02 + 0.98 * (k + rng.random()) / count
            p = strand_point(1, c, rng.uniform(0.62, 0.80) if c > 0.25 else rng.uniform(0.70, 0.86))
            out = unit(sub(p, (0.0, p[1], -0.010)))
            goal = -0.092 + 0.014 * rng.random() - 0.012 * c
            n = 5
            points, outs = [], []
            step = (p[1] - goal) / n
            curl, phase = rng.uniform(0.001, 0.005), rng.uniform(0, 6)
            for i in range(n + 1):
                t = i / n
                q = (p[0], p[1] - step * i, p[2])
                q = mad(q, out,
                        0.004 * sin(pi * min(1.0, 1.3 * t)) - 0.010 * t
                        + curl * t * sin(2.5 * pi * t + phase))
                near, least = (face(q), 0.004 + (0.006 if kind == "lock" else 0.003)
                               * min(1.0, 3 * t) * (1 - 0.3 * t))
                if near < least:
                    q = mad(q, gradient(face, q), least - near)
                points.append(q)
                outs.append(out)
            for side in (1, -1):
                ribbon(patch, [(side * q[0], q[1], q[2]) for q in points],
                       [(side * o[0], o[1], o[2]) for o in outs],
                       rng.uniform(0.014, 0.019) if kind == "under"
                       else rng.uniform(0.0016, 0.0034),
                       0.0012 if kind == "under" else 0.0, 0.5 * c, {"skullbase": 1.0}, ("hair",),
                       0.03 if kind == "under" else 0.012)
    return patch


# ---- roll ----------------------------------------------------------------------------------------
def roll_path(a):
    """Middle of the padded roll; a: 0 on top, + to the figure's left, pi at the nape."""
    top, low = (0, 0.117, 0.010), (0, -0.050, -0.088)
    middle, half = mix(top, low, 0.5), mad(mul_half(top), mul_half(low), -1)
    p = add(add(middle, tuple(x * cos(a) for x in half)), (0.0835 * sin(a), 0, 0.010 * sin(a) ** 2))
    d = unit(sub(p, CENTER))
    return mad(cast(hair, CENTER, d, 0.17), d, 0.0050 + 0.0015 * cos(a))


def mul_half(p):
    return tuple(0.5 * x for x in p)


def make_roll(look):
    patch = Patch("roll", look)
    n, m = 66, 9
    ring = [roll_path(a) for a in circle(n)]
    rows = []
    for i in range(n + 1):
        p = ring[i % n]
        ahead, behind = ring[(i + 1) % n], ring[i - 1]
        t = unit(sub(ahead, behind))
        out = unit(sub(p, CENTER))
        side = unit(cross(t, out))
        out = cross(side, t)
        a = 2 * pi * i / n
        r = 0.0125 - 0.0035 * smoothstep(0.6, 2.2, min(a, 2 * pi - a))
        r *= 1 + 0.045 * abs(sin(a * 13)) ** 0.5
        row = []
        for j in range(m + 1):
            b = 2 * pi * j / m
            q = mad(mad(p, out, r * 0.92 * sin(b)), side, r * 1.08 * cos(b))
            row.append(patch.vertex(q, (i / n * 13, j / m), {"skullbase": 1.0}, ("roll",)))
        rows.append(row)
    patch.grid(rows, flip=True)
    return patch


def make_pearls(look):
    """A row of small pearls along the front of the roll."""
    patch = Patch("pearls", look)
    for k in range(-11, 12):
        a = 0.128 * k
        p = roll_path(a)
        d = unit(sub(p, CENTER))
        front = unit((d[0] * 0.3, d[1] * 0.3 + 0.15, 1.0))
        c = mad(p, unit(mix(d, front, 0.62)), 0.0118)
        ball(patch, c, 0.0029 if k % 2 else 0.0022, {"skullbase": 1.0})
    return patch


def ball(patch, c, r, weights, segments=6, rings=4):
    top = patch.vertex((c[0], c[1] + r, c[2]), (0.5, 1), weights)
    rows = []
    for i in range(1, rings):
        a = pi * i / rings
        rows.append([patch.vertex((c[0] + r * sin(a) * sin(b), c[1] + r * cos(a),
                                   c[2] + r * sin(a) * cos(b)),
                                  (0.5, 0.5), weights) for b in circle(segments)])
    patch.fan(top, rows[0])
    patch.grid(rows, closed=True, flip=True)
    patch.fan(patch.vertex((c[0], c[1] - r, c[2]), (0.5, 0), weights), rows[-1], flip=True)


# ---- veil ----------------------------------------------------------------------------------------
def veil_weights(p):
    """Head at the top; where it lies on the shoulders, as the cape right below it, so that neither
    comes through the other when an arm is raised. Figure space."""
    head = smoothstep(1.36, 1.50, p[1])
    below, gap = cape_under(p) if head < 1 else (p, 1.0)
    # on a shoulder it stays there
    head *= 1 - smoothstep(0.06, 0.11, abs(p[0])) * smoothstep(0.07, 0.02, gap)
    return blend([("skullbase", head)] + scaled(cape_weights(below), 1 - head))


# from the nape to its edges: by the ears, the neck, over the shoulders
VEIL_TURN = [(0.0, 1.30), (0.32, 1.70), (0.45, 1.62), (0.90, 1.10)]


def above_cape(p):
    """Lifted where it would lie lower than cloth on cloth: folds end there. Figure space."""
    under, gap = cape_under(p)
    least = 0.009 * smoothstep(1.47, 1.42, p[1])
    return mad(p, unit(sub(p, CAPE_CENTER)), max(least - gap, 0.0))


TURNED = 7  # columns of cloth turned in at each edge


def turn_in(edge, s, t):
    """Cloth turned in from the veil's edge: s 0 there .. 1 at the neck; t 0 on the roll .. 1 at the
    hem. Figure space."""
    s *= lerp(0.03, 1.0, smoothstep(0.40, 0.56, t))  # below the roll; above it lies close anyway
    o = (0.0, edge[1], -0.030)
    out = sub(edge, o)
    far = length(out)
    out = rotate(unit(out), (0, 0, 0), (0.0, 1.0, 0.0), -0.16 * s * (1 if edge[0] > 0 else -1))
    above = smoothstep(1.400, 1.432, edge[1])  # of the collar
    near = cast(lambda p: min(lerp(body(p) - 0.010, face(sub(p, HEAD)) + 0.002, above),
                              hair(sub(p, HEAD)) - 0.003), o, out, 0.35)
    close = min(dot(sub(near, o), out), far - 0.0004)
    p = mad(o, out, lerp(far, close, s))
    soft = smoothstep(0.05, 0.35, t) * (far - close)
    return (p[0], p[1],
            p[2] + soft * (0.12 * sin(pi * s) + 0.11 * sin(4 * pi * s + 2 * t) * (1 - 0.6 * s)))


def make_veil(look):
    """Linen pinned over the roll, falling behind the shoulders. Figure space."""
    patch = Patch("veil", look)
    columns, upper, lower = 44, 11, 15
    rows = [[] for _ in range(upper + lower + 1)]
    o = (0.0, 0.020, -0.020)
    for i in range(columns + 1):
        u = 2 * i / columns - 1  # -1 right .. 1 left
        psi = u * 2.30
        start = roll_path(psi)
        start = mad(start, unit(sub(start, CENTER)), 0.0080)
        start = (start[0], start[1], start[2] - 0.005)
        beta = u * VEIL_TURN[0][1]
        d0, d1 = unit(sub(start, o)), unit((sin(beta), -0.10 - 0.45 * abs(u) ** 3, -cos(beta)))
        r0 = dot(sub(start, o), d0)
        middle = None
        for k in range(upper + 1):
            t = k / upper
            d = unit(mix(d0, d1, t * t * (3 - 2 * t) * 0.5 + t * 0.5))
            r = dot(sub(cast(hair, o, d, 0.18), o), d) + lerp(0.010, 0.0165, t)
            if k == 0:
                r = r0
            middle = mad(o, d, r)
            fold = 0.0022 * t * sin(beta * 9 + 1.5 * t)
            rows[k].append((add(HEAD, mad(middle, d, fold)), (u, 0.5 * t)))
        middle = add(HEAD, middle)
        end_y = lerp(1.215, 1.270, abs(u) ** 2.0)
        for k in range(1, lower + 1):
            t = k / lower
            beta = u * curve(VEIL_TURN, t)
            out = (sin(beta), 0.0, -cos(beta))
            x, _, z = rotate(middle, (0.0, 0.0, -0.010), (0.0, 1.0, 0.0),
                             u * VEIL_TURN[0][1] - beta)
            q = mad((x, lerp(middle[1], end_y, t), z), out, 0.030 * t ** 1.2)
            gap = body(q) - 0.034
            if gap < 0.012:  # lie softly on the shoulders
                far = cast(lambda p: body(p) - 0.034, (0.0, q[1], -0.03), out, 0.35)
                reach = (far[0] - q[0]) * out[0] + (far[2] - q[2]) * out[2]
                q = mad(q, out, max(reach, 0.0))
            amount = 0.0030 + 0.0095 * smoothstep(0, 0.8, t)
            fold = amount * (sin(beta * 13 + 0.8 * sin(3 * t + u)) + 0.35 * sin(beta * 27 + 2 * t))
            q = above_cape(mad(q, out, fold + 0.55 * amount))
            rows[upper + k].append((q, (u, 0.5 + 0.5 * t)))
    # both edges turn in towards the neck: from in front one sees cloth, no hollow
    for k, row in enumerate(rows):
        t = k / (upper + lower)
        turned = [[turn_in(row[end][0], j / TURNED, t) for j in range(1, TURNED + 1)]
                  for end in (0, -1)]
        v = row[0][1][1]
        rows[k] = ([(p, (-1 - 0.04 * (j + 1), v)) for j, p in reversed(list(enumerate(turned[0])))]
                   + row
                   + [(p, (1 + 0.04 * (j + 1), v)) for j, p in enumerate(turned[1])])
    ids = [[patch.vertex(p, (uv[0] * 2.2, uv[1] * 3.2), veil_weights(p), ("veil",))
            for p, uv in row] for row in rows]
    patch.grid(ids)
    return patch
