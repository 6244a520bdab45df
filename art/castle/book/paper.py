# SPDX-License-Identifier: Apache-2.0
"""Paper, ink and frames for the book's drawings. Coordinates are of a sheet of 1280 x 960; it is
drawn twice as large and made smaller, so edges are smooth."""
import numpy as np
from PIL import Image, ImageDraw, ImageFilter, ImageFont

WIDTH, HEIGHT, FINER = 1280, 960, 2
INK, RED, BLUE, GOLD = (62, 44, 30), (150, 40, 32), (44, 84, 134), (190, 142, 48)
WATER, STONE = (86, 140, 182), (176, 164, 146)
SERIF = '/usr/share/fonts/truetype/dejavu/DejaVuSerif-Bold.ttf'


def grain(height, width, seed, scales=(4, 16, 64)):
    """Smooth noise, about -1 to 1."""
    rng = np.random.default_rng(seed)
    total = np.zeros((height, width), np.float32)
    for scale in scales:
        small = rng.normal(0, 0.5, (height // scale + 2, width // scale + 2)).astype(np.float32)
        image = Image.fromarray(small).resize((width, height), Image.BICUBIC)
        total += np.asarray(image) / len(scales) ** 0.5
    return total


def parchment(seed=1):
    """A sheet of old paper, darker to its edges."""
    y, x = np.mgrid[-1:1:HEIGHT * 1j, -1:1:WIDTH * 1j]
    edge = np.clip((np.maximum(abs(x), abs(y)) - 0.72) / 0.28, 0, 1) ** 2
    tone = 1 + 0.022 * grain(HEIGHT, WIDTH, seed) - 0.17 * edge
    pixels = np.clip(np.array([240, 226, 194]) * tone[..., None], 0, 255).astype(np.uint8)
    return Image.fromarray(pixels).resize((WIDTH * FINER, HEIGHT * FINER), Image.BICUBIC)


class Sheet:
    """A drawing on parchment."""

    def __init__(self, seed=1):
        self.image = parchment(seed)
        self.draw = ImageDraw.Draw(self.image)

    def _scaled(self, points):
        return [(x * FINER, y * FINER) for x, y in points]

    def line(self, points, colour=INK, width=3):
        points = self._scaled(points)
        self.draw.line(points, colour, int(width * FINER), 'curve')
        radius = width * FINER / 2 - 0.5
        for x, y in (points[0], points[-1]):
            self.draw.ellipse((x - radius, y - radius, x + radius, y + radius), colour)

    def area(self, points, fill, colour=INK, width=3):
        self.draw.polygon(self._scaled(points), fill)
        if width:
            self.line(list(points) + [points[0], points[1]], colour, width)

    def box(self, left, top, right, bottom, fill, colour=INK, width=3):
        self.area([(left, top), (right, top), (right, bottom), (left, bottom)], fill, colour, width)

    def oval(self, x, y, rx, ry, fill, colour=INK, width=3):
        self.draw.ellipse([v * FINER for v in (x - rx, y - ry, x + rx, y + ry)], fill, colour,
                          int(width * FINER))

    def number(self, x, y, text, colour=RED, size=24):
        """A numbered disc, which the text beside the picture explains."""
        self.oval(x, y, size * 0.85, size * 0.85, (250, 243, 222), colour, 3)
        self.words(x, y, text, colour, size)

    def words(self, x, y, text, colour=INK, size=24, anchor='mm'):
        font = ImageFont.truetype(SERIF, size * FINER)
        self.draw.text((x * FINER, y * FINER), str(text), colour, font, anchor)

    def shade(self, mask_points, colour, strength, blur=30, margin=0):
        """A soft colour over an area: glow, shadow. Nothing of it in the sheet's margin."""
        mask = Image.new('L', (WIDTH, HEIGHT))
        ImageDraw.Draw(mask).polygon(mask_points, int(255 * strength))
        mask = mask.filter(ImageFilter.GaussianBlur(blur))
        inside = Image.new('L', mask.size)
        box = (margin, margin, WIDTH - margin, HEIGHT - margin)
        inside.paste(mask.crop(box), box)
        self.image.paste(colour, (0, 0), inside.resize(self.image.size, Image.BICUBIC))

    def border(self):
        for inset, width in ((26, 5), (38, 1.5)):
            self.line([(inset, inset), (WIDTH - inset, inset), (WIDTH - inset, HEIGHT - inset),
                       (inset, HEIGHT - inset), (inset, inset)], INK, width)

    def finished(self, size=(WIDTH, HEIGHT)):
        return self.image.resize(size, Image.LANCZOS)


def framed(picture):
    """A painting in a gilt frame on a dark green wall."""
    y, x = np.mgrid[-1:1:HEIGHT * 1j, -1:1:WIDTH * 1j]
    light = 1.15 - 0.35 * (x * x + (y + 0.3) ** 2) + 0.03 * grain(HEIGHT, WIDTH, 7, (2, 4))
    wall = np.clip(np.array([58, 72, 60]) * light[..., None], 0, 255).astype(np.uint8)
    wall = Image.fromarray(wall)
    scale = min(1060 / picture.width, 780 / picture.height)
    picture = picture.convert('RGB').resize(
        (round(picture.width * scale), round(picture.height * scale)), Image.LANCZOS)
    left, top, border = (WIDTH - picture.width) // 2, (HEIGHT - picture.height) // 2, 34
    shadow = Image.new('L', wall.size)
    ImageDraw.Draw(shadow).rectangle((left - border + 6, top - border + 22,
                                      left + picture.width + border + 6,
                                      top + picture.height + border + 26), 190)
    wall.paste((10, 14, 10), (0, 0), shadow.filter(ImageFilter.GaussianBlur(16)))
    draw = ImageDraw.Draw(wall)
    for i in range(border):                     # a profile: outer edge, hollow, bead, inner edge
        t = i / (border - 1)
        height = 0.75 + 0.25 * np.sin(9.5 * t) + (0.25 if t > 0.86 else 0)
        inset = border - i
        corners = [(left - inset, top - inset), (left + picture.width + inset - 1, top - inset),
                   (left + picture.width + inset - 1, top + picture.height + inset - 1),
                   (left - inset, top + picture.height + inset - 1)]
        for k, facing in enumerate((1.15, 0.8, 0.7, 1.0)):
            tone = tuple(int(min(255, c * height * facing)) for c in (206, 160, 74))
            draw.line([corners[k], corners[(k + 1) % 4]], tone)
    wall.paste(picture, (left, top))
    return wall


def castle_on(sheet, x, y, s, built=1.0):
    wall, roof = (216, 204, 178), (160, 70, 50)
    for dx, wide, tall in ((-250, 60, 120), (40, 150, 86), (165, 90, 110), (245, 64, 150)):
        if built < 1 and dx != 40:
            continue
        sheet.box(x + dx * s, y - tall * s, x + (dx + wide) * s, y, wall)
        peak = 70 if wide < 100 else 40
        sheet.area([(x + (dx - 8) * s, y - tall * s), (x + (dx + wide + 8) * s, y - tall * s),
                    (x + (dx + wide / 2) * s, y - (tall + peak) * s)], roof)
        for k in range(int(wide // 40)):
            wx = x + (dx + 22 + k * 40) * s
            sheet.box(wx - 5 * s, y - tall * .65 * s, wx + 5 * s, y - tall * .4 * s, (70, 56, 46),
                      INK, 1.5)
