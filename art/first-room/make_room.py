# SPDX-License-Identifier: Apache-2.0
"""Makes the potter's room:

    blender -b --factory-startup --python art/first-room/make_room.py -- OUT.glb

It is put together of boxes and turned profiles (shapes.py) and computed pictures (pictures.py).
Lengths are metres. Blender's (x, y, z) becomes (x, z, -y) in the file: the window is in the west
(-x), the shelf in the north. Needs Blender 3.4 or newer with numpy in its Python (Debian: blender,
python3-numpy).
"""
import math
import os
import sys
import tempfile

import bpy
from mathutils import Vector

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import pictures  # noqa: E402
from shapes import animate, box, empty, joined, lay, light, material, pot, rounded  # noqa: E402
from shapes import sheet, store, thing, tube, turned  # noqa: E402


# The room: 6 m from west to east, 5 m from south to north, 2.75 m high

WEST, EAST, SOUTH, NORTH, HIGH = -3.0, 3.0, -2.5, 2.5, 2.75
HEIGHTS, THICK = (0.92, 2.3), 0.36       # of the windows, and their walls' thickness
WEST_WINDOW, SOUTH_WINDOW = (-0.75, 1.15), (-1.5, 0.0)
DOOR = (-2.05, -1.15)                    # y of the door in the east wall


def make_materials():
    for tone in ('celadon', 'tenmoku', 'cobalt', 'honey', 'oatmeal', 'copper red', 'turquoise'):
        material(tone, picture=tone, roughness=0.18)
    material('faience', picture='faience', roughness=0.16)
    material('bare clay', picture='bare clay', roughness=0.85)
    material('wet clay', (0.20, 0.135, 0.095), 0.32)
    material('plaster', picture='plaster', bumps='plaster relief', roughness=0.9)
    material('floor light', picture='floor light', roughness=0.42)
    material('floor dark', picture='floor dark', roughness=0.42)
    material('oak', picture='oak', roughness=0.5)
    material('walnut', picture='walnut', roughness=0.35)
    material('sage', (0.27, 0.35, 0.28), 0.55)
    material('white paint', (0.78, 0.75, 0.68), 0.5)
    material('iron', (0.06, 0.06, 0.06), 0.45, 0.8)
    material('brass', (0.80, 0.56, 0.24), 0.25, 1.0)
    material('gold', (1.0, 0.72, 0.30), 0.18, 1.0)
    material('enamel', (0.03, 0.085, 0.06), 0.2)
    material('velvet', (0.11, 0.016, 0.028), 0.9)
    material('linen', (0.66, 0.60, 0.48), 0.9)
    material('bristle', (0.33, 0.22, 0.12), 0.8)
    material('painting', picture='painting', roughness=0.5)
    material('dial', picture='dial', roughness=0.4)
    material('rug', picture='rug', roughness=0.95)
    material('glass', (1, 1, 1), 0.0, is_pane=True)
    material('sky', (1, 1, 1), 0.0, picture='view', glow=8, is_pane=True)
    material('bulb', (1.0, 0.80, 0.55), glow=14)


def wall(name, low, high, opening, axis):
    """A wall along an axis (0: x, 1: y), round an opening of that axis and the heights."""
    (start, end), (sill, lintel) = opening, HEIGHTS

    def blocks():
        for a, b, c, d in ((low[axis], start, 0, HIGH), (end, high[axis], 0, HIGH),
                           (start, end, 0, sill), (start, end, lintel, HIGH)):
            one, other = [*low[:2], c], [*high[:2], d]
            one[axis], other[axis] = a, b
            box('block', one, other, 'plaster', 2, 0)
    joined(name, blocks)


