# SPDX-License-Identifier: Apache-2.0
"""Sculpture: the rearing bronze horse, a marble bust, and the suit of armour."""
import math

import numpy as np

from .lights import make_spot
from .mesh import Mesh, catmull_rom, translation, turn, turn_z
from .sculpt import Clay

HORSE = (-4.5, -2.1)


def horse_clay(step):
    """A horse in levade facing +x, about 1.35 m high, standing on z = 0."""
    c = Clay((-0.72, -0.30, -0.06), (0.86, 0.30, 1.62), step)
    c.ball((-0.26, 0, 0.56), (0.20, 0.165, 0.20), 0.02)                                   # croup
    c.limb([(-0.24, 0, 0.60), (-0.02, 0, 0.77), (0.17, 0, 0.95)], [0.170, 0.172, 0.160], 0.10)
    c.ball((0.21, 0, 0.96), (0.155, 0.135, 0.18), 0.08)                                   # chest
    c.limb([(0.22, 0, 1.03), (0.30, 0, 1.20), (0.37, 0, 1.33), (0.44, 0, 1.395)],
           [0.145, 0.105, 0.080, 0.070], 0.08, 0.72)
    c.ball((0.47, 0, 1.36), (0.075, 0.058, 0.085), 0.04)                                  # cheek
    c.limb([(0.46, 0, 1.40), (0.57, 0, 1.27), (0.635, 0, 1.185)], [0.062, 0.050, 0.043], 0.04, 0.82)
    c.ball((0.645, 0, 1.172), (0.042, 0.040, 0.042), 0.03)                                # muzzle
    for side in (-1, 1):
        c.limb([(0.415, side * 0.034, 1.44), (0.425, side * 0.044, 1.51)], [0.024, 0.006],
               0.015)      # ears
        c.carve((0.668, side * 0.026, 1.182), (0.012, 0.009, 0.014), 0.01)
        c.ball((0.515, side * 0.048, 1.372), (0.018, 0.012, 0.015), 0.012)                # eyes
        c.ball((0.23, side * 0.115, 0.90), (0.085, 0.055, 0.14), 0.06,
               -20)               # shoulders
        fold = 0.05 * side
        c.limb([(0.25, side * 0.115, 0.86), (0.42 + fold, side * 0.13, 0.83 + fold),
                (0.56 + fold, side * 0.125, 0.90 + 1.3 * fold)],
               [0.080, 0.052, 0.044], 0.04)
        knee = np.array((0.56 + fold, side * 0.125, 0.90 + 1.3 * fold))
        c.limb([knee, knee + (-0.02, 0, -0.15), knee + (-0.07, 0, -0.27), knee + (-0.115, 0,
            -0.325)], [0.042, 0.030, 0.029, 0.026], 0.02)
        c.limb([knee + (-0.105, 0, -0.31), knee + (-0.155, 0, -0.365)], [0.030, 0.042],
               0.012)           # hoof
        c.ball((-0.25, side * 0.10, 0.50), (0.165, 0.085, 0.20), 0.06, 15)                # haunch
        back = -0.05 * side
        c.limb([(-0.20, side * 0.12, 0.44), (-0.08 + back, side * 0.135, 0.33),
                (-0.20 + back, side * 0.13, 0.235), (-0.285 + back, side * 0.13, 0.19)],
               [0.115, 0.082, 0.058, 0.046], 0.05)
        c.limb([(-0.285 + back, side * 0.13, 0.19), (-0.245 + back, side * 0.13, 0.11),
                (-0.215 + back, side * 0.13, 0.055)], [0.044, 0.033, 0.032], 0.025)
        c.limb([(-0.205 + back, side * 0.13, 0.045), (-0.175 + back, side * 0.13, 0.018)],
               [0.036, 0.046], 0.015)
    tail = catmull_rom([(-0.42, 0, 0.60), (-0.53, 0.01, 0.56), (-0.60, 0.03, 0.40),
                        (-0.57, 0.02, 0.22), (-0.48, -0.02, 0.08), (-0.38, -0.05, 0.02)], 5)
    radii = [0.038 + 0.030 * math.sin(math.pi * i / (len(tail) - 1)) for i in range(len(tail))]
    c.limb(tail, radii, 0.03)
    for k in range(9):  # mane in locks
        t = k / 8
        root = np.array((0.425 - 0.24 * t, 0.0, 1.455 - 0.335 * t))
        sway = 0.02 * math.sin(k * 2.1)
        lock = [root, root + (-0.055, 0.045 + sway, -0.01), root + (-0.075, 0.085 + sway, -0.085),
                root + (-0.05 - sway, 0.098, -0.165)]
        c.limb(lock, [0.030, 0.032, 0.024, 0.010], 0.016)
    c.limb([(0.445, 0.0, 1.465), (0.50, 0.012, 1.445), (0.535, 0.018, 1.385)],
           [0.022, 0.02, 0.008], 0.012)       # forelock
    strands = 0.0035 * np.sin((c.z * 90 + c.y * 60 + c.x * 40)) * (c.x < -0.40)
    c.groove(strands)
    rock = 0.012 * np.sin(c.x * 23 + 1) * np.sin(c.y * 27) + 0.006 * np.sin(c.x * 61) * np.sin(c.y
        * 53 + 2)
    base = np.maximum(np.hypot((c.x + 0.22) / 0.46, c.y / 0.235) * 0.235 - 0.235,
                      np.abs(c.z + 0.03) - 0.035 - rock)
    c.join(base, 0.02)
    return c


