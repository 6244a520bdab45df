# SPDX-License-Identifier: Apache-2.0
"""Painted people and things: portraits, a still life, a coat of arms."""
import numpy as np

from .noise import generator, mix, smoothstep
from .painter import Canvas, oil

SKIN = (0.90, 0.70, 0.55)


def backdrop(c, centre, warm=(0.30, 0.21, 0.13), dark=(0.07, 0.055, 0.045)):
    glow = np.exp(-(((c.x - centre[0]) / 0.42) ** 2 + ((c.y - centre[1]) / 0.5) ** 2))
    c.pixels = mix(np.ones(c.pixels.shape) * dark, warm,
                   glow * (0.8 + 0.4 * (c.noise(2.2, 2, 40) - 0.5)))


def neck(c, x, y, s):
    c.ball(x + 0.02 * s, y + 0.52 * s, 0.20 * s, 0.34 * s, np.asarray(SKIN) * 0.80, shine=0.0,
           ambient=0.3)


def face(c, x, y, s, beard=None, look=0.0):
    """A head seen three-quarters, `s` tall from chin to crown, lit from the upper left."""
    skin = np.asarray(SKIN)
    c.ball(x, y, 0.355 * s, 0.47 * s, skin, (-0.6, -0.42, 0.68), shine=0.05, ambient=0.30)
    c.ball(x - 0.01 * s, y + 0.22 * s, 0.255 * s, 0.25 * s, skin * 0.985, (-0.6, -0.35, 0.7),
           shine=0.02, ambient=0.33)
    rosy = np.exp(-(((c.x - x + 0.16 * s) / (0.10 * s)) ** 2 + ((c.y - y - 0.12 * s)
                                                                / (0.08 * s)) ** 2))
    rosy += np.exp(-(((c.x - x - 0.16 * s) / (0.09 * s)) ** 2 + ((c.y - y - 0.12 * s)
                                                                 / (0.08 * s)) ** 2))
    c.lay((0.84, 0.48, 0.38), rosy, 0.32)
    nose = x - 0.035 * s
    shade = np.exp(-(((c.x - nose - 0.055 * s) / (0.030 * s)) ** 2 + ((c.y - y - 0.06 * s)
                                                                      / (0.13 * s)) ** 2))
    c.lay(skin * 0.55, shade, 0.55)
    c.ball(nose, y + 0.155 * s, 0.058 * s, 0.05 * s, skin * 1.02, shine=0.16, ambient=0.45)
    c.lay(skin * 1.1, c.stroke([(nose - 0.012 * s, y - 0.07 * s), (nose - 0.012 * s,
                                                                   y + 0.14 * s)], 0.03 * s), 0.45)
    c.lay(skin * 0.42,
          np.exp(-(((c.x - nose - 0.01 * s) / (0.05 * s)) ** 2 + ((c.y - y - 0.205 * s)
                                                                  / (0.012 * s)) ** 2)), 0.6)
    for side, width in ((-1, 0.075), (1, 0.066)):
        ex, ey = x - 0.03 * s + side * 0.145 * s, y - 0.035 * s
        socket = np.exp(-(((c.x - ex) / (0.10 * s)) ** 2 + ((c.y - ey + 0.01 * s)
                                                            / (0.06 * s)) ** 2))
        c.lay(skin * 0.56, socket, 0.42 if side < 0 else 0.55)
        c.lay((0.90, 0.86, 0.80), c.ellipse(ex, ey, width * s, 0.030 * s)[0], 0.9)
        c.lay((0.20, 0.15, 0.11), c.ellipse(ex + look * s, ey, 0.030 * s, 0.031 * s)[0])
        c.lay((0.03, 0.03, 0.03), c.ellipse(ex + look * s, ey, 0.015 * s, 0.016 * s)[0])
        c.lay((1.0, 1.0, 1.0), c.ellipse(ex + look * s - 0.011 * s, ey - 0.011 * s, 0.007 * s,
                                         0.007 * s)[0])
        c.lay(skin * 0.30, c.stroke([(ex - width * s, ey + 0.004 * s), (ex - width * 0.3 * s,
            ey - 0.030 * s), (ex + width * 0.4 * s, ey - 0.030 * s), (ex + width * s,
                                                                      ey + 0.006 * s)], 0.014 * s),
                                                                          0.9)
        c.lay((0.22, 0.14, 0.08), c.stroke([(ex - side * 0.07 * s, ey - 0.085 * s),
                                            (ex + side * 0.01 * s, ey - 0.108 * s),
                                                (ex + side * 0.085 * s, ey - 0.078 * s)],
                                                    0.024 * s, 0.012 * s), 0.75)
    mx, my = x - 0.03 * s, y + 0.285 * s
    c.lay((0.66, 0.28, 0.24), c.ellipse(mx, my + 0.016 * s, 0.072 * s, 0.022 * s)[0], 0.85)
    c.lay((0.52, 0.20, 0.18), c.ellipse(mx, my - 0.008 * s, 0.082 * s, 0.016 * s)[0], 0.85)
    c.lay((0.30, 0.10, 0.09), c.stroke([(mx - 0.085 * s, my - 0.002 * s), (mx, my + 0.004 * s),
                                        (mx + 0.08 * s, my - 0.004 * s)], 0.008 * s), 0.8)
    if beard is not None:
        beard = np.asarray(beard)
        for side in (-1, 1):
            c.lay(beard, c.stroke([(mx, my - 0.045 * s), (mx + side * 0.07 * s, my - 0.04 * s),
                                   (mx + side * 0.15 * s, my - 0.075 * s)], 0.05 * s, 0.012 * s),
                                       0.95)
        chin = c.polygon([(mx - 0.10 * s, my + 0.04 * s), (mx + 0.10 * s, my + 0.04 * s),
                          (mx + 0.07 * s, my + 0.18 * s), (mx, my + 0.30 * s),
                              (mx - 0.07 * s, my + 0.18 * s)], 0.02)
        c.lay(beard, chin, 0.92)
        for side in (-1, 1):
            c.lay(beard, c.stroke([(x + side * 0.325 * s, y - 0.05 * s), (x + side * 0.29 * s,
                y + 0.20 * s), (x + side * 0.17 * s, y + 0.40 * s), (mx, my + 0.14 * s)], 0.05 * s,
                    0.09 * s), 0.75)


