"""How are leaf springs read: their stiffness from their size, their preload and the stop on which they rest?

A leaf clamped at one end and pressed at the other is a cantilever: F = 3 E I y / L³ with I = w t³ / 12, for deflections small
against its length (Timoshenko, *Strength of Materials*, part I, 1930, art. 37 to 39: deflection of a cantilever).
On a pivoted body it presses at the end of an arm, which makes it a torsional spring of arm² times that.
"""

from __future__ import annotations

import math

from watchsim.scene.body import Body
from watchsim.scene.file.keys.key_values import NAN, Table
from watchsim.scene.file.keys.schema import LEAF

EXAMPLE = 'leaf = { modulus = "200 GPa", length = "5 mm", width = "0.5 mm", thickness = "0.08 mm" }'
SIZES = {
    "modulus": "it is the modulus of elasticity",
    "length": "it is measured from the clamp to where the leaf presses",
    "width": "it is the height of the strip, across the plane",
    "thickness": "it is the one in the plane, in which the leaf bends",
}


def leaf_stiffness(table: Table, motion: str) -> float:
    """3 E I / L³ of the leaf of a spring, N/m; times arm², N·m/rad, on a body with motion "pivot". NaN after a fault."""
    if not isinstance(table.mapping["leaf"], dict):
        table.fault("leaf", f"a table is needed here, such as {EXAMPLE}", with_value=True)
        return NAN
    keys = Table(table.mapping["leaf"], f"{table.path}.leaf", LEAF, table.faults)
    turns = motion == "pivot" or (not motion and "arm" in keys)
    needed = {**SIZES, **({"arm": "it is the distance of the leaf's force from the pivot"} if turns else {})}
    keys.lacks(needed, EXAMPLE + (' with arm = "2 mm", on a pivoted body' if turns else ""))
    if "arm" in keys and not turns:
        keys.fault("arm", "belongs to a leaf on a pivoted body: leave it out")
    sizes = {key: keys.positive(key, why) if key in keys else NAN for key, why in needed.items()}
    if sizes["thickness"] >= sizes["length"]:
        keys.fault("thickness", "a leaf is thin: the formula of a cantilever needs thickness far below length", with_value=True)
    bending = sizes["modulus"] * sizes["width"] * sizes["thickness"] ** 3 / 12.0
    return 3.0 * bending / sizes["length"] ** 3 * sizes.get("arm", 1.0) ** 2


def read_rest(table: Table, body: Body | None, stiffness: float, other: Body | None) -> float:
    """The place without force; with `preload` that from which the spring presses so much at its stop, or else at the start."""
    if "preload" not in table:
        return table.quantity("rest")
    if "rest" in table:
        table.fault("preload", "rest and preload say the same thing: leave one out")
    start = start_of(body) - start_of(other)
    return table.quantity("stop", start) + table.quantity("preload") / stiffness


def read_stop(table: Table, body: Body | None, other: Body | None, rest: float) -> tuple[float | None, float]:
    """Where a spring rests on its stop (None without one), and the restitution of impacts there."""
    restitution = table.quantity("restitution")
    if not 0.0 <= restitution <= 1.0 and not math.isnan(restitution):
        table.fault("restitution", "of impacts on the stop, lies between 0 and 1", with_value=True)
    if "stop" not in table:
        if "restitution" in table:
            table.fault("restitution", 'belongs to a spring with a stop, such as stop = "0°": leave it out')
        return None, 0.0
    stop = table.quantity("stop")
    carried = next((one for one in (body, other) if one is not None and one.on is not None), None)
    if carried is not None and other is not None:
        why = f"{carried.name} is carried by {carried.on}, and a stop between three angles is no contact of two bodies"
        table.fault("stop", f"{why}: draw the stop, and declare the contact with it")
    if other is not None and other.prescribed is not None:
        table.fault("stop", f"{other.name} is driven: draw the stop, and declare the contact with it")
    if rest == stop:
        table.fault("stop", "the spring does not press on it: say by preload or rest to which side it presses", with_value=True)
    elif body is not None and (start_of(body) - start_of(other) - stop) * (stop - rest) < 0.0:
        table.fault("stop", "the body stands beyond it at the start: choose another angle, or the other sign of preload", True)
    return stop, restitution


def start_of(body: Body | None) -> float:
    """The coordinate of a body at the start, 0 for the movement: angles count from the drawing's, travels from the start."""
    return body.angle if body is not None and body.motion == "pivot" else 0.0
