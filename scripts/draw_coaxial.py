"""How are the drawings of the co-axial escapement made?

    python scripts/draw_coaxial.py [folder]

Writes escape_wheel, lever, roller and banking as DXF (default folder: profiles/coaxial), from the design's own dimensions. The
scene (profiles/coaxial/scene.toml) is what `watchsim new coaxial` writes, with its length, window and expectations set by hand.
"""

from __future__ import annotations

from pathlib import Path

from watchsim.construction.coaxial.coaxial_dimensions import Coaxial
from watchsim.construction.coaxial.coaxial_sheets import sheets
from watchsim.storage.write import write_file


def draw(folder: Path) -> None:
    """Write the four drawings into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, sheet in sheets(Coaxial()).items():
        text = sheet.dxf()
        write_file(folder / f"{name}.dxf", lambda scratch, text=text: scratch.write_bytes(text), "the drawing")  # type: ignore[misc]


if __name__ == "__main__":
    from usage import arguments

    default = Path(__file__).resolve().parents[1] / "profiles" / "coaxial"
    draw(arguments(__doc__, folder=(default, "where the drawings go")).folder)