def make_walls():
    wall('West Wall', (WEST - THICK, SOUTH - THICK), (WEST, NORTH + 0.2), WEST_WINDOW, 1)
    wall('South Wall', (WEST, SOUTH - THICK), (EAST, SOUTH), SOUTH_WINDOW, 0)
    box('North Wall', (WEST, NORTH, 0), (EAST, NORTH + 0.2, HIGH), 'plaster', 2, 0)
    box('East Wall', (EAST, SOUTH - THICK, 0), (EAST + 0.2, NORTH + 0.2, HIGH), 'plaster', 2, 0)
    box('Ceiling', (WEST - THICK, SOUTH - THICK, HIGH), (EAST + 0.2, NORTH + 0.2, HIGH + 0.2),
        'plaster', 2, 0)

    def beams():
        for x in (-2.25, -0.75, 0.75, 2.25):
            box('beam', (x - 0.08, SOUTH, HIGH - 0.17), (x + 0.08, NORTH, HIGH), 'oak', 1.3, 0.012)
    joined('Beams', beams)

    def planks(tone):
        y, n = SOUTH, 0
        while y < NORTH - 0.01:
            wide = min((0.16, 0.19, 0.22)[n % 3], NORTH - y)
            x, lengths = WEST, [1.1 + 1.3 * ((n * 0.618) % 1), 2.2, 2.6, 6.0]
            for k, length in enumerate(lengths):
                end = min(x + length, EAST)
                if (n * 7 + k * 3) % 5 < 2 if tone == 'floor dark' else (n * 7 + k * 3) % 5 >= 2:
                    box('plank', (x + 0.001, y + 0.001, -0.03),
                        (end - 0.001, y + wide - 0.001, 0), tone, 1.4, 0.0025)
                x = end
                if x >= EAST:
                    break
            y, n = y + wide, n + 1
    joined('Floor', lambda: [planks(tone) for tone in ('floor light', 'floor dark')])

    def panelling():
        high, deep = 0.86, 0.022
        for along, low, end in (('x', WEST, EAST), ('y', SOUTH, NORTH), ('y', SOUTH, NORTH),
                                ('x', WEST, EAST)):
            side = panelling.side = (panelling.side + 1) % 4
            count = round((end - low) / 0.125)
            for n in range(count):
                a, b = (low + (end - low) * (n + i) / count for i in (0, 1))
                if side == 1 and a < DOOR[1] + 0.08 and b > DOOR[0] - 0.08:
                    continue
                put = [((a, NORTH - deep), (b, NORTH)), ((EAST - deep, a), (EAST, b)),
                       ((WEST, a), (WEST + deep, b)), ((a, SOUTH), (b, SOUTH + deep))][side]
                box('board', (*put[0], 0), (*put[1], high), 'sage', 1, 0.005)
                rail = [((a, NORTH - 0.045), (b, NORTH)), ((EAST - 0.045, a), (EAST, b)),
                        ((WEST, a), (WEST + 0.045, b)), ((a, SOUTH), (b, SOUTH + 0.045))][side]
                box('rail', (*rail[0], high), (*rail[1], high + 0.03), 'sage', 1, 0)
    panelling.side = -1
    joined('Panelling', panelling)


def make_window(name, ends, axis, face, out):
    """In a wall along an axis whose inner face lies at `face`; `out` is the way outside."""
    (start, end), (sill, lintel) = ends, HEIGHTS

    def put(what, a, c, b, d, inner, outer, paint):
        one, other = [a, a, c], [b, b, d]
        one[1 - axis], other[1 - axis] = sorted((face + out * inner, face + out * outer))
        box(what, one, other, paint, 1, 0.006)

    def frame():
        middle = (start + end) / 2
        for at, wide in ((start + 0.03, 0.06), (middle, 0.07), (end - 0.03, 0.06)):
            put('post', at - wide / 2, sill, at + wide / 2, lintel, 0.25, 0.31, 'white paint')
        for z, wide in ((sill + 0.03, 0.06), (lintel - 0.03, 0.06), (1.38, 0.03), (1.84, 0.03)):
            put('bar', start, z - wide / 2, end, z + wide / 2, 0.255, 0.305, 'white paint')
        for at in ((start + middle) / 2, (middle + end) / 2):
            put('bar', at - 0.013, sill, at + 0.013, lintel, 0.26, 0.30, 'white paint')
        put('sill', start, sill, end, sill + 0.035, -0.07, 0.25, 'oak')
    joined(name, frame)
    corners = [[a, a, z] for a, z in ((start, sill), (end, sill), (end, lintel), (start, lintel))]
    for corner in corners:
        corner[1 - axis] = face + out * 0.34
    sheet(name + ' Sky', corners if axis else corners[1::-1] + corners[:1:-1], 'sky')


