# SPDX-License-Identifier: Apache-2.0
"""What furnishes the hall: pictures, hangings, fireplace, chandeliers, benches, rope stands,
rug."""
import math

from .hall import CROWN, wall_frame
from .lights import make_point, make_spot
from .mesh import Mesh, catmull_rom, translation, turn, turn_z
from .noise import generator
from .statues import HORSE

FIREPLACE_X = -2.0


def frame(mesh, s, z, width, picture, ratio, rich=1.0):
    """A picture in a gilt frame on a wall (in the wall's frame), hung with its middle at (s, z)."""
    height = width / ratio
    w, h, y, k = width / 2, height / 2, -0.03, rich
    mesh.quad((s - w, y, z - h), (s + w, y, z - h), (s + w, y, z + h), (s - w, y, z + h),
              'picture ' + picture,
              uv=[(0, 0), (1, 0), (1, 1), (0, 1)])
    corners = [(s - w, y, z - h), (s - w, y, z + h), (s + w, y, z + h), (s + w, y, z - h)]
    profile = [(-0.10, -0.03), (0.012, -0.03), (0.012, 0.0), (0.0, 0.008), (-0.012, 0.008),
               (-0.018, 0.016), (-0.03, 0.018),
               (-0.045, 0.030), (-0.062, 0.052), (-0.078, 0.056), (-0.088, 0.048), (-0.094, 0.034),
                   (-0.10, 0.03)]
    profile = [(a * k if a < 0 else a, b * (0.6 + 0.4 * k) if b > 0 else b) for a, b in profile]
    mesh.sweep(profile, corners, 'gilt', [(0, -1, 0)], closed=True, scale=0.5)
    keep = mesh.transform
    for cs, cz in ((-1, -1), (1, -1), (1, 1),
                   (-1, 1)):                    # carved leaves at the corners
        mesh.transform = keep @ translation(s + cs * (w + 0.05 * k), y - 0.045 * k,
                                            z + cz * (h + 0.05 * k))
        for leaf in range(3):
            a = math.radians(-80 + 80 * leaf) + math.atan2(cz, cs)
            mesh.ellipsoid((0.042 * k * math.cos(a), 0, 0.042 * k * math.sin(a)),
                           (0.034 * k, 0.016, 0.034 * k), 'gilt', 8, 4)
        mesh.ellipsoid((0, -0.012, 0), (0.03 * k, 0.02, 0.03 * k), 'gilt', 8, 4)
    mesh.transform = keep


def make_pictures():
    mesh = Mesh('Paintings')
    mesh.transform = wall_frame('inner')                    # its x runs against the hall's x
    frame(mesh, -2.0, 2.55, 2.25, 'castle', 1.5, 1.35)
    frame(mesh, -4.95, 2.35, 0.82, 'lady', 0.744, 1.1)
    frame(mesh, -7.05, 2.35, 0.82, 'nobleman', 0.744, 1.1)
    frame(mesh, -6.0, 1.98, 0.84, 'river', 1.5, 0.85)
    frame(mesh, -6.0, 2.92, 0.92, 'winter', 1.333, 0.9)
    frame(mesh, 5.25, 2.4, 0.86, 'captain', 0.744, 1.1)
    frame(mesh, 6.75, 2.4, 0.86, 'still_life', 0.8, 1.1)
    mesh.transform = wall_frame('gate')
    frame(mesh, -3.0, 2.5, 1.3, 'moonlight', 1.412, 1.1)
    frame(mesh, 3.0, 2.5, 1.3, 'forest', 1.412, 1.1)
    mesh.finish(location=(2.0, -4.45, 2.55))
    for name, x, reach in (('Castle', 2.0, 34), ('Portraits', 6.0, 36), ('Captain', -6.0, 34)):
        make_spot('Light ' + name, (x, -1.9, 4.75), (x, -4.4, 2.3), 11.0, reach, (1.0, 0.86, 0.68),
                  0.7)


