# SPDX-License-Identifier: Apache-2.0
"""The colours of skin, lips, brows, eyes and hands, painted by place on the body."""
from math import atan2, cos, exp, hypot, sin, sqrt

from face import lid_opening
from face_form import EYE, MOUTH_HALF, SMILE_LINE, UPPER_LID_LINE, lower_lip_y, part_y, upper_lip_y
from form import add, bell, clamp, cross, curve, dot, fractal, length, lerp, mad, noise, smoothstep, sub, unit
from hair import HAIRLINE
from paint import mixed, rgb, times

BASE = rgb("e3b698")
RED = rgb("cf7f6c")
PALE = rgb("ecc9ad")
SHADE = rgb("a9705c")
BLUISH = rgb("b98d88")
LIP = rgb("bb7468")
LIP_DARK = rgb("7d3833")
BROW = rgb("5a3f2f")
HAIR = rgb("4a3222")
LASH = rgb("2c1d17")

# the brow's middle line: x, y, half thickness
BROW_LINE = [(0.0105, 0.0166, 0.0023), (0.0160, 0.0192, 0.0027), (0.0240, 0.0226, 0.0026), (0.0320, 0.0245, 0.0021),
             (0.0400, 0.0232, 0.0015), (0.0470, 0.0196, 0.0009), (0.0505, 0.0170, 0.0004)]


def texture_place(plane):
    """Where a point of the unrolled head lies in the texture: the face gets most of it."""
    u, v = plane
    x = clamp(abs(u) / 0.112) * 0.44 + clamp((abs(u) - 0.112) / 0.160) * 0.055
    y = 0.02 + 0.08 * clamp((v + 0.26) / 0.100) + 0.84 * clamp((v + 0.160) / 0.250) + 0.05 * clamp((v - 0.09) / 0.05)
    return 0.5 + (x if u >= 0 else -x), y


def brow_mask(x, y, side):
    """Density of the painted brow hairs."""
    if not 0.008 < x < 0.054 or not 0.010 < y < 0.032:
        return 0.0
    middle = curve([(k[0], k[1]) for k in BROW_LINE], x)
    half = curve([(k[0], k[2]) for k in BROW_LINE], x)
    d = (y - middle) / half
    body = exp(-(abs(d) / 1.05) ** 3) * smoothstep(0.0080, 0.0185, x) * smoothstep(0.0525, 0.044, x)
    if body < 0.01:
        return 0.0
    # single hairs: upright at the inner end, lying outwards at the outer
    root = x - (y - middle) * lerp(0.25, 2.2, smoothstep(0.011, 0.036, x))
    hairs = noise((root * 2600, (y - middle) * 210, side), 1.0, 21) + 0.6 * noise((root * 4700, (y - middle) * 380, side), 1.0, 22)
    return clamp(body * (0.80 + 0.75 * hairs))


def lips(x, y):
    """(amount of red, darkness towards the parting)."""
    if x > MOUTH_HALF * 1.08 or not -0.084 < y < -0.055:
        return 0.0, 0.0
    middle, top, low = part_y(x), upper_lip_y(x), lower_lip_y(x)
    d = (y - top) if y > middle else (low - y)
    amount = smoothstep(0.0007, -0.0009, d) * smoothstep(1.06, 0.93, x / MOUTH_HALF)
    return amount, bell(y - middle, 0.0011) * smoothstep(1.10, 1.0, x / MOUTH_HALF)


def lid_edges(x, y):
    """Distance to the lid margin in the front view: (upper, lower), metres; None beyond the corners."""
    t = (x - EYE[0] + 0.0146) / 0.0288
    if not -0.02 < t < 1.02:
        return None
    t = clamp(t, 0.0, 1.0)
    return y - EYE[1] - lid_opening(t, True)[1], lid_opening(t, False)[1] + EYE[1] - y


def line_distance(x, y, line):
    best = 1.0
    for (ax, ay), (bx, by) in zip(line, line[1:]):
        dx, dy = bx - ax, by - ay
        h = clamp(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy))
        best = min(best, hypot(x - ax - dx * h, y - ay - dy * h))
    return best