def make_door():
    south, north = DOOR

    def leaf():
        count = 5
        for n in range(count):
            a, b = (south + (north - south) * (n + i) / count for i in (0, 1))
            box('plank', (EAST - 0.05, a + 0.001, 0.01), (EAST - 0.005, b - 0.001, 2.02), 'oak', 1)
        for z in (0.35, 1.62):
            box('strap', (EAST - 0.062, south + 0.02, z - 0.03), (EAST - 0.049, north - 0.10,
                                                                 z + 0.03), 'iron')
            for n in range(6):
                nail = turned('nail', [(0.012, 0), (0.009, 0.008), (0.001, 0.011)], 'iron', sides=8)
                lay(nail, (EAST - 0.062, south + 0.08 + 0.13 * n, z), 'Y', -90)
        ring = [(EAST - 0.075, north - 0.09 + 0.045 * math.sin(t / 12 * math.tau),
                 1.0 + 0.045 * math.cos(t / 12 * math.tau)) for t in range(13)]
        tube('ring', ring, 0.006, 'iron')
        box('plate', (EAST - 0.06, north - 0.12, 0.98), (EAST - 0.049, north - 0.06, 1.12), 'iron')
    joined('Door', leaf)

    def frame():
        for low, high in (((south - 0.08, 0), (south, 2.11)), ((north, 0), (north + 0.08, 2.11)),
                          ((south, 2.03), (north, 2.11))):
            box('post', (EAST - 0.09, *low), (EAST, *high), 'walnut', 1, 0.008)
    joined('Door Frame', frame)


# What stands in it

BOWL = [(0.32, 0), (0.34, 0.05), (0.62, 0.18), (0.88, 0.42), (1.0, 0.72)]
DEEP = [(0.40, 0), (0.42, 0.06), (0.66, 0.25), (0.74, 0.6), (0.72, 1.0)]
JAR = [(0.42, 0), (0.50, 0.1), (0.72, 0.5), (0.70, 0.95), (0.44, 1.25), (0.40, 1.33), (0.46, 1.4)]
BOTTLE = [(0.36, 0), (0.46, 0.12), (0.56, 0.5), (0.42, 0.85), (0.15, 1.15), (0.12, 1.5),
          (0.19, 1.62)]
PLATE = [(0.45, 0), (0.48, 0.05), (0.72, 0.12), (1.0, 0.20)]
VASE = [(0.62, 0), (0.64, 0.08), (0.80, 0.45), (1.0, 1.05), (1.0, 1.5), (0.78, 2.0), (0.46, 2.35),
        (0.42, 2.55), (0.60, 2.8)]
CUP = [(0.62, 0), (0.60, 0.05), (0.30, 0.14), (0.13, 0.30), (0.20, 0.42), (0.13, 0.54),
       (0.30, 0.74), (0.66, 0.94), (0.82, 1.28), (0.88, 1.7)]


