# SPDX-License-Identifier: Apache-2.0
"""The castle book's drawings, and the paintings of its scene in frames.

    python3 make_drawings.py FOLDER     writes the pictures
    python3 make_drawings.py --film FOLDER     writes the numbered pictures of the well's film
"""
import io
import json
import math
import os
import random
import struct
import sys

from PIL import Image

from bell import casting
from paper import GOLD, INK, RED, STONE, WATER, Sheet, castle_on, framed
from well import film, well

exhibit = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../../content/castle')


def plan():
    """Hall and courtyard from above, in the scene's own metres; the sunny side, where the windows
    are, is below."""
    sheet = Sheet(3)
    sheet.border()

    def at(x, z):                                  # metres of the scene to the sheet
        return 1130 - (x + 20) * 35.3, 480 - z * 42

    def rectangle(x0, z0, x1, z1, fill, width=3):
        sheet.area([at(x0, z0), at(x1, z0), at(x1, z1), at(x0, z1)], fill, INK, width)

    rectangle(-20, -7, -8.9, 7, (206, 200, 178))                            # courtyard
    rng = random.Random(2)
    for i in range(420):
        x, z = rng.uniform(-19.7, -9.2), rng.uniform(-6.7, 6.7)
        px, py = at(x, z)
        sheet.oval(px, py, 5, 4, None, (176, 166, 142), 1)
    rectangle(-9.1, -5.4, 8.9, 5.4, (132, 118, 100))                         # walls
    rectangle(-8, -4.5, 8, 4.5, (246, 238, 216))
    for i in range(20):                                                     # floor of two stones
        for k in range(11):
            if (i + k) % 2 == 0:
                x, z = -8 + i * 0.8, -4.4 + k * 0.8
                rectangle(x, z, x + 0.8, min(z + 0.8, 4.5), (228, 216, 186), 0)
    rectangle(-9.1, -1.1, -7.9, 1.1, (246, 238, 216), 0)                    # the arch
    for bay in (-6, -2, 2, 6):                                              # windows and vault
        rectangle(bay - 1, -5.4, bay + 1, -4.5, (176, 208, 226))
        for side in (-1, 1):
            sheet.line([at(bay - 2 * side, -4.5), at(bay + 2 * side, 4.5)], (196, 180, 148), 2)
    rectangle(-3.1, 4.05, -0.9, 5.0, (150, 84, 60))                          # fireplace
    for x, z, radius in ((-18.6, 4.6, 1.7), (-18.2, -6.4, 2.0)):            # towers
        px, py = at(x, z)
        sheet.oval(px, py, radius * 38, radius * 38, (132, 118, 100))
        sheet.oval(px, py, radius * 22, radius * 22, (206, 200, 178))
    px, py = at(-13.2, -0.55)
    sheet.oval(px, py, 40, 40, STONE)
    sheet.oval(px, py, 26, 26, WATER)
    for x, z, half_x, half_z in ((-1.4, -0.9, .36, .36), (4.0, -3.35, .3, .3), (0, -3.35, .3, .3),
                                 (-4.0, -3.35, .3, .3), (-4.9, -0.95, .75, .3),
                                 (4.9, 2.6, .45, .35), (-7.3, 1.95, .28, .28)):
        rectangle(x - half_x, z - half_z, x + half_x, z + half_z, (120, 142, 150), 2)
    px, py = at(-4.5, 2.1)
    sheet.oval(px, py, 34, 30, (168, 126, 70))
    for number, x, z in ((1, -1.4, 0.1), (2, 4.0, -2.4), (3, 0, -2.4), (4, -4.0, -2.4),
                         (5, -4.9, -0.1), (6, 4.9, 3.6), (7, -6.6, 2.7), (8, -3.3, 2.6),
                         (9, -2.0, 3.4), (10, -14.9, -1.3)):
        sheet.number(*at(x, z), number, RED, 19)
    x, y = 115, 150                                                        # a rose of the winds
    for k in range(8):
        long = 62 if k % 2 == 0 else 34
        for side in (-1, 1):
            a, b = k * math.pi / 4, k * math.pi / 4 + side * math.pi / 8
            sheet.area([(x, y), (x + long * math.sin(a), y - long * math.cos(a)),
                        (x + 15 * math.sin(b), y - 15 * math.cos(b))],
                       (250, 243, 222) if side < 0 else RED if k == 0 else INK, INK, 1)
    left, low = at(8, -6.3)                                                # ten metres
    for i in range(10):
        sheet.box(left + i * 35.3, low, left + (i + 1) * 35.3, low + 12,
                  INK if i % 2 else (250, 243, 222), INK, 2)
    for i in (0, 5, 10):
        sheet.words(left + i * 35.3, low + 36, f'{i} m', INK, 20)
    return sheet.finished()


