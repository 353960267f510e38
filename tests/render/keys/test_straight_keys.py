"""When do straight lines between two keys stand for all instants between them?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from render.fake_runs import watch_run

from watchsim.render import keyframes as module
from watchsim.render.keyframes import _track, keyframes
from watchsim.render.movie import busy
from watchsim.simulation.state import EventKind

T = np.array([2.0, 2.1, 2.5, 2.6, 3.3, 3.4, 3.9, 4.4, 5.0])  # s, the fifth of which bulges
ALONG = ((T - 2.0) / 3.0)[:, None]


def kept(first: tuple[float, float, float], last: tuple[float, float, float], bulge: tuple[float, float, float]) -> list[float]:
    """x, y (m) and angle (rad) at both ends, and by how much they are off the straight line at one instant."""
    frames = np.array(first) + ALONG * np.subtract(last, first) + (np.arange(9) == 4)[:, None] * np.array(bulge)
    track = _track("a", T, frames)
    rows = np.searchsorted(T, track.t)
    assert track.name == "a" and track.places.tolist() == frames[rows, :2].tolist()
    assert track.angles.tolist() == frames[rows, 2].tolist()
    return track.t.tolist()


ENDS = [2.0, 5.0]


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("travels", [0, 1])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_place_may_be_off_by_a_five_thousandth_of_the_travel(axis: int, travels: int, sign: float) -> None:
    """Of the further of both ways, 3 mm; the other is a tenth of it."""
    first, last = (0.7, -0.3, 9.0), [0.7 + 3e-4, -0.3 - 3e-4, 9.0]
    last[travels] = first[travels] + 3e-3 * (1 - 2 * travels)
    for share, enough in ((1.9e-4, True), (2.1e-4, False)):
        bulge = [0.0, 0.0, 0.0]
        bulge[axis] = sign * share * 3e-3
        found = kept(first, (last[0], last[1], last[2]), (bulge[0], bulge[1], bulge[2]))
        assert (found == ENDS) is enough and (3.3 in found) is not enough


@pytest.mark.parametrize(("degrees", "enough"), [(0.019, True), (-0.019, True), (0.021, False), (-0.021, False)])
def test_an_angle_may_be_off_by_a_fiftieth_of_a_degree(degrees: float, enough: bool) -> None:
    found = kept((0.0, 0.0, 3.0), (0.0, 0.0, 4.1), (0.0, 0.0, np.radians(degrees)))
    assert (found == ENDS) is enough and (3.3 in found) is not enough


@pytest.mark.parametrize(("turn", "enough"), [(1.45, True), (-1.45, True), (1.55, False), (-1.55, False)])
def test_no_more_than_a_quarter_turn_from_key_to_key(turn: float, enough: bool) -> None:
    """Else the way round would be in doubt."""
    assert kept((0.0, 0.0, 3.0), (0.0, 0.0, 3.0 + turn), (0.0, 0.0, 0.0)) == (ENDS if enough else [2.0, 3.3, 5.0])


@pytest.mark.parametrize("speed", [1.0, 5e-4, 4.0])
def test_keys_are_a_microsecond_of_the_screen_apart(speed: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """The window begins at 0 s, and its instants are played at that speed."""
    asked = []

    def instants(run: Any, span: Any, apart: float) -> np.ndarray:
        asked.append((span, apart))
        return np.array([0.25, 0.3, 0.5])

    monkeypatch.setattr(module, "_instants", instants)
    tracks = keyframes(watch_run(), (0.25, 0.5), speed)
    assert asked == [((0.25, 0.5), pytest.approx(1e-6 * speed, rel=1e-12, abs=0.0))]
    assert [track.name for track in tracks] == ["wheel", "lever", "balance"]
    assert tracks[2].t == pytest.approx([0.0, 0.05 / speed, 0.25 / speed], rel=1e-12, abs=0.0)
    assert tracks[0].angles[[0, -1]] == pytest.approx([-0.5, -1.0], rel=1e-12)


@pytest.mark.parametrize("start", [0.0, 30.0])
def test_what_is_slow_around_an_event_is_a_share_of_the_window(start: float) -> None:
    """0.4 % of 5 s to each side, united where no more than twice that lies between; wherever the window begins."""
    times = start + np.array([1.0, 1.079, 3.0, 3.081])
    events = np.zeros(4, [("kind", np.int8), ("t", float)])
    events["t"], events["kind"] = times, [EventKind.JAM, EventKind.CLOSE, EventKind.ACCUMULATION, EventKind.OPEN]
    run: Any = SimpleNamespace(events=events)
    spans = [(0.98, 1.099), (2.98, 3.02), (3.061, 3.101)]
    assert busy(run, [], (start, start + 5.0)) == [pytest.approx((start + a, start + b), abs=1e-9) for a, b in spans]
