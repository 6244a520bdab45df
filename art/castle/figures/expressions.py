# SPDX-License-Identifier: Apache-2.0
"""What the face can do: each displacer is a field of small movements over the head, evaluated in
rest.

Fields work in head space and are symmetric unless they name a side. Visemes combine simple
movements with an opening of the jaw, so that one displacer is one mouth shape.
"""
from math import atan2, sin

from eyes import center
from face import LID_POINTS
from face_form import LID_RADIUS, MOUTH_HALF, SMILE_LINE, beside, lower_lip_y, part_y, upper_lip_y
from form import add, bell, clamp, lerp, mul, rotate, smoothstep, sub
from person import WHO
from rig import TMJ

ZERO = (0.0, 0.0, 0.0)


class Vertex:
    """One vertex of the head in rest."""
    __slots__ = ("p", "tag", "part", "jaw", "skin")

    def __init__(self, part, p, tag, jaw):
        self.part, self.p, self.tag, self.jaw = part, p, tag, jaw
        self.skin = self  # the place of the skin whose movements it follows
        if tag and tag[0] == "grown":  # hair moves as the skin at its root
            self.skin = Vertex("face", tag[1], ("lower" if tag[2] else "upper",), jaw)


# ---- eyelids -------------------------------------------------------------------------------------
def lid_place(v):
    """(side, place along the lid ring, distance 0..1 from the margin) or None."""
    tag = v.tag
    if not tag:
        return None
    if tag[0] == "lid":
        return (1 if v.p[0] > 0 else -1), tag[2], tag[1]
    if tag[0] == "rim":
        return tag[3], tag[2], 0.0
    if tag[0] == "lash":
        return tag[2], tag[1], 0.0
    return None


class Lids:
    """Turns lid margins about the eye's centre, so that they stay on the eyeball's curve."""

    def __init__(self, face):
        self.angle = {}
        for k, side in ((0, 1), (1, -1)):
            c = center(side)
            self.angle[side] = [atan2(face.rest[i][1] - c[1], face.rest[i][2] - c[2])
                                for i in face.eye_rings[k][0]]

    def at(self, side, place):
        ring = self.angle[side]
        i = int(place)
        return lerp(ring[i % len(ring)], ring[(i + 1) % len(ring)], place - i)

    def move(self, v, upper, lower, only=None):
        """upper, lower: how far each lid goes towards the closing line (1 closes, negative
        opens)."""
        place = lid_place(v)
        if place is None or (only and place[0] != only):
            return ZERO
        side, k, s = place
        if k == 0 or k == LID_POINTS:
            return ZERO
        is_upper = 0 < k < LID_POINTS
        other = 2 * LID_POINTS - k
        mine, theirs = self.at(side, k), self.at(side, other)
        top, low = (mine, theirs) if is_upper else (theirs, mine)
        meet = lerp(low, top, 0.16)
        meet += 0.012 if not is_upper else -0.014  # overlap: no gap of light
        amount = upper if is_upper else lower
        reach = 0.66 if is_upper else 0.55
        w = clamp(1 - s / reach) ** 1.25
        if w <= 0 or amount == 0:
            return ZERO
        c = center(side)
        turn = (meet - mine) * amount * w
        q = rotate(v.p, c, (1.0, 0.0, 0.0), -turn)
        # the cornea lifts the closing lid a little
        if v.tag[0] == "lid" and is_upper and amount > 0:
            d = sub(q, c)
            n = (d[0] ** 2 + d[1] ** 2 + d[2] ** 2) ** 0.5
            least = LID_RADIUS + 0.00045 * w
            if n < least and abs(d[0]) < 0.0125:
                q = add(c, mul(d, least / n))
        return sub(q, v.p)


# ---- mouth ---------------------------------------------------------------------------------------
def upper_side(v):
    if v.tag and v.tag[0] in ("upper", "lower"):
        return v.tag[0] == "upper"
    if v.tag and v.tag[0] == "lining":
        return v.tag[2]
    return v.p[1] >= part_y(abs(v.p[0]))


def soft(v):
    """1 for skin, fading into the mouth; 0 for teeth, tongue and everything that is not face."""
    if v.part == "face":
        return smoothstep(0.025, 0.055, v.p[2])
    if v.part == "mouth":
        return smoothstep(0.020, 0.004, v.tag[3])
    return 0.0


