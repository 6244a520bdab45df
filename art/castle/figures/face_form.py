# SPDX-License-Identifier: Apache-2.0
"""The sculpture of the head: bone and flesh as blended volumes, finer things as relief on top.

Head space: metres, y = 0 on the line between the pupils, z = 0 through the ears, x to the figure's
left. The proportions are an adult's: eyes halfway up the head, 22 cm from chin to crown; person.py
says what differs.
"""
from math import atan2, cos, sin, sqrt

from form import (bell, capsule, carve, clamp, curve, ellipsoid, join, lerp, mad, gradient, cast,
                  smoothstep, sphere)
from person import WHO

HEAD = (0.0, 1.562, 0.022)  # head space in the figure's space

EYE = (0.0315, 0.0, 0.0676)  # centre of the left eyeball
EYE_RADIUS = 0.0136
LID_RADIUS = EYE_RADIUS + 0.0013

MOUTH_Y = -0.0665  # where the lips part, at the middle
MOUTH_HALF = WHO.mouth_half


# ---- mouth lines, functions of x >= 0 ------------------------------------------------------------
def part_y(x):
    """Parting line: a soft bow; the corners of a kind mouth stand a little higher."""
    u = clamp(x / MOUTH_HALF, 0, 1.3)
    return (MOUTH_Y - 0.0007 * bell(u, 0.26) - 0.0009 * bell(u - 0.52, 0.3)
            + WHO.corner_rise * u ** 2.2)


def upper_lip_y(x):
    """Upper edge of the red: two peaks (the philtrum's), sinking to the corner."""
    u = clamp(x / MOUTH_HALF, 0, 1)
    height = WHO.lip_upper - 0.0013 * bell(u, 0.11) + 0.0007 * bell(u - 0.23, 0.14)
    return part_y(x) + height * (1 - u ** 1.5) ** 1.05 + 0.0004


def lower_lip_y(x):
    u = clamp(x / MOUTH_HALF, 0, 1)
    return part_y(x) - WHO.lip_lower * (1 - u ** 1.8) ** 1.15 - 0.0004


# ---- the volumes ---------------------------------------------------------------------------------
def bone(p):
    """Head and neck without eyelids; symmetric."""
    x, y, z = abs(p[0]), p[1], p[2]
    p = (x, y, z)
    w, chin = WHO.jaw_width, WHO.chin_width
    d = ellipsoid(p, (0, 0.026, -0.006), (0.0695, 0.083, 0.0985))  # cranium
    # bosses of the forehead
    d = join(d, ellipsoid(p, (0.018, 0.046, 0.052), (0.034, 0.030, 0.036)), 0.030)
    d = join(d, ellipsoid(p, (0, -0.030, 0.030), (0.0500, 0.078, 0.0600)), 0.030)  # face
    # jaw
    d = join(d, capsule(p, (0.0375 * w, -0.0660, 0.010), (0.0110, -0.0975, 0.070), 0.0112, 0.0106),
             0.026)
    # chin
    d = join(d,
             ellipsoid(p, (0, -0.0955 - WHO.chin_down, 0.0758 + WHO.chin_out),
                       (0.0180 * chin, 0.0140, 0.0175)), 0.030)
    d = join(d, ellipsoid(p, (0, -0.066, 0.072), (0.0305, 0.025, 0.0265)), 0.018)  # muzzle
    c = WHO.cheekbone
    # cheekbone
    d = join(d, ellipsoid(p, (0.0445 + c, -0.0205, 0.0560 + c), (0.0180, 0.0120, 0.0190)), 0.022)
    d = join(d,
             capsule(p, (0.050 + c, -0.016, 0.045), (0.0630 + 0.5 * c, -0.008, 0.006), 0.009,
                     0.006), 0.016)
    f = WHO.cheek_full
    # cheek
    d = join(d, ellipsoid(p, (0.0340, -0.0430, 0.0648), (0.0170 * f, 0.0180 * f, 0.0190 * f)),
             0.022)
    # chewing muscle
    d = join(d, ellipsoid(p, (0.0395 * w, -0.0480, 0.0300), (0.0135 * f, 0.0330, 0.0300)), 0.026)
    # soft edge of the jaw
    d = join(d, ellipsoid(p, (0.0275 * w, -0.0835, 0.0480), (0.0140, 0.0110, 0.0200)), 0.022)
    d = join(d,
             capsule(p, (0.007, 0.0165, 0.0815 + WHO.brow_bone),
                     (0.041, 0.0165, 0.0640 + 0.8 * WHO.brow_bone),
                     0.0085, 0.0085), 0.014)
    if WHO.temple_hollow:
        d = carve(d,
                  ellipsoid(p, (0.0850, 0.0280, 0.0420),
                            (0.0180 + WHO.temple_hollow, 0.0260, 0.0260)), 0.014)
    # eye socket
    d = carve(d, ellipsoid(p, (0.0310, 0.0005, 0.0890), (0.0190, 0.0120, 0.0150)), 0.014)
    # neck: leans forward going up; the muscle from behind the ear to the breastbone shows a little
    n = WHO.neck_width
    neck = capsule(p, (0, -0.045, -0.020), (0, -0.250, -0.045), 0.0425 * n, 0.0475 * n)
    neck = join(neck,
                capsule(p, (0.0445 * n, -0.042, -0.016), (0.013, -0.200, 0.004), 0.009, 0.0075),
                0.018)
    if n > 1.03:
        neck = join(neck, ellipsoid(p, (0, -0.135, 0.017), (0.009, 0.014, 0.012)), 0.014)  # larynx
    return join(d, neck, 0.022)


