# SPDX-License-Identifier: Apache-2.0
"""The skeleton (H-Anim level of articulation 3, all 94 joints) and the weights that tie surfaces to
it."""
from face_form import EYE, HEAD, MOUTH_HALF, part_y
from form import add, clamp, curve, lerp, smoothstep

SPINE = ["vl5", "vl4", "vl3", "vl2", "vl1", "vt12", "vt11", "vt10", "vt9", "vt8", "vt7", "vt6",
         "vt5", "vt4",
         "vt3", "vt2", "vt1", "vc7", "vc6", "vc5", "vc4", "vc3", "vc2", "vc1"]
SPINE_Y = [1.000, 1.030, 1.060, 1.089, 1.118, 1.146, 1.173, 1.199, 1.224, 1.248, 1.272, 1.295,
           1.317, 1.338,
           1.359, 1.380, 1.401, 1.421, 1.437, 1.453, 1.468, 1.483, 1.498, 1.512]
SPINE_Z = [(1.000, -0.030), (1.12, -0.036), (1.25, -0.062), (1.35, -0.062), (1.42, -0.042),
           (1.512, -0.004)]
SKULLBASE = (0.0, 1.524, 0.010)

# the arm hangs beside the body, a hand's breadth away at the wrist
SHOULDER = (0.150, 1.352, -0.022)
ELBOW = (0.196, 1.098, -0.030)
WRIST = (0.226, 0.862, -0.008)
HIP, KNEE, ANKLE = (0.088, 0.880, 0.000), (0.090, 0.478, 0.012), (0.090, 0.078, -0.022)


def make_joints():
    """{name: (parent, centre)}, parents before children."""
    from hand import finger_joints
    joints = {"humanoid_root": (None, (0.0, 0.900, 0.0)),
              "sacroiliac": ("humanoid_root", (0.0, 0.930, -0.010))}
    for side, s in (("l", 1), ("r", -1)):
        chain = [("hip", "sacroiliac", HIP), ("knee", "hip", KNEE), ("talocrural", "knee", ANKLE),
                 ("tarsometatarsal_2", "talocrural", (0.093, 0.040, 0.030)),
                 ("metatarsophalangeal_2", "tarsometatarsal_2", (0.097, 0.020, 0.095)),
                 ("tarsal_distal_interphalangeal_2", "metatarsophalangeal_2",
                  (0.098, 0.012, 0.125))]
        for name, parent, c in chain:
            parent = parent if parent == "sacroiliac" else side + "_" + parent
            joints[side + "_" + name] = (parent, (s * c[0], c[1], c[2]))
    last = "humanoid_root"
    for name, y in zip(SPINE, SPINE_Y):
        joints[name] = (last, (0.0, y, curve(SPINE_Z, y)))
        last = name
    joints["skullbase"] = (last, SKULLBASE)
    for side, s in (("l", 1), ("r", -1)):
        eye = add(HEAD, (s * EYE[0], EYE[1], EYE[2]))
        joints[side + "_eyelid_joint"] = ("skullbase", eye)
        joints[side + "_eyeball_joint"] = ("skullbase", eye)
        joints[side + "_eyebrow_joint"] = ("skullbase", add(HEAD, (s * 0.030, 0.022, 0.078)))
    joints["temporomandibular"] = ("skullbase", add(HEAD, (0.0, TMJ[1], TMJ[2])))
    for side, s in (("l", 1), ("r", -1)):
        chain = [("sternoclavicular", "vt1", (0.022, 1.388, 0.022)),
                 ("acromioclavicular", "sternoclavicular", (0.112, 1.385, -0.022)),
                 ("shoulder", "acromioclavicular", SHOULDER), ("elbow", "shoulder", ELBOW),
                 ("radiocarpal", "elbow", WRIST)]
        for name, parent, c in chain:
            parent = parent if parent == "vt1" else side + "_" + parent
            joints[side + "_" + name] = (parent, (s * c[0], c[1], c[2]))
        for name, parent, c in finger_joints():
            joints[side + "_" + name] = (side + "_" + parent, (s * c[0], c[1], c[2]))
    return joints


TMJ = (0.0, -0.014, 0.008)  # of the jaw hinge, head space


# ---- weights -------------------------------------------------------------------------------------
def blend(pairs):
    """{joint: weight} of (joint, weight) pairs: sums repeated joints, drops traces, normalises."""
    total = {}
    for joint, w in pairs:
        total[joint] = total.get(joint, 0.0) + w
    total = {j: w for j, w in total.items() if w > 0.004}
    top = sorted(total.items(), key=lambda jw: (-jw[1], jw[0]))[:6]
    s = sum(w for _, w in top)
    return {j: w / s for j, w in top}


def scaled(weights, s):
    return ([(j, w * s) for j, w in weights.items()] if isinstance(weights, dict)
            else [(j, w * s) for j, w in weights])


