"""Do the plots of a beat show what the run and its tables hold?"""

from __future__ import annotations

import csv
import dataclasses
import io
import math

import numpy as np
import pytest
from every_time import few
from matplotlib.patches import Rectangle
from render.figures.read_back import area_of, faults, named, svg_curve, width_mm

import watchsim as ws
from watchsim.analysis.energy import energy_shares
from watchsim.analysis.headlines import phases_csv
from watchsim.analysis.timeline import shown_beats, title
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.render import force_plot
from watchsim.render import timeline_plot as key_instants
from watchsim.render.force_plot import Curves, left_out
from watchsim.render.marks import clock
from watchsim.render.style import passing
from watchsim.render.torque_plot import pushes, torque_on
from watchsim.scene.scene import Body, Scene


@pytest.fixture(scope="module")
def run() -> ws.Trajectory:
    return ws.simulate(ws.load(ws.profiles_dir() / "bench_lever"), duration=1.0)


@pytest.fixture(scope="module")
def rows(run: ws.Trajectory) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO("".join(phases_csv(run, ws.beats(run))))))


PLOTS = {
    "kinematics": ws.plot_kinematics,
    "phases": ws.plot_phases,
    "timeline": ws.plot_timeline,
    "portrait": ws.plot_phase_portrait,
    "torque": ws.plot_torque,
    "forces": ws.plot_forces,
    "energy": ws.plot_energy,
    "timing": ws.plot_timing,
    "tape": ws.plot_tape,
}


@pytest.mark.parametrize("kind", PLOTS)
def test_every_plot_is_as_wide_as_asked_and_cuts_no_word(run: ws.Trajectory, kind: str) -> None:
    figure = PLOTS[kind](run, width=85.0)
    assert width_mm(figure) == pytest.approx(85.0)
    assert faults(figure) == []


@pytest.mark.parametrize("kind", few(PLOTS, lambda kind: kind in ("timeline", "energy")))
def test_every_plot_fills_a_page_and_is_written_as_vectors(run: ws.Trajectory, kind: str, tmp_path) -> None:
    from watchsim.render.style import save

    figure = PLOTS[kind](run, width=170.0)
    assert width_mm(figure) == pytest.approx(170.0)
    assert faults(figure) == []
    assert kind != "kinematics" or figure._repr_png_().startswith(b"\x89PNG")
    for form in ("svg", "pdf") if kind in ("kinematics", "timeline") else ("pdf",):
        save(figure, tmp_path / f"plot.{form}")
        first = (tmp_path / f"plot.{form}").read_bytes()
        assert first.startswith(b"%PDF" if form == "pdf" else b"<?xml")
        assert form == "svg" or b"/Type3" not in first  # fonts that printers refuse


def test_areas_of_torque_are_the_energies_of_phases_csv(run: ws.Trajectory, rows: list[dict[str, str]]) -> None:
    figure = ws.plot_torque(run)
    told = shown_beats(run)[-2:]
    panels = [axes for axes in figure.axes if axes.collections]
    assert len(panels) == 2
    for axes, beat, found in zip(panels, told, pushes(run, told), strict=True):
        own = {row["phase"] + row["on"]: row for row in rows if int(row["beat"]) == beat.stages[0].beat}
        words = [text.get_text() for text in axes.texts]
        largest = max(abs(one.stage.energy.to_balance) for one in found)
        for one, filled in zip(found, axes.collections, strict=True):
            assert filled.get_gid() == f"area {title(one.stage)}"
            drawn = 1e-9 * math.radians(1.0) * area_of(filled) * (1.0 if axes.get_ylabel() == "torque (nN·m)" else 1e3)
            row = own[one.stage.name + one.stage.phase.on]
            whole = float(row["to_balance_J"])
            drawn *= one.way
            assert drawn == pytest.approx(one.forces, abs=1e-6 * largest)
            # Two ways that share nothing: forces at the contacts and jumps, and the books of the balance.
            assert drawn + one.impacts == pytest.approx(whole, abs=2e-4 * largest)
            assert f"{round(1e9 * whole, 2) + 0.0:.2f}".replace("-", "−") in words
            if abs(whole) > 0.1 * largest:
                assert f"{1e9 * whole:+.1f} nJ".replace("-", "−") in words
        assert sum(one.stage.energy.to_balance for one in found) > 0.0
        assert own["unlock"]["to_balance_J"].startswith("-")


