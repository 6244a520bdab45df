# SPDX-License-Identifier: Apache-2.0
"""The museum's treasures and the vitrines they stand in."""
import math

import numpy as np
from mathutils import Vector

from .lights import make_spot
from .mesh import Mesh, catmull_rom, translation, turn, turn_z

PLINTH = 0.02       # the velvet floor's thickness


def vitrine(name, x, y, angle, width, depth, base, top, cloth='green velvet', lamps=1, candela=2.4,
            desk=False):
    """A dark plinth and a glass case with brass edges; lamps in its lid, or, on a `desk` to look
    into from above, under its front edge. Returns its floor's frame."""
    place = translation(x, y, 0) @ turn_z(angle)
    case, glass = Mesh('Vitrine ' + name), Mesh('Glass ' + name)
    case.transform = glass.transform = place
    w, d = width / 2, depth / 2
    case.box((-w + 0.03, -d + 0.03, 0.0), (w - 0.03, d - 0.03, 0.07), 'iron')
    case.box((-w, -d, 0.07), (w, d, base - 0.02), 'plinth')
    case.box((-w + 0.018, -d + 0.018, base - 0.01), (w - 0.018, d - 0.018, base + PLINTH), cloth)
    if not desk:
        case.box((-w, -d, top + 0.012), (w, d, top + 0.09), 'plinth')
        case.box((-w - 0.012, -d - 0.012, top - 0.008), (w + 0.012, d + 0.012, top + 0.016),
                 'brass')
    case.box((-w - 0.012, -d - 0.012, base - 0.03), (w + 0.012, d + 0.012, base), 'brass')
    for sx in (-1, 1):
        for sy in (-1, 1):
            case.box((sx * w - 0.010, sy * d - 0.010, base), (sx * w + 0.010, sy * d + 0.010, top),
                     'brass')
    for side in (0, 180):
        case.transform = place @ turn_z(side)
        y0, z0 = -d - 0.002, base - 0.20
        case.quad((-0.085, y0, z0), (0.085, y0, z0), (0.085, y0, z0 + 0.117),
                  (-0.085, y0, z0 + 0.117), 'label', uv=[(0, 0), (1, 0), (1, 1), (0, 1)])
    if desk:
        for side in (-1, 1):
            case.box((-w, side * d - 0.010, top - 0.010), (w, side * d + 0.010, top + 0.010),
                     'brass')
            case.box((side * w - 0.010, -d, top - 0.010), (side * w + 0.010, d, top + 0.010),
                     'brass')
        glass.quad((-w, -d, top), (w, -d, top), (w, d, top), (-w, d, top), 'glass')
    g = 0.003
    corners = [(-w + g, -d + g), (w - g, -d + g), (w - g, d - g), (-w + g, d - g)]
    for a, b in zip(corners, corners[1:] + corners[:1]):
        glass.quad((*a, base), (*b, base), (*b, top), (*a, top), 'glass')
    case.finish(bevel=0.003, location=(x, y, 0))
    glass.finish(location=(x, y, base))
    for i in range(lamps):
        s = (i - (lamps - 1) / 2) * width * 0.6
        make_spot(f'Lamp {name} {i + 1}', place @ Vector((s, -d * (0.9 if desk else 0.45),
                                                          top - 0.03)),
                  place @ Vector((s * 0.8, 0.0, base)), candela / lamps, 50 if desk else 44)
    return place @ translation(0, 0, base + PLINTH)


