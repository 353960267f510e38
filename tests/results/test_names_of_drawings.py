"""Under which names do drawings travel with results?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from watchsim.results.scene_copy import kept_names


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
