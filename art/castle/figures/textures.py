# SPDX-License-Identifier: Apache-2.0
"""Paints all textures of a person into the folder of the X3D file."""
import os

import fabric
import relief
import skin
from paint import Image, fill, spread

TILES = {  # look: (colour, width, height)
    "eye": (skin.eye_color, 512, 512),
    "mouth": (skin.mouth_color, 16, 64),
    "gown": (fabric.gown_color, 512, 512),
    "velvet": (fabric.velvet_color, 256, 256),
    "linen": (fabric.linen_color, 256, 256),
    "trim": (fabric.trim_color, 256, 128),
    "roll": (fabric.roll_color, 128, 128),
    "fur": (fabric.fur_color, 256, 256),
    "leather": (fabric.leather_color, 256, 64),
    "hair": (fabric.hair_color, 1024, 256),
}


def make_textures(figure, who, folder, wanted=None, size=1024):
    """`wanted`: names of the textures to paint (None: all); the others are taken as they lie
    there."""
    def save(name, paint):
        texture = "%s_%s.jpg" % (who.FILE, name)
        if wanted is None or name in wanted:
            paint().save(os.path.join(folder, texture))
        figure.looks[name].texture = texture

    def save_map(name, make):
        picture = "%s_%s_normal.jpg" % (who.FILE, name)
        if wanted is None or name + "_normal" in wanted:
            make().save(os.path.join(folder, picture), 95)
        figure.looks[name].normal_map = picture

    def spread_over(patch, points, color, side, ground):
        image = Image(side, side, ground)
        spread(image, patch, points, color)
        image.grow(6)
        return image

    for name, (color, width, height) in {**TILES, **who.tiles()}.items():
        if name in figure.looks:
            save(name, lambda: fill(width, height, color))
    face, hand = figure.patch("face"), figure.patch("hand_l")
    save("skin", lambda: spread_over(face, face.rest, skin.skin_color, size, skin.BASE))
    save_map("skin", lambda: relief.make_skin_map(face, size))
    save_map("hair", lambda: relief.make_hair_map(1024, 256))
    save("hands",
         lambda: spread_over(hand, [tag[1] for tag in hand.tags], skin.hand_color, size // 2,
                             skin.BASE))
