# SPDX-License-Identifier: Apache-2.0
"""Who is being made. One run makes one person: `choose` is called before any other module is
imported, and the modules read their numbers from `WHO`. A person is a module of the folder people/
with

  FILE       name of the figure's file and the beginning of its textures' names
  NUMBERS    what differs from the numbers below
  make_looks(look)         materials besides those of the body
  tiles()                  textures of its own: {look: (colour function, width, height)}
  make_wear(figure, face)  hair, beard, headdress and clothes

It imports what it uses inside these functions, because all other modules want to know the numbers
first.

Lengths in metres, colours as sRGB.
"""
import importlib


class Person:
    def __init__(self):
        # stature: the whole figure is scaled by it
        self.name, self.title, self.stature = "", "", 1.0
        # ---- head
        self.mouth_half = 0.0252  # middle to corner
        self.corner_rise = 0.0022  # how far the corners of the resting mouth stand above its middle
        self.lip_upper, self.lip_lower = 0.0064, 0.0090  # height of the red
        self.lip_full = 1.0  # how far the lips stand out
        self.face_width, self.jaw_width, self.chin_width = 1.0, 1.0, 1.0
        self.chin_out, self.chin_down = 0.0, 0.0
        self.cheek_full = 1.0  # flesh between cheekbone and jaw
        self.cheekbone = 0.0  # stands out by
        self.temple_hollow = 0.0
        self.brow_bone = 0.0
        self.nose_width, self.nose_out, self.nose_drop = 1.0, 0.0, 0.0
        self.nose_hump, self.nose_bridge = 0.0, 1.0
        self.neck_width = 1.0
        self.lid_open = 1.0
        self.lid_hood = 1.0
        self.eye_bags = 0.3
        self.age = 0.35  # depth of the folds: 0 a child .. 1 an old face
        # ---- colours
        self.skin, self.red, self.pale, self.shade = "e8bda4", "d2806f", "f2d3bd", "ad7562"
        self.ruddy = 1.0  # cheeks, nose, chin
        self.freckles = 0.55
        self.spots = 0.0  # of old age
        self.beard = 0.0  # how dense hair covers the skin under the beard
        self.lip, self.lip_dark = "bd7067", "7d3833"
        self.brow, self.brow_density, self.brow_thick = "5a3f2f", 0.85, 1.0
        self.iris = ("77694a", "64695a", "8f6a38")  # inside, outside, ring round the pupil
        self.hair = ("4a3223", "7c573b", "a99c90")  # dark, light and grey strands
        self.grey = 0.62
        self.hairline = True  # hair begins at the hairline of hair.py
        self.lashes = 1.0
        # ---- body
        self.bust, self.belly, self.waist = 1.0, 0.0, 0.0
        self.sleeve = 1.0  # width


WHO = Person()


def choose(name):
    """The module of the person; fills WHO."""
    module = importlib.import_module("people." + name)
    for key, value in module.NUMBERS.items():
        if not hasattr(WHO, key):
            raise KeyError("a person has no '%s'" % key)
        setattr(WHO, key, value)
    return module
