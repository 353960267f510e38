"""Does the summary hold every promised number, with its errors and doubts, in a watchmaker's words?"""

import json
import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from analysis.made_beats import lever_run
from render.fake_runs import disc_run, slide_run

import watchsim as ws
from watchsim.analysis.flows import energy_shares
from watchsim.analysis.headlines import doubts, expected_text, with_scatter
from watchsim.analysis.summary import NUMBERS, summary, summary_text, tables, with_error_bars
from watchsim.mechanism.compile import scene_size
from watchsim.scene.scene import Expectation
from watchsim.simulation import MOREAU
from watchsim.simulation.state import Stop

# Does the summary hold every promised number, and does its text read as a watchmaker expects?

PROMISED = (
    *("scene", "method", "tolerance", "simulated_s", "wall_s", "compile_s", "realtime_factor", "stop", "bodies", "impacts"),
    *("events", "lcp_failures", "worst_penetration_m", "energy", "amplitude_deg", "amplitude_deg_error", "period_s"),
    *("period_s_error", "rate_s_per_d", "rate_s_per_d_error", "beat_error_ms", "beat_error_ms_error", "timegrapher"),
    *("expect", "versions", "missed_beats"),
)
LEDGER = {
    "in_J": 2e-6,
    "dissipated": {"friction": 5e-7, "damping": 1e-6, "impacts": 4e-7},
    "stored_J": 1e-7,
    "residual_J": 1e-16,
    "residual_relative": 5e-11,
}


def promising(run, *expect):
    return replace(run, scene=replace(run.scene, expect=expect), energy=LEDGER, wall=0.5, worst_penetration=3e-10)


@pytest.mark.parametrize("run", [lever_run(40), lever_run(1), disc_run(), slide_run()], ids=["lever", "short", "disc", "slide"])
def test_every_promised_name_is_there_and_it_is_json(run):
    numbers = summary(run)
    assert set(PROMISED) <= set(numbers)
    assert set(numbers["energy"]) == set(LEDGER)
    assert json.loads(json.dumps(numbers, allow_nan=False)) == numbers
    assert run.scene.title in summary_text(run)


def test_numbers_of_a_ticking_watch():
    run = promising(lever_run(40))
    numbers = summary(run)
    assert numbers["amplitude_deg"] == pytest.approx(270.0) and numbers["rate_s_per_d"] == pytest.approx(0.0, abs=1e-6)
    assert numbers["vph"] == pytest.approx(28800.0) and numbers["frequency_hz"] == pytest.approx(4.0)
    assert (numbers["missed_beats"], numbers["beats"], numbers["stopped"], numbers["stop"]) == (0, 39, False, "DURATION")
    assert numbers["realtime_factor"] == pytest.approx(10.0) and numbers["window_s"] == pytest.approx([10.0 / 3.0, 5.0])
    assert numbers["timegrapher"]["amplitude_deg"] == pytest.approx(289.2, abs=0.5)
    # Out of a beat: pin, 2 of the impulse, 2 of the lock, banking; 40 beats.
    assert numbers["impacts"] == 240 and numbers["events_by_kind"]["turn"] == 40


def test_final_states():
    disc = summary(disc_run())["bodies"]["disc"]
    pull = 9.81 * math.sin(math.radians(20.0)) / 1.5
    assert disc["x_m"] == pytest.approx(4.5 * pull) and disc["x_m_per_s"] == pytest.approx(3.0 * pull)
    assert disc["angle_rad"] == pytest.approx(-90.0 * pull) and disc["angle_rad_per_s"] == pytest.approx(-60.0 * pull)
    assert disc["y_m"] == pytest.approx(0.05) and disc["y_m_per_s"] == pytest.approx(0.0, abs=1e-12)
    slider = summary(slide_run())["bodies"]["slider"]
    assert slider["x_m"] == pytest.approx(1e-3 + 2e-3 * math.sin(10.0) * math.sqrt(0.5))
    assert slider["y_m_per_s"] == pytest.approx(2e-2 * math.cos(10.0) * math.sqrt(0.5)) and slider["angle_rad_per_s"] == 0.0
    assert summary(disc_run())["bodies"]["plane"]["x_m_per_s"] == 0.0


