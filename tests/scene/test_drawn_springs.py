"""Is a spring drawn as its scene says, without any say in the motion?"""

from __future__ import annotations

import math
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from watchsim.geometry.hairspring import Coil
from watchsim.mechanism.compile import compile_scene
from watchsim.paths import profiles_dir
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.scene import Scene

PROFILES = Path(str(profiles_dir()))


def same(a: object, b: object) -> bool:
    """Equal to the bit, records field by field."""
    if isinstance(a, np.ndarray):
        return isinstance(b, np.ndarray) and a.dtype == b.dtype and a.tobytes() == b.tobytes()
    if hasattr(a, "_fields"):
        return all(same(getattr(a, name), getattr(b, name)) for name in a._fields)
    if isinstance(a, (tuple, list)):
        return isinstance(b, (tuple, list)) and len(a) == len(b) and all(map(same, a, b))
    return bool(a == b)


@pytest.mark.parametrize("profile", ["swiss_lever", "coaxial"])
def test_what_is_only_drawn_changes_no_bit_of_the_model(profile: str) -> None:
    scene = load(PROFILES / profile)
    assert {loop.layer for loop in scene.body("balance").decoration} == {"RIM"} and scene.springs[0].coil is not None
    bare = replace(
        scene,
        bodies=tuple(replace(body, decoration=()) for body in scene.bodies),
        springs=tuple(replace(spring, coil=None) for spring in scene.springs),
    )
    with_rim, without = compile_scene(scene), compile_scene(bare)
    for field in fields(with_rim):
        assert same(getattr(with_rim, field.name), getattr(without, field.name)), field.name
    turned = compile_scene(scene.set("bodies.lever.adjust.ARMS", {"turn": "0.0001°"}))
    assert not same(with_rim.model, turned.model)


def test_a_hairspring_that_is_weighed_is_drawn_as_it_is_weighed() -> None:
    (spring,) = load(PROFILES / "balance").springs
    assert spring.coil == Coil(0.6e-3, 2.6e-3, 13.0, 0.0, 3e-5)


def test_dimensions_are_keys_like_any_other() -> None:
    scene = load(PROFILES / "swiss_lever").set("springs.0.draw.turns", 11).set("springs.0.draw.stud", "45°")
    assert scene.springs[0].coil.turns == 11 and scene.springs[0].coil.stud == pytest.approx(math.radians(45.0))


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("springs.0.draw.turn", 3, 'Did you mean "turns"'),
        ("springs.0.draw.outer", "0.1 mm", "stud must stand outside"),
        ("springs.0.draw.inner", "-1 mm", "above zero"),
        ("springs.0.draw.turns", 1e6, "1 to 100 turns"),
        ("springs.0.draw.width", "3 kg", "length"),
        ("springs.0.draw", 3, "a table is needed"),
        ("springs.0.draw", {"inner": "1 mm"}, "missing: outer"),
    ],
)
def test_what_cannot_be_drawn_is_said(key: str, value: object, said: str) -> None:
    scene: Scene = load(PROFILES / "swiss_lever")
    with pytest.raises(SceneError, match=said):
        scene.set(key, value)


def test_a_sliding_body_has_no_hairspring(tmp_path: Path) -> None:
    text = """
[bodies.slider]
circle = "1 mm"
motion = "slide"
axis = [1.0, 0.0]
mass = "1 g"
[[springs]]
body = "slider"
stiffness = "1 N/m"
draw = { inner = "1 mm", outer = "2 mm", turns = 5 }
"""
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    with pytest.raises(SceneError, match="wound about a pivot"):
        load(tmp_path / "scene.toml")
