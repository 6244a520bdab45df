# SPDX-License-Identifier: Apache-2.0
"""How a bell is cast, step by step, and what its parts are."""
import math
import random

from paper import INK, RED, Sheet

EARTH = (150, 120, 84)

# The rib: half the bell's section as (radius, height), outer side from lip to crown, and inner.
OUTER = [(1.0, 0), (.985, .06), (.93, .16), (.85, .27), (.76, .42), (.69, .6), (.64, .8), (.6, 1.0),
         (.585, 1.18), (.57, 1.3), (.5, 1.38), (.36, 1.42), (0, 1.43)]
INNER = [(.93, 0), (.855, .1), (.79, .2), (.74, .32), (.68, .47), (.62, .64), (.575, .82),
         (.54, 1.0), (.525, 1.18), (.5, 1.27), (.4, 1.32), (0, 1.33)]


def profile(points, x, y, size, sign=1):
    return [(x + sign * r * size, y - h * size) for r, h in points]


def whole(points, x, y, size):
    return profile(points, x, y, size, -1) + profile(points, x, y, size)[::-1]


def bell(sheet, x, y, size, clapper=True, colour=(176, 128, 62)):
    """A finished bell from outside, with its crown."""
    for k in (-.2, 0, .2):
        sheet.oval(x + k * size, y - 1.56 * size, .11 * size, .17 * size, None, INK, size * .035)
        sheet.oval(x + k * size, y - 1.56 * size, .11 * size, .17 * size, None, colour, size * .02)
    if clapper:
        sheet.oval(x, y + 0.02 * size, .12 * size, .14 * size, (90, 84, 78))
    steps = 60
    for i in range(steps):                         # strips around, bright a little left
        a, b = -1 + 2 * i / steps, -1 + 2 * (i + 1) / steps + 0.01
        shine = math.exp(-((a + 0.35) / 0.28) ** 2) * 0.55 + 0.72 - 0.3 * a * a
        tone = tuple(min(255, int(c * shine)) for c in colour)
        sheet.area([(x + a * r * size, y - h * size) for r, h in OUTER[:-1]]
                   + [(x + b * r * size, y - h * size) for r, h in OUTER[:-1]][::-1], tone, None, 0)
    sheet.line(whole(OUTER, x, y, size) + [(x - size, y)], INK, 4)
    for h, r in ((.2, .905), (.26, .86), (1.08, .6), (1.2, .588)):
        sheet.line([(x - r * size, y - h * size), (x + r * size, y - h * size)], INK, 2)


def pit(sheet, ground):
    sheet.area([(41, ground), (1239, ground), (1239, 919), (41, 919)], EARTH, None, 0)
    rng = random.Random(4)
    for i in range(260):
        x, y = rng.uniform(60, 1220), rng.uniform(ground + 20, 905)
        sheet.oval(x, y, rng.uniform(2, 7), rng.uniform(2, 4), None, (124, 96, 66), 1.5)
    sheet.line([(41, ground), (1239, ground)], INK, 4)


def flames(sheet, x, y, size):
    for dx, tall, wide, colour in ((-.5, .8, .34, (204, 70, 30)), (.45, .9, .34, (204, 70, 30)),
                                   (0, 1.2, .42, (222, 104, 34)), (0, .7, .24, (248, 196, 80))):
        points = []
        for side in (-1, 1):
            edge = [(dx + side * wide * math.sin(math.pi * t) * (1 - t * .45)
                     + .06 * math.sin(t * 7 + dx * 5), tall * t)
                    for t in (i / 14 for i in range(15))]
            points += edge if side < 0 else edge[::-1]
        sheet.area([(x + a * size, y - b * size) for a, b in points], colour, None, 0)