def ruff(c, x, y, rx, ry, folds=24):
    """A pleated lace collar."""
    inside, u, v = c.ellipse(x, y, rx, ry)
    angle, r = np.arctan2(v, u), np.hypot(u, v)
    pleat = 0.5 + 0.5 * np.sin(angle * folds + 3 * r)
    light = np.clip(0.72 - 0.25 * u - 0.2 * v, 0, 1)
    tone = (0.52 + 0.40 * pleat * (0.4 + 0.6 * r)) * (0.55 + 0.55 * light)
    c.pixels = mix(c.pixels, np.stack([tone, tone * 0.975, tone * 0.92], -1), inside)


def cloth(c, mask, colour, folds=9, slant=0.6, depth=0.35):
    wave = np.sin((c.x + slant * (c.y - 0.7) * np.sign(c.x - c.aspect / 2)) * folds * 6 + 5
                  * c.noise(2.4, 1, 8))
    tone = (0.80 + depth * wave * 0.6) * np.clip(1.25 - 0.75 * c.x / c.aspect, 0.35, 1.2)
    c.pixels = mix(c.pixels, np.clip(np.asarray(colour) * tone[..., None], 0, 1), mask)


def shoulders(c, x, y, width, slope=0.13):
    return c.polygon([(x - 0.13, y), (x - width * 0.72, y + slope), (x - width, y + slope + 0.16),
                      (x - width * 1.05, 1.1), (x + width * 1.05, 1.1),
                      (x + width, y + slope + 0.16), (x + width * 0.72, y + slope), (x + 0.13, y)],
                          0.006)


