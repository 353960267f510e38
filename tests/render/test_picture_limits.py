"""On which side of each limit do pictures choose which words, times and rows?"""

import math
import os
import stat
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import imageio.v3 as imageio
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from render.fake_runs import slide_run, watch_run

import watchsim as ws
from watchsim.render.encoder import check_path
from watchsim.render.keyframes import keyframes
from watchsim.render.marks import changing_speed_text, clock, goes_round, reading, scale_bar, signed, speed_text, turn_text
from watchsim.render.movie import MOST_FRAMES, adaptive, busy, even
from watchsim.render.rows import kept_rows
from watchsim.render.view import dense, poses, sampled, stretch, swept
from watchsim.scene.scene import Body
from watchsim.simulation.state import EventKind
from watchsim.units import decimals_for

DEGREE = math.pi / 180.0


def test_from_which_length_on_times_are_in_seconds() -> None:
    """A second, or a millisecond; near zero milliseconds need no start, and a start is a round number before the window."""
    seconds, milli, micro = (1.0, "s"), (1e3, "ms"), (1e6, "µs")
    told = {
        **{(2.0, 3.0): (0.0, *seconds), (2.0, 2.999): (2.0, *milli), (0.0, 1.5): (0.0, *seconds), (0.25, 0.99): (0.0, *milli)},
        **{
            (0.25, 1.01): (0.25, *milli),
            (0.0, 0.0009): (0.0, *micro),
            (0.0, 0.0011): (0.0, *milli),
            (-0.3, 0.2): (0.0, *milli),
        },
        **{(19.4567, 19.4569): (19.4567, *micro), (19.45678, 19.4589): (19.4567, *milli), (19.49, 19.89): (19.49, *milli)},
        **{(19.4567, 19.89): (19.45, *milli), (3.99999999, 4.5): (4.0, *milli)},
    }
    for window, wanted in told.items():
        found = clock(window)
        assert (pytest.approx(found.base, abs=1e-12), found.factor, found.unit) == wanted, window
    assert clock((2.0, 3.0)).label == "time (s)" and clock((3.4, 3.6)).label == "time after 3.4 s (ms)"


def test_digits_that_show_a_step() -> None:
    steps = {0.1: 1, 0.11: 1, 0.099: 2, 1e-3: 3, 1e-9: 9, 1e-12: 9, 1.0: 0, 0.9999999999: 0, 50.0: 0, -1.0: 3}
    assert {step: decimals_for(step) for step in steps} == steps


def test_words_for_speeds() -> None:
    assert [
        speed_text(speed) for speed in (1.0 + 0.9e-9, 1.0 + 1.1e-8, 9 / 10, 10 / 13, 1 / 99_999, 0.3 + 1e-7, 0.3 + 1e-6)
    ] == [
        *("true speed", "1 × true speed", "9/10 of true speed", "0.7692 of true speed", "1/99999 of true speed"),
        *("3/10 of true speed", "0.3 of true speed"),
    ]
    speeds = {
        **{0.671: "0.7", 0.669: "1/1.5", 0.994: "1", 1.006: "1", 9.94: "9.9", 9.96: "10", 99.4: "99", 123.0: "120"},
        0.1: "1/10",
    }
    for speed, number in speeds.items():
        way = "of" if number.startswith("1/") else "×"
        assert changing_speed_text(speed) == f"{number} {way} true speed"
    assert changing_speed_text(0.9951) == changing_speed_text(1.0049) == "true speed"


def test_words_for_turns() -> None:
    turns = {0.004: "", 0.006: "0.01° counter-clockwise", -0.006: "0.01° clockwise", 450.0: "90° counter-clockwise"}
    turns |= {179.0: "179° counter-clockwise", 181.0: "179° clockwise"}
    for degrees, words in turns.items():
        assert turn_text(degrees * DEGREE) == (f"picture turned by {words}" if words else "")


@pytest.mark.parametrize(("largest", "so"), [(math.tau * 0.999, False), (math.tau, True), (-math.tau, True), (-6.0, False)])
def test_turns_that_have_gone_by(largest: float, so: bool) -> None:
    assert goes_round(np.array([0.1, largest, -0.2])) is so and not goes_round(np.zeros(0))