def spine(y):
    """Joints of the back for something at height y."""
    names = ["sacroiliac"] + SPINE
    heights = [0.955] + SPINE_Y
    if y <= heights[0]:
        return [("sacroiliac", 1.0)]
    for i in range(1, len(heights)):
        if y <= heights[i]:
            t = (y - heights[i - 1]) / (heights[i] - heights[i - 1])
            return [(names[i - 1], 1 - t), (names[i], t)]
    return [(names[-1], 1.0)]


def jaw_weight(p, lower=None):
    """How much a point of the face (head space) follows the jaw; `lower`: on the lower lip, when
    that is known."""
    if lower is None:
        lower = p[1] < part_y(abs(p[0]))
    x, y, z = abs(p[0]), p[1], p[2]
    # under the line from hinge to mouth corner
    below = (-0.050 * (z - TMJ[2]) / 0.077 + TMJ[1] - y) * 0.84
    cheek = smoothstep(-0.008, 0.030, below)
    u = x / MOUTH_HALF
    lips = (1 - min(u, 1.0) ** 2.1) ** 0.85  # the opening mouth is an oval
    w = lerp(cheek, 1.0 if lower else 0.0, lips)
    w *= smoothstep(-0.158, -0.108, y) * smoothstep(0.0, 0.035, z)
    return w


def head_weights(p, tag):
    """Skin of head and neck, head space; the tag tells the lips apart."""
    jaw = jaw_weight(p, tag[0] == "lower" if tag and tag[0] in ("upper", "lower") else None)
    h = p[1] + 0.6 * (p[2] + 0.010)
    skull = smoothstep(-0.135, -0.072, h)
    neck = scaled(spine(min(p[1] + HEAD[1], 1.50)), (1 - skull) * (1 - jaw))
    return blend([("temporomandibular", jaw), ("skullbase", skull * (1 - jaw))] + neck)


def shoulder_share(p):
    """How much cloth at the shoulder follows the upper arm: sleeve and cape must agree, or one
    pokes out."""
    x, y = abs(p[0]), p[1]
    return (smoothstep(0.098, 0.180, x + 0.35 * clamp(SHOULDER[1] - y, 0.0, 0.12))
            * smoothstep(1.10, 1.20, y))


def torso_weights(p, arm_share=1.0):
    """Clothing of chest and shoulders, figure space: spine, then collar bone and shoulder
    outwards."""
    side = "l_" if p[0] >= 0 else "r_"
    x = abs(p[0])
    high = smoothstep(1.22, 1.36, p[1])
    clavicle = 0.75 * smoothstep(0.03, 0.13, x) * high
    arm = shoulder_share(p) * arm_share
    rest = (1 - arm) * (1 - clavicle)
    return blend(scaled(spine(p[1]), rest)
                 + [(side + "sternoclavicular", 0.5 * (1 - arm) * clavicle),
                    (side + "acromioclavicular", 0.5 * (1 - arm) * clavicle),
                    (side + "shoulder", arm)])


def arm_weights(p, side):
    """Sleeves and wrists: along the arm; at the shoulder as the cape above."""
    y = p[1]
    s = side + "_"
    elbow = smoothstep(ELBOW[1] + 0.045, ELBOW[1] - 0.045, y)
    wrist = smoothstep(WRIST[1] + 0.022, WRIST[1] - 0.016, y)
    arm = smoothstep(1.25, 1.17, y)
    return blend(scaled(torso_weights(p), 1 - arm)
                 + [(s + "shoulder", arm * (1 - elbow)), (s + "elbow", elbow * (1 - wrist)),
                     (s + "radiocarpal", wrist)])


def skirt_weights(p):
    """The gown below the waist follows pelvis, thighs and shins softly."""
    y = p[1]
    thigh = 0.62 * smoothstep(0.96, 0.60, y)
    shin = 0.70 * smoothstep(0.56, 0.25, y)
    left = smoothstep(-0.13, 0.13, p[0])
    pairs = scaled(spine(y) if y > 0.955 else [("sacroiliac", 1.0)], 1 - thigh)
    for side, share in (("l_", left), ("r_", 1 - left)):
        pairs += [(side + "hip", thigh * share * (1 - shin)), (side + "knee", thigh * share * shin)]
    return blend(pairs)


def make_sites():
    """{joint: [(site, place)]}: end effectors, the view from the eyes, where the voice comes
    from."""
    from hand import LINES, to_figure
    tip = to_figure(LINES[3][3])
    return {"skullbase": [("skull_tip", add(HEAD, (0.0, 0.118, -0.008))),
                          ("skull_view", add(HEAD, (0.0, EYE[1], EYE[2] + 0.016))),
                          ("mouth_pt", add(HEAD, (0.0, -0.0665, 0.102)))],
            "l_radiocarpal": [("l_hand_tip", tip)],
            "r_radiocarpal": [("r_hand_tip", (-tip[0], tip[1], tip[2]))]}