def gem(sheet, x, y, r, colour):
    light = tuple(min(255, c + 90) for c in colour)
    dark = tuple(int(c * 0.55) for c in colour)
    ring = [(x + r * math.cos(a), y + r * math.sin(a))
            for a in (math.pi / 8 + k * math.pi / 4 for k in range(8))]
    table = [(x + 0.5 * (px - x), y + 0.5 * (py - y)) for px, py in ring]
    sheet.oval(x, y, r + 8, r + 8, (226, 184, 88), INK, 2)
    for k in range(8):
        facing = (1 + math.cos(k * math.pi / 4 + math.pi * 0.9)) / 2
        tone = tuple(int(d + (l - d) * facing) for d, l in zip(dark, light))
        sheet.area([ring[k], ring[(k + 1) % 8], table[(k + 1) % 8], table[k]], tone, dark, 1)
    sheet.area(table, colour, dark, 1)
    sheet.area([table[5], table[6], (x - r * .1, y - r * .1)], (255, 255, 255), None, 0)


def crown():
    sheet = Sheet(5)
    sheet.border()
    middle, low = 640, 640
    sheet.shade([(300, 660), (980, 660), (1040, 720), (240, 720)], (80, 60, 40), 0.5, 22)

    def rim(x):                                    # the band is a ring seen from a little above
        return 46 * math.sqrt(max(0, 1 - ((x - middle) / 360) ** 2))

    for part in range(72):                         # the band in strips: bright where it faces us
        x0, x1 = middle - 360 + part * 10, middle - 350 + part * 10
        facing = 1 - abs((x0 + x1) / 2 - middle + 90) / 470
        tone = tuple(int(c * (0.62 + 0.42 * facing)) for c in (232, 184, 82))
        sheet.area([(x0, low + rim(x0) - 130), (x1, low + rim(x1) - 130), (x1, low + rim(x1)),
                    (x0, low + rim(x0))], tone, None, 0)
    for lift in (0, 14, 116, 130):
        sheet.line([(middle - 360 + i * 10, low + rim(middle - 360 + i * 10) - lift)
                    for i in range(73)], INK if lift in (0, 130) else (140, 96, 30), 3)
    for x in (-360, 360):
        sheet.line([(middle + x, low), (middle + x, low - 130)], INK, 3)
    for k, x in enumerate((-318, -168, 0, 168, 318)):                       # lilies
        x, base = middle + x, low + rim(middle + x) - 130
        tall = 210 if k % 2 == 0 else 150
        wide = tall * 0.30 * (1 if abs(x - middle) < 250 else 0.7)
        gold, shade = (236, 192, 96), (196, 144, 54)
        side = [(0, 0), (.35, .25), (1, .42), (1.12, .62), (.82, .72), (.6, .55), (.3, .5)]
        leaf = [(0, 0.05), (.34, .45), (.42, .7), (0, 1), (-.42, .7), (-.34, .45)]
        for sign in (-1, 1):
            sheet.area([(x + sign * wide * a, base - tall * b) for a, b in side],
                       shade if sign > 0 else gold)
        sheet.area([(x + wide * a, base - tall * b) for a, b in leaf], gold)
        sheet.line([(x, base - tall * .12), (x, base - tall * .86)], (140, 96, 30), 2)
        sheet.box(x - wide * .5, base - tall * .36, x + wide * .5, base - tall * .27, shade)
        sheet.oval(x, base - tall - 10, 12, 12, (246, 240, 226))
    red, blue, green, glass = (176, 24, 44), (36, 66, 168), (24, 122, 72), (206, 226, 232)
    for k, colour in enumerate((red, blue, green, glass, red, blue, green)):
        x = middle + (-285, -200, -102, 0, 102, 200, 285)[k]
        gem(sheet, x, low + rim(x) - 65, 36 if k != 3 else 44, colour)
    gem(sheet, middle, low + rim(middle) - 130 - 116, 20, red)
    return sheet.finished()


