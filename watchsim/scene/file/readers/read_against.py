"""Between which two bodies does a spring, torque or damper act?"""

from __future__ import annotations

from collections.abc import Mapping

from watchsim.scene.body import Body
from watchsim.scene.file.keys.key_values import Table
from watchsim.scene.file.keys.schema import nearest

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
