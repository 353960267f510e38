"""Under which names do drawings travel with results?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from watchsim.results import folder as module
from watchsim.results.folder import kept_names, travelling


def kept(**drawings: bytes) -> dict[str, str]:
    scene: Any = SimpleNamespace(drawings={name.replace("__", "/"): data for name, data in drawings.items()})
    return kept_names(scene)


def test_different_drawings_get_different_names() -> None:
    """Of the same name in other folders the second is numbered 2; the same drawing is kept once, whatever the case."""
    found = kept(
        **{"a__wheel.dxf": b"1", "b__wheel.dxf": b"2", "c__Wheel.dxf": b"3", "d__wheel.dxf": b"2", "e\\lever.svg": b"2"}
    )
    assert found == {
        "a/wheel.dxf": "drawings/wheel.dxf",
        "b/wheel.dxf": "drawings/wheel_2.dxf",
        "c/Wheel.dxf": "drawings/Wheel_3.dxf",
        "d/wheel.dxf": "drawings/wheel_2.dxf",
        "e\\lever.svg": "drawings/lever.svg",
    }
    assert kept(**{"wheel.dxf": b"1", "x__wheel.dxf": b"1"}) == dict.fromkeys(
        ("wheel.dxf", "x/wheel.dxf"), "drawings/wheel.dxf"
    )


def test_the_scene_and_its_drawings_by_their_new_names(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "lock_text", lambda scene, kept: f"locked with {sorted(kept.values())}")
    scene: Any = SimpleNamespace(source={"scene": {}}, drawings={"a/wheel.dxf": b"1", "b/wheel.dxf": b"2"})
    assert travelling(scene) == {
        "scene.lock.toml": "locked with ['drawings/wheel.dxf', 'drawings/wheel_2.dxf']",
        "drawings/wheel.dxf": b"1",
        "drawings/wheel_2.dxf": b"2",
    }


def test_of_bodies_made_by_hand_nothing_can_be_said() -> None:
    scene: Any = SimpleNamespace(source={}, drawings={"a/wheel.dxf": b"1"})
    assert travelling(scene) == {"scene.lock.toml": ""}
