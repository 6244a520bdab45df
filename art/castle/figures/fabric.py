# SPDX-License-Identifier: Apache-2.0
"""The tiles of cloth, embroidery, hair and fur. Every colour function repeats with period 1 in u
and v."""
from math import atan2, cos, hypot, pi, sin

from form import bell, clamp, noise, smoothstep
from paint import mixed, rgb, times
from person import WHO


def wrap_noise(u, v, fu, fv, seed):
    """Noise that repeats with the tile: walked on a torus."""
    a, b = 2 * pi * u, 2 * pi * v
    return noise((cos(a) * fu + 3.7 * cos(b) * fv, sin(a) * fu + 2.9 * sin(b) * fv,
                  sin(b) * fv * 1.7 + seed), 1.0, seed)


def weave(u, v, n):
    """Threads over and under, -1..1."""
    i, j = int(u * n), int(v * n)
    over = (i + j) % 4 < 2
    fu, fv = u * n - i, v * n - j
    return (sin(pi * fv) if over else sin(pi * fu)) * 2 - 1


def pomegranate(u, v):
    """The figure of renaissance damask: a lobed fruit between leaves in a pointed oval, staggered;
    0 ground .. 1 figure."""
    best = 0.0
    for du, dv in ((0, 0), (0.5, 0.5), (-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)):
        x, y = u - 0.5 + du, v - 0.5 + dv
        x = (x + 0.5) % 1 - 0.5 if du == 0 else x
        ax = abs(x)
        oval = ax / 0.225 + (abs(y) / 0.46) ** 1.6
        ring = max(bell(oval - 0.95, 0.045), 0.7 * bell(oval - 0.80, 0.022))
        r, a = hypot(x, y - 0.01), atan2(y - 0.01, x)
        petal = 0.112 * (0.78 + 0.22 * abs(cos(4 * a)) ** 0.7)
        flower = smoothstep(petal + 0.006, petal - 0.006, r) * (1 - 0.8 * bell(r - 0.060, 0.008))
        flower *= 1 - 0.7 * smoothstep(0.030, 0.022, r) * smoothstep(0.012, 0.018, r)
        stem = smoothstep(0.012, 0.006, ax) * (-0.34 < y < -0.10)
        leaf = 0.0
        for ly, size in ((-0.19, 1.0), (0.185, 0.75)):
            p, q = ax - 0.045 * size, y - ly - 0.55 * (ax - 0.045 * size)
            leaf = max(leaf, smoothstep(1.08, 0.92, hypot(p / (0.050 * size), q / (0.020 * size))))
        bud = smoothstep(0.034, 0.028, hypot(ax, (y - 0.20) * 0.7))
        best = max(best, ring, flower, leaf, stem, bud)
    return clamp(best)


def gown_color(u, v):
    d = pomegranate(u, v)
    w = weave(u, v, 128)
    c = mixed(rgb("5e1420"), rgb("7d2230"), d)
    return times(c, 1 + 0.10 * w * (1 - 0.5 * d) + 0.10 * wrap_noise(u, v, 2.5, 2.5, 2))


def velvet_color(u, v):
    c = rgb("1d2b2a")
    return times(c, 1 + 0.25 * wrap_noise(u, v, 3, 3, 5) + 0.18 * wrap_noise(u, v, 22, 22, 6))


def linen_color(u, v):
    slub = wrap_noise(u, v * 1.0, 1.5, 14, 7) + wrap_noise(u, v, 14, 1.5, 8)
    return times(rgb("e6dfd0"), 0.985 + 0.045 * weave(u, v, 96) + 0.03 * slub)


def trim_color(u, v):
    """Gold thread on dark silk: an interlaced band between two cords. u along, v across."""
    ground = rgb("2c1418")
    gold = rgb("c99a45")
    thread = 0.5 + 0.5 * sin(2 * pi * (u * 34 + v * 9))
    c = times(ground, 1 + 0.1 * weave(u, v, 40))
    height = 0.0
    for phase in (0.0, 0.5):
        y = 0.5 + 0.24 * sin(2 * pi * (u + phase))
        height = max(height, smoothstep(0.085, 0.055, abs(v - y)))
    for cx in (0.0, 0.5, 1.0):
        height = max(height, smoothstep(0.17, 0.13, abs(u - cx) * 1.6 + abs(v - 0.5)))
    for cx in (0.25, 0.75):
        for cy in (0.24, 0.76):
            height = max(height, smoothstep(0.065, 0.045, hypot((u - cx) * 1.3, v - cy)))
    for edge in (0.06, 0.94):
        height = max(height, smoothstep(0.055, 0.035, abs(v - edge)))
    return mixed(c, times(gold, 0.72 + 0.42 * thread), clamp(height))


