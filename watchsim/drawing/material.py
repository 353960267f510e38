"""How much of what is drawn is material?

Layers add up: each may be a part or a height of its own. But a layer may be named for a bore or a pivot. A bore drawn on a
layer of its own is taken out of the outline around it; a circle that marks a pivot, an axis or a centre is only looked at.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Sequence

import numpy as np

from watchsim.geometry.loops import Inside, Loop
from watchsim.geometry.primitives import Arc, Boxes, Point
from watchsim.geometry.solids import area


def plain_word(word: str) -> str:
    """In lower case and without accents."""
    return "".join(one for one in unicodedata.normalize("NFKD", word.lower()) if not unicodedata.combining(one))


def tokens(name: str) -> list[str]:
    """The plain words of a name: "ESCAPE_WHEEL_z-1.30" has escape, wheel and z, "Steigradzähne" steigrad and zahne."""
    split = re.sub(r"(?<=[a-zäöüéèß])(?=[A-ZÄÖÜÉ])", " ", unicodedata.normalize("NFC", name))
    split = re.sub(COMPOUND, r"\1 ", plain_word(split))
    return [word for word in re.split(r"[^a-z]+|(?<=[a-z])(?=wheel)", split) if word]


COMPOUND = r"(anker(?!rad)|ankerrad|steigrad|gangrad|unruh|pendel)(?=[a-z]{3})"  # the first part of German names
BORES = frozenset(("bore", "bores", "drill", "drills", "hole", "holes", "bohrung", "bohrungen", "loch", "locher"))
BORES |= frozenset(("trou", "trous", "percage", "percages", "foro", "fori"))
CENTRES = frozenset(("center", "centers", "centre", "centres", "zentrum", "mitte", "mittelpunkt", "centro"))
MARKS = frozenset(("axes", "axis", "pivot", "pivots", "drehpunkt", "achse", "achsen", "axe", "asse", "assi", "perno", "perni"))
INWARD = 1e-6  # of an edge: so far beside it is looked whether there is material


def material_area(loops: Sequence[Loop]) -> float:
    """Square metres: outer loops less their holes, less the bores of other layers."""
    roles = layer_roles(loops)
    solid = [loop for loop in loops if roles[loop.layer] == "material"]
    bores = [loop for loop in loops if roles[loop.layer] == "bore" and not loop.hole]
    return layer_area(solid) - layer_area(bores[k] for k in in_material([just_inside(bore) for bore in bores], solid))


def layer_area(loops: Iterable[Loop]) -> float:
    """Square metres: outer loops less their holes."""
    return sum(area(loop) for loop in loops)


def layer_roles(loops: Iterable[Loop]) -> dict[str, str]:
    """ "material", "bore" or "mark" for each layer; where there is nothing but bores and marks these are the parts."""
    plain: dict[str, bool] = {}
    for loop in loops:
        plain[loop.layer] = plain.get(loop.layer, True) and isinstance(loop.edges[0], Arc) and loop.edges[0].is_circle
    roles = {layer: _role(layer, circles) for layer, circles in plain.items()}
    return roles if "material" in roles.values() else dict.fromkeys(roles, "material")


def _role(layer: str, only_circles: bool) -> str:
    return "bore" if _last_word(layer) in BORES else "mark" if is_mark(layer) and only_circles else "material"


def is_mark(layer: str) -> bool:
    """Is it named for what marks a place? "lever_PIVOT-2", "Pivot Lever" and "wheel centre" are, "CENTER WHEEL" is a wheel."""
    return _last_word(layer) in CENTRES or any(word in MARKS for word in tokens(layer))


def _last_word(layer: str) -> str:
    return next((word for word in reversed(tokens(layer)) if len(word) > 2), "")


def in_material(points: Sequence[Point], solid: Sequence[Loop]) -> list[int]:
    """Numbers of the points where there is material on any layer; in a hole that is drawn there too there is none."""
    if not points:
        return []
    depths = [0] * len(points)
    insides: dict[int, Inside] = {}
    for k, number in zip(*Boxes(np.array([loop.box for loop in solid])).holding(np.array(points)), strict=True):
        if number not in insides:
            insides[number] = Inside(solid[number])
        if insides[number].winding(points[k]) != 0:
            depths[k] += -1 if solid[number].hole else 1
    return [k for k, depth in enumerate(depths) if depth > 0]


def just_inside(loop: Loop) -> Point:
    """A point next to the middle of the first edge of an outer loop."""
    edge = loop.edges[0]
    depth = INWARD * (edge.radius if isinstance(edge, Arc) else edge.length)
    (x, y), (tx, ty) = edge.point(0.5), edge.tangent(0.5)
    return (x - depth * ty, y + depth * tx)