def tapestry(mesh, s, top, width, height, material):
    """A hanging with soft folds on a gilt rod."""
    columns, rows, points = 48, 12, []
    for r in range(rows + 1):
        z = top - height + height * r / rows
        loose = 1.0 - 0.6 * r / rows
        points.append([(s - width / 2 + width * c / columns,
                        -0.045 - 0.016 * loose * math.sin(c * 0.82) - 0.007 * loose
                            * math.sin(c * 0.37 + 1), z) for c in range(columns + 1)])
    mesh.grid(points, material, repeat=(1, 1))
    mesh.tube([(s - width / 2 - 0.16, -0.055, top + 0.015), (s + width / 2 + 0.16, -0.055,
                                                             top + 0.015)], 0.02, 'dark oak', 12)
    for side in (-1, 1):
        mesh.ellipsoid((s + side * (width / 2 + 0.18), -0.055, top + 0.015), (0.045, 0.036, 0.036),
                       'gilt', 14, 8)
    for k in range(9):
        t = s - width / 2 + width * (k + 0.5) / 9
        ring = [(t, -0.055 + 0.027 * math.cos(a), top + 0.015 + 0.027 * math.sin(a))
                for a in (2 * math.pi * i / 12 for i in range(12))]
        mesh.tube(ring, 0.004, 'brass', 5, closed=True)
    fringe = [(s - width / 2 + width * (i + 0.5) / 110, top - height) for i in range(110)]
    for t, z in fringe:
        mesh.quad((t - 0.006, -0.046, z - 0.07), (t + 0.006, -0.046, z - 0.07), (t + 0.005, -0.046,
            z + 0.005), (t - 0.005, -0.046, z + 0.005), 'fringe')


def make_hangings():
    mesh = Mesh('Tapestries')
    mesh.transform = wall_frame('court')
    tapestry(mesh, -3.0, 4.15, 2.12, 2.66, 'tapestry stag')
    tapestry(mesh, 3.0, 4.15, 2.12, 2.66, 'tapestry eagle')
    mesh.finish(location=(-7.95, 3.0, 2.8))


