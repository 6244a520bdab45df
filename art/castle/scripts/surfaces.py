# SPDX-License-Identifier: Apache-2.0
"""Pictures of building materials: plaster, ashlar, marble floor, oak, cobbles, shingles, metals."""
import numpy as np

from .noise import blur, generator, mix, normal_map, smoothstep, solid, spectral, warp


def plaster():
    """Limewash: nearly white with brush sweeps and faint stains. 3 m."""
    rng, shape = generator('plaster'), (1024, 1024)
    broad = spectral(shape, rng, 3.0, 1, 12)
    brush = spectral(shape, rng, 1.6, 6, 200, stretch=(1.0, 2.2))
    fine = spectral(shape, rng, 1.0, 60, 400)
    tone = 0.88 + 0.10 * (broad - 0.5) + 0.06 * (brush - 0.5) + 0.035 * (fine - 0.5)
    colour = solid(shape, (1.0, 0.972, 0.915)) * tone[..., None]
    stain = smoothstep(0.4, 0.95, spectral(shape, rng, 3.2, 1, 20))
    colour = mix(colour, colour * np.array([0.95, 0.915, 0.85]), stain * 0.8)
    height = 0.7 * brush + 0.5 * spectral(shape, rng, 1.8, 20, 300)
    return colour, normal_map(blur(height, 1.0), 7.0)


def masonry(shape, rng, courses, per_course, joint, shift=0.5, vary=0.25):
    """Course-laid blocks: block id, distance to the joint in pixels, (row, column) of each
    texel."""
    height, width = shape
    y, x = np.mgrid[0:height, 0:width].astype(float)
    row = np.floor(y / height * courses).astype(int)
    edge_y = (y / height * courses - row) * height / courses
    edges = np.zeros((courses, per_course + 1))
    for r in range(courses):
        cut = (np.arange(per_course) + (rng.random(per_course) - 0.5) * vary) / per_course
        start = shift * (r % 2) / per_course
        edges[r, :-1] = cut + start
        edges[r, -1] = edges[r, 0] + 1
    u = x / width
    u = np.where(u < edges[row, 0], u + 1, u)
    column = np.zeros(shape, int)
    for c in range(1, per_course):
        column += u >= edges[row, c]
    left, right = edges[row, column], edges[row, column + 1]
    edge_x = np.minimum(u - left, right - u) * width
    distance = np.minimum(edge_x, np.minimum(edge_y, height / courses - edge_y)) - joint
    return row * per_course + column, distance


def ashlar():
    """Hewn sandstone blocks with lime joints. 2.4 m wide and high, six courses."""
    rng, shape = generator('ashlar'), (1024, 1024)
    wobble = (spectral(shape, rng, 2.0, 4, 60) - 0.5) * 22
    block, distance = masonry(shape, rng, 6, 4, 3.2)
    distance = distance + wobble * 0.25
    stones = block.max() + 1
    tint = np.array([[0.80, 0.73, 0.62], [0.76, 0.70, 0.61], [0.72, 0.665, 0.585],
                     [0.82, 0.765, 0.675]])
    colour = (tint[rng.integers(0, 4, stones)] * (0.94 + 0.12 * rng.random((stones, 1))))[block]
    grain = spectral(shape, rng, 1.2, 8, 400)
    bed = spectral(shape, rng, 2.2, 3, 120, stretch=(1.0, 4.0))
    colour = colour * (0.86 + 0.16 * grain + 0.14 * bed)[..., None]
    soot = smoothstep(0.55, 0.85, spectral(shape, rng, 3.0, 1, 20))
    colour = mix(colour, colour * np.array([0.84, 0.82, 0.80]), soot * 0.6)
    joint = 1 - smoothstep(-1.0, 3.5, distance)
    colour = mix(colour, np.array([0.80, 0.775, 0.72]) * (0.9 + 0.2 * grain[..., None]),
                 joint * 0.85)
    chisel = spectral(shape, rng, 0.6, 30, 160, stretch=(1.0, 0.35))
    height = smoothstep(-1.0, 9.0, distance) * 1.6 + 0.7 * grain + 0.55 * chisel + 0.5 * bed
    return np.clip(colour, 0, 1), normal_map(blur(height, 0.8), 5.0)