def cushion(mesh, size, height, material):
    """A square velvet cushion with tasselled corners."""
    n, top, bottom = 20, [], []
    for j in range(n + 1):
        v = -1 + 2 * j / n
        line_top, line_low = [], []
        for i in range(n + 1):
            u = -1 + 2 * i / n
            pinch = 1 - 0.10 * (1 - u * u) * abs(v) - 0.10 * (1 - v * v) * abs(u)
            bulge = ((1 - u ** 4) * (1 - v ** 4)) ** 0.6
            dent = 0.35 * math.exp(-(u * u + v * v) / 0.18)
            line_top.append((size / 2 * u * pinch, size / 2 * v * pinch,
                             height * (0.45 + 0.55 * bulge * (1 - dent))))
            line_low.append((size / 2 * u * pinch, size / 2 * v * pinch,
                             height * 0.45 * (1 - bulge)))
        top.append(line_top)
        bottom.append(line_low[::-1])
    mesh.grid(top, material)
    mesh.grid(bottom, material)
    edge = [top[0][i] for i in range(n)] + [top[j][n] for j in range(n)] + [top[n][n - i]
        for i in range(n)] + [top[n - j][0] for j in range(n)]
    mesh.tube(edge, 0.006, 'gilt', 6, closed=True)
    keep = mesh.transform
    for sx in (-1, 1):
        for sy in (-1, 1):
            mesh.transform = keep @ translation(sx * (size / 2 + 0.012), sy * (size / 2 + 0.012),
                                                height * 0.36)
            mesh.ellipsoid((0, 0, 0), (0.014, 0.014, 0.014), 'gilt', 10, 6)
            mesh.lathe([(0.015, -0.06), (0.011, -0.012), (0.0, -0.01)], 10, 'gilt')
    mesh.transform = keep


