"""How are the contacts of the scene file read?"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from watchsim import units
from watchsim.scene.errors import Faults
from watchsim.scene.forces import CONSTANT, Contact, Side, SlipLaw
from watchsim.scene.keys import CONTACT, FRICTION, nearest
from watchsim.scene.scene import Body
from watchsim.scene.values import NAN, Table, listed, shown

# How is the table of a torque read, over an angle, a way or time?

Rows = tuple[tuple[float, float], ...]  # abscissa and value, in SI


def repeated(table: Table, rows: Rows) -> tuple[Rows, float]:
    """The rows with the first once more, a period later, and the period (s)."""
    period = table.quantity("period", NAN)
    if rows and period <= rows[-1][0] - rows[0][0]:
        table.fault("period", "must be longer than the table, which goes on with its first row after it", with_value=True)
    return (*rows, (rows[0][0] + period, rows[0][1])) if rows else (), period


def rows_of(table: Table, abscissa: units.Dimension) -> Rows:
    """(abscissa, value) pairs with ascending abscissae."""
    value, ordinate = table.mapping["table"], table.keys["value"].dimension_for(table.motion) or units.TORQUE
    if not isinstance(value, (list, tuple)) or len(value) < 2:
        example = f'[["0 {abscissa.usual[1]}", "0 {ordinate.usual[1]}"], ["1 {abscissa.usual[1]}", "1 {ordinate.usual[1]}"]]'
        table.fault("table", f"a list of at least two pairs is needed here, such as table = {example}", with_value=True)
        return ()
    rows = tuple(_row(table, i, row, (abscissa, ordinate)) for i, row in enumerate(value))
    for i, (before, after) in enumerate(pairwise(rows)):
        if after[0] <= before[0]:
            table.fault(f"table.{i + 1}", "its first column must ascend")
    return rows


def _row(table: Table, i: int, row: object, dimensions: tuple[units.Dimension, units.Dimension]) -> tuple[float, float]:
    if not isinstance(row, (list, tuple)) or len(row) != 2:
        table.faults.add(f"{table.path}.table.{i}", "two values are needed in each row", shown(row))
        return (NAN, NAN)
    x, y = (table.parsed(f"table.{i}.{j}", item, dimensions[j]) for j, item in enumerate(row))
    return (x, y)


# Between which two bodies does a spring, torque or damper act?

SINGLE = {  # what has no meaning between two bodies
    "frequency": "depends on both bodies: write stiffness, and `watchsim check` shows the frequency",
    "q_factor": "depends on both bodies: write viscous",
    "coulomb": "is simulated in bearings of the movement only: write viscous, or leave out against",
    "draw": "shows a spring whose stud does not move: leave it out",
    "ratio": "belongs to a mainspring, whose barrel is in the movement: leave out against",
}


def read_against(table: Table, body: Body | None, known: Mapping[str, Body]) -> str | None:
    """The name of the other body, None where the other end is in the movement; what cannot be simulated is a fault."""
    if "against" not in table:
        return None
    name = table.text("against")
    if not isinstance(table.mapping["against"], str):
        return None
    if name not in known:
        table.fault("against", f"there is no such body. {nearest(name, known)}", with_value=True)
        return None
    if body is None:
        return None
    for key, why in SINGLE.items():
        if key in table:
            table.fault(key, f"between two bodies this {why}", with_value=True)
    other = known[name]
    if other.name == body.name:
        table.fault("against", "is the same body: nothing acts between a body and itself", with_value=True)
    elif other.motion != body.motion or (body.motion == "slide" and other.axis != body.axis):
        alike = "two bodies that turn, or two that slide in the same direction"
        table.fault("against", f"acts between {alike}; between points of any bodies a line spring does", with_value=True)
    for one in (body, other):
        if one.geared is not None:
            table.fault(
                "against",
                f"{one.name} is geared to {one.geared.to}: let it act there, by the ratio of the gears",
                with_value=True,
            )
        elif one.on is not None:
            table.fault(
                "against", f"{one.name} is carried by {one.on}: what acts on it acts against that already", with_value=True
            )
    return name


# How are the contacts of the scene file read?

NOWHERE = Side("")


@dataclass(frozen=True, slots=True)
class BodyIndex:
    """The bodies that may be named, those whose outlines were read without a fault, those that say `layers = []`, and the
    tangential law of the scene."""

    bodies: Mapping[str, Body]
    sound: frozenset[str]
    bare: frozenset[str]
    law: str


def read_contacts(
    mapping: Mapping[str, Any], bodies: tuple[Body, ...], sound: frozenset[str], law: str, faults: Faults
) -> tuple[Contact, ...]:
    """All declared contacts; unknown bodies and layers, a body with itself and pairs declared twice are faults."""
    bare = frozenset(body.name for body in bodies if mapping["bodies"][body.name].get("layers") == [])
    known = BodyIndex({body.name: body for body in bodies}, sound, bare, law)
    tables = [Table(one, f"contacts.{i}", CONTACT, faults) for i, one in enumerate(listed(mapping, "contacts", faults))]
    contacts = tuple(_contact(table, known) for table in tables)
    _note_repeated(tables, contacts, known)
    return contacts


def _contact(table: Table, known: BodyIndex) -> Contact:
    sides = _sides(table, known)
    friction, slip = _friction(table)
    contact = Contact(sides, friction, table.quantity("restitution"), table.quantity("tangential_restitution"), slip)
    if contact.tangential_restitution > 0.0:
        # Not every law gives tangential impulses back.
        if known.law == "coulomb":
            cure = 'write tangential_law = "pg1996" (or "shifted") under [scene]'
            message = f'the law "coulomb" gives no tangential impulse back: {cure}'
            table.fault("tangential_restitution", message, with_value=True)
        elif known.law == "shifted" and contact.tangential_restitution > contact.restitution:
            message = f'must not be above restitution ({contact.restitution:g}) with tangential_law = "shifted"'
            table.fault("tangential_restitution", message, with_value=True)
    return contact


def _friction(table: Table) -> tuple[float, SlipLaw]:
    """The coefficient without slip, and what slip makes of it."""
    value = table.mapping.get("friction")
    if not isinstance(value, dict):
        return table.quantity("friction"), CONSTANT
    law = Table(value, f"{table.path}.friction", FRICTION, table.faults)
    law.lacks("friction = { static = 0.18, sliding = 0.12 }")
    static = law.quantity("static", NAN)
    sliding = law.quantity("sliding", static)
    if sliding > static:
        why = f"must not be above static ({static:g}): a contact that holds no more could not begin to slide either"
        law.fault("sliding", why, with_value=True)
    if "decay" in law and "sliding" not in law:
        law.fault("decay", "is the speed at which friction has dropped from static: write sliding = 0.12, or leave decay out")
    return static, SlipLaw(static - sliding, law.quantity("decay"), law.quantity("viscous"))


def _sides(table: Table, known: BodyIndex) -> tuple[Side, Side]:
    names = table.names("between", (2,), 'two sides are needed: between = ["wheel.TEETH", "lever.STONES"]', twice=True)
    if not names:
        return NOWHERE, NOWHERE
    first, second = (_side(table, i, name, known) for i, name in enumerate(names))
    if first.body and first.body == second.body:
        table.fault("between", f"{first.body} cannot touch itself: a body is rigid", with_value=True)
    elif first.body and second.body and all(_is_fixed(known.bodies[side.body]) for side in (first, second)):
        table.fault("between", f"{first.body} and {second.body} are both fixed, so this contact does nothing", with_value=True)
    elif first.body and second.body and all(_is_set(known.bodies[side.body]) for side in (first, second)):
        why = "neither can give way, so this contact does nothing"
        table.fault("between", f"{first.body} and {second.body} are driven or fixed: {why}", with_value=True)
    return first, second


def _is_set(body: Body) -> bool:
    return _is_fixed(body) or body.prescribed is not None


def _is_fixed(body: Body) -> bool:
    return body.motion == "fixed" and body.on is None


def _side(table: Table, i: int, name: str, known: BodyIndex) -> Side:
    """ "lever" or "lever.STONES"; a layer name may contain points."""
    body_name, _, layer = name.partition(".")
    body = known.bodies.get(body_name)
    key = f"{table.path}.between.{i}"
    if body is None:
        table.faults.add(key, f'there is no body "{body_name}". {nearest(body_name, known.bodies)}', f' = "{name}"')
        return NOWHERE
    if body_name in known.sound:
        if not body.loops and body_name in known.bare:
            why = "nothing of the drawing can touch, though a contact names this body"
            cure = 'Name the layers that touch, such as ["TEETH"], or leave layers out: then all with closed outlines can'
            table.faults.add(f"bodies.{body.name}.layers", f"{why}. {cure}", " = []")
        elif not body.loops:
            table.faults.add(key, f"{body_name} has no outline that could touch: give it a drawing or a shape", f' = "{name}"')
        elif layer and layer not in body.layers:
            _note_layer(table, key, body, layer)
    return Side(body_name, layer or None)


def _note_layer(table: Table, key: str, body: Body, layer: str) -> None:
    shown = f' = "{body.name}.{layer}"'
    if any(layer in solid.bores for solid in body.solids):
        table.faults.add(
            key, "this layer is taken out as a bore; to be touched, draw the bore on the layer of its plate", shown
        )
        return
    if layer in {loop.layer for loop in body.decoration}:
        table.faults.add(key, f'layer {layer} is left out by layers under [bodies.{body.name}]: add "{layer}" there', shown)
        return
    hint = nearest(layer, body.layers)
    there = f" Layers of {body.name}: {', '.join(body.layers)}." if hint.startswith("Did") else ""
    table.faults.add(key, f"{body.name} has no such layer. {hint}{there}", shown)


def _note_repeated(tables: list[Table], contacts: tuple[Contact, ...], known: BodyIndex) -> None:
    """Two declarations for one pair of outlines would make the pair touch twice."""
    first: dict[frozenset[Side], int] = {}
    for i, (table, contact) in enumerate(zip(tables, contacts, strict=True)):
        pairs = _covered(contact, known)
        if earlier := [first[pair] for pair in pairs if pair in first]:
            table.fault("between", f"contacts.{min(earlier)} declares this pair already: leave one out", with_value=True)
        for pair in pairs:
            first.setdefault(pair, i)


def _covered(contact: Contact, known: BodyIndex) -> set[frozenset[Side]]:
    first, second = (_layers(side, known) for side in contact.sides)
    return {frozenset((a, b)) for a in first for b in second}


def _layers(side: Side, known: BodyIndex) -> tuple[Side, ...]:
    if not side.body:
        return ()
    layers = (side.layer,) if side.layer else known.bodies[side.body].layers
    return tuple(Side(side.body, layer) for layer in layers)