def roll_color(u, v):
    """Twisted stripes round the padded roll: wine red, gold cord, dark green."""
    s = (u + v) % 1.0
    cord = 0.5 + 0.5 * sin(2 * pi * (v * 60 - u * 12))
    fine = 1 + 0.10 * weave(u, v, 64)
    c = rgb("6a1a26") if s < 0.62 else rgb("22332f")
    gold = max(bell(s - 0.62, 0.045), bell(s - 0.99, 0.045), bell(s + 0.01, 0.045))
    return mixed(times(c, fine), times(rgb("cfa04a"), 0.65 + 0.45 * cord), clamp(1.3 * gold))


def fur_color(u, v):
    return fur_hairs(u, v, rgb("2e1b10"), rgb("9a7250"), 3)


def fur_hairs(u, v, dark, light, seed):
    """Hair lies along v in tufts whose tips are light and whose gaps are dark."""
    tuft = wrap_noise(u, v, 2.6, 1.3, seed)
    lean = u + 0.05 * tuft
    hairs = wrap_noise(lean, v, 7, 1.1, seed + 1) + 0.7 * wrap_noise(lean, v, 16, 1.7, seed + 2)
    return mixed(dark, light, clamp(0.40 + 0.70 * hairs + 0.45 * tuft))


def leather_color(u, v):
    return times(rgb("4b2d1c"),
                 1 + 0.16 * wrap_noise(u, v, 9, 9, 2)
                 - 0.35 * max(bell(v - 0.12, 0.04), bell(v - 0.88, 0.04)))


def wool_color(u, v):
    """Dark blue broadcloth, a little felted."""
    c = rgb("2b3240")
    return times(c,
                 1 + 0.10 * weave(u, v, 110) + 0.12 * wrap_noise(u, v, 3, 3, 15)
                 + 0.10 * wrap_noise(u, v, 30, 30, 16))


def sable_color(u, v):
    return fur_hairs(u, v, rgb("22140c"), rgb("8a6442"), 13)


def doublet_color(u, v):
    """Silk in a small diamond pattern."""
    a, b = (u * 12 + v * 12) % 1, (u * 12 - v * 12) % 1
    line = max(bell(a - 0.5, 0.10), bell(b - 0.5, 0.10))
    dot = smoothstep(0.16, 0.10, hypot(a if a < 0.5 else a - 1, b if b < 0.5 else b - 1))
    return mixed(times(rgb("6e1d22"), 1 + 0.10 * weave(u, v, 96)), rgb("a8563f"),
                 clamp(0.55 * line + 0.7 * dot))


def black_color(u, v):
    return times(rgb("26242a"),
                 1 + 0.25 * wrap_noise(u, v, 4, 4, 25) + 0.18 * wrap_noise(u, v, 24, 24, 26))


def hair_color(u, v):
    """Strands run along v; u 0 lies at the hairline, where some have turned grey."""
    across = u * 460
    strand = (noise((across, v * 2.0, 0.0), 1.0, 1)
              + 0.8 * noise((across * 2.7, v * 3.0, 0.0), 1.0, 2))
    lock = noise((u * 80, v * 1.6, 0.0), 1.0, 3)
    dark, light, grey_hair = (rgb(t) for t in WHO.hair)
    c = mixed(dark, light, clamp(0.38 + 0.42 * strand + 0.30 * lock))
    grey = smoothstep(0.10, 0.55, noise((across * 1.1, v * 1.2, 0.0), 1.0, 6) + 0.15)
    near = bell((u % 0.5) / 0.5, 0.30)
    c = mixed(c, grey_hair, WHO.grey * grey * near)
    return times(c, 1.0 - 0.30 * smoothstep(0.05, 0.0, v))
