"""Are contacts marked where bodies touch, while they touch?"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from render.fake_runs import MM, circle, disc_run

from watchsim.mechanism.compile import compile_scene
from watchsim.render.marks import ContactMarks
from watchsim.render.movie import frame
from watchsim.render.view import poses
from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.state import EVENT_DTYPE, EventKind


def with_contact(run, bodies, moments):
    """The run with one declared contact and events (t, kind) of its contact number 0."""
    contact = Contact((Side(bodies[0]), Side(bodies[1])), 0.3)
    events = np.array([(t, kind, 0, -1, 0.0, 0.0, 0.0, 0.0) for t, kind in moments], dtype=EVENT_DTYPE)
    return replace(run, scene=replace(run.scene, contacts=(contact,)), events=events)


def points(run, t):
    frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
    return ContactMarks(run).points(t, frames)


def test_a_rolling_disc_touches_below_its_centre_while_closed():
    run = with_contact(disc_run(), ("disc", "plane"), [(0.5, EventKind.CLOSE), (2.0, EventKind.OPEN)])
    assert len(points(run, 0.4)) == 0
    x = run.at(1.0)[0][0]
    assert points(run, 1.0) == pytest.approx(np.array([[x, 0.0]]), abs=1e-12)
    assert len(points(run, 2.0)) == 0


def test_two_circles_touch_between_their_centres():
    left = Body("left", "free", (0.0, 0.0), mass=1.0, inertia=1.0, loops=(circle(0, 0, 2, "A"),))
    right = Body("right", "fixed", (5 * MM, 0.0), loops=(circle(0, 0, 3, "A"),))
    run = disc_run()
    still = replace(
        run, scene=Scene("", (left, right)), q=0.0 * run.q, u=0.0 * run.u, a=0.0 * run.a, slices={"left": slice(0, 3)}
    )
    marked = with_contact(still, ("left", "right"), [(0.0, EventKind.CLOSE)])
    assert len(compile_scene(marked.scene).model.contacts) == 1
    assert points(marked, 1.0) == pytest.approx(np.array([[2 * MM, 0.0]]), abs=1e-12)


def test_marks_are_drawn_only_when_asked_for():
    run = with_contact(disc_run(), ("disc", "plane"), [(0.5, EventKind.CLOSE)])
    plain, marked = frame(run, 1.0, (480, 270)), frame(run, 1.0, (480, 270), contacts=True)
    assert not np.array_equal(plain, marked)
    assert np.array_equal(frame(run, 0.2, (480, 270)), frame(run, 0.2, (480, 270), contacts=True))


def test_events_of_another_scene_are_refused():
    run = disc_run()
    events = np.array([(0.5, EventKind.CLOSE, 7, -1, 0.0, 0.0, 0.0, 0.0)], dtype=EVENT_DTYPE)
    with pytest.raises(ValueError, match="do not belong to its scene"):
        ContactMarks(replace(run, events=events))
