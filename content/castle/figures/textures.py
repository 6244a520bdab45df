# SPDX-License-Identifier: Apache-2.0
"""Paints all textures of the storyteller into the folder of the X3D file."""
import os

import fabric
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


def make_textures(figure, folder, size=1024):
    for name, (color, width, height) in TILES.items():
        save(figure, folder, name, fill(width, height, color))
    face = figure.patch("face")
    image = Image(size, size, skin.BASE)
    spread(image, face, face.rest, skin.skin_color)
    image.grow(6)
    save(figure, folder, "skin", image)
    hand = figure.patch("hand_l")
    image = Image(size // 2, size // 2, skin.BASE)
    spread(image, hand, [tag[1] for tag in hand.tags], skin.hand_color)
    image.grow(6)
    save(figure, folder, "hands", image)


def save(figure, folder, name, image):
    texture = "storyteller_%s.jpg" % name
    image.save(os.path.join(folder, texture))
    figure.looks[name].texture = texture
