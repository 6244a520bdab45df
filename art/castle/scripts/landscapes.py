# SPDX-License-Identifier: Apache-2.0
"""Painted views: a castle on its hill, a river town, moonlight, a forest, winter; and the sky
outside."""
import numpy as np

from .noise import generator, mix, smoothstep
from .painter import Canvas, oil


def clouds(c, low, high, colour_light, colour_dark, cover=0.5, stretch=(1.0, 0.45)):
    """Heaped clouds between two heights, lit from above."""
    field = c.noise(3.0, 2, 40, stretch)
    band = smoothstep(low - 0.1, low + 0.08, c.y) * (1 - smoothstep(high - 0.15, high, c.y))
    mask = smoothstep(cover, cover + 0.16, field) * band
    shade = smoothstep(-0.02, 0.05, np.roll(field, -int(0.02 * c.height), 0) - field + 0.01)
    c.pixels = mix(c.pixels, mix(np.ones(c.pixels.shape) * colour_light, colour_dark, shade * 0.8),
                   mask * 0.9)


def tower(c, x, foot, width, top, wall, roof, lit=-1, cone=1.6, battlements=False):
    """A tower with its light side to the left (lit = -1) or right."""
    body = c.polygon([(x - width / 2, foot), (x - width / 2, top), (x + width / 2, top),
                      (x + width / 2, foot)])
    side = np.clip(0.5 - lit * (c.x - x) / width, 0, 1)
    wall = np.asarray(wall)
    c.pixels = mix(c.pixels, mix(np.ones(c.pixels.shape) * wall * 0.52, wall, side), body)
    w = width * 0.62
    if battlements:
        for k in range(-2, 3):
            a = x + k * width * 0.26
            c.lay(wall * (0.95 if k * lit > 0 else 0.6), c.polygon([(a - width * 0.09, top),
                                                                    (a - width * 0.09,
                                                                     top - width * 0.22),
                                                                    (a + width * 0.09,
                                                                     top - width * 0.22),
                                                                         (a + width * 0.09, top)]))
    else:
        cap = c.polygon([(x - w, top + 0.004), (x, top - width * cone), (x + w, top + 0.004)])
        roof = np.asarray(roof)
        c.pixels = mix(c.pixels, mix(np.ones(c.pixels.shape) * roof * 0.5, roof, side), cap)
    for k in range(2):
        c.lay((0.12, 0.10, 0.10), c.polygon([(x - width * 0.07, top + width * (0.45 + 0.9 * k)),
                                             (x - width * 0.07, top + width * (0.25 + 0.9 * k)),
                                             (x + width * 0.07, top + width * (0.25 + 0.9 * k)),
                                                 (x + width * 0.07,
                                                  top + width * (0.45 + 0.9 * k))]), 0.8)


def castle(c, x, y, s, wall, roof, lit=-1):
    """A castle of about 1.0 * s width standing on (x, y)."""
    wall, roof = np.asarray(wall), np.asarray(roof)

    def block(x0, x1, top, tone):
        c.lay(wall * tone, c.polygon([(x + x0 * s, y + 0.06 * s), (x + x0 * s, y - top * s),
                                      (x + x1 * s, y - top * s), (x + x1 * s, y + 0.06 * s)]))

    tower(c, x + 0.06 * s, y, 0.13 * s, y - 0.66 * s, wall, roof, lit, 1.7)
    block(-0.42, 0.42, 0.17, 0.80)
    block(-0.20, 0.16, 0.36, 0.92)
    c.lay(roof * 0.85, c.polygon([(x - 0.225 * s, y - 0.355 * s), (x - 0.15 * s, y - 0.47 * s),
                                  (x + 0.12 * s, y - 0.47 * s), (x + 0.185 * s, y - 0.355 * s)]))
    tower(c, x - 0.25 * s, y, 0.11 * s, y - 0.48 * s, wall, roof, lit, 1.6)
    tower(c, x + 0.26 * s, y, 0.14 * s, y - 0.40 * s, wall, roof, lit, 1.2)
    tower(c, x - 0.44 * s, y + 0.02 * s, 0.12 * s, y - 0.27 * s, wall, roof, lit, 1.1,
          battlements=True)
    tower(c, x + 0.45 * s, y + 0.02 * s, 0.10 * s, y - 0.26 * s, wall, roof, lit, 1.5)
    for k in range(6):
        wx = x + (-0.16 + 0.055 * k) * s
        c.lay((0.16, 0.12, 0.11), c.polygon([(wx - 0.008 * s, y - 0.21 * s), (wx - 0.008 * s,
            y - 0.27 * s), (wx + 0.008 * s, y - 0.27 * s), (wx + 0.008 * s, y - 0.21 * s)]), 0.8)