def paint_lady():
    rng = generator('picture lady')
    c = Canvas(640, 860, (0.1, 0.1, 0.1), rng)
    x = c.aspect / 2
    backdrop(c, (x - 0.05, 0.4), (0.26, 0.25, 0.17))
    c.ball(x + 0.01, 0.315, 0.165, 0.20, (0.42, 0.20, 0.09), shine=0.15,
           ambient=0.25)             # hair
    cloth(c, shoulders(c, x, 0.56, 0.33), (0.48, 0.09, 0.11))
    bodice = c.polygon([(x - 0.12, 0.64), (x + 0.12, 0.64), (x + 0.06, 1.05), (x - 0.06, 1.05)],
                       0.004)
    cloth(c, bodice, (0.80, 0.66, 0.36), 14, 0.0, 0.2)
    lattice = (np.abs(((c.x - x) * 14 + c.y * 14) % 1 - 0.5) < 0.05) | (np.abs(((c.x - x) * 14
        - c.y * 14) % 1 - 0.5) < 0.05)
    c.lay((0.42, 0.28, 0.10), lattice * bodice, 0.6)
    neck(c, x, 0.345, 0.33)
    ruff(c, x + 0.005, 0.545, 0.235, 0.105)
    face(c, x, 0.345, 0.33)
    c.lay((0.36, 0.17, 0.075), c.polygon([(x - 0.125, 0.30), (x - 0.10, 0.20), (x, 0.165),
                                          (x + 0.10, 0.20), (x + 0.125, 0.32), (x + 0.085, 0.235),
                                              (x, 0.205), (x - 0.085, 0.235)], 0.008), 0.95)
    for k in range(9):
        a = np.pi * (0.12 + 0.76 * k / 8)
        c.ball(x - 0.118 * np.cos(a), 0.268 - 0.085 * np.sin(a), 0.0085, 0.0085,
               (0.95, 0.92, 0.86), shine=0.6)
    for k in range(15):
        t = k / 14
        c.ball(x - 0.13 + 0.26 * t, 0.665 + 0.10 * np.sin(np.pi * t), 0.011, 0.011,
               (0.93, 0.90, 0.84), shine=0.6)
    c.ball(x, 0.79, 0.022, 0.028, (0.55, 0.05, 0.08), shine=0.6)
    return oil(c.pixels, rng, ((40, 13, 1.4), (18, 6, 2.0), (9, 3.2, 3.4)))


def paint_nobleman():
    rng = generator('picture nobleman')
    c = Canvas(640, 860, (0.1, 0.1, 0.1), rng)
    x = c.aspect / 2
    backdrop(c, (x - 0.08, 0.42), (0.24, 0.17, 0.12))
    cloth(c, shoulders(c, x, 0.57, 0.35, 0.10), (0.115, 0.11, 0.13), 7, 0.7, 0.6)
    for side in (-1, 1):                                                           # fur collar
        for k in range(60):
            t = rng.random()
            px = x + side * (0.10 + 0.10 * t + 0.05 * (rng.random() - 0.5))
            c.ball(px, 0.60 + 0.5 * t, 0.032, 0.026, np.array((0.50, 0.34, 0.20))
                   * (0.7 + 0.5 * rng.random()), shine=0, ambient=0.4)
    c.ball(x, 0.33, 0.135, 0.175, (0.20, 0.12, 0.07), shine=0.05)
    neck(c, x, 0.36, 0.32)
    ruff(c, x, 0.55, 0.16, 0.066, 18)
    face(c, x, 0.36, 0.32, beard=(0.24, 0.14, 0.08), look=0.004)
    hat = c.polygon([(x - 0.155, 0.262), (x - 0.12, 0.13), (x - 0.02, 0.10), (x + 0.10, 0.125),
                     (x + 0.15, 0.262)], 0.012)
    cloth(c, hat, (0.10, 0.09, 0.12), 5, 0.2, 0.5)
    c.lay((0.085, 0.075, 0.10), c.ellipse(x, 0.262, 0.225, 0.040, -0.05)[0])
    c.lay((0.18, 0.16, 0.20), c.ellipse(x - 0.03, 0.252, 0.17, 0.018, -0.06)[0], 0.6)
    plume = [(x + 0.10, 0.22), (x + 0.17, 0.13), (x + 0.24, 0.12), (x + 0.285, 0.175)]
    c.lay((0.90, 0.87, 0.80), c.stroke(plume, 0.06, 0.03))
    c.lay((0.66, 0.62, 0.56), c.stroke(plume, 0.008, 0.006), 0.8)
    c.ball(x - 0.06, 0.222, 0.020, 0.020, (0.90, 0.70, 0.28), shine=0.5)
    for k in range(17):                                                            # chain of office
        t = k / 16
        c.ball(x - 0.19 + 0.38 * t, 0.70 + 0.16 * np.sin(np.pi * t), 0.017, 0.013,
               (0.90, 0.68, 0.26), shine=0.5)
    c.ball(x, 0.90, 0.042, 0.048, (0.92, 0.70, 0.28), shine=0.5)
    c.ball(x, 0.90, 0.020, 0.024, (0.12, 0.20, 0.45), shine=0.5)
    return oil(c.pixels, rng, ((40, 13, 1.4), (18, 6, 2.0), (9, 3.2, 3.4)))


