"""Which keys may a scene file hold?"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass

from watchsim import units
from watchsim.units import Dimension

SCHEMA = 1
ALIKE = 0.7  # share of letters two words have in common; "bodys" is "bodies", "nonsense" is not "scene"


@dataclass(frozen=True, slots=True)
class Key:
    """What stands behind a key: numbers of a `dimension` (`linear` where the body slides or is free; either where it is not
    known what the body does, motion ""), or none."""

    dimension: Dimension | None = None
    linear: Dimension | None = None

    def dimension_for(self, motion: str) -> Dimension | None:
        if self.linear and self.dimension and not motion:
            return _either(self.dimension, self.linear)
        return self.linear if self.linear and motion in ("slide", "free") else self.dimension


def _either(one: Dimension, other: Dimension) -> Dimension:
    return Dimension(f"{one.name} or {other.name}", one.powers + other.powers, one.si, one.usual)


Keys = dict[str, Key]
PLAIN = Key()
NUMBER = Key(units.NUMBER)
LENGTH = Key(units.LENGTH)
ANGLE = Key(units.ANGLE)

SCENE: Keys = {
    **{"title": PLAIN, "schema": NUMBER, "gravity": Key(units.ACCELERATION)},
    **{"tangential_law": PLAIN, "nu": NUMBER},
}
SHAPES = ("circle", "polygon", "line")
BODY: Keys = {
    **{"drawing": PLAIN, "layers": PLAIN, "draw": PLAIN, "units": PLAIN, "snap": LENGTH, "material": LENGTH},
    **{"circle": LENGTH, "polygon": LENGTH, "line": LENGTH},
    **{"pivot": LENGTH, "position": LENGTH, "motion": PLAIN, "axis": NUMBER, "angle": ANGLE},
    **{"velocity": Key(units.SPIN, units.SPEED), "spin": Key(units.SPIN)},
    **{"mass": Key(units.MASS), "inertia": Key(units.INERTIA), "centre_of_mass": LENGTH, "solids": PLAIN},
    **{"on": PLAIN, "adjust": PLAIN},
    **{"swing": PLAIN, "path": PLAIN},
}
SWING: Keys = {  # of a driven body
    "amplitude": Key(units.ANGLE, units.LENGTH),
    "frequency": Key(units.FREQUENCY),
    "phase": ANGLE,
}
SOLID: Keys = {
    **{"layer": PLAIN, "thickness": LENGTH, "density": Key(units.DENSITY), "count": NUMBER},
    **{"bores": PLAIN, "turned": LENGTH, "lying": PLAIN},
    **{"hairspring": PLAIN, "inner": LENGTH, "outer": LENGTH, "turns": NUMBER, "length": LENGTH, "width": LENGTH},
}
ADJUST: Keys = {  # of one layer of a body's drawing, or of one outline of it
    **{"turn": ANGLE, "about": LENGTH, "shift": LENGTH, "radial": LENGTH},
    **{"along": LENGTH, "face": LENGTH, "near": LENGTH},
}
SPRING: Keys = {
    "body": PLAIN,
    "frequency": Key(units.FREQUENCY),
    "stiffness": Key(units.ROTARY_STIFFNESS, units.LINEAR_STIFFNESS),
    "rest": Key(units.ANGLE, units.LENGTH),
    "draw": PLAIN,
    "against": PLAIN,
    "leaf": PLAIN,
    "preload": Key(units.TORQUE, units.FORCE),
    "stop": Key(units.ANGLE, units.LENGTH),
    "restitution": NUMBER,
}
COIL: Keys = {"inner": LENGTH, "outer": LENGTH, "turns": NUMBER, "stud": ANGLE, "width": LENGTH}  # draw of a spring
LEAF: Keys = {  # leaf of a spring
    "modulus": Key(units.PRESSURE),
    **{"length": LENGTH, "width": LENGTH, "thickness": LENGTH, "arm": LENGTH},
}
TORQUE: Keys = {
    **{"body": PLAIN, "value": Key(units.TORQUE, units.FORCE), "over": PLAIN, "table": PLAIN, "against": PLAIN},
    **{"ratio": NUMBER, "efficiency": NUMBER, "run_down": ANGLE, "train": PLAIN},
    **{"period": Key(units.TIME)},
}
TRAIN: Keys = {"ratio": NUMBER, "inertia": Key(units.INERTIA)}  # of one wheel between mainspring and body
DAMPING: Keys = {
    "body": PLAIN,
    "q_factor": NUMBER,
    "viscous": Key(units.ROTARY_VISCOUS, units.LINEAR_VISCOUS),
    "quadratic": Key(units.ROTARY_QUADRATIC, units.LINEAR_QUADRATIC),
    "coulomb": Key(units.TORQUE, units.FORCE),
    "against": PLAIN,
}
CONTACT: Keys = {"between": PLAIN, "friction": NUMBER, "restitution": NUMBER, "tangential_restitution": NUMBER}
GEAR: Keys = {
    **{"between": PLAIN, "ratio": NUMBER, "backlash": Key(units.ANGLE, units.LENGTH)},
    **{"restitution": NUMBER, "efficiency": NUMBER, "pressure_angle": ANGLE},
}
LINE_SPRING: Keys = {
    **{"between": PLAIN, "points": LENGTH, "stiffness": Key(units.LINEAR_STIFFNESS)},
    **{"length": LENGTH, "tension": Key(units.FORCE), "viscous": Key(units.LINEAR_VISCOUS), "leaf": PLAIN},
}
RUN: Keys = {"duration": Key(units.TIME), "record": Key(units.TIME), "tolerance": NUMBER}
TIMEGRAPHER: Keys = {"lift_angle": ANGLE, "frequency": Key(units.FREQUENCY)}
EXPECTATION: Keys = {"value": PLAIN, "tolerance": PLAIN}
LOCK: Keys = {"versions": PLAIN, "drawings": PLAIN, "design": PLAIN}

TABLES = {"scene": SCENE, "run": RUN, "timegrapher": TIMEGRAPHER, "lock": LOCK}  # [name]
NAMED = {"bodies": BODY, "expect": EXPECTATION}  # [name.anything]
LISTED = {
    "springs": SPRING,
    "torques": TORQUE,
    "damping": DAMPING,
    "contacts": CONTACT,
    "gears": GEAR,
    "line_springs": LINE_SPRING,
}  # [[name]]
WITHIN = {  # name = { … }
    ("bodies", "swing"): SWING,
    **{("springs", "draw"): COIL, ("springs", "leaf"): LEAF, ("line_springs", "leaf"): LEAF},
}
DESIGN = "design"  # [design], whose keys are the dimensions of the design it names
SECTIONS = (*TABLES, DESIGN, *NAMED, *LISTED)


def key_at(path: tuple[str, ...]) -> Key | None:
    """The description of a dotted path such as ("bodies", "lever", "position", "1"); None where no such key exists."""
    if not path:
        return None
    section, rest = path[0], path[1:]
    if section in TABLES:
        return TABLES[section].get(rest[0]) if rest else None
    if len(rest) < 2 or section not in SECTIONS:
        return None
    if (section, rest[1]) in WITHIN and len(rest) >= 3:
        return WITHIN[section, rest[1]].get(rest[2])
    if section in NAMED:
        if rest[1] == "solids" and len(rest) >= 4:
            return SOLID.get(rest[3])
        if rest[1] == "adjust" and len(rest) >= 4:
            inner = rest[4:] if rest[3].isdigit() else rest[3:]
            return ADJUST.get(inner[0]) if inner else PLAIN
        return NAMED[section].get(rest[1])
    if section == "torques" and rest[1] == "train" and len(rest) >= 4:
        return TRAIN.get(rest[3])
    return LISTED[section].get(rest[1])


def siblings(path: tuple[str, ...]) -> tuple[str, ...]:
    """The keys that may stand where the last known table of `path` was entered; for suggestions."""
    section = path[0] if path else ""
    if section in TABLES:
        return tuple(TABLES[section])
    if (section, *path[2:3]) in WITHIN and len(path) > 3:
        return tuple(WITHIN[section, path[2]])
    if section in NAMED:
        if path[2:3] == ("adjust",) and len(path) > 4:
            return tuple(ADJUST)
        return tuple(SOLID if path[2:3] == ("solids",) and len(path) > 4 else NAMED[section])
    return tuple(LISTED[section]) if section in LISTED else SECTIONS


def belongs(key: str) -> str:
    """'It belongs under [run].' of a key that has one place, or a few; else nothing."""
    homes = [f"[{name}]" for name, keys in TABLES.items() if key in keys]
    homes += ["[bodies.NAME]"] if key in BODY else []
    homes += [f"[[{name}]]" for name, keys in LISTED.items() if key in keys]
    return f"It belongs under {' or '.join(homes)}." if 1 <= len(homes) <= 3 else ""


def closest(word: str, known: Iterable[str]) -> str | None:
    """The known word that was probably meant."""
    words = list(known)
    folded = [one for one in words if one.casefold() == word.casefold()]
    return next(iter(folded or difflib.get_close_matches(word, words, n=1, cutoff=ALIKE)), None)


def nearest(word: str, known: Iterable[str]) -> str:
    """' Did you mean "drawing"?', or the list of what exists when nothing is near."""
    words = list(known)
    if meant := closest(word, words):
        return f'Did you mean "{meant}"?'
    return f"Known here: {', '.join(words)}." if words else ""
