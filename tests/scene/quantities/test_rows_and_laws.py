"""Are rows that are no pairs refused, laws that give nothing back named, and is a scene without outlines a millimetre large?"""

from __future__ import annotations

from pathlib import Path

import pytest

from watchsim.mechanism.compile import scene_size
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene

TEXT = """
[scene]
title = "two discs"
{law}
[bodies.a]
circle = "1 mm"
inertia = "1 g·cm²"
[bodies.b]
circle = "1 mm"
position = ["3 mm", "0 mm"]
inertia = "1 g·cm²"
[[contacts]]
between = ["a", "b"]
tangential_restitution = {tangential}
restitution = 0.5
[[torques]]
body = "a"
over = "time"
table = [["0 s", "0 N·m"], {row}]
[run]
duration = "1 s"
"""


def loaded(folder: Path, law: str = "", tangential: float = 0.0, row: str = '["1 s", "1 N·m"]') -> Scene:
    path = folder / "scene.toml"
    path.write_text(TEXT.format(law=law, tangential=tangential, row=row), encoding="utf-8")
    return load(path)


@pytest.mark.parametrize("row", ['["1 s"]', '["1 s", "1 N·m", "2 N·m"]', '"1 s"', "3", '"ab"', "[]"])
def test_two_values_in_each_row(tmp_path: Path, row: str) -> None:
    assert loaded(tmp_path).torques[0].table == ((0.0, 0.0), (1.0, 1.0))
    with pytest.raises(SceneError, match="two values are needed in each row"):
        loaded(tmp_path, row=row)


@pytest.mark.parametrize("tangential", [5e-4, 0.5])
def test_tangential_restitution_needs_a_law_that_gives_it_back(tmp_path: Path, tangential: float) -> None:
    assert loaded(tmp_path, 'tangential_law = "pg1996"', tangential).contacts[0].tangential_restitution == tangential
    with pytest.raises(SceneError, match="tangential_restitution"):
        loaded(tmp_path, 'tangential_law = "coulomb"', tangential)


def test_a_scene_without_outlines_is_a_millimetre_large() -> None:
    assert scene_size(Scene("none", (Body("a"), Body("b", "fixed")))) == pytest.approx(1e-3, rel=1e-12)