def make_table():
    x, y, high = -0.15, 0.35, 0.77

    def table():
        for n in range(4):
            a = y - 0.42 + 0.21 * n
            box('board', (x - 0.85, a + 0.001, high - 0.04), (x + 0.85, a + 0.209, high), 'oak')
        for i in (-1, 1):
            box('apron', (x - 0.74, y + i * 0.35 - 0.012, high - 0.14),
                (x + 0.74, y + i * 0.35 + 0.012, high - 0.04), 'oak')
            box('apron', (x + i * 0.74 - 0.012, y - 0.35, high - 0.14),
                (x + i * 0.74 + 0.012, y + 0.35, high - 0.04), 'oak')
            for k in (-1, 1):
                box('leg', (x + i * 0.74 - 0.035, y + k * 0.35 - 0.035, 0),
                    (x + i * 0.74 + 0.035, y + k * 0.35 + 0.035, high - 0.04), 'oak', 1, 0.01)
    joined('Table', table)
    pot('Vase', VASE, 'faience', (x - 0.05, y + 0.06, high), size=0.19, sides=80, rings=2)

    def jug():
        pot('body', [(0.40, 0), (0.46, 0.06), (0.64, 0.4), (0.62, 0.8), (0.44, 1.15), (0.42, 1.3),
                     (0.48, 1.45)], 'honey', (0, 0, 0), size=0.13)
        tube('handle', rounded([(0.056, 0, 0.172), (0.10, 0, 0.178), (0.122, 0, 0.13),
                                (0.105, 0, 0.08), (0.076, 0, 0.055)]), 0.010, 'honey', flat=1.4)
    made = joined('Jug', jug)
    made.location, made.rotation_euler.z = (x + 0.50, y + 0.12, high), -0.7
    pot('Tea Bowl', DEEP, 'turquoise', (x + 0.33, y - 0.20, high), size=0.085)
    pot('Small Bowl', BOWL, 'celadon', (x - 0.46, y - 0.20, high), size=0.12)

    def brushes():
        pot('beaker', [(0.8, 0), (0.85, 0.1), (0.9, 1.2), (0.95, 2.4)], 'oatmeal', (0, 0, 0),
            size=0.045)
        for n in range(6):
            turn, lean = n * 1.05, 0.03 + 0.008 * (n % 3)
            foot = Vector((-0.5 * lean * math.cos(turn), -0.5 * lean * math.sin(turn), 0.01))
            way = Vector((lean * math.cos(turn), lean * math.sin(turn), 0.16)).normalized()
            end = 0.19 + 0.012 * (n * 5 % 4)
            tube('handle', [foot, foot + way * end], 0.004, ('oak', 'walnut')[n % 2], sides=8)
            tube('ferrule', [foot + way * end, foot + way * (end + 0.02)], 0.0045, 'brass', sides=8)
            tube('hair', rounded([foot + way * (end + k) for k in (0.02, 0.035, 0.055)], 2),
                 0.0042, 'bristle', sides=8)
    made = joined('Brushes', brushes)
    made.location = (x - 0.66, y + 0.18, high)
    rug = [(x - 1.35, y - 0.95), (x + 1.35, y - 0.95), (x + 1.35, y + 0.95), (x - 1.35, y + 0.95)]
    sheet('Rug', [(*p, 0.008) for p in rug], 'rug')


