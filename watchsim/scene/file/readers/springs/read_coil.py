"""How is a spring drawn, which acts as a torque and has no shape of its own?"""

from __future__ import annotations

import math

from watchsim.geometry.coil import Coil
from watchsim.scene.body import Body
from watchsim.scene.file.keys.key_values import Table
from watchsim.scene.file.keys.schema import COIL
from watchsim.scene.solid import HAIRSPRING

WIDTH = 3e-5  # m, where the scene does not say
FEWEST, MOST = 1.0, 100.0  # turns that a picture can show
EXAMPLE = 'draw = { inner = "0.5 mm", outer = "2.8 mm", turns = 13, stud = "90°" }'


def read_coil(table: Table, body: Body | None) -> Coil | None:
    """As `draw` of a spring says; else as the `solids` of its body weigh a hairspring given by numbers; else not at all."""
    if "draw" not in table:
        return _weighed(body)
    if body is not None and body.motion != "pivot":
        table.fault("draw", f'a hairspring is wound about a pivot, and motion of {body.name} is "{body.motion}"')
        return None
    if not isinstance(table.mapping["draw"], dict):
        table.fault("draw", f"a table is needed here, such as {EXAMPLE}", with_value=True)
        return None
    keys = Table(table.mapping["draw"], f"{table.path}.draw", COIL, table.faults)
    known = len(table.faults.found)
    keys.lacks(("inner", "outer", "turns"), EXAMPLE)
    inner = keys.positive("inner", "it is the radius of the collet") if "inner" in keys else math.nan
    outer = keys.positive("outer", "it is the stud's distance from the pivot") if "outer" in keys else math.nan
    turns = keys.quantity("turns", math.nan)
    width = keys.positive("width", "it is seen from above") if "width" in keys else WIDTH
    if not math.isnan(turns) and not FEWEST <= turns <= MOST:
        keys.fault("turns", f"draw {FEWEST:g} to {MOST:g} turns", with_value=True)
    if outer <= inner:
        keys.fault("outer", "the stud must stand outside the collet: outer is no more than inner", with_value=True)
    stud = keys.quantity("stud")
    return Coil(inner, outer, turns, stud, width) if len(table.faults.found) == known else None


def _weighed(body: Body | None) -> Coil | None:
    spirals = () if body is None or body.motion != "pivot" else [one for one in body.solids if one.kind == HAIRSPRING]
    for solid in spirals:
        if solid.spiral is not None and FEWEST <= solid.spiral.turns <= MOST:
            return Coil(solid.spiral.inner, solid.spiral.outer, solid.spiral.turns, 0.0, solid.width)
    return None
