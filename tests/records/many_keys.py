"""Which made-up scenes use, between them, every table and most keys and units of a scene file?"""

from pathlib import Path

import dxf_text as d

FOLDER = Path(__file__).parent / "scenes"
MARKS = d.record("POINT", *d.point(10, (1, 2)), layer="PIVOT") + d.record("POINT", *d.point(10, (3, 2)), layer="PLACE")
DRAWING = d.dxf(
    d.lwpolyline([(-2, 0), (4, 0, 0.4), (4, 4), (-2, 4)], True, "PLATE")
    + d.circle(1, 2, 0.5, layer="BORE")
    + d.circle(3, 1, 0.25, layer="PINS")
    + d.circle(3, 3, 0.25, layer="PINS")
    + d.lwpolyline([(10, 0), (10.5, 0), (10.5, 3), (10, 3)], True, "STAFF")
    + d.line((10, -1), (10, 4), "AXIS")
    + d.lwpolyline([(5, 2), (5.4, 2), (5.4, 2.2), (5, 2.2)], True, "SCREW")
    + d.line((4.5, 2), (6, 2), "SCREW_AXIS")
    + d.line((-3, 0), (-3, 4), "BANK")
    + MARKS
)
SCENES = sorted(path.stem for path in FOLDER.glob("*.toml"))


def write(name: str, folder: Path) -> Path:
    """The scene file of that name, its drawing beside it."""
    (folder / "plate.dxf").write_bytes(DRAWING)
    path = folder / "scene.toml"
    path.write_bytes((FOLDER / f"{name}.toml").read_bytes())
    return path