def test_expectations_are_judged():
    run = promising(
        lever_run(40),
        Expectation("amplitude", 270.0, 1.0, "°"),
        Expectation("rate", 5.0, 1.0, "s/d"),
        Expectation("rte", 0, 1, ""),
    )
    kept, missed, unknown = summary(run)["expect"]
    assert kept["ok"] and not missed["ok"] and not unknown["ok"] and 'Did you mean "rate"?' in unknown["message"]
    assert expected_text(kept) == "amplitude = 270° ± 1°, got 270°"
    assert expected_text(unknown).startswith('rte = 0 ± 1, but "rte" is not a number in the results.')


def test_text_of_a_watch():
    lines = summary_text(promising(lever_run(40), Expectation("amplitude", 260.0, 1.0, "°"))).splitlines()
    assert lines[0] == "Made lever"
    text = "\n".join(lines)
    for part in (
        *("amplitude    270.000000°, scatter", "rate         0 s/d", "28800.00 vph, averaged from 3.333 s to 5 s"),
        *(
            "would show 289°, 0.0 s/d, 0.00 ms with a lift angle of 52°",
            "none in 39 half swings",
            "240, 48 per second",
            "overlapped by up to 300 pm",
        ),
        *("2 µJ put in, 400 nW: friction 25.0 %, damping 50.0 %, impacts 20.0 %, stored 5.0 %", "closes to 5e-11"),
        *("10 × real time, 0.5 s", "amplitude = 260° ± 1°, got 270°: MISSED"),
    ):
        assert part in text, part


def test_text_of_a_watch_that_stopped():
    text = summary_text(promising(lever_run(20, missed=range(10, 20))))
    stopped = next(line for line in text.splitlines() if line.startswith("  verdict"))
    # The run ends at a turning point, which is not to be taken for a held balance.
    assert (
        stopped.startswith("  verdict      t = 1.19")
        and "the watch stands: the escape wheel has stood still since t = 1.19" in stopped
    )
    assert "balance swinging, now at −270°; last amplitude 270°; in contact: wheel.TEETH corner 3" in stopped
    assert "missed beats 10 in 19 half swings: half pitches the wheel fell short or ran ahead" in text


def test_text_of_a_watch_that_jams():
    """The balance stays where it is in the middle of the run."""
    ticking = lever_run(20)
    early = ticking.t < 1.3
    t = np.append(ticking.t[early], np.linspace(1.3, 2.5, 400))
    q, u, a = (
        np.concatenate([x[early], np.repeat(x[early][-1:] * keep, 400, 0)])
        for x, keep in zip((ticking.q, ticking.u, ticking.a), (1, 0, 0), strict=True)
    )
    run = replace(ticking, t=t, q=q, u=u, a=a, events=ticking.events[ticking.events["t"] < 1.3])
    numbers = summary(run)
    assert (
        numbers["stopped"]
        and "balance held at" in numbers["stopped_message"]
        and "−91.81° since t = 1.29" in numbers["stopped_message"]
    )


def test_where_a_spring_only_presses_it_is_said_where_all_are_at_the_end():
    """A finger moved as the scene says, a star, and its jumper: nothing keeps time."""
    run = ws.simulate(ws.load(ws.profiles_dir() / "jumper"), 0.3)
    text, bodies = summary_text(run), summary(run)["bodies"]
    for name in ("finger", "star", "jumper"):
        angle = f"{round(math.degrees(bodies[name]['angle_rad']), 3) + 0.0:.3f}".replace("-", "−")
        assert f"  {name:13}at {angle}° at the end" in text


