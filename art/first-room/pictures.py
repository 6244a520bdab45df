# SPDX-License-Identifier: Apache-2.0
"""The pictures of the potter's room, computed: arrays of rows from above, sRGB from 0 to 1."""
import numpy as np


def noise(height, width, cells, seed, stretch=1.0, roughness=1.6):
    """Clouds that repeat at the edges, with a mean of 0 and a deviation of 1. `cells`: how many
    of the largest there are across; `stretch` times longer than high."""
    rows = np.fft.fftfreq(height)[:, None] * height
    columns = np.fft.fftfreq(width)[None, :] * width * stretch
    size = np.hypot(rows, columns)
    power = np.where(size < cells, 0, np.maximum(size, 1.0) ** -roughness)
    made = np.fft.ifft2(np.fft.fft2(np.random.default_rng(seed).normal(size=(height, width)))
                        * power).real
    return (made - made.mean()) / made.std()


def colour(code):
    return np.array([int(code[i:i + 2], 16) / 255 for i in (0, 2, 4)])


def mix(one, other, share):
    return one + (other - one) * np.clip(share, 0, 1)[..., None]


def grid(height, width):
    """x and y of each pixel's middle, 0 to 1, y upwards."""
    return np.meshgrid((np.arange(width) + 0.5) / width,
                       1 - (np.arange(height) + 0.5) / height)


def step(edge, value, soft=0.004):
    return np.clip((value - edge) / soft + 0.5, 0, 1)


def bumps(relief, strength):
    """A normal map of a relief."""
    dx = np.roll(relief, -1, 1) - np.roll(relief, 1, 1)
    dy = np.roll(relief, -1, 0) - np.roll(relief, 1, 0)
    normal = np.stack([-strength * dx, strength * dy, np.ones_like(dx)], axis=-1)
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True) * 0.5 + 0.5


def wood(dark, light, seed):
    """Fibres along the rows, and the waves of the year rings."""
    fibres = noise(512, 512, 2, seed, stretch=24, roughness=0.7)
    rings = noise(512, 512, 1, seed + 1, stretch=7, roughness=2.6)
    waves = np.abs((rings * 2.2) % 2 - 1)
    tint = noise(512, 512, 1, seed + 2, roughness=2)
    share = 0.5 + 0.28 * (waves - 0.5) + 0.16 * fibres + 0.08 * tint
    return mix(colour(dark), colour(light), share)


def plaster():
    share = 0.5 + 0.10 * noise(512, 512, 2, 11) + 0.05 * noise(512, 512, 30, 12, roughness=0.6)
    return mix(colour('e6dcc8'), colour('f8f2e6'), share)


def plaster_relief():
    return bumps(noise(512, 512, 5, 13, roughness=1.9), 0.35)


def glaze(body, low, high, inside, seed, speckles=0.0):
    """A fired vessel, foot to lip in the lower three quarters, then its inside: bare clay, a wavy
    edge where the glaze ran, a lip where it is thin."""
    x, y = grid(256, 512)
    run = noise(256, 512, 3, seed, roughness=2.4)[0]
    edge = 0.10 + 0.018 * run[None, :] + 0.012 * np.sin(2 * np.pi * (3 * x + 0.2 * run[None, :]))
    cloud = noise(256, 512, 3, seed + 1)
    tone = mix(colour(low), colour(high), (y / 0.75 - 0.15) + 0.16 * cloud)
    tone = mix(tone, colour(low) * 0.72, 0.8 * step(-0.03, -np.abs(y - edge - 0.02), 0.03))
    if speckles:
        tone = mix(tone, colour('3a2413'), step(3 - speckles, noise(256, 512, 40, seed + 2,
                                                                      roughness=0.3), 0.3) * 0.8)
    tone = mix(colour(body) * (1 + 0.05 * cloud[..., None]), tone, step(edge, y, 0.012))
    tone = mix(tone, colour(inside) * (1 + 0.04 * cloud[..., None]), step(0.745, y, 0.02))
    return mix(tone, colour(body) * 0.9, 0.7 * step(-0.014, -np.abs(y - 0.745), 0.012))


