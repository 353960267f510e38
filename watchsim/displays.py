"""How does a value show itself in a notebook, without knowing anything of pictures?

Scenes, runs and beats belong to layers that draw nothing. What draws them is looked up by name when a notebook asks.
"""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from typing import Any

HOME = "watchsim.pages.notebook"
PLAYER = "watchsim.pages.notebook"


def notebook_html(value: object) -> str:
    """HTML for a value of a class that `watchsim.pages.notebook` has a function for: NAME_html, in small letters."""
    draw = getattr(importlib.import_module(HOME), f"{type(value).__name__.lower()}_html")
    return str(draw(value))


def player(run: object, window: Sequence[float] | None = None) -> Any:
    """What plays a run inside a notebook."""
    return importlib.import_module(PLAYER).show(run, window)
