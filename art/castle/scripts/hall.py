# SPDX-License-Identifier: Apache-2.0
"""The great hall itself: floor, walls, windows, vault, panelling, doors.

Inside: x -8..8, y -4.5..4.5 (windows at +4.5), z 0..6. Four bays of 4 m with a ribbed vault.
"""
import math

from .mesh import Mesh, bezier, pointed_arch, translation, turn_z

LENGTH, WIDTH = 16.0, 9.0
BAYS = (-6.0, -2.0, 2.0, 6.0)
SPRING, CROWN = 3.3, 5.9
WINDOW_DEPTH, WINDOW_HALF = 0.34, 1.02   # shallow: deep bright jambs are noise, they are no lamps
SKY_HORIZON = 0.16            # where the horizon lies in the sky's picture
FOOT = -0.001


class Opening:
    """A pointed opening in a wall: centre along the wall, half width, sill, springing and rise."""

    def __init__(self, centre, half, sill, spring, rise, count=12):
        self.centre, self.half, self.sill = centre, half, sill
        self.spring, self.rise, self.count = spring, rise, count

    def outline(self, shrink=0.0):
        """(s, z) from the left foot over the top to the right foot; `shrink` narrows it evenly."""
        half, rise = self.half - shrink, self.rise - shrink * 1.15
        arch = [(self.centre + x, self.spring + z) for x, z in pointed_arch(half, rise, self.count)]
        return [(self.centre - half, self.sill)] + arch + [(self.centre + half, self.sill)]


def wall_frame(which):
    """Local frame of a wall: x along it, y outwards, z up, origin at the middle of its foot."""
    angle, shift = {'window': (0, WIDTH / 2), 'inner': (180, WIDTH / 2),
                    'court': (90, LENGTH / 2), 'gate': (-90, LENGTH / 2)}[which]
    return turn_z(angle) @ translation(0, shift, 0)


def wall(mesh, s0, s1, top, openings, material, scale, y=0.0):
    """The face of a wall with holes, seen from -y."""
    position = s0
    for opening in sorted(openings, key=lambda o: o.centre):
        left, right = opening.centre - opening.half, opening.centre + opening.half
        mesh.quad((position, y, 0), (left, y, 0), (left, y, top), (position, y, top), material,
                  scale=scale)
        if opening.sill > 0:
            mesh.quad((left, y, 0), (right, y, 0), (right, y, opening.sill),
                      (left, y, opening.sill),
                      material, scale=scale)
        arch = opening.outline()[1:-1]
        for (a, za), (b, zb) in zip(arch, arch[1:]):
            mesh.quad((a, y, za), (b, y, zb), (b, y, top), (a, y, top), material, scale=scale)
        position = right
    mesh.quad((position, y, 0), (s1, y, 0), (s1, y, top), (position, y, top), material, scale=scale)


def reveal(mesh, inner, outer, depth, material, scale, sill=True):
    count = len(inner)
    for i in range(count if sill else count - 1):
        (a, za), (b, zb) = inner[i], inner[(i + 1) % count]
        (c, zc), (d, zd) = outer[i], outer[(i + 1) % count]
        mesh.quad((a, 0, za), (c, depth, zc), (d, depth, zd), (b, 0, zb), material, scale=scale)


def moulding(mesh, outline, depth, profile, material='stone', lift=0.0):
    """Sweeps a profile of (towards the opening, towards the room) along a wall opening's
    outline."""
    mesh.sweep(profile, [(s, depth, z + lift) for s, z in outline], material, [(0, -1, 0)],
               scale=1.5)


def lattice(mesh, outline, depth, spacing=0.21, slope=1.45, bar=0.0065):
    """Diamond lead lattice clipped to a convex outline."""
    centre = sum(s for s, _ in outline) / len(outline)
    low = min(z for _, z in outline)
    high = max(z for _, z in outline)
    for sign in (1, -1):
        direction = (1 / math.hypot(1, slope), sign * slope / math.hypot(1, slope))
        normal = (-direction[1], direction[0])
        reach = int((high - low + 2) / (spacing * abs(normal[0]))) + 2
        for k in range(-reach, reach):
            base = (centre + k * spacing, low)
            hits = []
            for i in range(len(outline)):
                p, q = outline[i], outline[(i + 1) % len(outline)]
                dp = (p[0] - base[0]) * normal[0] + (p[1] - base[1]) * normal[1]
                dq = (q[0] - base[0]) * normal[0] + (q[1] - base[1]) * normal[1]
                if (dp < 0) != (dq < 0):
                    t = dp / (dp - dq)
                    hits.append((p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t))
            if len(hits) == 2 and math.dist(*hits) > 0.05:
                path = [(s, depth, z) for s, z in hits]
                mesh.tube(path, bar, 'lead', segments=4, caps=False, smooth=False)


