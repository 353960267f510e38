"""Which stone was unlocked, what did impacts take, and does a record that begins with a phase tell the same of it?"""

from __future__ import annotations

import math
from dataclasses import astuple, replace
from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import lever_run

from watchsim.analysis.timeline import stones_unlocked as module
from watchsim.analysis.timeline.impact_losses import impact_losses, pair_name
from watchsim.analysis.timeline.rows import Stage, _rows, can_be_told, timeline
from watchsim.analysis.timeline.stones_unlocked import StonesUnlocked
from watchsim.scene.recording import STATISTICS
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.methods import MOREAU

PARTS: Any = SimpleNamespace(oscillator="balance", wheel="wheel", lever="lever")
STONES = [(3.0, 2.0), (-2.5, 1.0), (-0.5, -3.0), (1.5, -0.5)]  # of the lever, in its frame
OWNERS = ["wheel", "lever", "lever", "lever", "lever", "balance"]
SIDES = [("wheel", 0, 1), ("lever", 2, 0), ("lever", 3, 0), ("wheel", 0, 4), ("wheel", 0, 5)]  # contacts: body a, primitives
WHEEL, LEVER = (1.0, -2.0), (4.0, 3.0)


def pose(name: str, t: float) -> tuple[float, float, float]:
    return (*WHEEL, 0.7 * t) if name == "wheel" else (*LEVER, 0.4 + 0.1 * t)


def made(seed: int) -> tuple[Any, Any]:
    """A run with random events, of contacts that are no longer known, too, and the model of its contacts."""
    rng = np.random.default_rng(seed)
    events = np.zeros(int(rng.integers(0, 25)), EVENT_DTYPE)
    events["t"], events["kind"] = np.sort(rng.integers(0, 30, len(events))) / 2.0, rng.integers(1, 7, len(events))
    events["contact"] = rng.integers(0, len(SIDES) + 1, len(events))
    others = ["lever" if a == "wheel" else "wheel" for a, _, _ in SIDES]
    others[-1] = "balance"
    pairs = [SimpleNamespace(body_a=a, body_b=b) for (a, _, _), b in zip(SIDES, others, strict=True)]
    pairs.append(SimpleNamespace(body_a="lever", body_b="wheel"))
    places = [(9.0, 9.0), *STONES, (8.0, 8.0)]
    model = SimpleNamespace(
        contacts=[SimpleNamespace(a=a, b=b) for _, a, b in SIDES], primitives=[SimpleNamespace(px=x, py=y) for x, y in places]
    )
    run = SimpleNamespace(events=events, pairs=pairs, pose=pose, scene=None, t=np.array([3.0]))
    return run, SimpleNamespace(model=model, owners=OWNERS)