def paint_captain():
    rng = generator('picture captain')
    c = Canvas(640, 860, (0.1, 0.1, 0.1), rng)
    x = c.aspect / 2
    backdrop(c, (x + 0.02, 0.4), (0.20, 0.22, 0.24))
    body = shoulders(c, x, 0.58, 0.33, 0.11)
    c.lay((0.2, 0.21, 0.23), body)
    c.ball(x, 0.98, 0.30, 0.36, (0.50, 0.53, 0.57), shine=0.55, ambient=0.2,
           mask=body)             # breastplate
    for side in (-1, 1):
        for k in range(3):
            c.ball(x + side * 0.27, 0.74 + 0.075 * k, 0.105, 0.07, (0.46, 0.49, 0.53), shine=0.5,
                   ambient=0.2)
    for k in range(-1, 2):
        c.lay((0.78, 0.60, 0.24), c.stroke([(x + k * 0.12, 0.66), (x + k * 0.09, 1.0)], 0.008), 0.8)
    sash = c.polygon([(x - 0.34, 0.66), (x - 0.24, 0.63), (x + 0.36, 0.98), (x + 0.36, 1.1),
                      (x + 0.24, 1.1)], 0.004)
    cloth(c, sash, (0.60, 0.11, 0.10), 16, 2.0, 0.5)
    c.ball(x, 0.33, 0.15, 0.19, (0.55, 0.53, 0.50), shine=0.05)
    for side in (-1, 1):
        for k in range(14):
            c.ball(x + side * (0.12 + 0.02 * rng.random()), 0.30 + 0.018 * k, 0.034, 0.026,
                   np.array((0.62, 0.59, 0.55)) * (0.7 + 0.4 * rng.random()), shine=0.03)
    neck(c, x, 0.36, 0.33)
    ruff(c, x, 0.555, 0.16, 0.06, 30)
    face(c, x, 0.36, 0.33, beard=(0.55, 0.52, 0.48))
    return oil(c.pixels, rng, ((40, 13, 1.4), (18, 6, 2.0), (9, 3.2, 3.4)))