def test_text_of_other_things():
    text = summary_text(disc_run())
    assert "frequency" not in text and "disc         at (10065.6528, 50.0000) mm, −11534.388° at the end" in text
    assert "by less than 0.001 nm" in text
    given_up = replace(lever_run(1), stop=Stop.LCP_FAILED, counts={"lcp_failures": 1})
    assert "1 had no solution" in summary_text(given_up)


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (275.321, 0.1, "275.3°, scatter 0.1°"),
        (-4.88, 0.03, "−4.88°, scatter 0.03°"),
        (290.732, 0.0007, "290.7320°, scatter 0.0007°"),
        (285.2, 2.1, "285°, scatter 2°"),
        (1.5, 0.0, "1.500000°, scatter 0.000001°"),
        (1.5, 1e-12, "1.500000°, scatter 0.000001°"),
        (-1e-9, 0.1, "0.0°, scatter 0.1°"),
        (1e-9, 1e-12, "below 0.000001°"),
        (0.0, 0.0, "0°"),
        (3.0, None, "3.000°"),
    ],
)
def test_numbers_show_what_is_sure(value, error, text):
    assert with_scatter(value, error, "°") == text


def test_a_swing_that_dies_out_is_not_called_driven():
    """Nothing drives it, nothing touches: the energy was there at the start, and no contact problem was solved."""
    free = replace(lever_run(20), energy={**LEDGER, "in_J": 0.0, "stored_J": -2e-6, "dissipated": {"damping": 2e-6}}, counts={})
    text = summary_text(free)
    assert "2 µJ taken from what was stored at the start, 800 nW: damping 100.0 %" in text and "put in" not in text
    assert "there was no contact problem to solve" in text
    both = replace(free, energy={**free.energy, "in_J": 1e-6})
    assert "3 µJ put in or taken from what was stored" in summary_text(both)


def test_doubtful_runs_say_so():
    run = lever_run(20)
    assert summary(run)["warnings"] == [] and "WARNING" not in summary_text(run)
    coarse = replace(run, method=MOREAU, step=50e-6, worst_penetration=74e-6)
    (warning,) = summary(coarse)["warnings"]
    assert "the step of 50 µs is too coarse: bodies overlapped by 74 µm" in warning and '--step "10 µs"' in warning
    assert "  WARNING      the step of 50 µs" in summary_text(coarse)
    fine = replace(coarse, worst_penetration=1e-3 * scene_size(run.scene))
    assert summary(fine)["warnings"] == []
    unsolved = summary_text(replace(run, worst_residual=0.989, counts={"lcp": 3}))
    assert "3 contact problems, the worst left with a residual of 0.99" in unsolved and "solved to" not in unsolved
    assert "WARNING      a contact problem was left with a residual of 0.99" in unsolved


def test_energy_shares_sum_to_one():
    run = promising(disc_run())
    run = replace(run, scene=replace(run.scene, gravity=(0.0, 0.0)))
    assert sum(energy_shares(run).went_to.values()) == pytest.approx(1.0)
    running_down = replace(run, energy={**LEDGER, "in_J": 0.0, "stored_J": -1.9e-6})
    shares = energy_shares(running_down)
    assert shares.supplied == pytest.approx(1.9e-6) and sum(shares.went_to.values()) == pytest.approx(1.0)
    lifting = replace(run, energy={**LEDGER, "in_J": -1e-6, "stored_J": -2.9e-6})
    assert energy_shares(lifting).went_to["given back to the drive"] == pytest.approx(1.0 / 2.9)
    assert energy_shares(replace(run, energy={})).went_to == {}


def test_tables_of_a_results_folder():
    made = tables(lever_run(6))
    assert set(made) == {"beats.csv", "phases.csv"} and all(str(text).endswith("\n") for text in made.values())
    assert tables(disc_run()) == {}


# Do the first lines that a watchmaker reads say what the numbers say, in his units?


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


