"""How do tests read a drawing that they have just written?"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.read import read

SHARED = Path(__file__).resolve().parents[2].parent / "shared" / "drawings"


@pytest.fixture
def read_bytes(tmp_path: Path) -> Callable[..., Drawing]:
    """read_bytes(data, **options): the drawing read from a file with these bytes."""

    def reader(data: bytes, **options: object) -> Drawing:
        path = tmp_path / "drawing.dxf"
        path.write_bytes(data)
        return read(path, **options)  # type: ignore[arg-type]

    return reader


@pytest.fixture
def shared_drawings() -> Path:
    """The folder of real drawings beside the project; tests that need it are skipped without it."""
    if not SHARED.is_dir():
        pytest.skip("the real drawings are not here")
    return SHARED
