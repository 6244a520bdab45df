# SPDX-License-Identifier: Apache-2.0
"""Puts a person together: looks, surfaces, weights."""
import eyes
import face
import hand
import mouth
import rig
from face_form import HEAD, asymmetry
from form import add
from paint import linear
from patch import Figure, Look
from person import WHO
from skin import texture_place


def make_looks(figure, who):
    def look(name, color, roughness, **rest):
        return figure.look(Look(name, color, roughness, **rest))

    skin = linear(WHO.skin)
    look("skin", skin, 0.46)
    look("hands", skin, 0.52)
    look("flesh", (0.62, 0.26, 0.22), 0.22)
    look("eye", (0.8, 0.78, 0.75), 0.06)
    look("lash", (0.018, 0.012, 0.010) if WHO.lashes > 0.7 else (0.09, 0.065, 0.05), 0.6,
         double_sided=True)
    look("brow", linear(WHO.brow), 0.6, double_sided=True)
    look("mouth", (0.32, 0.07, 0.065), 0.35, double_sided=True)
    look("tooth", (0.88, 0.84, 0.75), 0.2)
    look("gum", (0.55, 0.20, 0.19), 0.3, double_sided=True)
    look("tongue", (0.55, 0.19, 0.18), 0.35)
    look("hair", linear(WHO.hair[0]), 0.42, double_sided=True)
    who.make_looks(look)


def place_head(patch, weights=None):
    """Head space to figure space."""
    patch.drop_unused()
    patch.rest = list(patch.positions)  # displacers work in head space
    if weights:
        patch.weights = [weights(p, tag) for p, tag in zip(patch.positions, patch.tags)]
    bends = patch.name in ("face", "mouth")
    patch.positions = [add(asymmetry(p) if bends else p, HEAD) for p in patch.positions]
    return patch


def make_person(who):
    figure = Figure()
    make_looks(figure, who)
    skin = face.make_face("skin")
    skin.uv = [texture_place(plane) for plane in skin.uv]
    parts = [eyes.make_eyeball(1, "eye"), eyes.make_eyeball(-1, "eye"),
             eyes.make_lid_rims(skin, "flesh"),
             eyes.make_lashes(skin, "lash"), eyes.make_brows("brow"),
             mouth.make_lining(skin, "mouth"), *mouth.make_teeth(True, "tooth", "gum"),
             *mouth.make_teeth(False, "tooth", "gum"), mouth.make_tongue("tongue")]
    for part in [skin] + parts:
        figure.add(place_head(part, rig.head_weights if part is skin else None))
    for patch in hand.make_hands("hands"):
        figure.add(patch)
    who.make_wear(figure, skin)
    return figure
