# SPDX-License-Identifier: Apache-2.0
"""What is seen through the arch: the courtyard with its well, and the sky behind it."""
import math

import numpy as np

from .mesh import Mesh, circle, translation, turn, turn_z
from .noise import generator

GROUND = -0.15
WELL = (-13.2, 0.55)


def make_well():
    mesh = Mesh('Well')
    mesh.transform = translation(*WELL, GROUND)
    mesh.lathe([(1.18, 0.0), (1.18, 0.10), (0.98, 0.101)], 32, 'stone', smooth=False,
               repeat=(4, 0.2))
    mesh.lathe([(0.95, 0.10), (0.93, 0.80)], 32, 'ashlar', repeat=(2.5, 0.32))
    mesh.lathe([(1.02, 0.80), (1.04, 0.82), (1.04, 0.93), (1.02, 0.95), (0.70, 0.95),
                (0.68, 0.93)], 32, 'stone',
               smooth=False, repeat=(4, 0.3))
    mesh.lathe([(0.68, 0.93), (0.68, -0.6)], 32, 'ashlar', repeat=(2, 0.6))
    mesh.lathe([(0.68, 0.25), (0.0, 0.25)], 32, 'water')
    keep = mesh.transform
    mesh.transform = keep @ turn_z(75)
    for x in (-0.84, 0.84):
        mesh.block((x, 0, 1.63), (0.14, 0.14, 1.36), 'oak', 1.2, 'z')
        mesh.block((x, 0, 2.36), (0.12, 1.5, 0.12), 'oak', 1.2, 'y')
        for side in (-1, 1):                                             # braces
            mesh.transform = keep @ turn_z(75) @ translation(x, side * 0.3, 2.1) @ turn(-side * 45,
                'X')
            mesh.plank((0.08, 0.08, 0.75), 'oak', 1.2)
        mesh.transform = keep @ turn_z(75)
    mesh.tube([(-1.0, 0, 1.62), (1.05, 0, 1.62)], 0.075, 'oak', 14)
    mesh.tube([(1.05, 0, 1.62), (1.12, 0, 1.62), (1.12, 0, 1.34), (1.3, 0, 1.34)], 0.018, 'iron', 8)
    coil = [(-0.12 + 0.24 * i / 64, 0.09 * math.cos(i * 0.6), 1.62 + 0.09 * math.sin(i * 0.6))
            for i in range(65)]
    mesh.tube(coil, 0.016, 'fringe', 6)
    mesh.tube([(0.09, 0.085, 1.6), (0.09, 0.085, 1.18)], 0.012, 'fringe', 6)
    bucket = mesh.transform
    mesh.transform = bucket @ translation(0.09, 0.085, 0.0)
    mesh.lathe([(0.0, 0.90), (0.115, 0.90), (0.145, 1.13), (0.13, 1.13), (0.105, 0.92),
                (0.0, 0.915)], 16, 'oak',
               repeat=(2, 0.5))
    for z, r in ((0.94, 0.123), (1.09, 0.142)):
        mesh.lathe([(r, z), (r + 0.004, z + 0.002), (r + 0.004, z + 0.026), (r, z + 0.028)], 16,
                   'iron')
    arc = [(0.14 * math.cos(a), 0, 1.10 + 0.13 * math.sin(a)) for a in (math.pi * i / 10
        for i in range(11))]
    mesh.tube(arc, 0.007, 'iron', 6)
    mesh.transform = bucket
    ridge, eave, drop, reach = 3.12, 2.38, 0.92, 1.18                     # the little roof
    for side in (-1, 1):
        a, b = (-reach * side, 0, ridge), (reach * side, 0, ridge)
        c, d = (reach * side, -drop * side, eave), (-reach * side, -drop * side, eave)
        mesh.quad(d, c, b, a, 'shingles', uv=[(0, 0), (2, 0), (2, 1), (0, 1)])
        lower = [(x, y, z - 0.05) for x, y, z in (a, b, c, d)]
        mesh.quad(*lower, 'dark oak', scale=1.2, grain='x')
        mesh.quad(d, lower[3], lower[2], c, 'dark oak', scale=1.2, grain='x')
        mesh.quad(c, lower[2], lower[1], b, 'dark oak', scale=1.2, grain='y')
        mesh.quad(a, lower[0], lower[3], d, 'dark oak', scale=1.2, grain='y')
        gable = side * (reach - 0.2)
        points = [(gable, -0.72, 2.42), (gable, 0.72, 2.42), (gable, 0, 3.02)]
        mesh.add(points, [(0, 1, 2) if side > 0 else (0, 2, 1)], 'dark oak', scale=1.2, grain='z')
    mesh.tube([(-reach, 0, ridge + 0.015), (reach, 0, ridge + 0.015)], 0.045, 'dark oak', 8)
    mesh.finish(location=(*WELL, GROUND))


