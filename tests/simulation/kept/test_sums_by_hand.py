"""Are the sums over half swings those of all events at once, and is what is kept told in its columns? Made-up runs."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from watchsim.scene.body import Body
from watchsim.scene.force import Spring
from watchsim.scene.recording import ALL, Recording
from watchsim.scene.scene import Scene
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.record import tally as tallying
from watchsim.simulation.record.contact_names import Pair
from watchsim.simulation.record.row_selection import Kept, columns_of
from watchsim.simulation.record.tally import Tally, _add
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.stops import Stop

SCENE = Scene(
    "two",
    (Body("post", "fixed"), Body("balance", "pivot", velocity=(3.0,), inertia=1e-9), Body("lever", "pivot", inertia=1e-9)),
    springs=(Spring("balance", 1e-9 * math.pi**2),),  # a half period of a second
)


def pair(one: str, other: str) -> Pair:
    return Pair(0, one, "corner", 0, "a", other, "line", 1, "b")


PAIRS = [pair("lever", "post"), pair("balance", "lever"), pair("lever", "balance")]


def swung(count: int, seed: int) -> np.ndarray:
    """Events of an uneven swing about zero: turns, passages, knocks of the balance in most half swings, and of others."""
    rng = np.random.default_rng(seed)
    rows, side = [], 1.0
    for k in range(count):
        rows.append((k + rng.uniform(-0.1, 0.1), EventKind.TURN, -1, 1, -side * rng.uniform(2.0, 3.0)))
        rows.append((k + 0.5 + rng.uniform(-0.1, 0.1), EventKind.CROSS, -1, 1, side * rng.uniform(5.0, 6.0)))
        if rng.random() < 0.8:
            rows.append((k + 0.3 + rng.uniform(-0.05, 0.05), EventKind.IMPACT, rng.integers(1, 3), -1, -0.1))
        rows.append((k + 0.32 + rng.uniform(0.0, 0.1), EventKind.IMPACT, 0, -1, -0.1))  # none of the balance's
        rows.append((k + 0.1, EventKind.CLOSE, 1, -1, 2.0))  # makes no noise
        rows.append((k + 0.2, EventKind.TURN, -1, 2, 9.0))  # the lever's
        side = -side
    events = np.zeros(len(rows), EVENT_DTYPE)
    for name, column in zip(("t", "kind", "contact", "body", "value"), zip(*rows, strict=True), strict=True):
        events[name] = column
    return events[np.argsort(events["t"])]


def by_hand(events: np.ndarray) -> dict[str, np.ndarray]:
    """Amplitude, period and unevenness of every half swing."""
    own = events[events["body"] == 1]
    turns, passages = (own[own["kind"] == kind] for kind in (EventKind.TURN, EventKind.CROSS))
    noises = events["t"][(events["kind"] == EventKind.IMPACT) & (events["contact"] > 0)]
    found: dict[str, list[float]] = {"amplitude": [], "period": [], "uneven_ticks": [], "uneven_passages": []}
    ticks: list[float] = []
    for k in range(len(turns) - 1):
        start, end = turns[k], turns[k + 1]
        way = end["value"] - start["value"]
        within = noises[(noises > start["t"]) & (noises < end["t"])]
        ticks.append(float(within[0]) if len(within) else math.nan)
        found["amplitude"].append(0.5 * abs(way))
        if k >= 2:
            t = passages["t"]
            found["period"].append(t[k] - t[k - 2])
            found["uneven_passages"].append(math.copysign(1.0, way) * (t[k] - 2.0 * t[k - 1] + t[k - 2]))
            found["uneven_ticks"].append(math.copysign(1.0, way) * (ticks[k] - 2.0 * ticks[k - 1] + ticks[k - 2]))
    found["ticks"] = [tick for tick in ticks if not math.isnan(tick)]
    return {name: np.array([value for value in values if not math.isnan(value)]) for name, values in found.items()}


@pytest.mark.parametrize("carried", [8, 4])
@pytest.mark.parametrize("parts", [1, 2, 5, 60, 1000])
@pytest.mark.parametrize("seed", [1, 2])
def test_sums_are_those_of_all_half_swings_however_events_are_handed_over(
    parts: int, seed: int, carried: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Four passages with the turning points between them are all that the next half swing needs."""
    monkeypatch.setattr(tallying, "CARRIED", carried)
    events = swung(20, seed)
    tally = Tally(SCENE, PAIRS)
    assert tally.half_period == pytest.approx(1.0)
    for part in np.array_split(events, parts):
        tally.fold(part)
    assert len(tally.carried) <= 6 * (carried + 1)
    sums, wanted = tally.finished(), by_hand(events)
    assert sums["half_swings"] == len(wanted["amplitude"]) == 19 and sums["ticks"] == len(wanted["ticks"])
    for name in ("amplitude", "period", "uneven_ticks", "uneven_passages"):
        values = wanted[name]
        number, ends = len(values), {"least": values.min(), "largest": values.max()}
        moments = {"number": number, "mean": values.mean(), "squares": number * values.var(), **ends}
        assert number > 3 and sums[name] == pytest.approx(moments, rel=1e-9)
    kinds = sums["events_by_kind"]
    assert kinds["turn"] == 40 and kinds["close"] == kinds["cross"] == 20 and kinds["jam"] == kinds["open"] == 0
    assert kinds["impact"] == int((events["kind"] == EventKind.IMPACT).sum())
    assert tally.finished() == sums  # asked twice, it is the same