def nose(p, d):
    """Adds the nose to the distance `d`; `p` has x >= 0."""
    w, out, drop = WHO.nose_width, WHO.nose_out, WHO.nose_drop
    tip_y, tip_z = -0.0350 - drop, 0.1035 + out
    d = join(d,
             capsule(p, (0, 0.008, 0.0797 + 0.35 * WHO.brow_bone),
                     (0, -0.0290 - 0.8 * drop, 0.1012 + 0.9 * out),
                     0.0056 * WHO.nose_bridge, 0.0062 * w), 0.0095)  # bridge
    if WHO.nose_hump:
        d = join(d,
                 ellipsoid(p, (0, -0.0110, 0.0935 + WHO.nose_hump), (0.0050 * w, 0.0100, 0.0040)),
                 0.006)
    # tip
    d = join(d, ellipsoid(p, (0.0020 * w, tip_y, tip_z), (0.0054 * w, 0.0064, 0.0080)), 0.006)
    d = join(d,
             capsule(p, (0, tip_y - 0.0045, tip_z + 0.0005), (0, -0.0442 - 0.6 * drop, 0.0930),
                     0.0034, 0.0040), 0.005)
    # wing
    d = join(d,
             ellipsoid(p, (0.0106 * w, -0.0386 - 0.5 * drop, 0.0945 + 0.3 * out),
                       (0.0050 * w, 0.0062, 0.0086)), 0.0050)
    return carve(d,
                 ellipsoid(p, (0.0068 * w, -0.0455 - 0.6 * drop, 0.0975 + 0.4 * out),
                           (0.0028 * w, 0.0046, 0.0056)), 0.0016)


def face(p):
    """Everything but the relief."""
    q = (abs(p[0]), p[1], p[2])
    # towards the chin
    slim = 1 + 0.060 * smoothstep(-0.028, -0.075, p[1]) * smoothstep(-0.190, -0.130, p[1])
    slim /= lerp(1.0, WHO.face_width,
                 smoothstep(0.055, 0.000, p[1]) * smoothstep(-0.150, -0.115, p[1]))
    d = bone((q[0] * slim, q[1], q[2]))
    if q[0] < 0.034 and -0.066 < q[1] < 0.03 and q[2] > 0.05:
        d = nose(q, d)
    if q[2] > 0.05 and abs(q[1]) < 0.03:
        d = join(d, sphere(q, EYE, LID_RADIUS), 0.0035)
    return d


# ---- relief: millimetres along the normal --------------------------------------------------------
def lips(x, y):
    """Height of the lips over the muzzle; x >= 0."""
    u = x / MOUTH_HALF
    if u > 1.25 or y < -0.088 or y > -0.050:
        return 0.0
    fade = clamp(1 - u ** 2.6) ** 0.8 if u < 1 else 0.0
    middle = part_y(x)
    if y >= middle:
        q = (y - middle) / max(upper_lip_y(x) - middle, 8e-4)
        # the tubercle in the middle
        top = 0.0034 * fade * WHO.lip_full * (1 - 0.12 * bell(u - 0.30, 0.16))
        height = top * (sqrt(min(q, 1.0) / 0.38) if q < 0.38 else 1.0)
        if q > 0.38:
            height *= 1 - 0.42 * smoothstep(0.38, 1.0, q)
        if q > 1.0:
            height = top * 0.58 * bell(q - 1.0, 0.9)
    else:
        q = (middle - y) / max(middle - lower_lip_y(x), 8e-4)
        top = 0.0045 * fade * WHO.lip_full * (1 - 0.10 * bell(u, 0.16))  # two pads
        height = top * (sqrt(q / 0.45) if q < 0.45 else 1.0)
        if q > 0.45:
            height *= 1 - 0.70 * smoothstep(0.45, 1.08, q)
        if q > 1.0:
            height = top * 0.30 * bell(q - 1.05, 0.5)
    # towards the corner the lips lie closer
    crease = -0.0016 * bell(y - middle, 0.0007) * smoothstep(1.04, 0.55, u)
    corner = -0.0009 * bell(x - MOUTH_HALF * 1.06, 0.0048) * bell(y - part_y(x), 0.0046)
    return height + crease + corner