def day():
    """The hours of a day in the castle as a wheel: dark, light, and what is done."""
    sheet = Sheet(60)
    sheet.border()
    x, y, radius = 640, 480, 390
    for hour in range(96):
        a, b = (math.radians(hour * 3.75 + 90 + e) for e in (0, 4.1))
        height = -math.cos((hour / 4) * math.pi / 12)                       # of the sun, roughly
        t = min(1, max(0, height * 1.4 + 0.45))
        tone = tuple(int(n + (d - n) * t) for n, d in zip((38, 46, 84), (168, 206, 228)))
        if 0.12 < t < 0.75:
            tone = tuple(int(c * .6 + w * .4) for c, w in zip(tone, (236, 156, 90)))
        sheet.area([(x, y), (x + radius * math.cos(a), y + radius * math.sin(a)),
                    (x + radius * math.cos(b), y + radius * math.sin(b))], tone, None, 0)
    sheet.oval(x, y, radius, radius, None, INK, 5)
    sheet.oval(x, y, 262, 262, (244, 232, 204), INK, 4)
    for hour in range(24):
        a = math.radians(hour * 15 + 90)
        sheet.line([(x + 262 * math.cos(a), y + 262 * math.sin(a)),
                    (x + 274 * math.cos(a), y + 274 * math.sin(a))], INK, 3)
        light = 6 <= hour <= 18
        sheet.words(x + 292 * math.cos(a), y + 292 * math.sin(a), hour,
                    INK if light else (236, 226, 200), 17)
    for k in range(12):                                                     # the sun at noon
        a = k * math.pi / 6
        sheet.line([(x, y - 346), (x + 46 * math.cos(a), y - 346 + 46 * math.sin(a))], GOLD, 5)
    sheet.oval(x, y - 346, 28, 28, (244, 204, 84), INK, 2)
    sheet.oval(x, y + 346, 27, 27, (238, 232, 206), INK, 2)                 # the moon
    sheet.oval(x + 14, y + 340, 23, 24, (40, 48, 84), None, 0)
    rng = random.Random(3)
    for i in range(26):
        a, r = math.radians(rng.uniform(35, 145)), rng.uniform(312, 380)
        if abs(a - math.pi / 2) > .15:
            sheet.oval(x + r * math.cos(a), y + r * math.sin(a), 2.5, 2.5, (250, 244, 214), None, 0)
    for number, hour in ((1, 5), (2, 7), (3, 10.5), (4, 13), (5, 17.5), (6, 20.5)):
        a = math.radians(hour * 15 + 90)
        px, py = x + 196 * math.cos(a), y + 196 * math.sin(a)
        sheet.line([(px, py), (x + 260 * math.cos(a), y + 260 * math.sin(a))], RED, 3)
        sheet.number(px, py, number)
    castle_on(sheet, x - 8, y + 66, .42)
    castle_on(sheet, x - 79, y + 66, .42, .5)
    sheet.line([(x - 130, y + 68), (x + 130, y + 68)], (122, 138, 84), 8)
    return sheet.finished()


def paintings():
    """The pictures that hang in the hall, out of the scene's file."""
    with open(os.path.join(exhibit, 'scene.glb'), 'rb') as file:
        data = file.read()
    length = struct.unpack('<I', data[12:16])[0]
    document, start = json.loads(data[20:20 + length]), 20 + length + 8
    found = {}
    for image in document['images']:
        view = document['bufferViews'][image['bufferView']]
        begin = start + view.get('byteOffset', 0)
        found[image['name']] = Image.open(io.BytesIO(data[begin:begin + view['byteLength']]))
    return found


def save(folder, name, picture):
    picture.convert('RGB').save(os.path.join(folder, name + '.jpg'), quality=90, optimize=True)
    print(name, flush=True)


def main():
    folder = sys.argv[-1]
    os.makedirs(folder, exist_ok=True)
    if '--film' in sys.argv:
        return film(folder)
    scene = paintings()
    for name, source in (('castle', 'picture_castle'), ('winter', 'picture_winter'),
                         ('river', 'picture_river'), ('lady', 'picture_lady'),
                         ('arms', 'picture_arms'), ('chronicle', 'book_page')):
        save(folder, name, framed(scene[source]))
    save(folder, 'plan', plan())
    save(folder, 'crown', crown())
    save(folder, 'day', day())
    for stage, name in enumerate(('core', 'mould', 'pour', 'free', 'parts')):
        save(folder, 'bell_' + name, casting(stage + 1))
    for name, sheet in (('well_dry', well(12, mason=12, house=False, hammer=1.0)),
                        ('well_falcon', well(60, falcon=-1, mason=60, house=False)),
                        ('well_song', well(70, falcon=52, mason=70, house=False)),
                        ('well_water', well(70, water=66, house=False)),
                        ('well_today', well(70, water=24, voices=1))):
        save(folder, name, sheet.finished())


if __name__ == '__main__':
    main()
