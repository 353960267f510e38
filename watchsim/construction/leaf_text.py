"""How is the leaf of a design written into its scene?"""

from __future__ import annotations

from typing import Protocol

STEEL = 200e9  # Pa


class Leaf(Protocol):
    """Dimensions with those of a leaf of steel and of the arm at which it presses, mm."""

    @property
    def leaf_length(self) -> float: ...

    @property
    def leaf_width(self) -> float: ...

    @property
    def leaf_thickness(self) -> float: ...

    @property
    def leaf_arm(self) -> float: ...


def leaf_text(values: Leaf) -> str:
    """What stands between the braces of `leaf = { }`."""
    sizes = (
        ("length", values.leaf_length),
        ("width", values.leaf_width),
        ("thickness", values.leaf_thickness),
        ("arm", values.leaf_arm),
    )
    return ", ".join([f'modulus = "{STEEL * 1e-9:g} GPa"', *(f'{name} = "{size!r} mm"' for name, size in sizes)])
