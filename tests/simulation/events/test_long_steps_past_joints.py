"""Is a mode's end found in a long step, and is the next face met without a jump? On scenes that the hunt found."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from watchsim.scene.file.load import load
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.simulate import simulate

FOUND = Path(__file__).parents[2] / "data" / "hunt"


@pytest.mark.parametrize("tolerance", [1e-5, 1e-7, 1e-9, 1e-11])
def test_a_block_tips_when_its_support_has_slid_from_below_its_centre(tolerance):
    """Block `a` slides below `b` without friction; a corner of `b` is let go when one of `a` has come below its centre."""
    scene = load(FOUND / "blocks-801-4472.toml")
    run = simulate(scene, tolerance=tolerance)
    a, b = (next(body for body in scene.bodies if body.name == name) for name in "ab")
    half_width = max(edge.start[0] for edge in a.loops[0].edges)
    tips = (a.position[0] + half_width - b.position[0]) / -a.velocity[0]
    let_go = run.events[run.events["kind"] == EventKind.OPEN]["t"][0]
    assert let_go == pytest.approx(tips, rel=1e-6)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-7, 1e-9])
def test_the_next_face_is_met_where_bodies_are(tolerance):
    """A roller on a wave of arcs: energy does not rise, and no event moves a body by more than the tolerance."""
    scene = load(FOUND / "wave-801-9913.toml")
    run = simulate(scene, tolerance=tolerance)
    masses = {body.name: (body.mass, body.inertia) for body in scene.bodies}
    (bar, _), (roller, inertia) = masses["bar"], masses["roller"]
    kinetic = 0.5 * run.u**2 @ np.array([bar, roller, roller, inertia])
    total = kinetic - roller * scene.gravity[1] * run.q[:, run.slices["roller"]][:, 1]
    rise = (total - np.minimum.accumulate(total)).max()
    assert rise < max(10.0 * tolerance, 1e-9) * kinetic.max()
    at_once = np.diff(run.t) == 0.0
    assert np.abs(np.diff(run.q, axis=0))[at_once][:, :3].max() < max(tolerance, 1e-9) * 0.1
