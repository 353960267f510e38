"""Are all cycles found, with their stability, and what each swing leads to?"""

from __future__ import annotations

import math

import numpy as np
import pytest
from dead_beat_scenes import one_wheel, two_wheels, with_catch

import watchsim as ws
from watchsim.commands.steady import text
from watchsim.studies.all_cycles import Survey, judged, run_from
from watchsim.studies.return_map import Return
from watchsim.studies.section import Loop, first_section, parts_of
from watchsim.studies.steady import steady


def surveyed(function, known, good=lambda a: True):
    """Of a map in closed form; an oscillation takes 0.25 s."""

    def oscillate(amplitude):
        return Return(function(amplitude), 0.25, "" if good(amplitude) else "knocks", None, np.zeros(0))

    return Survey(oscillate, known)


def test_cubic_map_with_two_stable_cycles():
    """a' = a - 0.1 (a-1)(a-2)(a-3): 1 and 3 attract, 2 repels; slopes 1 - 0.2, 1 + 0.1, 1 - 0.2."""
    found = surveyed(lambda a: a - 0.1 * (a - 1.0) * (a - 2.0) * (a - 3.0), 2.7, lambda a: 0.3 < a < 5.0)
    assert [one.amplitudes[0] for one in found.cycles] == pytest.approx([1.0, 2.0, 3.0], abs=1e-10)
    assert [one.multiplier for one in found.cycles] == pytest.approx([0.8, 1.1, 0.8], abs=1e-8)
    assert [one.stable for one in found.cycles] == [True, False, True]
    low, high = (next(span for span in found.spans if span.cycle == number) for number in (0, 2))
    assert (low.low, low.high, high.low, high.high) == pytest.approx((0.3, 2.0, 2.0, 5.0), rel=1e-4)
    assert {span.verdict for span in found.spans if span.cycle is None} == {"knocks"}


@pytest.mark.parametrize("past", [1e-4, 0.01, 0.6])
def test_period_doubling(past):
    """x' = -(1 + p) x + p x³ about 3: multiplier -(1 + p), and the pair x = ±1 with the multiplier (2p - 1)²."""
    found = surveyed(lambda a: 3.0 - (1.0 + past) * (a - 3.0) + past * (a - 3.0) ** 3, 3.0, lambda a: 1.8 < a < 4.2)
    single = next(one for one in found.cycles if len(one.amplitudes) == 1)
    pair = next(one for one in found.cycles if len(one.amplitudes) == 2)
    assert single.amplitudes[0] == pytest.approx(3.0, abs=1e-10)
    assert (single.multiplier, single.stable) == (pytest.approx(-1.0 - past, abs=1e-8), False)
    assert sorted(pair.amplitudes) == pytest.approx([2.0, 4.0], abs=1e-7)
    assert (pair.multiplier, pair.stable) == (pytest.approx((2.0 * past - 1.0) ** 2, abs=1e-6), True)


@pytest.mark.parametrize("r, stable", [(2.8, False), (3.2, True), (3.5, False)])
def test_logistic_map(r, stable):
    """a' = r a (1 - a): fixed point 1 - 1/r with slope 2 - r; the pair from r > 3 on, with the multiplier 4 + 2r - r²."""
    found = surveyed(lambda a: r * a * (1.0 - a), 0.6, lambda a: 0.0 < a < 1.0)
    pairs = [one for one in found.cycles if len(one.amplitudes) == 2]
    single = max(one.amplitudes[0] for one in found.cycles if len(one.amplitudes) == 1)
    assert single == pytest.approx(1.0 - 1.0 / r, abs=1e-10)
    assert len(pairs) == (1 if r > 3.0 else 0)
    for pair in pairs:
        half = math.sqrt((r - 3.0) * (r + 1.0))
        assert sorted(pair.amplitudes) == pytest.approx([(r + 1.0 - half) / (2 * r), (r + 1.0 + half) / (2 * r)], abs=1e-9)
        assert pair.multiplier == pytest.approx(4.0 + 2.0 * r - r * r, abs=1e-6)
        assert pair.stable is stable


