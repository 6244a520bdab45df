# SPDX-License-Identifier: Apache-2.0
"""Ludmila, keeper of the keys: a chatelaine of about 1530 in her fifties."""
FILE = "storyteller"
NUMBERS = {
    "name": "storyteller",
    "title": "The storyteller of the castle: a chatelaine of about 1530, "
             "with face controls and visemes",
}


def make_looks(look):
    look("gown", (0.22, 0.022, 0.032), 0.75, double_sided=True)
    look("velvet", (0.020, 0.035, 0.032), 0.85, double_sided=True)
    look("trim", (0.55, 0.36, 0.11), 0.5, double_sided=True)
    look("fur", (0.10, 0.055, 0.032), 0.95)
    look("linen", (0.80, 0.77, 0.70), 0.85, double_sided=True)
    look("roll", (0.25, 0.03, 0.04), 0.7)
    look("pearl", (0.82, 0.78, 0.72), 0.2)
    look("gold", (0.80, 0.56, 0.22), 0.3, metallic=1.0)
    look("iron", (0.35, 0.33, 0.31), 0.38, metallic=1.0)
    look("leather", (0.085, 0.042, 0.022), 0.5)


def tiles():
    return {}


def make_wear(figure, face):
    import accessories
    import dress
    import hair
    from assemble import place_head
    for part in (hair.make_hair("hair"), hair.make_strands("hair"), hair.make_roll("roll"),
                 hair.make_pearls("pearl")):
        figure.add(place_head(part))
    figure.add(hair.make_veil("linen"))
    for group in (dress.make_bodice("gown", "trim"), dress.make_skirt("gown", "trim"),
                  dress.make_sleeves("gown", "trim", "linen"),
                  dress.make_cape("velvet", "trim", "fur"),
                  dress.make_collar("linen", "velvet", "gold"),
                  accessories.make_belt("leather", "gold")):
        for patch in group:
            figure.add(patch)
    figure.add(accessories.make_keys("iron"))
    figure.add(accessories.make_shoes("leather"))