def window(walls, tracery, glazing, portal, centre):
    opening = Opening(centre, WINDOW_HALF, 1.15, 3.05, 1.55, 10)
    inner, outer = opening.outline(), opening.outline(0.13)
    reveal(walls, inner, outer, WINDOW_DEPTH, 'ashlar', 2.4)
    moulding(walls, inner, 0.0, [(-0.17, 0.0), (0.0, 0.0), (0.0, 0.03), (-0.03, 0.06),
                                 (-0.08, 0.045),
                                 (-0.13, 0.07), (-0.17, 0.05)])
    walls.box((centre - 1.2, -0.14, 1.09), (centre + 1.2, 0.02, 1.15), 'stone', 1.5)
    depth = 0.22
    frame = opening.outline(0.11)
    moulding(tracery, frame, depth, [(-0.05, -0.07), (0.055, -0.07), (0.055, -0.03), (0.02, 0.06),
                                     (-0.05, 0.06)])
    rib = [(-0.05, -0.03), (-0.02, -0.07), (0.02, -0.07), (0.05, -0.03), (0.05, 0.0), (0.02, 0.06),
           (-0.02, 0.06), (-0.05, 0.0)]
    moulding(tracery, [(centre, opening.sill), (centre, 3.2)], depth, rib)
    moulding(tracery, [(centre - 0.9, 2.12), (centre + 0.9, 2.12)], depth, rib)
    small = [(s * 0.72, z * 0.72) for s, z in rib]
    for side in (-1, 1):
        middle = centre + side * 0.452
        light = [(middle + x, 3.05 + z) for x, z in pointed_arch(0.45, 0.64, 8)]
        moulding(tracery, light, depth, small)
    ring = [(centre + 0.27 * math.cos(a), 3.92 + 0.27 * math.sin(a))
            for a in (2 * math.pi * i / 24 for i in range(24))]
    tracery.sweep(small, [(s, depth, z) for s, z in ring], 'stone', [(0, -1, 0)], closed=True,
                  scale=1.5)
    for k in range(4):                                     # a quatrefoil in the ring
        a = math.pi / 4 + k * math.pi / 2
        foil = [(centre + 0.125 * math.cos(a) + 0.12 * math.cos(a + b), 3.92 + 0.125 * math.sin(a)
                 + 0.12 * math.sin(a + b))
                for b in (math.radians(-112 + 224 * i / 10) for i in range(11))]
        moulding(tracery, foil, depth, [(s * 0.4, z * 0.5) for s, z in rib])
    lattice(glazing, frame, depth)
    # The sky stands in the opening itself: nearly every ray from the hall to it gets through, and
    # the sun passes, because it is a pane that glows. Its horizon is at eye height.
    points = [(s, WINDOW_DEPTH - 0.02, z) for s, z in outer]
    share = 0.045 * (centre + 8)
    uvs = [(share + (s - centre) * 0.047, SKY_HORIZON + (z - 1.65) * 0.21) for s, _, z in points]
    portal.add(points, [tuple(range(len(points)))[::-1]], 'sky', [uvs[::-1]])


def arch_height(v):
    """Height above the springing of the vault's pointed profile, v = 0 (crown) .. 1 (springing)."""
    k = 1.25
    offset = (k * k - 1) / 2
    return (CROWN - SPRING) / k * math.sqrt(max(0.0,
                                                (1 + offset) ** 2 - (min(1.0,
                                                    abs(v)) + offset) ** 2))


