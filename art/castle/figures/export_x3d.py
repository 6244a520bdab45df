# SPDX-License-Identifier: Apache-2.0
"""Writes a figure as X3D 4.0 XML with one HAnimHumanoid: skeleton, weights, displacers, one shared
skin."""
from xml.sax.saxutils import quoteattr

from form import mul
from patch import vertex_normals

# joint -> segment; the right side mirrors the left
SEGMENTS = {
    "humanoid_root": "sacrum", "sacroiliac": "pelvis", "l_hip": "l_thigh", "l_knee": "l_calf",
    "l_talocrural": "l_talus", "l_tarsometatarsal_2": "l_metatarsal_2",
    "l_metatarsophalangeal_2": "l_tarsal_proximal_phalanx_2",
    "l_tarsal_distal_interphalangeal_2": "l_tarsal_distal_phalanx_2", "vl5": "l5", "vl4": "l4",
    "vl3": "l3",
    "vl2": "l2", "vl1": "l1", "vt12": "t12", "vt11": "t11", "vt10": "t10", "vt9": "t9", "vt8": "t8",
    "vt7": "t7", "vt6": "t6", "vt5": "t5", "vt4": "t4", "vt3": "t3", "vt2": "t2", "vt1": "t1",
    "vc7": "c7",
    "vc6": "c6", "vc5": "c5", "vc4": "c4", "vc3": "c3", "vc2": "c2", "vc1": "c1",
    "skullbase": "skull",
    "l_eyelid_joint": "l_eyelid", "l_eyeball_joint": "l_eyeball", "l_eyebrow_joint": "l_eyebrow",
    "temporomandibular": "jaw", "l_sternoclavicular": "l_clavicle",
    "l_acromioclavicular": "l_scapula",
    "l_shoulder": "l_upperarm", "l_elbow": "l_forearm", "l_radiocarpal": "l_carpal",
    "l_carpometacarpal_1": "l_metacarpal_1",
    "l_metacarpophalangeal_1": "l_carpal_proximal_phalanx_1",
    "l_carpal_interphalangeal_1": "l_carpal_distal_phalanx_1",
    "l_carpometacarpal_2": "l_metacarpal_2",
    "l_metacarpophalangeal_2": "l_carpal_proximal_phalanx_2",
    "l_carpal_proximal_interphalangeal_2": "l_carpal_middle_phalanx_2",
    "l_carpal_distal_interphalangeal_2": "l_carpal_distal_phalanx_2",
    "l_carpometacarpal_3": "l_metacarpal_3",
    "l_metacarpophalangeal_3": "l_carpal_proximal_phalanx_3",
    "l_carpal_proximal_interphalangeal_3": "l_carpal_middle_phalanx_3",
    "l_carpal_distal_interphalangeal_3": "l_carpal_distal_phalanx_3",
    "l_carpometacarpal_4": "l_metacarpal_4",
    "l_metacarpophalangeal_4": "l_carpal_proximal_phalanx_4",
    "l_carpal_proximal_interphalangeal_4": "l_carpal_middle_phalanx_4",
    "l_carpal_distal_interphalangeal_4": "l_carpal_distal_phalanx_4",
    "l_carpometacarpal_5": "l_metacarpal_5",
    "l_metacarpophalangeal_5": "l_carpal_proximal_phalanx_5",
    "l_carpal_proximal_interphalangeal_5": "l_carpal_middle_phalanx_5",
    "l_carpal_distal_interphalangeal_5": "l_carpal_distal_phalanx_5",
}


def segment_of(joint):
    if joint.startswith("r_"):
        return "r_" + SEGMENTS["l_" + joint[2:]][2:]
    return SEGMENTS[joint]


def number(x, digits):
    s = ("%.*f" % (digits, x)).rstrip("0").rstrip(".")
    return "0" if s in ("-0", "") else s


def numbers(values, digits):
    return " ".join(number(x, digits) for v in values for x in v)


def integers(values):
    return " ".join(map(str, values))


class Writer:
    def __init__(self, stream):
        self.stream = stream
        self.depth = 0

    def line(self, tag, attributes, close=True):
        text = "".join(" %s=%s" % (k, quoteattr(str(v))) for k, v in attributes.items())
        self.stream.write("%s<%s%s%s>\n" % ("  " * self.depth, tag, text, "/" if close else ""))
        if not close:
            self.depth += 1

    def end(self, tag):
        self.depth -= 1
        self.stream.write("%s</%s>\n" % ("  " * self.depth, tag))


def collect(figure):
    """Vertices of all patches in one row; which vertices each joint moves and how much."""
    positions, uv, triangles, joints = [], [], [], {}
    for patch, i, index in figure.vertices():
        positions.append(patch.positions[i])
        uv.append(patch.uv[i])
        for joint, w in patch.weights[i].items():
            joints.setdefault(joint, []).append((index, w))
    for patch in figure.patches:
        triangles += [tuple(v + patch.first for v in t) for t in patch.triangles]
    normals = vertex_normals(positions, triangles)
    for patch in figure.patches:
        for i, n in patch.normals.items():
            normals[patch.first + i] = n
    return positions, uv, normals, joints