def make_horse():
    pedestal = Mesh('Pedestal')
    pedestal.transform = translation(*HORSE, 0) @ turn_z(-28)
    w, d = 0.62, 0.36
    for grow, low, high in ((0.10, 0.0, 0.10), (0.07, 0.10, 0.15), (0.0, 0.15, 0.86),
                            (0.045, 0.86, 0.90), (0.08, 0.90, 0.97)):
        pedestal.box((-w - grow, -d - grow, low), (w + grow, d + grow, high), 'marble', 1.2)
    pedestal.box((-0.20, -d - 0.012, 0.42), (0.20, -d, 0.60), 'brass')
    pedestal.finish(bevel=0.012)
    horse = Mesh('Horse')
    horse.transform = pedestal.transform @ translation(0.06, 0, 1.035) @ turn_z(0)
    vertices, faces = horse_clay(0.0115).skin(2)
    horse.surface(vertices, faces, 'bronze', scale=0.8)
    make_spot('Light Horse', (-3.4, 0.2, 4.6), (HORSE[0], HORSE[1], 1.6), 13.0, 20,
              (1.0, 0.88, 0.72), 0.6)
    horse.finish(auto_smooth=180, decimate=0.24, location=(*HORSE, 0.97))


def bust_clay(step):
    """A bearded king's head and shoulders facing -y, 0.62 m high."""
    c = Clay((-0.32, -0.24, -0.02), (0.32, 0.24, 0.70), step)
    c.ball((0, 0.02, 0.50), (0.088, 0.108, 0.115), 0.02)                                  # skull
    c.ball((0, -0.035, 0.455), (0.070, 0.075, 0.095), 0.03)                               # face
    c.limb([(0, -0.085, 0.515), (0, -0.118, 0.462)], [0.013, 0.019], 0.016)               # nose
    c.limb([(-0.045, -0.083, 0.523), (0, -0.093, 0.520), (0.045, -0.083, 0.523)],
           [0.013, 0.012, 0.013], 0.016)
    for side in (-1, 1):
        c.carve((side * 0.033, -0.105, 0.500), (0.020, 0.020, 0.013), 0.016)
        c.ball((side * 0.033, -0.079, 0.499), (0.014, 0.012, 0.012), 0.004)
        c.ball((side * 0.040, -0.075, 0.462), (0.026, 0.022, 0.022),
               0.02)                # cheekbones
        c.ball((side * 0.088, 0.005, 0.485), (0.012, 0.020, 0.030), 0.012)                # ears
        c.limb([(side * 0.008, -0.106, 0.436), (side * 0.034, -0.096, 0.428),
                (side * 0.058, -0.078, 0.405)], [0.012, 0.012, 0.007], 0.008)
    c.limb([(-0.016, -0.100, 0.418), (0.016, -0.100, 0.418)], [0.009, 0.009], 0.006)
    for k in range(-3,
                   4):                                                                # beard locks
        a = k / 3
        c.limb([(a * 0.062, -0.075 + 0.02 * abs(a), 0.415 + 0.02 * abs(a)),
                (a * 0.055, -0.092 + 0.02 * abs(a), 0.36 + 0.02 * abs(a)),
                (a * 0.040, -0.085 + 0.01 * abs(a), 0.305 + 0.035 * abs(a))],
                    [0.024, 0.022, 0.008], 0.012)
    for k in range(13):  # hair to the neck
        a = math.radians(-120 + 240 * k / 12)
        x, y = math.sin(a) * 0.088, 0.03 + math.cos(a) * 0.095
        c.limb([(x * 0.75, y * 0.8, 0.585), (x * 1.08, y * 1.05, 0.52), (x * 1.12, y * 1.1, 0.43),
                (x * 0.95, y + 0.005, 0.355)], [0.022, 0.026, 0.026, 0.014], 0.012)
    c.limb([(0, 0.02, 0.40), (0, 0.02, 0.25)], [0.066, 0.078], 0.03)                      # neck
    c.limb([(-0.17, 0.03, 0.215), (0, 0.0, 0.25), (0.17, 0.03, 0.215)], [0.088, 0.098, 0.088], 0.05)
    c.ball((0, -0.01, 0.16), (0.17, 0.115, 0.15), 0.06)
    for side in (-1,
                 1):                                                                  # cloak folds
        for k in range(4):
            c.limb([(side * (0.05 + 0.045 * k), -0.05, 0.29 - 0.01 * k), (side * (0.02 + 0.05 * k),
                -0.112 + 0.008 * k, 0.17),
                    (side * (0.0 + 0.04 * k), -0.10 + 0.01 * k, 0.06)], [0.020, 0.020, 0.014],
                        0.014)
    c.ball((0.105, -0.095, 0.235), (0.028, 0.02, 0.028), 0.008)                           # clasp
    crown = np.abs(np.hypot(c.x, (c.y - 0.02) * 0.86) - 0.096) - 0.007
    angle = np.arctan2(c.x, c.y - 0.02)
    height = 0.582 + 0.030 * np.abs(np.cos(angle * 4)) ** 1.5
    c.join(np.maximum(crown, np.maximum(c.z - height, 0.545 - c.z)), 0.004)
    c.cut_below(0.045)
    c.limb([(0, 0, 0.055), (0, 0, 0.0)], [0.075, 0.088], 0.02)
    c.cut_below(0.0)
    return c