def smooth_stone():
    """Dressed limestone without joints, for mouldings, columns and sculpture plinths. 1.5 m."""
    rng, shape = generator('smooth stone'), (512, 512)
    tone = 0.9 + 0.12 * (spectral(shape, rng, 2.4, 1, 40) - 0.5) + 0.08 * (spectral(shape, rng,
        1.0, 30, 250) - 0.5)
    colour = solid(shape, (0.83, 0.775, 0.685)) * tone[..., None]
    pores = smoothstep(0.68, 0.76, spectral(shape, rng, 0.8, 40, 220))
    return mix(colour, colour * 0.8, pores * 0.6)


def veins(shape, rng, count, width, wander):
    """Marble veins: zero crossings of warped noise, thin here and wide there."""
    field = np.zeros(shape)
    for i in range(count):
        noise = spectral(shape, rng, 2.6, 1 + i, 48)
        dy, dx = ((spectral(shape, rng, 2.4, 1, 24) - 0.5) * wander for _ in range(2))
        ridge = np.abs(warp(noise, dy, dx) - 0.5)
        thickness = width * (0.25 + 1.2 * spectral(shape, rng, 3, 1, 8) ** 2) / (1 + 0.6 * i)
        field = np.maximum(field, np.exp(-(ridge / thickness) ** 2) * (1.0 - 0.25 * i))
    return field


def marble_floor():
    """A diagonal chequer of cream and dark green-grey marble with small red corner stones.
    2.4 m square; colour, metallic-roughness picture."""
    rng, size = generator('floor'), 2048
    shape = (size, size)
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size
    cells = 4                                    # diagonal tiles a side: edge 2.4 / 4 / sqrt(2) m
    a, b = (x + y) * cells, (x - y) * cells
    ia, ib = np.floor(a).astype(int), np.floor(b).astype(int)
    fa, fb = a - ia, b - ib
    tile_metres = 2.4 / cells / np.sqrt(2)
    edge = np.minimum(np.minimum(fa, 1 - fa), np.minimum(fb, 1 - fb)) * tile_metres
    dark = (ia + ib) % 2 == 0                    # parity keeps the pattern periodic
    wrap = 2 * cells
    # Tile identity, invariant under a whole period in x or y.
    cx, cy = (ia + ib + 1) % (2 * cells), (ia - ib) % (2 * cells)
    tile = cx * wrap + cy
    count = wrap * wrap
    # Each tile is cut from another place of the slab.
    oy, ox = rng.integers(0, size, count)[tile], rng.integers(0, size, count)[tile]

    pale_vein = veins(shape, rng, 3, 0.018, 150)
    cloud = spectral(shape, rng, 2.8, 2, 60)
    pale = mix(solid(shape, (0.90, 0.855, 0.765)), (0.80, 0.725, 0.61), cloud * 0.8)
    pale = mix(pale, (0.60, 0.49, 0.37), pale_vein * 0.5)
    deep_vein = veins(shape, rng, 3, 0.014, 190)
    deep = mix(solid(shape, (0.29, 0.33, 0.315)), (0.39, 0.425, 0.395), spectral(shape, rng, 2.2,
        2, 90))
    deep = mix(deep, (0.72, 0.74, 0.69), deep_vein * 0.55)
    pale, deep = warp(pale, oy, ox), warp(deep, oy, ox)
    colour = np.where(dark[..., None], deep, pale) * (0.93 + 0.12 * rng.random(count))[tile][...,
        None]

    # Small red stones where four corners meet.
    na, nb = np.rint(a), np.rint(b)
    du, dv = (a - na) * tile_metres, (b - nb) * tile_metres
    diamond = np.maximum(np.abs(du + dv), np.abs(du - dv)) / np.sqrt(2)
    inset = diamond < 0.052
    red = mix(solid(shape, (0.46, 0.20, 0.15)), (0.60, 0.33, 0.24), spectral(shape, rng, 2.0, 6,
        200))
    red = mix(red, (0.80, 0.68, 0.58), veins(shape, rng, 2, 0.012, 100) * 0.5)
    colour = np.where(inset[..., None], red, colour)
    gap = np.where(inset, np.abs(diamond - 0.052), np.minimum(edge, np.abs(diamond - 0.052)))
    joint = 1 - smoothstep(0.0006, 0.0019, gap)
    colour = mix(colour, (0.38, 0.345, 0.30), joint * 0.8)

    wear = spectral(shape, rng, 2.2, 1, 60)
    rough = 0.17 + 0.08 * (wear - 0.3) + 0.03 * (rng.random(count))[tile] + 0.45 * joint
    rough = np.clip(rough[::2, ::2], 0.13, 0.8)
    packed = np.stack([np.ones_like(rough), rough, np.zeros_like(rough)], axis=-1)
    return np.clip(colour, 0, 1), packed