def make_crown(place):
    mesh = Mesh('Crown')
    mesh.transform = place
    cushion(mesh, 0.42, 0.12, 'red velvet')
    base = place @ translation(0, 0, 0.082)
    mesh.transform = base
    r, n = 0.100, 96
    mesh.lathe([(r - 0.004, 0.0), (r + 0.004, 0.0), (r + 0.006, 0.004), (r + 0.004, 0.008),
                (r + 0.003, 0.036), (r + 0.006, 0.040), (r + 0.004, 0.044),
                (r - 0.002, 0.044), (r - 0.004, 0.03), (r - 0.004, 0.0)], n, 'gold')
    gems = ('ruby', 'sapphire', 'emerald', 'sapphire')
    for k in range(16):
        mesh.transform = base @ turn_z(360 * k / 16) @ translation(r + 0.005, 0, 0.022)
        if k % 2 == 0:
            gem(mesh, gems[k // 2 % 4], 0.0115)
        else:
            mesh.ellipsoid((0, 0, 0), (0.0055, 0.0055, 0.0055), 'pearl', 10, 6)
    for k in range(8):                                                         # lilies and points
        mesh.transform = base @ turn_z(45 * k + 22.5) @ translation(r + 0.001, 0, 0.042)
        tall = k % 2 == 0
        lily(mesh, 0.072 if tall else 0.045, tall)
    for k in range(4):                                                         # arches
        mesh.transform = base @ turn_z(90 * k + 22.5)
        arch = catmull_rom([(r, 0, 0.10), (r - 0.004, 0, 0.135), (0.062, 0, 0.165),
                            (0.022, 0, 0.158), (0.0, 0, 0.150)], 6)
        mesh.tube(arch, [0.0065 - 0.002 * i / (len(arch) - 1) for i in range(len(arch))], 'gold', 8)
        for p in arch[2:-3:3]:
            mesh.ellipsoid((p[0] + 0.004, 0, p[2] + 0.005), (0.0048, 0.0048, 0.0048), 'pearl', 8, 5)
    mesh.transform = base
    mesh.lathe([(0.088, 0.012), (0.090, 0.05), (0.080, 0.10), (0.055, 0.132), (0.02, 0.145),
                (0.0, 0.146)], 32, 'blue velvet')
    mesh.ellipsoid((0, 0, 0.170), (0.016, 0.016, 0.016), 'gold', 16, 10)
    mesh.box((-0.0035, -0.0035, 0.184), (0.0035, 0.0035, 0.222), 'gold')
    mesh.box((-0.014, -0.0032, 0.203), (0.014, 0.0032, 0.210), 'gold')
    mesh.finish(location=place.translation)


def gem(mesh, material, size):
    """A brilliant set in a gold collar, facing +x."""
    keep = mesh.transform
    mesh.transform = keep @ turn(90, 'Y')
    mesh.lathe([(size * 1.25, -0.003), (size * 1.25, 0.002), (size * 1.0, 0.0035)], 16, 'gold')
    mesh.lathe([(size, 0.002), (size * 0.72, 0.0065), (0.0, 0.0068)], 8, material, smooth=False)
    mesh.transform = keep


def lily(mesh, height, tall):
    """A fleur-de-lis of gold leaf facing +x."""
    mesh.ellipsoid((0, 0, height * 0.62), (0.0045, height * 0.16, height * 0.42), 'gold', 12, 8)
    if tall:
        for side in (-1, 1):
            curl = catmull_rom([(0, 0, height * 0.18), (0.001, side * height * 0.22,
                                                        height * 0.42),
                                                            (0.002, side * height * 0.42,
                                                             height * 0.62),
                                (0.002, side * height * 0.52, height * 0.50),
                                    (0.001, side * height * 0.44, height * 0.40)], 4)
            mesh.tube(curl, [0.0045, 0.0055, 0.006, 0.006, 0.0055, 0.005, 0.005, 0.005, 0.0045,
                             0.0045, 0.004, 0.004, 0.0035, 0.003, 0.003, 0.0028, 0.0025], 'gold', 7)
        mesh.box((-0.005, -height * 0.26, height * 0.24), (0.006, height * 0.26, height * 0.31),
                 'gold')
        mesh.ellipsoid((0.005, 0, height * 0.55), (0.004, 0.006, 0.006), 'ruby', 10, 6)
    mesh.ellipsoid((0, 0, height * 1.08), (0.006, 0.006, 0.006), 'pearl', 10, 6)


def make_goblet(place):
    mesh = Mesh('Goblet')
    mesh.transform = place @ translation(-0.02, 0.02, 0)
    base = mesh.transform
    mesh.lathe([(0.0, 0.0), (0.072, 0.0), (0.075, 0.006), (0.070, 0.014), (0.050, 0.022),
                (0.024, 0.035), (0.014, 0.055), (0.013, 0.080), (0.024, 0.088),
                (0.030, 0.100), (0.024, 0.112), (0.013, 0.120), (0.012, 0.140), (0.020, 0.150),
                    (0.045, 0.165), (0.060, 0.190), (0.064, 0.225),
                (0.062, 0.262), (0.066, 0.272), (0.064, 0.275), (0.058, 0.262), (0.060, 0.225),
                    (0.056, 0.193), (0.040, 0.170), (0.0, 0.162)], 48, 'gold')
    for k in range(8):
        mesh.transform = base @ turn_z(45 * k) @ translation(0.0635, 0, 0.232)
        if k % 2 == 0:
            gem(mesh, ('ruby', 'emerald', 'sapphire', 'emerald')[k // 2], 0.012)
        else:
            mesh.ellipsoid((0.001, 0, 0), (0.006, 0.010, 0.018), 'silver', 12, 8)
        mesh.transform = base @ turn_z(45 * k + 22.5) @ translation(0.052, 0, 0.18)
        mesh.ellipsoid((0, 0, 0), (0.012, 0.016, 0.024), 'gold', 12, 8)
        mesh.transform = base @ turn_z(45 * k) @ translation(0.029, 0, 0.100)
        mesh.ellipsoid((0, 0, 0), (0.006, 0.006, 0.006), 'ruby', 8, 5)
    mesh.finish(location=base.translation)


def make_jug(place):
    mesh = Mesh('Jug')
    mesh.transform = place @ translation(0.0, 0.0, 0) @ turn_z(25)
    outer = [(0.062, 0.0), (0.066, 0.006), (0.062, 0.014), (0.085, 0.05), (0.108, 0.10),
             (0.112, 0.145), (0.098, 0.195), (0.066, 0.235), (0.052, 0.262),
             (0.052, 0.295), (0.060, 0.325), (0.062, 0.333)]
    mesh.lathe(outer, 48, 'jug')
    mesh.lathe([(0.062, 0.333), (0.057, 0.330), (0.047, 0.295), (0.046, 0.262), (0.06, 0.23)], 48,
               'pearl')
    mesh.lathe([(0.0, 0.0), (0.062, 0.0)][::-1], 48, 'pearl')
    handle = catmull_rom([(-0.056, 0, 0.312), (-0.098, 0, 0.318), (-0.128, 0, 0.27),
                          (-0.128, 0, 0.215), (-0.098, 0, 0.178)], 6)
    mesh.tube(handle, [0.012 - 0.003 * i / (len(handle) - 1) for i in range(len(handle))], 'pearl',
              10)
    mesh.finish(location=place.translation)


def make_sword(place):
    """A hand-and-a-half sword on two velvet cradles, blade along x."""
    mesh = Mesh('Sword')
    mesh.transform = place
    for x in (-0.38, 0.34):
        mesh.box((x - 0.03, -0.09, 0), (x + 0.03, 0.09, 0.015), 'dark oak', 1.2, 'y')
        mesh.box((x - 0.012, -0.05, 0.015), (x + 0.012, 0.05, 0.075), 'dark oak', 1.2, 'z')
    mesh.transform = place @ translation(0, 0, 0.095) @ turn(38, 'X')
    rings = []
    for x, w, t in ((-0.30, 0.027, 0.0036), (0.10, 0.023, 0.0033), (0.42, 0.018, 0.0026),
                    (0.52, 0.011, 0.002), (0.565, 0.001, 0.0004)):
        rings.append([(x, -w, 0), (x, -w * 0.28, t), (x, -w * 0.10, t * 0.55),
                      (x, w * 0.10, t * 0.55), (x, w * 0.28, t), (x, w, 0),
                      (x, w * 0.28, -t), (x, w * 0.10, -t * 0.55), (x, -w * 0.10, -t * 0.55),
                          (x, -w * 0.28, -t)][::-1])
    mesh.loft(rings, 'silver', smooth=False)
    guard = catmull_rom([(-0.292, -0.125, 0), (-0.312, -0.06, 0), (-0.315, 0, 0),
                         (-0.312, 0.06, 0), (-0.292, 0.125, 0)], 5)
    mesh.tube(guard, [0.010 + 0.004 * abs(i - 10) / 10 for i in range(len(guard))], 'gold', 10)
    for side in (-1, 1):
        mesh.ellipsoid((-0.288, side * 0.132, 0), (0.017, 0.014, 0.014), 'gold', 12, 8)
    grip = [(-0.32 - 0.20 * i / 40, 0, 0) for i in range(41)]
    mesh.tube(grip, [0.0155 - 0.003 * abs(i - 20) / 20 + (0.0012 if i % 4 < 2 else 0)
                     for i in range(41)], 'leather', 12)
    mesh.tube([(-0.43, 0, 0), (-0.437, 0, 0)], 0.017, 'gold', 12)
    mesh.ellipsoid((-0.548, 0, 0), (0.032, 0.032, 0.017), 'gold', 20, 10)
    mesh.ellipsoid((-0.548, 0, 0.013), (0.013, 0.013, 0.008), 'ruby', 14, 8)
    mesh.finish(location=place.translation)


def make_book(place):
    """An open codex on a sloping oak stand, readable from -y."""
    mesh = Mesh('Book')
    mesh.transform = place @ translation(0, 0.02, 0.075) @ turn(22, 'X')
    mesh.box((-0.30, -0.19, -0.03), (0.30, 0.19, -0.012), 'dark oak', 1.2, 'x')
    mesh.box((-0.30, -0.205, -0.03), (0.30, -0.188, 0.012), 'dark oak', 1.2, 'x')
    w, d, n = 0.265, 0.175, 18
    for side in (-1, 1):
        mesh.box(*sorted_box((0, -d - 0.006, -0.012), (side * (w + 0.012), d + 0.006, -0.006)),
                 'leather')
        lift = lambda u: 0.002 + 0.046 * (math.sin(math.pi * min(1.0, u ** 0.55)) ** 0.9
                                          * (1 - 0.55 * u) if u > 0 else 0) + 0.010 * (1 - u)
        rows = [[(side * w * (i / n), y, lift(i / n)) for i in (range(n + 1) if side > 0
                                                                else range(n, -1, -1))]
                                                                    for y in (-d, 0, d)]
        mesh.grid(rows, 'book page', repeat=(0.5, 1), offset=(0.5 if side > 0 else 0.0, 0))
        for y, flip in ((-d, 1), (d, -1)):
            for i in range(n):
                a, b = side * w * i / n, side * w * (i + 1) / n
                quad = [(a, y, -0.006), (b, y, -0.006), (b, y, lift((i + 1) / n)),
                        (a, y, lift(i / n))]
                mesh.quad(*quad[::flip * side], 'paper')
        quad = [(side * w, -d, -0.006), (side * w, d, -0.006), (side * w, d, lift(1.0)),
                (side * w, -d, lift(1.0))]
        mesh.quad(*quad[::side], 'paper')
    ribbon = catmull_rom([(0.004, d, 0.012), (0.012, 0.05, 0.016), (0.006, -0.10, 0.016),
                          (0.03, -d - 0.004, 0.012), (0.05, -d - 0.05, -0.035)], 5)
    mesh.sweep([(-0.006, 0.0), (0.006, 0.0), (0.006, 0.001), (-0.006, 0.001)], ribbon,
               'red velvet', [(0, 0, 1)], scale=1)
    mesh.finish(location=place.translation)


def sorted_box(a, b):
    return tuple(min(p, q) for p, q in zip(a, b)), tuple(max(p, q) for p, q in zip(a, b))


def make_helmet(place):
    """A great helm with a brass cross and breaths."""
    mesh = Mesh('Helmet')
    mesh.transform = place @ turn_z(-18)
    base = mesh.transform
    mesh.lathe([(0.0, 0.0), (0.085, 0.0), (0.085, 0.015), (0.03, 0.03), (0.022, 0.14),
                (0.0, 0.15)], 24, 'dark oak')
    rings = [oval_ring(z, rx, ry, keel) for z, rx, ry, keel in ((0.07, 0.112, 0.140, 0.020),
                                                                (0.12, 0.110, 0.136, 0.020),
                                                                    (0.20, 0.107, 0.130, 0.016),
             (0.252, 0.106, 0.128, 0.012), (0.256, 0.101, 0.122, 0.010), (0.32, 0.093, 0.112,
                 0.004), (0.352, 0.078, 0.094, 0.0), (0.364, 0.04, 0.05, 0.0),
                     (0.366, 0.005, 0.006, 0.0))]
    mesh.loft(rings, 'steel', caps=False)
    mesh.loft([[(p[0] * 0.96, p[1] * 0.96, p[2]) for p in ring] for ring in rings[::-1]], 'soot',
              caps=False)
    front = lambda z, a: surface_point(z, a)
    mesh.sweep([(-0.010, -0.003), (0.010, -0.003), (0.010, 0.004), (-0.010, 0.004)],
               [front(z, 0) for z in (0.07, 0.12, 0.20, 0.252, 0.32)], 'brass', [(0, -1, 0.1)])
    for side in (-1, 1):
        arc = [front(0.252, side * a) for a in (0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2)]
        mesh.sweep([(-0.011, -0.003), (0.011, -0.003), (0.011, 0.004), (-0.011, 0.004)],
                   arc[::side], 'brass', [(math.sin(side * a), -math.cos(a), 0) for a in (0.0, 0.2,
                       0.4, 0.6, 0.8, 1.0, 1.2)][::side])
        sight = [front(0.234, side * a) for a in (0.13, 0.3, 0.5, 0.7)]
        mesh.sweep([(-0.005, -0.002), (0.005, -0.002), (0.005, 0.0025), (-0.005, 0.0025)],
                   sight[::side], 'soot', [(math.sin(side * a), -math.cos(a), 0) for a in (0.13,
                       0.3, 0.5, 0.7)][::side])
        for row in range(4):
            for k in range(5):
                p = front(0.11 + 0.024 * row, side * (0.20 + 0.12 * k + 0.06 * (row % 2)))
                mesh.ellipsoid(p, (0.0042, 0.0042, 0.0042), 'soot', 8, 4)
    for k in range(22):
        a = 2 * math.pi * k / 22
        p = surface_point(0.262, a)
        mesh.ellipsoid(p, (0.004, 0.004, 0.004), 'brass', 6, 4)
    mesh.finish(location=place.translation)


def oval_ring(z, rx, ry, keel, count=40):
    return [(rx * math.cos(a), ry * math.sin(a) - keel * max(0.0, -math.sin(a)) ** 8,
             z) for a in (2 * math.pi * i / count for i in range(count))]


def surface_point(z, a):
    """A point on the helm's outside, a = 0 in front (-y), growing towards +x."""
    zs, rx, ry, keel = zip((0.07, 0.112, 0.140, 0.020), (0.12, 0.110, 0.136, 0.020),
                           (0.20, 0.107, 0.130, 0.016), (0.252, 0.106, 0.128, 0.012),
                               (0.32, 0.093, 0.112, 0.004))
    r = [float(np.interp(z, zs, values)) for values in (rx, ry, keel)]
    return (r[0] * math.sin(a), -r[1] * math.cos(a) - r[2] * max(0.0, math.cos(a)) ** 8, z)


def make_ammonite(place):
    """A polished ammonite, a coil of ribbed tube, on a brass stand."""
    mesh = Mesh('Ammonite')
    mesh.transform = place @ translation(0, 0, 0.21) @ turn(-12, 'X')
    turns, steps, around = 3.6, 44, 12
    rings = []
    for i in range(int(turns * steps) + 1):
        a = 2 * math.pi * i / steps
        scale = math.exp(-0.158 * (turns * 2 * math.pi - a)) * 0.165
        rib = 1 + 0.075 * math.sin(a * 17) ** 2
        centre, tube = scale * 0.72, scale * 0.345 * rib
        ring = []
        for k in range(around):
            b = 2 * math.pi * k / around
            radial, lift = centre + tube * math.cos(b), tube * 0.80 * math.sin(b)
            ring.append((radial * math.cos(a), lift, radial * math.sin(a)))
        rings.append(ring)
    mesh.loft([ring[::-1] for ring in rings], 'fossil', repeat=(1, 14))
    mesh.transform = place
    mesh.lathe([(0.0, 0.0), (0.075, 0.0), (0.075, 0.012), (0.016, 0.022), (0.011, 0.05),
                (0.0, 0.052)], 24, 'brass')
    for side in (-1, 1):
        mesh.tube(catmull_rom([(0, 0, 0.045), (side * 0.05, 0.0, 0.055), (side * 0.095, 0.0, 0.09),
                               (side * 0.11, -0.012, 0.12)], 5), 0.006, 'brass', 8)
    mesh.finish(location=place.translation)


def make_treasury():
    make_crown(vitrine('Crown', -1.4, 0.9, 0, 0.72, 0.72, 1.02, 1.72, 'blue velvet', lamps=1,
                       candela=2.6))
    make_goblet(vitrine('Goblet', 4.0, 3.35, 0, 0.56, 0.56, 1.05, 1.70, 'green velvet'))
    make_helmet(vitrine('Helmet', 0.0, 3.35, 0, 0.60, 0.60, 1.00, 1.70, 'red velvet'))
    make_ammonite(vitrine('Ammonite', -4.0, 3.35, 0, 0.60, 0.60, 1.00, 1.68, 'green velvet'))
    make_sword(vitrine('Sword', -4.9, 0.95, 0, 1.50, 0.56, 0.88, 1.26, 'red velvet', candela=2.6,
                       desk=True))
    make_book(vitrine('Book', 4.9, -2.6, 208, 0.86, 0.66, 0.86, 1.26, 'green velvet', candela=1.4,
                      desk=True))
    make_jug(vitrine('Jug', -7.3, -1.95, 90, 0.50, 0.50, 1.02, 1.66, 'blue velvet'))