def near_lips(v, rx=0.026, up=0.017, down=0.020):
    """1 on the lips, fading around them."""
    x = abs(v.p[0])
    top, low = upper_lip_y(min(x, MOUTH_HALF)), lower_lip_y(min(x, MOUTH_HALF))
    y = v.p[1]
    dy = (y - top) / up if y > top else (low - y) / down if y < low else 0.0
    dx = max(0.0, x - 0.9 * MOUTH_HALF) / rx
    return soft(v) * clamp(1 - dy) ** 1.5 * clamp(1 - dx) ** 1.5 if dy < 1 and dx < 1 else 0.0


def corner(v, side, radius=0.019):
    x, y = v.p[0] * side, v.p[1]
    if x < 0:
        return 0.0
    return (soft(v) * bell(x - MOUTH_HALF, radius * (0.85 if x < MOUTH_HALF else 1.0))
            * bell(y - part_y(MOUTH_HALF), radius))


def pull(v, side):
    """How much the skin follows a corner of the mouth: growing from the middle of the lips, so that
    they bend in an arc, most at the corner, fading over the cheek."""
    x = v.p[0] * side
    if x <= 0:
        return 0.0
    return soft(v) * smoothstep(0.0, 0.95 * MOUTH_HALF, x) * bell(x - 1.10 * MOUTH_HALF,
                                                                  0.021) * bell(
v.p[1] - part_y(min(x, MOUTH_HALF)), 0.018)


def nasolabial(v, side):
    """(the fold from the wing of the nose past the mouth, the flesh beside it): what lifts a cheek
    deepens both."""
    if v.part != "face":
        return 0.0, 0.0
    x, y = v.p[0] * side, v.p[1]
    d = beside(x, y, SMILE_LINE)
    ends = soft(v) * smoothstep(-0.078, -0.064, y) * smoothstep(-0.030, -0.040, y) * (x > 0.010)
    return ends * bell(d, 0.0026), ends * bell(d - 0.0080, 0.0065)


def smile(v, side):
    x, y = v.p[0] * side, v.p[1]
    if x < -0.004:
        return ZERO
    k = pull(v, side)
    on_face = soft(v) if v.part == "face" else 0.0
    cheek = on_face * bell(x - 0.038, 0.015) * bell(y + 0.037, 0.015)
    under = on_face * bell(x - 0.034, 0.018) * bell(y + 0.014, 0.007)
    crease, pad = nasolabial(v, side)
    return (side * (0.0058 * k + 0.0010 * cheek + 0.0008 * pad - 0.0002 * crease),
            0.0062 * k + 0.0040 * cheek + 0.0012 * under + 0.0006 * pad,
            -0.0046 * k + 0.0026 * cheek + 0.0005 * under + 0.0018 * pad - 0.0016 * crease)


def cheek_up(v, lids):
    """The muscle round the eye: the cheek rises against the lower lid, which it pushes up and
    wrinkles."""
    total = lids.move(v, 0.06, 0.62)
    if v.part != "face":
        return total
    y = v.p[1]
    for side in (1, -1):
        x = v.p[0] * side
        cheek = soft(v) * bell(x - 0.037, 0.015) * bell(y + 0.028, 0.013)
        under = soft(v) * bell(x - 0.032, 0.017) * bell(y + 0.0125, 0.0055)
        # crow's feet: drawn to the eye
        outer = soft(v) * bell(x - 0.052, 0.009) * bell(y - 0.001, 0.013)
        tail = soft(v) * bell(x - 0.045, 0.012) * bell(y - 0.019, 0.008)
        crease, pad = nasolabial(v, side)
        total = add(total,
                    (-side * (0.0016 * outer + 0.0002 * cheek),
                     0.0038 * cheek + 0.0018 * under - 0.0012 * tail + 0.0006 * pad,
                     0.0022 * cheek + 0.0010 * under + 0.0010 * pad - 0.0008 * crease))
    return total


def frown(v):
    """The corners sink in an arc; the chin pushes the lower lip up."""
    total = ZERO
    for side in (1, -1):
        k = pull(v, side)
        total = add(total, (-side * 0.0004 * k, -0.0062 * k, -0.0012 * k))
    chin = soft(v) * bell(v.p[0], 0.018) * bell(v.p[1] + 0.089, 0.010) if v.part == "face" else 0.0
    middle = near_lips(v, down=0.016) * bell(v.p[0], 0.015)
    return add(total,
               (0, 0.0020 * chin + 0.0011 * middle,
                0.0014 * chin + (0.0 if upper_side(v) else 0.0012 * middle)))