def side(stone: int, t: float, way: float) -> str:
    """By angles: the stone lies before the line from wheel to lever where the wheel, on its way, comes past it first."""
    turn = 0.4 + 0.1 * t
    x, y = STONES[stone]
    z = complex(*LEVER) + complex(x, y) * complex(math.cos(turn), math.sin(turn)) - complex(*WHEEL)
    return "entry" if way * np.angle(z / (complex(*LEVER) - complex(*WHEEL))) < 0.0 else "exit"


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("seed", range(25))
def test_the_stone_of_the_last_contact_before_a_beat(seed: int, way: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """On which side it lies is looked at when it is unlocked for the first time."""
    monkeypatch.setattr(module, "drive_direction", lambda scene, wheel: way)
    run, compiled = made(seed)
    starts = np.sort(np.random.default_rng(seed).integers(0, 32, 8)) / 2.0
    wanted: list[str] = []
    known: dict[int, str] = {}
    for t in starts.tolist():
        before = [int(k) for k, at in zip(run.events["contact"], run.events["t"], strict=True) if at <= t and k < 4]
        if not before:
            wanted.append("")
            continue
        wanted.append(known.setdefault(before[-1], side(before[-1], t, way)))
    assert StonesUnlocked(run, compiled, PARTS).at(starts) == wanted


ANCHORS = [(0, 0, 1, 1), (0, 1, 1, 1), (1, 1, 1, 1), (1, 0, 1, 0), (0, 0, 0, 0)]


@pytest.mark.parametrize(("sprung", "heavy", "both", "told"), ANCHORS)
def test_an_anchor_is_told_by_stones_on_either_side(
    sprung: int, heavy: int, both: int, told: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """But for a balance on a spring without gravity, which the wheel touches itself."""
    monkeypatch.setattr(module, "drive_direction", lambda scene, wheel: 1.0)
    run, compiled = made(3)
    anchor: Any = SimpleNamespace(oscillator="lever", wheel="wheel", lever="lever")
    springs = [SimpleNamespace(body="wheel"), SimpleNamespace(body="lever")][: 1 + sprung]
    run.scene = SimpleNamespace(springs=springs, gravity=(0.0, -9.81 * heavy))
    run.pairs, run.events = run.pairs[:5], run.events[run.events["contact"] < 4]
    assert len({side(k, 3.0, 1.0) for k in range(4)}) == 2 and len(run.events)
    if not both:
        compiled.model.primitives[1:5] = compiled.model.primitives[1:2] * 4
    found = StonesUnlocked(run, compiled, anchor).at(np.array([40.0, 50.0]))
    assert all(found) if told else found == ["", ""]


BODIES = ["banking", "wheel", "balance", "lever"]
PAIRS = [("lever", "wheel"), ("wheel", "lever"), ("balance", "lever"), ("lever", "banking"), ("wheel", "balance")]


@pytest.mark.parametrize("seed", range(30))
def test_what_impacts_take_in_stretches(seed: int) -> None:
    rng = np.random.default_rng(seed)
    events = np.zeros(int(rng.integers(0, 60)), EVENT_DTYPE)
    events["t"], events["kind"] = np.sort(rng.integers(0, 30, len(events))) / 2.0, rng.integers(1, 11, len(events))
    events["contact"], events["energy_lost"] = rng.integers(0, 5, len(events)), rng.uniform(1.0, 2.0, len(events))
    pairs = [SimpleNamespace(body_a=a, body_b=b) for a, b in PAIRS]
    scene = SimpleNamespace(bodies=[SimpleNamespace(name=name) for name in BODIES])
    run: Any = SimpleNamespace(events=events, pairs=pairs, scene=scene)
    starts = np.sort(rng.integers(2, 24, 6)) / 2.0
    ends = starts + rng.integers(0, 7, 6) / 2.0
    after, with_end = rng.random(6) < 0.5, rng.random(6) < 0.5
    found = impact_losses(run, starts, ends, after, with_end)
    names = ["wheel-lever", "wheel-lever", "balance-lever", "banking-lever", "wheel-balance"]
    assert [pair_name(run, k) for k in range(5)] == names
    for i, told in enumerate(found.by_pair()):
        wanted: dict[str, float] = {}
        for event in events:
            t = float(event["t"])
            begun = t > starts[i] or (t == starts[i] and not after[i])
            if event["kind"] in (EventKind.IMPACT, EventKind.JAM) and begun and (t < ends[i] or (t == ends[i] and with_end[i])):
                name = names[int(event["contact"])]
                wanted[name] = wanted.get(name, 0.0) + float(event["energy_lost"])
        assert told == pytest.approx(wanted, rel=1e-14) and found.whole[i] == pytest.approx(sum(wanted.values()), abs=1e-14)


def test_the_first_row_of_an_instant_or_the_last() -> None:
    t = np.array([1.0, 2.0, 2.0, 2.0, 3.5, 4.0, 4.0])
    for time, after in product([0.5, 1.0, 2.0, 3.0, 3.5, 4.0, 9.0], [False, True]):
        at = [k for k in range(len(t)) if (t[k] <= time if after else t[k] >= time)]
        wanted = (at[-1] if after else at[0]) if at else (0 if after else len(t) - 1)
        assert _rows(t, np.array([time]), np.array([after])).tolist() == [wanted]


@pytest.mark.parametrize("first", [6, 12])
def test_a_record_that_begins_with_a_phase_tells_the_same(first: int) -> None:
    """With the rates before the impacts at its first instant, where there are two rows."""
    run = lever_run(8)
    told = timeline(run)
    k = int(np.searchsorted(run.t, told[first].phase.start, side="left"))
    assert run.t[k + 1] == run.t[k] and (run.u[k + 1] != run.u[k]).any()
    late = timeline(replace(run, t=run.t[k:], q=run.q[k:], u=run.u[k:], a=run.a[k:]))

    def numbers(one: Stage) -> Any:
        return [*one.start_rates, *one.end_rates, *one.end_angles, one.impulse, *astuple(one.energy)[:-1]]

    assert [one.phase for one in late] == [one.phase for one in told[first:]]
    for one, before in zip(late, told[first:], strict=True):
        assert numbers(one) == pytest.approx(numbers(before), rel=1e-9, abs=1e-18)
        assert one.energy.impacts == pytest.approx(before.energy.impacts, rel=1e-12)


def test_which_runs_carry_energies() -> None:
    run = lever_run(3)
    assert can_be_told(run)
    assert not can_be_told(replace(run, method=MOREAU)) and not can_be_told(replace(run, keep=STATISTICS))
