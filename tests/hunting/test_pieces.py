"""Is what a description makes otherwise told from what unstable motion makes of rounding?"""

from __future__ import annotations

import math
from dataclasses import replace

import hunt_path  # noqa: F401
import numpy as np
import pytest
from every_time import few
from hunt.generator.parts import free, pivoted, sliding
from hunt.generator.shapes import box, circle
from hunt.judge import Judge
from hunt.pieces import made, resumed
from hunt.views import views

from watchsim.scene.force import Contact, Side, Spring
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate


def pendulum(angle: float, duration: float) -> Scene:
    """A bar of 40 mm, its end at the pivot: λ² = 1.5 g/l."""
    bar = pivoted("bar", box(0.04, 1e-3).moved(0.0, (0.02, 0.0)), (0.0, 0.0), angle, mass=0.01)
    other = sliding("other", circle(1e-3), (0.1, 0.0), 0.0, 0.0, 0.01)
    return Scene("pendulum", (bar, other), gravity=(0.0, -9.81), duration=duration)


def discs(restitution: float = 0.5) -> Scene:
    """One slides along a spring and strikes a free one."""
    bodies = (
        sliding("a", circle(5e-3), (0.0, 0.0), 0.0, 0.5, 0.02),
        free("b", circle(5e-3), (20e-3, 1e-3), 0.03),
    )
    contacts = (Contact((Side("a"), Side("b")), 0.2, restitution),)
    return Scene("discs", bodies, (Spring("a", 5.0, 0.01),), contacts=contacts, duration=0.06)


@pytest.mark.parametrize("at", [0.005, 0.03])
def test_a_run_resumed_goes_on_as_it_did(at):
    """Before and after the impact; the slide has gone some way along its spring."""
    run = simulate(discs())
    row = int(np.searchsorted(run.t, at))
    scene, begun = resumed(run, row, 0.06)
    rest = simulate(scene)
    assert begun[0] == run.q[row, 0] != 0.0
    assert rest.q[-1] + begun == pytest.approx(run.q[-1], rel=1e-9, abs=1e-12)
    assert rest.u[-1] == pytest.approx(run.u[-1], rel=1e-8, abs=1e-10)


def test_growth_is_not_made():
    """Upright to rounding, which cosh λt multiplies by 10¹⁰."""
    scene = pendulum(math.pi / 2.0, 1.25)
    assert math.cosh(math.sqrt(1.5 * 9.81 / 0.04) * scene.duration) > 1e10
    judge, view = Judge(scene), views(scene, 3, 2)[1]
    judge.times = judge.times[3::4]
    base, other = judge.run(scene, 1e-9), judge.run(view.of(scene), 1e-9)
    apart = np.abs(judge.motion(base) - judge.motion(other, view)).max()
    assert apart > 3e-7
    assert made(judge, base, 1e-9, view)[-1] + made(judge, other, 1e-9)[-1] < 0.01 * apart


class Faulty(Judge):
    """A solver that takes another restitution in the mirrored scene: always, or only where it is run as a whole."""

    def __init__(self, always: bool) -> None:
        super().__init__(discs(), 1)
        self.times = self.times[4::5]
        self.view, self.always = views(self.scene, 1, 2)[1], always

    def run(self, scene, tolerance, prefilter=False):
        mirrored = scene.bodies[0].axis == self.view.of(self.scene).bodies[0].axis
        wrong = mirrored and (self.always or scene.duration == self.scene.duration)
        solved = replace(scene, contacts=discs(0.5001).contacts) if wrong else scene
        return replace(super().run(solved, tolerance, prefilter), scene=scene)


@pytest.mark.parametrize("always", few([True, False], 1))
def test_what_is_made_counts_in_full(always):
    judge = Faulty(always)
    base, other = judge.run(judge.scene, 1e-9), judge.run(judge.view.of(judge.scene), 1e-9)
    apart = np.abs(judge.motion(base) - judge.motion(other, judge.view)).max(axis=1)
    assert apart[-1] > 3e-7
    assert (made(judge, base, 1e-9, judge.view) + made(judge, other, 1e-9) >= 0.9 * apart).all()
    assert [reason.split(":")[0] for reason in judge.judge(with_witness=False).reasons] == ["disagrees"]