def facade(mesh, s0, s1, top, windows, scale=2.4, material='lime wall'):
    """A courtyard wall in its own frame (x along, y away): plaster, stone quoins, small windows."""
    mesh.quad((s0, 0, 0), (s1, 0, 0), (s1, 0, top), (s0, 0, top), material, scale=scale)
    mesh.box((s0, -0.06, 0), (s1, 0, 0.5), 'ashlar', 2.4)
    mesh.box((s0, -0.12, top - 0.22), (s1, 0, top), 'stone', 1.5)
    for x, z, w, h in windows:
        mesh.box((x - w / 2 - 0.12, -0.06, z - 0.12), (x + w / 2 + 0.12, 0, z + h + 0.12), 'stone',
                 1.5)
        mesh.box((x - w / 2, -0.065, z), (x + w / 2, -0.02, z + h), 'soot')
        mesh.box((x - 0.03, -0.075, z), (x + 0.03, -0.03, z + h), 'oak', 1.2, 'z')
        mesh.box((x - w / 2, -0.075, z + h * 0.6), (x + w / 2, -0.03, z + h * 0.6 + 0.05), 'oak',
                 1.2, 'x')
        mesh.box((x - w / 2 - 0.2, -0.18, z - 0.2), (x + w / 2 + 0.2, 0, z - 0.12), 'stone', 1.5)


def lean_roof(mesh, s0, s1, low, depth, rise):
    mesh.quad((s0, -0.35, low), (s1, -0.35, low), (s1, depth, low + rise), (s0, depth, low + rise),
              'roof tiles',
              scale=1.2)


def tower(mesh, x, y, radius, top, roof):
    keep = mesh.transform
    mesh.transform = translation(x, y, GROUND)
    around = 2 * math.pi * radius / 2.4
    mesh.lathe([(radius * 1.06, 0), (radius, 0.8), (radius, top)], 28, 'ashlar',
               repeat=(round(around), top / 2.4))
    mesh.lathe([(radius, top), (radius + 0.22, top + 0.18), (radius + 0.22, top + 0.4)], 28,
               'stone', repeat=(6, 0.4))
    mesh.lathe([(radius + 0.4, top + 0.36), (radius * 0.55, top + roof * 0.45), (0.0, top + roof)],
               28, 'roof tiles',
               smooth=False, repeat=(8, 4))
    for k, z in ((0, top - 1.4), (-0.5, top * 0.45), (0.6, top * 0.62)):
        mesh.transform = translation(x, y, GROUND) @ turn_z(math.degrees(k))
        mesh.block((radius, 0, z), (0.12, 0.42, 0.95), 'stone', 1.5)
        mesh.block((radius + 0.03, 0, z), (0.1, 0.22, 0.75), 'soot')
    mesh.transform = keep


def ivy(mesh, rng, place, count, size=0.11):
    """Leaves strewn by `place(rng) -> (point, normal)`; a rose here and there."""
    for i in range(count):
        point, normal = (np.asarray(v, float) for v in place(rng))
        normal = normal + rng.normal(0, 0.45, 3)
        normal /= np.linalg.norm(normal)
        side = np.cross(normal, rng.normal(0, 1, 3))
        side /= np.linalg.norm(side) + 1e-9
        up = np.cross(normal, side)
        s = size * (0.6 + 0.8 * rng.random())
        corners = [point - side * s * 0.5, point - up * s * 0.6, point + side * s * 0.5,
                   point + up * s * 0.7]
        mesh.add(corners, [(0, 1, 2, 3)], 'rose' if i % 17 == 0 else 'leaves')


