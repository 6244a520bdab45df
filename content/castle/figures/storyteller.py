# SPDX-License-Identifier: Apache-2.0
"""Puts the storyteller together: looks, surfaces, weights, displacers."""
import accessories
import dress
import eyes
import face
import hair
import hand
import mouth
import rig
from face_form import HEAD, asymmetry
from form import add
from patch import Figure, Look
from skin import texture_place


def make_looks(figure):
    def look(name, color, roughness, **rest):
        return figure.look(Look(name, color, roughness, **rest))

    look("skin", (0.72, 0.47, 0.36), 0.45)
    look("hands", (0.72, 0.47, 0.36), 0.5)
    look("flesh", (0.62, 0.26, 0.22), 0.25)
    look("eye", (0.8, 0.78, 0.75), 0.08)
    look("lash", (0.018, 0.012, 0.010), 0.6, double_sided=True)
    look("mouth", (0.32, 0.07, 0.065), 0.35, double_sided=True)
    look("tooth", (0.78, 0.72, 0.60), 0.2)
    look("gum", (0.55, 0.20, 0.19), 0.3, double_sided=True)
    look("tongue", (0.55, 0.19, 0.18), 0.35)
    look("hair", (0.12, 0.07, 0.045), 0.5, double_sided=True)
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


def place_head(patch, weights=None):
    """Head space to figure space."""
    patch.drop_unused()
    patch.rest = list(patch.positions)  # displacers work in head space
    if weights:
        patch.weights = [weights(p, tag) for p, tag in zip(patch.positions, patch.tags)]
    bends = patch.name in ("face", "mouth")
    patch.positions = [add(asymmetry(p) if bends else p, HEAD) for p in patch.positions]
    return patch


def make_storyteller():
    figure = Figure()
    make_looks(figure)
    skin = face.make_face("skin")
    skin.uv = [texture_place(plane) for plane in skin.uv]
    parts = [eyes.make_eyeball(1, "eye"), eyes.make_eyeball(-1, "eye"), eyes.make_lid_rims(skin, "flesh"),
             eyes.make_lashes(skin, "lash"), mouth.make_lining(skin, "mouth"), *mouth.make_teeth(True, "tooth", "gum"),
             *mouth.make_teeth(False, "tooth", "gum"), mouth.make_tongue("tongue"), hair.make_hair("hair"),
             hair.make_roll("roll"), hair.make_pearls("pearl")]
    for part in [skin] + parts:
        figure.add(place_head(part, rig.head_weights if part is skin else None))
    figure.add(hair.make_veil("linen"))
    for patch in hand.make_hands("hands"):
        figure.add(patch)
    for group in (dress.make_bodice("gown", "trim"), dress.make_skirt("gown", "trim"), dress.make_sleeves("gown", "trim", "linen"),
                  dress.make_cape("velvet", "trim", "fur"), dress.make_collar("linen", "velvet", "gold"),
                  accessories.make_belt("leather", "gold")):
        for patch in group:
            figure.add(patch)
    figure.add(accessories.make_keys("iron"))
    figure.add(accessories.make_shoes("leather"))
    return figure