def knoll(c, x, top, width, foot, shade, light):
    """A rocky hill for a castle to stand on."""
    line = foot - (foot - top) * np.exp(-((c.x - x) / width) ** 4) + 0.02 * (c.noise(1.8, 4,
        60)[0][None, :] - 0.5)
    flank = np.clip(0.5 - (c.x - x) / width * 0.8 + 0.8 * (c.noise(1.8, 4, 60) - 0.5), 0, 1)
    c.pixels = mix(c.pixels, mix(np.ones(c.pixels.shape) * shade, light, flank), smoothstep(-0.003,
        0.003, c.y - line))


def tree(c, x, foot, height, leaf, trunk=(0.16, 0.11, 0.08), light=(-0.6, -0.6, 0.5), spread=0.42):
    c.lay(trunk, c.stroke([(x, foot), (x + 0.01 * height, foot - 0.5 * height)], 0.07 * height,
                          0.03 * height))
    leaf = np.asarray(leaf)
    order = sorted((c.rng.random(3) for _ in range(110)), key=lambda v: v[2])
    for a, b, depth in order:
        angle, r = a * 2 * np.pi, np.sqrt(b) * spread * height
        px, py = x + np.cos(angle) * r, foot - 0.66 * height + np.sin(angle) * r * 0.85
        c.ball(px, py, 0.075 * height, 0.055 * height, leaf * (0.65 + 0.5 * depth), light,
               shine=0.0, ambient=0.3)


def pine(c, x, foot, height, colour):
    colour = np.asarray(colour)
    for k in range(7):
        t = k / 7
        w = height * 0.26 * (1 - t) + 0.012 * height
        top = foot - height * (t + 0.26)
        base = foot - height * (t * 0.95)
        c.lay(colour * (0.75 + 0.35 * t), c.polygon([(x - w, base), (x, max(top, foot - height)),
                                                     (x + w, base)], 0.004))


def paint_castle():
    rng = generator('picture castle')
    c = Canvas(1200, 800, (0.8, 0.8, 0.8), rng)
    c.gradient([(0, (0.33, 0.47, 0.66)), (0.30, (0.62, 0.70, 0.76)), (0.52, (0.97, 0.83, 0.60)),
                (0.6, (0.96, 0.75, 0.50))])
    clouds(c, -0.1, 0.46, (1.0, 0.90, 0.74), (0.62, 0.58, 0.64), 0.47)
    c.ridge(0.54, 0.12, 2.2, (0.60, 0.62, 0.70), 20, ((0.80, 0.76, 0.72), 0.12))
    c.ridge(0.60, 0.12, 2.2, (0.44, 0.50, 0.54), 16, ((0.66, 0.66, 0.60), 0.16))
    hill_x, hill_y = 0.98, 0.40
    slope = np.exp(-((c.x - hill_x) / 0.30) ** 2)
    line = 0.70 - (0.70 - hill_y) * slope + 0.012 * (c.noise(1.6, 4, 60)[0][None, :] - 0.5)
    hill = smoothstep(-0.002, 0.002, c.y - line)
    flank = np.clip(0.5 - (c.x - hill_x) * 1.6, 0, 1)
    c.pixels = mix(c.pixels, mix(np.ones(c.pixels.shape) * (0.20, 0.25, 0.19), (0.52, 0.50, 0.28),
                                 flank), hill)
    rock = smoothstep(0.5, 0.64, c.noise(1.8, 6, 80)) * hill * (1 - smoothstep(0.04, 0.22,
        c.y - line))
    c.lay((0.60, 0.53, 0.42), rock, 0.8)
    castle(c, hill_x, hill_y + 0.02, 0.40, (0.93, 0.83, 0.66), (0.62, 0.30, 0.22))
    meadow, _ = c.ridge(0.74, 0.06, 2.6, (0.46, 0.48, 0.24), 6, ((0.25, 0.30, 0.15), 0.3))
    c.lay((0.62, 0.56, 0.28), meadow * smoothstep(0.5, 0.7, c.noise(2.0, 2, 30, (2.5, 1.0))), 0.6)
    river = [(0.60 + 0.16 * np.sin(t * 4.2) + 0.10 * t, 0.69 + 0.31 * t ** 1.5)
             for t in np.linspace(0, 1, 24)]
    c.lay((0.76, 0.74, 0.66), c.stroke(river, 0.012, 0.17))
    c.lay((0.50, 0.60, 0.70), c.stroke([(x + 0.01, y + 0.004) for x, y in river], 0.004, 0.10), 0.6)
    for k in range(26):
        x, y = rng.random() * 1.5, 0.70 + 0.07 * rng.random()
        c.ball(x, y, 0.018 + 0.014 * rng.random(), 0.018, (0.30, 0.36, 0.18), shine=0, ambient=0.3)
    tree(c, 0.20, 0.97, 0.80, (0.36, 0.40, 0.16), spread=0.36)
    tree(c, 0.02, 1.02, 0.62, (0.27, 0.32, 0.13), spread=0.38)
    tree(c, 1.44, 0.98, 0.42, (0.30, 0.34, 0.15))
    return oil(c.pixels, rng)