def make_wheel():
    """A kick wheel with a pot that is not finished, and its stool."""
    x, y = -2.15, 0.35

    def frame():
        for i in (-1, 1):
            for k in (-1, 1):
                box('leg', (x + i * 0.36 - 0.035, y + k * 0.40 - 0.035, 0),
                    (x + i * 0.36 + 0.035, y + k * 0.40 + 0.035, 0.66), 'walnut', 1, 0.008)
            for low, high in ((0.58, 0.66), (0.08, 0.14)):
                box('rail', (x - 0.36, y + i * 0.40 - 0.02, low),
                    (x + 0.36, y + i * 0.40 + 0.02, high), 'walnut')
            box('rail', (x + i * 0.36 - 0.02, y - 0.40, 0.58),
                (x + i * 0.36 + 0.02, y + 0.40, 0.66), 'walnut')
        box('beam', (x - 0.04, y - 0.40, 0.60), (x + 0.04, y + 0.40, 0.65), 'walnut')
        turned('shaft', [(0.018, 0.02), (0.018, 0.75)], 'iron', (x, y, 0), sides=16)
        turned('flywheel', [(0.001, 0.14), (0.33, 0.14), (0.34, 0.15), (0.34, 0.20), (0.33, 0.21),
                            (0.001, 0.21)], 'oak', (x, y, 0), smooth=30)
        turned('head', [(0.001, 0.715), (0.16, 0.715), (0.165, 0.72), (0.165, 0.745), (0.16, 0.75),
                        (0.001, 0.75)], 'iron', (x, y, 0), smooth=30)
    joined('Wheel', frame)
    ridges = [(0.062 + 0.020 * math.sin(z * 20) + 0.0016 * math.sin(z * 260), z)
              for z in (0.006 * n for n in range(31))]
    pot('Fresh Pot', ridges, 'wet clay', (x, y, 0.75), wall=0.008, steps=1)

    def stool():
        turned('seat', [(0.001, 0.44), (0.15, 0.44), (0.165, 0.455), (0.16, 0.475), (0.05, 0.468),
                        (0.001, 0.467)], 'oak', smooth=30)
        for n in range(3):
            turn = math.tau * n / 3 + 0.5
            tube('leg', [(0.10 * math.cos(turn), 0.10 * math.sin(turn), 0.445),
                         (0.19 * math.cos(turn), 0.19 * math.sin(turn), 0)], 0.017, 'walnut')
    joined('Stool', stool).location = (x + 0.18, y - 0.88, 0)

    def clay():
        for at, size in (((0, 0, 0), 1.0), ((0.06, 0.44, 0), 0.85)):
            sack = rounded([(0.12 * size, 0), (0.19 * size, 0.05), (0.21 * size, 0.16),
                            (0.16 * size, 0.34), (0.05 * size, 0.42), (0.05 * size, 0.44),
                            (0.11 * size, 0.51), (0.002, 0.47)])
            turned('sack', sack, 'linen', at, sides=40)
        for n, (dx, dy, z) in enumerate(((0.42, 0.1, 0), (0.42, 0.34, 0), (0.44, 0.22, 0.15))):
            box('block', (dx - 0.13, dy - 0.10, z), (dx + 0.13, dy + 0.10, z + 0.15), 'wet clay', 1,
                0.025)
    joined('Clay', clay).location = (-2.70, -1.85, 0)


def make_shelf():
    west, east, deep = -2.55, -0.35, 0.26
    levels = (1.12, 1.54, 1.96)

    def boards():
        for z in levels:
            box('board', (west, NORTH - deep, z - 0.03), (east, NORTH, z), 'oak', 1.2)
        for x in (west + 0.28, (west + east) / 2, east - 0.28):
            box('post', (x - 0.02, NORTH - 0.03, 0.98), (x + 0.02, NORTH, levels[-1]), 'walnut')
            for z in levels:
                box('bracket', (x - 0.018, NORTH - 0.22, z - 0.075), (x + 0.018, NORTH, z - 0.03),
                    'walnut')
    joined('Shelf', boards)
    y = NORTH - 0.135
    rows = (((-2.36, BOWL, 'cobalt', 0.120), (-2.05, JAR, 'tenmoku', 0.150),
             (-1.74, BOWL, 'honey', 0.110), (-1.42, DEEP, 'copper red', 0.115),
             (-1.10, BOWL, 'oatmeal', 0.125), (-0.80, JAR, 'celadon', 0.135),
             (-0.53, DEEP, 'bare clay', 0.105)),
            ((-2.36, DEEP, 'turquoise', 0.105), (-2.10, BOTTLE, 'copper red', 0.165),
             (-1.80, BOWL, 'celadon', 0.120), (-1.48, BOWL, 'tenmoku', 0.118),
             (-1.20, BOTTLE, 'oatmeal', 0.175), (-0.90, DEEP, 'cobalt', 0.115),
             (-0.58, BOWL, 'turquoise', 0.122)),
            ((-2.34, JAR, 'oatmeal', 0.160), (-1.98, BOWL, 'copper red', 0.125),
             (-1.68, BOTTLE, 'cobalt', 0.190), (-1.36, JAR, 'honey', 0.150),
             (-1.02, BOWL, 'tenmoku', 0.125), (-0.74, BOTTLE, 'celadon', 0.175),
             (-0.50, DEEP, 'honey', 0.095)))

    def vessels():
        for z, row in zip(levels, rows):
            for x, outline, glaze, size in row:
                made = pot('vessel', outline, glaze, (x, y + 0.012 * math.sin(9 * x), z), size=size,
                           sides=26, steps=2)
                made.rotation_euler.z = 5 * x
    joined('Glazes', vessels)


