# SPDX-License-Identifier: Apache-2.0
"""The castle's hill cut through: the well as it was dug, and a film of that."""
import math
import os
import random

from paper import BLUE, GOLD, INK, RED, STONE, WATER, Sheet, castle_on

GRASS = (122, 138, 84)

def bird(sheet, x, y, size, wings):
    """A falcon: `wings` 1 sits, 0 is folded in a dive."""
    if wings:
        sheet.area([(x, y), (x - .5 * size, y - .1 * size), (x - .9 * size, y + .75 * size),
                    (x - .55 * size, y + .6 * size), (x - .25 * size, y + .7 * size),
                    (x + .12 * size, y + .4 * size)], (104, 78, 58))
        sheet.oval(x - .02 * size, y - .12 * size, .2 * size, .19 * size, (128, 98, 72))
        sheet.area([(x + .15 * size, y - .14 * size), (x + .3 * size, y - .04 * size),
                    (x + .12 * size, y - .02 * size)], GOLD, INK, 2)
        sheet.oval(x + .05 * size, y - .16 * size, .04 * size, .04 * size, INK, None, 0)
    else:
        sheet.area([(x, y + .8 * size), (x - .3 * size, y), (x - .18 * size, y - .8 * size), (x, y),
                    (x + .18 * size, y - .8 * size), (x + .3 * size, y)], (214, 172, 124))


def person(sheet, x, y, size, colour, hammer=None):
    sheet.line([(x - .12 * size, y), (x, y - .45 * size), (x + .12 * size, y)], INK, .09 * size)
    sheet.area([(x - .18 * size, y - .4 * size), (x + .18 * size, y - .4 * size),
                (x + .13 * size, y - .85 * size), (x - .13 * size, y - .85 * size)], colour, INK, 2)
    sheet.oval(x, y - .98 * size, .12 * size, .13 * size, (224, 184, 148), INK, 2)
    if hammer is not None:
        hx, hy = x + .5 * size * math.cos(hammer), y - .65 * size - .5 * size * math.sin(hammer)
        sheet.line([(x, y - .7 * size), (hx, hy)], INK, .06 * size)
        sheet.oval(hx, hy, .1 * size, .1 * size, (110, 106, 104), INK, 2)


