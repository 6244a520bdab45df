# SPDX-License-Identifier: Apache-2.0
"""Writes the benchmark's scenes, one .glb each, beside this script:
    python3 tests/benchmark/scenes/make_scenes.py
cornell_box   Cornell University's measured box in metres, purely diffuse
metal_box     the same walls and lamp around a block, a ball and a step of white metal
diffuse_hall  a colonnade lit by tall windows on one side: mostly light between walls
caustics      glass, water, a prism and polished metal on a table under a small lamp
conference    a conference room with 104 lights in its ceiling
"""
import math
import os

from gltf import Mesh, Scene, add, scale

FOLDER = os.path.dirname(os.path.abspath(__file__))


def save(scene, name):
    scene.save(os.path.join(FOLDER, name + ".glb"))


def box_walls(scene):
    """Cornell's walls and lamp; returns the material of the white ones."""
    white = scene.matt("white", [0.73, 0.73, 0.73])
    red = scene.matt("red", [0.65, 0.05, 0.05])
    green = scene.matt("green", [0.12, 0.45, 0.15])
    lamp = scene.material("lamp", [0, 0, 0], emission=[17, 12, 4],
                          extensions={"KHR_materials_ior": {"ior": 1.0}})
    w, h, d = 0.28, 0.55, 0.56
    scene.mesh("floor", white, Mesh().quad([-w, 0, 0], [2 * w, 0, 0], [0, 0, -d]))
    scene.mesh("ceiling", white, Mesh().quad([-w, h, -d], [2 * w, 0, 0], [0, 0, d]))
    scene.mesh("back wall", white, Mesh().quad([-w, 0, -d], [2 * w, 0, 0], [0, h, 0]))
    scene.mesh("left wall", red, Mesh().quad([-w, 0, 0], [0, 0, -d], [0, h, 0]))
    scene.mesh("right wall", green, Mesh().quad([w, 0, -d], [0, 0, d], [0, h, 0]))
    scene.mesh("lamp", lamp,
               Mesh().quad([-0.065, h - 0.001, -0.33], [0.13, 0, 0], [0, 0, 0.105]))
    return white


def tall_block():
    return Mesh().box([-0.1725, 0, -0.4335], [-0.0075, 0.33, -0.2685], 0.29)


def look_into_box(scene):
    scene.camera("front", [0, 0.275, 0.8], [0, 0.275, 0], math.degrees(0.686))


def cornell_box():
    scene = Scene()
    white = box_walls(scene)
    scene.mesh("short block", white, Mesh().box([0.0105, 0, -0.2515], [0.1755, 0.165, -0.0865],
                                                -0.29))
    scene.mesh("tall block", white, tall_block())
    look_into_box(scene)
    save(scene, "cornell_box")


def metal_box():
    scene = Scene()
    box_walls(scene)
    # White metal reflects all light at every angle, whatever a renderer makes of Fresnel's law.
    brushed, polished, blunt = (
        scene.material(name, [1, 1, 1], roughness=r, metallic=1)
        for name, r in (("brushed", 0.2), ("polished", 0.1), ("blunt", 0.25)))
    scene.mesh("tall block", brushed, tall_block())
    scene.mesh("ball", polished, Mesh().sphere([0.1, 0.09, -0.18], 0.09, 32))
    scene.mesh("step", blunt, Mesh().box([-0.22, 0, -0.16], [-0.02, 0.04, -0.06]))
    look_into_box(scene)
    save(scene, "metal_box")


