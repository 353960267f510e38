"""What is the outline of the bench lever: the made-up escapement used to compare engines?

    python scripts/draw_bench_lever.py [folder]

Writes wheel, lever, balance and banking as DXF (default folder: profiles/bench_lever). Fifteen pointed teeth of 2.5 mm,
straight polygons and circles only; the numbers are the scene's definition and are kept to the nanometre as published,
so nothing is computed here. The scene itself (profiles/bench_lever/scene.toml) is written by hand.
"""

from __future__ import annotations

from pathlib import Path

from watchsim.drawing.sheet import add_circle, add_polygon, new_sheet, write

TEETH = (
    ((2.5, 0.0), (1.826397222, 0.523710976), (1.881509331, 0.264428892)),
    ((2.283863644, 1.016841608), (1.455484442, 1.221296458), (1.611291383, 1.006846602)),
    ((1.672826516, 1.857862064), (0.832905179, 1.707708688), (1.062466517, 1.575171388)),
    ((0.772542486, 2.377641291), (0.066309044, 1.898842571), (0.329931538, 1.871134731)),
    ((-0.261321158, 2.486304738), (-0.711752527, 1.761649324), (-0.459651602, 1.84356188)),
    ((-1.25, 2.165063509), (-1.366745621, 1.319850904), (-1.169756803, 1.497220432)),
    ((-2.022542486, 1.469463131), (-1.785415979, 0.649838272), (-1.677600426, 0.891995969)),
    ((-2.445369002, 0.519779227), (-1.895371695, -0.1325373), (-1.895371695, 0.1325373)),
    ((-2.445369002, -0.519779227), (-1.677600426, -0.891995969), (-1.785415979, -0.649838272)),
    ((-2.022542486, -1.469463131), (-1.169756803, -1.497220432), (-1.366745621, -1.319850904)),
    ((-1.25, -2.165063509), (-0.459651602, -1.84356188), (-0.711752527, -1.761649324)),
    ((-0.261321158, -2.486304738), (0.329931538, -1.871134731), (0.066309044, -1.898842571)),
    ((0.772542486, -2.377641291), (1.062466517, -1.575171388), (0.832905179, -1.707708688)),
    ((1.672826516, -1.857862064), (1.611291383, -1.006846602), (1.455484442, -1.221296458)),
    ((2.283863644, -1.016841608), (1.881509331, -0.264428892), (1.826397222, -0.523710976)),
)
PALLETS = (
    ((-1.291726486, -0.644031069), (-0.804948697, -0.609996918), (-1.015049524, 0.26513601), (-1.501827314, 0.23110186)),
    ((1.291726486, -0.644031069), (1.516169995, -1.107999433), (2.088640394, -0.413537308), (1.864196885, 0.050431056)),
)
FORK = (
    ((-0.38, 3.4), (-0.13, 3.4), (-0.13, 3.77), (-0.38, 3.74)),
    ((0.13, 3.4), (0.38, 3.4), (0.38, 3.74), (0.13, 3.77)),
)
ARM = ((-0.15, 1.2), (0.15, 1.2), (0.15, 3.2), (-0.15, 3.2))
PIN_CENTRE, PIN_RADIUS = (0.0, -0.85), 0.12
BANKING_CENTRES, BANKING_RADIUS = ((-0.540080174, 4.843997729), (0.540080174, 4.843997729)), 0.2


def draw(folder: Path) -> None:
    """Write the four drawings into `folder`."""
    wheel = new_sheet(("TEETH",))
    for tooth in TEETH:
        add_polygon(wheel, "TEETH", list(tooth))
    write(wheel, folder / "wheel.dxf")
    lever = new_sheet(("PALLETS", "FORK", "ARM"))
    for layer, shapes in (("PALLETS", PALLETS), ("FORK", FORK), ("ARM", (ARM,))):
        for shape in shapes:
            add_polygon(lever, layer, list(shape))
    write(lever, folder / "lever.dxf")
    balance = new_sheet(("PIN",))
    add_circle(balance, "PIN", PIN_CENTRE, PIN_RADIUS)
    write(balance, folder / "balance.dxf")
    banking = new_sheet(("PINS",))
    for centre in BANKING_CENTRES:
        add_circle(banking, "PINS", centre, BANKING_RADIUS)
    write(banking, folder / "banking.dxf")


if __name__ == "__main__":
    from usage import arguments

    default = Path(__file__).resolve().parents[1] / "profiles" / "bench_lever"
    draw(arguments(__doc__, folder=(default, "where the drawings go")).folder)