def asymmetry(p):
    """What keeps a face from looking machined: half a millimetre here and there."""
    x, y, z = p
    front = smoothstep(0.04, 0.07, z)
    left = smoothstep(-0.01, 0.02, x)
    dx = (0.0006 * bell(x, 0.016) * bell(y + 0.038, 0.014)
          + 0.0008 * bell(x, 0.030) * bell(y + 0.100, 0.018))
    dy = 0.0009 * left * smoothstep(0.013, 0.020, y) * smoothstep(0.050, 0.028, y)
    dy += (0.0008 * left - 0.0003) * bell(abs(x) - MOUTH_HALF, 0.012) * bell(y - MOUTH_Y, 0.012)
    return (x + dx * front, y + dy * front, z)


def beside(x, y, line):
    """Distance from a polyline [(x, y)] that runs downwards; negative on its inner side, towards
    the middle of the face."""
    best, side = 1e9, 0.0
    for (ax, ay), (bx, by) in zip(line, line[1:]):
        dx, dy = bx - ax, by - ay
        h = clamp(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy))
        ex, ey = x - ax - dx * h, y - ay - dy * h
        d = ex * ex + ey * ey
        if d < best:
            best = d
            side = 1.0 if ex * -dy + ey * dx > 0 else -1.0
    return side * sqrt(best)


def fold(x, y, line, depth, width, raise_outside=0.0):
    """A crease along a polyline [(x, y)]; the flesh outside of it may stand higher and hang over
    it."""
    d = beside(x, y, line)
    return -depth * bell(d, width) + raise_outside * (d / width) * bell(d, 2.5 * width)


def lid_fold(x, y):
    """The crease of the upper lid and the soft skin that rests on it, heavier outwards."""
    if not 0.013 < x < 0.056 or not 0.0 < y < 0.024:
        return 0.0
    line = curve(UPPER_LID_LINE, x)
    ends = smoothstep(0.0150, 0.0200, x) * smoothstep(0.0545, 0.0470, x)
    above = y - line
    hood = (0.0010 + 0.0006 * smoothstep(0.030, 0.046, x)) * WHO.lid_hood
    rest = hood * bell(above - 0.0030, 0.0026) if above > 0 else -0.0002 * bell(above, 0.003)
    return ends * (rest - 0.0010 * bell(above, 0.0009))


SMILE_LINE = [(0.0160, -0.0345), (0.0205, -0.0425), (0.0260, -0.0525), (0.0310, -0.0630),
              (0.0322, -0.0720)]
TEAR_LINE = [(0.0165, -0.0070), (0.0215, -0.0140), (0.0290, -0.0178), (0.0375, -0.0178)]
# from the mouth's corner down, with age
CORNER_LINE = [(0.0285, -0.0720), (0.0300, -0.0800), (0.0290, -0.0880)]
UPPER_LID_LINE = [(0.0145, 0.0026), (0.0185, 0.0072), (0.0235, 0.0100), (0.0300, 0.0112),
                  (0.0365, 0.0106), (0.0430, 0.0082),
                  (0.0490, 0.0036), (0.0550, -0.0006)]
FOREHEAD_LINES = [(0.0370, 0.9), (0.0445, 1.0), (0.0520, 0.7)]


# the brow's middle line: x, y, half thickness
BROW_LINE = [(0.0100, 0.0160, 0.0025), (0.0160, 0.0180, 0.0030), (0.0240, 0.0206, 0.0029),
             (0.0320, 0.0222, 0.0024),
             (0.0400, 0.0212, 0.0018), (0.0470, 0.0180, 0.0011), (0.0510, 0.0154, 0.0005)]


def forehead_line(x, k):
    height = FOREHEAD_LINES[k][0]
    return height + 0.0016 * cos(x * 75 + 0.6 * k) - 0.0012 * bell(x, 0.012)


