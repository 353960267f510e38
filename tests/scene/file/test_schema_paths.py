"""Which key does a dotted path mean?"""

from __future__ import annotations

import pytest

from watchsim.scene.keys import ADJUST, SOLID, key_at


@pytest.mark.parametrize(
    ("path", "key"),
    [
        ("bodies.wheel.solids.0.thickness", SOLID["thickness"]),
        ("bodies.lever.adjust.STONES.turn", ADJUST["turn"]),
        ("bodies.lever.adjust.STONES.1.turn", ADJUST["turn"]),
        ("bodies.wheel.solids.0.nonsense", None),
        ("bodies", None),
    ],
)
def test_paths_into_nested_tables(path: str, key: object) -> None:
    assert key_at(tuple(path.split("."))) == key
