"""How are the drawings of the Swiss lever made?

    python scripts/draw_swiss_lever.py [folder]

Writes escape_wheel, lever, roller and banking as DXF (default folder: profiles/swiss_lever): lines, arcs and circles on
named layers, millimetres, one point on the layer PIVOT each. The construction is watchsim/construction/swiss_lever; the scene
(profiles/swiss_lever/scene.toml) is written by hand; scripts/checks/measure_lever.py measures what was drawn.
"""

from __future__ import annotations

from pathlib import Path

from watchsim.construction.swiss_lever.swiss_lever_points import Swiss
from watchsim.construction.swiss_lever.swiss_lever_sheets import sheets


def draw(folder: Path, design: Swiss | None = None) -> None:
    """Write the four drawings into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, sheet in sheets(design or Swiss()).items():
        (folder / f"{name}.dxf").write_bytes(sheet.dxf())


if __name__ == "__main__":
    from usage import arguments

    default = Path(__file__).resolve().parents[1] / "profiles" / "swiss_lever"
    draw(arguments(__doc__, folder=(default, "where the drawings go")).folder)
