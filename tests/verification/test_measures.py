"""Does each benchmark read from a run the number that it names? Asked of a made-up run in which every number is another one."""

from __future__ import annotations

import math
import re
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from benchmark_names import NAMES, PLACES, benchmark_of

from watchsim.simulation.event_kinds import EventKind
from watchsim.verification.benchmarks import Benchmark, inclines, swings
from watchsim.verification.edge_cases import corner, graze, standing
from watchsim.verification.hard_cases import dry_balance, friction_angle, painleve_rods, pins_on_rollers, superball, wedges
from watchsim.verification.repeated_impacts import cradle, groove, pulled_block, rocking_block

WIDTH, ROWS, EACH = 6, 5, 14  # coordinates, rows, events of a kind
EVENT = [("kind", np.int8), ("t", float), ("value", float), ("contact", int)]
DISSIPATED = {"friction": 2.0, "damping": 30.0, "impacts": 400.0}


def made_up(speed: float = 7.0) -> Any:
    """Places are 100, 101, ..., speeds `speed` and so on; at other times those times are added."""
    rows = np.arange(ROWS)[:, None] * 1e4
    q, u = 100.0 + np.arange(WIDTH) + rows, speed + np.arange(WIDTH) + rows
    events = np.zeros(len(EventKind) * EACH, EVENT)
    events["kind"] = np.tile([int(kind) for kind in EventKind], EACH)
    events["t"] = np.repeat(np.arange(1.0, EACH + 1.0), len(EventKind)) - 0.5
    events["value"] = 1000.0 * events["t"] + events["kind"]
    events["contact"] = np.arange(len(events)) // len(EventKind) % 5
    sides = ((2, 0), (2, 0), (2, 1), (3, 0), (2, 0))
    return SimpleNamespace(
        t=np.arange(ROWS) * 1.0,
        q=q,
        u=u,
        events=events,
        at=lambda t: (100.0 + np.arange(WIDTH) + 10.0 * t, speed + np.arange(WIDTH) + 10.0 * t),
        energy={"dissipated": DISSIPATED, "residual_relative": 0.25, "residual_J": 0.125},
        worst_penetration=0.0625,
        pairs=[SimpleNamespace(primitive_b=kind, index_b=index) for kind, index in sides],
    )


def read(case: Benchmark, run: Any = None) -> dict[str, float]:
    return {check.quantity: check.measure(run or made_up()) for check in case.checks}


def time_in(quantity: str) -> float:
    found = re.search(r" at ([0-9.]+) s", quantity)
    assert found
    return float(found[1])


def of_kind(kind: EventKind, number: int, column: str = "value") -> float:
    """Of the number-th event, counted from 1; they come every second from half a second on."""
    return number - 0.5 if column == "t" else 1000.0 * (number - 0.5) + int(kind)


SOUNDNESS = {"energy ledger, residual over its largest entry": 0.25, "worst penetration [m]": 0.0625}


@pytest.mark.parametrize("name", [name for name in NAMES if PLACES[name][0] in (inclines, swings)])
def test_states_events_and_energies(name: str) -> None:
    case = benchmark_of(name)
    accumulation, stick, turn, hit = EventKind.ACCUMULATION, EventKind.STICK, EventKind.TURN, EventKind.IMPACT
    known = SOUNDNESS | {
        "accumulation of the bounces [s]": of_kind(accumulation, 1),
        "rolling begins [s]": of_kind(stick, EACH, "t"),
        "energy lost [J]": sum(DISSIPATED.values()),
        "twelfth turning point [s]": of_kind(turn, 12, "t"),
        "angle there [rad]": of_kind(turn, 12),
        **{f"touch {k} [s]": of_kind(hit, k, "t") for k in (1, 3, 6)},
    }
    swings_once = not case.name.startswith("incline")
    for quantity, got in read(case).items():
        if quantity in known:
            assert got == pytest.approx(known[quantity], rel=1e-12)
        else:
            word = quantity.split()[0]
            start = {"x": 100.0, "angle": 100.0 if swings_once else 102.0, "rate": 7.0, "spin": 9.0}[word]
            assert got == pytest.approx(start + 10.0 * time_in(quantity), rel=1e-12)