def make_bust(x, y, angle):
    column = Mesh('Column')
    column.transform = translation(x, y, 0)
    column.prism([(-0.24, -0.24), (0.24, -0.24), (0.24, 0.24), (-0.24, 0.24)], 0, 0.09, 'stone',
                 1.5)
    column.lathe([(0.235, 0.09), (0.235, 0.13), (0.19, 0.15), (0.205, 0.19), (0.175, 0.22),
                  (0.165, 0.25), (0.15, 1.06), (0.17, 1.07),
                  (0.17, 1.10), (0.21, 1.14), (0.225, 1.17)], 32, 'ashlar', repeat=(0.5, 0.5))
    column.prism([(-0.23, -0.23), (0.23, -0.23), (0.23, 0.23), (-0.23, 0.23)], 1.17, 1.22, 'stone',
                 1.5)
    column.finish(bevel=0.006)
    bust = Mesh('Bust')
    bust.transform = translation(x, y, 1.22) @ turn_z(angle)
    vertices, faces = bust_clay(0.0062).skin(1)
    bust.surface(vertices, faces, 'marble', scale=0.6)
    bust.finish(auto_smooth=180, decimate=0.15, location=(x, y, 1.22))


def oval(cx, cy, z, rx, ry, count=20, front=0.0):
    """A ring; `front` pushes its -y side forward into a keel."""
    ring = []
    for i in range(count):
        a = 2 * math.pi * i / count
        ring.append((cx + rx * math.cos(a), cy + ry * math.sin(a) - front * max(0.0,
            -math.sin(a)) ** 6, z))
    return ring


def plates(mesh, rings, material='steel'):
    mesh.loft(rings, material, caps=True)