def angles(*degrees: float) -> np.ndarray:
    return np.column_stack((np.zeros((len(degrees), 2)), np.radians(degrees)))


@pytest.mark.parametrize(("span", "text"), [(29.9, "12.35°"), (30.1, "12.3°")])
def test_small_ranges_of_angles_have_two_decimals(span: float, text: str) -> None:
    body = Body("arm")
    tell, ends = reading(body, angles(0.0, span))
    assert tell(angles(12.345)[0]).replace("12.35", "12.34") == text.replace("12.35", "12.34")
    assert ends[0] in ("0.00°", "0.0°") and len(ends[0]) == len(text) - 1
    within, room = reading(body, angles(0.0, span), within_turn=True)
    shown = [within(angles(value)[0]) for value in (370.25, -10.25, 359.9999, 720.0)]
    digits = 2 if span < 30.0 else 1
    assert shown == [f"{10.25:.{digits}f}°", f"{349.75:.{digits}f}°", f"{0.0:.{digits}f}°", f"{0.0:.{digits}f}°"]
    assert room == (f"{0.0:.{digits}f}°", f"{300.0:.{digits}f}°")


@pytest.mark.parametrize(("travel", "decimals"), [(2e-3, 2), (0.9e-3, 3), (2e-6, 5), (0.0, 6), (0.5, 2)])
def test_travels_have_two_digits_more_than_their_range(travel: float, decimals: int) -> None:
    """Along an oblique axis from a place off the origin."""
    body = Body("slide", "slide", (1e-3, -2e-3), axis=(0.6, -0.8))
    ways = np.array([-0.25, 0.75]) * travel
    frames = np.column_stack((1e-3 + 0.6 * ways, -2e-3 - 0.8 * ways, [0.0, 0.0]))
    tell, ends = reading(body, frames)
    for frame, way, end in zip(frames, ways, ends, strict=True):
        text = f"{1e3 * way:.{decimals}f} mm".replace("-", "−")
        assert tell(frame) == end == (text if float(text.split()[0].replace("−", "-")) else text.lstrip("−"))


@pytest.mark.parametrize(("width", "name"), [(0.99, "500 mm"), (1.0, "1 m"), (1.99, "1 m"), (9.0, "5 m"), (1e-5, "0.01 mm")])
def test_names_of_scale_bars(width: float, name: str) -> None:
    assert scale_bar(width)[1] == name


@pytest.mark.parametrize(("over", "fits"), [(0.9e-9, True), (1.1e-9, False)])
def test_a_window_may_miss_the_record_by_a_billionth_of_itself(over: float, fits: bool) -> None:
    """At either end; what is drawn was recorded."""
    run = watch_run()
    for window in ((1.5, 2.0 + 0.5 * over), (-0.5 * over, 0.5)):
        if fits:
            low, high = stretch(run, window)
            assert low >= 0.0 and high <= 2.0 and high - low == pytest.approx(0.5, abs=1e-8)
        else:
            with pytest.raises(ValueError, match="was recorded"):
                stretch(run, window)


def test_samples_and_room() -> None:
    """Some hundred instants; a body that turns by less than a turn fills just that room, evenly, by three degrees."""
    run = watch_run()
    lever, balance = run.scene.body("lever"), run.scene.body("balance")
    assert 400 <= len(sampled(run, lever, (0.0, 0.9))) <= 1250
    for body in (lever, balance):
        room = swept(run, body, (0.0, 0.9))
        steps = np.diff(room[:, 2])
        assert steps == pytest.approx(steps[0]) and 0.0 < steps[0] < 3.0 * DEGREE * 1.001
        assert np.ptp(room[:, 2]) <= math.tau * (1.0 + 1e-12) and (room[:, :2] == body.position).all()
    assert swept(run, replace(balance, on="lever"), (0.0, 0.9)).shape == sampled(run, balance, (0.0, 0.9)).shape
    slider = slide_run()
    body = slider.scene.body("slider")
    assert np.array_equal(swept(slider, body, (0.0, 1.0)), sampled(slider, body, (0.0, 1.0)))


