# SPDX-License-Identifier: Apache-2.0
"""Words for describing form: smooth blends, signed distances, ray casts onto a form, noise.

Points are plain (x, y, z) tuples in metres: a sculpture is evaluated some hundred thousand times,
and tuples of floats are what Python is quickest with. Everything here is deterministic.
"""
from math import cos, exp, pi, sin, sqrt

from mathutils import noise as _noise


# ---- numbers -------------------------------------------------------------------------------------
def clamp(x, low=0.0, high=1.0):
    return low if x < low else high if x > high else x


def lerp(a, b, t):
    return a + (b - a) * t


def smoothstep(low, high, x):
    t = clamp((x - low) / (high - low))
    return t * t * (3 - 2 * t)


def bell(x, width):
    """1 at 0, falling smoothly; about 0.37 at `width`."""
    return exp(-(x / width) ** 2)


def curve(knots, x):
    """Smooth (monotone cubic) interpolation through sorted (x, y) knots; constant beyond the
    ends."""
    if x <= knots[0][0]:
        return knots[0][1]
    if x >= knots[-1][0]:
        return knots[-1][1]
    i = 1
    while knots[i][0] < x:
        i += 1
    (x0, y0), (x1, y1) = knots[i - 1], knots[i]
    h = x1 - x0
    slope = (y1 - y0) / h

    def tangent(a, b, c):
        left = (b[1] - a[1]) / (b[0] - a[0])
        right = (c[1] - b[1]) / (c[0] - b[0])
        return 0.0 if left * right <= 0 else 2 * left * right / (left + right)

    m0 = tangent(knots[i - 2], knots[i - 1], knots[i]) if i >= 2 else slope
    m1 = tangent(knots[i - 1], knots[i], knots[i + 1]) if i + 1 < len(knots) else slope
    t = (x - x0) / h
    return ((2 * t ** 3 - 3 * t * t + 1) * y0 + (t ** 3 - 2 * t * t + t) * h * m0
            + (3 * t * t - 2 * t ** 3) * y1 + (t ** 3 - t * t) * h * m1)


# ---- vectors -------------------------------------------------------------------------------------
def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def mul(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def mad(a, b, s):
    """a + b * s"""
    return (a[0] + b[0] * s, a[1] + b[1] * s, a[2] + b[2] * s)


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


def unit(a):
    n = length(a)
    return (a[0] / n, a[1] / n, a[2] / n) if n > 1e-12 else (0.0, 0.0, 1.0)


def distance(a, b):
    return length(sub(a, b))


def rotate(p, center, axis, angle):
    """p turned about the unit `axis` through `center` (right-handed, radians)."""
    v = sub(p, center)
    c, s = cos(angle), sin(angle)
    k = dot(axis, v) * (1 - c)
    w = cross(axis, v)
    return (center[0] + v[0] * c + w[0] * s + axis[0] * k,
            center[1] + v[1] * c + w[1] * s + axis[1] * k,
            center[2] + v[2] * c + w[2] * s + axis[2] * k)


# ---- signed distances ----------------------------------------------------------------------------
def join(a, b, k):
    """Union with a fillet about `k` metres wide."""
    h = 0.5 + 0.5 * (b - a) / k
    if h <= 0:
        return b
    if h >= 1:
        return a
    return b + (a - b) * h - k * h * (1 - h)


def carve(a, b, k):
    """`a` without `b`, with a fillet about `k` metres wide."""
    return -join(-a, b, k)


def ellipsoid(p, c, r):
    x, y, z = (p[0] - c[0]) / r[0], (p[1] - c[1]) / r[1], (p[2] - c[2]) / r[2]
    k0 = sqrt(x * x + y * y + z * z)
    x, y, z = x / r[0], y / r[1], z / r[2]
    k1 = sqrt(x * x + y * y + z * z)
    return k0 * (k0 - 1.0) / k1 if k1 > 1e-9 else -min(r)


def sphere(p, c, r):
    x, y, z = p[0] - c[0], p[1] - c[1], p[2] - c[2]
    return sqrt(x * x + y * y + z * z) - r


def capsule(p, a, b, ra, rb):
    """A rod from `a` to `b` whose radius goes from `ra` to `rb`."""
    bx, by, bz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    px, py, pz = p[0] - a[0], p[1] - a[1], p[2] - a[2]
    h = (px * bx + py * by + pz * bz) / (bx * bx + by * by + bz * bz)
    h = 0.0 if h < 0 else 1.0 if h > 1 else h
    x, y, z = px - bx * h, py - by * h, pz - bz * h
    return sqrt(x * x + y * y + z * z) - (ra + (rb - ra) * h)


def gradient(form, p, step=2e-4):
    x, y, z = p
    return unit((form((x + step, y, z)) - form((x - step, y, z)),
                 form((x, y + step, z)) - form((x, y - step, z)),
                 form((x, y, z + step)) - form((x, y, z - step))))


def cast(form, origin, direction, far, near=0.0):
    """First point of `form` met when coming from `origin + far * direction` towards `origin`."""
    t = far
    last = None
    for _ in range(160):
        p = mad(origin, direction, t)
        d = form(p)
        if d < 2e-5:
            if d < -1e-4 and last is not None:  # stepped inside: bisect
                low, high = t, last
                for _ in range(24):
                    mid = 0.5 * (low + high)
                    if form(mad(origin, direction, mid)) < 0:
                        low = mid
                    else:
                        high = mid
                return mad(origin, direction, high)
            return p
        last = t
        t -= max(0.75 * d, 2e-5)
        if t < near:
            return mad(origin, direction, near)
    return mad(origin, direction, t)


# ---- noise ---------------------------------------------------------------------------------------
def noise(p, scale=1.0, seed=0.0):
    """Perlin noise, about -1..1; features about 1 / scale metres wide."""
    return _noise.noise((p[0] * scale + seed * 17.3, p[1] * scale + seed * 5.1,
                         p[2] * scale - seed * 9.7))


def fractal(p, scale=1.0, seed=0.0, octaves=4):
    total, amplitude = 0.0, 0.5
    for _ in range(octaves):
        total += amplitude * noise(p, scale, seed)
        scale, amplitude, seed = scale * 2.03, amplitude * 0.5, seed + 1
    return total


def circle(count, phase=0.0):
    return [2 * pi * (i + phase) / count for i in range(count)]