def oak(base=(0.53, 0.355, 0.21), name='oak', gloss=0.42):
    """Quarter-sawn oak, grain along u. 1.2 m long, 0.6 m across; colour, normals, roughness."""
    rng, shape = generator(name), (512, 1024)
    y, x = np.mgrid[0:shape[0], 0:shape[1]].astype(float)
    wave = (spectral(shape, rng, 2.6, 1, 10, stretch=(1.0, 3.0)) - 0.5) * 90
    rings = spectral(shape, rng, 1.4, 5, 90, stretch=(1.0, 40.0))
    rings = warp(rings, wave, np.zeros(shape))
    fibre = spectral(shape, rng, 0.6, 30, 420, stretch=(1.0, 16.0))
    fleck = smoothstep(0.66, 0.78, spectral(shape, rng, 1.0, 14, 90, stretch=(1.0, 5.0)))
    tone = 0.62 + 0.75 * (rings - 0.15) * 0.8 + 0.35 * (fibre - 0.5)
    colour = np.asarray(base) * tone[..., None] * 1.25
    colour = mix(colour, colour * np.array([1.28, 1.25, 1.16]), fleck * 0.55)
    pores = smoothstep(0.62, 0.74, spectral(shape, rng, 0.4, 60, 500, stretch=(1.0, 22.0)))
    colour = mix(colour, colour * 0.55, pores * 0.6)
    height = 0.6 * rings + 0.4 * fibre - 0.5 * pores
    rough = np.clip(gloss + 0.16 * (0.5 - rings) + 0.2 * pores + 0.1 * (spectral(shape, rng, 2, 1,
        20) - 0.5), 0.15, 0.9)
    packed = np.stack([np.ones_like(rough), rough, np.zeros_like(rough)], axis=-1)[::2, ::2]
    return np.clip(colour, 0, 1), normal_map(blur(height, 0.7), 3.0)[::2, ::2], packed


def dark_oak():
    return oak((0.27, 0.175, 0.105), 'dark oak')[0]


