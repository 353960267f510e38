"""Does one mistake give one message, which says what to do, and nothing that only follows from it?"""

from __future__ import annotations

import pytest

from watchsim.scene.errors import SceneError
from watchsim.scene.file.load import load

# what stands in the good scene | what replaces it (; for a new line) | key and value | message
SAID = """
layers = ["TEETH"] | layers = [] | bodies.wheel.layers = [] | \
nothing of the drawing can touch, though a contact names this body. \
Name the layers that touch, of ["TEETH", "BORE"], or leave layers out: then all can.
"wheel.dxf" | "." | bodies.wheel.drawing = "." | this is a folder; the name of a drawing is needed here: wheel.dxf.
"wheel.dxf" | "" | bodies.wheel.drawing = "" | the name of a drawing is needed here: wheel.dxf.

"fixed" | "fix" | bodies.banking.motion = "fix" | not one of pivot, slide, free, fixed, driven. Did you mean "fixed"?
"fixed" | "rigid" | bodies.banking.motion = "rigid" | not one of pivot, slide, free, fixed, driven.
"fixed" | 5 | bodies.banking.motion = 5 | not one of pivot, slide, free, fixed, driven: a text in quotes is needed here.
"fixed" | "slidee"; axis = [1, 0]; mass = "1 g"; velocity = "1 mm/s" | bodies.banking.motion = "slidee" | \
not one of pivot, slide, free, fixed, driven. Did you mean "slide"?
"fixed" | "rail"; axis = [1, 0]; mass = "1 g"; velocity = "1 mm/s" | bodies.banking.motion = "rail" | \
not one of pivot, slide, free, fixed, driven.

title = "Small lever" | schema = "1" | scene.schema = "1" | a plain number is needed here, without quotes: schema = 1.
title = "Small lever" | schema = true | scene.schema = true | a plain number is needed here, without quotes: schema = 1.
title = "Small lever" | schema = 2 | scene.schema = 2 | this version of watchsim reads schema 1. \
Install the watchsim that this scene was written for.
title = "Small lever" | tangential_law = "pg96"; nu = 0.5 | scene.tangential_law = "pg96" | \
not one of coulomb, pg1996, shifted. Did you mean "pg1996"?
title = "Small lever" | tangential_law = "newton"; nu = 0.5 | scene.tangential_law = "newton" | \
not one of coulomb, pg1996, shifted.

value = "-1.0 µN·m" | over = "tme"; table = [["0 s", "0 N·m"], ["1 s", "1 N·m"]] | torques.0.over = "tme" | \
not one of angle, time, barrel. Did you mean "time"?
value = "-1.0 µN·m" | over = "seconds"; table = [["0 s", "0 N·m"], ["1 s", "1 N·m"]] | torques.0.over = "seconds" | \
not one of angle, time, barrel.
"""


@pytest.mark.parametrize("row", [row for row in SAID.splitlines() if row])
def test_one_mistake(desk, good, row):
    right, wrong, heading, message = row.split(" | ")
    assert right in good
    path = desk.scene(good.replace(right, wrong.replace("; ", "\n"), 1))
    with pytest.raises(SceneError) as caught:
        load(path)
    place, _, said = str(caught.value).partition("  ")
    assert said == f"{heading}\n  {message}"
    assert place.startswith(f"{path}:")