def test_the_torque_is_what_accelerates_the_balance(run: ws.Trajectory) -> None:
    beat = shown_beats(run)[-1]
    stage = next(one for one in beat.stages if one.name == "impulse")
    times = np.linspace(stage.phase.start, stage.phase.end, 42)[1:-1]
    column = run.slices["balance"].start
    (spring,), (damper,) = run.scene.springs, run.scene.damping
    inertia = run.scene.body("balance").inertia
    q, u = run.sample(times)
    needed = inertia * run.acceleration(times)[:, column] + spring.stiffness * (q[:, column] - spring.rest)
    needed = needed + damper.viscous * u[:, column]
    told = torque_on(run, "balance", times)
    assert np.abs(told).max() > 0.0
    assert np.median(np.abs(told - needed)) < 1e-3 * np.abs(told).max()


def test_bars_are_the_shares_of_the_account(run: ws.Trajectory) -> None:
    figure = ws.plot_energy(run)
    shares = energy_shares(run)
    for name, share in shares.went_to.items():
        _, bar = named(figure, f"energy {name}")
        assert isinstance(bar, Rectangle) and bar.get_width() == pytest.approx(100.0 * share)
    axes = figure.axes[1]
    for stage in (one for one in shown_beats(run)[-2].stages if one.name != "locked"):
        parts = ("stored", "damping", "friction", "impacts")
        widths = {name: next(b for b in axes.patches if b.get_gid() == f"energy {title(stage)} {name}") for name in parts}
        assert sum(bar.get_width() for bar in widths.values()) == pytest.approx(1e9 * stage.energy.supplied, abs=1e-3)
        # What is left of the account where nothing rubs is rounding: nJ.
        assert widths["friction"].get_width() == pytest.approx(1e9 * stage.energy.friction, rel=1e-6, abs=1e-12)
        assert widths["impacts"].get_width() == pytest.approx(1e9 * sum(stage.energy.impacts.values()))


def test_forces_are_those_of_the_contacts(run: ws.Trajectory) -> None:
    figure = ws.plot_forces(run, window=(0.5, 0.62))
    axes, line = named(figure, "force wheel-lever normal")
    x, y = line.get_data()
    time = clock((0.5, 0.62))
    told = ws.forces(run, time.base + x[::25] / time.factor)
    mine = [k for k, i in enumerate(told.pairs) if {run.pairs[i].body_a, run.pairs[i].body_b} == {"wheel", "lever"}]
    factor = {"N": 1.0, "mN": 1e3, "µN": 1e6}[axes.get_ylabel().split("(")[1].rstrip(")")]
    assert y[::25] == pytest.approx(factor * told.normal[:, mine].sum(axis=1), abs=2e-3 * y.max())
    _, bearing = named(figure, "force bearings balance")
    assert np.max(bearing.get_ydata()) > 0.0