def cobbles():
    """Rounded paving stones by nearest points. 2 m."""
    rng, size, count = generator('cobbles'), 768, 18
    grid = np.stack(np.meshgrid(np.arange(count), np.arange(count), indexing='ij'), -1).reshape(-1,
        2)
    points = (grid + 0.5 + (rng.random(grid.shape) - 0.5) * 0.55 + (grid[:, :1] % 2) * [0,
        0.5]) * size / count % size
    y, x = np.mgrid[0:size, 0:size]
    first = np.full((size, size), 1e9)
    second, owner = first.copy(), np.zeros((size, size), int)
    for i, (py, px) in enumerate(points):
        dy, dx = np.abs(y - py), np.abs(x - px)
        d = np.hypot(np.minimum(dy, size - dy), np.minimum(dx, size - dx))
        nearer = d < first
        second = np.where(nearer, first, np.minimum(second, d))
        owner = np.where(nearer, i, owner)
        first = np.where(nearer, d, first)
    gap = second - first
    colour = np.array([0.50, 0.47, 0.43]) * (0.72 + 0.45 * rng.random((len(points), 1)))
    colour = (colour + rng.normal(0, 0.006, colour.shape))[owner]
    colour = colour * (0.8 + 0.4 * spectral((size, size), rng, 1.4, 6, 250))[..., None]
    joint = 1 - smoothstep(1.0, 7.0, gap)
    moss = smoothstep(0.5, 0.75, spectral((size, size), rng, 2.4, 1, 30))
    colour = mix(colour, mix(solid((size, size), (0.28, 0.25, 0.20)), (0.27, 0.32, 0.15), moss),
                 joint * 0.85)
    height = smoothstep(0.0, 22.0, gap) * 3 + 0.4 * spectral((size, size), rng, 1.5, 10, 200)
    return np.clip(colour, 0, 1), normal_map(blur(height, 1.0), 5.0)


def shingles():
    """Weathered wooden roof shingles, eight courses in 1.2 m."""
    rng, shape = generator('shingles'), (512, 512)
    block, distance = masonry(shape, rng, 8, 10, 1.0, vary=0.5)
    colour = (np.array([0.40, 0.30, 0.225]) * (0.65 + 0.6 * rng.random((block.max() + 1,
        1))))[block]
    grain = spectral(shape, rng, 1.0, 10, 250, stretch=(12.0, 1.0))
    y = np.mgrid[0:shape[0], 0:shape[1]][0] / shape[0] * 8 % 1
    colour = colour * (0.7 + 0.5 * grain)[..., None] * (0.75 + 0.3 * y)[..., None]
    colour = mix(colour, (0.10, 0.08, 0.06), (1 - smoothstep(-1, 2, distance)) * 0.85)
    height = 1.5 * y + smoothstep(-1, 2, distance) + 0.4 * grain
    return np.clip(colour, 0, 1), normal_map(height, 3.0)


def roof_tiles():
    """Red beaver-tail clay tiles, eight courses in 1.2 m."""
    rng, shape = generator('roof tiles'), (512, 512)
    block, distance = masonry(shape, rng, 8, 8, 0.8, vary=0.0)
    colour = (np.array([0.60, 0.30, 0.20]) * (0.7 + 0.5 * rng.random((block.max() + 1, 1))))[block]
    y = np.mgrid[0:shape[0], 0:shape[1]][0] / shape[0] * 8 % 1
    colour = colour * (0.62 + 0.45 * y)[..., None] * (0.85 + 0.3 * spectral(shape, rng, 1.5, 5,
        200))[..., None]
    return np.clip(mix(colour, (0.16, 0.08, 0.06), (1 - smoothstep(-1, 2, distance)) * 0.8), 0, 1)


def bronze():
    """Dark polished bronze with green-brown patina in broad clouds; colour, metallic-roughness."""
    rng, shape = generator('bronze'), (512, 512)
    patina = smoothstep(0.35, 0.95, spectral(shape, rng, 2.8, 2, 40))
    fine = spectral(shape, rng, 1.0, 20, 200)
    colour = mix(solid(shape, (0.66, 0.47, 0.29)), (0.40, 0.36, 0.26), patina * 0.75)
    colour = colour * (0.88 + 0.24 * fine)[..., None]
    rough = np.clip(0.25 + 0.20 * patina + 0.10 * (fine - 0.5), 0.12, 0.8)
    return np.clip(colour, 0, 1), np.stack([np.ones_like(rough), rough, 1 - 0.15 * patina], axis=-1)
