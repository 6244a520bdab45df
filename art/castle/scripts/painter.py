# SPDX-License-Identifier: Apache-2.0
"""An oil painter: shapes laid on a canvas, then worked over with thousands of brush strokes.

Canvas coordinates: x 0..aspect to the right, y 0..1 downwards. Colours are sRGB 0..1.
"""
import numpy as np

from .noise import blur, mix, smoothstep, spectral


class Canvas:
    def __init__(self, width, height, colour, rng):
        self.height, self.width, self.rng = height, width, rng
        self.aspect = width / height
        self.y, self.x = (np.mgrid[0:height, 0:width] + 0.5) / height
        self.pixels = np.ones((height, width, 3)) * np.asarray(colour, float)
        self.soft = 1.2 / height

    # -- masks ---------------------------------------------------------------------------------
    def noise(self, slope=2.2, low=1, high=64, stretch=(1.0, 1.0)):
        return spectral((self.height, self.width), self.rng, slope, low, high, stretch)

    def ellipse(self, cx, cy, rx, ry, angle=0.0):
        c, s = np.cos(angle), np.sin(angle)
        u = ((self.x - cx) * c + (self.y - cy) * s) / rx
        v = (-(self.x - cx) * s + (self.y - cy) * c) / ry
        r = np.sqrt(u * u + v * v)
        return 1 - smoothstep(1 - 2 * self.soft / min(rx, ry), 1, r), u, v

    def polygon(self, points, soft=None):
        """Even-odd polygon, edges softened by `soft`."""
        inside = np.zeros(self.x.shape, bool)
        for (x0, y0), (x1, y1) in zip(points, points[1:] + points[:1]):
            if y0 == y1:
                continue
            crosses = ((y0 > self.y) != (y1 > self.y)) & (self.x < x0 + (self.y - y0) * (x1 - x0)
                                                          / (y1 - y0))
            inside ^= crosses
        mask = inside.astype(float)
        return blur_edge(mask, (soft or self.soft) * self.height * 0.6)

    def stroke(self, points, width0, width1=None):
        """A line of round caps whose width runs from width0 to width1."""
        width1 = width0 if width1 is None else width1
        mask = np.zeros(self.x.shape)
        count = len(points) - 1
        for i, ((x0, y0), (x1, y1)) in enumerate(zip(points, points[1:])):
            w0 = width0 + (width1 - width0) * i / count
            w1 = width0 + (width1 - width0) * (i + 1) / count
            dx, dy = x1 - x0, y1 - y0
            t = np.clip(((self.x - x0) * dx + (self.y - y0) * dy) / (dx * dx + dy * dy + 1e-12), 0,
                        1)
            d = np.hypot(self.x - x0 - t * dx, self.y - y0 - t * dy) - (w0 + (w1 - w0) * t) / 2
            mask = np.maximum(mask, 1 - smoothstep(-self.soft, self.soft, d))
        return mask

    # -- paint ---------------------------------------------------------------------------------
    def lay(self, colour, mask, strength=1.0):
        self.pixels = mix(self.pixels, colour, mask * strength)

    def gradient(self, stops, mask=None, strength=1.0):
        """Vertical blend through (y, colour) stops."""
        ys = [s[0] for s in stops]
        colour = np.stack([np.interp(self.y, ys, [s[1][c] for s in stops]) for c in range(3)],
                          axis=-1)
        self.pixels = mix(self.pixels, colour, np.ones(self.x.shape) * strength if mask is None
                          else mask * strength)

    def ball(self, cx, cy, rx, ry, colour, light=(-0.55, -0.6, 0.58), angle=0.0, shine=0.25,
             ambient=0.28, mask=None):
        """A shaded ellipsoid lit from `light` (x right, y down, z towards the eye)."""
        inside, u, v = self.ellipse(cx, cy, rx, ry, angle)
        if mask is not None:
            inside = inside * mask
        z = np.sqrt(np.clip(1 - u * u - v * v, 0, 1))
        light = np.asarray(light) / np.linalg.norm(light)
        c, s = np.cos(-angle), np.sin(-angle)
        lx, ly = light[0] * c - light[1] * s, light[0] * s + light[1] * c
        diffuse = np.clip(u * lx + v * ly + z * light[2], 0, 1)
        glint = np.clip(diffuse, 0, 1) ** 24 * shine
        shaded = np.asarray(colour) * (ambient + (1.08 - ambient) * diffuse)[...,
            None] + glint[..., None]
        self.pixels = mix(self.pixels, np.clip(shaded, 0, 1), inside)

    def ridge(self, base, height, roughness, colour, seed_high=24, fade=None):
        """A line of hills from noise; returns its mask."""
        profile = spectral((64, self.width), self.rng, roughness, 1, seed_high)[0]
        line = base - height * (profile - 0.35)
        mask = smoothstep(-self.soft, self.soft, self.y - line[None, :])
        self.lay(colour, mask)
        if fade:
            depth = np.clip((self.y - line[None, :]) / fade[1], 0, 1)
            self.lay(fade[0], mask * depth)
        return mask, line