def make_armour(x, y, angle, name='Armour'):
    """A field armour on its stand, 1.9 m with the plinth, facing -y before turning, hands on a
    sword."""
    mesh = Mesh(name)
    mesh.transform = translation(x, y, 0) @ turn_z(angle)
    keep = mesh.transform
    mesh.box((-0.42, -0.36, 0.0), (0.42, 0.36, 0.04), 'dark oak', 1.2, 'x')
    mesh.box((-0.38, -0.32, 0.04), (0.38, 0.32, 0.12), 'dark oak', 1.2, 'x')
    mesh.transform = keep @ translation(0, 0, 0.12)
    stand = mesh.transform
    for side in (-1, 1):
        sx = side * 0.115
        mesh.loft([oval(sx, -0.10, 0.0, 0.050, 0.135), oval(sx, -0.10, 0.035, 0.054, 0.135),
                   oval(sx, -0.075, 0.075, 0.046, 0.095),
                   oval(sx, -0.02, 0.115, 0.044, 0.05)],
                       'steel')                                      # sabaton
        for k in range(4):
            mesh.loft([oval(sx, -0.185 + 0.045 * k, 0.034 + 0.012 * k, 0.053, 0.030, 14),
                       oval(sx, -0.175 + 0.045 * k, 0.060 + 0.014 * k, 0.046, 0.024, 14)],
                           'dark steel')
        plates(mesh, [oval(sx, 0, 0.10, 0.047, 0.052), oval(sx, 0.0, 0.16, 0.045, 0.05),
                      oval(sx, 0.012, 0.30, 0.064, 0.072, front=0.012),
                      oval(sx, 0.008, 0.40, 0.058, 0.064, front=0.014), oval(sx, 0, 0.46, 0.052,
                          0.058)])
        mesh.ellipsoid((sx, -0.028, 0.495), (0.062, 0.060, 0.058), 'steel', 16,
                       8)                      # knee
        mesh.ellipsoid((sx + side * 0.055, -0.01, 0.495), (0.018, 0.055, 0.050), 'steel', 12, 6)
        for z in (0.445, 0.545):
            mesh.loft([oval(sx, -0.008, z - 0.016, 0.064, 0.070), oval(sx, -0.008, z + 0.016,
                0.066, 0.072)], 'dark steel')
        plates(mesh, [oval(sx, 0, 0.53, 0.060, 0.066), oval(sx * 1.02, 0, 0.68, 0.078, 0.085,
                                                            front=0.012), oval(sx * 1.02, 0, 0.84,
                                                                0.086, 0.096)])
    for k in range(4):                                                                     # fauld
        z = 0.86 + 0.045 * (3 - k)
        grow = 0.012 * k
        plates(mesh, [oval(0, 0, z - 0.028, 0.195 + grow + 0.012, 0.145 + grow + 0.010, 28),
                      oval(0, 0, z + 0.028, 0.182 + grow, 0.132 + grow, 28)])
    for side in (-1, 1):                                                                   # tassets
        for k in range(4):
            z = 0.80 - 0.05 * k
            plates(mesh, [oval(side * 0.105, -0.055, z - 0.030, 0.094 - 0.004 * k,
                               0.100 - 0.006 * k), oval(side * 0.105, -0.055, z + 0.030,
                                                        0.088 - 0.004 * k, 0.094 - 0.006 * k)])
    plates(mesh, [oval(0, 0, 1.01, 0.168, 0.122, 32), oval(0, -0.005, 1.08, 0.175, 0.130, 32,
                                                           0.012), oval(0, -0.015, 1.19, 0.198,
                                                               0.155, 32, 0.030),
                  oval(0, -0.015, 1.30, 0.208, 0.158, 32, 0.026), oval(0, -0.005, 1.38, 0.190,
                      0.135, 32, 0.012), oval(0, 0.0, 1.44, 0.135, 0.105, 32), oval(0, 0, 1.465,
                          0.085, 0.085, 32)])
    mesh.loft([oval(0, 0, 1.005, 0.176, 0.130, 32), oval(0, 0, 1.025, 0.176, 0.130, 32)], 'leather')
    plates(mesh, [oval(0, 0, 1.455, 0.086, 0.088, 24), oval(0, 0, 1.49, 0.072, 0.076, 24),
                  oval(0, -0.004, 1.535, 0.082, 0.090, 24)])   # gorget
    # Helmet: skull with comb, visor with beak and sights.
    plates(mesh, [oval(0, -0.004, 1.53, 0.084, 0.096, 28, 0.012), oval(0, -0.002, 1.60, 0.092,
        0.110, 28, 0.018), oval(0, 0.0, 1.68, 0.094, 0.116, 28, 0.008),
                  oval(0, 0.004, 1.74, 0.082, 0.104, 28), oval(0, 0.006, 1.785, 0.052, 0.072, 28),
                      oval(0, 0.008, 1.80, 0.012, 0.03, 28)])
    mesh.sweep([(-0.008, 0.0), (0.008, 0.0), (0.0, 0.028)], [(0, -0.10 + 0.004, 1.70),
                                                             (0, -0.06, 1.775), (0, 0.01, 1.80),
                                                                 (0, 0.08, 1.77), (0, 0.115, 1.70)],
               'steel', [(0, -0.7, 0.7), (0, -0.35, 1), (0, 0, 1), (0, 0.35, 1), (0, 0.7, 0.7)],
                   smooth=True)
    mesh.loft([oval(0, -0.022, 1.565, 0.072, 0.098, 28, 0.055), oval(0, -0.022, 1.61, 0.080, 0.108,
                                                                     28, 0.062), oval(0, -0.016,
                                                                         1.655, 0.086, 0.112, 28,
                                                                             0.030)], 'steel')
    mesh.loft([oval(0, -0.018, 1.668, 0.088, 0.114, 28, 0.020), oval(0, -0.014, 1.69, 0.089, 0.114,
                                                                     28, 0.012)], 'steel')
    mesh.loft([oval(0, -0.014, 1.654, 0.083, 0.108, 28, 0.02), oval(0, -0.014, 1.669, 0.083, 0.108,
                                                                    28, 0.02)], 'soot')
    for side in (-1, 1):
        mesh.ellipsoid((side * 0.094, 0.0, 1.655), (0.010, 0.022, 0.022), 'brass', 12, 6)
        for k in range(4):
            mesh.ellipsoid((side * (0.018 + 0.014 * k), -0.165 + 0.016 * k + 0.006 * k * k, 1.60),
                           (0.0035, 0.004, 0.012), 'soot', 6, 4)
    for side in (-1,
                 1):  # arms, hands together in front
        shoulder, elbow, wrist, hand = ((side * 0.235, 0.0, 1.375), (side * 0.295, -0.06, 1.13),
                                        (side * 0.12, -0.27, 1.04), (side * 0.035, -0.315, 1.02))
        for k in range(4):
            mesh.transform = stand @ translation(side * (0.215 + 0.020 * k), -0.005,
                                                 1.405 - 0.042 * k) @ turn(side * (28 + 8 * k), 'Y')
            mesh.ellipsoid((0, 0, 0), (0.082 - 0.004 * k, 0.098 - 0.006 * k, 0.040), 'steel', 18, 8)
        mesh.transform = stand
        mesh.tube([shoulder, elbow], [0.058, 0.046], 'steel', 16)
        mesh.ellipsoid(elbow, (0.056, 0.056, 0.056), 'steel', 16, 8)
        mesh.ellipsoid((elbow[0] + side * 0.03, elbow[1] + 0.012, elbow[2]), (0.022, 0.05, 0.055),
                       'steel', 12, 6)
        mesh.tube([elbow, tuple(e + (w - e) * 0.45 for e, w in zip(elbow, wrist)), wrist],
                  [0.044, 0.052, 0.036], 'steel', 16)
        mesh.tube([tuple(e + (w - e) * 0.72 for e, w in zip(elbow, wrist)), wrist], [0.062, 0.040],
                  'steel', 16)
        mesh.ellipsoid(hand, (0.048, 0.042, 0.034), 'dark steel', 14, 8)
        for k in range(4):
            mesh.ellipsoid((hand[0] - side * 0.02, hand[1] - 0.035, hand[2] + 0.024 - 0.016 * k),
                           (0.024, 0.014, 0.0095), 'steel', 8, 5)
    mesh.transform = stand @ translation(0, -0.325,
                                         0)                                     # the sword
    mesh.loft([[(-0.004, 0, 0.0), (0, -0.002, 0.0), (0.004, 0, 0.0), (0, 0.002, 0.0)],
               [(-0.022, 0, 0.10), (0, -0.006, 0.10), (0.022, 0, 0.10), (0, 0.006, 0.10)],
               [(-0.028, 0, 0.92), (0, -0.007, 0.92), (0.028, 0, 0.92), (0, 0.007, 0.92)]],
                   'silver', smooth=False)
    mesh.tube([(-0.14, 0, 0.925), (-0.07, 0, 0.93), (0.07, 0, 0.93), (0.14, 0, 0.925)],
              [0.014, 0.011, 0.011, 0.014], 'brass', 10)
    mesh.tube([(0, 0, 0.93), (0, 0, 1.13)], 0.015, 'leather', 10)
    mesh.ellipsoid((0, 0, 1.155), (0.032, 0.022, 0.032), 'brass', 14, 8)
    mesh.transform = keep
    mesh.finish(location=(x, y, 0))