def paint_river():
    rng = generator('picture river')
    c = Canvas(1020, 680, (0.8, 0.8, 0.8), rng)
    c.gradient([(0, (0.46, 0.60, 0.76)), (0.35, (0.74, 0.80, 0.82)), (0.5, (0.95, 0.90, 0.78))])
    clouds(c, -0.1, 0.42, (0.99, 0.96, 0.90), (0.70, 0.72, 0.78), 0.45)
    c.ridge(0.47, 0.12, 2.2, (0.56, 0.64, 0.72), 14, ((0.74, 0.77, 0.76), 0.1))
    c.ridge(0.55, 0.10, 2.2, (0.40, 0.48, 0.38), 12)
    knoll(c, 1.16, 0.455, 0.26, 0.60, (0.36, 0.44, 0.34), (0.50, 0.56, 0.36))
    castle(c, 1.16, 0.46, 0.24, (0.88, 0.82, 0.70), (0.55, 0.30, 0.24))
    for k in range(26):                                                           # the town
        x = 0.06 + 1.36 * (k + rng.random() * 0.6) / 26
        w, h = 0.045 + 0.025 * rng.random(), 0.05 + 0.05 * rng.random()
        wall = np.array([0.92, 0.86, 0.74]) * (0.85 + 0.2 * rng.random()) + rng.normal(0, 0.03, 3)
        c.lay(wall, c.polygon([(x - w / 2, 0.63), (x - w / 2, 0.63 - h), (x + w / 2, 0.63 - h),
                               (x + w / 2, 0.63)]))
        c.lay(np.array([0.64, 0.33, 0.24]) * (0.8 + 0.3 * rng.random()),
              c.polygon([(x - w * 0.58, 0.632 - h), (x - w * 0.1, 0.60 - h - 0.012),
                         (x + w * 0.2, 0.60 - h - 0.012), (x + w * 0.58, 0.632 - h)]))
        for j in range(2):
            c.lay((0.25, 0.22, 0.22), c.stroke([(x + w * (j - 0.5) * 0.5, 0.60),
                                                (x + w * (j - 0.5) * 0.5, 0.607)], 0.007), 0.8)
    tower(c, 0.52, 0.63, 0.05, 0.40, (0.93, 0.87, 0.74), (0.36, 0.46, 0.42), cone=2.4)
    tower(c, 0.60, 0.63, 0.05, 0.43, (0.93, 0.87, 0.74), (0.36, 0.46, 0.42), cone=2.2)
    shore = int(0.635 * c.height)
    mirror = c.pixels[shore - 1 - np.arange(c.height - shore) * 3 // 2 % shore]
    ripple = (c.noise(1.4, 10, 160, (3.0, 0.5)) - 0.5) * 34
    shift = np.clip(np.arange(c.width)[None, :] + ripple[shore:].astype(int), 0, c.width - 1)
    water = np.take_along_axis(mirror, shift[..., None], axis=1)
    c.pixels[shore:] = mix(water * np.array([0.78, 0.84, 0.88]), (0.52, 0.62, 0.68), 0.35)
    for k in range(5):                                                            # the bridge
        x = 0.70 + 0.16 * k
        c.lay((0.70, 0.62, 0.50), c.polygon([(x - 0.02, 0.70), (x - 0.014, 0.60),
                                             (x + 0.014, 0.60), (x + 0.02, 0.70)]))
    c.lay((0.76, 0.68, 0.55), c.stroke([(0.62, 0.615), (1.02, 0.60), (1.5, 0.615)], 0.022))
    boat = [(0.22, 0.80), (0.25, 0.835), (0.42, 0.835), (0.46, 0.795)]
    c.lay((0.24, 0.16, 0.11), c.polygon(boat))
    c.lay((0.93, 0.88, 0.76), c.polygon([(0.335, 0.79), (0.345, 0.55), (0.44, 0.76)]))
    c.lay((0.20, 0.14, 0.10), c.stroke([(0.34, 0.80), (0.345, 0.53)], 0.006))
    return oil(c.pixels, rng)


def paint_moonlight():
    rng = generator('picture moonlight')
    c = Canvas(960, 680, (0.1, 0.1, 0.2), rng)
    c.gradient([(0, (0.06, 0.10, 0.20)), (0.4, (0.16, 0.25, 0.38)), (0.55, (0.36, 0.45, 0.52)),
                (1, (0.05, 0.08, 0.13))])
    clouds(c, -0.1, 0.5, (0.55, 0.62, 0.66), (0.16, 0.20, 0.30), 0.5)
    glow = np.exp(-np.hypot(c.x - 0.95, c.y - 0.22) ** 2 / 0.045)
    c.lay((0.86, 0.87, 0.76), glow, 0.75)
    c.lay((0.99, 0.97, 0.86), c.ellipse(0.95, 0.22, 0.05, 0.05)[0])
    c.ridge(0.58, 0.20, 2.2, (0.15, 0.20, 0.27), 12)
    knoll(c, 0.42, 0.46, 0.34, 0.66, (0.13, 0.17, 0.22), (0.20, 0.25, 0.31))
    castle(c, 0.42, 0.47, 0.30, (0.26, 0.29, 0.34), (0.14, 0.15, 0.19), lit=1)
    c.ridge(0.62, 0.10, 2.4, (0.09, 0.12, 0.15), 16)
    lake = smoothstep(0.655, 0.66, c.y)
    c.gradient([(0.65, (0.22, 0.30, 0.38)), (1, (0.05, 0.08, 0.13))], lake)
    path = np.exp(-((c.x - 0.95 - 0.02 * np.sin(c.y * 40)) / (0.03 + 0.16 * np.maximum(c.y - 0.65,
        0))) ** 2)
    glitter = smoothstep(0.48, 0.62, c.noise(1.0, 20, 200, (4.0, 0.6)))
    c.lay((0.90, 0.90, 0.78), lake * path * glitter, 0.9)
    for k in range(9):
        pine(c, 0.02 + 0.045 * k + 0.02 * rng.random(), 0.99 - 0.012 * k,
             0.62 - 0.05 * k + 0.1 * rng.random(), (0.055, 0.085, 0.08))
    pine(c, 1.36, 1.0, 0.66, (0.05, 0.075, 0.07))
    for x in (0.455, 0.38, 0.50):
        c.lay((1.0, 0.75, 0.35), c.ellipse(x, 0.435, 0.006, 0.008)[0])
    return oil(c.pixels, rng)


def paint_forest():
    rng = generator('picture forest')
    c = Canvas(960, 680, (0.6, 0.6, 0.4), rng)
    c.gradient([(0, (0.50, 0.55, 0.34)), (0.4, (0.92, 0.86, 0.58)), (0.62, (0.86, 0.76, 0.46)),
                (1, (0.22, 0.20, 0.09))])
    glow = np.exp(-((c.x - 0.80) ** 2 / 0.06 + (c.y - 0.36) ** 2 / 0.07))
    c.lay((1.0, 0.96, 0.78), glow, 0.9)
    for layer, tone in ((0, (0.66, 0.62, 0.40)), (1, (0.44, 0.42, 0.24)), (2, (0.20, 0.17, 0.10))):
        for k in range(16 - 4 * layer):
            x = rng.random() * 1.45
            if layer == 2 and 0.55 < x < 1.05:
                continue
            w = (0.014, 0.024, 0.05)[layer] * (0.7 + 0.6 * rng.random())
            foot = 0.64 + 0.12 * layer
            c.lay(tone, c.stroke([(x, foot), (x + rng.normal(0, 0.015), 0.3),
                                  (x + rng.normal(0, 0.03), -0.05)], w * 1.3, w * 0.7))
    ground = smoothstep(0.64, 0.70, c.y + 0.02 * (c.noise(2, 2, 30) - 0.5))
    c.gradient([(0.62, (0.62, 0.54, 0.26)), (0.8, (0.32, 0.30, 0.13)), (1, (0.13, 0.12, 0.06))],
               ground)
    for k in range(70):
        x, y = rng.random() * 1.42, 0.10 * rng.random() ** 1.5
        c.ball(x, y, 0.05, 0.035, np.array((0.40, 0.42, 0.14)) * (0.6 + 0.6 * rng.random()),
               shine=0, ambient=0.4)
    stag(c, 0.80, 0.735, 0.30, (0.25, 0.14, 0.07))
    rays = np.clip(np.sin((c.x - 0.8) / (0.12 + c.y * 0.6) * 9) * 0.5 + 0.5, 0,
                   1) ** 3 * np.exp(-((c.x - 0.8) / 0.45) ** 2)
    c.lay((1.0, 0.93, 0.68), rays * (1 - smoothstep(0.5, 0.8, c.y)) * smoothstep(0.05, 0.4, c.y),
          0.28)
    return oil(c.pixels, rng)


def stag(c, x, y, s, colour, lighter=1.5):
    """A standing stag, facing left, `s` tall at the shoulder, hooves at y."""
    p = lambda u, v: (x + u * s, y - v * s)
    colour = np.asarray(colour)
    legs = ((-0.36, 0.0), (-0.27, 0.05), (0.36, 0.0), (0.44, 0.04))
    for k, (u, lift) in enumerate(legs):
        knee = 0.03 if k < 2 else -0.05
        c.lay(colour * (1.0 if k % 2 == 0 else 0.75),
              c.stroke([p(u * 0.92, 0.62), p(u + knee, 0.32), p(u, 0.02 + lift)], 0.13 * s,
                       0.045 * s))
    for u, v, a, b in ((-0.26, 0.76, 0.24, 0.22), (0.05, 0.76, 0.34, 0.19), (0.34, 0.76, 0.22,
            0.22)):
        px, py = p(u, v)
        c.ball(px, py, a * s, b * s, colour * 1.5, shine=0.02, ambient=0.42)
    c.lay(colour * 1.1, c.stroke([p(-0.36, 0.86), p(-0.50, 1.10), p(-0.54, 1.26)], 0.26 * s,
                                 0.14 * s))
    c.lay(colour * 1.25, c.stroke([p(-0.52, 1.27), p(-0.74, 1.18)], 0.15 * s, 0.075 * s))
    c.lay(colour, c.stroke([p(-0.47, 1.30), p(-0.36, 1.36)], 0.06 * s, 0.02 * s))
    for side in (-1, 1):
        beam = [p(-0.50, 1.32), p(-0.50 + side * 0.16, 1.52), p(-0.48 + side * 0.26, 1.78),
                p(-0.48 + side * 0.20, 2.0)]
        c.lay(colour * 0.8, c.stroke(beam, 0.05 * s, 0.025 * s))
        for (bu, bv), (tu, tv) in (((0.14, 1.48), (0.02, 1.66)), ((0.22, 1.66), (0.40, 1.84)),
                                   ((0.25, 1.80), (0.12, 1.98))):
            c.lay(colour * 0.8, c.stroke([p(-0.50 + side * bu, bv), p(-0.50 + side * tu, tv)],
                                         0.035 * s, 0.015 * s))
    c.lay(colour * lighter, c.stroke([p(0.52, 0.84), p(0.58, 0.72)], 0.08 * s, 0.03 * s))


def paint_winter():
    rng = generator('picture winter')
    c = Canvas(960, 720, (0.8, 0.85, 0.9), rng)
    c.gradient([(0, (0.52, 0.60, 0.72)), (0.35, (0.80, 0.80, 0.80)), (0.52, (0.96, 0.84, 0.72))])
    clouds(c, -0.1, 0.4, (0.92, 0.90, 0.90), (0.62, 0.66, 0.76), 0.46)
    c.ridge(0.50, 0.22, 2.2, (0.72, 0.76, 0.84), 12, ((0.90, 0.88, 0.88), 0.2))
    knoll(c, 0.88, 0.44, 0.30, 0.64, (0.62, 0.67, 0.76), (0.90, 0.89, 0.90))
    castle(c, 0.88, 0.44, 0.28, (0.80, 0.74, 0.68), (0.86, 0.88, 0.92))
    c.ridge(0.60, 0.10, 2.6, (0.86, 0.88, 0.92), 8, ((0.94, 0.93, 0.92), 0.3))
    for k in range(40):
        pine(c, rng.random() * 1.34, 0.64 + 0.04 * rng.random(), 0.07 + 0.05 * rng.random(),
             (0.26, 0.32, 0.36))
    ice, u, v = c.ellipse(0.60, 0.84, 0.52, 0.11)
    c.gradient([(0.73, (0.72, 0.78, 0.84)), (0.95, (0.52, 0.61, 0.70))], ice)
    for k in range(16):
        x, y = 0.60 + 0.42 * (rng.random() * 2 - 1), 0.79 + 0.10 * rng.random()
        h = 0.035 + 0.03 * (y - 0.75) / 0.15
        coat = [(0.50, 0.12, 0.10), (0.15, 0.17, 0.26), (0.30, 0.20, 0.12),
                (0.16, 0.22, 0.15)][k % 4]
        c.lay(coat, c.stroke([(x, y), (x + 0.006, y - h)], h * 0.28, h * 0.42))
        c.lay((0.78, 0.60, 0.48), c.ellipse(x + 0.007, y - h * 1.32, h * 0.14, h * 0.17)[0])
        c.lay((0.10, 0.08, 0.08), c.ellipse(x + 0.007, y - h * 1.46, h * 0.17, h * 0.08)[0])
        c.lay((0.42, 0.48, 0.56), c.ellipse(x + 0.02, y + 0.004, h * 0.5, h * 0.08)[0], 0.6)

    def branch(x, y, angle, length, width, depth):
        x1, y1 = x + np.cos(angle) * length, y - np.sin(angle) * length
        c.lay((0.16, 0.12, 0.11), c.stroke([(x, y), (x1, y1)], width, width * 0.65))
        c.lay((0.93, 0.94, 0.96), c.stroke([(x, y - width * 0.4), (x1, y1 - width * 0.3)],
                                           width * 0.35, width * 0.2), 0.8)
        if depth:
            for turn in (-0.55, 0.1, 0.5):
                branch(x1, y1, angle + turn + rng.normal(0, 0.15), length * 0.68, width * 0.58,
                       depth - 1)
    branch(0.12, 1.0, 1.5, 0.26, 0.036, 3)
    return oil(c.pixels, rng)


def sky():
    """What lies beyond the windows: hills under a summer sky. Emission: brightness matters, so the
    land is dim and the sky bright. Wraps around horizontally."""
    rng = generator('sky')
    c = Canvas(2048, 768, (0.7, 0.8, 0.95), rng)
    c.gradient([(0, (0.60, 0.77, 0.99)), (0.45, (0.76, 0.87, 0.99)), (0.72, (0.93, 0.955, 0.97)),
                (0.78, (0.97, 0.96, 0.92))])
    clouds(c, -0.2, 0.72, (1.0, 0.99, 0.97), (0.80, 0.85, 0.93), 0.5, (1.0, 0.5))
    far = None
    for base, height, colour, fade in ((0.775, 0.09, (0.66, 0.74, 0.80), (0.76, 0.81, 0.83)),
                                       (0.81, 0.08, (0.50, 0.60, 0.62), (0.62, 0.69, 0.66)),
                                       (0.855, 0.07, (0.37, 0.47, 0.38), (0.46, 0.55, 0.40))):
        _, line = c.ridge(base, height, 2.4, colour, 18, (fade, 0.06))
        far = line if far is None else np.minimum(far, line)
    mask, _ = c.ridge(0.90, 0.05, 2.4, (0.36, 0.45, 0.24), 12, ((0.42, 0.48, 0.24), 0.1))
    woods = smoothstep(0.50, 0.6, c.noise(1.6, 6, 120, (1.6, 1.0)))
    c.lay((0.22, 0.31, 0.16), mask * woods, 0.75)
    land = smoothstep(-0.002, 0.002, c.y - far)
    grey = c.pixels.mean(axis=-1, keepdims=True)
    c.pixels = mix(c.pixels, (c.pixels * 0.6 + grey * 0.4) * np.array([0.60, 0.61, 0.63]), land)
    for x, s in ((0.9, 0.075), (2.05, 0.09)):
        castle(c, x, 0.80, s, (0.80, 0.76, 0.70), (0.56, 0.42, 0.38))
    return c.pixels