def make_picture():
    x, z, wide, high = 0.62, 1.66, 0.88, 0.66
    y = NORTH - 0.02

    def frame():
        for paint, inner, outer, deep, chamfer in (('walnut', 0.0, 0.07, 0.05, 0.014),
                                                   ('gold', -0.012, 0.0, 0.035, 0.003)):
            for i in (-1, 1):
                a, b = sorted((i * (wide / 2 + inner), i * (wide / 2 + outer)))
                box('upright', (x + a, NORTH - deep, z - high / 2 - outer),
                    (x + b, NORTH, z + high / 2 + outer), paint, 1, chamfer)
                a, b = sorted((i * (high / 2 + inner), i * (high / 2 + outer)))
                box('crossbar', (x - wide / 2 - inner, NORTH - deep, z + a),
                    (x + wide / 2 + inner, NORTH, z + b), paint, 1, chamfer)
    joined('Frame', frame)
    sheet('Painting', [(x - wide / 2, y, z - high / 2), (x + wide / 2, y, z - high / 2),
                       (x + wide / 2, y, z + high / 2), (x - wide / 2, y, z + high / 2)],
          'painting')


def make_clock():
    """Its pendulum of 0.56 m swings once to and fro in 1.5 seconds."""
    x, low, high, half, deep = 1.78, 0.98, 2.24, 0.17, 0.17
    front, dial = NORTH - deep, 2.02

    def case():
        box('back', (x - half, NORTH - 0.02, low), (x + half, NORTH, high), 'oak', 1, 0)
        for i in (-1, 1):
            box('side', (x + i * half - 0.014, front, low), (x + i * half + 0.014, NORTH, high),
                'walnut', 1, 0.006)
            turned('column', rounded([(0.009, 0), (0.013, 0.02), (0.009, 0.05), (0.011, 0.40),
                                      (0.009, 0.76), (0.013, 0.79), (0.009, 0.81)]), 'walnut',
                   (x + i * (half - 0.005), front - 0.008, low + 0.05), sides=16)
        for z, wide in ((low, 0.035), (high, 0.04)):
            box('board', (x - half - wide, front - 0.03, z - 0.03), (x + half + wide, NORTH,
                                                                    z + 0.03), 'walnut', 1, 0.012)
        box('cornice', (x - half + 0.02, front, high + 0.03), (x + half - 0.02, NORTH, high + 0.10),
            'walnut', 1, 0.03)
        turned('knob', rounded([(0.02, 0), (0.012, 0.02), (0.028, 0.05), (0.010, 0.09), (0.002,
                               0.115)]), 'brass', (x, NORTH - 0.08, high + 0.10), sides=24)
        box('board', (x - half, front + 0.04, dial - 0.16), (x + half, NORTH - 0.1, high), 'walnut')
        bezel = [(0.152, 0), (0.152, 0.016), (0.143, 0.022), (0.137, 0.010), (0.137, 0)]
        lay(turned('bezel', bezel, 'brass', sides=64), (x, front + 0.04, dial), 'X', 90)
    clock = joined('Clock', case)
    face = [(x + 0.14 * math.cos(math.tau * n / 64), front + 0.036,
             dial + 0.14 * math.sin(math.tau * n / 64)) for n in range(64)]
    thing('Dial', face, [tuple(range(64))],
          [((p[0] - x) / 0.28 + 0.5, (p[2] - dial) / 0.28 + 0.5) for p in face], 'dial',
          parent=clock)
    pivot = empty('Pendulum', (x, front + 0.085, 1.78), clock)
    tube('Rod', [(0, 0, 0), (0, 0, -0.56)], 0.0035, 'brass', sides=10, parent=pivot)
    bob = turned('Bob', rounded([(0.001, -0.010), (0.045, -0.008), (0.062, 0), (0.045, 0.010),
                                 (0.001, 0.013)]), 'brass', sides=48, parent=pivot)
    bob.location, bob.rotation_euler.x = (0, 0, -0.56), math.pi / 2
    animate(pivot, 'Pendulum', 'y', 36, lambda t: math.radians(4.2) * math.sin(math.tau * t))


