"""What does a locked scene say that its file left out?"""

import dataclasses
import hashlib
import platform

import numpy as np

from watchsim.results.folder import _start, _undrawn, lock_text, versions
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Prescribed, Written
from watchsim.scene.values import tomllib

EVERYTHING = """
[bodies.disc]
circle = "2 mm"
motion = "free"
position = ["3 mm", "5 mm"]
velocity = ["7 mm/s", "11 mm/s"]
spin = "13 rad/s"
mass = "17 g"
[bodies.rolls]
circle = "3 mm"
motion = "free"
mass = "17 g"
[bodies.slider]
polygon = [["0 mm", "0 mm"], ["1 mm", "0 mm"], ["0 mm", "1 mm"]]
motion = "slide"
axis = [0, 1]
mass = "3 g"
[bodies.wheel]
circle = "4 mm"
angle = "0.5 rad"
[[bodies.wheel.solids]]
layer = "circle"
thickness = "0.12 mm"
density = "7.85 g/cm³"
[bodies.arm]
inertia = "1 g·cm²"
[bodies.driver]
motion = "driven"
velocity = "2 rad/s"
[bodies.plate]
circle = "1 mm"
motion = "fixed"
[[springs]]
body = "arm"
stiffness = "1 µN·m/rad"
rest = "0.25 rad"
[[springs]]
body = "slider"
stiffness = "40 N/m"
[[springs]]
body = "wheel"
stiffness = "1 µN·m/rad"
preload = "0.5 µN·m"
[[contacts]]
between = ["disc", "plate"]
friction = 0.3
[[contacts]]
between = ["wheel", "plate"]
restitution = 0.2
"""


def test_what_each_kind_of_body_leaves_out_is_written_out(desk):
    scene = load(desk.scene(EVERYTHING))
    told = tomllib.loads(lock_text(scene, desk.folder))
    bodies = told["bodies"]
    assert list(bodies) == ["disc", "rolls", "slider", "wheel", "arm", "driver", "plate"]
    at_start = {key: bodies["rolls"][key] for key in ("position", "angle", "velocity", "spin")}
    assert at_start == {
        **{"position": ["0.0 m", "0.0 m"], "angle": "0.0 rad"},
        **{"velocity": ["0.0 m/s", "0.0 m/s"], "spin": "0.0 rad/s"},
    }
    assert bodies["disc"]["velocity"] == ["7 mm/s", "11 mm/s"] and bodies["disc"]["spin"] == "13 rad/s"
    assert bodies["rolls"]["inertia"] == f"{scene.body('rolls').inertia!r} kg·m²"
    assert bodies["slider"]["velocity"] == "0.0 m/s" and bodies["arm"]["velocity"] == "0.0 rad/s"
    assert bodies["wheel"]["motion"] == "pivot" and bodies["wheel"]["angle"] == "0.5 rad"
    assert "inertia" not in bodies["wheel"] and "inertia" not in bodies["plate"] and "inertia" not in bodies["driver"]
    assert "velocity" not in bodies["plate"] and bodies["driver"]["velocity"] == "2 rad/s"
    assert [spring.get("rest") for spring in told["springs"]] == ["0.25 rad", "0.0 m", None]
    coefficients = ("friction", "restitution", "tangential_restitution")
    assert [[one[key] for key in coefficients] for one in told["contacts"]] == [[0.3, 0.0, 0.0], [0.0, 0.2, 0.0]]
    assert told["run"]["duration"] == f"{scene.duration!r} s" and told["run"]["tolerance"] == scene.tolerance
    assert told["scene"]["gravity"] == ["0.0 m/s²", "0.0 m/s²"] and told["scene"]["title"] == scene.title


def test_velocities_at_the_start_by_kind_of_motion():
    """In the order of the coordinates; none of what is moved as the scene says, or not at all."""
    free = Body("a", "free", velocity=(0.5, -0.25, 3.5))
    assert _start(free) == {"velocity": ["0.5 m/s", "-0.25 m/s"], "spin": "3.5 rad/s"}
    assert _start(Body("a", velocity=(1.5,))) == {"velocity": "1.5 rad/s"}
    assert _start(Body("a", "slide", velocity=(-2.5,))) == {"velocity": "-2.5 m/s"}
    assert _start(Body("a", "fixed")) == {} == _start(Body("a", velocity=(1.5,), prescribed=Prescribed()))


def test_drawings_travel_under_their_new_names(desk):
    """Each with the digest of what was read, wherever the files are by now."""
    scene = load(desk.scene())
    data = scene.drawings["wheel.dxf"]
    (desk.folder / "wheel.dxf").unlink()
    told = tomllib.loads(lock_text(scene, kept={"wheel.dxf": "drawings/wheel_3.dxf"}))
    assert told["bodies"]["wheel"]["drawing"] == "drawings/wheel_3.dxf"
    assert told["lock"]["drawings"] == {"drawings/wheel_3.dxf": hashlib.sha256(data).hexdigest()}


def test_versions_are_those_of_what_is_installed():
    found = versions()
    assert found["python"] == platform.python_version() and found["numpy"] == np.__version__
    found["numpy"] = "changed"
    assert versions()["numpy"] == np.__version__


def test_a_design_makes_its_drawings_again(desk):
    """Unless they travel with the text: then it says of the design only which it was."""
    text = desk.scene().read_text(encoding="utf-8")
    scene = load(desk.scene())
    source = {**scene.source, "design": {"name": "lever", "teeth": 15}}
    of_design = dataclasses.replace(scene, source=source, written=Written({}, {}, frozenset({"wheel.dxf"})))
    assert "drawing" in text
    told = tomllib.loads(lock_text(of_design, desk.folder))
    assert told["design"] == {"name": "lever", "teeth": 15} and "design" not in told["lock"]
    assert "drawing" not in told["bodies"]["wheel"] and told["bodies"]["wheel"]["layers"] == ["TEETH"]
    assert told["lock"]["drawings"] == {}
    kept = tomllib.loads(lock_text(of_design, desk.folder, kept={"wheel.dxf": "drawings/wheel.dxf"}))
    assert "design" not in kept and kept["lock"]["design"] == {"name": "lever", "teeth": 15}
    assert kept["bodies"]["wheel"]["drawing"] == "drawings/wheel.dxf" and list(kept["lock"]["drawings"]) == [
        "drawings/wheel.dxf"
    ]


def test_of_a_table_only_the_made_drawing_is_left_out():
    entry = {"drawing": "wheel.dxf", "layers": "wheel.dxf", "mass": "1 g"}
    assert _undrawn(entry, frozenset({"wheel.dxf", "1 g"})) == {"layers": "wheel.dxf", "mass": "1 g"}
    assert _undrawn(entry, frozenset({"lever.dxf"})) == entry
