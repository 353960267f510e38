"""What holds where a scene leaves something out: the same in a file that says nothing, one that says it, and in Python."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import watchsim as ws
from watchsim.drawing.read import read as read_drawing
from watchsim.scene.forces import Contact, Damping, Side, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Gear, Recording, Scene

NECESSARY = """
[scene]
title = "left out"
[bodies.wheel]
circle = "1 mm"
inertia = "1 g·cm²"
{body}
[bodies.disc]
circle = "1 mm"
inertia = "1 g·cm²"
position = ["5 mm", "0 mm"]
[[damping]]
body = "wheel"
viscous = "1 nN·m·s"
{damping}
[[contacts]]
between = ["wheel", "disc"]
{contact}
[[gears]]
between = ["wheel", "disc"]
ratio = -1.0
backlash = "1°"
{gear}
[run]
duration = "1 s"
{run}
"""
SAID = {
    "body": 'motion = "pivot"\nposition = ["0 mm", "0 mm"]\nangle = "0°"\nmass = "0 g"\ncentre_of_mass = ["0 mm", "0 mm"]',
    "damping": 'quadratic = "0 N·m·s²/rad²"\ncoulomb = "0 N·m"',
    "contact": "friction = 0\nrestitution = 0\ntangential_restitution = 0",
    "gear": 'restitution = 0\nefficiency = 1\npressure_angle = "20°"',
    "run": 'tolerance = 1e-9\nrecord = "all"',
}


def scene(folder: Path, parts: dict[str, str]) -> Scene:
    path = folder / "scene.toml"
    path.write_text(NECESSARY.format(**parts), encoding="utf-8")
    return load(path)


def test_what_is_left_out_is_what_the_manual_says(tmp_path: Path) -> None:
    short = scene(tmp_path, dict.fromkeys(SAID, ""))
    for key, words in SAID.items():
        full = scene(tmp_path, dict.fromkeys(SAID, "") | {key: words})
        mine, theirs = (
            replace(one, source={}, bodies=tuple(replace(body, velocity=()) for body in one.bodies)) for one in (short, full)
        )
        assert mine == theirs, key


def test_in_python_the_same_is_left_out(tmp_path: Path) -> None:
    short = scene(tmp_path, dict.fromkeys(SAID, ""))
    wheel, disc = short.bodies
    made = Scene(
        "left out",
        (Body("wheel", inertia=1e-7, loops=wheel.loops), Body("disc", position=(5e-3, 0.0), inertia=1e-7, loops=disc.loops)),
        damping=(Damping("wheel", 1e-9),),
        contacts=(Contact((Side("wheel"), Side("disc"))),),
        gears=(Gear(("wheel", "disc"), -1.0, short.gears[0].backlash),),
    )
    for one, other in zip(made.bodies, short.bodies, strict=True):
        assert replace(one, velocity=other.velocity) == other
    for name in ("damping", "contacts", "gears", "gravity", "nu", "duration", "tolerance", "record", "torques"):
        assert getattr(made, name) == getattr(short, name), name
    assert Recording().stride == 1 and Torque("wheel").value == Body("wheel").inertia == 0.0
    assert ws.simulate(replace(made, gears=()), duration=0.1).end_q.tolist() == [0.0, 0.0]


def test_of_a_file_that_cannot_be_read_nothing_is_told(tmp_path: Path) -> None:
    for name in ("nothing.dxf", "nothing.svg"):
        (tmp_path / name).write_text("neither\n", encoding="utf-8")
        drawing = read_drawing(tmp_path / name)
        assert (drawing.fitted_curves, drawing.fitted_arcs, drawing.fitted_deviation, drawing.drawn.length) == (0, 0, 0.0, 0.0)
        assert any(finding.severity == "error" for finding in drawing.findings)
