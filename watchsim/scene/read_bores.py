"""Which bores, drawn on layers of their own, are taken out of a plate?

Those on the layers that its entry names in `bores`, where they lie wholly in its material. Nothing is taken out unasked.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence, Set
from dataclasses import replace

from watchsim.drawing.chain_faults import shown
from watchsim.drawing.circles import Lie, lies
from watchsim.drawing.findings import Finding
from watchsim.drawing.material import layer_area, layer_roles
from watchsim.geometry.loops import Loop
from watchsim.geometry.solids import area, section_of_loop
from watchsim.scene.keys import nearest
from watchsim.scene.outlines import Outlines
from watchsim.scene.solids import PLATE, Solid, Weight
from watchsim.scene.values import Table
from watchsim.units import show

# Which bores, drawn on layers of their own, are taken out of a plate?

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


# Which bores weigh on the result in a way that a designer should know of?
#
# A layer may be called a bore and not be taken out, or be named as one and lie in no material. Neither is an error, and neither
# passes in silence.

CODE = "bore"


def bore_notices(table: Table, outlines: Outlines, solids: Sequence[Solid], elsewhere: Set[str]) -> tuple[Finding, ...]:
    """For the body of `table`, whose `solids` are in the coordinates of its drawing.

    `elsewhere` are the layers that other bodies of the same drawing name as bores: these are theirs.
    """
    entries = table.mapping.get("solids", ())
    if not solids or len(entries) != len(solids):  # what is wrong is reported as a fault
        return ()
    plates = [(solid, entry) for solid, entry in zip(solids, entries, strict=True) if solid.kind == PLATE]
    unasked = [solid for solid, entry in plates if entry.get("bores") != []]
    found = [*_idle(outlines, [solid for solid, _ in plates]), *_touchable(outlines, solids)]
    found += [finding for solid in unasked for finding in _forgotten(table, outlines, solid, elsewhere)]
    return tuple(Finding(f.code, f.severity, f"{_body(table)}: {f.message}", f.fix, f.layer, f.x_mm, f.y_mm) for f in found)


def _idle(outlines: Outlines, plates: Sequence[Solid]) -> Iterator[Finding]:
    """Bores on layers that were named, taken out of no plate of the body."""
    taken = {loop.edges for plate in plates for loop in plate.drilled}
    seen: set[Loop] = set()
    for plate in plates:
        bores = [loop for loop in outlines.all if loop.closed and loop.layer in plate.bores]
        if all(as_hole(bore).edges in taken for bore in bores):
            continue
        for bore, lie in zip(bores, lies(bores, _material(plate, plate.bores)), strict=True):
            if as_hole(bore).edges in taken or bore in seen:
                continue
            seen.add(bore)
            where = "in another bore, taken out with it" if lie.within is not None else "outside of every plate that names it"
            where = "in a hole that is drawn already" if lie.holes else where
            yield _finding("notice", f"{_the(bore)} lies {where}", "", bore)


def _touchable(outlines: Outlines, solids: Sequence[Solid]) -> Iterator[Finding]:
    """Layers that are taken out, filled by no solid, and can be touched all the same."""
    filled = {solid.layer for solid in solids}
    bores = {layer for solid in solids for layer in solid.bores} - filled
    for layer in dict.fromkeys(loop.layer for loop in outlines.loops if loop.layer in bores):
        message = f"layer {layer} is taken out as a bore, but can be touched as if it were filled"
        fix = "Leave it out of layers; a bore whose wall is touched is drawn on the layer of the plate."
        yield _finding("warning", message, fix, next(loop for loop in outlines.loops if loop.layer == layer))


def _forgotten(table: Table, outlines: Outlines, plate: Solid, elsewhere: Set[str]) -> Iterator[Finding]:
    """Layers that are called bores, lie in the plate and are not taken out of it."""
    found = _unnamed(outlines, plate, elsewhere)
    for bore, lie in found:
        if _doubtful(lie):
            message = f"{_the(bore)} lies across an outline of {_plate(plate)}: what is missing there cannot be determined"
            yield _finding("notice", message, f"{LATER}.", bore)
    missing = [bore for bore, lie in found if lie.taken]
    if missing:
        how = "counted as material of" if any(bore in plate.loops for bore in missing) else "not taken out of"
        message = f"{how} {_plate(plate)}: {count_of(missing)} lying in it"
        yield _finding("notice", message, _line_to_add(table, plate, missing), missing[0])


def _line_to_add(table: Table, plate: Solid, missing: Sequence[Loop]) -> str:
    layers = tuple(dict.fromkeys(bore.layer for bore in missing))
    touching = [layer for layer in layers if not plate.layer and layer in table.texts("layers")]
    first = f"Take {', '.join(touching)} out of layers and write" if touching else "Write"
    names = ", ".join(f'"{layer}"' for layer in (*plate.bores, *layers))
    left = layer_area(_material(plate, layers)) - sum(abs(area(bore)) for bore in missing)
    before, after = plate.weight.mass, plate.density * plate.thickness * plate.count * left
    masses = f"{show(before, 'mg')} become {show(after, 'mg')}"
    return f"{first} bores = [{names}] beside its thickness: {masses}. bores = [] says that the plate is whole."


def uniform_notices(table: Table, outlines: Outlines, weight: Weight, elsewhere: Set[str]) -> tuple[Finding, ...]:
    """The same for a body with a `mass` alone, which is spread evenly over its closed outlines."""
    plate = Solid(PLATE, "", weight, 0.0, tuple(loop for loop in outlines.loops if loop.closed))
    missing = [bore for bore, lie in _unnamed(outlines, plate, elsewhere) if lie.taken]
    if not missing:
        return ()
    how = "one more part" if any(bore in plate.loops for bore in missing) else "filled"
    message = (
        f"{_body(table)}: its mass is spread evenly over its outlines, and {count_of(missing)} lying in them count as {how}"
    )
    fix = "Give solids with bores instead of mass, or the inertia as well."
    return (_finding("notice", message, fix, missing[0]),)


def _unnamed(outlines: Outlines, plate: Solid, elsewhere: Set[str]) -> list[tuple[Loop, Lie]]:
    """The outlines on layers that are called bores and named by nobody, and how they lie to the plate without them."""
    closed = [loop for loop in outlines.all if loop.closed]
    roles = layer_roles(closed)
    known = {plate.layer, *plate.bores, *elsewhere}
    bores = [loop for loop in closed if roles[loop.layer] == "bore" and loop.layer not in known]
    left = {bore.layer for bore in bores}
    return list(zip(bores, lies(bores, _material(plate, left)), strict=True))


def count_of(bores: Sequence[Loop]) -> str:
    """ "3 bores of LEVER_BORE"."""
    layers = ", ".join(dict.fromkeys(bore.layer for bore in bores))
    return f"{len(bores)} {'bore' if len(bores) == 1 else 'bores'} of {layers}"


def _material(plate: Solid, bores: Iterable[str]) -> list[Loop]:
    return [loop for loop in plate.loops if loop.layer not in bores]


def _doubtful(lie: Lie) -> bool:
    inside = lie.depth > 0 and lie.meets is not None
    return lie.crosses is not None or inside or (lie.around is not None and lie.around.hole)


def _the(bore: Loop) -> str:
    return f"the bore at {shown(middle(bore))} mm of layer {bore.layer}"


def _body(table: Table) -> str:
    return table.path.partition(".")[2]


def _plate(plate: Solid) -> str:
    return f"the plate {plate.layer}" if plate.layer else "the plate"


def _finding(severity: str, message: str, fix: str, bore: Loop) -> Finding:
    x, y = middle(bore)
    return Finding(CODE, severity, message, fix, bore.layer, 1e3 * x, 1e3 * y)
