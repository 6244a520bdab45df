# SPDX-License-Identifier: Apache-2.0
"""The colours of skin, lips, brows, eyes and hands, painted by place on the body."""
from math import atan2, cos, exp, hypot, sin, sqrt

from beard import mask
from face import lid_opening
from face_form import (BROW_LINE, CORNER_LINE, EYE, MOUTH_HALF, SMILE_LINE, TEAR_LINE,
                       UPPER_LID_LINE, forehead_line,
                       lower_lip_y, part_y, upper_lip_y)
from form import (add, bell, clamp, cross, curve, dot, fractal, length, lerp, mad, noise,
                  smoothstep, sub, unit)
from hair import HAIRLINE
from paint import mixed, rgb, times
from person import WHO

BASE, RED, PALE, SHADE = rgb(WHO.skin), rgb(WHO.red), rgb(WHO.pale), rgb(WHO.shade)
BLUISH = rgb("b98d88")
LIP, LIP_DARK = rgb(WHO.lip), rgb(WHO.lip_dark)
BROW = rgb(WHO.brow)
HAIR = mixed(rgb(WHO.hair[0]), rgb(WHO.hair[1]), 0.5 * WHO.beard)
LASH = rgb("2c1d17")

def texture_place(plane):
    """Where a point of the unrolled head lies in the texture: the face gets most of it."""
    u, v = plane
    x = clamp(abs(u) / 0.112) * 0.44 + clamp((abs(u) - 0.112) / 0.160) * 0.055
    y = (0.02 + 0.08 * clamp((v + 0.26) / 0.100) + 0.84 * clamp((v + 0.160) / 0.250)
         + 0.05 * clamp((v - 0.09) / 0.05))
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
    hairs = (noise((root * 2600, (y - middle) * 210, side), 1.0, 21)
             + 0.6 * noise((root * 4700, (y - middle) * 380, side), 1.0, 22))
    return clamp(body * (0.80 + 0.75 * hairs))


def lips(x, y):
    """(amount of red, darkness towards the parting)."""
    if x > MOUTH_HALF * 1.08 or not -0.084 < y < -0.055:
        return 0.0, 0.0
    middle, top, low = part_y(x), upper_lip_y(x), lower_lip_y(x)
    d = (y - top) if y > middle else (low - y)
    amount = (smoothstep(0.0010, -0.0011, d)
              * (0.45 + 0.55 * smoothstep(1.02, 0.72, x / MOUTH_HALF))
              * smoothstep(1.05, 0.96, x / MOUTH_HALF))
    return amount, bell(y - middle, 0.0009) * smoothstep(1.00, 0.60, x / MOUTH_HALF)