def casting(stage):
    """1 core, 2 false bell and cope, 3 pouring, 4 the mould is broken, 5 the bell's parts."""
    sheet = Sheet(20 + stage)
    x, y, size, ground = 640, 800, 340, 250
    if stage in (1, 2):
        sheet.area([(41, y), (1239, y), (1239, 919), (41, 919)], EARTH, None, 0)
        sheet.line([(41, y), (1239, y)], INK, 4)
    if stage == 1:
        core = whole(INNER, x, y, size)
        sheet.area(core, (184, 120, 84))
        for row in range(11):                                               # bricks of the core
            h = (row + 1) * .115
            reach = max(0.05, next((r for r, hh in INNER if hh >= h), 0.05)) - .05
            sheet.line([(x - reach * size, y - h * size), (x + reach * size, y - h * size)],
                       (130, 76, 52), 2)
            for k in range(-5, 6):
                px = x + (k + row % 2 * .5) * .17 * size
                if abs(px - x) < (reach - .03) * size:
                    sheet.line([(px, y - h * size), (px, y - (h - .115) * size)], (130, 76, 52), 2)
        sheet.line(core, (120, 90, 60), 14)                                 # clay over them
        sheet.line([(x, y + 60), (x, 150)], (96, 70, 44), 12)               # the board on its pole
        board = profile(INNER, x + 14, y, size) + [(x + 1.16 * size, y - 1.33 * size),
                                                   (x + 1.16 * size, y)]
        sheet.area(board, (198, 158, 100))
        for k in range(4):
            sheet.line([(x + (1.13 - .05 * k) * size, y - 20), (x + (1.13 - .05 * k) * size,
                                                                y - 1.3 * size)], (160, 120, 70), 2)
        for px in (x + .3 * size, x + 1.08 * size):
            sheet.line([(px, 190), (px, y - 1.3 * size)], (120, 84, 50), 12)
        sheet.box(x - 20, 170, x + 1.16 * size, 200, (150, 108, 60))
        for k, (px, py) in enumerate(((x - 160, y - 150), (x + 345, y - 300), (x - 60, 160))):
            sheet.number(px, py, k + 1)
        sweep = [(x + 330 * math.cos(a), 245 + 26 * math.sin(a))
                 for a in (math.radians(d) for d in range(195, 345, 6))]
        sheet.line(sweep, RED, 4)
        sheet.area([(x - 345, 262), (x - 300, 246), (x - 312, 224)], RED, None, 0)
    if stage == 2:
        cope = [(1.2, 0), (1.16, .3), (1.02, .62), (.92, 1.0), (.86, 1.34), (.66, 1.6), (.28, 1.66),
                (0, 1.66)]
        sheet.area(whole(cope, x, y, size), (190, 150, 104))
        sheet.area(whole(OUTER, x, y, size), (226, 200, 140))
        sheet.area(whole(INNER, x, y, size), (184, 120, 84))
        for h in (.35, .75, 1.15, 1.5):                                     # iron hoops
            r = next(r for r, hh in cope if hh >= h) + .02
            sheet.line([(x - r * size, y - h * size), (x + r * size, y - h * size)],
                       (70, 66, 62), 9)
        sheet.area(whole(OUTER, x, y, size), (226, 200, 140))
        sheet.area(whole(INNER, x, y, size), (184, 120, 84))
        flames(sheet, x, y, 190)
        for k, (px, py) in enumerate(((x - 130, y - 330), (x + 228, y - 250), (x + 345, y - 130))):
            sheet.number(px, py, k + 1)
    if stage == 3:
        sheet.shade([(-99, -99), (1379, -99), (1379, 330), (-99, 330)], (40, 44, 70), 0.85, 40, 40)
        pit(sheet, ground)
        sheet.area([(x - 430, ground), (x + 430, ground), (x + 400, 890), (x - 400, 890)],
                   (112, 88, 60))
        px, py, s = x, 850, 300
        cope = [(1.2, 0), (1.16, .3), (1.02, .62), (.92, 1.0), (.86, 1.34), (.66, 1.6), (.12, 1.66)]
        sheet.area(whole(cope, px, py, s), (170, 128, 88))
        sheet.area(whole(OUTER, px, py, s), (250, 176, 66))
        sheet.area(whole(INNER, px, py, s), (150, 92, 62))
        for side in (-1, 1):
            sheet.line([(px + side * .06 * s, py - 1.66 * s), (px + side * .06 * s, py - 1.42 * s)],
                       INK, 3)
        sheet.box(px - .055 * s, py - 1.66 * s, px + .055 * s, py - 1.41 * s,
                  (255, 200, 90), None, 0)
        sheet.area([(x + 170, ground - 6), (x + 520, ground - 6), (x + 500, 120), (x + 190, 120)],
                   (150, 92, 70))                                           # the furnace
        for row in range(5):
            sheet.line([(x + 175 + row * 4, ground - 24 - row * 22),
                        (x + 515 - row * 4, ground - 24 - row * 22)], (110, 62, 46), 2)
        sheet.area([(x + 290, ground - 6), (x + 290, 200), (x + 320, 176), (x + 370, 176),
                    (x + 400, 200), (x + 400, ground - 6)], (60, 30, 20))
        flames(sheet, x + 345, ground - 8, 62)
        channel = [(x + 200, 226), (x + 60, 262), (x, 300), (x, py - 1.6 * s)]
        sheet.line(channel, (90, 50, 30), 30)
        sheet.line(channel, (255, 188, 76), 16)
        sheet.shade([(x - 60, 230), (x + 230, 200), (x + 60, 400), (x - 60, 400)], (255, 190, 90),
                    0.55, 40)
        for i, (sx, sy) in enumerate(((180, 110), (300, 160), (420, 90), (520, 190), (1130, 90),
                                      (100, 190))):
            sheet.oval(sx, sy, 3, 3, (250, 240, 200), None, 0)
        for k, (nx, ny) in enumerate(((x + 445, 176), (x + 110, 300), (px + 196, py - 180))):
            sheet.number(nx, ny, k + 1)
    if stage == 4:
        pit(sheet, 760)
        bell(sheet, x, 770, 300, clapper=False)
        rng = random.Random(9)
        for side in (-1, 1):                                                # halves of the cope
            left = x + side * 420
            sheet.area([(left - 70 * side, 780), (left + 110 * side, 780), (left + 130 * side, 560),
                        (left + 70 * side, 470), (left + 20 * side, 540), (left - 20 * side, 640)],
                       (178, 138, 96))
            for i in range(9):
                cx, cy = left + rng.uniform(-150, 150), rng.uniform(785, 860)
                r = rng.uniform(12, 34)
                sheet.area([(cx + r * math.cos(a), cy + .6 * r * math.sin(a)) for a in
                            sorted(rng.uniform(0, 6.28) for _ in range(6))], (178, 138, 96))
        sheet.line([(860, 330), (1010, 200)], (150, 104, 56), 16)           # the hammer
        sheet.area([(810, 330), (868, 278), (910, 326), (852, 378)], (96, 92, 90))
    if stage == 5:
        bell(sheet, 335, 720, 250)
        bx, by, s = 905, 720, 250
        sheet.area(whole(OUTER, bx, by, s), (200, 150, 78))
        sheet.area(whole(INNER, bx, by, s), (240, 226, 194))
        sheet.line([(bx, by - 1.33 * s), (bx, by - .12 * s)], (90, 84, 78), 12)
        sheet.oval(bx, by - .02 * s, .12 * s, .14 * s, (120, 112, 104))
        for k in (-.2, 0, .2):
            sheet.oval(bx + k * s, by - 1.56 * s, .11 * s, .17 * s, None, INK, s * .035)
        for number, nx, ny, tx, ty in ((1, 1160, 250, bx + .24 * s, by - 1.56 * s),
                                       (2, 1160, 400, bx + .56 * s, by - 1.16 * s),
                                       (3, 1195, 560, bx + .72 * s, by - .5 * s),
                                       (4, 1195, 760, bx + .97 * s, by - .05 * s),
                                       (5, 900, 850, bx, by + .1 * s)):
            sheet.line([(nx, ny), (tx, ty)], RED, 2.5)
            sheet.number(nx, ny, number)
    sheet.border()
    return sheet.finished()