def diffuse_hall():
    scene = Scene()
    stone = scene.matt("sandstone", [0.68, 0.58, 0.44])
    plaster = scene.matt("plaster", [0.78, 0.76, 0.72])
    light_tile = scene.matt("light tile", [0.62, 0.58, 0.52])
    dark_tile = scene.matt("dark tile", [0.26, 0.13, 0.1])
    timber = scene.matt("timber", [0.32, 0.2, 0.11])
    curtain = scene.matt("curtain", [0.5, 0.06, 0.05])
    blue = scene.matt("glazed vase", [0.08, 0.16, 0.5])
    daylight = scene.material("daylight", [0, 0, 0], emission=[5.2, 6, 7],
                              extensions={"KHR_materials_ior": {"ior": 1.0}})
    length, nave, aisle, high, low = 18.0, 3.2, 2.4, 6.4, 3.9
    out = nave + aisle
    # Floor of tiles, half a metre wide in the nave, in two materials.
    tiles = (Mesh(), Mesh())
    size = 0.8
    nx, nz = int(round(2 * out / size)), int(round(length / size))
    for i in range(nx):
        for k in range(nz):
            x, z = -out + 2 * out * i / nx, -length * (k + 1) / nz
            tiles[(i + k) % 2].quad([x, 0, z + length / nz], [2 * out / nx, 0, 0],
                                    [0, 0, -length / nz])
    scene.mesh("light tiles", light_tile, tiles[0])
    scene.mesh("dark tiles", dark_tile, tiles[1])
    shell = Mesh()
    shell.quad([-nave, high, -length], [2 * nave, 0, 0], [0, 0, length])  # nave's ceiling
    for side in (-1, 1):
        outer = side * out
        inner = side * nave
        u = [0, 0, -length] if side < 0 else [0, 0, length]
        start = 0 if side < 0 else -length
        if side > 0:
            shell.quad([outer, 0, start], u, [0, low, 0])  # the wall without windows
        shell.quad([inner, low - 0.6, start], u, [0, high - low + 0.6, 0])  # over the arches
        back = [0, 0, length] if side < 0 else [0, 0, -length]
        shell.quad([inner + side * 0.5, low - 0.6, -length - start], back, [0, 0.6, 0])
        shell.quad([min(inner, inner + side * 0.5), low - 0.6, -length], [0.5, 0, 0],
                   [0, 0, length])
        shell.quad([min(inner, outer), low, -length], [aisle, 0, 0], [0, 0, length])
    shell.quad([-out, 0, -length], [2 * out, 0, 0], [0, high, 0])  # far end
    shell.quad([out, 0, 0], [-2 * out, 0, 0], [0, high, 0])  # behind the eye
    # The wall of windows: piers between them, a parapet below, a lintel above.
    bays, sill, top = 5, 0.9, 3.4
    pitch = length / bays
    window_width = 2.3
    wall, glass, frames = Mesh(), Mesh(), Mesh()
    wall.quad([-out, 0, 0], [0, 0, -length], [0, sill, 0])
    wall.quad([-out, top, 0], [0, 0, -length], [0, low - top, 0])
    for b in range(bays):
        middle = -(b + 0.5) * pitch
        near, far = middle + window_width / 2, middle - window_width / 2
        wall.quad([-out, sill, -b * pitch], [0, 0, near + b * pitch], [0, top - sill, 0])
        wall.quad([-out, sill, far], [0, 0, -(b + 1) * pitch - far], [0, top - sill, 0])
        depth = 0.2  # reveals, then the sky
        x = -out - depth
        wall.quad([x, sill, near], [depth, 0, 0], [0, 0, -window_width])
        wall.quad([-out, top, near], [-depth, 0, 0], [0, 0, -window_width])
        wall.quad([-out, sill, near], [-depth, 0, 0], [0, top - sill, 0])
        wall.quad([x, sill, far], [depth, 0, 0], [0, top - sill, 0])
        glass.quad([x, sill, near], [0, 0, -window_width], [0, top - sill, 0])
        for z in (near - 0.02, middle, far + 0.02):
            frames.box([x + 0.02, sill, z - 0.03], [x + 0.08, top, z + 0.03])
        for y in (sill + 0.8, sill + 1.65):
            frames.box([x + 0.02, y - 0.025, far], [x + 0.08, y + 0.025, near])
    scene.mesh("walls", plaster, shell)
    scene.mesh("window wall", plaster, wall)
    scene.mesh("daylight", daylight, glass)
    scene.mesh("window frames", timber, frames)
    columns = Mesh()
    profile = [(0.34, 0.0), (0.34, 0.12), (0.3, 0.2), (0.26, 0.26), (0.245, 1.4), (0.225, 2.75),
               (0.25, 2.8), (0.25, 2.86), (0.23, 2.9), (0.3, 3.05), (0.34, 3.12), (0.34, 3.3)]
    for side in (-1, 1):
        for b in range(bays + 1):
            z = -b * pitch if 0 < b < bays else (-0.35 if b == 0 else -length + 0.35)
            columns.turned(profile, [side * (nave + 0.25), 0, z], 28)
    scene.mesh("columns", stone, columns)
    beams = Mesh()
    for b in range(1, 2 * bays):
        z = -b * pitch / 2
        beams.box([-nave, high - 0.32, z - 0.12], [nave, high, z + 0.12], faces="yzZ")
    scene.mesh("beams", timber, beams)
    # Things to look at: pedestals with vases, a curtain in folds, benches.
    vase = [(0.0, 0.0), (0.11, 0.0), (0.12, 0.03), (0.1, 0.06), (0.19, 0.22), (0.23, 0.38),
            (0.2, 0.52), (0.11, 0.62), (0.08, 0.7), (0.12, 0.78), (0.1, 0.775), (0.06, 0.7)]
    pedestals, vases = Mesh(), Mesh()
    for x, z in ((-1.75, -6.6), (1.75, -6.6), (1.75, -12.0), (-1.75, -12.0)):
        pedestals.box([x - 0.28, 0, z - 0.28], [x + 0.28, 0.1, z + 0.28])
        pedestals.box([x - 0.22, 0.1, z - 0.22], [x + 0.22, 1.0, z + 0.22])
        vases.turned(vase, [x, 1.0, z], 40)
    scene.mesh("pedestals", stone, pedestals)
    scene.mesh("vases", blue, vases)
    folds = Mesh()
    steps, width = 48, 2.6
    points = []
    for i in range(steps + 1):
        x = -width / 2 + width * i / steps
        points.append((x, -length + 0.2 + 0.07 * math.sin(i * 1.2), 0.07 * 1.2 * steps / width
                       * math.cos(i * 1.2)))
    for (x0, z0, s0), (x1, z1, s1) in zip(points, points[1:]):
        i = [folds.vertex(p, n) for p, n in (
            ([x0, 0.02, z0], [-s0, 0, 1]), ([x1, 0.02, z1], [-s1, 0, 1]),
            ([x1, 4.4, z1], [-s1, 0, 1]), ([x0, 4.4, z0], [-s0, 0, 1]))]
        folds.triangles += [[i[0], i[1], i[2]], [i[0], i[2], i[3]]]
    scene.mesh("curtain", curtain, folds)
    benches = Mesh()
    for z in (-4.4, -9.3, -14.2):
        for dz in (-0.7, 0.7):
            benches.box([4.85, 0, z + dz - 0.06], [5.3, 0.42, z + dz + 0.06])
        benches.box([4.8, 0.42, z - 0.95], [5.35, 0.48, z + 0.95])
    scene.mesh("benches", timber, benches)
    scene.camera("entrance", [0.7, 1.65, -0.9], [-0.35, 1.95, -9], 52)
    save(scene, "diffuse_hall")