def vault(mesh):
    half_x, half_y = 2.0, WIDTH / 2
    steps = [math.sin(math.pi / 2 * i / 9) for i in range(-9, 10)]
    rows = [0.0, 0.12, 0.28, 0.46, 0.64, 0.82, 0.93, 1.0]
    for centre in BAYS:
        for axis, sign in ((1, 1), (1, -1), (0, 1), (0, -1)):
            points = []
            for t in rows:
                row = []
                for u in steps:
                    z = SPRING + arch_height(t * u)
                    if axis:
                        row.append((centre - half_x * t * u * sign, sign * half_y * t, z))
                    else:
                        row.append((centre + sign * half_x * t, sign * half_y * t * u, z))
                points.append(row)
            mesh.grid(points, 'plaster', repeat=(1.6, 0.9), offset=(centre * 0.31, axis * 0.4))


def ribs(mesh):
    profile = [(-0.11, -0.06), (0.11, -0.06), (0.11, 0.05), (0.075, 0.085), (0.05, 0.14),
               (-0.05, 0.14),
               (-0.075, 0.085), (-0.11, 0.05)]
    slim = [(s * 0.72, z * 0.72) for s, z in profile]
    steps = [math.sin(math.pi / 2 * i / 10) for i in range(-10, 11)]
    for x in (-8.0, -4.0, 0.0, 4.0, 8.0):
        path = [(x, WIDTH / 2 * s, SPRING + arch_height(s)) for s in steps]
        mesh.sweep(profile, path, 'stone', [(x - p[0], -p[1], SPRING - 0.2 - p[2]) for p in path],
                   scale=1.5)
    for centre in BAYS:
        for sign in (1, -1):
            path = [(centre + 2 * s, sign * WIDTH / 2 * s, SPRING + arch_height(s)) for s in steps]
            mesh.sweep(slim, path, 'stone', [(centre - p[0], -p[1], SPRING - 0.2 - p[2])
                                             for p in path], scale=1.5)
            wall_rib = [(centre + 2 * s, sign * WIDTH / 2, SPRING + arch_height(s)) for s in steps]
            mesh.sweep(slim, wall_rib, 'stone', [(centre - p[0], 0, SPRING - 0.2 - p[2])
                                                 for p in wall_rib], scale=1.5)
        mesh.sweep(slim, [(centre, -WIDTH / 2, CROWN), (centre, WIDTH / 2, CROWN)], 'stone',
                   [(0, 0, -1)], scale=1.5)
    mesh.sweep(slim, [(-8, 0, CROWN), (8, 0, CROWN)], 'stone', [(0, 0, -1)], scale=1.5)


def boss(mesh, x):
    """A carved keystone: a rosette of eight gilt petals on a stone disc."""
    keep = mesh.transform
    mesh.transform = translation(x, 0, CROWN)
    mesh.lathe([(0.0, -0.26), (0.10, -0.25), (0.20, -0.22), (0.27, -0.17), (0.30, -0.10),
                (0.30, 0.0)], 24, 'stone')
    for k in range(8):
        mesh.transform = translation(x, 0, CROWN - 0.225) @ turn_z(45 * k)
        mesh.ellipsoid((0.13, 0, 0), (0.085, 0.045, 0.035), 'gilt', 10, 6)
    mesh.transform = translation(x, 0, CROWN - 0.26)
    mesh.ellipsoid((0, 0, 0), (0.06, 0.06, 0.045), 'gilt', 12, 6)
    mesh.transform = keep


def shaft(mesh, x, y):
    """An engaged column with base and capital, carrying the ribs."""
    keep = mesh.transform
    mesh.transform = translation(x, y, 0)
    r = 0.135
    base = [(0.27, FOOT), (0.27, 0.16), (0.245, 0.19), (0.245, 0.30), (0.225, 0.345), (0.19, 0.36),
            (0.17, 0.385),
            (0.175, 0.42), (0.15, 0.45), (r, 0.48)]
    capital = [(r, 2.86), (0.165, 2.875), (0.165, 2.905), (0.145, 2.92), (0.155, 3.02),
               (0.20, 3.12), (0.27, 3.19),
               (0.29, 3.20), (0.29, 3.27), (0.32, 3.29), (0.32, 3.35), (0.0, 3.36)]
    mesh.lathe(base, 16, 'stone', repeat=(1, 0.6))
    mesh.lathe([(r, 0.48), (r, 2.86)], 16, 'stone', repeat=(0.8, 2))
    mesh.lathe(capital, 16, 'stone', repeat=(1, 0.6))
    for k in range(8):                                        # curled leaves around the bell
        mesh.transform = translation(x, y, 0) @ turn_z(45 * k + 22.5)
        leaf = bezier([(0.15, 0, 2.93), (0.165, 0, 3.04), (0.21, 0, 3.18), (0.275, 0, 3.17),
                       (0.265, 0, 3.11)], 4)
        mesh.sweep([(-0.045, -0.012), (0.045, -0.012), (0.0, 0.02)], leaf, 'stone', [(1, 0, 0)],
                   scale=1.5, smooth=True)
    mesh.transform = keep


