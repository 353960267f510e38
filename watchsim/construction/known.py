"""Which designs are there? Each is loaded when it is asked for."""

from __future__ import annotations

import importlib

from watchsim.construction.design import Design

_HOMES = {
    "swiss_lever": "watchsim.construction.swiss_lever.design",
    "coaxial": "watchsim.construction.coaxial.design",
    "detent": "watchsim.construction.detent.design",
    "geneva": "watchsim.construction.geneva.design",
    "graham": "watchsim.construction.graham.design",
    "recoil_anchor": "watchsim.construction.recoil_anchor.design",
    "involute_pair": "watchsim.construction.involute_pair.design",
    "jumper": "watchsim.construction.jumper.design",
    "cam": "watchsim.construction.cam.design",
    "ratchet": "watchsim.construction.ratchet.design",
    "verge": "watchsim.construction.verge.design",
}

NAMES = tuple(_HOMES)


def design(name: str) -> Design:
    """The design of that name; KeyError if there is none."""
    found: Design = importlib.import_module(_HOMES[name]).DESIGN
    return found