def blur_edge(mask, radius):
    if radius < 0.3:
        return mask
    pad = int(radius * 4) + 2
    return blur(np.pad(mask, pad, mode='edge'), radius)[pad:-pad, pad:-pad]


def brush_tips(rng, length, width, angles=16):
    """Stroke stamps for each angle: soft ends, hairy across."""
    size = int(length * 1.1) | 1
    y, x = np.mgrid[0:size, 0:size] - size // 2
    tips = []
    for variant in range(3):
        hairs = rng.random(64)
        for k in range(angles):
            a = np.pi * k / angles
            along, across = x * np.cos(a) + y * np.sin(a), -x * np.sin(a) + y * np.cos(a)
            body = (1 - smoothstep(0.55, 1.0, np.abs(along) / (length / 2))) * (1 - smoothstep(0.7,
                1.0, np.abs(across) / (width / 2)))
            bristle = np.interp(across, np.linspace(-width / 2, width / 2, 64), hairs)
            tips.append((body * (0.62 + 0.38 * bristle), (bristle - 0.5) * body))
    return tips


def oil(pixels, rng, layers=((46, 15, 1.6), (24, 8, 2.2), (12, 4.5, 2.6)), detail=None,
        relief=0.05):
    """Repaints a picture in layers of strokes: (length, width, coverage). Strokes follow the
    contours and take their colour from the picture, so the forms stay and become paint."""
    height, width = pixels.shape[:2]
    canvas = blur(pixels, 6)
    relief_map = np.zeros((height, width))
    for index, (length, breadth, coverage) in enumerate(layers):
        source = blur_edge_picture(pixels, breadth * 0.35)
        gray = blur_edge(source.mean(axis=-1), breadth * 0.8)
        gy, gx = np.gradient(gray)
        drift = spectral((height, width), rng, 2.6, 1, 8) * np.pi * 2.4
        strong = np.hypot(gx, gy)
        along = np.where(strong > 0.004, np.arctan2(gy, gx) + np.pi / 2, drift)
        tips = brush_tips(rng, length, breadth)
        reach = tips[0][0].shape[0] // 2
        count = int(coverage * width * height / (length * breadth))
        ys, xs = rng.integers(0, height, count), rng.integers(0, width, count)
        error = np.abs(canvas - source).mean(axis=-1)
        for i in range(count):
            y, x = ys[i], xs[i]
            if index and error[y, x] < 0.018 and rng.random() < 0.6:
                continue
            k = int(round((along[y, x] + rng.normal(0, 0.18)) / np.pi
                          * 16)) % 16 + 16 * rng.integers(0, 3)
            tip, hair = tips[k]
            y0, y1, x0, x1 = max(0, y - reach), min(height, y + reach + 1), max(0,
                x - reach), min(width, x + reach + 1)
            part = (slice(y0 - y + reach, y1 - y + reach), slice(x0 - x + reach, x1 - x + reach))
            weight = tip[part] * 0.9
            colour = source[y, x] * (1 + rng.normal(0, 0.035)) + rng.normal(0, 0.008, 3)
            canvas[y0:y1, x0:x1] += (colour - canvas[y0:y1, x0:x1]) * weight[..., None]
            relief_map[y0:y1, x0:x1] += (hair[part] - relief_map[y0:y1, x0:x1]) * weight
    if detail is not None:
        canvas = mix(canvas, pixels, detail)
    canvas = canvas * (1 + relief * 2.2 * relief_map[..., None])
    weave_y, weave_x = np.mgrid[0:height, 0:width]
    canvas *= 1 + 0.012 * (np.sin(weave_x * np.pi / 1.5) * np.sin(weave_y * np.pi / 1.5))[..., None]
    varnish = mix(canvas, canvas * np.array([1.0, 0.965, 0.88]), 0.6)
    edge_y, edge_x = (np.mgrid[0:height, 0:width] + 0.5)
    edge = np.minimum(np.minimum(edge_y, height - edge_y), np.minimum(edge_x,
                                                                      width - edge_x)) / height
    return np.clip(varnish * (0.80 + 0.2 * smoothstep(0, 0.09, edge))[..., None], 0, 1)


def blur_edge_picture(pixels, radius):
    return np.stack([blur_edge(pixels[..., c], radius) for c in range(3)], axis=-1)