@pytest.mark.parametrize("accelerations", [True, False])
def test_rows_and_points_between(accelerations: bool) -> None:
    """Between rows far apart as many as it takes, evenly."""
    run = watch_run()
    t, q, u, a = dense(run, (0.2, 0.7), least=37, accelerations=accelerations)
    rows = run.t[(run.t > 0.2) & (run.t < 0.7)]
    assert set(rows) <= set(t) and np.diff(t).max() <= 0.5 / 37 * (1.0 + 1e-9)
    at_q, at_u = run.sample(t)
    assert q == pytest.approx(at_q, abs=1e-12) and u == pytest.approx(at_u, abs=1e-9)
    assert a.shape == ((len(t) if accelerations else 0), q.shape[1])
    if accelerations:
        assert a[1:-1] == pytest.approx(run.acceleration(t)[1:-1], rel=1e-6, abs=1e-6)


def test_kept_rows_are_the_fewest_halvings() -> None:
    """Where three in a row fit; where all do; what must be kept is."""
    assert kept_rows(9, lambda i, j: j - i <= 2).tolist() == [0, 2, 4, 6, 8]
    assert kept_rows(9, lambda i, j: j - i <= 4).tolist() == [0, 4, 8] and kept_rows(9, lambda i, j: True).tolist() == [0, 8]
    assert kept_rows(9, lambda i, j: True, (3, 5)).tolist() == [0, 3, 5, 8]
    assert kept_rows(7, lambda i, j: False).tolist() == list(range(7))
    assert kept_rows(0, lambda i, j: True).tolist() == [] and kept_rows(1, lambda i, j: True).tolist() == [0]
    asked: set[tuple[int, int]] = set()

    def fits(i: int, j: int) -> bool:
        asked.add((i, j))
        return True

    kept_rows(12, fits, (4, 5))
    assert asked == {(0, 4), (5, 11)}


@pytest.mark.parametrize("speed", [1.0, 0.05, 3.0])
def test_keys_lie_on_the_motion_to_what_an_eye_sees(speed: float) -> None:
    """Straight lines between them are off by no more than 0.02° and 0.02 % of the travel; times begin with the window."""
    run = watch_run()
    tracks = {track.name: track for track in keyframes(run, (0.25, 0.75), speed)}
    assert sorted(tracks) == ["balance", "lever", "wheel"]
    for name, track in tracks.items():
        t, turned = track.t, track.angles
        assert t[0] == 0.0 and t[-1] == pytest.approx(0.5 / speed, rel=1e-12) and (np.diff(t) > 0.0).all()
        fine = np.linspace(0.0, 0.5, 4001)
        truth = run.sample(0.25 + fine)[0][:, run.slices[name].start]
        assert np.abs(np.interp(fine / speed, t, turned) - truth).max() <= 0.0215 * DEGREE


def test_places_are_off_by_a_share_of_the_travel() -> None:
    """Of 2 mm to and fro, along an oblique axis; not by much less either, or there would be more keys than it takes."""
    run = slide_run()
    (track,) = keyframes(run, (0.0, 1.0), 1.0)
    fine = np.linspace(0.0, 1.0, 4001)
    truth = poses(run, fine)["slider"][:, :2]
    off = np.abs(np.column_stack([np.interp(fine, track.t, track.places[:, k]) for k in (0, 1)]) - truth).max()
    travel = np.ptp(truth, axis=0).max()
    assert 0.5e-4 * travel < off <= 2.1e-4 * travel


@pytest.mark.parametrize("speed", [0.0, -1.0, math.nan, math.inf])
def test_speeds_that_are_none(speed: float) -> None:
    with pytest.raises(ValueError, match="seconds of the watch per second"):
        keyframes(watch_run(), None, speed)


def lively(
    times: list[float], found: list[tuple[str, float, float]] | None = None, window: tuple[float, float] = (0.0, 10.0)
) -> Any:
    events = np.zeros(2 * len(times), [("kind", np.int8), ("t", float)])
    events["t"], events["kind"] = np.repeat(times, 2), np.tile([int(EventKind.IMPACT), int(EventKind.CROSS)], len(times))
    phases: Any = [SimpleNamespace(name=name, start=start, end=end) for name, start, end in found or []]
    run: Any = SimpleNamespace(events=events)
    return [pytest.approx(span) for span in busy(run, phases, window)]


