"""Is no more looked at than it takes to find which contact closes first?"""

from __future__ import annotations

import heapq
import math
from pathlib import Path

import numpy as np
import pytest
from moving_scenes import circle, ground

from watchsim.jit import callable_kernel
from watchsim.model.named_fields import dtype_of
from watchsim.model.records import records
from watchsim.scene.body import Body
from watchsim.scene.file.load import load
from watchsim.scene.force import Contact, Side, Torque
from watchsim.scene.scene import Scene
from watchsim.simulation.first_closing.waiting_contacts import drop_first, put
from watchsim.simulation.loop_state.scratch import Waiting
from watchsim.simulation.simulate import simulate

KEPT = Path(__file__).resolve().parents[2] / "data" / "hunt"


@pytest.mark.parametrize("seed", range(20))
def test_the_contact_that_could_close_first_is_in_front(seed: int) -> None:
    """Against the heap of Python's standard library, with ties."""
    add, drop = callable_kernel(put), callable_kernel(drop_first)
    rng = np.random.default_rng(seed)
    waiting, count, oracle = records(dtype_of(Waiting), 100), 0, []
    for k in range(300):
        if count and (count == len(waiting) or rng.random() < 0.45):
            first = waiting[0]
            assert first.stays_open == oracle[0][0]
            entry = (float(first.stays_open), int(first.contact), int(first.pair), float(first.start), float(first.until))
            oracle.remove(entry)
            heapq.heapify(oracle)
            count = drop(waiting, count)
        else:
            stays = float(rng.integers(0, 12))
            count = add(waiting, count, k, k % 7, (stays - 1.0, stays + 2.0, stays))
            heapq.heappush(oracle, (stays, k, k % 7, stays - 1.0, stays + 2.0))
        assert count == len(oracle)


def test_a_flight_is_not_searched_beyond_its_first_closing() -> None:
    """A roller bounces 2717 times on a bar that goes on sliding for a second: a flight takes about one look at each contact."""
    run = simulate(load(KEPT / "wave-801-16576.toml"), prefilter=False)
    assert run.counts["flights"] > 2000
    assert run.counts["gap_evaluations"] < 3 * len(run.pairs) * run.counts["flights"]


APPROACH, DRAWN, GAP, DURATION = 5e-8, 1e-7, 1e-10, 5.0  # m/s, m/s², m, s


def parted(restitution: float) -> Scene:
    """A disc nears the ground by 0.1 nm in 2 ms, so slowly that it counts as no speed, and is drawn away from it."""
    height = 0.05 + GAP
    disc = Body("disc", "slide", (0.0, height), axis=(0.0, 1.0), velocity=(-APPROACH,), mass=1.0, loops=(circle(0.05),))
    contacts = (Contact((Side("ground"), Side("disc")), 0.0, restitution),)
    return Scene("parted", (ground(0.1), disc), torques=(Torque("disc", DRAWN),), contacts=contacts, duration=DURATION)


@pytest.mark.parametrize("restitution", [0.0, 0.4, 1.0])
def test_what_nears_more_slowly_than_counts_as_zero_rebounds_once(restitution: float) -> None:
    run = simulate(parted(restitution), tolerance=1e-7)
    assert run.counts["instants"] < 10
    speed = math.sqrt(APPROACH**2 - 2.0 * DRAWN * GAP)
    after = DURATION - (APPROACH - speed) / DRAWN
    assert run.u[-1, 0] == pytest.approx(restitution * speed + DRAWN * after, rel=1e-6, abs=0.0)
    assert run.q[-1, 0] - run.q[0, 0] == pytest.approx((restitution * speed + 0.5 * DRAWN * after) * after - GAP, rel=1e-6)