def caustics():
    scene = Scene()

    def solid(name, ior, **more):
        extensions = {"KHR_materials_transmission": {"transmissionFactor": 1.0},
                      "KHR_materials_ior": {"ior": ior},
                      "KHR_materials_volume": {"thicknessFactor": 0.1, **more.get("volume", {})}}
        if "dispersion" in more:
            extensions["KHR_materials_dispersion"] = {"dispersion": more["dispersion"]}
        return scene.material(name, [1, 1, 1], more.get("roughness", 0.0), extensions=extensions)

    table = scene.material("table", [0.5, 0.42, 0.33], 0.85)
    wall = scene.matt("wall", [0.55, 0.55, 0.53])
    crystal = solid("crystal ball", 1.52)
    amber = solid("amber bowl", 1.5, volume={"attenuationColor": [0.95, 0.55, 0.12],
                                             "attenuationDistance": 0.03})
    flint = solid("flint prism", 1.62, dispersion=0.55)
    frosted = solid("frosted cube", 1.5, roughness=0.35,
                    volume={"attenuationColor": [0.35, 0.85, 0.75],
                            "attenuationDistance": 0.08})
    gold = scene.material("gold ring", [1.0, 0.77, 0.34], 0.08, 1.0)
    lamp = scene.material("lamp", [0, 0, 0], emission=[170, 154, 132],
                          extensions={"KHR_materials_ior": {"ior": 1.0}})
    soft = scene.material("soft light", [0, 0, 0], emission=[2.2, 2.6, 3.2],
                          extensions={"KHR_materials_ior": {"ior": 1.0}})
    # A table top that curves up into the wall behind, as photographers have it.
    sweep = Mesh()
    curve = [(1.4, 0.0), (-0.75, 0.0)]
    for i in range(1, 13):
        a = math.pi / 2 * i / 12
        curve.append((-0.75 - 0.45 * math.sin(a), 0.45 * (1 - math.cos(a))))
    for k, ((z0, y0), (z1, y1)) in enumerate(zip(curve, curve[1:])):
        def normal(z, y):
            return [0, 1, 0] if z >= -0.75 else [0, 0.45 - y, -0.75 - z]
        i = [sweep.vertex(p, n) for p, n in (
            ([-1.6, y0, z0], normal(z0, y0)), ([1.6, y0, z0], normal(z0, y0)),
            ([1.6, y1, z1], normal(z1, y1)), ([-1.6, y1, z1], normal(z1, y1)))]
        sweep.triangles += [[i[0], i[1], i[2]], [i[0], i[2], i[3]]]
    scene.mesh("table", table, sweep)
    scene.mesh("wall", wall, Mesh().quad([-1.6, 0.45, -1.2], [3.2, 0, 0], [0, 1.6, 0]))
    scene.mesh("crystal ball", crystal, Mesh().sphere([-0.13, 0.1205, -0.05], 0.12, 56))
    # A thick bowl: outside up, rim, inside down.
    outside = [(0.0, 0.0), (0.06, 0.0)] + [
        (0.06 + 0.075 * math.sin(math.pi / 2 * i / 14), 0.1 * (1 - math.cos(math.pi / 2 * i / 14)))
        for i in range(1, 15)]
    rim = [(0.135 - 0.006 + 0.006 * math.cos(math.pi * i / 8),
            0.1 + 0.006 * math.sin(math.pi * i / 8))
           for i in range(1, 9)]
    inside = [(0.055 + 0.068 * math.sin(math.pi / 2 * i / 14),
               0.014 + 0.086 * (1 - math.cos(math.pi / 2 * i / 14))) for i in range(13, -1, -1)]
    scene.mesh("amber bowl", amber,
               Mesh().turned(outside + rim + inside + [(0.0, 0.014)], [0.27, 0.0005, -0.22], 72))
    prism = Mesh()
    side, length = 0.11, 0.24
    height = side * math.sqrt(3) / 2
    angle = 0.5
    c, s = math.cos(angle), math.sin(angle)

    def place(x, y, z):
        return [0.22 + c * x + s * z, 0.0505 + y, 0.16 - s * x + c * z]

    a = [place(-length / 2, 0, -side / 2), place(length / 2, 0, -side / 2)]
    b = [place(-length / 2, 0, side / 2), place(length / 2, 0, side / 2)]
    t = [place(-length / 2, height, 0), place(length / 2, height, 0)]

    def face(p, q, r):
        prism.quad(p, [q[i] - p[i] for i in range(3)], [r[i] - p[i] for i in range(3)])

    face(a[0], a[1], b[0])
    face(b[0], b[1], t[0])
    face(a[1], a[0], t[1])
    for p, q, r in ((a[0], b[0], t[0]), (b[1], a[1], t[1])):
        n = [0, 0, 0]
        u = [q[i] - p[i] for i in range(3)]
        v = [r[i] - p[i] for i in range(3)]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        i = [prism.vertex(x, n) for x in (p, q, r)]
        prism.triangles.append(i)
    scene.mesh("flint prism", flint, prism)
    stand = Mesh()
    for x in (-0.085, 0.085):
        foot = place(x, -0.0255, 0)
        stand.box([foot[0] - 0.012, 0, foot[2] - 0.045], [foot[0] + 0.012, 0.05, foot[2] + 0.045],
                  angle)
    scene.mesh("prism stand", scene.material("walnut", [0.16, 0.09, 0.05], 0.6), stand)
    scene.mesh("frosted cube", frosted,
               Mesh().box([-0.5, 0.0005, -0.42], [-0.34, 0.1605, -0.26], 0.45))
    ring = [(0.135, 0.0), (0.139, 0.003), (0.139, 0.052), (0.135, 0.055), (0.131, 0.052),
            (0.131, 0.003)]
    scene.mesh("gold ring", gold, Mesh().turned(ring, [-0.4, 0.0005, 0.2], 96, closed=True))
    # A small round lamp high on the left, and a large dim panel above.
    disc = Mesh()
    center, radius = [-1.05, 1.25, 0.5], 0.07
    towards = [0.68, -0.8, -0.33]
    length_ = math.sqrt(sum(x * x for x in towards))
    n = scale(towards, 1 / length_)
    u = [n[2], 0, -n[0]]
    lu = math.sqrt(sum(x * x for x in u))
    u = scale(u, 1 / lu)
    v = [n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]]
    hub = disc.vertex(center, n)
    rim_ = [disc.vertex(add(center, add(scale(u, radius * math.cos(2 * math.pi * i / 24)),
                                        scale(v, radius * math.sin(2 * math.pi * i / 24)))), n)
            for i in range(24)]
    disc.triangles += [[hub, rim_[i], rim_[(i + 1) % 24]] for i in range(24)]
    scene.mesh("lamp", lamp, disc)
    scene.mesh("soft light", soft, Mesh().quad([-0.8, 1.9, -0.6], [1.6, 0, 0], [0, 0, 1.2]))
    # The studio round it, which glass and gold show.
    studio = Mesh()
    x, low, high, z = 2.6, -0.8, 2.6, 2.8
    studio.quad([-x, low, z], [0, 0, -2 * z], [0, high - low, 0])
    studio.quad([x, low, -z], [0, 0, 2 * z], [0, high - low, 0])
    studio.quad([-x, low, -z], [2 * x, 0, 0], [0, high - low, 0])
    studio.quad([x, low, z], [-2 * x, 0, 0], [0, high - low, 0])
    studio.quad([-x, low, z], [2 * x, 0, 0], [0, 0, -2 * z])
    studio.quad([-x, high, -z], [2 * x, 0, 0], [0, 0, 2 * z])
    scene.mesh("studio", wall, studio)
    scene.camera("table", [0.1, 0.56, 0.98], [-0.06, 0.05, -0.05], 38)
    save(scene, "caustics")