def wrinkles(x, y):
    """The furrows of an old face: forehead, between the brows, beside the eyes, down from the
    mouth."""
    h = 0.0
    if y > 0.030:
        for k, (_, depth) in enumerate(FOREHEAD_LINES):
            off = y - forehead_line(x, k)
            h += (depth * (0.00035 * bell(off - 0.0030, 0.0026) - 0.00060 * bell(off, 0.0012))
                  * smoothstep(0.044, 0.026, x))
    elif y > 0.006 and x < 0.012:
        h -= 0.0003 * bell(x - 0.0052, 0.0012) * bell(y - 0.019, 0.006)
    if x > 0.044 and -0.02 < y < 0.02:
        for a, size in ((0.42, 0.013), (0.05, 0.015), (-0.33, 0.013)):
            dx, dy = x - 0.0475, y + 0.0005
            along, off = dx * cos(a) + dy * sin(a), -dx * sin(a) + dy * cos(a)
            h -= (0.00055 * bell(off, 0.0009) * smoothstep(0.001, 0.004, along)
                  * smoothstep(size, 0.006, along))
    h += fold(x, y, CORNER_LINE, 0.0009, 0.0024, 0.0004)
    return h


def relief(p):
    x, y, z = abs(p[0]), p[1], p[2]
    if z < 0.02:
        return 0.0
    front = smoothstep(0.02, 0.05, z)
    age = WHO.age
    h = lips(x, y)
    h -= 0.0018 * bell(y + 0.0830, 0.0042) * bell(x, 0.015)  # under the lower lip
    # philtrum
    h -= (0.0010 * bell(x, 0.0026) * smoothstep(-0.0455, -0.0490, y)
          * smoothstep(-0.0600, -0.0565, y))
    h += (0.0005 * bell(x - 0.0043, 0.0020) * smoothstep(-0.0465, -0.0500, y)
          * smoothstep(-0.062, -0.058, y))
    h += fold(x, y, SMILE_LINE, 0.0003 + 0.0010 * age, 0.0026, 0.0002 + 0.0006 * age)
    h += fold(x, y, TEAR_LINE, 0.0003 + 0.0008 * age, 0.0028)
    h += 0.0022 * WHO.eye_bags * bell(x - 0.030, 0.0095) * bell(y + 0.0118, 0.0036)
    h += lid_fold(x, y)
    if age > 0.3:
        h += (age - 0.3) / 0.7 * wrinkles(x, y)
    # wing crease
    h -= (0.0015 * bell(x - 0.0128 * WHO.nose_width, 0.0028) * bell(y + 0.0320, 0.0048)
          * bell(z - 0.092, 0.012))
    return h * front


def on_face(p):
    """A point of the sculpture moved onto the relief."""
    h = relief(p)
    return mad(p, gradient(face, p), h) if abs(h) > 1e-6 else p


def front_point(x, y):
    """The point of the face seen at (x, y) from the front."""
    return on_face(cast(face, (x, y, 0.0), (0.0, 0.0, 1.0), 0.13, -0.02))


# ---- rays that sweep the head from crown to collar -----------------------------------------------
# v (metres, like a height) -> height of the ray's start on the axis, its slope
ORIGIN = [(-0.26, -0.215), (-0.20, -0.155), (-0.165, -0.105), (-0.13, -0.080), (-0.10, -0.078),
          (-0.085, -0.080),
          (-0.06, -0.060), (0.02, 0.020), (0.06, 0.030), (0.14, 0.030)]
SLOPE = [(-0.26, -0.10), (-0.20, -0.55), (-0.165, -0.85), (-0.13, -0.66), (-0.10, -0.25),
         (-0.085, -0.05), (-0.07, 0.0),
         (0.02, 0.0), (0.06, 0.45), (0.11, 1.00), (0.14, 1.50)]
LOW, HIGH = -0.26, 0.14  # of v


def ray(theta, v):
    a = curve(SLOPE, v)
    return (0.0, curve(ORIGIN, v), 0.0), (sin(theta) * cos(a), sin(a), cos(theta) * cos(a))


def sweep(theta, v):
    origin, direction = ray(theta, v)
    return on_face(cast(face, origin, direction, 0.16))


def unroll(p):
    """(theta, v) of a point: the inverse of `sweep`."""
    theta = atan2(p[0], p[2])
    rho = sqrt(p[0] * p[0] + p[2] * p[2])
    low, high = LOW, HIGH
    for _ in range(40):
        v = 0.5 * (low + high)
        a = curve(SLOPE, v)
        if (p[1] - curve(ORIGIN, v)) * cos(a) - rho * sin(a) > 0:
            low = v
        else:
            high = v
    return theta, 0.5 * (low + high)
