# SPDX-License-Identifier: Apache-2.0
"""Woven things, and the small printed, carved and glazed pictures of the collection."""
import numpy as np

from .noise import blur, generator, mix, normal_map, smoothstep, solid, spectral
from .landscapes import stag
from .painter import Canvas
from .surfaces import veins


def weave_normal():
    """Ribbed tapestry weave, 32 ribs across."""
    y, x = np.mgrid[0:256, 0:256].astype(float)
    rib = np.abs(np.sin(np.pi * x / 8))
    pick = np.abs(np.sin(np.pi * (y / 4 + (x // 8) % 2 * 0.5)))
    return normal_map(rib * 1.2 + pick * 0.8, 1.1)


def woven(pixels, stitch, rng, contrast=0.10):
    """Reduces a design to stitches of slightly uneven dye, and shows the thread."""
    height, width = pixels.shape[:2]
    rows, columns = height // stitch, width // stitch
    cells = pixels[:rows * stitch, :columns * stitch].reshape(rows, stitch, columns, stitch,
                                                              3).mean(axis=(1, 3))
    cells = cells * (1 + rng.normal(0, 0.045, (rows, columns, 1)))
    dye = spectral((rows, columns), rng, 2.0, 1, 60, stretch=(0.35, 2.0)) - 0.5
    cells = cells * (1 + 0.22 * dye[..., None])
    big = np.repeat(np.repeat(cells, stitch, 0), stitch, 1)
    y, x = np.mgrid[0:big.shape[0], 0:big.shape[1]]
    thread = np.sin(np.pi * ((x % stitch) + 0.5) / stitch) * (0.75 + 0.25
                                                              * np.sin(np.pi * ((y % stitch) + 0.5)
                                                                  / stitch))
    return np.clip(big * (1 - contrast + 1.2 * contrast * thread)[..., None], 0, 1)


def flower(c, x, y, s, petals, heart, count=5, phase=0.0):
    for k in range(count):
        a = phase + 2 * np.pi * k / count
        c.lay(petals, c.ellipse(x + s * 0.62 * np.cos(a), y + s * 0.62 * np.sin(a), s * 0.5,
                                s * 0.34, a)[0])
    c.lay(heart, c.ellipse(x, y, s * 0.3, s * 0.3)[0])


def sprig(c, x, y, s, rng, tone=1.0):
    """One plant of a millefleurs ground."""
    green = np.array((0.36, 0.46, 0.26)) * (0.75 + 0.5 * rng.random()) * tone
    lean = rng.normal(0, 0.25)
    stem = [(x, y), (x + lean * s * 0.5, y - s * 0.5), (x + lean * s, y - s)]
    c.lay(green, c.stroke(stem, 0.10 * s))
    for side in (-1, 1):
        c.lay(green * 1.15, c.stroke([(x + lean * 0.2 * s, y - 0.2 * s), (x + side * 0.42 * s,
            y - 0.42 * s)], 0.20 * s, 0.04 * s))
    dyes = [(0.80, 0.34, 0.30), (0.88, 0.78, 0.62), (0.86, 0.64, 0.28), (0.62, 0.66, 0.80),
            (0.88, 0.60, 0.56)]
    flower(c, x + lean * s, y - s, 0.36 * s, np.array(dyes[rng.integers(0, 5)]) * tone,
           (0.86, 0.70, 0.30), 5, rng.random() * 6)


def border(c, width, ground, line):
    """Band of leafy scrolls and rosettes around a hanging."""
    edge = np.minimum(np.minimum(c.x, c.aspect - c.x), np.minimum(c.y, 1 - c.y))
    c.lay(ground, (edge < width).astype(float))
    for a, b in ((0.0, 0.010), (width * 0.12, width * 0.20), (width * 0.84, width * 0.92)):
        c.lay(line, ((edge >= a) & (edge < b)).astype(float))
    m = width * 0.52
    for horizontal in (True, False):
        length = (c.aspect if horizontal else 1.0) - 2 * m
        count = int(round(length / (width * 1.15)))
        for k in range(count + 1):
            t = m + length * k / count
            for far in (False, True):
                if horizontal:
                    x, y = t, (1 - m if far else m)
                else:
                    x, y = (c.aspect - m if far else m), t
                if k % 2 == 0:
                    flower(c, x, y, width * 0.24, (0.80, 0.30, 0.26), (0.90, 0.76, 0.36), 6)
                else:
                    for q in range(4):
                        a = np.pi / 4 + q * np.pi / 2
                        c.lay((0.52, 0.58, 0.34), c.stroke([(x, y), (x + width * 0.28 * np.cos(a),
                                                                     y + width * 0.28
                                                                         * np.sin(a))],
                                                                             width * 0.13,
                                                                                 width * 0.03))
                    c.lay((0.90, 0.76, 0.36), c.ellipse(x, y, width * 0.08, width * 0.08)[0])


def millefleurs(c, rng, inset, keep_clear, count=420, size=0.045):
    placed = []
    for _ in range(count * 6):
        x, y = inset + rng.random() * (c.aspect - 2 * inset), inset + 0.03 + rng.random() * (1 - 2
            * inset - 0.03)
        if keep_clear(x, y) or any((x - a) ** 2 + (y - b) ** 2 < (size * 1.02) ** 2 for a,
                                   b in placed):
            continue
        placed.append((x, y))
        sprig_local(c, x, y, size * (0.8 + 0.35 * rng.random()), rng)
        if len(placed) >= count:
            break


def sprig_local(c, x, y, s, rng):
    """Draws a sprig on the part of the canvas it touches: many of them stay quick."""
    h = c.height
    x0, x1 = max(0, int((x - s) * h)), min(c.width, int((x + s) * h) + 1)
    y0, y1 = max(0, int((y - 1.6 * s) * h)), min(h, int((y + 0.4 * s) * h) + 1)
    part = Canvas.__new__(Canvas)
    part.x, part.y = c.x[y0:y1, x0:x1], c.y[y0:y1, x0:x1]
    part.soft, part.height, part.aspect = c.soft, c.height, c.aspect
    part.pixels = c.pixels[y0:y1, x0:x1]
    sprig(part, x, y, s, rng)
    c.pixels[y0:y1, x0:x1] = part.pixels


def tapestry_stag():
    """A white stag under an oak on a flowering green-blue ground."""
    rng = generator('tapestry stag')
    c = Canvas(1020, 1280, (0.115, 0.185, 0.20), rng)
    x = c.aspect / 2
    c.gradient([(0.0, (0.13, 0.21, 0.25)), (0.55, (0.10, 0.17, 0.18)), (1.0, (0.12, 0.19, 0.13))])
    mound = smoothstep(-0.004, 0.004, c.y - 0.73 - 0.10 * ((c.x - x) / 0.4) ** 2)
    c.lay((0.20, 0.28, 0.16), mound)
    clear = lambda a, b: ((a - x) / 0.25) ** 2 + ((b - 0.60) / 0.20) ** 2 < 1 or ((a - x - 0.02)
        / 0.27) ** 2 + ((b - 0.27) / 0.17) ** 2 < 1
    millefleurs(c, rng, 0.10, clear, 330, 0.042)
    trunk = [(x + 0.02, 0.74), (x + 0.05, 0.55), (x + 0.01, 0.40), (x + 0.02, 0.28)]
    c.lay((0.40, 0.29, 0.18), c.stroke(trunk, 0.060, 0.030))
    for k in range(70):                                                            # oak crown
        a, r = rng.random() * 2 * np.pi, np.sqrt(rng.random())
        px, py = x + 0.02 + 0.235 * r * np.cos(a), 0.27 + 0.135 * r * np.sin(a)
        tone = np.array((0.36, 0.44, 0.22)) * (0.75 + 0.6 * rng.random())
        for q in range(3):
            b = rng.random() * np.pi
            c.lay(tone, c.ellipse(px + 0.014 * np.cos(q * 2.1), py + 0.014 * np.sin(q * 2.1),
                                  0.026, 0.012, b)[0])
        if k % 5 == 0:
            c.lay((0.80, 0.60, 0.24), c.ellipse(px, py, 0.010, 0.012)[0])
    stag(c, x + 0.01, 0.755, 0.205, (0.66, 0.62, 0.54), 1.1)
    collar = c.stroke([(x - 0.085, 0.545), (x - 0.035, 0.555)], 0.022)
    c.lay((0.86, 0.66, 0.24), collar)
    border(c, 0.085, (0.40, 0.13, 0.12), (0.80, 0.62, 0.28))
    return woven(c.pixels, 4, rng)


def tapestry_eagle():
    """A crowned eagle with a shield on a crimson ground."""
    rng = generator('tapestry eagle')
    c = Canvas(1020, 1280, (0.42, 0.09, 0.10), rng)
    x = c.aspect / 2
    clear = lambda a, b: ((a - x) / 0.33) ** 2 + ((b - 0.50) / 0.36) ** 2 < 1
    millefleurs(c, rng, 0.10, clear, 260, 0.046)
    gold, dark = np.array((0.88, 0.70, 0.32)), np.array((0.17, 0.13, 0.14))
    disc, u, v = c.ellipse(x, 0.50, 0.315, 0.345)
    c.lay((0.52, 0.13, 0.12), disc)
    c.lay(gold, disc * (np.hypot(u, v) > 0.955))
    for side in (-1, 1):
        p = lambda a, b: (x + side * a, b)
        for k in range(7):                                                         # wing feathers
            t = k / 6
            root = p(0.10 + 0.06 * t, 0.37 + 0.02 * t)
            tip = p(0.265 - 0.115 * t ** 1.6, 0.40 + 0.245 * t ** 0.75)
            c.lay(dark * (1.0 + 0.25 * (k % 2)),
                  c.stroke([root, ((root[0] * 0.4 + tip[0] * 0.6) + side * 0.012,
                                   root[1] * 0.5 + tip[1] * 0.5), tip], 0.046, 0.020))
            c.lay(gold * 0.8, c.stroke([root, tip], 0.0045))
        c.lay(dark, c.stroke([p(0.02, 0.42), p(0.10, 0.345), p(0.20, 0.335), p(0.265, 0.37)], 0.07,
                             0.03))
        c.lay(gold * 0.9, c.stroke([p(0.05, 0.385), p(0.12, 0.335), p(0.21, 0.328)], 0.010))
        c.lay(gold, c.stroke([p(0.04, 0.60), p(0.09, 0.665), p(0.085, 0.70)], 0.030,
                             0.016))        # legs
        for q in (-1, 0, 1):
            c.lay(gold, c.stroke([p(0.085, 0.70), p(0.085 + q * 0.035, 0.735)], 0.014, 0.006))
    for k in range(-2, 3):                                                         # tail
        c.lay(dark * (1.0 + 0.25 * (k % 2)), c.stroke([(x, 0.60), (x + k * 0.022, 0.70),
                                                       (x + k * 0.045, 0.785)], 0.05, 0.022))
        c.lay(gold * 0.8, c.stroke([(x, 0.62), (x + k * 0.040, 0.77)], 0.0045))
    c.lay(dark, c.ellipse(x, 0.50, 0.085, 0.145)[0])
    for row in range(6):
        for k in range(-2, 3):
            c.lay(gold * 0.55, c.ellipse(x + k * 0.030 + (row % 2) * 0.015, 0.42 + row * 0.033,
                                         0.011, 0.009)[0] * c.ellipse(x, 0.50, 0.08, 0.14)[0])
    c.lay(dark, c.stroke([(x, 0.42), (x - 0.005, 0.33), (x - 0.02, 0.285)], 0.085, 0.06))
    c.lay(dark, c.ellipse(x - 0.022, 0.272, 0.042, 0.036)[0])
    c.lay(gold, c.polygon([(x - 0.05, 0.258), (x - 0.105, 0.283), (x - 0.092, 0.298),
                           (x - 0.05, 0.290)]))
    c.lay(gold, c.ellipse(x - 0.034, 0.265, 0.008, 0.008)[0])
    for k in range(5):
        px = x - 0.062 + 0.022 * k
        c.lay(gold, c.polygon([(px - 0.013, 0.236), (px, 0.192 + 0.010 * (k % 2)),
                               (px + 0.013, 0.236)]))
    c.lay(gold, c.stroke([(x - 0.075, 0.238), (x + 0.038, 0.238)], 0.014))
    shield = [(x - 0.058, 0.44), (x + 0.058, 0.44), (x + 0.055, 0.53), (x, 0.60), (x - 0.055, 0.53)]
    c.lay(gold, c.polygon([(x + (a - x) * 1.14, 0.51 + (b - 0.51) * 1.12) for a, b in shield]))
    mask = c.polygon(shield)
    c.lay((0.16, 0.25, 0.46), mask)
    for k in range(3):
        c.lay((0.90, 0.88, 0.82),
              c.stroke([(x - 0.06 + 0.012 * i, 0.475 + 0.035 * k + 0.006 * np.sin(i * 1.5))
                        for i in range(11)], 0.011) * mask)
    border(c, 0.085, (0.14, 0.20, 0.30), (0.84, 0.66, 0.30))
    return woven(c.pixels, 4, rng)


def rug():
    """A hearth rug with a medallion, drawn in one quarter and mirrored."""
    rng = generator('rug')
    c = Canvas(1152, 768, (0.44, 0.10, 0.09), rng)
    x = c.aspect / 2
    ax, ay = np.abs(c.x - x), np.abs(c.y - 0.5)
    navy, ivory, ochre, red = (0.12, 0.15, 0.26), (0.84, 0.77, 0.62), (0.74, 0.52, 0.22), (0.52,
        0.12, 0.10)
    vine = np.sin(ax * 52 + 6 * np.sin(ay * 26)) * np.sin(ay * 52 + 6 * np.sin(ax * 26))
    c.lay((0.62, 0.26, 0.16), (vine > 0.62).astype(float), 0.8)
    c.lay(ochre, (vine < -0.80).astype(float), 0.8)
    for scale, colour in ((1.0, navy), (0.90, ochre), (0.86, navy), (0.58, red), (0.52, ivory),
                          (0.47, red)):
        a = np.arctan2(ay, ax)
        r = np.hypot(ax / 0.44, ay / 0.30) / (1 + 0.08 * np.cos(a * 12))
        c.lay(colour, (r < scale).astype(float))
    inner = np.hypot(ax / 0.44, ay / 0.30)
    petals = np.sin(np.arctan2(ay, ax) * 10) * np.sin(inner * 30)
    c.lay(ivory, ((petals > 0.5) & (inner < 0.84)).astype(float), 0.75)
    c.lay((0.60, 0.20, 0.14), ((petals < -0.6) & (inner < 0.84)).astype(float), 0.75)
    corner = np.hypot((x - 0.12 - ax) / 0.26, (0.38 - ay) / 0.22)
    c.lay(navy, (corner < 0.75).astype(float))
    c.lay(ochre, ((corner < 0.75) & (corner > 0.68)).astype(float))
    edge = np.minimum(x - ax, 0.5 - ay)
    c.lay(navy, (edge < 0.12).astype(float))
    along = np.where(x - ax < 0.5 - ay, ay, ax)
    motif = np.sin(along * 60) * np.sin((edge - 0.02) * np.pi / 0.08)
    c.lay(red, ((motif > 0.35) & (edge < 0.11)).astype(float))
    c.lay(ivory, ((motif < -0.55) & (edge < 0.11)).astype(float))
    for a, b, colour in ((0.112, 0.122, ivory), (0.100, 0.106, ochre), (0.0, 0.016, red),
                         (0.016, 0.022, ivory)):
        c.lay(colour, ((edge >= a) & (edge < b)).astype(float))
    return woven(c.pixels, 3, rng, 0.14)


def book_page():
    """An illuminated double page: two columns of script, a gilded initial, a painted margin."""
    rng = generator('book page')
    c = Canvas(1024, 704, (0.87, 0.80, 0.65), rng)
    c.pixels *= (0.93 + 0.14 * c.noise(2.2, 1, 60))[..., None]
    for page in (0, 1):
        left = 0.10 + page * c.aspect / 2
        for row in range(17):
            if page == 0 and row < 5:
                start = left + 0.17
            else:
                start = left
            x, y = start, 0.14 + row * 0.044
            while x < left + 0.50:
                word = 0.02 + 0.05 * rng.random()
                ink = (0.45, 0.10, 0.07) if rng.random() < 0.04 else (0.17, 0.11, 0.08)
                strokes = int(word / 0.008)
                for k in range(strokes):
                    px = x + k * 0.008
                    x0, x1 = int((px - 0.004) * c.height), int((px + 0.008) * c.height)
                    y0, y1 = int((y - 0.014 - 0.010 * (rng.random() < 0.25)) * c.height), int((y
                        + 0.004) * c.height)
                    c.pixels[y0:y1, (x0 + x1) // 2 - 1:(x0 + x1) // 2 + 1] = np.asarray(ink)
                    if rng.random() < 0.6:
                        c.pixels[y1 - 2:y1, x0:x1] = c.pixels[y1 - 2:y1,
                                                              x0:x1] * 0.5 + np.asarray(ink) * 0.5
                x += word + 0.018
    c.lay((0.16, 0.24, 0.50), c.polygon([(0.10, 0.12), (0.255, 0.12), (0.255, 0.32), (0.10, 0.32)]))
    c.lay((0.86, 0.66, 0.22), c.stroke([(0.135, 0.29), (0.178, 0.15), (0.222, 0.29)], 0.026))
    c.lay((0.86, 0.66, 0.22), c.stroke([(0.150, 0.24), (0.208, 0.24)], 0.014))
    for k in range(13):
        y = 0.16 + 0.055 * k
        for x in (0.055, c.aspect - 0.055):
            c.lay((0.24, 0.40, 0.20), c.stroke([(x, y - 0.03), (x + 0.016 * (-1) ** k, y),
                                                (x, y + 0.03)], 0.006))
            flower(c, x + 0.016 * (-1) ** k, y, 0.016, ((0.70, 0.16, 0.14),
                                                        (0.20, 0.30, 0.58))[k % 2],
                                                            (0.88, 0.70, 0.26))
    gutter = np.exp(-((c.x - c.aspect / 2) / 0.035) ** 2)
    c.pixels *= (1 - 0.5 * gutter)[..., None]
    return np.clip(c.pixels, 0, 1)


def label():
    """A museum label: a heading and lines too small to read."""
    rng = generator('label')
    c = Canvas(256, 176, (0.93, 0.915, 0.87), rng)
    c.lay((0.15, 0.13, 0.12), c.stroke([(0.12, 0.20), (0.85, 0.20)], 0.075))
    for k in range(4):
        end = 1.30 if k < 3 else 0.8
        x = 0.12
        while x < end:
            w = 0.05 + 0.10 * rng.random()
            c.lay((0.30, 0.28, 0.27), c.stroke([(x, 0.42 + 0.13 * k), (min(end, x + w),
                0.42 + 0.13 * k)], 0.034))
            x += w + 0.06
    return c.pixels


def white_marble():
    rng, shape = generator('white marble'), (512, 512)
    colour = solid(shape, (0.90, 0.885, 0.855)) * (0.95 + 0.08 * spectral(shape, rng, 2.4, 1,
        30))[..., None]
    return mix(colour, (0.66, 0.65, 0.64), veins(shape, rng, 2, 0.012, 60) * 0.35)


def gilt():
    """Water gilding: gold leaf over red clay, rubbed through here and there."""
    rng, shape = generator('gilt'), (256, 256)
    colour = solid(shape, (0.97, 0.79, 0.42)) * (0.86 + 0.22 * spectral(shape, rng, 2.0, 2,
        60))[..., None]
    rubbed = smoothstep(0.60, 0.86, spectral(shape, rng, 1.8, 3, 60))
    return mix(colour, (0.56, 0.28, 0.17), rubbed * 0.55)


def jug():
    """Tin-glazed ware painted in blue with a frieze of flowers; wraps around."""
    rng = generator('jug')
    c = Canvas(768, 512, (0.93, 0.925, 0.90), rng)
    blue, ochre, green = (0.13, 0.22, 0.52), (0.84, 0.58, 0.16), (0.22, 0.44, 0.26)
    for y, w in ((0.06, 0.02), (0.10, 0.006), (0.285, 0.016), (0.72, 0.016), (0.755, 0.006),
                 (0.93, 0.03)):
        c.lay(blue, (np.abs(c.y - y) < w / 2).astype(float))
    count = 5
    for k in range(-1, count + 1):
        x = c.aspect * (k + 0.5) / count
        flower(c, x, 0.50, 0.085, blue, ochre, 8, 0.2)
        for side in (-1, 1):
            stem = [(x, 0.60), (x + side * 0.08, 0.66), (x + side * 0.15, 0.58), (x + side * 0.14,
                0.48)]
            c.lay(green, c.stroke(stem, 0.012))
            flower(c, x + side * 0.14, 0.44, 0.034, ochre, blue, 5)
            c.lay(green, c.ellipse(x + side * 0.10, 0.62, 0.032, 0.013, side * 0.6)[0])
        c.lay(blue, c.stroke([(x - 0.09, 0.20), (x, 0.15), (x + 0.09, 0.20)], 0.012))
        c.lay(blue, c.ellipse(x, 0.20, 0.016, 0.016)[0])
        c.lay(blue, c.stroke([(x - 0.13, 0.84), (x - 0.065, 0.80), (x, 0.84), (x + 0.065, 0.88),
                              (x + 0.13, 0.84)], 0.014))
    glaze = spectral((512, 768), rng, 2.0, 1, 60)
    return np.clip(blur(c.pixels, 0.8) * (0.95 + 0.08 * glaze)[..., None], 0, 1)


def fossil():
    rng, shape = generator('fossil'), (512, 512)
    band = spectral(shape, rng, 2.0, 2, 60, stretch=(1.0, 3.0))
    colour = mix(solid(shape, (0.42, 0.30, 0.20)), (0.78, 0.66, 0.48), smoothstep(0.3, 0.7, band))
    speck = smoothstep(0.6, 0.75, spectral(shape, rng, 1.0, 30, 200))
    return mix(colour, (0.25, 0.18, 0.13), speck * 0.5)