def skin_color(p):
    """Face and neck; p in head space."""
    side = 1 if p[0] >= 0 else -1
    x, y, z = abs(p[0]), p[1], p[2]
    front = smoothstep(0.0, 0.05, z)
    c = BASE
    c = mixed(c, PALE, 0.55 * bell(x, 0.045) * smoothstep(0.022, 0.045, y) * front)
    c = mixed(c, PALE, 0.30 * bell(x - 0.022, 0.012) * bell(y + 0.022, 0.010))
    blotch = 0.5 + 0.5 * fractal(p, 60, 3)
    c = mixed(c, RED, front * clamp((0.40 + 0.22 * blotch) * bell(x - 0.042, 0.019) * bell(y + 0.033, 0.017)))
    c = mixed(c, RED, 0.34 * bell(x, 0.012) * bell(y + 0.036, 0.010) * smoothstep(0.085, 0.100, z))
    c = mixed(c, RED, 0.30 * bell(x - 0.0145, 0.006) * bell(y + 0.039, 0.008) * front)
    c = mixed(c, RED, 0.30 * bell(x, 0.016) * bell(y + 0.098, 0.012) * front)
    c = mixed(c, RED, 0.08 * smoothstep(-0.13, -0.19, y))
    # round the eyes
    around = bell(x - 0.031, 0.019) * bell(y - 0.001, 0.013) * front
    c = mixed(c, BLUISH, 0.34 * around)
    c = mixed(c, BLUISH, 0.42 * bell(x - 0.0215, 0.0085) * bell(y + 0.0105, 0.0055) * front)
    c = mixed(c, SHADE, 0.42 * bell(line_distance(x, y, UPPER_LID_LINE[1:7]), 0.0009) * front)
    edges = lid_edges(x, y)
    if edges and z > 0.06:
        up, low = edges
        along = (x - EYE[0] + 0.0146) / 0.0288
        c = mixed(c, rgb("b0736a"), 0.45 * bell(max(up, 0), 0.0030) * (up > -0.001))
        c = mixed(c, LASH, 0.82 * smoothstep(0.0011, 0.0002, up) * (up > -0.0012) * smoothstep(0.0, 0.25, along))
        c = mixed(c, rgb("c98579"), 0.65 * smoothstep(0.0016, 0.0, low) * (low > -0.0012))
        c = mixed(c, LASH, 0.34 * bell(low - 0.0009, 0.0005) * smoothstep(0.25, 0.6, along))
    # folds and hollows
    c = mixed(c, SHADE, 0.22 * bell(line_distance(x, y, SMILE_LINE), 0.0018) * front)
    c = mixed(c, SHADE, 0.30 * bell(y + 0.0815, 0.0040) * bell(x, 0.014) * front)
    c = mixed(c, rgb("6b3a30"), 0.85 * bell(x - 0.0062, 0.0036) * bell(y + 0.0445, 0.0022) * (z > 0.09))
    c = mixed(c, SHADE, 0.35 * bell(x - 0.0185, 0.0022) * bell(y + 0.040, 0.0055) * (z > 0.07))
    for k, (a, size) in enumerate(((0.45, 0.013), (0.05, 0.014), (-0.35, 0.012))):  # laughter lines
        dx, dy = x - 0.0485, y + 0.0005
        along, off = dx * cos(a) + dy * sin(a), -dx * sin(a) + dy * cos(a) - 6 * max(dx, 0) ** 2 * (1 - k)
        c = mixed(c, SHADE, 0.30 * bell(off, 0.0005) * smoothstep(0.001, 0.004, along) * smoothstep(size, 0.006, along))
    for k, height in enumerate((0.0375, 0.0455, 0.0530)):
        wave = height + 0.0016 * cos(x * 75) + 0.0006 * noise((p[0] * 60, k, 0.0), 1.0, 8)
        c = mixed(c, SHADE, 0.08 * bell(y - wave, 0.0005) * smoothstep(0.038, 0.020, x) * front)
    # pores, freckles
    grain = fractal(p, 420, 5, 3)
    c = times(c, 1 + 0.045 * grain + 0.030 * fractal(p, 35, 6, 3))
    q = add(p, (0.004 * noise(p, 90, 14), 0.004 * noise(p, 90, 15), 0.0))
    freckle = noise(q, 520, 9) * (0.5 + 0.5 * noise(p, 70, 10))
    c = mixed(c, rgb("b27f62"), 0.22 * smoothstep(0.25, 0.48, freckle) * bell(x - 0.028, 0.030) * bell(y + 0.022, 0.028) * front)
    # lips
    red, dark = lips(x, y) if z > 0.05 else (0.0, 0.0)
    if red > 0 or dark > 0:
        lines = noise((p[0] * 900, p[1] * 130, 0.0), 1.0, 12)
        lip = mixed(LIP, rgb("c98c7f"), 0.5 * bell(y + 0.0725, 0.0030) * bell(x, 0.012))
        lip = mixed(lip, rgb("ab645a"), 0.45 * (y > part_y(x)))
        c = mixed(c, times(lip, 1 + 0.055 * lines), 0.86 * red)
        c = mixed(c, LIP_DARK, 0.72 * dark)
    c = mixed(c, SHADE, 0.45 * bell(x - MOUTH_HALF * 1.03, 0.0026) * bell(y - part_y(x), 0.0026) * front)
    # brows, hairline
    hairs = brow_mask(x, y, side) if z > 0.03 else 0.0
    c = mixed(c, BROW, 0.80 * hairs)
    return hairline(c, p, side)


