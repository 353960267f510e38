"""Does one mistake give one message, which says what to do, and nothing that only follows from it?"""

from __future__ import annotations

import pytest

from watchsim.scene.errors import SceneError
from watchsim.scene.load import load

# what stands in the good scene | what replaces it (; for a new line) | key and value | message
SAID = """
layers = ["TEETH"] | layers = [] | bodies.wheel.layers = [] | \
nothing of the drawing can touch, though a contact names this body. \
Name the layers that touch, such as ["TEETH"], or leave layers out: then all with closed outlines can.
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
value = "-1.0 µN·m" | over = "time" | torques.0 | missing: the table to which over belongs.
value = "-1.0 µN·m" | table = [["0 s", "0 N·m"], ["1 s", "1 N·m"]] | torques.0 | a table needs over = "angle" or over = "time".

frequency = "28800 vph" | freqency = "28800 vph" | springs.0.freqency | unknown key. Did you mean "frequency"?
frequency = "28800 vph" | leaf = {} | springs.0.leaf | missing: modulus, length, width, thickness, arm. Write e.g. \
leaf = { modulus = "200 GPa", length = "5 mm", width = "0.5 mm", thickness = "0.08 mm" } with arm = "2 mm", on a pivoted body.
frequency = "28800 vph" | frequency = "4 Hz"; draw = { stud = "1°" } | springs.0.draw | \
missing: inner, outer, turns. Write e.g. draw = { inner = "0.5 mm", outer = "2.8 mm", turns = 13, stud = "90°" }.
[[springs]] | [springs] | springs | write [[springs]] with double brackets: there can be several.
[[springs]] | [[sprngs]] | sprngs | unknown section. Did you mean "springs"?
friction = 0.12 | lift_angle = "50°" | contacts.0.lift_angle | unknown key. It belongs under [timegrapher].
motion = "fixed" | motion = "fixed"; friction = 0.1 | bodies.banking.friction | unknown key. It belongs under [[contacts]].
[scene] | title = "x"; [scene] | title | unknown section. It belongs under [scene].
[timegrapher] | [timegrapher]; frequency = "7 Hz" | timegrapher.frequency = "7 Hz" | \
the oscillator makes small swings at 4 Hz (28800 vph), more than 10 % off: look at mass, inertia and spring.
[scene] | [scen] | scen | unknown section. Did you mean "scene"?
motion = "fixed" | moton = "fixed" | bodies.banking.moton | unknown key. Did you mean "motion"?
motion = "fixed" | axis = [1, 0]; mass = "1 g"; velocity = "1 mm/s" | bodies.banking.axis | \
belongs to motion = "slide", which is not written; a body turns unless motion says otherwise.
motion = "fixed" | path = [["1 s", "5°"]] | bodies.banking.path | \
belongs to motion = "driven", which is not written; a body turns unless motion says otherwise.
motion = "fixed" | motion = "driven"; swing = {} | bodies.banking.swing | missing: amplitude, frequency. Write e.g. \
swing = { amplitude = "10°", frequency = "2 Hz" }.
motion = "fixed" | motion = "fixed"; on = "" | bodies.banking.on = "" | \
there is no such body. Known here: wheel, lever, balance.

tolerance = 1e-8 | tolerance = "2 s" | run.tolerance = "2 s" | "2 s" is a time; here a plain number is needed, without a unit.
"lever", "banking.circle" | "lever", 5 | contacts.2.between = ["lever", 5] | \
two sides are needed: between = ["wheel.TEETH", "lever.STONES"].
[run] | [[gears]]; between = ["wheel", "lever"]; ratio = 2; restitution = 0.1; efficiency = 0.9; [run] | gears.0.restitution | \
restitution and efficiency need play: give backlash = "0.5°", how far the second body can go while the first is held.
[run] | [[gears]]; between = ["wheel", "lever"]; ratio = 2; backlash = "1°"; efficiency = "1 s"; [run] | \
gears.0.efficiency = "1 s" | "1 s" is a time; here a plain number is needed, without a unit.
[run] | [[gears]]; between = ["wheel", 3]; ratio = 2; [run] | gears.0.between = ["wheel", 3] | \
two bodies are needed: between = ["wheel", "pinion"].
[run] | [[line_springs]]; between = []; points = [["0 mm", "0 mm"], ["1 mm", "0 mm"]]; stiffness = "1 N/m"; [run] | \
line_springs.0.between = [] | \
one or two bodies are needed: between = ["lever", "wheel"], or ["lever"] for a spring from the movement.
{ value = 500, tolerance = 3 } | {} | expect.impacts | missing: value, tolerance. Write e.g. { value = 500, tolerance = 3 }.

duration = "180 s" | duration = 180 s | duration = 180 s | \
not valid TOML: Expected newline or end of document after a statement. \
Texts and quantities stand in quotes; plain numbers (0.15), true, false and lists do not.
duration = "180 s" | duration = "180 s | duration = "180 s | not valid TOML: Illegal character '\\n'. \
A quotation mark is missing at the end of the line.
[bodies.lever] | [bodies.wheel] | [bodies.wheel] | not valid TOML: Cannot declare ('bodies', 'wheel') twice. \
This table is there already: give it another name, or make one of both.
friction = 0.12 | friction = 0.1; friction = 0.2 | friction = 0.2 | not valid TOML: Cannot overwrite a value. \
This key has a value already: leave one of them out.
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


def only(text: str, desk) -> str:
    with pytest.raises(SceneError) as caught:
        load(desk.scene(text))
    (fault,) = caught.value.faults
    return str(fault).partition("/scene.toml:")[2]


@pytest.mark.parametrize("bodies", ["", "[bodies]\n", "bodies = 5\n", "bodies = []\n"])
def test_without_bodies_none_of_them_is_missed(desk, good, bodies):
    start, end = good.index("[bodies.wheel]"), good.index("[[springs]]")
    with pytest.raises(SceneError) as caught:
        load(desk.scene(bodies + good[:start] + good[end:]))
    assert [fault.key for fault in caught.value.faults] == ["bodies"]


def test_forces_on_a_body_that_there_is_not_may_be_of_either_kind(desk, good):
    spring = '[[springs]]\nbody = "rack"\nstiffness = "1 N/m"\npreload = "2 N"\n'
    torque = '[[torques]]\nbody = "rack"\nover = "travel"\ntable = [["0 mm", "0 N"], ["1 mm", "1 N"]]\n'
    for text in (spring, torque, '[[damping]]\nbody = "rack"\nviscous = "1 N·s/m"\n'):
        assert "there is no such body" in only(good + text, desk)
    other = good + spring.replace("1 N/m", "3 s")
    with pytest.raises(SceneError, match="is a time; here a rotary stiffness or stiffness is needed"):
        load(desk.scene(other))


def test_a_misspelt_table_keeps_its_lines_and_its_faults(desk, good):
    """Both mistakes are told, with the keys and lines that stand in the file."""
    with pytest.raises(SceneError) as caught:
        load(desk.scene(good.replace("[scene]\ntitle", "[scen]\ntitel").replace('"Small lever"', "5")))
    faults = [(fault.key, fault.place.rpartition(":")[2]) for fault in caught.value.faults]
    assert faults == [("scen", "1"), ("scen.titel", "2"), ("scen.titel", "2")]


def test_the_body_of_a_spring_may_be_anything_beside_gears(desk, good):
    gears = '[[gears]]\nbetween = ["wheel", "lever"]\nratio = 2\n'
    assert "a text in quotes is needed" in only(good.replace('body = "balance"\nfreq', "body = []\nfreq") + gears, desk)
