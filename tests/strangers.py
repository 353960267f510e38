"""Where are the drawings and scenes that are not ours? The one place that looks outside the repository.

The project stands alone: what needs them is skipped without them, and the same is tested on drawings of our own.
"""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
BESIDE = ROOT.parent / "shared"
DRAWINGS, SCENES = BESIDE / "drawings", BESIDE / "scenes"
PIN_LEVER = DRAWINGS / "pin_lever"


def marks(path: Path) -> list[pytest.MarkDecorator]:
    """Marks of what needs a path: where it lies outside the repository it can be missing, and is skipped with one line."""
    if path.is_relative_to(ROOT):
        return []
    return [pytest.mark.strangers, pytest.mark.skipif(not path.exists(), reason=f"not beside the repository: {path.name}")]


def needs(path: Path) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """The marks of `marks`, for one test."""

    def marked(test: Callable[..., None]) -> Callable[..., None]:
        for mark in marks(path):
            test = mark(test)
        return test

    return marked


def pin_lever_scene(name: str, folder: Path) -> Path:
    """A scene of `tests/pin_lever`, copied to `folder` together with the drawing it is of."""
    for path in (ROOT / "tests" / "pin_lever" / name, PIN_LEVER / "siconos_pin_lever_assembly.dxf"):
        shutil.copy(path, folder)
    return folder / name