def test_a_window_with_too_many_instants_is_refused(run: ws.Trajectory, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("watchsim.render.force_plot.MOST", 300)
    with pytest.raises(ValueError, match="choose a shorter window"):
        ws.plot_forces(run, window=(0.1, 0.9))


def test_the_portrait_passes_through_the_states_of_the_run(run: ws.Trajectory) -> None:
    figure = ws.plot_phase_portrait(run, window=(0.4, 0.7))
    _, line = named(figure, "lever portrait")
    x, y = line.get_data()
    column = run.slices["lever"].start
    own = (run.t > 0.4) & (run.t < 0.7)
    for values, drawn in ((run.q, x), (run.u, y)):
        shown = np.degrees(values[own, column])
        assert drawn.max() == pytest.approx(shown.max(), abs=1e-3 * np.ptp(shown))
        assert drawn.min() == pytest.approx(shown.min(), abs=1e-3 * np.ptp(shown))


def test_the_curve_in_the_file_is_that_of_the_run(run: ws.Trajectory) -> None:
    figure = ws.plot_kinematics(run, ["balance"], ["angle", "velocity"], window=(0.2, 0.6))
    for k, name in enumerate(("angle", "velocity")):
        axes = figure.axes[k]
        x, y = svg_curve(figure, axes, f"balance {name}")
        exact = np.degrees(run.sample(1e-3 * x)[k][:, run.slices["balance"].start])
        assert len(x) > 50
        assert y == pytest.approx(exact, abs=2e-3 * np.ptp(exact))  # SVG carries six decimals of a point; x is rounded too


def test_phases_are_shaded_when_they_are(run: ws.Trajectory) -> None:
    window = (0.4, 0.7)
    figure = ws.plot_kinematics(run, ["lever"], ["angle"], window)
    shaded = sorted((band.get_x(), band.get_x() + band.get_width()) for band in figure.axes[0].patches)
    expected = sorted(
        (1e3 * (phase.start - 0.0), 1e3 * (phase.end - 0.0))
        for beat in passing(run, window)
        for phase in beat
        if phase.name != "locked"
    )
    base = expected[0][0] - shaded[0][0]  # the plot counts from a round time
    assert len(shaded) == len(expected) > 5
    assert np.array(shaded) + base == pytest.approx(np.array(expected), abs=1e-6)
    words = {text.get_text() for text in figure.texts}
    assert {"unlock", "impulse", "drop"} <= words
    assert ws.plot_kinematics(run).axes[0].patches == [] or len(passing(run, (0.0, 1.0))) <= 12


def test_dots_of_timing_are_the_beats(run: ws.Trajectory) -> None:
    figure, found = ws.plot_timing(run), ws.beats(run)
    for name, values in (("amplitude", found.amplitude_deg), ("rate", found.rate_s_per_d), ("beat error", found.beat_error_ms)):
        dots = [named(figure, f"{name} {way}")[1].get_data() for way in ("forward", "back")]
        t, y = np.concatenate([one[0] for one in dots]), np.concatenate([one[1] for one in dots])
        for (ours, _), forward in zip(dots, (True, False), strict=True):
            assert ours == pytest.approx(found.t[(found.end_at > found.start_at) == forward])
        order = np.argsort(t)
        assert t[order] == pytest.approx(found.t) and y[order] == pytest.approx(values, nan_ok=True)


def test_pictures_stand_at_the_middle_of_each_phase(run: ws.Trajectory) -> None:
    figure = ws.plot_timeline(run)
    beats_shown = shown_beats(run)[-2:]
    pictures = [axes for axes in figure.axes if not len(axes.get_xticks())]
    phases = [one for beat in beats_shown for one in beat.stages if one.name != "locked"]
    assert len(pictures) == len(phases) + len(beats_shown)
    words = [text.get_text() for text in figure.texts]
    assert any("unlock" in text for text in words) and any("at rest" in text for text in words)
    lever = [axes.lines[0] for axes in figure.axes if axes.lines and axes.lines[0].get_gid() == "angle lever"]
    for line, beat in zip(lever, beats_shown, strict=True):
        x, y = line.get_data()
        exact = np.degrees(run.sample(beat.start + 1e-3 * x)[0][:, run.slices["lever"].start])
        assert y == pytest.approx(exact, abs=1e-6)


def test_pictures_of_a_tall_lever_show_all_of_it(
    run: ws.Trajectory, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def scales(tallest: float) -> tuple[np.ndarray, np.ndarray]:
        monkeypatch.setattr(key_instants, "TALLEST", tallest)
        figure = ws.plot_timeline(run)
        assert faults(figure) == []
        axes = figure.axes[0]
        size = axes.get_position().size * figure.get_size_inches()
        assert np.ptp(axes.get_xlim()) / size[0] == pytest.approx(np.ptp(axes.get_ylim()) / size[1])
        return np.array([axes.get_xlim(), axes.get_ylim()]), size

    whole, size = scales(10.0)
    low, lower = scales(0.3)
    assert lower[1] < size[1]
    assert np.all(low[:, 0] <= whole[:, 0] + 1e-9) and np.all(low[:, 1] >= whole[:, 1] - 1e-9)
    assert caplog.messages == []


def test_a_run_without_an_escapement_has_the_plots_that_need_none() -> None:
    disc = ws.simulate(ws.load(ws.profiles_dir() / "incline"), duration=0.5)
    for draw in (ws.plot_kinematics, ws.plot_phase_portrait, ws.plot_forces, ws.plot_energy):
        for width in (170.0, 85.0):
            assert faults(draw(disc, width=width)) == []
    for draw in (ws.plot_torque, ws.plot_timeline, ws.plot_phases, ws.plot_timing):
        with pytest.raises(ValueError):
            draw(disc)


def test_bearings_of_geared_bodies_say_what_is_left_out() -> None:
    profiles = ws.profiles_dir()
    tourbillon = ws.load(profiles / "tourbillon")
    assert left_out(tourbillon) == ""
    assert left_out(dataclasses.replace(tourbillon, rigid_gears=())) == ", without gears"  # as a scene made in Python may be
    assert left_out(ws.load(profiles / "swiss_lever")) == ""


def test_beats_side_by_side_have_forces_in_one_unit(run: ws.Trajectory, monkeypatch: pytest.MonkeyPatch) -> None:
    made, told = force_plot.curves, []

    def unequal(run: ws.Trajectory, spans: object) -> list[Curves]:
        """The first beat with a thousandth of the forces."""
        first, second = made(run, spans)  # type: ignore[arg-type]
        first = dataclasses.replace(first, normal={name: 1e-3 * values for name, values in first.normal.items()})
        told.extend((first, second))
        return told

    monkeypatch.setattr(force_plot, "curves", unequal)
    figure = ws.plot_forces(run)
    lines = [line for axes in figure.axes for line in axes.lines if line.get_gid() == "force wheel-lever normal"]
    drawn = [np.max(line.get_ydata()) for line in lines]
    largest = [one.normal["wheel-lever"].max() for one in told]
    assert drawn[0] / drawn[1] == pytest.approx(largest[0] / largest[1], rel=1e-6)
    assert drawn[1] > 1.0


@pytest.mark.parametrize("count", [2, 6, 12])
def test_the_names_of_many_bearings_stand_above_their_panel(count: int) -> None:
    bodies = tuple(
        Body(f"wheel_{k}", "pivot", (k, 0.0), 0.0, (1.0,), mass=1.0, inertia=0.1, centre_of_mass=(0.1, 0.0))
        for k in range(count)
    )
    run = ws.simulate(Scene("wheels", bodies), 0.1)
    for width in (170.0, 85.0):
        figure = ws.plot_forces(run, width=width)
        assert faults(figure) == []
        assert {text.get_text() for text in figure.axes[0].get_legend().get_texts()} == {body.name for body in bodies}


def test_a_load_that_hardly_changes_is_not_magnified() -> None:
    run = ws.simulate(ws.load(ws.profiles_dir() / "governor"), duration=0.2)
    for width in (170.0, 85.0):
        figure = ws.plot_forces(run, width=width)
        assert faults(figure) == []
        axes, line = named(figure, "force bearings drum")
        values = np.asarray(line.get_ydata())
        assert 0.0 < np.ptp(values) < 1e-3 * values.max() < np.ptp(axes.get_ylim())
        assert axes.get_ylim()[0] < values.min() and values.max() < axes.get_ylim()[1]


@pytest.mark.parametrize("speed", [0.0, 1e-13])
def test_a_body_at_rest_but_for_rounding_is_a_point_in_its_portrait(speed: float) -> None:
    ring = (Line(-1.0, -1.0, 1.0, -1.0), Line(1.0, -1.0, 0.0, 1.0), Line(0.0, 1.0, -1.0, -1.0))
    still, turning = (
        Body(name, "pivot", (place, 0.0), 0.3, (velocity,), mass=0.0, inertia=0.1, loops=(Loop(ring),))
        for name, place, velocity in (("still", 0.0, speed), ("turning", 5.0, 2.0))
    )
    run = ws.simulate(Scene("turning", (still, turning)), 1.0)
    for width in (170.0, 85.0):
        figure = ws.plot_phase_portrait(run, width=width)
        assert faults(figure) == []
        axes, point = named(figure, "still at rest")
        assert point.get_xydata() == pytest.approx(np.array([[np.degrees(0.3), 0.0]]), abs=1e-9)
        assert all(np.ptp(ends) > 9e-5 for ends in (axes.get_xlim(), axes.get_ylim()))
        with pytest.raises(KeyError):
            named(figure, "turning at rest")
