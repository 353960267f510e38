"""How do tests read a drawing that they have just written?"""

from collections.abc import Callable
from pathlib import Path

import pytest

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.read import read


@pytest.fixture
def read_bytes(tmp_path: Path) -> Callable[..., Drawing]:
    """read_bytes(data, **options): the drawing read from a DXF file with these bytes."""
    return reader_of(tmp_path / "drawing.dxf")


@pytest.fixture
def read_svg(tmp_path: Path) -> Callable[..., Drawing]:
    """read_svg(data, **options): the drawing read from an SVG file with these bytes or this text."""
    return reader_of(tmp_path / "drawing.svg")


def reader_of(path: Path) -> Callable[..., Drawing]:
    def reader(data: bytes | str, **options: object) -> Drawing:
        path.write_bytes(data.encode() if isinstance(data, str) else data)
        return read(path, **options)  # type: ignore[arg-type]

    return reader