def make_courtyard():
    mesh = Mesh('Courtyard')
    mesh.quad((-20, -8, GROUND), (-8.9, -8, GROUND), (-8.9, 8, GROUND), (-20, 8, GROUND),
              'cobbles', scale=2.0)
    mesh.transform = turn_z(90) @ translation(0, 19.0, GROUND)                    # far wing
    facade(mesh, -8, 8, 4.6, [(-5.2, 2.6, 0.8, 1.1), (-2.7, 2.6, 0.8, 1.1), (2.6, 2.6, 0.8, 1.1),
                              (5.2, 2.6, 0.8, 1.1),
                              (-4.0, 0.8, 0.6, 0.8), (4.2, 0.8, 0.6, 0.8)])
    lean_roof(mesh, -8, 8, 4.6, 3.0, 2.6)
    gate = [(-1.1, 0.0)] + [(1.1 * -math.cos(a), 1.6 + 1.1 * math.sin(a)) for a in (math.pi * i
        / 12 for i in range(13))] + [(1.1, 0.0)]
    mesh.add([(s, -0.07, z) for s, z in gate], [tuple(range(len(gate)))[::-1]], 'dark oak',
             scale=1.2, grain='z')
    mesh.sweep([(-0.28, -0.02), (0.0, -0.02), (0.0, 0.12), (-0.28, 0.12)], [(s, -0.02, z) for s,
        z in gate], 'stone',
               [(0, -1, 0)], scale=1.5)
    mesh.transform = turn_z(180) @ translation(0, 7.0,
                                               GROUND)  # the wing on the shady side
    facade(mesh, 8.9, 20, 4.2, [(11.0, 2.4, 0.8, 1.1), (13.8, 2.4, 0.8, 1.1), (16.6, 2.4, 0.8,
        1.1), (12.4, 0.7, 0.7, 0.9)])
    lean_roof(mesh, 8.9, 20, 4.2, 3.0, 2.6)
    mesh.transform = translation(0, 7.0,
                                 GROUND)  # low wall on the sunny side
    mesh.box((-20, 0, 0), (-8.9, 0.5, 2.1), 'ashlar', 2.4)
    mesh.box((-20, -0.06, 2.1), (-8.9, 0.56, 2.2), 'stone', 1.5)
    mesh.transform = translation(0, 0, 0)
    tower(mesh, -18.6, -4.6, 1.7, 7.4, 3.6)
    tower(mesh, -18.2, 6.4, 2.2, 9.5, 4.2)
    mesh.finish()

    plants = Mesh('Roses')
    rng = generator('roses')

    def on_far_wall(r):
        y = 1.2 + 3.6 * r.random()
        return (-18.9, y, 0.1 + (2.6 + math.sin(y * 3)) * r.random() ** 0.8), (1, 0, 0)

    def on_well(r):
        a = math.radians(20 + 130 * r.random())
        height = 0.02 + 0.75 * r.random() ** 1.6
        return (WELL[0] + 1.02 * math.cos(a), WELL[1] + 1.02 * math.sin(a),
                GROUND + height), (math.cos(a), math.sin(a), 0.3)

    def bush(r):
        d = r.normal(0, 1, 3)
        d /= np.linalg.norm(d)
        d[2] = abs(d[2])
        return np.array((-16.4, -2.6, GROUND + 0.1)) + d * np.array((0.75, 0.75, 0.9)) * (0.75
            + 0.25 * r.random()), d

    ivy(plants, rng, on_far_wall, 620, 0.17)
    ivy(plants, rng, on_well, 150, 0.09)
    ivy(plants, rng, bush, 480, 0.16)
    plants.finish()


def make_backdrop():
    """Hills and summer sky behind the courtyard, as a painted screen that the sun lights: no
    emitter."""
    mesh = Mesh('Courtyard Sky')
    mesh.quad((-27, -24, -3), (-27, 24, -3), (-27, 24, 33), (-27, -24, 33), 'far sky',
              uv=[(0.30, 0), (1.05, 0), (1.05, 1), (0.30, 1)])
    mesh.finish()