def make_fireplace():
    mesh = Mesh('Fireplace')
    base = wall_frame('inner') @ translation(-FIREPLACE_X, 0, 0)
    mesh.transform = base
    w, deep = 1.05, 0.72  # opening half width, projection
    mesh.box((-1.55, -1.12, 0), (1.55, 0, 0.06), 'stone', 1.5)                # hearth
    for side in (-1,
                 1):                                                      # jambs with half columns
        x0, x1 = sorted((side * w, side * (w + 0.24)))
        mesh.box((x0, -deep + 0.10, 0.06), (x1, 0, 1.42), 'ashlar', 2.4)
        mesh.transform = base @ translation(side * (w + 0.12), -deep + 0.08, 0.06)
        mesh.lathe([(0.13, 0.0), (0.13, 0.06), (0.105, 0.08), (0.115, 0.12), (0.09, 0.15),
                    (0.082, 1.05), (0.10, 1.07), (0.10, 1.09),
                    (0.085, 1.10), (0.12, 1.22), (0.15, 1.27), (0.15, 1.33), (0.16, 1.36),
                        (0.0, 1.361)], 20, 'stone', repeat=(0.6, 1))
        mesh.transform = base
    mesh.box((-w - 0.34, -deep - 0.10, 1.42), (w + 0.34, 0, 1.50), 'stone', 1.5)
    mesh.box((-w - 0.27, -deep - 0.03, 1.50), (w + 0.27, 0, 1.86), 'ashlar', 2.4)
    mesh.box((-w - 0.36, -deep - 0.13, 1.86), (w + 0.36, 0, 1.93), 'stone', 1.5)
    mesh.box((-w - 0.32, -deep - 0.08, 1.93), (w + 0.32, 0, 1.97), 'stone', 1.5)
    for k in range(5):  # carved quatrefoils in the lintel
        x = -0.92 + 0.46 * k
        for q in range(4):
            a = math.pi / 2 * q
            mesh.ellipsoid((x + 0.055 * math.cos(a), -deep - 0.03, 1.68 + 0.055 * math.sin(a)),
                           (0.052, 0.028, 0.052), 'stone', 12, 6)
        mesh.ellipsoid((x, -deep - 0.045, 1.68), (0.03, 0.026, 0.03), 'gilt', 10, 6)
    low = [(-w - 0.24, -deep), (w + 0.24, -deep), (w + 0.24, 0),
           (-w - 0.24, 0)]     # the hood, up into the vault
    high = [(-0.52, -0.30), (0.52, -0.30), (0.52, 0), (-0.52, 0)]
    a = [(x, y, 1.97) for x, y in low] + [(x, y, 5.6) for x, y in high]
    mesh.add(a, [(0, 1, 5, 4), (1, 2, 6, 5), (3, 0, 4, 7)], 'plaster', scale=3.0)
    for side in (-1, 1):                                                      # firebox
        mesh.quad((side * w, -deep + 0.1, 0.06), (side * (w - 0.2), 0.3, 0.06), (side * (w - 0.2),
            0.3, 1.42), (side * w, -deep + 0.1, 1.42), 'soot') \
            if side < 0 else mesh.quad((w - 0.2, 0.3, 0.06), (w, -deep + 0.1, 0.06),
                                       (w, -deep + 0.1, 1.42), (w - 0.2, 0.3, 1.42), 'soot')
    mesh.quad((-w + 0.2, -0.004, 0.06), (w - 0.2, -0.004, 0.06), (w - 0.2, -0.004, 1.42),
              (-w + 0.2, -0.004, 1.42), 'soot')
    mesh.quad((-w, -0.02, 0.062), (-w, -deep, 0.062), (w, -deep, 0.062), (w, -0.02, 0.062), 'soot')
    mesh.box((-0.55, -0.06, 0.10), (0.55, -0.02, 0.85), 'iron')               # fireback
    rng = generator('logs')
    for k, (x, y, z, yaw) in enumerate(((-0.05, -0.28, 0.17, 4), (0.06, -0.44, 0.17, -6),
                                        (0.0, -0.36, 0.29, 12), (-0.1, -0.34, 0.40, -14))):
        mesh.transform = base @ translation(x, y, z) @ turn_z(yaw)
        n = 9
        rings = [[(-0.42 + 0.84 * i / 6, 0.062 * (1 + 0.12 * rng.normal()) * math.cos(b),
                   0.062 * (1 + 0.12 * rng.normal()) * math.sin(b))
                  for b in (2 * math.pi * q / n for q in range(n))] for i in range(7)]
        mesh.loft(rings, 'dark oak', repeat=(1, 2))
    mesh.transform = base
    for side in (-1, 1):                                                      # fire dogs
        mesh.tube([(side * 0.36, -0.66, 0.06), (side * 0.36, -0.62, 0.26), (side * 0.36, -0.62,
            0.50)], [0.03, 0.02, 0.024], 'iron', 8)
        mesh.ellipsoid((side * 0.36, -0.62, 0.54), (0.045, 0.045, 0.045), 'brass', 14, 8)
        mesh.box((side * 0.36 - 0.015, -0.62, 0.12), (side * 0.36 + 0.015, -0.1, 0.15), 'iron')
    for k in range(7):                                                        # embers, few faces
        x, y, s = -0.34 + 0.68 * rng.random(), -0.36 + 0.16 * (rng.random()
                                                               - 0.5), 0.035 + 0.03 * rng.random()
        top = (x, y, 0.12 + s)
        ring = [(x + s * math.cos(b), y + s * math.sin(b), 0.075) for b in (2 * math.pi
            * (q + rng.random() * 0.3) / 4 for q in range(4))]
        mesh.add(ring + [top], [(q, (q + 1) % 4, 4) for q in range(4)], 'ember')
    mesh.transform = base @ translation(0, -0.62, 0)
    frame_on_hood(mesh, base)
    mesh.finish(bevel=0.005, location=(FIREPLACE_X, -4.5, 0))
    make_point('Fire', (FIREPLACE_X, -4.5 + 0.42, 0.62), 1.6, (1.0, 0.45, 0.15))


def frame_on_hood(mesh, base):
    """The painted arms of the house lean on the sloping hood."""
    slope = math.degrees(math.atan2(0.72 - 0.30, 5.6 - 1.97))
    z = 2.72
    y = -(0.72 - (0.72 - 0.30) * (z - 1.97) / (5.6 - 1.97))
    mesh.transform = base @ translation(0, y - 0.01, z) @ turn(-slope, 'X') @ translation(0, 0, -z)
    frame(mesh, 0.0, z, 0.86, 'arms', 0.8, 1.0)
    mesh.transform = base