def flower(paint, x, y, at, size, petals, tones):
    """Petals round a heart, outlined; the picture comes round again."""
    dx, dy = 0.8 * ((x - at[0] + 0.5) % 1 - 0.5), y - at[1]
    far, turn = np.hypot(dx, dy) / size, np.arctan2(dy, dx)
    rim = 0.72 + 0.28 * np.abs(np.cos(petals * turn / 2))
    for reach, tone in ((1.0, tones[0]), (0.90, tones[1]), (0.55, tones[2]), (0.26, tones[3])):
        paint = mix(paint, colour(tone), step(0, reach * rim - far, 0.03))
    veins = (np.abs(np.sin(petals * turn / 2)) < 0.10) & (far > 0.3) & (far < 0.8 * rim)
    return mix(paint, colour(tones[0]), 0.8 * veins)


def leaf(paint, x, y, at, size, turn, tone):
    dx, dy = 0.8 * ((x - at[0] + 0.5) % 1 - 0.5), y - at[1]
    along = (dx * np.cos(turn) + dy * np.sin(turn)) / size
    across = (-dx * np.sin(turn) + dy * np.cos(turn)) / size
    shape = 0.34 * np.sin(np.pi * np.clip(along, 0, 1)) - np.abs(across)
    shape = np.where((along > 0) & (along < 1), shape, -1)
    paint = mix(paint, colour('22345e'), step(-0.03, shape, 0.03))
    paint = mix(paint, colour(tone), step(0.02, shape, 0.03))
    return mix(paint, colour('22345e'), 0.7 * step(-0.02, -np.abs(across), 0.02)
               * step(0.04, shape, 0.03))


def faience():
    """Half of the large vase: tin white with flowers in cobalt, yellow, green and manganese."""
    x, y = grid(1024, 1024)
    cloud = noise(1024, 1024, 4, 21)
    paint = mix(colour('ece8dd'), colour('f7f4ec'), 0.5 + 0.2 * cloud)
    blue, yellow, green, plum = '27448f', 'e0a92b', '4f8a45', '7a3d5e'
    y = np.clip(y / 0.75, 0, 1)
    for low, high, tone in ((0.05, 0.075, blue), (0.085, 0.092, blue), (0.80, 0.806, blue),
                            (0.815, 0.855, yellow), (0.864, 0.870, blue), (0.975, 1.1, blue),
                            (0.16, 0.185, yellow), (0.15, 0.155, blue), (0.19, 0.195, blue)):
        paint = mix(paint, colour(tone), step(low, y) * step(-high, -y) * (0.9 + 0.05 * cloud))
    vine = 0.47 + 0.085 * np.sin(2 * np.pi * x)
    paint = mix(paint, colour(green), step(-0.008, -np.abs(y - vine)))
    for n in range(4):
        at = n / 4 + 0.06
        height = 0.47 + 0.085 * np.sin(2 * np.pi * at)
        way = (-1) ** n
        paint = leaf(paint, x, y, (at, height), 0.13, way * 1.0 + 0.3, green)
        paint = leaf(paint, x, y, (at + 0.03, height), 0.10, -way * 0.9 + 0.2, '86ab3e')
    for at, height, size, petals, tones in (
            (0.25, 0.545, 0.15, 8, (blue, '4f74c4', 'dfe6f3', yellow)),
            (0.75, 0.400, 0.14, 6, (plum, 'a8648a', 'f0d9df', yellow)),
            (0.50, 0.655, 0.075, 5, (blue, yellow, 'f4dd92', plum)),
            (1.00, 0.290, 0.075, 5, (blue, yellow, 'f4dd92', plum)),
            (0.02, 0.690, 0.060, 6, (blue, '6f8fd2', 'eef1f7', yellow)),
            (0.48, 0.280, 0.060, 6, (blue, '6f8fd2', 'eef1f7', yellow))):
        paint = flower(paint, x, y, (at, height), size, petals, tones)
    for n in range(16):  # a row of drops round the neck
        paint = leaf(paint, x, y, (n / 16, 0.882), 0.05, np.pi / 2, blue)
    return mix(paint, colour('f3efe4'), step(0.995, y))