def pucker(v):
    k = near_lips(v)
    x, y = v.p[0], v.p[1]
    middle = bell(x, 0.022)
    gather = (part_y(abs(x)) - y) * 0.10
    u = min(abs(x) / MOUTH_HALF, 1.0)
    return (-(0.42 + 0.12 * u ** 5) * x * k, (gather - 0.0048 * (abs(x) / MOUTH_HALF) ** 2) * k,
            (0.0056 * middle + 0.0018) * k)


def wide(v):
    total = ZERO
    for side in (1, -1):
        k = corner(v, side)
        total = add(total, (side * 0.0068 * k, 0.0002 * k, -0.0040 * k))
    return total


def drop(v):
    """The corners as an opening jaw draws them: down and in, so that the mouth is an oval and no
    grin."""
    total = ZERO
    for side in (1, -1):
        k = corner(v, side)
        total = add(total, (-side * 0.0026 * k, -0.0052 * k, 0))
    return total


def press(v):
    """The lips roll inwards upon each other: what is seen of the red grows narrow, the skin around
    it swells."""
    k = near_lips(v, up=0.010, down=0.011)
    x = abs(v.p[0])
    off = v.p[1] - part_y(min(x, MOUTH_HALF))
    roll = clamp(1 - x / (1.25 * MOUTH_HALF)) ** 0.5 if x < 1.25 * MOUTH_HALF else 0.0
    s = 1 if off > 0 or (off == 0 and upper_side(v)) else -1
    edge = bell(abs(off) - 0.0052, 0.0045)
    swell = bell(abs(off) - 0.0125, 0.0050) * soft(v) * bell(x, 0.020) if v.part == "face" else 0.0
    return (0, -s * 0.0026 * k * edge * roll - s * 0.0004 * k * bell(off, 0.002),
            -0.0026 * k * bell(off, 0.0075) + 0.0008 * swell)


def lip_up(v):
    """The upper lip rises in an even curve, bares the teeth and grows thinner."""
    if not upper_side(v):
        return ZERO
    x = abs(v.p[0])
    k = near_lips(v, up=0.020) * smoothstep(1.0, 0.55, x / MOUTH_HALF)
    edge = bell(v.p[1] - upper_lip_y(min(x, MOUTH_HALF)), 0.006) if v.part == "face" else 0.0
    return (0, (0.0056 - 0.0008 * edge) * k, (0.0006 + 0.0010 * edge) * k)


def lip_down(v):
    if upper_side(v):
        return ZERO
    k = near_lips(v, down=0.022)
    u = abs(v.p[0]) / MOUTH_HALF
    return (0, -0.0058 * k * max(0.0, 1 - 0.9 * u * u), 0.0008 * k * max(0.0, 1 - u * u))


def tuck(v):
    """The lower lip under the upper teeth, as for f."""
    if upper_side(v):
        return ZERO
    k = near_lips(v, down=0.016) * max(0.0, 1 - (abs(v.p[0]) / MOUTH_HALF) ** 2)
    return (0, 0.0022 * k, -0.0038 * k)


def jaw(v, angle):
    if v.jaw <= 0:
        return ZERO
    return sub(rotate(v.p, TMJ, (1.0, 0.0, 0.0), angle * v.jaw), v.p)


def tongue(v, up, forward):
    if v.part != "tongue":
        return ZERO
    tip = (1 - v.tag[1]) ** 1.6
    return (0, up * tip, forward * (1 - v.tag[1]) ** 1.2)


# ---- cheeks, nose, brows -------------------------------------------------------------------------
def puff(v):
    if v.part != "face":
        return ZERO
    total = ZERO
    for side in (1, -1):
        x = v.p[0] * side
        k = (smoothstep(0.0, 0.012, x) * bell(x - 0.040, 0.018) * bell(v.p[1] + 0.056, 0.018)
             * smoothstep(0.0, 0.03, v.p[2]))
        total = add(total, (side * 0.0068 * k, 0.0004 * k, 0.0052 * k))
    k = near_lips(v) * 0.25
    return add(total, (0, 0, 0.004 * k))


