"""Scenes of geared bodies, as text."""

from pathlib import Path

from watchsim.scene.load import load
from watchsim.scene.scene import Scene

WHEELS = """
[scene]
title = "two wheels"
{scene}

[bodies.wheel]
inertia = "1 g·cm²"
{wheel}

[bodies.pinion]
position = ["9 mm", "0 mm"]
inertia = "0.1 g·cm²"
{pinion}

[[gears]]
between = ["wheel", "pinion"]
ratio = {ratio}
{gears}

{more}

[run]
duration = "0.5 s"
"""


def wheels(folder: Path, ratio: float = -8.0, **parts: str) -> Scene:
    """A wheel of 1 g·cm² and a pinion of 0.1; `parts` are keys of [scene], bodies and gears, and `more` tables."""
    texts = dict.fromkeys(("scene", "wheel", "pinion", "gears", "more"), "") | parts
    return read(folder, WHEELS.format(ratio=ratio, **texts))


def read(folder: Path, text: str) -> Scene:
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return load(path)