def hills(height, width, sky, lands, seed, sun=None):
    """Ridge behind ridge, under a sky of two colours."""
    x, y = grid(height, width)
    cloud = noise(height, width, 2, seed, stretch=2.5, roughness=1.9)
    paint = mix(colour(sky[0]), colour(sky[1]), (y - 0.45) * 1.9)
    paint = mix(paint, colour(sky[2]), 0.55 * step(0.7, cloud, 1.6) * step(0.5, y, 0.3))
    if sun:
        far = np.hypot((x - sun[0]) * width / height, y - sun[1])
        paint = mix(paint, colour('fff0c4'), np.exp(-(far / 0.16) ** 2) * 0.8 + step(-0.035, -far))
    for n, tone in enumerate(lands):
        line = noise(8, width, 1.5 + n, seed + n, roughness=1.7)[0][None, :]
        line = 0.56 - 0.115 * n + 0.045 * line
        grain = noise(height, width, 12, seed + 20 + n, stretch=0.5, roughness=1.0)
        tone = colour(tone) * (1 + (0.02 + 0.035 * n) * grain[..., None])
        paint = mix(paint, tone, step(0, line - y, 0.006))
    return np.clip(paint, 0, 1)


def painting():
    """An evening with a castle on a hill, in short strokes."""
    paint = hills(768, 1024, ('f0b878', '7f95b8', 'f6d9b0'),
                  ('8d8fa8', '6f7f86', '5d6f52', '3f5538', '2d3b28'), 31, sun=(0.30, 0.60))
    x, y = grid(768, 1024)
    x = x * 4 / 3
    castle = np.zeros_like(x)
    mound = 0.555 - 0.9 * (x - 0.98) ** 2
    for left, right, top in ((0.86, 1.10, 0.61), (0.90, 0.945, 0.70), (1.04, 1.075, 0.675),
                             (0.965, 1.02, 0.645)):
        castle = np.maximum(castle, step(left, x) * step(-right, -x) * step(0, top - y))
    paint = mix(paint, colour('4d5a55'), step(0, mound - y) * step(0.40, y, 0.03))
    paint = mix(paint, colour('5c5550'), castle * step(0, y - mound))
    for middle, top, wide in ((0.9225, 0.70, 0.035), (1.0575, 0.675, 0.028)):
        roof = step(0, (1 - (y - top) / 0.07) * wide - np.abs(x - middle)) * step(top, y)
        paint = mix(paint, colour('7d4032'), roof)
    river = 0.62 + 0.16 * np.sin(9 * y) - 0.3 * y
    paint = mix(paint, colour('e9c79a'), 0.8 * step(0, (0.30 - y) * 0.22 - np.abs(x - river))
                * step(0, 0.29 - y))
    strokes = noise(768, 1024, 20, 33, stretch=3, roughness=0.8)
    return np.clip(paint * (1 + 0.035 * strokes[..., None]), 0, 1)


def window_view():
    return hills(512, 512, ('dfe8ee', '9fc0e4', 'ffffff'),
                 ('8d9bac', '5c676e', '49533f', '3b442e'), 44)


