# SPDX-License-Identifier: Apache-2.0
"""Painting tools: images as rows of sRGB floats, patches spread over a texture, small colour
sums."""
from array import array
from functools import lru_cache

from form import clamp


def mixed(a, b, t):
    return (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t)


def times(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


@lru_cache(maxsize=None)
def rgb(text):
    return tuple(int(text[i:i + 2], 16) / 255 for i in (0, 2, 4))


def linear(text):
    return tuple(c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in rgb(text))


class Image:
    def __init__(self, width, height, ground=(0.5, 0.5, 0.5)):
        self.width, self.height = width, height
        self.pixels = array("f", [*ground, 1.0]) * (width * height)
        self.done = bytearray(width * height)

    def put(self, x, y, color):
        i = y * self.width + x
        self.done[i] = 1
        self.pixels[4 * i] = clamp(color[0])
        self.pixels[4 * i + 1] = clamp(color[1])
        self.pixels[4 * i + 2] = clamp(color[2])

    def grow(self, steps):
        """Spreads painted texels into unpainted neighbours, so that filtering meets no ground
        colour."""
        w, h, pixels = self.width, self.height, self.pixels
        edge = [i for i in range(w * h) if self.done[i]]
        for _ in range(steps):
            fresh = []
            for i in edge:
                x, y = i % w, i // w
                for j, ok in ((i - 1, x > 0), (i + 1, x < w - 1), (i - w, y > 0),
                              (i + w, y < h - 1)):
                    if ok and not self.done[j]:
                        self.done[j] = 1
                        pixels[4 * j:4 * j + 3] = pixels[4 * i:4 * i + 3]
                        fresh.append(j)
            edge = fresh

    def save(self, path, quality=92):
        import bpy
        image = bpy.data.images.new("texture", self.width, self.height, alpha=False,
                                    float_buffer=False)
        image.pixels.foreach_set(self.pixels)
        image.filepath_raw = path
        image.file_format = "JPEG"
        bpy.context.scene.render.image_settings.quality = quality
        image.save()
        bpy.data.images.remove(image)


def fill(width, height, color):
    """An image of color(u, v), u and v 0..1 from the lower left."""
    image = Image(width, height)
    for y in range(height):
        v = (y + 0.5) / height
        for x in range(width):
            image.put(x, y, color((x + 0.5) / width, v))
    return image


def texels(patch, points, width, height, done):
    """(x, y, point) of every texel `patch` covers in its texture, `points` interpolated over each
    triangle; those that are `done` are left out."""
    w, h = width, height
    for a, b, c in patch.triangles:
        (ax, ay), (bx, by), (cx, cy) = [(patch.uv[i][0] * w - 0.5, patch.uv[i][1] * h - 0.5)
                                        for i in (a, b, c)]
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if abs(area) < 1e-9:
            continue
        pa, pb, pc = points[a], points[b], points[c]
        for y in range(max(0, int(min(ay, by, cy))), min(h - 1, int(max(ay, by, cy)) + 1) + 1):
            for x in range(max(0, int(min(ax, bx, cx))), min(w - 1, int(max(ax, bx, cx)) + 1) + 1):
                s = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area
                t = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area
                if s < -0.02 or t < -0.02 or s + t > 1.02 or done[y * w + x]:
                    continue
                r = 1 - s - t
                yield x, y, (pa[0] * r + pb[0] * s + pc[0] * t, pa[1] * r + pb[1] * s + pc[1] * t,
                             pa[2] * r + pb[2] * s + pc[2] * t)


def spread(image, patch, points, color):
    """Paints `patch` into its texture: color(point)."""
    for x, y, p in texels(patch, points, image.width, image.height, image.done):
        image.put(x, y, color(p))
