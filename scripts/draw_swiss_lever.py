"""How are the drawings of the Swiss lever made?

    python scripts/draw_swiss_lever.py [folder]

Writes escape_wheel, lever, roller and banking as DXF (default folder: profiles/swiss_lever): lines, arcs and circles on
named layers, millimetres, one point on the layer PIVOT each. The scene (profiles/swiss_lever/scene.toml) is written by
hand; scripts/checks/measure_lever.py measures what was drawn.
"""

from __future__ import annotations

from pathlib import Path

from draw_sheet import add_loop, new_sheet, write
from draw_swiss_body import lever
from draw_swiss_design import Swiss
from draw_swiss_roller import banking, roller
from draw_swiss_wheel import wheel

from watchsim.geometry.loop import Loop


def draw(folder: Path, design: Swiss | None = None) -> None:
    """Write the four drawings into `folder`."""
    swiss = design or Swiss()
    sheets = {"escape_wheel": wheel(swiss), "lever": lever(swiss), "roller": roller(swiss), "banking": banking(swiss)}
    for name, loops in sheets.items():
        draw_sheet(folder / f"{name}.dxf", loops)


def draw_sheet(path: Path, loops: list[Loop]) -> None:
    """One file with the loops on their layers and the pivot at the origin."""
    sheet = new_sheet(tuple(dict.fromkeys(loop.layer for loop in loops)))
    for loop in loops:
        add_loop(sheet, loop)
    write(sheet, path)


if __name__ == "__main__":
    from usage import arguments

    default = Path(__file__).resolve().parents[1] / "profiles" / "swiss_lever"
    draw(arguments(__doc__, folder=(default, "where the drawings go")).folder)