def bulb(mesh, z, radius, height):
    """A flame of eight faces: emitters should have few."""
    ring = [(radius, 0), (0, radius), (-radius, 0), (0, -radius)]
    points = [(x, y, z + height * 0.35) for x, y in ring] + [(0, 0, z), (0, 0, z + height)]
    mesh.add(points, [(k, (k + 1) % 4, 5) for k in range(4)] + [((k + 1) % 4, k,
                                                                 4) for k in range(4)], 'bulb')


def make_chandelier(name, x, candles=6, height=3.75):
    mesh = Mesh(name)
    mesh.transform = translation(x, 0, height)
    ring = [(0.62 * math.cos(a), 0.62 * math.sin(a), 0) for a in (2 * math.pi * i / 36
                                                                  for i in range(36))]
    mesh.sweep([(-0.012, -0.035), (0.012, -0.035), (0.016, 0.0), (0.012, 0.035), (-0.012, 0.035),
                (-0.016, 0.0)], ring, 'brass', [(0, 0, 1)], closed=True)
    for z in (-0.035, 0.035):
        mesh.tube([(px, py, z) for px, py, _ in ring], 0.012, 'brass', 5, closed=True)
    mesh.lathe([(0.0, -0.20), (0.03, -0.19), (0.045, -0.15), (0.025, -0.11), (0.05, -0.06),
                (0.085, 0.0), (0.05, 0.07), (0.025, 0.11),
                (0.03, 0.30), (0.016, 0.33), (0.016, 0.62), (0.0, 0.63)], 20, 'brass')
    for k in range(candles):
        a = 2 * math.pi * k / candles
        cx, cy = 0.62 * math.cos(a), 0.62 * math.sin(a)
        mesh.transform = translation(x, 0, height) @ turn_z(math.degrees(a))
        arm = catmull_rom([(0.05, 0, 0.02), (0.20, 0, -0.09), (0.42, 0, -0.05), (0.62, 0, 0.0)], 5)
        mesh.tube(arm, 0.011, 'brass', 7)
        mesh.transform = translation(x + cx, cy, height)
        mesh.lathe([(0.012, 0.03), (0.05, 0.055), (0.055, 0.065), (0.02, 0.07), (0.022, 0.10),
                    (0.0, 0.101)], 14, 'brass')
        mesh.lathe([(0.016, 0.07), (0.016, 0.20), (0.0, 0.201)], 10, 'paper')
        bulb(mesh, 0.20, 0.020, 0.085)
    mesh.transform = translation(0, 0, 0)
    for k in range(3):
        a = 2 * math.pi * k / 3 + math.pi / 6
        mesh.tube([(x + 0.61 * math.cos(a), 0.61 * math.sin(a), height + 0.03),
                   (x + 0.02 * math.cos(a), 0.02 * math.sin(a), height + 0.85)], 0.006, 'brass', 5)
    links = int((CROWN - 0.3 - height - 0.6) / 0.052)
    for k in range(links):
        mesh.transform = translation(x, 0, height + 0.62 + 0.052 * k + 0.02) @ turn_z(90 * (k % 2))
        mesh.tube([(0.016 * math.cos(a), 0, 0.034 * math.sin(a)) for a in (2 * math.pi * i / 8
            for i in range(8))], 0.0055, 'iron', 5, closed=True)
    mesh.finish(location=(x, 0, height))
    make_point(name + ' Light', (x, 0, height - 0.30), 8.0)


