"""How is the scene of a design written: commented tables, their keys aligned, a remark behind a heading or a value?

    scene(
        head(values, "A simple pendulum, drawn to these dimensions:", "Simple pendulum"),
        body("bob", "bob", "BOB", angle="5°", inertia=f"{values.inertia:.15g} g·mm²"),
        table("[[damping]]", body="bob", q_factor=values.q_factor),
        run("10 s"),
    )

Texts are quoted, numbers written with all their digits, entries of value None left out. Lengths are millimetres.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from watchsim.construction.design import Values, dimensions_of

NOTED = 37  # column at which remarks begin
ORIGIN = ("0 mm", "0 mm")
STEEL = 200e9  # Pa


@dataclass(frozen=True)
class Noted:
    """A value with a remark behind it, so many spaces away."""

    value: object
    remark: str
    gap: int = 8


def scene(*tables: str | None) -> str:
    """The whole text."""
    return "\n".join(one for one in tables if one is not None)


def table(heading: str, remark: str = "", width: int = 0, /, **entries: object) -> str:
    """A heading with its entries; the signs = stand below each other, `width` characters or the longest key from the left."""
    given = {key: value for key, value in entries.items() if value is not None}
    wide = width or max(map(len, given))
    first = f"{heading:{NOTED}}# {remark}" if remark else heading
    return "\n".join([first, *(f"{key:{wide}} = {_written(value)}" for key, value in given.items())]) + "\n"


def _written(value: object) -> str:
    if isinstance(value, Noted):
        return f"{_written(value.value)}{' ' * value.gap}# {value.remark}"
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_written, value))}]"
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {_written(one)}' for key, one in value.items())} }}"
    return repr(value)


def head(values: Values, words: str, title: str, after: str = "", gravity: float | None = None) -> str:
    """The comment with all dimensions, those that differ from the default marked, and [scene]; gravity in m/s², downwards."""
    lines = [f"# {line}" for line in words.splitlines()]
    for one in dimensions_of(type(values)):
        number = getattr(values, one.name)
        usual = "" if number == one.default else f" (default {one.shortly(one.default)})"
        lines.append(f"#   {one.name} = {one.shortly(number)}{usual}: {one.meaning}")
    lines += [f"# {line}" for line in after.splitlines()]
    down = None if gravity is None else ("0 m/s²", f"{-gravity!r} m/s²")
    return "\n".join(lines) + "\n\n" + table("[scene]", title=title, schema=1, gravity=down)


def at(x: float, y: float) -> tuple[str, str]:
    """A place, mm."""
    return (f"{x!r} mm", f"{y!r} mm")


def body(
    name: str,
    file: str,
    layers: str,
    remark: str = "",
    *,
    rides: str | None = None,
    draw: str | None = None,
    pivot: object = "PIVOT",
    width: int = 8,
    **entries: object,
) -> str:
    """A body with its drawing, the layers that touch and those that are only drawn, each separated by blanks; it `rides` on
    another one."""
    first: dict[str, Any] = {} if rides is None else {"on": rides}
    first |= {"drawing": f"{file}.dxf", "layers": layers.split(), "draw": draw and draw.split(), "pivot": pivot}
    return table(f"[bodies.{name}]", remark, width, **first, **entries)


def banking(layer: str = "PINS") -> str:
    """The banking of a lever or detent."""
    return body("banking", "banking", layer, position=ORIGIN, motion="fixed")


class Law(Protocol):
    """Dimensions with the two coefficients that all contacts of a design share."""

    @property
    def friction(self) -> float: ...

    @property
    def restitution(self) -> float: ...


def contacts(law: Law, *pairs: str) -> str:
    """One table for each pair of sides, "body.LAYER body.LAYER", with a remark behind a colon."""
    found = []
    for pair in pairs:
        sides, _, remark = pair.partition(": ")
        entries: dict[str, Any] = {"between": sides.split(), "friction": law.friction, "restitution": law.restitution}
        found.append(table("[[contacts]]", remark, **entries))
    return scene(*found)


def torque(body: str, value: str, remark: str = "") -> str:
    """A constant torque."""
    return table("[[torques]]", remark, body=body, value=value)


def hairspring(frequency: float, draw: Mapping[str, object] | None = None) -> str:
    """Of the balance, by its frequency in beats per hour."""
    return table("[[springs]]", body="balance", frequency=f"{frequency:.15g} vph", draw=draw)


def q_factor(body: str, value: float) -> str:
    """Damping of an oscillator by its quality factor."""
    return table("[[damping]]", body=body, q_factor=value)


def run(duration: str, tolerance: str = "1e-9") -> str:
    """How long and how accurately it is simulated."""
    return table("[run]", "", 9, duration=duration) + f"tolerance = {tolerance}\n"


def timegrapher(lift_angle: str | Noted) -> str:
    """The lift angle to which the amplitude is computed."""
    return table("[timegrapher]", lift_angle=lift_angle)


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


def leaf(values: Leaf) -> dict[str, str]:
    """The entries of `leaf = { }`."""
    sizes = {
        "length": values.leaf_length,
        "width": values.leaf_width,
        "thickness": values.leaf_thickness,
        "arm": values.leaf_arm,
    }
    return {"modulus": f"{STEEL * 1e-9:g} GPa", **{name: f"{size!r} mm" for name, size in sizes.items()}}