def test_stretches_around_events() -> None:
    """0.4 % of the window to each side, united where no more than 0.8 % lies between them, cut to the window."""
    assert lively([]) == [] and lively([5.0]) == [(4.96, 5.04)] and lively([-1.0, 11.0]) == []
    assert lively([5.0, 5.159]) == [(4.96, 5.199)] and lively([5.0, 5.161]) == [(4.96, 5.04), (5.121, 5.201)]
    assert lively([0.0, 10.0]) == [(0.0, 0.04), (9.96, 10.0)] and lively([0.01, 0.02]) == [(0.0, 0.06)]


def test_a_tenth_of_the_longest_phase_is_shown_beside_it() -> None:
    assert lively([], [("drop", 4.0, 4.5), ("locked", 4.5, 9.0)]) == [(3.95, 4.55)]
    assert lively([], [("drop", 4.0, 7.0)]) == [(3.7, 7.3)]


def test_stretches_of_phases() -> None:
    """All but those in which nothing happens, a tenth of the longest to each side."""
    phases = [("unlocking", 1.0, 1.5), ("impulse", 1.5, 2.5), ("locked", 2.5, 6.0), ("drop", 6.0, 6.1), ("run", 12.0, 13.0)]
    assert lively([9.0], phases) == [(0.9, 2.6), (5.9, 6.2)]
    assert lively([9.0], [*phases, ("draw", 7.19, 7.2)]) == [(0.9, 2.6), (5.9, 7.3)]
    assert lively([9.0], [*phases, ("draw", 7.31, 7.32)]) == [(0.9, 2.6), (5.9, 6.2), (7.21, 7.42)]
    assert lively([9.0], phases[2:3]) == [(8.96, 9.04)] and lively([], phases, (2.4, 6.05)) == [(2.4, 2.6), (5.9, 6.05)]


def test_where_a_movie_can_be_written(tmp_path: Path) -> None:
    (tmp_path / "folder.mp4").mkdir()
    assert check_path(str(tmp_path / "a.Mp4")) == tmp_path / "a.Mp4" and check_path(tmp_path / "b.gif") == tmp_path / "b.gif"
    for name, error in (("a.avi", ValueError), ("folder.mp4", IsADirectoryError)):
        with pytest.raises(error):
            check_path(tmp_path / name)


BEAT = ((0.1, 0.106), (0.225, 0.231), (0.35, 0.356))


def test_what_happens_gets_most_of_the_frames():
    plan = adaptive((0.0, 0.5), BEAT, 10.0, 60.0)
    shown = sum(np.count_nonzero((plan.times >= start) & (plan.times <= end)) for start, end in BEAT)
    assert len(plan.times) == 601 and 0.65 < shown / 601 < 0.85
    assert plan.times[0] == 0.0 and plan.times[-1] == pytest.approx(0.5, abs=1e-12)


def test_the_speed_told_is_that_of_the_film():
    """Against central differences of the instants, which know nothing of speeds: off by the square of the step."""
    off = []
    for fps in (1200.0, 2400.0):
        plan = adaptive((0.0, 0.5), BEAT, 10.0, fps)
        measured = (plan.times[2:] - plan.times[:-2]) * fps / 2.0
        off.append(np.quantile(np.abs(measured / plan.speeds[1:-1] - 1.0), 0.99))
    assert off[0] < 1e-3 and off[1] == pytest.approx(off[0] / 4.0, rel=0.2)


@given(
    cuts=st.lists(st.integers(0, 10**9).map(lambda n: n / 10**9), min_size=2, max_size=12, unique=True).filter(
        lambda cuts: len(cuts) % 2 == 0
    ),
    length=st.floats(0.2, 60.0),
)
def test_any_stretches_give_a_film_of_the_asked_length_that_never_turns_back(cuts, length):
    edges = sorted(cuts)
    plan = adaptive((0.0, 1.0), list(zip(edges[::2], edges[1::2], strict=True)), length, 30.0)
    assert len(plan.times) == max(2, int(np.floor(length * 30.0 + 1e-6)) + 1)
    assert plan.times[0] == pytest.approx(0.0, abs=1e-9) and plan.times[-1] == pytest.approx(1.0, abs=1e-9)
    assert np.all(np.diff(plan.times) >= 0.0) and np.all(plan.speeds > 0.0) and np.all(np.isfinite(plan.speeds))