@pytest.mark.parametrize(
    ("expected", "tolerance", "got", "text"),
    [
        (12.0, 1.0, 12.3456, "12.35"),
        (123.0, 1.0, -123.456, "−123.46"),
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


# From which residual and which overlap on is a run doubted, and which step is proposed?

SCENE = ws.load(ws.profiles_dir() / "incline")
DEEP = 0.005 * scene_size(SCENE)


def said(residual: float = 0.0, overlap: float = 0.0, step: float | None = 20e-6, method: str = MOREAU) -> list[str]:
    values = {"worst_residual": residual, "worst_penetration": overlap, "step": step, "method": method}
    run: Any = SimpleNamespace(scene=SCENE, **values)
    return list(doubts(run))


@pytest.mark.parametrize("overlap", [0.0, 0.99 * DEEP])
def test_small_ones_are_passed_over(overlap: float) -> None:
    assert said(0.99e-6, overlap) == []


def test_each_is_said_with_its_number() -> None:
    (unsolved,) = said(residual=1.01e-6)
    assert unsolved.startswith("a contact problem was left with a residual of 1e-06 of its largest term")
    (coarse,) = said(overlap=1.01 * DEEP)
    assert coarse.startswith(f"the step of 20 µs is too coarse: bodies overlapped by {1.01e6 * DEEP:.2g} µm.")
    assert '--step "4 µs"' in coarse
    assert len(said(1.0, 1.0)) == 2


def test_only_fixed_steps_are_too_coarse() -> None:
    assert said(overlap=1.0, method="pfeiffer-glocker") == said(overlap=1.0, step=None) == []


# What does a second, more exact run say of the numbers of the first?


def numbers(rate: float, scatter: float | None, stop: str = "DURATION") -> dict[str, Any]:
    empty = dict.fromkeys((*NUMBERS, *(f"{name}_error" for name in NUMBERS)))
    said = {"method": "pfeiffer-glocker", "tolerance": 1e-9, "step_s": None, "stop": stop, "wall_s": 1.0}
    return {**empty, **said, "rate_s_per_d": rate, "rate_s_per_d_error": scatter, "bodies": {"balance": {"angle_rad": rate}}}


def test_the_larger_of_scatter_and_difference_is_given() -> None:
    assert with_error_bars(numbers(5.0, 0.5), numbers(5.25, 0.0))["rate_s_per_d_error"] == 0.5
    assert with_error_bars(numbers(5.0, 0.125), numbers(5.25, 0.0))["rate_s_per_d_error"] == 0.25


def test_a_scatter_that_nobody_knows_is_not_called_small() -> None:
    out = with_error_bars(numbers(5.0, None), numbers(5.25, None))
    assert out["rate_s_per_d_error"] is None and out["error_bars"]["differences"] == {"rate_s_per_d": 0.25}
    assert out["bodies"]["balance"]["angle_rad_error"] == 0.25


def test_a_second_run_that_gave_up_says_nothing() -> None:
    out = with_error_bars(numbers(5.0, 0.5), numbers(6.0, 0.5, stop="LCP_FAILED"))
    assert out["rate_s_per_d_error"] == 0.5 and out["error_bars"]["complete"] is False


def test_half_the_step_leaves_half_the_error_of_the_first_order() -> None:
    """What is still to come after halving is as much again."""
    first, second = ({**numbers(rate, 0.0), "method": MOREAU} for rate in (5.0, 5.25))
    assert with_error_bars(first, second)["rate_s_per_d_error"] == 0.5


def test_what_only_one_of_the_runs_gives_has_no_error() -> None:
    known, unknown = numbers(5.0, 0.5), {**numbers(5.0, 0.5), "rate_s_per_d": None}
    for first, second in ((known, unknown), (unknown, known)):
        out = with_error_bars(first, second)
        assert out["error_bars"]["differences"] == {} and out["rate_s_per_d_error"] == 0.5