def test_a_tally_goes_on_from_what_was_saved() -> None:
    events = swung(12, 3)
    one, two, whole = (Tally(SCENE, PAIRS) for _ in range(3))
    one.fold(events[:31])
    two.restore(one.arrays())
    two.fold(events[31:])
    whole.fold(events)
    for name, sums in whole.finished().items():
        assert two.finished()[name] == (pytest.approx(sums, rel=1e-12, abs=0.0) if isinstance(sums, dict) else sums)


def test_a_turning_point_further_out_may_still_come_before_the_next_passage() -> None:
    """It knocks at 1 rad, goes on to 1.5: handed over between the two, the half swing waits for the next passage."""
    rows = [(0.0, EventKind.TURN, -2.0), (0.5, EventKind.CROSS, 5.0), (0.8, EventKind.TURN, 1.0), (0.9, EventKind.TURN, 0.9),
            (1.0, EventKind.TURN, 1.5), (1.5, EventKind.CROSS, -5.0), (2.0, EventKind.TURN, -2.5)]  # fmt: skip
    events = np.zeros(len(rows), EVENT_DTYPE)
    for name, column in zip(("t", "kind", "value"), zip(*rows, strict=True), strict=True):
        events[name] = column
    events["contact"], events["body"] = -1, 1
    for cut in range(8):
        tally = Tally(SCENE, ())
        for part in (events[:cut], events[cut:]):
            tally.fold(part)
        amplitude = tally.finished()["amplitude"]
        assert (amplitude["number"], amplitude["least"], amplitude["largest"]) == (2, 1.75, 2.0)


def test_sums_have_the_shapes_of_saved_states() -> None:
    shapes = {name: array.shape for name, array in Tally(SCENE, PAIRS).arrays().items()}
    assert shapes == {"kinds": (11,), "beats": (2,), "moments": (4, 5), "last": (1,), "carried": (0,)}


def test_without_an_oscillator_only_kinds_are_counted() -> None:
    tally = Tally(Scene("none", SCENE.bodies[:1]), ())
    tally.fold(swung(4, 1))
    sums = tally.finished()
    assert (
        set(sums) == {"events_by_kind"}
        and sums["events_by_kind"]["cross"] == 4
        and (tally.body, tally.half_period) == (-1, 0.0)
    )


def test_of_an_oscillator_that_never_passes_its_rest_so_many_noises_are_carried(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tallying, "MOST_CARRIED", 7)
    events = np.zeros(20, EVENT_DTYPE)
    events["t"], events["kind"], events["contact"], events["body"] = np.arange(20.0), EventKind.IMPACT, 1, -1
    tally = Tally(SCENE, PAIRS)
    tally.fold(events)
    assert tally.carried["t"].tolist() == list(range(13, 20))