def wrinkle(v):
    """The nose wrinkles: its wings and the lip beside them rise, the skin of its bridge gathers,
    the brows come down to it."""
    if v.part not in ("face", "brows"):
        return ZERO
    x, y = abs(v.p[0]), v.p[1]
    s = 1 if v.p[0] > 0 else -1
    k = soft(v) if v.part == "face" else smoothstep(0.025, 0.055, v.p[2])
    wing = k * bell(x - 0.013, 0.0085) * bell(y + 0.037, 0.011)
    tip = k * bell(x, 0.007) * bell(y + 0.037, 0.010)
    side = k * bell(x - 0.012, 0.008) * bell(y + 0.013, 0.013)
    brow = k * bell(x - 0.011, 0.012) * bell(y - 0.019, 0.010)
    gather = (k * smoothstep(0.018, 0.006, x) * smoothstep(-0.026, -0.018, y)
              * smoothstep(0.012, 0.004, y))
    rib = 0.00050 * gather * sin(y * 1250 + 0.12 * x * 1250)  # small cross folds over the bridge
    cheek = k * bell(x - 0.026, 0.010) * bell(y + 0.026, 0.013)
    crease, pad = nasolabial(v, s)
    high = smoothstep(-0.066, -0.048, y)
    lip = (k * upper_side(v) * bell(x - 0.013, 0.011) * smoothstep(-0.072, -0.060, y)
           * smoothstep(-0.038, -0.050, y))
    return (s * (0.0016 * wing - 0.0003 * brow),
            0.0044 * wing + 0.0016 * tip + 0.0022 * side - 0.0032 * brow + 0.0026 * cheek
            + 0.0034 * lip,
            0.0008 * side + 0.0014 * cheek + 0.0010 * brow + rib
            + high * (0.0012 * pad - 0.0016 * crease) + 0.0004 * lip)


def brow_band(v):
    """1 on the brows and the forehead just above; the lids below hardly move."""
    if v.part not in ("face", "brows"):
        return 0.0
    y = v.p[1]
    low = 0.0085 + 0.35 * max(0.0, abs(v.p[0]) - 0.030)
    return (smoothstep(low - 0.0015, 0.0145 + (low - 0.0085), y) * smoothstep(0.058, 0.026, y)
            * smoothstep(0.015, 0.045, v.p[2]))


def brow_up(v, side):
    x = v.p[0] * side
    k = brow_band(v) * smoothstep(-0.004, 0.018, x) * smoothstep(0.068, 0.048, x)
    # the lid's skin is drawn up
    fold = (soft(v) * bell(x - 0.034, 0.016) * bell(v.p[1] - 0.0135, 0.005) if v.part == "face"
            else 0.0)
    return (0, 0.0084 * k + 0.0016 * fold, -0.0012 * k - 0.0006 * fold)


def brow_inner_up(v):
    x = abs(v.p[0])
    k = brow_band(v) * bell(x - 0.008, 0.014)
    outer = brow_band(v) * bell(x - 0.044, 0.012)
    s = 1 if v.p[0] > 0 else -1
    return (-s * 0.0020 * k * smoothstep(0, 0.006, x), 0.0078 * k - 0.0022 * outer, 0.0008 * k)


def brow_down(v):
    x = abs(v.p[0])
    k = brow_band(v) * bell(x - 0.012, 0.018)
    s = 1 if v.p[0] > 0 else -1
    # the muscle that draws them together bulges
    knot = brow_band(v) * bell(x - 0.0085, 0.0055) * bell(v.p[1] - 0.020, 0.009)
    crease = brow_band(v) * bell(x - 0.0035, 0.0022) * bell(v.p[1] - 0.021, 0.008)
    return (-s * 0.0015 * k * smoothstep(0, 0.008, x), -0.0054 * k,
            0.0014 * k + 0.0012 * knot - 0.0010 * crease)


# ---- the list ------------------------------------------------------------------------------------
VISEMES = {  # jaw (radians), then movements
    "pp": (0.0, {press: 1.0}, None),
    "ff": (0.018, {tuck: 1.0, lip_up: 0.35}, None),
    "th": (0.060, {drop: 0.25, lip_down: 0.25, lip_up: 0.22}, (0.0030, 0.0115)),
    "dd": (0.045, {drop: 0.15, lip_down: 0.35, lip_up: 0.25, wide: 0.15}, (0.0060, 0.0020)),
    "kk": (0.070, {drop: 0.30, lip_down: 0.20, lip_up: 0.15, wide: 0.10}, (-0.0010, -0.0040)),
    "ch": (0.030, {pucker: 0.75, lip_down: 0.60, lip_up: 0.60}, (0.0030, 0.0)),
    "ss": (0.016, {wide: 0.40, lip_down: 0.55, lip_up: 0.40}, (0.0030, 0.0)),
    "nn": (0.055, {drop: 0.20, lip_down: 0.25, lip_up: 0.15, wide: 0.10}, (0.0065, 0.0010)),
    "rr": (0.050, {pucker: 0.55, drop: 0.20, lip_down: 0.30, lip_up: 0.20}, (0.0040, -0.0030)),
    "aa": (0.185, {drop: 1.00, lip_down: 0.20, lip_up: 0.32}, (-0.0010, 0.0)),
    "e": (0.100, {drop: 0.40, wide: 0.40, lip_down: 0.25, lip_up: 0.32}, (0.0, 0.0020)),
    "ih": (0.055, {drop: 0.15, wide: 0.55, lip_down: 0.40, lip_up: 0.45}, (0.0020, 0.0020)),
    "oh": (0.130, {pucker: 0.95, drop: 0.90, lip_up: 0.50}, (-0.0010, -0.0020)),
    "ou": (0.050, {pucker: 1.25, drop: 0.50, lip_down: 0.15, lip_up: 0.34}, (0.0, -0.0030)),
}


