"""How does a value show itself in a notebook, without knowing anything of pictures?

Scenes, runs and beats belong to layers that draw nothing. What draws them is looked up by name when a notebook asks.
"""

from __future__ import annotations

import importlib

HOME = "watchsim.pages.notebook"


def notebook_html(value: object) -> str:
    """HTML for a value of a class that `watchsim.pages.notebook` has a function for: NAME_html, in small letters."""
    draw = getattr(importlib.import_module(HOME), f"{type(value).__name__.lower()}_html")
    return str(draw(value))