def test_without_anything_to_tell_apart_the_speed_is_even():
    for spans in ((), ((0.0, 1.0),)):
        plan = adaptive((0.0, 1.0), spans, 5.0, 20.0)
        assert np.allclose(plan.times, np.linspace(0.0, 1.0, 101)) and np.allclose(plan.speeds, 0.2)


@pytest.mark.parametrize("length", [0.0, -1.0, np.nan, np.inf, 1e9])
def test_a_length_without_sense_is_refused(length):
    with pytest.raises(ValueError, match="length"):
        adaptive((0.0, 1.0), (), length, 60.0)


def test_even_frames_lie_evenly_and_are_limited():
    plan = even((1.0, 2.0), 0.5, 10.0)
    assert np.allclose(np.diff(plan.times), 0.05) and np.all(plan.speeds == 0.5)
    with pytest.raises(ValueError, match="frames"):
        even((0.0, 2.0 * MOST_FRAMES), 1.0, 60.0)


@pytest.mark.parametrize(
    ("speed", "text"),
    [
        (1.0, "true speed"),
        (1 / 20, "1/20 of true speed"),
        (0.05, "1/20 of true speed"),
        (2 / 3, "2/3 of true speed"),
        (0.123456, "0.1235 of true speed"),
        (1e-7, "1e-07 of true speed"),
        (2.0, "2 × true speed"),
        (1.2, "1.2 × true speed"),
        (1.0625, "1.062 × true speed"),
        (9 / 11, "9/11 of true speed"),
        (10 / 11, "0.9091 of true speed"),
    ],
)
def test_speed(speed, text):
    assert speed_text(speed) == text


def test_time_in_seconds_or_after_the_start():
    assert clock((0.0, 10.0)).text(1.2345, 1 / 60) == "1.23 s"
    assert clock((19.4, 19.75)).text(19.4125, 1 / 1200) == "19.4125 s"
    assert clock((3.40000046, 3.6)).label == "time after 3.4 s (ms)"
    assert clock((3.40000046, 3.6)).text(3.4125, 1 / 1200) == "3.4125 s"
    assert clock((19.816, 19.8165)).text(19.8161234, 1e-7) == "19.8161234 s"
    assert clock((0.0, 0.3)).text(0.0125, 1 / 1200) == "12.5 ms"


def test_numbers():
    assert signed(-0.04, 1) == "0.0"
    assert signed(-1.25, 2) == "−1.25"
    assert [decimals_for(step) for step in (20.0, 1.0, 0.5, 0.01, 0.0)] == [0, 0, 1, 2, 3]


@pytest.mark.parametrize(
    ("room", "bar"), [(0.0016, (1e-3, "1 mm")), (0.0004, (2e-4, "0.2 mm")), (0.05, (0.05, "50 mm")), (3.1, (2.0, "2 m"))]
)
def test_scale_bar_is_round(room, bar):
    length, name = scale_bar(room)
    assert (length, name) == (pytest.approx(bar[0]), bar[1])


def test_poses_in_words():
    run = watch_run()
    balance = run.scene.body("balance")
    tell, ends = reading(balance, sampled(run, balance, (0.0, 2.0)))
    assert tell(np.array([0.0, 0.0, np.radians(-123.42)])) == "−123.4°"
    assert ends == ("−286.5°", "286.5°")
    lever = run.scene.body("lever")
    tell, _ = reading(lever, sampled(run, lever, (0.0, 0.9)))
    assert tell(np.array([0.0, 3e-3, np.radians(5.126)])) == "5.13°"
    slider = slide_run()
    body = slider.scene.body("slider")
    tell, _ = reading(body, sampled(slider, body, (0.0, 1.0)))
    assert tell(poses(slider, np.array([0.3]))["slider"][0]) == f"{2 * np.sin(3.0):.2f} mm"


