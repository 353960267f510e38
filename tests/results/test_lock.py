"""Does the locked scene load again to the scene that was simulated?"""

import dataclasses
import hashlib
import platform

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.results.folder import lock_text, versions
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.scene import Written
from watchsim.scene.toml import toml_text, tomllib

FREE = """
[bodies.disc]
circle = "50 mm"
motion = "free"
position = ["0.1 mm", "150 mm"]
mass = "1 kg"
[bodies.slider]
motion = "slide"
axis = [1, 2]
mass = "3 g"
velocity = "0.3 mm/s"
[bodies.wheel]
drawing = "wheel.dxf"
pivot = "PIVOT"
[[bodies.wheel.solids]]
layer = "TEETH"
thickness = "0.12 mm"
density = "7.85 g/cm³"
[bodies."odd name µ"]
line = [["20 m", "0 m"], ["-1 m", "0 m"]]
motion = "fixed"
[[contacts]]
between = ["disc", "odd name µ"]
"""


@pytest.mark.parametrize("text", [None, FREE])
def test_round_trip(desk, good, text):
    scene = load(desk.scene(text or good))
    locked = desk.folder / "scene.lock.toml"
    locked.write_text(lock_text(scene, desk.folder), encoding="utf-8")
    again = load(locked)
    assert again == scene
    assert lock_text(again, desk.folder) == locked.read_text(encoding="utf-8")


def test_round_trip_in_another_folder(desk):
    scene = load(desk.scene()).set("bodies.lever.angle", 0.123456789012345)
    folder = desk.folder / "results"
    folder.mkdir()
    for where in (folder, None):
        locked = folder / "scene.lock.toml"
        locked.write_text(lock_text(scene, where), encoding="utf-8")
        assert load(locked) == scene
    assert 'drawing = "../wheel.dxf"' in lock_text(scene, folder)


def test_defaults_versions_and_digests_are_written_out(desk):
    text = lock_text(load(desk.scene()), desk.folder)
    mapping = tomllib.loads(text)
    assert mapping["bodies"]["lever"]["velocity"] == "0.0 rad/s"
    assert mapping["springs"][0]["rest"] == "0.0 rad"
    assert mapping["contacts"][1]["friction"] == 0.0
    assert mapping["scene"]["schema"] == 1
    digest = hashlib.sha256((desk.folder / "wheel.dxf").read_bytes()).hexdigest()
    assert mapping["lock"]["drawings"] == {"wheel.dxf": digest}
    assert {"python", "numpy"} <= set(mapping["lock"]["versions"])


def test_a_changed_drawing_is_noticed(desk):
    locked = desk.folder / "scene.lock.toml"
    locked.write_text(lock_text(load(desk.scene()), desk.folder), encoding="utf-8")
    (desk.folder / "wheel.dxf").write_text("another drawing")
    with pytest.raises(SceneError, match="the drawing was changed after this scene was locked"):
        load(locked)


SCALARS = st.one_of(st.booleans(), st.integers(-(2**60), 2**60), st.floats(allow_nan=False), st.text(max_size=8))
KEYS = st.text(min_size=0, max_size=6)


@given(
    st.recursive(
        st.dictionaries(KEYS, st.one_of(SCALARS, st.lists(SCALARS, max_size=3)), max_size=4),
        lambda inner: st.dictionaries(KEYS, st.one_of(SCALARS, inner, st.lists(inner, min_size=1, max_size=3)), max_size=4),
        max_leaves=12,
    )
)
def test_toml_reads_back(mapping):
    assert tomllib.loads(toml_text(mapping)) == mapping


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
