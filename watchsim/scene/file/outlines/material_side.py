"""On which side of an open chain is the material?

An open chain has no inside, so it can only be touched where the scene says what is behind it: `material` of a body, for all its
open chains or layer by layer. A point in the material says it however the chain was drawn.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from watchsim.drawing.chaining.track import Track
from watchsim.drawing.drawing import Drawing
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Point
from watchsim.scene.file.keys.key_values import Table, shown
from watchsim.scene.file.keys.schema import closest, nearest

SIDES = ("left", "right")
ADVICE = 'material = "left" (or "right", seen along the drawn direction; or a point behind it, ["0 mm", "-1 mm"])'
UNREADABLE_SIDE = ""

Side = str | Point


def face_layers(table: Table, drawing: Drawing, asked: tuple[str, ...]) -> dict[str, Side]:
    """Layers whose open chains can be touched, with the side of their material; faults go to the table.

    One value speaks for all `asked` layers that have open chains, or where none are asked for all layers.
    """
    if "material" not in table:
        return {}
    value = table.mapping["material"]
    there = tuple(dict.fromkeys(chain.layer for chain in drawing.open_chains))
    if not isinstance(value, Mapping):
        side = _side(table, "material", value)
        chosen = [layer for layer in there if layer in asked or "layers" not in table]
        if not chosen:
            table.fault("material", "there is no open chain it could apply to: closed outlines have their material inside")
        return dict.fromkeys(chosen, side)
    result = {}
    sure = table.mapping.get("layers") == [*asked] and set(asked) <= set(drawing.layers)  # else that is the fault
    for layer, entry in value.items():
        meant = layer if layer in there else closest(layer, [one for one in there if one not in value])
        result[meant or layer] = _side(table, f"material.{layer}", entry)
        if layer not in there:
            hint = nearest(layer, there) if there else "There are none in this drawing."
            table.fault(f"material.{layer}", f"there is no open chain on this layer. {hint}")
        elif sure and layer not in asked:
            table.fault(f"material.{layer}", f'this layer cannot touch: add "{layer}" to layers')
    return result


def _side(table: Table, key: str, value: object) -> Side:
    if isinstance(value, str):
        if value not in SIDES:
            what = f"a side is left or right, or a point of the drawing in the material. Write e.g. {ADVICE}"
            table.faults.add(f"{table.path}.{key}", what, shown(value))
            return UNREADABLE_SIDE
        return value
    return table.point(key, value, table.dimension("material"))


def faces(table: Table, drawing: Drawing, sides: Mapping[str, Side]) -> Iterator[Loop]:
    """The open chains of those layers with the material on their left."""
    for chain in drawing.open_chains:
        side = sides.get(chain.layer, UNREADABLE_SIDE)
        if side == UNREADABLE_SIDE:
            continue
        yield chain if _on_left(table, chain, side) else chain.reversed()


def _on_left(table: Table, chain: Loop, side: Side) -> bool:
    if isinstance(side, str):
        return side == "left"
    if any(math.isnan(c) for c in side):
        return True
    track = Track(chain)
    distance, hand = track.side(side, 0.0, track.length)
    if distance <= 1e-9 * track.length:
        message = f"the point lies on the chain of layer {chain.layer} itself: give one well inside the material"
        table.fault("material", message, with_value=True)
    return hand > 0.0