def hairline(c, p, side):
    """Soft shadow and single fine hairs where the hair begins."""
    x, y, z = abs(p[0]), p[1], p[2]
    if y < -0.06 or z < -0.03:
        return c
    best, under = 1.0, 0.0
    for a, b in zip(HAIRLINE, HAIRLINE[1:]):
        d = sub(b, a)
        q = sub((x, y, z), a)
        h = clamp(dot(q, d) / dot(d, d))
        off = mad(q, d, -h)
        if length(off) < best:
            best = length(off)
            under = dot(off, cross(p_out(a), d))  # > 0 on the covered side
    covered = under > 0
    if covered:
        return mixed(c, HAIR, 0.55 + 0.35 * smoothstep(0.0, 0.004, best))
    wisps = 0.45 + 0.9 * noise((x * 420 + z * 420, (y - x - z) * 50, side), 1.0, 31)
    c = mixed(c, SHADE, 0.30 * bell(best, 0.007))
    return mixed(c, HAIR, clamp(wisps) * 0.75 * bell(best, 0.0036))


def p_out(a):
    """Outwards from the head at a point of the hairline."""
    return unit((a[0], a[1] * 0.5, a[2]))


# ---- eyes ---------------------------------------------------------------------------------------------
def eye_color(u, v):
    from eyes import IRIS_ANGLE, MAP_ANGLE
    x, y = u - 0.5, v - 0.5
    r = hypot(x, y) / (0.5 * IRIS_ANGLE / MAP_ANGLE)  # 1 at the rim of the iris
    a = atan2(y, x)
    white = mixed(rgb("efe9e2"), rgb("d9a79a"), 0.75 * smoothstep(2.0, 3.6, r))
    vein = abs(noise((cos(a) * 5, sin(a) * 5, r * 0.9), 1.0, 3) + 0.5 * noise((cos(a) * 11, sin(a) * 11, r * 2), 1.0, 4))
    white = mixed(white, rgb("c4695e"), 0.35 * smoothstep(0.06, 0.0, vein) * smoothstep(1.3, 2.6, r))
    fibre = noise((cos(a) * 9, sin(a) * 9, r * 1.1), 1.0, 5) + 0.7 * noise((cos(a) * 26, sin(a) * 26, r * 1.6), 1.0, 6)
    iris = mixed(rgb("7a6a45"), rgb("5c6a58"), smoothstep(0.45, 0.80, r + 0.10 * fibre))
    iris = times(iris, 1.12 + 0.34 * fibre)
    iris = mixed(iris, rgb("a5742f"), 0.55 * bell(r - 0.45, 0.13))
    iris = mixed(iris, rgb("1d2320"), 0.85 * smoothstep(0.80, 1.0, r))
    iris = times(iris, 1.0 + 0.30 * clamp(-sin(a)) * bell(r - 0.7, 0.3) - 0.30 * clamp(sin(a)))  # light falls in from above
    c = mixed(iris, white, smoothstep(0.96, 1.07, r))
    return mixed(rgb("070606"), c, smoothstep(0.36, 0.42, r + 0.012 * fibre))