def make_bench(mesh, x, y, angle, length=1.7):
    """An upholstered oak bench on turned legs."""
    base = translation(x, y, 0) @ turn_z(angle)
    mesh.transform = base
    w, d = length / 2, 0.23
    mesh.box((-w, -d, 0.36), (w, d, 0.42), 'dark oak', 1.2, 'x')
    mesh.box((-w + 0.10, -0.02, 0.12), (w - 0.10, 0.02, 0.17), 'dark oak', 1.2, 'x')
    rows = []
    for j in range(9):
        v = -1 + 2 * j / 8
        rows.append([(w * 0.985 * u, d * 0.98 * v, 0.42 + 0.075 * (1 - abs(u) ** 14)
                      * (1 - v ** 8) ** 0.8) for u in (-1 + 2 * i / 28 for i in range(29))])
    mesh.grid(rows, 'red velvet')
    for sx in (-1, 1):
        for sy in (-1, 1):
            mesh.transform = base @ translation(sx * (w - 0.10), sy * (d - 0.055), 0)
            mesh.lathe([(0.022, 0.0), (0.034, 0.02), (0.034, 0.06), (0.02, 0.08), (0.034, 0.16),
                        (0.038, 0.22), (0.022, 0.28), (0.036, 0.30), (0.036, 0.36)],
                       12, 'dark oak')
        mesh.transform = base
        mesh.box((sx * (w - 0.10) - 0.02, -d + 0.05, 0.12), (sx * (w - 0.10) + 0.02, d - 0.05,
                                                             0.17), 'dark oak', 1.2, 'y')


def make_benches():
    mesh = Mesh('Benches')
    for x in (-6.0, -2.0, 2.0, 6.0):
        make_bench(mesh, x, 4.05, 0)
    make_bench(mesh, 6.0, -3.9, 0, 1.6)
    mesh.finish(bevel=0.004)


def make_stanchions():
    """Brass posts with a crimson rope around the bronze horse."""
    mesh = Mesh('Rope')
    base = translation(*HORSE, 0) @ turn_z(-28)
    corners = [(-1.2, -0.92), (0, -0.92), (1.2, -0.92), (1.2, 0.92), (0, 0.92), (-1.2, 0.92)]
    for x, y in corners:
        mesh.transform = base @ translation(x, y, 0)
        mesh.lathe([(0.0, 0.0), (0.15, 0.0), (0.15, 0.012), (0.06, 0.035), (0.022, 0.05),
                    (0.019, 0.86), (0.034, 0.87), (0.034, 0.91), (0.019, 0.92),
                    (0.030, 0.945), (0.038, 0.965), (0.030, 0.99), (0.0, 1.0)], 18, 'brass')
    mesh.transform = base
    for (xa, ya), (xb, yb) in zip(corners, corners[1:] + corners[:1]):
        path = []
        for i in range(13):
            t = i / 12
            path.append((xa + (xb - xa) * t, ya + (yb - ya) * t,
                         0.885 - 0.17 * (1 - (2 * t - 1) ** 2)))
        mesh.tube(path, 0.018, 'rope', 8)
    mesh.finish(location=(*HORSE, 0))


def make_rug():
    mesh = Mesh('Rug')
    mesh.transform = translation(FIREPLACE_X, -2.45, 0)
    w, d = 1.32, 0.88
    rows = [[(-w + 2 * w * i / 12, -d + 2 * d * j / 8, 0.011 + 0.0015 * math.sin(i * 1.3)
              * math.sin(j * 1.7)) for i in range(13)] for j in range(9)]
    mesh.grid(rows, 'rug')
    for low, high in (((-w, -d - 0.002), (w, -d)), ((-w, d), (w, d + 0.002)), ((-w - 0.002, -d),
            (-w, d)), ((w, -d), (w + 0.002, d))):
        mesh.box((*low, 0.001), (*high, 0.0105), 'fringe')
    rng = generator('fringe')
    for side in (-1, 1):
        for k in range(90):
            y = -d + 2 * d * (k + 0.5) / 90
            mesh.quad(*[(side * x, y + dy, 0.004) for x, dy in ((w, -0.004),
                                                                (w + 0.07, -0.003 + rng.normal(0,
                                                                    0.004)), (w + 0.07, 0.003),
                                                                        (w, 0.004))][::side],
                                                                            'fringe')
    mesh.finish()


def make_furniture():
    make_pictures()
    make_hangings()
    make_fireplace()
    make_chandelier('Chandelier', -2.0)
    make_chandelier('Chandelier Gate', 2.0)
    make_benches()
    make_stanchions()
    make_rug()