def test_swiss_lever_has_one_cycle_and_a_swing_that_is_too_small():
    """An ordinary run from just below the border stops, from just above it ticks."""
    scene = ws.load(ws.profiles_dir() / "bench_lever")
    cycle = steady(scene, all_cycles=True)
    assert len(cycle.cycles) == 1
    assert cycle.cycles[0].amplitudes_deg[0] == pytest.approx(cycle.amplitude_deg, abs=1e-6)
    assert cycle.cycles[0].multiplier == pytest.approx(cycle.multipliers[0], abs=1e-5)
    assert [one.verdict for one in cycle.starts] == ["stops", "ticks", "overbanks"]
    assert cycle.starts[1].cycle == 0
    loop = Loop(scene, scene.tolerance)
    parts = parts_of(scene, loop.compiled)
    section = first_section(loop, parts, loop.begin())
    assert section.side == cycle.starts[1].side
    for factor, verdict in ((0.99, "stops"), (1.01, "ticks")):
        state = section.at(loop, parts, math.radians(factor * cycle.starts[1].from_deg))
        assert judged(run_from(loop, state, 30.0)).name == verdict
    shown = text(scene.title, cycle)
    assert "cycle 1" in shown
    assert "overbanks" in shown


@pytest.mark.slow
def test_two_wheels_on_one_pendulum_have_two_stable_cycles(tmp_path):
    """E = w Q / (2π) of the wheels that are let off: 2 mN·m alone, or 2 + 4 mN·m."""
    scene = two_wheels(tmp_path, 2.3)
    cycle = steady(scene, all_cycles=True)
    low, high = cycle.cycles
    assert (low.stable, high.stable) == (True, True)
    assert high.amplitudes_deg[0] ** 2 / low.amplitudes_deg[0] ** 2 == pytest.approx(3.0, rel=2e-3)
    assert low.amplitudes_deg[0] == pytest.approx(cycle.amplitude_deg, abs=1e-5)
    assert [one.cycle for one in cycle.starts] == [0, 1]
    border = cycle.starts[0].to_deg
    for start, orbit in ((0.9 * border, low), (1.15 * border, high)):
        other = steady(two_wheels(tmp_path, start))
        assert other.amplitude_deg == pytest.approx(orbit.amplitudes_deg[0], abs=1e-5)


@pytest.mark.slow
def test_a_swing_that_repeats_itself_after_two_oscillations(tmp_path):
    """A catch takes the same work d from each half swing that throws it over; without it x = A² becomes κ x + w."""
    scene = with_catch(tmp_path, 33.0)
    cycle = steady(scene)
    assert cycle.found
    assert cycle.oscillations == 2
    assert "after 2 oscillations" in cycle.message
    found = ws.beats(ws.simulate(scene, 40.0, record="statistics"))
    swings = found.amplitude_deg[-4:]
    pairs = [sorted((swings[i % 4] + swings[(i + 1) % 4]) / 2 for i in (j, j + 2)) for j in (0, 1)]
    assert sorted(cycle.amplitudes_deg) in [pytest.approx(pair, abs=1e-4) for pair in pairs]
    kept = math.exp(-math.pi / math.sqrt(20.0**2 - 0.25))  # of the energy, in a half swing
    free = steady(one_wheel(tmp_path, quality=20, torque=33.0, start=4.5)).amplitude_deg
    squares = np.degrees(found.end_at[-5:]) ** 2
    taken = np.sort(kept * squares[:-1] + (1.0 - kept) * free**2 - squares[1:])
    assert taken[0] < 0.0  # once it is only held against its torque, and gives the work back
    assert taken[1:] == pytest.approx(taken[1], rel=1e-3)
    stiffness = scene.springs[0].stiffness
    through = np.degrees(1.0) * taken[1] * math.radians(1.0) ** 2 * stiffness / 2.0 / 10e-3  # ° of the catch, at 10 mN·m
    assert 5.0 < through < 6.03  # it is thrown from one stop, at 6.03°, to the middle
    assert cycle.multipliers[0] == pytest.approx(kept**4, rel=0.01)
