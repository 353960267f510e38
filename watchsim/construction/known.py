"""Which designs are there? Each is loaded when it is asked for."""

from __future__ import annotations

import importlib

from watchsim.construction.design import Design

_HOMES = {
    "swiss_lever": "watchsim.construction.swiss_lever.swiss_lever_design",
    "remontoir": "watchsim.construction.remontoir.remontoir_design",
    "tourbillon": "watchsim.construction.tourbillon.tourbillon_design",
    "coaxial": "watchsim.construction.coaxial.coaxial_design",
    "detent": "watchsim.construction.detent.detent_design",
    "pin_pallet": "watchsim.construction.pin_pallet.pin_pallet_design",
    "pin_wheel": "watchsim.construction.pin_wheel.pin_wheel_design",
    "cylinder": "watchsim.construction.cylinder.cylinder_design",
    "duplex": "watchsim.construction.duplex.duplex_design",
    "geneva": "watchsim.construction.geneva.geneva_design",
    "geneva_stop": "watchsim.construction.geneva_stop.geneva_stop_design",
    "graham": "watchsim.construction.graham.graham_design",
    "recoil_anchor": "watchsim.construction.recoil_anchor.recoil_anchor_design",
    "grasshopper": "watchsim.construction.grasshopper.grasshopper_design",
    "verge": "watchsim.construction.verge.verge_design",
    "involute_pair": "watchsim.construction.involute_pair.involute_pair_design",
    "cycloidal_pair": "watchsim.construction.cycloidal_pair.cycloidal_pair_design",
    "jumper": "watchsim.construction.jumper.jumper_design",
    "cam": "watchsim.construction.cam.cam_design",
    "snail": "watchsim.construction.snail.snail_design",
    "governor": "watchsim.construction.governor.governor_design",
    "ratchet": "watchsim.construction.ratchet.ratchet_design",
    "winding_click": "watchsim.construction.winding_click.winding_click_design",
}

NAMES = tuple(_HOMES)


def design(name: str) -> Design:
    """The design of that name; KeyError if there is none."""
    found: Design = importlib.import_module(_HOMES[name]).DESIGN
    return found