@pytest.mark.parametrize("seed", range(4))
def test_moments_of_parts_are_those_of_the_whole(seed: int) -> None:
    rng = np.random.default_rng(seed)
    values = rng.normal(5.0, 2.0, 17)
    moments = np.array([0.0, 0.0, 0.0, np.inf, -np.inf])
    for part in np.split(values, [3, 3, 4, 11]):
        _add(moments, part)
    wanted = [17, values.mean(), ((values - values.mean()) ** 2).sum(), values.min(), values.max()]
    assert moments == pytest.approx(wanted, rel=1e-12)


def test_rows_are_told_as_time_places_velocities_and_accelerations() -> None:
    rows = np.arange(21.0).reshape(3, 7)
    t, q, u, a = columns_of(rows)
    assert t.tolist() == [0.0, 7.0, 14.0]
    assert [part[1].tolist() for part in (q, u, a)] == [[8.0, 9.0], [10.0, 11.0], [12.0, 13.0]]


def rows_at(*times: float) -> np.ndarray:
    return np.array([[t, 10.0 + t, 20.0 + t, 30.0 + t] for t in times])


def events_at(*times: float) -> np.ndarray:
    events = np.zeros(len(times), EVENT_DTYPE)
    events["t"] = times
    return events


def told(kept: Kept, end: float) -> tuple[list[float], list[float]]:
    """Times of rows and events of a run that ends there."""
    found = kept.closed(end)
    assert found is not None
    (t, q, u, a), events = found
    assert (q[:, 0].tolist(), u[:, 0].tolist(), a[:, 0].tolist()) == ([*(10.0 + t)], [*(20.0 + t)], [*(30.0 + t)])
    return t.tolist(), events["t"].tolist()


@pytest.mark.parametrize(("after", "stays"), [(3.0, True), (1.4, False)])
def test_a_row_before_a_window_waits_for_the_next_one(after: float, stays: bool) -> None:
    """Also where the run is taken up there."""
    whole = Kept(Recording(((1.5, 2.5),)), 0.5)
    whole.flush(rows_at(0.0, 1.0), events_at(0.5))
    assert told(whole, 1.0) == ([], [0.5]) and whole.unfinished()["row"].tolist() == [1.0, 11.0, 21.0, 31.0]
    later = Kept(Recording(((1.5, 2.5),)), 0.5)
    later.go_on(whole.unfinished())
    assert told(later, 1.0) == ([], []) and later.parts == 1
    for kept, before in ((whole, [0.5]), (later, [])):
        kept.flush(rows_at(after, 4.0), events_at(3.5))
        assert told(kept, 4.0) == ([1.0, 3.0] if stays else [1.4, 4.0], [*before, 3.5])


def test_of_statistics_events_within_windows_stay_and_those_of_the_end() -> None:
    """Also of parts that are settled."""
    kept, followed = Kept(Recording(((1.0, 2.0),), "statistics"), 0.5), []
    kept.follow = lambda events, rows: followed.append((events["t"].tolist(), rows[0].tolist()))
    for start in range(0, 20, 2):
        kept.flush(rows_at(start + 0.25, start + 1.25), events_at(start + 0.5, start + 1.5))
    assert told(kept, 19.25) == ([0.25, 1.25, 2.25, 18.25, 19.25], [1.5, 19.5])
    assert followed == [([1.5], [0.25, 1.25]), ([], [2.25])]


def test_a_run_made_by_hand_has_reached_nothing_and_kept_all() -> None:
    none = np.zeros((0, 1))
    made = Trajectory(SCENE, np.zeros(0), none, none, none, {}, np.zeros(0, EVENT_DTYPE), (), Stop.DURATION)
    given: dict[str, Any] = {
        "stop_message": "", "simulated": 0.0, "wall": 0.0, "compile": 0.0, "method": "pfeiffer-glocker", "tolerance": 1e-9,
        "worst_penetration": 0.0, "worst_residual": 0.0, "overlap": {}, "energy": {}, "counts": {}, "step": None, "keep": ALL,
        "spans": (), "sums": {}, "end_state": None, "failure": None, "worst_overlap": 0.0, "end": None,
    }  # fmt: skip
    assert {name: getattr(made, name) for name in given} == given
    assert made.end_q.shape == made.end_u.shape == (0,)
