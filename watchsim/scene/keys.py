"""Which keys may a scene file hold, and what may stand behind each?

One table says it for all: where a key belongs, what it holds and in which unit, its default, the range of a number, the motions
for which it is, and one line for people. The readers read by it (`watchsim.scene.values`), unknown keys are judged by it,
`--set` finds its way by it (`watchsim.scene.assign`), and docs/reference/keys.md is made from it. What relates several keys to
each other stays with the readers.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache

from watchsim import units
from watchsim.model import TANGENTIAL_CODE
from watchsim.scene.scene import MOTIONS, PRESSURE_ANGLE
from watchsim.tolerances import COARSEST_TOLERANCE, FINEST_TOLERANCE
from watchsim.units import Dimension

SCHEMA = 1
ALIKE = 0.7  # share of letters two words have in common; "bodys" is "bodies", "nonsense" is not "scene"
SMALLEST = 1e-100  # SI: products and powers of what is read must stay numbers
TOO_SMALL = "is too small to compute with"
DRIVEN = "driven"
USUAL_TOLERANCE = 1e-9
MOST_COPIES = 1000  # of one layer: each is weighed, drawn and looked at
FEWEST_TURNS, MOST_TURNS = 1.0, 100.0  # that a picture can show
LEAST_RATIO = 1e-6  # nearer to 0 it is a slip
TEXT, TEXTS, FLAG, PAIR, POINTS, VALUE = "text", "list of texts", "true or false", "two values", "list of points", "value"
VALUES = "a value or a list"
NUMBER_OR_TABLE = "value or table"
TABLE, NAMED_TABLES, TABLES_LISTED, LAYERS = "table", "tables by name", "list of tables", "tables by layer"


@dataclass(frozen=True, slots=True)
class Limit:
    """A number lies from `low` to `high` (SI), without the end that is `open`, or `message` is said.

    With `zero` it may be 0, with `whole` it has no fraction, and it is no nearer to 0 than `apart`.
    """

    low: float
    high: float
    message: str
    open: str = ""  # "low", "high"
    zero: bool = False
    whole: bool = False
    apart: float = 0.0

    def holds(self, value: float) -> bool:
        if self.zero and value == 0.0:
            return True
        inside = self.low < value if self.open == "low" else self.low <= value
        inside = inside and (value < self.high if self.open == "high" else value <= self.high)
        return inside and abs(value) >= self.apart and not (self.whole and value != round(value))


@dataclass(frozen=True, slots=True)
class Key:
    """What stands behind a key.

    dimension, linear  of its numbers; `linear` where the body slides or is free, either where it is not known what the body
                       does (motion ""); None for what holds no number
    doc                what it means, one line of Markdown
    form               what holds the numbers or texts; of a key with `inner` keys how these are reached
    default            SI, of a number that is left out; `absent` says in words what a missing key means
    limits             of a number, the first that does not hold is reported
    choices            of a text
    motions            of a body; elsewhere the key is a fault. `beside` is added to its message
    required           its table makes no sense without
    instead_of         the keys of the same table that say the same thing: giving this one replaces them
    """

    dimension: Dimension | None = None
    linear: Dimension | None = None
    doc: str = ""
    form: str = VALUE
    default: float = 0.0
    absent: str = ""
    limits: tuple[Limit, ...] = ()
    choices: tuple[str, ...] = ()
    motions: tuple[str, ...] = ()
    beside: str = ""
    required: bool = False
    instead_of: tuple[str, ...] = ()
    inner: Mapping[str, Key] = field(default_factory=dict)

    def dimension_for(self, motion: str) -> Dimension | None:
        if self.linear and self.dimension and not motion:
            one, other = self.dimension, self.linear
            return Dimension(f"{one.name} or {other.name}", one.powers + other.powers, one.si, one.usual)
        return self.linear if self.linear and motion in ("slide", "free") else self.dimension


Keys = Mapping[str, Key]


def _above_zero(why: str) -> tuple[Limit, ...]:
    return (
        Limit(0.0, math.inf, f"must be above zero: {why}" if why else "must be above zero", "low"),
        Limit(SMALLEST, math.inf, TOO_SMALL),
    )


def _not_negative(message: str = "must not be negative") -> tuple[Limit, ...]:
    return (Limit(0.0, math.inf, message),)


def _text(doc: str, **more: object) -> Key:
    return Key(doc=doc, form=TEXT, **more)  # type: ignore[arg-type]


def _number(doc: str, **more: object) -> Key:
    return Key(units.NUMBER, doc=doc, **more)  # type: ignore[arg-type]


def _length(doc: str, **more: object) -> Key:
    return Key(units.LENGTH, doc=doc, **more)  # type: ignore[arg-type]


def _angle(doc: str, **more: object) -> Key:
    return Key(units.ANGLE, doc=doc, **more)  # type: ignore[arg-type]


_SIZE = SMALLEST, math.inf, TOO_SMALL
_WEIGHT = (*_not_negative(), Limit(*_SIZE, zero=True))
_REBOUND = (Limit(0.0, 1.0, "must lie between 0 (no rebound) and 1 (nothing lost)"),)
_SHARE = (Limit(0.0, 1.0, "is a share of the work: above 0, at most 1", "low"),)
_DRIVES = _not_negative("negative damping would drive the body")
_TURNS = (Limit(-math.inf, math.inf, "must not be 0: it is how often the body turns in one turn", apart=LEAST_RATIO),)
_COEFFICIENT = Limit(-0.1, 0.1, "is a relative change for each kelvin, at most 10 %/K")
_BODY = _text("the body it acts on", required=True)
_AGAINST = _text("another body: it acts between the two, on one and back on the other", absent="the movement")

SCENE: Keys = {
    "title": _text("shown in pictures and reports", absent="the folder's name"),
    "schema": _number("the version of this format", absent="1"),
    "gravity": Key(units.ACCELERATION, doc="its two components in the movement", form=PAIR, absent="none"),
    "tangential_law": _text("friction in the expansion of impacts", choices=tuple(TANGENTIAL_CODE), absent="coulomb"),
    "nu": _number("belongs to `pg1996`", limits=(Limit(0.0, 1.0, "must lie between 0 and 1"),)),
}
SHAPES = ("circle", "polygon", "line")
SWING: Keys = {
    "amplitude": Key(units.ANGLE, units.LENGTH, doc="to either side", required=True),
    "frequency": Key(units.FREQUENCY, doc="how often", required=True, limits=_above_zero("it says how often the body swings")),
    "phase": _angle("of the sine, at the start"),
}
SOLID: Keys = {
    "layer": _text("where it is drawn", absent="the outlines of `layers`"),
    "thickness": _length("of a plate, or height of a strip", limits=_above_zero("it is the height of the plate")),
    "density": Key(units.DENSITY, doc="of its material", required=True, limits=_above_zero("steel has 7.85 g/cm³")),
    "count": _number(
        "copies, evenly about the pivot",
        default=1.0,
        limits=(Limit(1.0, MOST_COPIES, f"a whole number from 1 to {MOST_COPIES} is needed here", whole=True),),
    ),
    "bores": Key(doc="layers with bores that are taken out of a plate", form=TEXTS),
    "turned": _length("layer with the axis of a half profile, or two points of it", form=POINTS),
    "lying": Key(doc="the turned part lies in the plane", form=FLAG, absent="false"),
    "hairspring": Key(doc="one third of it counts", form=FLAG, absent="false"),
    "inner": _length("radius of a hairspring", limits=_above_zero("it is the radius of the innermost coil")),
    "outer": _length("radius of a hairspring", limits=_above_zero("it is the radius of the outermost coil")),
    "turns": _number("of a hairspring", limits=_above_zero("it is the number of coils")),
    "length": _length("of a hairspring's strip", limits=_above_zero("it is the length of the strip")),
    "width": _length("of a hairspring's strip", limits=_above_zero("it is how thick the strip is, seen from above")),
}
ADJUST: Keys = {
    "turn": _angle("counter-clockwise"),
    "about": _length("a place, or a layer with one point or circle", form=PAIR, absent="the centre of area"),
    "shift": _length("by these two lengths", form=PAIR),
    "radial": _length("away from `about`, else from the pivot"),
    "along": _length("along the straight edge nearest to `face`"),
    "face": _length("the end of that edge towards which", form=PAIR),
    "near": _length("only the outline nearest to this place", form=PAIR, absent="all of the layer"),
    "offset": _length("by which the outline grows, or shrinks (negative), on all sides"),
}
TEETH: Keys = {
    "pitch": _length("along the circle of the tips, of each tooth", form=VALUES),
    "height": _length("of the tips, one value or one for each tooth", form=VALUES),
    "width": _length("of the teeth, one value or one for each tooth", form=VALUES),
    "wobble": _angle("of the wheel's plane on its arbor; what is seen from above shrinks along `towards`"),
    "towards": _angle("of the drawing, where the wobble is seen"),
}
BODY: Keys = {
    "drawing": _text("DXF or SVG file, or a solid (STL, OBJ, GLB, 3MF, STEP), relative to the scene"),
    "layers": Key(doc="layers whose closed outlines can touch", form=TEXTS, absent="all but the pivot's"),
    "draw": Key(doc="layers that are drawn though they cannot touch", form=TEXTS, absent="all others"),
    "units": _text("unit of the drawing", absent="the file's"),
    "section": _length("height, along z, at which a solid is cut", absent="where it is the same at all heights: there"),
    "snap": _length(
        "ends this close are one point", default=1e-6, limits=_above_zero("it is the gap that may be closed"), absent="1 µm"
    ),
    "material": _length("side of the material of open chains: left, right, or a point in it; or a table by layer"),
    "circle": _length("instead of a drawing: radius", limits=_above_zero("it is the radius")),
    "polygon": _length("instead of a drawing: its corners", form=POINTS),
    "line": _length("instead of a drawing: two points, material on the left", form=POINTS),
    "pivot": _length("a layer, what is near a place, or a point of the drawing", form=PAIR, absent="the drawing's origin"),
    "position": _length("where the origin sits in the movement, or `as drawn`", form=PAIR, absent="the movement's origin"),
    "motion": _text("what the body can do", choices=(*MOTIONS, DRIVEN), absent="pivot"),
    "axis": _number("direction of travel", form=PAIR, motions=("slide", DRIVEN)),
    "angle": _angle("at the start"),
    "velocity": Key(units.SPIN, units.SPEED, doc="at the start; of a free body two components", absent="at rest"),
    "spin": Key(units.SPIN, doc="angular velocity at the start", motions=("free",), beside="; here the key is velocity"),
    "mass": Key(units.MASS, doc="of the whole body", limits=_WEIGHT, absent="from its solids"),
    "inertia": Key(
        units.INERTIA, doc="about the origin, of a free body about its centre", limits=_WEIGHT, absent="from its solids"
    ),
    "centre_of_mass": _length("from the pivot; with `mass` and `inertia`", form=PAIR, absent="that of the outlines"),
    "solids": Key(doc="what it is made of", inner=SOLID, form=TABLES_LISTED),
    "on": _text("the body that carries it", absent="the movement"),
    "adjust": Key(doc="turns and shifts parts of its drawing", inner=ADJUST, form=LAYERS),
    "teeth": Key(doc="errors of its teeth", inner=TEETH, form=TABLE),
    "play": _length(
        "of the pivot in its hole: it lies half of it off `position`", limits=_not_negative("play cannot be negative")
    ),
    "side": _angle("in the movement, to which the play is taken up"),
    "swing": Key(doc="a sine that it is driven by", inner=SWING, form=TABLE, motions=(DRIVEN,)),
    "path": Key(doc="times and travels that it is driven through", form=POINTS, motions=(DRIVEN,)),
}
COIL: Keys = {
    "inner": _length("radius of the collet", required=True, limits=_above_zero("it is the radius of the collet")),
    "outer": _length(
        "the stud's distance from the pivot", required=True, limits=_above_zero("it is the stud's distance from the pivot")
    ),
    "turns": _number(
        "from collet to stud",
        required=True,
        limits=(Limit(FEWEST_TURNS, MOST_TURNS, f"draw {FEWEST_TURNS:g} to {MOST_TURNS:g} turns"),),
    ),
    "stud": _angle("its direction"),
    "width": _length("of the strip", default=3e-5, limits=_above_zero("it is seen from above"), absent="0.03 mm"),
}
WOUND: Keys = {
    **COIL,
    "mass": Key(units.MASS, doc="of the strip, whose weight acts", limits=_not_negative(), default=0.0, absent="none"),
}
LEAF: Keys = {
    "modulus": Key(units.PRESSURE, doc="of elasticity", required=True, limits=_above_zero("it is the modulus of elasticity")),
    "length": _length(
        "from the clamp to where it presses",
        required=True,
        limits=_above_zero("it is measured from the clamp to where the leaf presses"),
    ),
    "width": _length("across the plane", required=True, limits=_above_zero("it is the height of the strip, across the plane")),
    "thickness": _length(
        "in the plane", required=True, limits=_above_zero("it is the one in the plane, in which the leaf bends")
    ),
    "arm": _length(
        "of its force, on a pivoted body", limits=_above_zero("it is the distance of the leaf's force from the pivot")
    ),
}
CURB: Keys = {
    "share": _number(
        "of the strip's length that lies between pins and stud: the setting of the index",
        required=True,
        limits=(Limit(0.0, 1.0, "is a share of the strip's length: from 0, below 1", "high"),),
    ),
    "gap": _angle("of the body, from the middle to where the coil touches either pin", required=True, limits=_not_negative()),
    "offset": _angle("of that middle from rest: the coil leans to one pin"),
}
SPRING: Keys = {
    "body": _BODY,
    "frequency": Key(
        units.FREQUENCY,
        doc="of the free oscillation",
        limits=_above_zero("it is the frequency of the free oscillation"),
        instead_of=("stiffness", "leaf"),
    ),
    "stiffness": Key(
        units.ROTARY_STIFFNESS,
        units.LINEAR_STIFFNESS,
        doc="of the spring",
        limits=_above_zero("a spring pulls back"),
        instead_of=("frequency", "leaf"),
    ),
    "cubic": Key(units.ROTARY_CUBIC, units.LINEAR_CUBIC, doc="stiffness that grows with the square of the way from rest"),
    "coil": Key(doc="the hairspring as it bends, presses on its pivot and weighs", inner=WOUND, form=TABLE),
    "curb": Key(doc="two pins between which a hairspring plays", inner=CURB, form=TABLE),
    "rest": Key(
        units.ANGLE,
        units.LENGTH,
        doc="angle at which it does not act, of a slide its travel from position",
        instead_of=("preload",),
    ),
    "draw": Key(doc="the hairspring that pictures show", inner=COIL, form=TABLE),
    "against": _AGAINST,
    "leaf": Key(doc="a leaf that is the spring", inner=LEAF, form=TABLE, instead_of=("frequency", "stiffness")),
    "preload": Key(units.TORQUE, units.FORCE, doc="with which it presses at its stop, or at the start", instead_of=("rest",)),
    "stop": Key(
        units.ANGLE, units.LENGTH, doc="angle, or travel, at which the body is stopped on its way to rest", absent="none"
    ),
    "restitution": _number("of impacts on the stop", limits=(Limit(0.0, 1.0, "of impacts on the stop, lies between 0 and 1"),)),
}
TRAIN: Keys = {
    "ratio": _number("turns of the body for one of the wheel", required=True, limits=_TURNS),
    "inertia": Key(units.INERTIA, doc="of the wheel", required=True, limits=_above_zero("it is the wheel's moment of inertia")),
}
TORQUE: Keys = {
    "body": _BODY,
    "value": Key(
        units.TORQUE,
        units.FORCE,
        doc="a constant torque, or a force on a sliding body",
        instead_of=("table", "over", "period", "ratio", "efficiency", "run_down", "train"),
    ),
    "over": _text("what the table's first column holds", choices=("angle", "travel", "time", "barrel")),
    "table": Key(doc="pairs, linear between them", form=POINTS, instead_of=("value",)),
    "against": _AGAINST,
    "ratio": _number("turns of the body for one of the barrel", limits=_TURNS),
    "efficiency": _number("of the train", default=1.0, limits=_SHARE),
    "run_down": _angle("of the barrel since it was wound"),
    "train": Key(doc="the wheels between barrel and body", inner=TRAIN, form=TABLES_LISTED),
    "period": Key(units.TIME, doc="after which a table over time repeats", limits=_above_zero("the table repeats after it")),
}
DAMPING: Keys = {
    "body": _BODY,
    "q_factor": _number(
        "quality factor of the oscillation",
        limits=_above_zero("it is the quality factor of the oscillation, about 250 for a balance"),
        instead_of=("viscous",),
    ),
    "viscous": Key(units.ROTARY_VISCOUS, units.LINEAR_VISCOUS, doc="times speed", limits=_DRIVES, instead_of=("q_factor",)),
    "quadratic": Key(units.ROTARY_QUADRATIC, units.LINEAR_QUADRATIC, doc="times the square of the speed", limits=_DRIVES),
    "coulomb": Key(units.TORQUE, units.FORCE, doc="dry friction in the bearing", limits=_DRIVES),
    "against": _AGAINST,
}
_RUBS = _not_negative("a negative friction coefficient would drive the bodies")
FRICTION: Keys = {
    "static": _number("coefficient up to which a contact holds without slip", limits=_RUBS, required=True),
    "sliding": _number("coefficient to which it drops as the contact slides", limits=_RUBS, absent="that of `static`"),
    "decay": Key(
        units.SPEED,
        doc="speed of slip at which all but 1/e of the drop is done",
        limits=_above_zero("leave it out where friction drops as soon as the contact slides"),
        absent="friction drops as soon as the contact slides",
    ),
    "viscous": Key(
        units.PER_SPEED,
        doc="by how much the coefficient grows per speed of slip",
        limits=_not_negative("friction that falls for ever with speed would drive the bodies"),
    ),
}
CONTACT: Keys = {
    "between": Key(doc="two sides, each a body or BODY.LAYER", form=TEXTS, required=True),
    "friction": _number(
        "Coulomb's coefficient, or a table of it for rest and sliding", limits=_RUBS, form=NUMBER_OR_TABLE, inner=FRICTION
    ),
    "restitution": _number("Poisson's", limits=_REBOUND),
    "tangential_restitution": _number("of the laws `pg1996` and `shifted`", limits=_REBOUND),
}
BEARING: Keys = {
    "body": _BODY,
    "radius": _length("of the pivot", limits=_above_zero("it is the radius of the pivot"), required=True),
    "friction": _number("coefficient between pivot and hole", limits=_RUBS, required=True),
    "flat": _length(
        "equivalent radius of the end of the pivot on its cap stone, which carries the weight of a body that lies flat",
        limits=_not_negative(),
    ),
    "play": _length(
        "by how much the hole is wider than the pivot, which then rolls and slides in it",
        limits=_not_negative("play cannot be negative: leave it out for none"),
    ),
    "side": _angle(
        "where the pivot touches its hole at the start, seen from the middle", absent="nowhere: it is in the middle"
    ),
}
SHOCK: Keys = {
    "at": Key(units.TIME, doc="when it begins", limits=_not_negative("a run begins at 0"), absent="0 s"),
    "acceleration": Key(units.ACCELERATION, doc="of the case, the height of a half sine", limits=_not_negative()),
    "direction": _angle("of that acceleration, in the movement"),
    "duration": Key(units.TIME, doc="of the half sine", limits=_above_zero("it is how long the half sine lasts")),
    "turn": Key(units.SPIN_UP, doc="angular acceleration of the case, the height of a half sine as long"),
    "about": _length("the point of the case that is accelerated so, and about which it turns", form=PAIR, absent="the origin"),
    "file": _text(
        "a recording instead of a half sine: CSV with the columns t_s, ax_m_s2, ay_m_s2 and, if it turns, turn_rad_s2"
    ),
}
GEAR: Keys = {
    "between": Key(doc="two bodies", form=TEXTS, required=True),
    "ratio": _number("how far the second goes for one unit of the first", required=True),
    "backlash": Key(
        units.ANGLE,
        units.LENGTH,
        doc="play of the second while the first is held",
        limits=_not_negative("play cannot be negative: leave it out for none"),
    ),
    "restitution": _number("of impacts when the play is used up", limits=_REBOUND),
    "efficiency": _number("share of the work that arrives; needs play", default=1.0, limits=_SHARE),
    "pressure_angle": _angle(
        "of the teeth, for loads of pivots",
        default=PRESSURE_ANGLE,
        limits=(Limit(0.0, math.radians(45.0), "must lie between 0° and 45°; usual is 20°", "high"),),
        absent="20°",
    ),
}
LINE_SPRING: Keys = {
    "between": Key(doc="two bodies, or one and the movement", form=TEXTS, required=True),
    "points": _length("one of each, from its pivot", form=POINTS, required=True),
    "stiffness": Key(
        units.LINEAR_STIFFNESS, doc="of the spring", limits=_above_zero("a spring pulls back"), instead_of=("leaf",)
    ),
    "length": _length("without force", absent="that at the start"),
    "tension": Key(units.FORCE, doc="at the start, instead of `length`"),
    "viscous": Key(
        units.LINEAR_VISCOUS, doc="damping along the line", limits=_not_negative("negative damping would drive the bodies")
    ),
    "leaf": Key(doc="a leaf that is the spring", inner=LEAF, form=TABLE, instead_of=("stiffness",)),
}
RUN: Keys = {
    "duration": Key(
        units.TIME, doc="how long to simulate", default=1.0, limits=_above_zero("it is how long to simulate"), absent="1 s"
    ),
    "record": Key(units.TIME, doc="what is kept: a word, windows of time, or a list of them", absent="all"),
    "tolerance": _number(
        "relative error per step",
        default=USUAL_TOLERANCE,
        limits=(
            Limit(
                FINEST_TOLERANCE,
                COARSEST_TOLERANCE,
                f"must lie between {FINEST_TOLERANCE:g} and {COARSEST_TOLERANCE:g}; {USUAL_TOLERANCE:g} is usual",
            ),
        ),
    ),
}
TIMEGRAPHER: Keys = {
    "lift_angle": _angle(
        "arc of the balance during which it touches the lever",
        limits=(
            *_above_zero("it is the arc of the balance during which it touches the lever"),
            Limit(-math.inf, math.tau, "must be below a full turn", "high"),
        ),
    ),
    "frequency": Key(
        units.FREQUENCY,
        doc="what the rate is measured against",
        limits=_above_zero("the rate is measured against it"),
        absent="the oscillator's",
    ),
}
AT_HOME = 23.0  # °C, at which the numbers of a scene hold
THERMAL: Keys = {
    name: Key(units.PER_KELVIN, doc=f"of the {what}: its relative change for each kelvin", limits=(_COEFFICIENT,))
    for name, what in {
        "stiffness": "oscillator's springs",
        "inertia": "oscillator",
        "damping": "viscous and quadratic damping of all bodies",
        "friction": "dry friction of bearings and contacts",
    }.items()
}
WATCH: Keys = {
    "position": _text("dial up or down (`CH`, `CB`), or the hour that is up, such as `3H` or `10H30`: in place of `gravity`"),
    "twelve": _angle("direction of 12 h in the movement", default=0.5 * math.pi, absent="90°"),
    "seen_from": _text("the side from which the movement is drawn", choices=("dial", "back"), absent="dial"),
    "temperature": Key(
        units.TEMPERATURE,
        doc=f"of the movement; all numbers of the scene hold at {AT_HOME:g} °C",
        default=AT_HOME,
        limits=(Limit(-60.0, 120.0, "must lie between −60 °C and 120 °C"),),
        absent=f"{AT_HOME:g} °C",
    ),
    "since_wound": Key(
        units.TIME,
        doc="how long ago the mainspring was wound: in place of `run_down`",
        limits=_not_negative("the mainspring was wound before now"),
    ),
    "thermal": Key(doc="how its numbers change with the temperature", inner=THERMAL, form=TABLE),
}
EXPECTATION: Keys = {
    "value": Key(doc="what a run must give; with `tolerance`. `draw` is the least, bank to corner"),
    "tolerance": Key(doc="how far it may be off", limits=_above_zero("")[:1]),
    "min": Key(doc="the least that it may give, instead of `value`"),
    "max": Key(doc="the most that it may give"),
}
TOLERANCE: Keys = {
    "limits": _text('deviations from the nominal value: "±5 µm", "+0/-8 µm", or a fit class of ISO 286 such as "h6"'),
    "distribution": _text(
        "of the values within the limits", choices=("uniform", "normal", "truncated", "triangular", "file"), absent="uniform"
    ),
    "cpk": _number(
        "of a normal distribution: half the width of the limits by three sigmas", default=1.0, limits=_above_zero("")
    ),
    "sigma": Key(doc="of a normal distribution: its standard deviation", limits=_above_zero("")),
    "group": _text("dimensions of the same group get one draw: made by one tool, or of one batch"),
    "each": Key(doc="one value for each tooth", form=FLAG, absent="false"),
    "file": _text("measured values, one with its unit on each line"),
    "correlated": Key(doc="coefficients of correlation with other dimensions", form="table of numbers"),
}
LOCK: Keys = {
    "versions": Key(doc="what wrote the scene"),
    "drawings": Key(doc="digests of the drawings"),
    "design": Key(doc="the dimensions of the design"),
}

DESIGN = "design"  # [design], whose keys are the dimensions of the design it names

TABLES = {"scene": SCENE, "run": RUN, "timegrapher": TIMEGRAPHER, "watch": WATCH, "lock": LOCK}  # [name]
NAMED = {"bodies": BODY, "expect": EXPECTATION, "tolerances": TOLERANCE}  # [name.anything]
DOTTED = ("expect", "tolerances")  # of these, whose names are paths
LISTED = {  # [[name]]
    "springs": SPRING,
    "torques": TORQUE,
    "damping": DAMPING,
    "bearings": BEARING,
    "shocks": SHOCK,
    "contacts": CONTACT,
    "gears": GEAR,
    "line_springs": LINE_SPRING,
}
SECTIONS: Keys = {
    **{name: Key(inner=keys, form=TABLE) for name, keys in TABLES.items()},
    DESIGN: Key(doc="the design that the scene is made from, and its dimensions", form=TABLE),
    **{name: Key(inner=keys, form=NAMED_TABLES) for name, keys in NAMED.items()},
    **{name: Key(inner=keys, form=TABLES_LISTED) for name, keys in LISTED.items()},
}


_WORD = re.compile(r'"[^"]*"|[^."]+')


def words_of(key: str) -> tuple[str, ...]:
    """The words of a dotted path; one with points in it stands in quotes, as in bodies.lever.adjust."STONES 1.30".turn."""
    return tuple(word.strip('"') for word in _WORD.findall(key)) if '"' in key else tuple(key.split("."))


PLACES = ("x", "y")
OF_PLACES = ("position", "gravity", "centre_of_mass", "axis")


def in_words(key: str) -> str:
    """A dotted path as it is said: "bodies.wheel.position.1" is "wheel position y", "torques.0.value" is "torque 0": counted as
    it is typed."""
    said: list[str] = []
    before = ""
    for part in words_of(key):
        if not part.isdigit():
            unsaid = part == "adjust" or part in (("value",) if said else ("design", "bodies", "scene"))
            said += [] if unsaid else [part.replace("_", " ")]
        elif before in OF_PLACES and int(part) < len(PLACES):
            said.append(PLACES[int(part)])
        elif said:
            said[-1] = f"{said[-1].removesuffix('s')} {part}"
        before = part
    return " ".join(said) if said != ["of"] else "design"


def dotted(words: Iterable[str]) -> str:
    """The path of these words."""
    return ".".join(f'"{word}"' if "." in word else word for word in words)


def path_of(key: str) -> tuple[str, ...]:
    """The same; the names below [tolerances] and [expect] are dotted themselves, and one word."""
    first, *rest = words_of(key)
    return (first, dotted(rest[:-1]), rest[-1]) if first in DOTTED and len(rest) > 2 else (first, *rest)


def key_at(path: tuple[str, ...]) -> Key | None:
    """The description of a dotted path such as ("bodies", "lever", "position", "1"); None where no such key exists."""
    key, _, at = entered(path)
    return None if at < len(path) or at == 0 else key


def entered(path: tuple[str, ...]) -> tuple[Key, Keys, int]:
    """How far a dotted path leads: the last key found, the keys beside the next word, and the number of that word.

    That number is the length of the path where it ends at a key or in one of its elements, 0 where it ends in a section.
    """
    keys, at, key = SECTIONS, 0, Key()
    while at < len(path):
        if path[at] not in keys:
            return key, keys, at
        key = keys[path[at]]
        inside = at + steps_into(key, path[at + 1 :]) + 1
        if at == 0 and (inside >= len(path) or not key.inner):
            return key, key.inner or keys, 0
        if not key.inner or inside >= len(path):
            break
        keys, at = key.inner, inside
    return key, keys, len(path) if path else 0


def steps_into(key: Key, rest: tuple[str, ...]) -> int:
    """How many words of a path lead into one of the tables of that key: none, a name, a number, or a layer and perhaps one."""
    return {NAMED_TABLES: 1, TABLES_LISTED: 1, LAYERS: 2 if rest[1:2] and rest[1].isdigit() else 1}.get(key.form, 0)


def siblings(path: tuple[str, ...]) -> tuple[str, ...]:
    """The keys that may stand where the last known table of `path` was entered; for suggestions."""
    return tuple(entered(path)[1])


def belongs(key: str) -> str:
    """'It belongs under [run].' of a key that has one place, or a few; else nothing."""
    homes = [f"[{name}]" for name, keys in TABLES.items() if key in keys]
    homes += ["[bodies.NAME]"] if key in BODY else []
    homes += [f"[[{name}]]" for name, keys in LISTED.items() if key in keys]
    return f"It belongs under {' or '.join(homes)}." if 1 <= len(homes) <= 3 else ""


def closest(word: str, known: Iterable[str]) -> str | None:
    """The known word that was probably meant."""
    return _closest(word, tuple(known))


@lru_cache(maxsize=4096)  # one slip is often made in every table, and looking is slow
def _closest(word: str, words: tuple[str, ...]) -> str | None:
    folded = [one for one in words if one.casefold() == word.casefold()]
    return next(iter(folded or difflib.get_close_matches(word, words, n=1, cutoff=ALIKE)), None)


def nearest(word: str, known: Iterable[str]) -> str:
    """' Did you mean "drawing"?', or the list of what exists when nothing is near."""
    words = list(known)
    if meant := closest(word, words):
        return f'Did you mean "{meant}"?'
    return f"Known here: {', '.join(words)}." if words else ""