def mouth_color(u, v):
    """Inside of the mouth: v grows with the depth."""
    c = mixed(rgb("a65a55"), rgb("6e2724"), smoothstep(0.0, 0.30, v))
    return mixed(c, rgb("1c0807"), smoothstep(0.25, 0.80, v))


# ---- hands --------------------------------------------------------------------------------------------
def hand_color(p):
    """p in hand space."""
    from hand import FINGERS, LINES, THUMB, gradient, hand
    c = mixed(BASE, RED, 0.10)
    n = gradient(hand, p)
    palm = smoothstep(0.1, -0.5, n[2])
    c = mixed(c, rgb("d99f88"), 0.65 * palm)
    c = mixed(c, RED, 0.30 * smoothstep(0.085, 0.18, p[0]))
    lines = [(LINES[k], FINGERS[k][2]) for k in FINGERS] + [(THUMB, (0.0, 0.0108, 0.0094, 0.0072))]
    for line, radii in lines:
        for i in (0, 1, 2):
            d = sqrt(sum((a - b) ** 2 for a, b in zip(p, line[i])))
            if d < 0.02 and n[2] > 0.1:
                c = mixed(c, RED, 0.40 * bell(d, 0.010))
                wrinkle = noise((p[0] * 1400, p[1] * 160, 0.0), 1.0, 4)
                c = times(c, 1 - 0.07 * bell(d, 0.0060) * clamp(wrinkle + 0.3) * (i == 1))
        tip, base = line[-1], line[-2]
        axis = [a - b for a, b in zip(tip, base)]
        size = sqrt(sum(a * a for a in axis))
        axis = [a / size for a in axis]
        q = [a - b for a, b in zip(p, base)]
        along = sum(a * b for a, b in zip(q, axis)) / size
        if 0.35 < along < 1.05:
            off = [a - b * along * size for a, b in zip(q, axis)]
            radius = radii[-1]
            thumb = line is THUMB
            up = (0.30, 0.45, 0.84) if thumb else (0.0, 0.0, 1.0)  # the thumb's nail looks forward
            height = sum(a * b for a, b in zip(off, up))
            across = sqrt(max(0.0, sum(a * a for a in off) - height * height))
            shape = ((along - 0.68) / 0.30) ** 4 + (across / (0.80 * radius)) ** 4
            if height > 0 and shape < 1.35:
                nail = mixed(rgb("e6b3a4"), rgb("f6e6da"), smoothstep(0.90, 0.96, along))
                nail = mixed(nail, rgb("ecc9bd"), 0.6 * smoothstep(0.48, 0.41, along))
                c = mixed(c, rgb("a25f50"), 0.6 * smoothstep(1.35, 1.05, shape))
                c = mixed(c, nail, 0.92 * smoothstep(1.08, 0.90, shape))
    c = times(c, 1 + 0.04 * fractal(p, 420, 5, 3) + 0.05 * fractal(p, 60, 6, 3))
    vein = abs(noise((p[0] * 14, p[1] * 45, 0.0), 1.0, 7))
    return mixed(c, rgb("b99a90"), 0.20 * smoothstep(0.12, 0.0, vein) * smoothstep(0.4, 0.9, n[2]) * (0.0 < p[0] < 0.08))
