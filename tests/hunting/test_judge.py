"""Does the judge tell a wrong motion from one that cannot be known better?"""

from __future__ import annotations

import time
from dataclasses import replace

import hunt_path  # noqa: F401
import numpy as np
import pytest
from hunt import pool, witness
from hunt.generator.generate import mechanism
from hunt.generator.parts import fixed, sliding
from hunt.generator.shapes import box, circle
from hunt.judge import Judge, judged, merged
from hunt.pool import answers
from hunt.views import views

from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate


def two_discs(restitution: float = 0.5) -> Scene:
    bodies = (
        sliding("a", circle(5e-3), (0.0, 0.0), 0.0, 0.5, 0.02),
        sliding("b", circle(5e-3), (20e-3, 1e-3), 0.0, 0.0, 0.03),
    )
    return Scene("discs", bodies, contacts=(Contact((Side("a"), Side("b")), 0.0, restitution),), duration=0.04)


def cradle() -> Scene:
    """Three blocks in line, the last two a nanometre apart: another gap, another outcome."""
    bodies = [sliding("a", box(0.01, 0.01), (-0.02, 0.0), 0.0, 1.0, 0.02)]
    bodies += [sliding(name, box(0.01, 0.01), (x, 0.0), 0.0, 0.0, 0.02) for name, x in (("b", 0.0), ("c", 0.010000001))]
    pairs = (("a", "b"), ("b", "c"))
    return Scene(
        "cradle", tuple(bodies), contacts=tuple(Contact((Side(a), Side(b)), 0.0, 0.6) for a, b in pairs), duration=0.03
    )


def test_fine():
    verdict = judged(two_discs(), 1, with_witness=True)
    assert (verdict.kind, verdict.reasons) == ("fine", [])


class Spoilt(Judge):
    """A solver whose speeds in one orientation, or at one tolerance, come out otherwise by a share."""

    def __init__(self, scene: Scene, share: float, tolerance: float | None) -> None:
        super().__init__(scene, 1)
        self.times = self.times[4::5]
        self.share, self.only = share, tolerance

    def motion(self, run, view=None, times=None):
        spoils = (run.tolerance == self.only) if self.only else (view is not None and view.mirrored)
        return super().motion(run, view, times) * (1.0 + self.share * spoils)


@pytest.mark.parametrize("tolerance", [None, 1e-11])
@pytest.mark.parametrize(("share", "wrong"), [(0.0, False), (1e-9, False), (1e-5, True)])
def test_one_run_that_differs(share, wrong, tolerance):
    verdict = Spoilt(two_discs(), share, tolerance).judge(with_witness=False)
    assert [reason.split(":")[0] for reason in verdict.reasons] == ["disagrees"] * wrong


def test_witness_contradicts_a_motion_that_is_alike_everywhere():
    """The event-driven runs of a scene with another restitution than that which the witness sees."""

    class Other(Judge):
        def run(self, scene, tolerance, prefilter=False):
            return super().run(replace(scene, contacts=two_discs(0.9).contacts), tolerance, prefilter)

    verdict = Other(two_discs(0.1), 1).judge(with_witness=True)
    assert [reason.split(":")[0] for reason in verdict.reasons] == ["witness"]


def test_impacts_in_turn_that_a_coarse_run_takes_for_one():
    run = simulate(cradle())
    assert merged(run, 1e-8, 0.03)
    assert not merged(run, 1e-10, 0.03)
    assert not merged(run, 1e-8, 0.001)
    assert not judged(cradle(), 1).reasons


@pytest.mark.slow
def test_sensitive_motion_is_not_wrong():
    """A ball between round posts forgets its start: one part in 10⁷ decides after a dozen impacts."""
    ball = mechanism(7, 2, "boxed").bodies[-1]
    bodies = [replace(ball, motion="free", position=(0.0, 0.0013), velocity=(0.9, 0.31, 0.0), loops=(circle(2e-3),))]
    places = [(x * 7e-3 + 3.5e-3 * (y % 2), y * 6e-3) for x in range(-2, 3) for y in range(-2, 3) if (x, y) != (0, 0)]
    bodies += [fixed(f"post{k}", circle(2e-3), position=place) for k, place in enumerate(places)]
    contacts = tuple(Contact((Side(ball.name), Side(b.name)), 0.0, 1.0) for b in bodies[1:])
    verdict = judged(Scene("posts", tuple(bodies), contacts=contacts, duration=0.1), 1)
    assert verdict.reasons == []
    assert verdict.runs > 5
    assert verdict.judged < 0.9


def test_worker_that_dies_does_not_end_the_hunt():
    def work(number: int) -> int:
        if number == 2:
            raise SystemExit(1)
        return 10 * number

    assert dict(answers(range(5), work, 2)) == {0: 0, 1: 10, 2: None, 3: 30, 4: 40}


@pytest.mark.slow
def test_worker_that_hangs_is_killed(monkeypatch):
    monkeypatch.setattr(pool, "PATIENCE", 0.1)
    found = dict(answers(range(3), lambda number: time.sleep(1000.0) if number == 1 else number, 1))
    assert found == {0: 0, 1: None, 2: 2}


def test_views_are_not_the_scene():
    scene = two_discs()
    turned = Judge(scene, 1)
    runs = [turned.run(view.of(scene), 1e-9) for view in views(scene, 1, 2)]
    assert all(not np.allclose(run.scene.bodies[0].axis, (1.0, 0.0)) for run in runs)


def test_steps_part_what_bodies_in_touch_pass_on_at_once():
    """The second and third block touch from the start: the impact on one goes through both."""
    apart = cradle()
    third = replace(apart.bodies[2], position=(0.01, 0.0))
    assert witness.merged(simulate(replace(apart, bodies=(*apart.bodies[:2], third))), 0.03, 0.0)
    assert not witness.merged(simulate(two_discs()), 0.04, 1e-3)
