"""Which bores weigh on the result in a way that a designer should know of?

A layer may be called a bore and not be taken out, or be named as one and lie in no material. Neither is an error, and neither
passes in silence.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence, Set

from watchsim.drawing.bores import Lie, lies
from watchsim.drawing.chaining.open_ends import shown
from watchsim.drawing.drawn_material import layer_area, layer_roles
from watchsim.drawing.findings import Finding
from watchsim.geometry.loop import Loop
from watchsim.geometry.solids.mass import area
from watchsim.scene.file.keys.key_values import Table
from watchsim.scene.file.outlines.body_outlines import Outlines
from watchsim.scene.file.readers.read_bores import LATER, as_hole, middle
from watchsim.scene.solid import PLATE, Solid, Weight
from watchsim.units import show

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
        message = f"{how} {_plate(plate)}: {told(missing)} lying in it"
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
    message = f"{_body(table)}: its mass is spread evenly over its outlines, and {told(missing)} lying in them count as {how}"
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


def told(bores: Sequence[Loop]) -> str:
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