def shape(v, angle, movements, tongue_move):
    total = jaw(v, angle) if angle else ZERO
    for movement, amount in movements.items():
        total = add(total, mul(movement(v.skin), amount))
    return add(total, tongue(v, *tongue_move)) if tongue_move else total


def controls(lids):
    """{name: movement of a Vertex}."""
    def caruncle(v, amount):
        return (0, 0, -0.0016 * amount) if v.tag and v.tag[0] == "caruncle" else ZERO

    table = {
        "blink_l": lambda v: lids.move(v, 1.0, 1.0, 1),
        "blink_r": lambda v: lids.move(v, 1.0, 1.0, -1),
        "lid_wide": lambda v: lids.move(v, -0.36, -0.30),
        "squint": lambda v: add(lids.move(v, 0.20, 1.35), (0, 0.0010 * k, 0.0004 * k) if
                                (k := bell(abs(v.p[0]) - 0.034, 0.017) * bell(v.p[1] + 0.014, 0.006)
                                 * (v.part == "face")) else ZERO),
        "brow_up_l": lambda v: brow_up(v, 1),
        "brow_up_r": lambda v: brow_up(v, -1),
        "brow_inner_up": brow_inner_up,
        "brow_down": brow_down,
        "cheek_up": lambda v: cheek_up(v, lids),
        "smile_l": lambda v: smile(v, 1),
        "smile_r": lambda v: smile(v, -1),
        "frown": frown,
        "lips_pucker": pucker,
        "lips_wide": wide,
        "lips_press": press,
        "upper_lip_up": lip_up,
        "lower_lip_down": lip_down,
        "cheek_puff": puff,
        "nose_wrinkle": wrinkle,
    }
    table = {name: (lambda v, move=move: move(v.skin)) for name, move in table.items()}
    shapes = {"mouth_open": lambda v: shape(v, 0.24, {drop: 1.5, lip_down: 0.10, lip_up: 0.20},
                                            None)}
    for name, (angle, movements, tongue_move) in VISEMES.items():
        shapes["viseme_" + name] = lambda v, a=angle, m=movements, t=tongue_move: shape(v, a, m, t)
    return {**table, **shapes}


def breathe(p):
    """The chest widens and rises; figure space."""
    k = bell(p[1] - 1.25, 0.13)
    front = smoothstep(-0.06, 0.12, p[2])
    side = 1 if p[0] > 0 else -1
    return (side * 0.0022 * k * smoothstep(0.0, 0.10, abs(p[0]))
            * smoothstep(0.24, 0.16, abs(p[0])),
            0.0028 * smoothstep(1.05, 1.30, p[1]) * smoothstep(1.47, 1.36, p[1]) * front,
            0.0062 * k * front)


LEAST = 4e-5  # metres: smaller movements are left out


def add_displacers(figure):
    heads = [p for p in figure.patches if hasattr(p, "rest")]
    face = figure.patch("face")
    vertices = []
    for patch in heads:
        if patch.look in ("hair", "roll", "pearl", "eye", "cap") and patch.name != "beard":
            continue
        for i, p in enumerate(patch.rest):
            jaw_share = patch.weights[i].get("temporomandibular", 0.0)
            vertices.append((patch.first + i, Vertex(patch.name, p, patch.tags[i], jaw_share)))
    for name, move in controls(Lids(face)).items():
        moved = {}
        for index, v in vertices:
            d = move(v)
            if v.skin is not v:  # a thousand hairs: a tenth of a millimetre is fine enough
                d = tuple(round(x * WHO.stature, 4) / WHO.stature for x in d)
            if d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > LEAST * LEAST:
                moved[index] = d
        figure.displacers.append(("skullbase", name, moved))
    moved = {}
    for patch, i, index in figure.vertices():
        if patch.tags[i] and patch.tags[i][0] in ("chest", "linen"):
            d = breathe(patch.positions[i])
            if d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > LEAST * LEAST:
                moved[index] = d
    figure.displacers.append(("vt6", "breathe", moved))
