"""Are bodies where the exact motion says they are?"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from render.fake_runs import MM, disc_run, slide_run, watch_run

from watchsim.render.view import choose, dense, moving, placed, poses, recorded, sampled, stretch, swept

TIMES = np.array([0.0, 0.1234, 0.777, 1.9, 2.0])


def test_sample_agrees_with_at_and_with_the_exact_motion():
    run = watch_run()
    q, u = run.sample(TIMES)
    for k, t in enumerate(TIMES):
        assert np.array_equal(q[k], run.at(t)[0])
        assert np.array_equal(u[k], run.at(t)[1])
    assert q[:, 2] == pytest.approx(5.0 * np.cos(25.0 * TIMES), abs=1e-8)
    assert u[:, 2] == pytest.approx(-125.0 * np.sin(25.0 * TIMES), abs=1e-5)


def test_after_an_impact_the_new_velocity_counts():
    run = watch_run()
    before, at = run.sample(np.array([1.0 - 1e-9, 1.0]))[1][:, 1]
    assert at - before == pytest.approx(4.0, abs=1e-6)


def test_times_outside_are_clamped_and_a_double_last_row_counts_once():
    run = watch_run()
    last = replace(
        run,
        t=np.append(run.t, run.t[-1]),
        q=np.vstack((run.q, run.q[-1])),
        u=np.vstack((run.u, run.u[-1] + 1.0)),
        a=np.vstack((run.a, run.a[-1])),
    )
    assert np.array_equal(last.at(5.0)[1], run.u[-1] + 1.0)
    assert np.array_equal(last.at(-5.0)[0], run.q[0])


def test_poses_of_all_motions():
    watch = poses(watch_run(), TIMES)
    assert np.allclose(watch["wheel"][:, 2], -2.0 * TIMES)
    assert np.all(watch["lever"][:, :2] == (0.0, 3 * MM))
    assert np.all(watch["banking"] == 0.0)
    disc = poses(disc_run(), np.array([1.0]))["disc"][0]
    assert disc[2] == pytest.approx(-disc[0] / 0.05)
    x, y, angle = poses(slide_run(), np.array([0.3]))["slider"][0]
    assert (x, y) == pytest.approx((1 * MM + 2 * MM * math.sin(3.0) * math.sqrt(0.5),) * 2, abs=1e-9)
    assert angle == 0.0


def test_placed_turns_and_shifts():
    points = placed(np.array([[1.0, 0.0], [0.0, 2.0]]), np.array([[3.0, 4.0, math.pi / 2]]))[0]
    assert points == pytest.approx(np.array([[3.0, 5.0], [1.0, 4.0]]))


def test_swept_angles_end_where_the_motion_ends():
    run = watch_run()
    lever = swept(run, run.scene.body("lever"), (0.0, 0.9))
    assert (lever[:, 2].min(), lever[:, 2].max()) == pytest.approx((-0.1, 0.1), abs=1e-4)
    balance = swept(run, run.scene.body("balance"), (0.0, 0.9))
    assert np.ptp(balance[:, 2]) == pytest.approx(2.0 * math.pi)


def test_dense_keeps_rows_and_jumps():
    run = watch_run()
    t, q, u, _ = dense(run, (0.95, 1.05))
    assert (t[0], t[-1]) == (0.95, 1.05)
    assert np.all(np.diff(t) >= 0.0)
    assert np.diff(t).max() <= 0.1 / 2000 * 1.001
    twice = np.flatnonzero(np.diff(t) == 0.0)
    assert len(twice) == 1
    assert u[twice[0] + 1, 1] - u[twice[0], 1] == pytest.approx(4.0)
    assert q[:, 2] == pytest.approx(5.0 * np.cos(25.0 * t), abs=1e-8)


def test_window_is_checked():
    run = watch_run()
    assert stretch(run, None) == (0.0, 2.0)
    assert stretch(run, (0.5, 1)) == (0.5, 1.0)
    for wrong, said in (
        ((1.5, 2.5), "0 s to 2 s was recorded"),
        ((1, 1), "empty"),
        ((2, 1), "empty"),
        (3, "two times"),
        (("a", 1), "two"),
    ):
        with pytest.raises(ValueError, match=said):
            stretch(run, wrong)


def test_gaps_in_the_record_are_neither_drawn_nor_allowed():
    full = watch_run()
    keep = (full.t <= 0.51) | (full.t >= 1.49)  # with the rows next to what was asked for
    cut = {name: getattr(full, name)[keep] for name in ("t", "q", "u", "a")}
    run = replace(full, spans=((0.0, 0.5), (1.5, 2.0)), **cut)
    assert recorded(run) == ((0.0, 0.5), (1.5, 2.0))
    assert stretch(run, (1.5, 2.0)) == (1.5, 2.0)
    with pytest.raises(ValueError, match=r"0 s to 0\.5 s and 1\.5 s to 2 s"):
        stretch(run, (0.4, 1.6))
    with pytest.raises(ValueError, match="choose a window"):
        stretch(run, None, unbroken=True)
    t, q, *_ = dense(run, stretch(run, None))
    assert np.all(np.isnan(q[(t > 0.5) & (t < 1.5)]))
    assert not np.any(np.isnan(q[(t <= 0.5) | (t >= 1.5)]))


def test_bodies_are_chosen_by_name():
    run = watch_run()
    assert [body.name for body in moving(run)] == ["wheel", "lever", "balance"]
    assert [body.name for body in choose(run, ["balance", "wheel"])] == ["balance", "wheel"]
    assert [body.name for body in choose(run, "lever")] == ["lever"]
    for wrong in (["lver"], ["banking"], []):
        with pytest.raises(ValueError, match="wheel, lever, balance"):
            choose(run, wrong)


def test_a_record_of_one_row_is_known_at_that_instant_and_one_of_none_nowhere():
    full = watch_run()
    one, none = ({name: getattr(full, name)[:count] for name in ("t", "q", "u", "a")} for count in (1, 0))
    assert recorded(replace(full, spans=(), **one)) == ((0.0, 0.0),)
    with pytest.raises(ValueError, match="no row"):
        recorded(replace(full, spans=(), **none))


def test_rows_of_the_window_are_among_its_samples() -> None:
    """Both ends, too; of very many rows so few that the evenly spread instants outnumber them."""
    run = watch_run(rows=3001)
    times = -0.5 * sampled(run, run.scene.body("wheel"), (0.5, 0.75))[:, 2]
    rows = run.t[(run.t >= 0.5) & (run.t <= 0.75)]
    assert np.abs(times[:, None] - rows).min(axis=0).max() < 1e-12 and len(times) > len(rows)
    assert times[0] == pytest.approx(0.5, rel=1e-12) and times[-1] == pytest.approx(0.75, rel=1e-12)
    whole = sampled(run, run.scene.body("wheel"), (0.0, 2.0))
    assert 700 < len(whole) <= 400 + math.ceil(3002 / (3002 // 400)) + 1