def test_too_few_events_give_no_number() -> None:
    run = made_up()
    run.events = run.events[:0]
    for case in (*inclines(), *swings(), dry_balance(), pulled_block(), rocking_block(), groove(), graze(-1.0)):
        for check in case.checks:
            if "[s]" in check.quantity or "there [rad]" in check.quantity or "approach" in check.quantity:
                assert math.isnan(check.measure(run))


def test_the_superball_is_looked_at_on_top_of_its_bounces() -> None:
    """It falls 0.1 m, touches, and is on top again twice that time later."""
    fall = math.sqrt(0.2 / 9.81)
    got = read(superball())
    for k in (1, 2, 3):
        assert got[f"spin after touch {k} [rad/s]"] == pytest.approx(9.0 + 20.0 * k * fall, rel=1e-12)
        assert got[f"speed after touch {k} [m/s]"] == pytest.approx(7.0 + 20.0 * k * fall, rel=1e-12)
        assert got[f"x at the top after touch {k} [m]"] == pytest.approx(100.0 + 20.0 * k * fall, rel=1e-12)
    begins = 0.5 * (0.4**2 + 0.5 * 0.02**2 * 30.0**2) + 9.81 * 0.1  # J of a disc of 1 kg
    assert got["share of the energy lost"] == pytest.approx(400.0 / begins, rel=1e-12)


def test_hard_cases() -> None:
    end, turn = 1e4 * (ROWS - 1), EventKind.TURN
    assert list(read(dry_balance()).values()) == [of_kind(turn, 3, "t"), of_kind(turn, 3), EACH, 100.0 + end, 7.0 + end, 30.0]
    for case in friction_angle():
        way, height, tilt, hits = read(case).values()
        t = 100.0 if "below" in case.name else 1000.0
        assert (way, height, tilt, hits) == pytest.approx((100.0 + 10.0 * t, 101.0 + 10.0 * t, 102.0 + 10.0 * t, EACH))
    run = made_up()
    run.events["t"][0] = 0.0
    for case in painleve_rods():
        kinds = int((run.events["kind"][:1] == EventKind.JAM).sum())
        assert list(read(case, run).values()) == pytest.approx([kinds, 9.0, 7.0 + 0.1 * math.sin(102.0) * 9.0])
    for case in pins_on_rollers():
        assert list(read(case).values()) == pytest.approx([EACH, 7.0 + 10.0 * 1e-3, 8.0 + 10.0 * 1e-3])


@pytest.mark.parametrize("jams", [0, 3])
def test_jams_at_the_start_alone_are_counted(jams: int) -> None:
    run = made_up()
    own = np.flatnonzero(run.events["kind"] == EventKind.JAM)
    run.events["t"][own[:jams]] = 0.0
    assert all(read(case, run)["jams at the start"] == jams for case in painleve_rods())


AFTER = [(0.9e-9, 0.0, 0.0), (1.1e-9, 1.0, 0.0), (0.499, 1.0, 0.0), (0.501, 0.0, 0.0), (0.999, 0.0, 0.0), (1.001, 0.0, 1.0)]
AFTER += [(-0.1, 0.0, 0.0), (-0.999, 0.0, 0.0), (-1.001, 0.0, 1.0)]


@pytest.mark.parametrize(("up", "out", "gains"), AFTER)
def test_a_wedge_comes_out_no_faster_than_the_law_allows(up: float, out: float, gains: float) -> None:
    """It came with 1 m/s, restitution 0.5: up to 0.5 m/s it has come out, beyond 1 m/s it has gained energy."""
    run = made_up()
    run.u[-1, 1] = up
    for case in wedges():
        got = read(case, run)
        assert (got["comes out"], got["energy gains"]) == (out, gains)
        assert got["speed sideways [m/s]"] == run.u[-1, 0] and got.get("speed left [m/s]", up) == up