def conference():
    scene = Scene()
    plaster = scene.matt("plaster", [0.75, 0.73, 0.7])
    panel = scene.material("wall panel", [0.38, 0.22, 0.12], 0.55)
    carpet = scene.matt("carpet", [0.12, 0.17, 0.28])
    oak = scene.material("oak", [0.45, 0.28, 0.14], 0.25)
    leather = scene.material("leather", [0.06, 0.05, 0.05], 0.45)
    steel = scene.material("steel", [0.7, 0.7, 0.72], 0.3, 1.0)
    paper = scene.matt("paper", [0.85, 0.85, 0.82])
    screen = scene.material("screen", [0.9, 0.9, 0.9], 0.9)
    tints = [scene.material(f"lamp {i}", [0, 0, 0], emission=e,
                            extensions={"KHR_materials_ior": {"ior": 1.0}})
             for i, e in enumerate(([30, 24, 16], [26, 25, 22], [16, 21, 30]))]
    w, h, d = 4.0, 3.1, 13.0
    scene.mesh("carpet", carpet, Mesh().quad([-w, 0, 0], [2 * w, 0, 0], [0, 0, -d]))
    ceiling, lamps = Mesh(), [Mesh(), Mesh(), Mesh()]
    # 8 x 13 lights, flush with a ceiling that is pieced together round them.
    columns, rows, half = 8, 13, 0.1
    cw, cd = 2 * w / columns, d / rows
    for i in range(columns):
        for k in range(rows):
            x0, z1 = -w + i * cw, -k * cd
            x, z = x0 + cw / 2, z1 - cd / 2
            xs = [x0, x - half, x + half, x0 + cw]
            zs = [z1 - cd, z - half, z + half, z1]
            for a in range(3):
                for b in range(3):
                    if (a, b) != (1, 1):
                        ceiling.quad([xs[a], h, zs[b]], [xs[a + 1] - xs[a], 0, 0],
                                     [0, 0, zs[b + 1] - zs[b]])
            # Warm over the table, cooler towards the walls and the screen.
            tint = 0 if 2 <= i <= 5 and k < 10 else 2 if k >= 11 else 1
            lamps[tint].quad([x - half, h, z - half], [2 * half, 0, 0], [0, 0, 2 * half])
    scene.mesh("ceiling", plaster, ceiling)
    for i, mesh in enumerate(lamps):
        scene.mesh(f"lamps {i}", tints[i], mesh)
    walls = Mesh()
    walls.quad([-w, 0, 0], [0, 0, -d], [0, h, 0])
    walls.quad([w, 0, -d], [0, 0, d], [0, h, 0])
    walls.quad([-w, 0, -d], [2 * w, 0, 0], [0, h, 0])
    walls.quad([w, 0, 0], [-2 * w, 0, 0], [0, h, 0])
    scene.mesh("walls", plaster, walls)
    panels = Mesh()
    for k in range(10):
        z = -0.35 - k * 1.25
        for side in (-1, 1):
            low, high = sorted((side * w, side * (w - 0.04)))
            panels.box([low, 0.15, z - 1.1], [high, 2.4, z])
    scene.mesh("wall panels", panel, panels)
    scene.mesh("screen", screen, Mesh().box([-1.5, 0.9, -d + 0.02], [1.5, 2.6, -d + 0.06]))
    # The table: a long oval top on three feet.
    top = Mesh()
    outline = []
    for i in range(64):
        a = 2 * math.pi * i / 64
        bend = lambda t: math.copysign(abs(t) ** 0.55, t)
        outline.append((1.15 * bend(math.cos(a)), -6.3 - 4.1 * bend(math.sin(a))))
    for y, sign in ((0.76, 1), (0.7, -1)):
        hub = top.vertex([0, y, -6.3], [0, sign, 0])
        ring = [top.vertex([x, y, z], [0, sign, 0]) for x, z in outline]
        for i in range(64):
            a, b = ring[i], ring[(i + 1) % 64]
            top.triangles.append([hub, a, b] if sign > 0 else [hub, b, a])
    for i in range(64):
        (x0, z0), (x1, z1) = outline[i], outline[(i + 1) % 64]
        top.quad([x0, 0.7, z0], [x1 - x0, 0, z1 - z0], [0, 0.06, 0])
    scene.mesh("table top", oak, top)
    feet = Mesh()
    for z in (-3.8, -6.3, -8.8):
        feet.box([-0.35, 0, z - 0.12], [0.35, 0.7, z + 0.12], faces="xXzZ")
    scene.mesh("table feet", steel, feet)
    seat, frame = Mesh(), Mesh()
    places = [(side * 1.62, -3.2 - 1.05 * k, -side * math.pi / 2) for side in (-1, 1)
              for k in range(7)] + [(0, -11.1, 0.0)]
    for x, z, angle in places:
        c, s = math.cos(angle), math.sin(angle)

        def put(mesh, low, high, x=x, z=z, c=c, s=s, angle=angle):
            middle = [(low[i] + high[i]) / 2 for i in range(3)]
            half_ = [(high[i] - low[i]) / 2 for i in range(3)]
            m = [x + c * middle[0] + s * middle[2], middle[1], z - s * middle[0] + c * middle[2]]
            mesh.box([m[i] - half_[i] for i in range(3)], [m[i] + half_[i] for i in range(3)],
                     angle)

        put(seat, [-0.26, 0.42, -0.25], [0.26, 0.5, 0.27])
        put(seat, [-0.25, 0.56, -0.33], [0.25, 1.08, -0.27])
        put(frame, [-0.03, 0.06, -0.03], [0.03, 0.42, 0.03])
        put(frame, [-0.28, 0.02, -0.03], [0.28, 0.06, 0.03])
        put(frame, [-0.03, 0.02, -0.28], [0.03, 0.06, 0.28])
        put(frame, [-0.03, 0.45, -0.31], [0.03, 0.8, -0.28])
    scene.mesh("seats", leather, seat)
    scene.mesh("chair frames", steel, frame)
    papers = Mesh()
    for i, (x, z, angle) in enumerate(places[:-1]):
        papers.box([x * 0.52 - 0.105, 0.7602, z - 0.148], [x * 0.52 + 0.105, 0.7625, z + 0.148],
                   math.pi / 2 + 0.2 * math.sin(7.3 * i))
    scene.mesh("papers", paper, papers)
    carafe = [(0.0, 0.0), (0.07, 0.0), (0.085, 0.05), (0.075, 0.14), (0.035, 0.2), (0.032, 0.26),
              (0.045, 0.29), (0.0, 0.29)]
    jugs = Mesh()
    for z in (-4.6, -8.0):
        jugs.turned(carafe, [0.1, 0.76, z], 32)
    scene.mesh("jugs", steel, jugs)
    scene.camera("door", [2.6, 1.75, -0.5], [-0.5, 0.95, -7], 50)
    save(scene, "conference")


if __name__ == "__main__":
    cornell_box()
    metal_box()
    diffuse_hall()
    caustics()
    conference()