def make_cupboard():
    """On the east wall; its door turns by 105 degrees in 1.5 seconds. In it: the first bowl."""
    low, high, south, north, deep = 1.05, 1.72, 0.55, 1.13, 0.26
    front = EAST - deep

    def body():
        for a, b in (((south, low), (north, low + 0.022)), ((south, high - 0.022), (north, high)),
                     ((south, low), (south + 0.022, high)), ((north - 0.022, low), (north, high)),
                     ((south, (low + high) / 2 - 0.009), (north, (low + high) / 2 + 0.009))):
            box('board', (front, *a), (EAST, *b), 'walnut', 1, 0.003)
        box('back', (EAST - 0.015, south, low), (EAST, north, high), 'oak', 1, 0)
        for z, out in ((low - 0.03, 0.02), (high, 0.035)):
            box('ledge', (front - out, south - out, z), (EAST, north + out, z + 0.03), 'walnut', 1,
                0.01)
    hinge = empty('Cupboard Door', (front, north, 0), joined('Cupboard', body))

    def leaf():
        wide, thick = south - north, -0.022
        for a, b in (((wide, low), (wide + 0.07, high)), ((-0.07, low), (0, high)),
                     ((wide + 0.07, low), (-0.07, low + 0.07)),
                     ((wide + 0.07, high - 0.07), (-0.07, high))):
            box('frame', (thick, *a), (0, *b), 'walnut', 1, 0.005)
        box('panel', (thick * 0.7, wide + 0.06, low + 0.06), (thick * 0.2, -0.06, high - 0.06),
            'sage', 1, 0.003)
        knob = [(0.006, 0), (0.005, 0.012), (0.014, 0.022), (0.010, 0.034), (0.001, 0.037)]
        lay(turned('knob', rounded(knob), 'brass', sides=24), (thick, wide + 0.035, 1.36), 'Y', -90)
    made = joined('Leaf', leaf)
    made.parent = hinge
    pot('First Bowl', BOWL, 'bare clay', (EAST - 0.13, (south + north) / 2 + 0.09,
                                          (low + high) / 2 + 0.009), size=0.105)
    pot('Mended Jar', JAR, 'turquoise', (EAST - 0.13, (south + north) / 2 - 0.12, low + 0.022),
        size=0.13)
    pot('Plate', PLATE, 'oatmeal', (EAST - 0.13, (south + north) / 2 + 0.12, low + 0.022),
        size=0.11)
    animate(hinge, 'Cupboard', 'z', 36, lambda t: -math.radians(105) * t * t * (3 - 2 * t))