def test_repeated_impacts() -> None:
    end, period = 1e4 * (ROWS - 1), math.tau * math.sqrt(2e-3 / 50.0)
    start = 0.4 * 0.05 / (50.0 * 0.03)  # friction over what the spring's force grows by in a second
    slides, way, speed, fastest, stretch, *sound = read(pulled_block()).values()
    assert (slides, way, speed) == (of_kind(EventKind.SLIDE, 1, "t"), 100.0 + end, 7.0 + end)
    assert fastest == pytest.approx(7.0 + 10.0 * (start + 39.5 * period), rel=1e-12)
    later = start + 0.25 * period
    assert stretch == pytest.approx(0.03 * later - (100.0 + 10.0 * later), rel=1e-12)
    assert sound == list(SOUNDNESS.values())
    assert [*read(cradle(0.0)).values()] == [*(7.0 + k + end for k in range(5)), EACH, 0.125]
    first, last, height, aside, beyond, *sound = read(groove()).values()
    assert (first, last) == (of_kind(EventKind.IMPACT, 1, "t"), of_kind(EventKind.ACCUMULATION, 1))
    assert (height, aside, beyond, sound) == (101.0 + end, 100.0 + end, 0.0, list(SOUNDNESS.values()))


def test_a_groove_knows_how_many_impulses_there_may_be() -> None:
    """Two at each of the impacts until less than a microsecond of 2 t1 e^k / (1 - e) is left, and of one more."""
    e, touch = 0.6, math.sqrt(2.0 * 2e-3 / 9.81)
    run = made_up()
    run.events = np.zeros(200, EVENT)
    run.events["kind"] = EventKind.IMPACT
    rebounds = 0.5 * (200.0 - read(groove(), run)["impulses beyond the most there may be"]) - 2.0
    assert 2.0 * touch * e**rebounds / (1.0 - e) == pytest.approx(1e-6, rel=1e-9, abs=0.0)


def test_rocking_block() -> None:
    run = made_up()
    run.u[-1] = [-3.0, 2.0, 1.0, 0.0, -1.0, -2.0]
    numbers = (1, 10, 100, 1000, 3000, 7000)
    run.events = np.zeros(7001, EVENT)
    run.events["kind"], run.events["value"] = EventKind.IMPACT, np.arange(1, 7002)
    *approaches, fastest, tilt, residual, depth = read(rocking_block(), run).values()
    assert approaches == [float(k) for k in numbers]
    assert (fastest, tilt, residual, depth) == (3.0, run.q[-1, 2], 0.25, 0.0625)


def test_edge_cases() -> None:
    end = 1e4 * (ROWS - 1)
    run = made_up()
    run.q[2, :2] = 3e-4, -4e-4  # nearest to the post, whose touching distance is 1.5 mm
    hits, height, nearest = read(graze(1.0), run).values()
    assert (hits, height) == (EACH, 101.0 + end) and nearest == pytest.approx(1.5e-3 + 1e-9 - 5e-4, rel=1e-5)
    hits, approach, when, nearest = read(graze(-1.0), run).values()
    assert (hits, approach, when) == (EACH, of_kind(EventKind.IMPACT, 1), 0.5) and nearest > 0.0
    assert read(graze(1.0))["nearest to the post, below touching [m]"] == 0.0
    assert read(corner(1.0)) == {"faces met": 3.0, "way until it stops [m]": 100.0 + end, "speed left [m/s]": 7.0 + end}
    hits, found, way = read(standing(3), run).values()
    assert (hits, found) == (EACH, EACH) and way == end
    run.q[-1] = run.q[0]
    run.q[-1, 3] -= 7.0
    assert read(standing(3), run)["largest way in a second [m]"] == 7.0