def paint_still_life():
    rng = generator('picture still life')
    c = Canvas(640, 800, (0.1, 0.08, 0.06), rng)
    backdrop(c, (0.28, 0.35), (0.30, 0.22, 0.14))
    table = smoothstep(0.655, 0.66, c.y)
    c.gradient([(0.65, (0.42, 0.26, 0.14)), (0.8, (0.30, 0.17, 0.09)), (1, (0.12, 0.07, 0.04))],
               table)
    linen = c.polygon([(0.34, 0.66), (0.80, 0.66), (0.80, 0.9), (0.68, 0.98), (0.55, 0.88),
                       (0.42, 0.95)], 0.004)
    cloth(c, linen, (0.90, 0.87, 0.80), 8, 0.2, 0.4)
    c.ball(0.24, 0.47, 0.135, 0.20, (0.40, 0.44, 0.50), shine=0.7,
           ambient=0.18)                  # pewter jug
    c.lay((0.34, 0.37, 0.42), c.polygon([(0.17, 0.33), (0.19, 0.18), (0.30, 0.18), (0.31, 0.33)],
                                        0.004))
    c.lay((0.62, 0.65, 0.70), c.stroke([(0.205, 0.20), (0.20, 0.42)], 0.018), 0.8)
    c.ball(0.245, 0.18, 0.065, 0.02, (0.55, 0.58, 0.62), shine=0.3)
    c.lay((0.30, 0.33, 0.38), c.stroke([(0.31, 0.22), (0.41, 0.27), (0.41, 0.42), (0.35, 0.52)],
                                       0.024))
    for x, y, r, colour in ((0.40, 0.62, 0.085, (0.74, 0.16, 0.10)), (0.54, 0.60, 0.082,
                                                                      (0.80, 0.52, 0.14)),
                                                                          (0.47, 0.68, 0.088,
                                                                              (0.82, 0.70, 0.20)),
                            (0.62, 0.68, 0.078, (0.68, 0.12, 0.10))):
        shadow, _, _ = c.ellipse(x + 0.03, y + r * 0.92, r * 1.15, r * 0.22)
        c.lay((0.08, 0.05, 0.03), shadow, 0.6)
        c.ball(x, y, r, r * 0.95, colour, shine=0.45, ambient=0.2)
        c.lay((0.20, 0.12, 0.06), c.stroke([(x, y - r * 0.85), (x + 0.012, y - r * 1.2)], 0.008))
    for k in range(34):                                                            # grapes
        t = rng.random()
        px, py = 0.20 + 0.15 * t + 0.07 * (rng.random()
                                           - 0.5), 0.70 + 0.10 * rng.random() + 0.05 * t
        c.ball(px, py, 0.028, 0.029, np.array((0.24, 0.12, 0.30)) * (0.8 + 0.5 * rng.random()),
               shine=0.5, ambient=0.2)
    c.ball(0.66, 0.82, 0.075, 0.052, (0.93, 0.80, 0.22), shine=0.3,
           angle=0.5)                    # lemon
    c.lay((0.96, 0.90, 0.62), c.ellipse(0.605, 0.80, 0.03, 0.045, 0.5)[0], 0.9)
    glass, u, v = c.ellipse(0.66, 0.42, 0.062, 0.105)
    c.lay((0.75, 0.72, 0.55), glass * (0.18 + 0.5 * smoothstep(0.75, 1.0, np.hypot(u, v))), 0.8)
    c.lay((0.50, 0.08, 0.08), glass * smoothstep(-0.1, 0.0, v), 0.7)
    c.lay((0.95, 0.95, 0.9), c.stroke([(0.625, 0.36), (0.62, 0.45)], 0.010), 0.8)
    c.lay((0.62, 0.60, 0.52), c.stroke([(0.66, 0.52), (0.66, 0.62)], 0.010), 0.8)
    c.lay((0.62, 0.60, 0.52), c.ellipse(0.66, 0.63, 0.05, 0.012)[0], 0.8)
    return oil(c.pixels, rng, ((40, 13, 1.4), (20, 7, 2.0), (10, 3.6, 2.8)))