def write_joint(out, name, skeleton, children, weights, displacers, sites):
    center = skeleton[name][1]
    attributes = {"DEF": "hanim_" + name, "name": name, "center": numbers([center], 5)}
    if name == "humanoid_root":
        attributes["containerField"] = "skeleton"
    if name in weights:
        attributes["skinCoordIndex"] = integers(i for i, _ in weights[name])
        attributes["skinCoordWeight"] = " ".join(number(w, 4) for _, w in weights[name])
    out.line("HAnimJoint", attributes, close=False)
    segment = segment_of(name)
    out.line("HAnimSegment", {"DEF": "hanim_" + segment, "name": segment}, close=name not in sites)
    if name in sites:
        for site, p in sites[name]:
            out.line("HAnimSite",
                     {"DEF": "hanim_" + site, "name": site, "translation": numbers([p], 5)})
        out.end("HAnimSegment")
    for owner, displacer, moved in displacers:
        if owner == name:
            out.line("HAnimDisplacer",
                     {"DEF": displacer, "name": displacer, "containerField": "displacers",
                      "coordIndex": integers(moved), "displacements": numbers(moved.values(), 5)})
    for child in children.get(name, []):
        write_joint(out, child, skeleton, children, weights, displacers, sites)
    out.end("HAnimJoint")


def write_shape(out, patch, look, first, seen):
    out.line("Shape", {"DEF": "shape_" + patch.name, "containerField": "skin"}, close=False)
    if look.name in seen:
        out.line("Appearance", {"USE": "look_" + look.name})
    else:
        seen.add(look.name)
        out.line("Appearance", {"DEF": "look_" + look.name}, close=False)
        out.line("PhysicalMaterial",
                 {"baseColor": numbers([(1, 1, 1) if look.texture else look.color], 4),
                  "metallic": number(look.metallic, 3), "roughness": number(look.roughness, 3)},
                 close=not look.texture)
        if look.texture:
            out.line("ImageTexture",
                     {"containerField": "baseTexture", "url": '"%s"' % look.texture})
            if look.normal_map:
                out.line("ImageTexture",
                         {"containerField": "normalTexture", "url": '"%s"' % look.normal_map})
            out.end("PhysicalMaterial")
        out.end("Appearance")
    out.line("IndexedTriangleSet", {"solid": "false" if look.double_sided else "true",
                                    "index": integers(v + patch.first for t in patch.triangles
                                                      for v in t)}, close=False)
    out.line("Coordinate", {"USE": "skin_points"})
    out.line("Normal", {"USE": "skin_normals"})
    if first is None:
        out.line("TextureCoordinate", {"USE": "skin_texture_points"})
    else:
        out.line("TextureCoordinate", {"DEF": "skin_texture_points", "point": numbers(first, 4)})
    out.end("IndexedTriangleSet")
    out.end("Shape")


def enlarge(figure, skeleton, sites, s):
    """Everything was made for a stature of 1.68 m; tall people are larger all over."""
    if s == 1:
        return skeleton, sites
    for patch in figure.patches:
        patch.positions = [mul(p, s) for p in patch.positions]
    figure.displacers = [(owner, name, {v: mul(d, s) for v, d in moved.items()})
                         for owner, name, moved in figure.displacers]
    return ({name: (parent, mul(c, s)) for name, (parent, c) in skeleton.items()},
            {joint: [(name, mul(p, s)) for name, p in places] for joint, places in sites.items()})


def write_figure(figure, skeleton, sites, path, title, who):
    """`skeleton`: {joint: (parent, centre)}; `sites`: {joint: [(name, place)]}."""
    skeleton, sites = enlarge(figure, skeleton, sites, who.stature)
    positions, uv, normals, weights = collect(figure)
    children = {}
    for name, (parent, _) in skeleton.items():
        children.setdefault(parent, []).append(name)
    with open(path, "w", encoding="utf-8") as stream:
        stream.write('<?xml version="1.0" encoding="UTF-8"?>\n'
                     '<!-- SPDX-License-Identifier: Apache-2.0 -->\n'
                     '<!DOCTYPE X3D PUBLIC "ISO//Web3D//DTD X3D 4.0//EN" '
                     '"https://www.web3d.org/specifications/x3d-4.0.dtd">\n')
        out = Writer(stream)
        out.line("X3D", {"profile": "Full", "version": "4.0"}, close=False)
        out.line("head", {}, close=False)
        for name, content in (("title", title), ("description", who.title),
                              ("creator", "Wellspring"),
                              ("license", "Apache-2.0"), ("generator", "make_figure.py")):
            out.line("meta", {"name": name, "content": content})
        out.end("head")
        out.line("Scene", {}, close=False)
        out.line("HAnimHumanoid",
                 {"DEF": "hanim_" + who.name, "name": who.name, "version": "2.0", "loa": "3",
                  "skeletalConfiguration": "BASIC",
                  "info": '"authorName=Wellspring" "copyright=Apache-2.0" "height=%.2f"' % (
                      1.68 * who.stature)}, close=False)
        out.line("Coordinate",
                 {"DEF": "skin_points", "containerField": "skinCoord",
                  "point": numbers(positions, 5)})
        out.line("Normal",
                 {"DEF": "skin_normals", "containerField": "skinNormal",
                  "vector": numbers(normals, 3)})
        write_joint(out, "humanoid_root", skeleton, children, weights, figure.displacers, sites)
        for name in skeleton:
            out.line("HAnimJoint", {"USE": "hanim_" + name, "containerField": "joints"})
        for name in skeleton:
            out.line("HAnimSegment",
                     {"USE": "hanim_" + segment_of(name), "containerField": "segments"})
        for places in sites.values():
            for name, _ in places:
                out.line("HAnimSite", {"USE": "hanim_" + name, "containerField": "sites"})
        seen = set()
        for k, patch in enumerate(figure.patches):
            write_shape(out, patch, figure.looks[patch.look], uv if k == 0 else None, seen)
        out.end("HAnimHumanoid")
        out.end("Scene")
        out.end("X3D")