def lid_edges(x, y):
    """Distance to the lid margin in the front view: (upper, lower), metres; None beyond the
    corners."""
    t = (x - EYE[0] + 0.0153) / 0.0301
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
    age, ruddy = WHO.age, WHO.ruddy
    c = BASE
    c = mixed(c, PALE, 0.50 * bell(x, 0.045) * smoothstep(0.022, 0.045, y) * front)
    c = mixed(c, PALE, 0.35 * bell(x - 0.024, 0.012) * bell(y + 0.024, 0.009))
    # the forehead is yellower, the middle redder
    c = mixed(c, rgb("d9a878"), 0.16 * smoothstep(0.015, 0.045, y) * front)
    blotch = 0.5 + 0.5 * fractal(p, 60, 3)
    c = mixed(c, RED,
              ruddy * front
              * clamp((0.34 + 0.22 * blotch) * bell(x - 0.040, 0.020) * bell(y + 0.033, 0.018)))
    c = mixed(c, RED,
              ruddy * 0.42 * bell(x, 0.013) * bell(y + 0.036, 0.009) * smoothstep(0.085, 0.100, z))
    c = mixed(c, RED, ruddy * 0.40 * bell(x - 0.0140, 0.005) * bell(y + 0.0395, 0.008) * front)
    c = mixed(c, RED, ruddy * 0.30 * bell(x, 0.016) * bell(y + 0.098, 0.012) * front)
    c = mixed(c, RED, 0.22 * bell(x, 0.040) * smoothstep(-0.135, -0.175, y) * front)
    c = mixed(c, RED, 0.18 * smoothstep(0.050, 0.066, x) * bell(y + 0.020, 0.035))
    # under the chin
    c = mixed(c, SHADE,
              0.22 * smoothstep(-0.104, -0.122, y) * smoothstep(-0.175, -0.135, y) * front)
    # blood and its absence: broad patches, then small ones
    c = mixed(c, RED, 0.18 * ruddy * smoothstep(-0.10, 0.45, fractal(p, 28, 21, 3)) * front)
    c = mixed(c, PALE, 0.16 * smoothstep(-0.10, 0.45, fractal(p, 75, 22, 3)) * front)
    c = mixed(c, RED,
              0.22 * ruddy * smoothstep(-0.05, 0.45, fractal(p, 240, 23, 3))
              * (0.25 + bell(y + 0.032, 0.034)) * front)
    c = mixed(c, BLUISH, 0.10 * smoothstep(0.0, 0.5, fractal(p, 110, 24, 2)) * front)
    # round the eyes
    around = bell(x - 0.031, 0.019) * bell(y - 0.001, 0.013) * front
    c = mixed(c, BLUISH, 0.26 * around)
    c = mixed(c, BLUISH,
              (0.30 + 0.25 * WHO.eye_bags) * bell(x - 0.0225, 0.0095)
              * bell(y + 0.0110, 0.0050) * front)
    c = mixed(c, SHADE, 0.46 * bell(line_distance(x, y, UPPER_LID_LINE[1:7]), 0.0009) * front)
    edges = lid_edges(x, y)
    if edges and z > 0.06:
        up, low = edges
        along = (x - EYE[0] + 0.0153) / 0.0301
        c = mixed(c, rgb("b57c70"), 0.40 * bell(max(up, 0), 0.0032) * (up > -0.001))
        c = mixed(c, LASH,
                  0.85 * smoothstep(0.0012, 0.0002, up) * (up > -0.0012)
                  * smoothstep(0.0, 0.25, along) * WHO.lashes)
        c = mixed(c, rgb("cf8d80"), 0.65 * smoothstep(0.0016, 0.0, low) * (low > -0.0012))
        c = mixed(c, LASH,
                  0.30 * bell(low - 0.0009, 0.0005) * smoothstep(0.25, 0.6, along) * WHO.lashes)
    c = folds(c, p, x, y, z, front, age)
    # pores, freckles, spots
    grain = fractal(p, 460, 5, 3)
    pores = noise(p, 1500, 15) * (0.4 + bell(x, 0.030) * bell(y + 0.020, 0.035))
    c = times(c,
              1 + 0.050 * grain + 0.030 * fractal(p, 35, 6, 3)
              - 0.055 * smoothstep(0.15, 0.6, pores))
    if WHO.freckles:
        freckle = noise(p, 340, 9) + 0.5 * noise(p, 800, 10)
        where = bell(x - 0.026, 0.030) * bell(y + 0.020, 0.024) + 0.30 * smoothstep(0.02, 0.04, y)
        c = mixed(c, rgb("b07a58"),
                  WHO.freckles * 0.26 * smoothstep(0.30, 0.62, freckle) * min(where, 1.0) * front)
    if WHO.spots:
        spot = smoothstep(0.34, 0.66, noise(p, 75, 33) + 0.30 * noise(p, 300, 34))
        c = mixed(c, rgb("9a6647"),
                  WHO.spots * 0.30 * spot * smoothstep(0.018, 0.040, x + 0.6 * max(y, 0)) * front)
    if WHO.beard:
        c = mixed(c, times(HAIR, 1 + 0.35 * noise((p[0] * 900, p[1] * 120, z * 900), 1.0, 17)),
                  WHO.beard * mask(p))
    # lips
    red, dark = lips(x, y) if z > 0.05 else (0.0, 0.0)
    if red > 0 or dark > 0:
        lines = noise((p[0] * 1100, p[1] * 130, 0.0), 1.0, 12)
        lip = mixed(LIP, mixed(LIP, PALE, 0.45), 0.6 * bell(y + 0.0730, 0.0032) * bell(x, 0.013))
        lip = mixed(lip, times(LIP, 0.84), 0.6 * (y > part_y(x)))
        c = mixed(c, times(lip, 1 + 0.10 * lines), 0.78 * red)
        c = mixed(c, LIP_DARK, 0.50 * dark)
    c = mixed(c, SHADE,
              0.20 * bell(x - MOUTH_HALF * 1.04, 0.0034) * bell(y - part_y(x), 0.0034) * front)
    # brows, hairline
    hairs = brow_mask(x, y, side) if z > 0.03 else 0.0
    c = mixed(c, BROW, WHO.brow_density * 0.75 * hairs)
    return hairline(c, p, side) if WHO.hairline else c


