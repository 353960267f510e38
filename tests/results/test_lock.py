"""Does the locked scene load again to the scene that was simulated?"""

import hashlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim.results.folder import lock_text
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.values import tomllib
from watchsim.scene.write_toml import toml_text

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
