# SPDX-License-Identifier: Apache-2.0
"""Matouš, bell founder and chronicler of the castle: a man of about seventy, about 1530."""
FILE = "chronicler"
NUMBERS = {
    "name": "chronicler",
    "title": "The chronicler of the castle: an old bell founder of about 1530, "
             "with face controls and visemes",
    "stature": 1.04,
    "mouth_half": 0.0258, "corner_rise": 0.0030, "lip_upper": 0.0058, "lip_lower": 0.0080,
    "lip_full": 0.95,
    "face_width": 1.02, "jaw_width": 1.07, "chin_width": 1.15, "cheek_full": 0.88,
    "cheekbone": 0.0010, "temple_hollow": 0.004,
    "brow_bone": 0.0032, "nose_width": 1.17, "nose_out": 0.0045, "nose_drop": 0.0032,
    "nose_hump": 0.0012, "nose_bridge": 1.18,
    "neck_width": 1.08, "lid_open": 0.90, "lid_hood": 1.6, "eye_bags": 0.85, "age": 0.95,
    "skin": "dfae90", "red": "c56c5a", "pale": "ebc7ab", "shade": "98644f", "ruddy": 1.2,
    "freckles": 0.0, "spots": 1.0,
    "lip": "b4574d", "lip_dark": "702f2b", "brow": "aaa194", "brow_density": 0.45,
    "brow_thick": 1.5, "iris": ("8798a4", "56707f", "9a8a66"),
    "hair": ("8e8477", "d2c9bb", "efeae1"), "grey": 0.9, "lashes": 0.6, "beard": 0.95,
    "bust": 0.0, "belly": 0.7, "waist": 0.024, "sleeve": 1.16,
}


def tiles():
    import fabric
    return {"robe": (fabric.wool_color, 256, 256), "sable": (fabric.sable_color, 256, 256),
            "doublet": (fabric.doublet_color, 256, 256), "cap": (fabric.black_color, 256, 256)}


def make_looks(look):
    look("robe", (0.03, 0.035, 0.05), 0.85, double_sided=True)
    look("sable", (0.10, 0.055, 0.032), 0.95, double_sided=True)
    look("doublet", (0.20, 0.03, 0.03), 0.6, double_sided=True)
    look("cap", (0.02, 0.02, 0.022), 0.9, double_sided=True)
    look("linen", (0.80, 0.77, 0.70), 0.85, double_sided=True)
    look("gold", (0.80, 0.56, 0.22), 0.3, metallic=1.0)
    look("leather", (0.085, 0.042, 0.022), 0.5)


def make_wear(figure, face):
    import accessories
    import beard
    import dress
    import hair
    import robe
    from assemble import place_head
    for part in (hair.make_hair("hair"), hair.make_strands("hair"), hair.make_fall("hair"),
                 beard.make_beard(face, "hair"),
                 *robe.make_cap("cap", "cap")):
        figure.add(place_head(part))
    for group in (robe.make_gown("robe"), robe.make_facings("sable", "doublet", "gold"),
                  dress.make_sleeves("robe", "sable", "linen")):
        for patch in group:
            figure.add(patch)
    for patch in (robe.make_fur_collar("sable"), robe.make_shirt("linen"), robe.make_chain("gold"),
                  accessories.make_shoes("leather")):
        figure.add(patch)