def well(deep, water=0.0, falcon=None, mason=None, house=True, scale=True, hammer=None, voices=0.0):
    """The hill cut through. `deep`: metres of the shaft, `water`: metres of water in it; `falcon`:
    its depth, -1 on the edge; `mason`: his depth."""
    sheet = Sheet(40)
    top, per_metre, middle, half = 250, 8.6, 560, 34

    def at(depth):
        return top + depth * per_metre

    sheet.shade([(41, 41), (1239, 41), (1239, 300), (41, 300)], (150, 190, 214), 0.75, 60)
    hill = [(41, 620), (110, 560), (210, 420), (290, 300), (370, top), (960, top), (1030, 310),
            (1100, 430), (1170, 540), (1239, 630), (1239, 919), (41, 919)]
    sheet.area(hill, (196, 172, 132))
    layers = ((330, (178, 160, 128)), (450, (166, 150, 124)), (580, (180, 164, 140)),
              (700, (152, 140, 120)), (820, (138, 130, 116)))

    def surface(x):
        for (x0, y0), (x1, y1) in zip(hill, hill[1:]):
            if x0 <= x <= x1:
                return y0 + (y1 - y0) * (x - x0) / max(x1 - x0, 1e-9)
        return 919

    xs = [41 + 1198 * i / 120 for i in range(121)]
    for depth, colour in layers:
        edge = [(x, max(surface(x) + 4, depth + 14 * math.sin(x * .011 + depth))) for x in xs]
        sheet.area(edge + [(1239, 919), (41, 919)], colour, None, 0)
        sheet.line([p for p in edge if p[1] > surface(p[0]) + 8] or edge[:2], (128, 112, 88), 2)
    rng = random.Random(6)
    for i in range(230):
        x, y = rng.uniform(60, 1220), rng.uniform(300, 900)
        if y > surface(x) + 24 and abs(x - middle) > half + 14:
            w = rng.uniform(5, 18)
            sheet.line([(x - w, y), (x + w, y + rng.uniform(-3, 3))], (126, 110, 88), 2)
    sheet.line(hill[:-2], INK, 4)
    sheet.line([(p[0], p[1] - 6) for p in hill[1:-3]], GRASS, 8)
    spring = [(1239, 800), (1060, 812), (880, 836), (740, 846), (middle + half + 12, at(70) - 4)]
    sheet.line(spring, (70, 96, 116), 26)                                   # the spring in the rock
    sheet.line(spring, WATER, 18)
    if house:
        castle_on(sheet, 640, top, .98)
    else:
        castle_on(sheet, 650, top, .7, .5)
    sheet.box(middle - half, top - 4, middle + half, at(deep), (58, 50, 44), None, 0)
    for side in (-1, 1):                                                    # the shaft's lining
        x = middle + side * (half + 6)
        sheet.line([(x, top), (x, at(deep))], STONE, 12)
        for k in range(int(deep / 2.2)):
            sheet.line([(x - 6, at(k * 2.2)), (x + 6, at(k * 2.2))], INK, 1.5)
    if water > 0:
        sheet.box(middle - half, at(deep - water), middle + half, at(deep), WATER, None, 0)
        sheet.line([(middle + half - 4, at(70) - 4), (middle + half + 30, at(70) - 6)], WATER, 18)
        for k in range(int(water / 5) + 1):
            y = at(deep - water + 1 + k * 5)
            if y < at(deep) - 6:
                sheet.line([(middle - 22 + 3 * i, y + 3 * math.sin(i * .9 + k)) for i in range(15)],
                           (196, 222, 236), 2)
    sheet.box(middle - half - 16, top - 34, middle - half, top, STONE)       # the well-head
    sheet.box(middle + half, top - 34, middle + half + 16, top, STONE)
    if house:
        for side in (-1, 1):
            sheet.line([(middle + side * 44, top - 30), (middle + side * 44, top - 96)],
                       (110, 78, 48), 9)
        sheet.line([(middle - 50, top - 78), (middle + 62, top - 78)], (110, 78, 48), 12)
        sheet.area([(middle - 68, top - 94), (middle + 68, top - 94), (middle, top - 140)],
                   (120, 84, 60))
        sheet.line([(middle + 4, top - 74), (middle + 4, min(at(deep - water), top + 60))],
                   (214, 190, 140), 3)
        sheet.area([(middle - 12, top + 60), (middle + 20, top + 60), (middle + 16, top + 92),
                    (middle - 8, top + 92)], (140, 98, 58))
    if scale:
        x = middle - 130
        sheet.line([(x, top), (x, at(70))], RED, 3)
        for metres in range(0, 71, 10):
            sheet.line([(x - 10, at(metres)), (x, at(metres))], RED, 3)
            if metres:
                sheet.words(x - 18, at(metres), f'{metres} m', RED, 20, 'rm')
    if mason is not None:
        person(sheet, middle - 4, at(mason) - 2, 54, (150, 62, 48), hammer)
    if falcon is not None:
        if falcon < 0:
            bird(sheet, middle + half + 8, top - 74, 56, 1)
        else:
            bird(sheet, middle, at(falcon), 44, 0)
    for k in range(3):                                                      # voices as rings
        if voices > k * .3:
            radius = 26 + 24 * k
            arc = [(middle + radius * math.cos(a), top - 150 + radius * .8 * math.sin(a) + 40)
                   for a in (math.radians(d) for d in range(200, 341, 7))]
            sheet.line(arc, BLUE, 4)
    sheet.border()
    return sheet


def film(folder, fps=12, seconds=14):
    """Three summers of digging, the falcon, the spring, and the well as it is."""
    for i in range(fps * seconds):
        t = i / fps
        if t < 5:                                  # digging
            deep = 3 + 64 * (t / 5)
            sheet = well(deep, mason=deep, house=False, hammer=.4 + abs(math.sin(t * 5)) * 1.2)
        elif t < 6.5:
            sheet = well(67, mason=67, falcon=-1, house=False)
        elif t < 8:
            fall = ((t - 6.5) / 1.5) ** 2
            sheet = well(67 + 3 * fall, mason=67 + 3 * fall, falcon=fall * 62, house=False)
        elif t < 10.5:
            up = (t - 8) / 2.5
            rise = 68 * up * up * (3 - 2 * up)
            sheet = well(70, water=max(1, rise), mason=max(3, 70 - rise), house=False)
        else:
            sink = min(1, (t - 10.5) / 1.5)
            sheet = well(70, water=68 - 44 * sink, voices=max(0, t - 12) * .5)
        sheet.finished((960, 720)).save(os.path.join(folder, f'{i:04}.png'), compress_level=1)
