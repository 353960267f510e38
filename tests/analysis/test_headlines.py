"""Do the first lines that a watchmaker reads say what the numbers say, in his units?"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from watchsim.analysis import headlines as told
from watchsim.analysis.headlines import expected_text, with_scatter
from watchsim.scene.body import Body
from watchsim.scene.scene import Scene
from watchsim.simulation.methods import MOREAU
from watchsim.simulation.stops import Stop

MOTIONS = {"disc": "free", "rack": "slide", "arm": "pivot", "frame": "fixed"}
SCENE = Scene("Made up", tuple(Body(*each) for each in MOTIONS.items()))
STATE = {"x_m_error": 0.0, "y_m_error": 0.0, "angle_rad_error": 0.0}
NUMBERS: dict[str, Any] = {
    **{"verdict": "ticks", "verdict_message": "the watch ticks", "timing_message": "no more is known"},
    **{"amplitude_deg": 275.312, "amplitude_deg_error": 0.12, "rate_s_per_d": -3.4567, "rate_s_per_d_error": 0.02},
    **{"beat_error_ms": 0.1234, "beat_error_ms_error": None, "vph": 28799.876, "window_s": (5.0, 10.0)},
    **{"missed_beats": 2, "beats": 80, "efficiency": 0.34567, "impacts": 1234, "events": 4321, "simulated_s": 10.0},
    "timegrapher": {"amplitude_deg": 281.4, "rate_s_per_d": -3.46, "beat_error_ms": 0.126, "lift_angle_deg": 51.2},
    "bodies": {
        "disc": {
            "x_m": -1.5e-3,
            "y_m": 0.25,
            "angle_rad": math.pi / 3.0,
            **STATE,
            "y_m_error": 2.4e-9,
            "angle_rad_error": 1e-9,
        },
        "rack": {"x_m": 2e-3, "y_m": 0.0, "angle_rad": 0.0, **STATE},
        "arm": {"x_m": 0.0, "y_m": 0.0, "angle_rad": -math.pi / 6.0, **STATE},
        "frame": {"x_m": 0.0, "y_m": 0.0, "angle_rad": 0.0, **STATE},
    },
    "worst_penetration_m": 3.21e-9,
    "overlap": {"looks": 7, "between": ("a", "b"), "x_mm": -1.0, "y_mm": 2.5, "worst_m": 4.2e-6, "t_s": 3.25},
    "counts": {"accumulations": 3, "jams": 0, "energy_rescues": 1},
    **{"realtime_factor": 20.0, "lcp_failures": 1, "warnings": ("doubtful",)},
    "error_bars": {
        **{"complete": True, "step_s": 4e-6, "tolerance": None},
        "differences": {"amplitude_deg": 0.034, "rate_s_per_d": 2e-8, "impacts": 4.0},
    },
    "expect": [
        {"key": "amplitude", "expected": 275.3, "tolerance": 0.05, "unit": "°", "ok": True, "got": 275.312},
        {"key": "rate", "expected": 0.0, "tolerance": 1.0, "unit": "s/d", "ok": False, "got": -3.4567},
        *({"key": key, "ok": None, "message": "not checked: changed by --set"} for key in ("x", "y")),
    ],
}
SILENT = {**dict.fromkeys(NUMBERS["timegrapher"]), "message": "nothing is heard"}
LINES = """\
Made up
  verdict      the watch ticks
  amplitude    275.3°, scatter 0.1°
  rate         −3.46 s/d, scatter 0.02 s/d
  beat error   0.123 ms
  timegrapher  would show 281°, −3.5 s/d, 0.13 ms with a lift angle of 51.2°
  timing       no more is known
  frequency    28799.88 vph, averaged from 5 s to 10 s
               SCATTER
  missed beats 2 in 80 half swings: half pitches the wheel fell short or ran ahead
  efficiency   34.6 % of the drive's work reached the oscillator
  disc         at (−1.5000, 250.0000) mm, 60.000° at the end
  rack         at (2.0000, 0.0000) mm at the end
  arm          at −30.000° at the end
  impacts      1234, 123 per second; 4321 events
  penetration  bodies overlapped by up to 3.2 nm
               7 checks of the outlines themselves: a and b by 4.2 µm at 3.25 s, at (−1.0000, 2.5000) mm
  energy       15 µJ put in, 1.5 µW: damping 75.0 %, friction 24.9 %
               the account closes to 3e-12 of it
  speed        20 × real time, 0.5 s (and 2.5 s to compile or load the solver)
  method       Moreau's time stepping, steps of 20 µs
  solver       5 contact problems, the worst left with a residual of 2e-06; 2 from another start; 1 had no solution
               bounces that died out in ever smaller rebounds: 3
               impacts that would have gained energy, solved again with less restitution: 1
  error bars   of the computation, from a second run with steps of 4 µs:
               amplitude ± 0.03°, rate ± 2e-08 s/d
               disc at the end ± 2 nm and ± 6e-08°
  end          stopped by hand
  WARNING      doubtful
  expected     amplitude = 275.3° ± 0.05°, got 275.312°: kept
  expected     rate = 0 s/d ± 1 s/d, got -3.457 s/d: MISSED
  expected     2 numbers not checked: changed by --set"""


WENT = {"damping": 0.75, "friction": 0.249, "impacts": 4e-4}


def lines(
    monkeypatch: pytest.MonkeyPatch, went_to: dict[str, float] | None = None, ran_down: float = 0.0, **changes: object
) -> list[str]:
    shares = SimpleNamespace(supplied=1.5e-5, went_to=went_to or WENT, ran_down=ran_down)
    monkeypatch.setattr(told, "energy_shares", lambda _: shares)
    run: Any = SimpleNamespace(
        **{"scene": SCENE, "method": MOREAU, "step": 20e-6, "compile": 2.5, "wall": 0.5, "simulated": 10.0},
        **{"counts": {"lcp": 5, "lcp_detours": 2}, "worst_residual": 2e-6, "stop": Stop.DURATION},
        **{"stop_message": "stopped by hand", "energy": {"in_J": 1.0, "stored_J": 0.0, "residual_relative": 3e-12}},
    )
    for name in list(changes):
        if hasattr(run, name):
            setattr(run, name, changes.pop(name))
    return told.headlines(run, NUMBERS | changes).splitlines()


def test_every_line(monkeypatch: pytest.MonkeyPatch) -> None:
    assert lines(monkeypatch) == LINES.replace("SCATTER", told.SCATTER).splitlines()


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"ran_down": 1.5e-5}, "15 µJ taken from what was stored at the start, 1.5 µW: "),
        ({"ran_down": 1e-5}, "15 µJ put in or taken from what was stored, 1.5 µW: "),
        ({"energy": {}}, "the account closes to 0 of it"),
        ({"worst_penetration_m": 0.9e-12}, "bodies overlapped by less than 0.001 nm"),
        ({"worst_penetration_m": 1.1e-12}, "bodies overlapped by up to 1.1 pm"),
        ({"verdict": "knocks"}, "amplitude    275.3°, scatter 0.1°, while it knocks\n"),
        ({"verdict": None}, "Made up\n  amplitude    275.3°, scatter 0.1°\n"),
        ({"method": "another"}, "to compile or load the solver)\n  solver "),
        ({"step": None}, "to compile or load the solver)\n  solver "),
        ({"efficiency": None}, "wheel fell short or ran ahead\n  disc "),
        ({"missed_beats": 0}, "none in 80 half swings"),
        ({"worst_residual": 0.9e-6}, "5 contact problems, each solved to 9e-07 or better; 2 from another start"),
        ({"counts": {}, "lcp_failures": 0}, "there was no contact problem to solve"),
        ({"counts": {"lcp": 1}, "lcp_failures": 0}, "1 contact problem, the worst left"),
        ({"realtime_factor": 0.0}, "speed        not measured"),
        ({"compile": 0.9}, "20 × real time, 0.5 s\n"),
        ({"compile": 1.1}, "20 × real time, 0.5 s (and 1.1 s to compile or load the solver)\n"),
        ({"overlap": {"looks": 1, "between": None, "resolution_m": 2e-6}}, "1 check of the outlines themselves found no"),
        ({"error_bars": {"complete": False}}, "none: the more exact run did not finish"),
        ({"error_bars": NUMBERS["error_bars"] | {"differences": {"amplitude_deg": 0.0}}}, "amplitude ± 0.000000°"),
        ({"simulated_s": 0.0}, "impacts      1234; 4321 events"),
        ({"simulated_s": 5e-4}, "impacts      1234, 2468000 per second; 4321 events"),
        ({"simulated": 0.0}, "15 µJ put in: damping 75.0 %"),
        ({"simulated": 5e-4}, "15 µJ put in, 30 mW: damping 75.0 %"),
        ({"efficiency": -0.25}, "none of the drive's work reached the oscillator, which gave away 25.0 % as much"),
        ({"realtime_factor": 1514.9}, "1,510 × real time"),
        ({"realtime_factor": 999.4}, "speed        999 × real time"),
        ({"stop_message": ""}, "end          " + Stop.DURATION.sentence),
        ({"timegrapher": SILENT}, "timegrapher  nothing is heard"),
    ],
)
def test_otherwise(monkeypatch: pytest.MonkeyPatch, changes: dict[str, object], line: str) -> None:
    assert line in "\n".join(lines(monkeypatch, **changes)) + "\n"


@pytest.mark.parametrize(
    ("value", "error", "expected"),
    [
        (-3.0, 1e-9, "−3.000000 s/d, scatter 0.000001 s/d"),
        (-1e-9, 1e-9, "below 0.000001 s/d"),
        (0.0, 0.0, "0 s/d"),
        (-0.04, 0.3, "0.0 s/d, scatter 0.3 s/d"),
        (-12.3456, None, "−12.346 s/d"),
        (5e-7, 1e-9, "below 0.000001 s/d"),
        (0.0, 1e-9, "below 0.000001 s/d"),
        (1e-9, 0.0, "below 0.000001 s/d"),
        (1.1e-6, 1e-9, "0.000001 s/d, scatter 0.000001 s/d"),
        (0.0, 1.1e-6, "0.000000 s/d, scatter 0.000001 s/d"),
        (3.0, 0.0101, "3.00 s/d, scatter 0.01 s/d"),
        (3.0, 0.0099, "3.000 s/d, scatter 0.010 s/d"),
        (31.0, 12.0, "31 s/d, scatter 12 s/d"),
    ],
)
def test_scatter_of_what_is_negative_or_next_to_nothing(value: float, error: float | None, expected: str) -> None:
    assert with_scatter(value, error, " s/d") == expected


def test_scatter_is_explained_where_there_is_any(monkeypatch: pytest.MonkeyPatch) -> None:
    names = [f"{name}_error" for name, _, _ in told.AVERAGED]
    for known in names:
        assert told.SCATTER in "\n".join(lines(monkeypatch, **{name: 0.1 if name == known else None for name in names}))
    assert told.SCATTER not in "\n".join(lines(monkeypatch, **dict.fromkeys(names)))


@pytest.mark.parametrize(("share", "listed"), [(-0.2, True), (6e-4, True), (-6e-4, True), (4e-4, False), (-4e-4, False)])
def test_shares_of_the_energy_that_show_are_listed(monkeypatch: pytest.MonkeyPatch, share: float, listed: bool) -> None:
    """From a twentieth of a per cent on, of either sign."""
    said = "\n".join(lines(monkeypatch, went_to={"damping": 0.7, "friction": share}))
    assert (f"friction {100.0 * share:.1f} %" in said) is listed and "damping 70.0 %" in said


@pytest.mark.parametrize(
    ("error", "unit", "text"),
    [
        (0.9e-6, "°", "9e-07°"),
        (1.1e-6, "°", "0.000001°"),
        (0.0, "°", "0.000000°"),
        (0.034, " s/d", "0.03 s/d"),
        (2.4e-9, "m", "2 nm"),
        (0.9e-12, "m", "1 pm"),
        (3.1e-12, "m", "3 pm"),
    ],
)
def test_errors_have_one_digit(error: float, unit: str, text: str) -> None:
    assert told._error(error, unit) == text


@pytest.mark.parametrize("place", ["x_m_error", "y_m_error", "angle_rad_error", None])
def test_how_far_bodies_are_off(monkeypatch: pytest.MonkeyPatch, place: str | None) -> None:
    """The larger of both coordinates, and the angle, where they are not zero."""
    state = {"x_m": 0.0, "y_m": 0.0, "angle_rad": 0.0, **STATE}
    said = lines(monkeypatch, bodies={"rack": state | ({place: 3e-4} if place else {})})
    here = [line.strip() for line in said if line.strip().startswith("rack at the end")]
    assert here == ([f"rack at the end ± {'0.02°' if place == 'angle_rad_error' else '300 µm'}"] if place else [])


@pytest.mark.parametrize(
    ("expected", "tolerance", "got", "text"),
    [
        (12.0, 1.0, 12.3456, "12.35"),
        (123.0, 1.0, -123.456, "-123.46"),
        (1234.0, 1.0, 1234.567, "1234.57"),
        (12345.0, 1.0, 12345.678, "12345.68"),
        (0.0, 1.0, 0.0, "0"),
        (0.0, 1.0, 0.123456, "0.1235"),
        (0.1, 1e-16, 0.1, "0.10000000000000001"),
    ],
)
def test_what_was_got_has_two_digits_more_than_the_tolerance(expected: float, tolerance: float, got: float, text: str) -> None:
    entry = {"key": "k", "expected": expected, "tolerance": tolerance, "unit": "", "ok": True, "got": got}
    assert expected_text(entry) == f"k = {expected:.12g} ± {tolerance:.4g}, got {text}"