def dial():
    """Strokes for the hours, hands at twenty past ten."""
    x, y = grid(512, 512)
    x, y = 2 * x - 1, 2 * y - 1
    far, turn = np.hypot(x, y), np.arctan2(x, y) % (2 * np.pi)
    paint = mix(colour('efe6cf'), colour('f8f2e2'), 0.5 + 0.2 * noise(512, 512, 3, 51))
    ink = colour('2a2320')
    hour = np.abs((turn / (2 * np.pi) * 12 + 0.5) % 1 - 0.5) * far * np.pi / 6
    minute = np.abs((turn / (2 * np.pi) * 60 + 0.5) % 1 - 0.5) * far * np.pi / 30
    soft = 0.008
    paint = mix(paint, ink, step(-0.020, -hour, soft) * step(0.60, far, soft)
                * step(-0.80, -far, soft))
    paint = mix(paint, ink, step(-0.006, -minute, soft) * step(0.85, far, soft)
                * step(-0.92, -far, soft))
    paint = mix(paint, ink, step(-0.006, -np.abs(far - 0.93), soft))
    for angle, reach, wide in ((310, 0.50, 0.036), (120, 0.78, 0.024)):
        a = np.radians(angle)
        along, across = x * np.sin(a) + y * np.cos(a), np.abs(x * np.cos(a) - y * np.sin(a))
        shape = step(across, wide * (1.2 - along / reach), soft)
        paint = mix(paint, ink, shape * step(-0.12, along, soft) * step(-reach, -along, soft))
    return mix(paint, ink, step(-0.06, -far, soft))


def rug():
    """Woven stripes with a row of diamonds."""
    x, y = grid(512, 768)
    tones = [colour(code) for code in ('7d2f2a', 'c9a25f', '31465c', 'e3d5b4', '7d2f2a', '49613f')]
    wide = np.array([3, 1, 2, 0.6, 3, 1.2])
    place = (np.abs(y - 0.5) * 2 * 1.7 * wide.sum()) % wide.sum()
    paint, low = np.zeros((512, 768, 3)), 0.0
    for tone, size in zip(tones, wide):
        paint[(place >= low) & (place < low + size)] = tone
        low += size
    diamond = np.abs((x * 12) % 1 - 0.5) + np.abs(y - 0.5) * 6
    for reach, tone in ((0.62, 'e3d5b4'), (0.5, '31465c'), (0.3, 'c9a25f'), (0.14, '7d2f2a')):
        paint = mix(paint, colour(tone), step(0, reach - diamond, 0.03))
    threads = 0.06 * np.sin(2 * np.pi * x * 190) + 0.05 * noise(512, 768, 9, 61, stretch=5)
    return np.clip(paint * (0.95 + threads[..., None]), 0, 1)


def all_pictures():
    """Name, pixels, and whether they are numbers and no colours."""
    yield 'plaster', plaster(), False
    yield 'plaster relief', plaster_relief(), True
    yield 'floor light', wood('8a5c34', 'b98a57', 1), False
    yield 'floor dark', wood('6d4526', 'a3744a', 4), False
    yield 'oak', wood('54351f', '8f6238', 7), False
    yield 'walnut', wood('2f1c12', '5f3d26', 9), False
    yield 'celadon', glaze('a9805c', '6d927a', 'a9c6ac', 'b7cfb6', 101, 0.3), False
    yield 'tenmoku', glaze('8d6446', '1d1210', '5b2d18', '2a1712', 104), False
    yield 'cobalt', glaze('b08a66', '15265c', '3f66ad', '9db4d6', 107), False
    yield 'honey', glaze('9a6a45', '9a5a18', 'd99a3a', 'e0b366', 110, 0.4), False
    yield 'oatmeal', glaze('8f6547', 'c9bda2', 'e6dfcc', 'e9e2d1', 113, 1.0), False
    yield 'copper red', glaze('b59a84', '4f0f12', 'a32a24', 'd9c4b4', 116), False
    yield 'turquoise', glaze('a07a58', '1c5f68', '58aaa6', 'a6d2c9', 119, 0.2), False
    yield 'bare clay', glaze('a5714e', 'a5714e', 'b98059', 'a5714e', 122), False
    yield 'faience', faience(), False
    yield 'painting', painting(), False
    yield 'view', window_view(), False
    yield 'dial', dial(), False
    yield 'rug', rug(), False