def wainscot(mesh, s0, s1, height=1.08):
    """Oak frame-and-panel work along a wall from s0 to s1, in the wall's frame."""
    count = max(1, round((s1 - s0) / 0.78))
    step = (s1 - s0) / count
    mesh.box((s0, -0.065, 0), (s1, 0, 0.15), 'oak', 1.2, 'x')
    mesh.box((s0, -0.05, 0.15), (s1, 0, 0.24), 'oak', 1.2, 'x')
    mesh.box((s0, -0.05, height - 0.13), (s1, 0, height - 0.035), 'oak', 1.2, 'x')
    mesh.box((s0, -0.095, height - 0.035), (s1, 0, height), 'oak', 1.2, 'x')
    mesh.box((s0, -0.07, height - 0.06), (s1, -0.05, height - 0.035), 'oak', 1.2, 'x')
    for i in range(count + 1):
        s = min(max(s0 + i * step, s0 + 0.05), s1 - 0.05)
        mesh.box((s - 0.05, -0.05, 0.24), (s + 0.05, 0, height - 0.13), 'oak', 1.2, 'z')
    for i in range(count):
        a, b = s0 + i * step + 0.05, s0 + (i + 1) * step - 0.05
        low, high = 0.24, height - 0.13
        mesh.box((a, -0.012, low), (b, 0, high), 'oak', 1.2, 'z')
        m, d = 0.075, 0.036                                      # the raised field with its bevels
        outer = [(a + 0.02, low + 0.02), (b - 0.02, low + 0.02), (b - 0.02, high - 0.02),
                 (a + 0.02, high - 0.02)]
        inner = [(a + m, low + m), (b - m, low + m), (b - m, high - m), (a + m, high - m)]
        points = [(s, -0.012, z) for s, z in outer] + [(s, -d, z) for s, z in inner]
        mesh.add(points, [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)],
                 'oak',
                 scale=1.2, grain='z')


def plank_door(mesh, opening, y, iron):
    """An arched double door of upright planks with strap hinges and ring handles."""
    planks = 10
    width = 2 * opening.half / planks
    arch = opening.outline()[1:-1]
    for k in range(planks):
        a = opening.centre - opening.half + k * width + 0.004
        b = a + width - 0.008
        top = min(interpolate(arch, a), interpolate(arch, b))
        mesh.box((a, y, 0.01), (b, y + 0.06, top + 0.03), 'dark oak', 1.2, 'z')
    for z in (0.55, 1.45, 2.3):
        for side in (-1, 1):
            x0, x1 = opening.centre + side * opening.half, opening.centre + side * 0.18
            iron.box((min(x0, x1), y - 0.012, z - 0.035), (max(x0, x1), y + 0.002, z + 0.035),
                     'iron')
            for k in range(5):
                iron.ellipsoid((x0 + (x1 - x0) * (0.1 + 0.2 * k), y - 0.012, z),
                               (0.018, 0.012, 0.018), 'iron', 8, 4)
    for side in (-1, 1):
        ring = [(opening.centre + side * 0.14 + 0.07 * math.cos(a), y - 0.035,
                 1.12 + 0.07 * math.sin(a))
                for a in (2 * math.pi * i / 16 for i in range(16))]
        iron.tube(ring, 0.009, 'iron', 6, closed=True)


def interpolate(curve, s):
    for (a, za), (b, zb) in zip(curve, curve[1:]):
        if a <= s <= b:
            return za + (zb - za) * (s - a) / max(1e-9, b - a)
    return curve[0][1] if s < curve[0][0] else curve[-1][1]


