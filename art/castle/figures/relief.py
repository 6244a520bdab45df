# SPDX-License-Identifier: Apache-2.0
"""Normal maps: relief too fine for triangles. A height function, in metres, over the skin or over a
tile becomes a picture of slopes as glTF and X3D 4 have it: red along u, green along v, blue
outwards."""
from array import array
from math import cos, sin, sqrt

from beard import mask
from face_form import (CORNER_LINE, MOUTH_HALF, TEAR_LINE, beside, forehead_line, lower_lip_y,
                       part_y, upper_lip_y)
from fabric import wrap_noise
from form import bell, clamp, fractal, lerp, noise, smoothstep
from paint import Image, texels
from person import WHO

FLAT = (0.5, 0.5, 1.0)


def encode(slope_u, slope_v):
    size = sqrt(slope_u * slope_u + slope_v * slope_v + 1)
    return 0.5 - 0.5 * slope_u / size, 0.5 - 0.5 * slope_v / size, 0.5 + 0.5 / size


def over_patch(patch, points, height, width, rows):
    """The normal map of height(point) over a patch in its own texture; slopes are measured on the
    surface."""
    size = width * rows
    place = array("f", [0.0, 0.0, 0.0]) * size
    high = array("f", [0.0]) * size
    done = bytearray(size)
    for x, y, p in texels(patch, points, width, rows, done):
        i = y * width + x
        done[i] = 1
        place[3 * i], place[3 * i + 1], place[3 * i + 2] = p
        high[i] = height(p)
    image = Image(width, rows, FLAT)

    def slope(i, step):
        a, b = i - step, i + step
        if not (0 <= a and b < size and done[a] and done[b]):
            return 0.0
        far = sqrt(sum((place[3 * b + k] - place[3 * a + k]) ** 2 for k in range(3)))
        return (high[b] - high[a]) / far if 1e-6 < far < 0.01 else 0.0

    for i in range(size):
        if done[i]:
            image.put(i % width, i // width, encode(slope(i, 1), slope(i, width)))
    image.grow(6)
    return image


def over_tile(width, rows, height, across, along):
    """The normal map of a tile height(u, v) that is `across` metres wide and `along` metres
    high."""
    image = Image(width, rows, FLAT)
    high = [[height((x + 0.5) / width, (y + 0.5) / rows) for x in range(width)]
            for y in range(rows)]
    for y in range(rows):
        above, below = high[(y + 1) % rows], high[y - 1]
        for x in range(width):
            u = (high[y][(x + 1) % width] - high[y][x - 1]) * width / (2 * across)
            v = (above[x] - below[x]) * rows / (2 * along)
            image.put(x, y, encode(u, v))
    return image


def laughter_lines(x, y):
    """Fine lines that fan out from the outer corner of the eye."""
    h = 0.0
    for a, size in ((0.62, 0.010), (0.36, 0.013), (0.10, 0.014), (-0.18, 0.013), (-0.45, 0.010)):
        dx, dy = x - 0.0475, y + 0.0005
        along, off = (dx * cos(a) + dy * sin(a),
                      -dx * sin(a) + dy * cos(a) + 0.0006 * sin(300 * dx + 4 * a))
        h += (bell(off, 0.00042) * smoothstep(0.0012, 0.004, along)
              * smoothstep(size, 0.5 * size, along))
    return h


def skin_height(p):
    """Pores, the net of fine lines between them, lips, wrinkles of the age; head space."""
    x, y, z = abs(p[0]), p[1], p[2]
    front = smoothstep(0.0, 0.05, z)
    age = WHO.age
    red = 0.0
    if x < 1.05 * MOUTH_HALF and -0.085 < y < -0.055 and z > 0.05:
        red = smoothstep(-0.0004, 0.0006,
                         min(upper_lip_y(min(x, MOUTH_HALF)) - y,
                             y - lower_lip_y(min(x, MOUTH_HALF))))
    cheek = bell(x - 0.022, 0.022) * bell(y + 0.028, 0.024)
    nose = bell(x, 0.014) * bell(y + 0.030, 0.018)
    chin = bell(x, 0.020) * bell(y + 0.098, 0.016)
    oily = clamp(0.30 + 0.8 * cheek + 0.9 * nose + 0.5 * chin) * (0.35 + 0.65 * front)
    h = -1.0e-4 * oily * smoothstep(0.10, 0.55, noise(p, 1350, 15))  # pores
    h += 4.0e-5 * noise(p, 900, 16) + 9.0e-5 * fractal(p, 420, 17, 2)  # lines between them
    h += 1.5e-4 * fractal(p, 150, 18, 2) * front  # flesh is never even
    h *= 1 - red
    if red:
        folds = noise((p[0] * 900 + 0.3 * noise(p, 300, 23), y * 60, 0.0), 1.0, 12)
        h += red * (1.8e-4 * folds + 7e-5 * noise((p[0] * 2100, y * 150, 1.0), 1.0, 13))
    h -= (6e-5 + 2.2e-4 * age) * laughter_lines(x, y) * front
    if y > 0.028:
        for k in range(3):
            off = y - forehead_line(x, k) - 0.0006 * noise((p[0] * 60, k, 0.0), 1.0, 8)
            broken = clamp(0.65 + 0.9 * noise((p[0] * 70, k * 7.0, 0.0), 1.0, 18))
            h -= ((6e-5 + 3.2e-4 * age * age) * broken * bell(off, 0.0007)
                  * smoothstep(0.046, 0.026, x) * front)
    under = bell(x - 0.030, 0.013) * bell(y + 0.0125, 0.0050) * front  # crepe under the eyes
    if under > 0.02:
        h -= ((5e-5 + 1.4e-4 * age) * under
              * smoothstep(-0.1, 0.5,
                           noise((p[0] * 160 + y * 260, y * 1500 - p[0] * 240, 0.0), 1.0, 27)))
    if age > 0.5:
        net = abs(noise((p[0] * 520 + y * 300, y * 520 - p[0] * 200, z * 300), 1.0, 41))
        h -= 1.1e-4 * age * smoothstep(0.25, 0.0, net) * front * (1 - red)
        for line in (CORNER_LINE, TEAR_LINE):
            h -= 3e-4 * age * bell(beside(x, y, line), 0.0007) * front
    return h * (1 - 0.7 * WHO.beard * mask(p) if WHO.beard else 1.0)


def hair_height(u, v):
    """Strands along v, in locks."""
    lock = wrap_noise(u, v, 9.0, 0.16, 3)
    across = u * 420
    strand = (noise((across, v * 2.0, 0.0), 1.0, 1)
              + 0.7 * noise((across * 2.3, v * 2.6, 0.0), 1.0, 2))
    return 2.6e-4 * strand + 7.0e-4 * lock


def make_hair_map(width, rows):
    return over_tile(width, rows, hair_height, 0.30, 0.25)


def make_skin_map(face, side):
    return over_patch(face, face.rest, skin_height, side, side)