def folds(c, p, x, y, z, front, age):
    """Skin is darker where it is folded, the more the older."""
    c = mixed(c, SHADE, (0.10 + 0.34 * age) * bell(line_distance(x, y, SMILE_LINE), 0.0017) * front)
    c = mixed(c, SHADE, 0.26 * bell(y + 0.0830, 0.0040) * bell(x, 0.014) * front)
    c = mixed(c, rgb("6b3a30"), 0.50 * bell(x - 0.0066 * WHO.nose_width, 0.0024)
              * bell(y + 0.0455 + 0.6 * WHO.nose_drop, 0.0018) * (z > 0.09))
    c = mixed(c, SHADE,
              0.32 * bell(x - 0.0172 * WHO.nose_width, 0.0020)
              * bell(y + 0.0395, 0.0055) * (z > 0.07))
    for k, (a, size) in enumerate(((0.42, 0.013), (0.05, 0.015), (-0.33, 0.013))):  # laughter lines
        dx, dy = x - 0.0475, y + 0.0005
        along, off = dx * cos(a) + dy * sin(a), -dx * sin(a) + dy * cos(a)
        c = mixed(c, SHADE,
                  (0.12 + 0.40 * age) * bell(off, 0.0005) * smoothstep(0.001, 0.004, along)
                  * smoothstep(size, 0.006, along))
    if y > 0.03:
        for k in range(3):
            off = y - forehead_line(x, k) - 0.0005 * noise((p[0] * 60, k, 0.0), 1.0, 8)
            broken = 0.65 + 0.7 * noise((p[0] * 90, k * 7.0, 0.0), 1.0, 18)
            c = mixed(c, SHADE,
                      (0.03 + 0.22 * age ** 1.5) * broken * bell(off, 0.0008)
                      * smoothstep(0.044, 0.024, x) * front)
    if age > 0.5:
        c = mixed(c, SHADE, 0.45 * age * bell(x - 0.0052, 0.0008) * bell(y - 0.019, 0.006) * front)
        c = mixed(c, SHADE, 0.40 * age * bell(line_distance(x, y, CORNER_LINE), 0.0014) * front)
        c = mixed(c, SHADE, 0.40 * age * bell(line_distance(x, y, TEAR_LINE), 0.0012) * front)
        # crossing fine lines
        fine = noise((p[0] * 500 + p[1] * 300, p[1] * 500 - p[0] * 200, z * 300), 1.0, 41)
        c = times(c, 1 - 0.045 * age * smoothstep(0.1, 0.5, abs(fine)) * front)
    return c


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
    # strands leave the forehead backwards, the temples downwards
    strand = (noise((x * 900 - y * 300, z * 130, side), 1.0, 31) if y > 0.045
              else noise((z * 900 - y * 260, x * 130, side), 1.0, 32))
    if covered:
        deep = smoothstep(0.0, 0.0075, best)  # no edge: hairs stand singly, then close
        return times(mixed(c, HAIR, clamp(0.30 + 0.80 * deep + 1.2 * strand * (1 - deep))),
                     1 + 0.45 * strand * deep)
    wisps = 0.40 + 1.1 * strand
    c = mixed(c, SHADE, 0.30 * bell(best, 0.007))
    return mixed(c, HAIR,
                 clamp(wisps * (0.55 + 0.45 * bell(best, 0.0040))) * 0.85 * bell(best, 0.0075))


def p_out(a):
    """Outwards from the head at a point of the hairline."""
    return unit((a[0], a[1] * 0.5, a[2]))


# ---- eyes ----------------------------------------------------------------------------------------
def eye_color(u, v):
    from eyes import IRIS_ANGLE, MAP_ANGLE
    x, y = u - 0.5, v - 0.5
    r = hypot(x, y) / (0.5 * IRIS_ANGLE / MAP_ANGLE)  # 1 at the rim of the iris
    a = atan2(y, x)
    white = mixed(rgb("e9e3dc"), rgb("d8a497"), 0.75 * smoothstep(1.7, 3.3, r))
    white = mixed(white, rgb("b9b6b8"), 0.30 * bell(r - 1.05, 0.18))  # the dark rim shines through
    # the lid's shadow
    white = times(white, 1 - 0.30 * smoothstep(0.05, 1.0, sin(a)) * smoothstep(0.9, 1.3, r))
    vein = abs(noise((cos(a) * 5, sin(a) * 5, r * 0.9), 1.0, 3)
               + 0.5 * noise((cos(a) * 11, sin(a) * 11, r * 2), 1.0, 4))
    white = mixed(white, rgb("c4695e"),
                  0.30 * smoothstep(0.05, 0.0, vein) * smoothstep(1.4, 2.7, r))
    fibre = (noise((cos(a) * 9, sin(a) * 9, r * 1.1), 1.0, 5)
             + 0.8 * noise((cos(a) * 30, sin(a) * 30, r * 1.4), 1.0, 6))
    inner, outer, ring = (rgb(t) for t in WHO.iris)
    iris = mixed(inner, outer, smoothstep(0.50, 0.82, r + 0.12 * fibre))
    iris = times(iris, 1.04 + 0.45 * fibre)
    iris = mixed(iris, ring, 0.60 * bell(r - 0.47 - 0.03 * fibre, 0.10))
    iris = mixed(iris, rgb("1d2320"), 0.85 * smoothstep(0.78, 1.0, r))
    # light falls in from above
    iris = times(iris, 1.05 + 0.40 * clamp(-sin(a)) * bell(r - 0.7, 0.3) - 0.50 * clamp(sin(a)))
    c = mixed(iris, white, smoothstep(0.95, 1.08, r))
    return mixed(rgb("050404"), c, smoothstep(0.385, 0.435, r + 0.012 * fibre))


def mouth_color(u, v):
    """Inside of the mouth: v grows with the depth."""
    c = mixed(rgb("b2625c"), rgb("8c3d38"), smoothstep(0.0, 0.30, v))
    return mixed(c, rgb("3a1411"), smoothstep(0.30, 0.95, v))


# ---- hands ---------------------------------------------------------------------------------------
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
    return mixed(c, rgb("b99a90"),
                 0.20 * smoothstep(0.12, 0.0, vein) * smoothstep(0.4, 0.9, n[2])
                 * (0.0 < p[0] < 0.08))