def make_case():
    """The glass case of the golden cup, with a lamp in its lid."""
    x, y, half, high, glass = 1.55, -0.35, 0.23, 0.98, 0.44

    def stand():
        box('plinth', (x - half, y - half, 0.06), (x + half, y + half, high), 'enamel', 1, 0.006)
        box('foot', (x - half - 0.02, y - half - 0.02, 0), (x + half + 0.02, y + half + 0.02, 0.06),
            'walnut', 1, 0.008)
        box('lid', (x - half, y - half, high + glass), (x + half, y + half, high + glass + 0.035),
            'brass', 1, 0.006)
        for i in (-1, 1):
            for k in (-1, 1):
                box('edge', (x + i * half - 0.005, y + k * half - 0.005, high),
                    (x + i * half + 0.005, y + k * half + 0.005, high + glass), 'brass', 1, 0.001)
        box('cushion', (x - 0.12, y - 0.12, high), (x + 0.12, y + 0.12, high + 0.055), 'velvet', 1,
            0.02)
    joined('Case', stand)
    low, top, a = high + 0.001, high + glass - 0.001, half - 0.006

    def panes():
        for corners in (((-a, -a), (a, -a)), ((a, -a), (a, a)), ((a, a), (-a, a)), ((-a, a),
                                                                                   (-a, -a))):
            (p, q), (r, s) = corners
            sheet('pane', [(x + p, y + q, low), (x + r, y + s, low), (x + r, y + s, top),
                           (x + p, y + q, top)], 'glass')
    joined('Glass', panes)
    pot('Cup', CUP, 'gold', (x, y, high + 0.055), size=0.10, wall=0.004, sides=56)
    light('Case Lamp', 'SPOT', (x, y, high + glass - 0.02), 1.6, degrees=36)


def make_lamp():
    """Over the table."""
    x, y, z = -0.15, 0.35, 1.92

    def shade():
        turned('outside', rounded([(0.22, 0), (0.20, 0.05), (0.10, 0.13), (0.035, 0.17),
                                   (0.03, 0.22)]), 'enamel', (x, y, z))
        turned('inside', rounded([(0.03, 0.165), (0.095, 0.127), (0.196, 0.048), (0.218, 0.001)]),
               'white paint', (x, y, z))
        turned('cap', [(0.03, 0.22), (0.012, 0.235), (0.008, 0.27), (0.001, 0.271)], 'brass',
               (x, y, z), sides=24)
        tube('cable', [(x, y, z + 0.26), (x, y, HIGH)], 0.004, 'iron', sides=8)
    joined('Lamp', shade)
    turned('Bulb', [(0.001, 0.035), (0.028, 0.065), (0.001, 0.10)], 'bulb', (x, y, z), sides=4)
    light('Lamp Light', 'SPOT', (x, y, z + 0.03), 5.0, degrees=74)

    def spot():
        lay(turned('shade', [(0.04, 0), (0.045, 0.10), (0.02, 0.13), (0.001, 0.131)], 'brass',
                   sides=24), (-1.45, 0.80, 2.50), 'X', 50)
        tube('arm', [(-1.45, 0.70, HIGH), (-1.45, 0.70, 2.58)], 0.008, 'brass', sides=8)
    joined('Shelf Spot', spot)
    light('Shelf Lamp', 'SPOT', (-1.45, 0.83, 2.47), 9.0, degrees=42, way=(0, 1.6, -0.95))


def main():
    out = os.path.abspath(sys.argv[sys.argv.index('--') + 1])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module='io_scene_gltf2')
    with tempfile.TemporaryDirectory() as folder:
        for name, pixels, is_data in pictures.all_pictures():
            store(name, pixels, is_data, folder)
        make_materials()
        make_window('West Window', WEST_WINDOW, 1, WEST, -1)
        make_window('South Window', SOUTH_WINDOW, 0, SOUTH, -1)
        for make in (make_walls, make_door, make_table, make_wheel, make_shelf,
                     make_picture, make_clock, make_cupboard, make_case, make_lamp):
            make()
        light('Sun', 'SUN', (-8, -2, 6), 12.0, tone=(1.0, 0.86, 0.68), way=(0.93, 0.10, -0.37))
        unitless = {key: 'COMPAT' for key in ('convert_lighting_mode',  # until Blender 3.5
                                              'export_import_convert_lighting_mode')}
        known = bpy.ops.export_scene.gltf.get_rna_type().properties.keys()
        bpy.ops.export_scene.gltf(
            filepath=out, export_format='GLB', export_apply=True, export_lights=True,
            export_copyright='The Wellspring authors, Apache License 2.0',
            export_animations=True, export_frame_range=False, export_image_format='AUTO',
            **{key: value for key, value in unitless.items() if key in known})


main()