@pytest.mark.parametrize(
    ("degrees", "text"),
    [
        (0.0, ""),
        (360.0, ""),
        (-90.0, "picture turned by 90° clockwise"),
        (20.0, "picture turned by 20° counter-clockwise"),
        (270.0, "picture turned by 90° clockwise"),
        (180.0, "picture turned by 180°"),
        (-180.0, "picture turned by 180°"),
    ],
)
def test_a_turned_picture_says_so(degrees, text):
    assert turn_text(math.radians(degrees)) == text


def test_room_for_a_slider_is_that_of_its_whole_travel():
    """2 mm · sin(10 t) along its axis: the texts at both ends say how much room the read-out needs."""
    run = slide_run()
    slider = run.scene.body("slider")
    tell, ends = reading(slider, sampled(run, slider, (0.0, 1.0)))
    frames = poses(run, np.array([0.05]))["slider"]
    assert float(tell(frames[0]).split()[0]) == pytest.approx(2.0 * math.sin(0.5), abs=6e-3)
    assert [float(text.replace("−", "-").split()[0]) for text in ends] == pytest.approx([-2.0, 2.0], abs=6e-3)
    assert [text.split()[1] for text in ends] == ["mm", "mm"]


@pytest.mark.parametrize(
    ("speed", "text"),
    [
        (1.004, "true speed"),
        (0.996, "true speed"),
        (0.7, "0.7 × true speed"),
        (0.5, "1/2 of true speed"),
        (1 / 43.2, "1/43 of true speed"),
        (1 / 432.0, "1/430 of true speed"),
        (2.46, "2.5 × true speed"),
    ],
)
def test_a_speed_that_changes_has_two_digits(speed: float, text: str) -> None:
    assert changing_speed_text(speed) == text


@pytest.mark.parametrize("exponent", range(-6, 1))
@pytest.mark.parametrize("step", [1, 2, 5])
def test_a_scale_bar_as_wide_as_its_room_fits(step: int, exponent: int) -> None:
    """To the last digit; with a hair less room it is the next smaller one."""
    length = step * 10.0**exponent
    smaller = {1: 0.5, 2: 0.5, 5: 0.4}[step]
    assert scale_bar(length)[0] == pytest.approx(length, rel=1e-12)
    assert scale_bar(length * (1.0 - 1e-6))[0] == pytest.approx(smaller * length, rel=1e-12, abs=0.0)


# Is an old movie left as it was where the new one cannot be written, and is a picture made of the longest words?

SMALL = (480, 270)
FULL_DISK = "cat > /dev/null; echo 'frame 1' >&2; echo 'write: No space left on device' >&2; exit {}"


@pytest.mark.skipif(os.name != "posix", reason="the encoder here is a script of the shell")
@pytest.mark.parametrize(
    ("does", "said"),
    [
        (FULL_DISK.format(1), "write: No space left on device"),
        (FULL_DISK.format(0), "write: No space left on device"),  # as some releases of ffmpeg end
        ("echo 'it dies at once' >&2; exit 1", "it dies at once"),
        ("exit 3", "stopped without a message"),
    ],
)
@pytest.mark.parametrize("name", ["beat.mp4", "beat.gif"])
def test_an_encoder_that_fails_leaves_the_old_movie(
    does: str, said: str, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    encoder = tmp_path / "ffmpeg"
    encoder.write_text(f'#!/bin/sh\nfor last; do :; done\necho half > "$last"\n{does}\n', encoding="utf-8")
    encoder.chmod(encoder.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(encoder))
    folder = tmp_path / "movies"
    folder.mkdir()
    (folder / name).write_bytes(b"the old movie")
    with pytest.raises(OSError, match=said):
        ws.movie(watch_run(), folder / name, size=SMALL, speed=2.0, fps=20)
    assert (folder / name).read_bytes() == b"the old movie" and list(folder.iterdir()) == [folder / name]


def test_a_title_of_ten_megabytes_is_cut_in_a_plot(tmp_path: Path) -> None:
    """In less time than its letters would take to be measured."""
    begun = time.process_time()
    run = watch_run(title="tick " * 2_000_000)
    place = tmp_path / "kinematics.png"
    ws.plot_kinematics(run).savefig(place)
    assert imageio.imread(place).shape[0] > 0 and time.process_time() - begun < 20.0
