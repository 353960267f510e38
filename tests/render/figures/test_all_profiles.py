"""Does every plot of every profile fit its page and its column, with nothing cut off?"""

from __future__ import annotations

from pathlib import Path

import pytest
from render.figures.read_back import faults, width_mm

import watchsim as ws
from watchsim.commands.pictures import KINDS, Request

PROFILES = sorted(path.name for path in Path(str(ws.profiles_dir())).iterdir() if (path / "scene.toml").is_file())
WITHOUT_BEATS = {
    "geneva",
    "geneva_stop",
    "cycloidal_pair",
    "incline",
    "involute_pair",
    "balance",
    "cam",
    "jumper",
    "ratchet",
    "snail",
    "winding_click",
    "verge",
    "governor",
}
TWO_PALLETS = {"grasshopper"}  # each a body of its own: which phase a beat is in, no table knows
# s: slow pendulums, and wheels that stand still in every other half swing; a second of all others
DURATION = {"graham": 4.0, "recoil_anchor": 4.0, "pin_wheel": 8.0, "detent": 2.0, "grasshopper": 4.0, "duplex": 2.0}


@pytest.mark.slow
@pytest.mark.parametrize("profile", PROFILES)
def test_nothing_is_clipped(profile: str, caplog: pytest.LogCaptureFixture) -> None:
    scene = ws.load(ws.profiles_dir() / profile)
    run = ws.simulate(scene, duration=DURATION.get(profile, min(1.0, scene.duration)), record="all")
    drawn = set()
    for width in (170.0, 85.0):
        asked = Request(run, None, ("angle", "velocity", "acceleration"), None, width)
        for kind, draw in KINDS.items():
            try:
                figure = draw(asked)
            except ValueError:
                continue
            assert width_mm(figure) == pytest.approx(width)
            assert faults(figure) == [], kind
            drawn.add(kind)
    assert caplog.messages == []  # what matplotlib would say to the user
    assert {"kinematics", "phase-portrait", "forces"} <= drawn
    of_beats = {"energy", "timing", "tape"} | ({"phases", "timeline", "torque"} if profile not in TWO_PALLETS else set())
    assert profile in WITHOUT_BEATS or drawn >= of_beats, set(KINDS) - drawn
