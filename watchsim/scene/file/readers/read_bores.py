"""Which bores, drawn on layers of their own, are taken out of a plate?

Those on the layers that its entry names in `bores`, where they lie wholly in its material. Nothing is taken out unasked.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from watchsim.drawing.bores import Lie, lies
from watchsim.drawing.chaining.open_ends import shown
from watchsim.geometry.loop import Loop
from watchsim.geometry.solids.mass import section_of_loop
from watchsim.scene.file.keys.key_values import Table
from watchsim.scene.file.keys.schema import nearest
from watchsim.scene.file.outlines.body_outlines import Outlines

LATER = "Draw what is missing there in the outline itself"


def bores_of_plate(entry: Table, outlines: Outlines, plate: Sequence[Loop]) -> tuple[Loop, ...]:
    """The bores taken out of `plate` (its closed loops), as holes on their own layers; every fault is noted at its layer."""
    names = entry.texts("bores", "LEVER_BORE")
    layers = {name: i for i, name in enumerate(names) if _is_there(entry, outlines, plate, names, i)}
    bores = [loop for loop in outlines.all if loop.closed and loop.layer in layers]
    found = lies(bores, plate)
    for bore, lie in zip(bores, found, strict=True):
        _note_unclear(entry, layers[bore.layer], bores, bore, lie)
    for name, i in layers.items():
        own = [(bore, lie) for bore, lie in zip(bores, found, strict=True) if bore.layer == name]
        if plate and all(lie.clear and lie.depth == 0 for _, lie in own):
            why = " (they lie in holes that are drawn already)" if all(lie.holes for _, lie in own) else ""
            where = shown(middle(own[0][0]))
            message = f"nothing on this layer lies in the material of the plate{why}; its first outline is at {where} mm"
            _fault(entry, i, f"{message}. Leave it out of bores, or name the layer whose outline it is drilled through")
    return tuple(as_hole(bore) for bore, lie in zip(bores, found, strict=True) if lie.taken)


def middle(loop: Loop) -> tuple[float, float]:
    """Its centroid (metres): where it is looked for."""
    return section_of_loop(loop).centroid


def as_hole(bore: Loop) -> Loop:
    """Clockwise, whichever way it was drawn."""
    return replace(bore.reversed() if section_of_loop(bore).area > 0.0 else bore, hole=True)


def _is_there(entry: Table, outlines: Outlines, plate: Sequence[Loop], names: Sequence[str], i: int) -> bool:
    """Are there closed outlines on the layer, and may they be bores of this plate?"""
    name = names[i]
    closed = dict.fromkeys(loop.layer for loop in outlines.all if loop.closed)
    layer = entry.mapping.get("layer")
    own = {loop.layer for loop in plate} | ({layer} if isinstance(layer, str) else set())
    if name in names[:i]:
        _fault(entry, i, "this layer is named twice: leave one out")
    elif name in own:
        cure = "the holes drawn on it are taken out already. Leave it out of bores"
        _fault(entry, i, f"this is the plate's own layer: {cure}" if "layer" in entry else f"{_TOUCHES}: {cure}")
    elif name in {loop.layer for loop in outlines.aside}:
        _fault(entry, i, "this layer is the section or the strip of another solid, not a bore seen from above")
    elif name in closed:
        return True
    elif outlines.sound and name not in {finding.layer for finding in outlines.errors}:
        others = [layer for layer in closed if layer not in own]
        hint = nearest(name, others) or "There is no other layer with one"
        _fault(entry, i, f"no closed outline is on this layer. {hint}")
    return False


_TOUCHES = "this layer is one of those that touch, of which the plate is made (write layer, if it is made of another one)"


def _note_unclear(entry: Table, i: int, bores: Sequence[Loop], bore: Loop, lie: Lie) -> None:
    """Where it cannot be determined what is missing, or is missing twice."""
    where = f"the bore at {shown(middle(bore))} mm"
    if lie.crosses is not None:
        _fault(entry, i, f"{where} crosses an outline of the plate at {shown(lie.crosses)} mm. {LATER}")
    elif lie.around is not None:
        what = "a hole" if lie.around.hole else "an outline"
        _fault(entry, i, f"{where} has {what} of the plate in it, at {shown(middle(lie.around))} mm. {LATER}")
    elif lie.meets is not None:
        other, place = lie.meets
        if bores[other].layer != bore.layer:  # crossings on one layer were found when the drawing was read
            _fault(
                entry, i, f"{where} crosses one of layer {bores[other].layer} at {shown(place)} mm. Draw one outline of both"
            )
    elif lie.depth > 1:
        message = f"{where} lies in {lie.depth} outlines of this plate, one above the other"
        _fault(entry, i, f"{message}. Write a plate for each of their layers")


def _fault(entry: Table, i: int, message: str) -> None:
    name = entry.mapping["bores"][i]
    entry.faults.add(f"{entry.path}.bores.{i}", message, f' = "{name}"')