def paint_arms():
    rng = generator('picture arms')
    c = Canvas(512, 640, (0.82, 0.74, 0.58), rng)
    c.pixels *= (0.86 + 0.28 * c.noise(2.2, 1, 40))[..., None]
    x = c.aspect / 2
    gold, red, blue, silver = (0.86, 0.66, 0.22), (0.62, 0.10, 0.10), (0.12, 0.20, 0.46), (0.90,
        0.89, 0.86)
    for side in (-1, 1):                                                           # mantling
        for k in range(9):
            t = k / 8
            px = x + side * (0.10 + 0.24 * np.sin(2.6 * t)); py = 0.24 + 0.46 * t
            c.lay(red if k % 2 else gold, c.stroke([(px, py), (px + side * 0.06, py + 0.05),
                                                    (px + side * 0.03, py + 0.10)], 0.06, 0.015),
                                                        0.95)
    shield = [(x - 0.23, 0.40), (x + 0.23, 0.40), (x + 0.23, 0.64), (x + 0.17, 0.78), (x, 0.90),
              (x - 0.17, 0.78), (x - 0.23, 0.64)]
    mask = c.polygon(shield)
    c.lay(gold, c.polygon([(x + (a - x) * 1.07, 0.65 + (b - 0.65) * 1.06) for a, b in shield]))
    c.lay(red, mask)
    c.lay(blue, mask * (((c.x > x) != (c.y > 0.63)).astype(float)))
    castle_x, castle_y = x - 0.115, 0.60
    for dx, top in ((-0.055, 0.47), (0.0, 0.44), (0.055, 0.47)):
        c.lay(silver, c.polygon([(castle_x + dx - 0.022, castle_y), (castle_x + dx - 0.022, top),
                                 (castle_x + dx + 0.022, top), (castle_x + dx + 0.022, castle_y)])
                                     * mask)
    c.lay(silver, c.polygon([(castle_x - 0.075, castle_y), (castle_x - 0.075, 0.53),
                             (castle_x + 0.075, 0.53), (castle_x + 0.075, castle_y)]) * mask)
    c.lay((0.1, 0.08, 0.08), c.ellipse(castle_x, 0.59, 0.016, 0.03)[0] * mask)
    for k in range(3):                                                             # three stars
        sx, sy = x + 0.115 + (-0.05, 0.05, 0.0)[k], 0.48 + (0.0, 0.0, 0.075)[k]
        points = [(sx + (0.032 if i % 2 == 0 else 0.013) * np.sin(np.pi * i / 6),
                   sy - (0.032 if i % 2 == 0 else 0.013) * np.cos(np.pi * i / 6))
                       for i in range(12)]
        c.lay(gold, c.polygon(points))
    for k in range(3):  # waves for the well
        wave = [(x - 0.22 + 0.02 * i, 0.675 + 0.05 * k + 0.010 * np.sin(i * 1.6))
                for i in range(12)]
        c.lay(silver, c.stroke(wave, 0.016) * mask * (c.x < x))
    rose_x, rose_y = x + 0.085, 0.715
    for k in range(5):
        a = 2 * np.pi * k / 5
        c.ball(rose_x + 0.034 * np.sin(a), rose_y - 0.034 * np.cos(a), 0.027, 0.027, gold,
               shine=0.1, ambient=0.5)
    c.ball(rose_x, rose_y, 0.016, 0.016, silver, shine=0.2)
    c.ball(x, 0.28, 0.085, 0.10, (0.55, 0.57, 0.60),
           shine=0.6)                                   # helmet and crown
    c.lay((0.06, 0.06, 0.07), c.stroke([(x - 0.07, 0.27), (x + 0.05, 0.27)], 0.014))
    for k in range(5):
        px = x - 0.08 + 0.04 * k
        c.lay(gold, c.polygon([(px - 0.02, 0.19), (px, 0.125 - 0.012 * (k % 2)),
                               (px + 0.02, 0.19)]))
        c.ball(px, 0.12 - 0.012 * (k % 2), 0.010, 0.010, silver, shine=0.4)
    c.lay(gold, c.stroke([(x - 0.10, 0.19), (x + 0.10, 0.19)], 0.022))
    c.lay((0.90, 0.85, 0.70), c.stroke([(x - 0.28, 0.955), (x, 0.93), (x + 0.28, 0.955)], 0.045))
    return oil(c.pixels, rng, ((26, 9, 1.2), (12, 4, 2.4), (7, 2.6, 3.5)), relief=0.03)
