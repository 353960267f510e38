"""Which designs are there? Each is loaded when it is asked for."""

from __future__ import annotations

import importlib

from watchsim.construction.design import Design

_HOMES = {
    "swiss_lever": "watchsim.construction.swiss_lever",
    "remontoir": "watchsim.construction.remontoir",
    "tourbillon": "watchsim.construction.tourbillon",
    "coaxial": "watchsim.construction.coaxial",
    "detent": "watchsim.construction.detent",
    "pin_pallet": "watchsim.construction.pin_pallet",
    "pin_wheel": "watchsim.construction.pin_wheel",
    "cylinder": "watchsim.construction.cylinder",
    "duplex": "watchsim.construction.duplex",
    "geneva": "watchsim.construction.geneva",
    "geneva_stop": "watchsim.construction.geneva_stop",
    "graham": "watchsim.construction.graham",
    "recoil_anchor": "watchsim.construction.recoil_anchor",
    "grasshopper": "watchsim.construction.grasshopper",
    "verge": "watchsim.construction.verge",
    "involute_pair": "watchsim.construction.involute_pair",
    "cycloidal_pair": "watchsim.construction.cycloidal_pair",
    "jumper": "watchsim.construction.jumper",
    "cam": "watchsim.construction.cam",
    "snail": "watchsim.construction.snail",
    "governor": "watchsim.construction.governor",
    "ratchet": "watchsim.construction.ratchet",
    "winding_click": "watchsim.construction.winding_click",
}

NAMES = tuple(_HOMES)


def design(name: str) -> Design:
    """The design of that name; KeyError if there is none."""
    found: Design = importlib.import_module(_HOMES[name]).DESIGN
    return found