COURT_ARCH = Opening(0.0, 1.3, 0.0, 2.3, 1.6)
GATE_ARCH = Opening(0.0, 1.15, 0.0, 2.1, 1.35)
ARCH_PROFILE = [(-0.30, 0.0), (0.0, 0.0), (0.0, 0.03), (-0.03, 0.08), (-0.09, 0.09), (-0.12, 0.05),
                (-0.19, 0.05),
                (-0.22, 0.11), (-0.28, 0.11), (-0.30, 0.07)]


def make_floor():
    mesh = Mesh('Floor')
    x, y = LENGTH / 2 - 0.42, WIDTH / 2 - 0.42
    mesh.quad((-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0), 'floor', scale=2.4)
    for low, high in (((-8, -4.5), (8, -y)), ((-8, y), (8, 4.5)), ((-8, -y), (-x, y)),
                      ((x, -y), (8, y))):
        mesh.quad((*low, 0), (high[0], low[1], 0), (*high, 0), (low[0], high[1], 0), 'floor border')
    mesh.box((-8.95, -1.29, -0.3), (-8.0, 1.29, 0.0), 'stone', 1.5)                 # threshold
    mesh.box((-9.35, -1.5, -0.3), (-8.95, 1.5, -0.08), 'stone', 1.5)                # step down
    mesh.finish(bevel=0.0)


def make_hall():
    walls, wood = Mesh('Walls'), Mesh('Panelling')
    tracery, glazing, portal = Mesh('Tracery'), Mesh('Lattice'), Mesh('Sky')
    iron = Mesh('Ironwork')
    for mesh in (walls, wood, tracery, glazing, portal, iron):
        mesh.transform = wall_frame('window')
    wall(walls, -8, 8, 6.1, [Opening(c, WINDOW_HALF, 1.15, 3.05, 1.55, 10) for c in BAYS],
         'plaster', 3.0)
    for centre in BAYS:
        window(walls, tracery, glazing, portal, centre)
    wainscot(wood, -7.85, 7.85)
    for mesh in (walls, wood):
        mesh.transform = wall_frame('inner')
    wall(walls, -8, 8, 6.1, [], 'plaster', 3.0)
    wainscot(wood, -7.85, 0.72, 1.3)          # the fireplace stands between
    wainscot(wood, 3.28, 7.85, 1.3)
    for mesh in (walls, wood):
        mesh.transform = wall_frame('court')
    wall(walls, -4.5, 4.5, 6.1, [COURT_ARCH], 'ashlar', 2.4)
    outline = COURT_ARCH.outline()
    reveal(walls, outline, COURT_ARCH.outline(0.02), 0.95, 'ashlar', 2.4, sill=False)
    moulding(walls, outline, 0.0, ARCH_PROFILE)
    wainscot(wood, -4.36, -1.62, 1.3)
    wainscot(wood, 1.62, 4.36, 1.3)
    for mesh in (walls, wood, iron):
        mesh.transform = wall_frame('gate')
    wall(walls, -4.5, 4.5, 6.1, [GATE_ARCH], 'ashlar', 2.4)
    reveal(walls, GATE_ARCH.outline(), GATE_ARCH.outline(), 0.35, 'ashlar', 2.4, sill=False)
    moulding(walls, GATE_ARCH.outline(), 0.0, ARCH_PROFILE)
    plank_door(wood, GATE_ARCH, 0.28, iron)
    walls.quad((-1.2, 0.34, 0), (1.2, 0.34, 0), (1.2, 0.34, 3.6), (-1.2, 0.34, 3.6), 'soot')
    wainscot(wood, -4.36, -1.47, 1.3)
    wainscot(wood, 1.47, 4.36, 1.3)
    walls.finish()
    wood.finish(bevel=0.003)
    tracery.finish()
    glazing.finish()
    portal.finish()
    iron.finish()

    ceiling, stone = Mesh('Vault'), Mesh('Ribs')
    vault(ceiling)
    ribs(stone)
    for centre in BAYS:
        boss(stone, centre)
    for x in (-8.0, -4.0, 0.0, 4.0, 8.0):
        for y in (-WIDTH / 2, WIDTH / 2):
            shaft(stone, x, y)
    ceiling.finish(auto_smooth=60)
    stone.finish()
    make_floor()
