"""Do the plots of a beat show what the run and its tables hold?"""

import csv
import dataclasses
import io
import itertools
import math
from dataclasses import replace

import matplotlib
import matplotlib.image
import numpy as np
import pytest
from every_time import few
from matplotlib.colors import rgb_to_hsv, to_rgb
from matplotlib.patches import Rectangle
from render.fake_runs import disc_run, slide_run, watch_run
from render.read_back import area_of, faults, named, svg_curve, width_mm

import watchsim as ws
from watchsim.analysis.flows import energy_shares
from watchsim.analysis.headlines import phases_csv
from watchsim.analysis.timeline import shown_beats, title
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.render import force_plot
from watchsim.render import phase_plots as key_instants
from watchsim.render.energy_plot import pushes, torque_on
from watchsim.render.force_plot import Curves, left_out
from watchsim.render.kinematics_plot import Kinematics, plot_kinematics, write_png
from watchsim.render.marks import clock
from watchsim.render.palette import looks
from watchsim.render.parts import parts
from watchsim.render.rows import envelope
from watchsim.render.style import ShownFigure, passing, with_room
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


@pytest.mark.parametrize("kind", PLOTS)
def test_a_plot_takes_the_place_of_some_axes_and_leaves_the_rest_alone(run: ws.Trajectory, kind: str) -> None:
    """All that is drawn lies in the left half, and holds as many panels and words as in a figure of its own."""
    whole = ShownFigure(figsize=(14.0, 8.0))
    ours, theirs = whole.subplots(1, 2)
    part, alone = PLOTS[kind](run, ax=ours), PLOTS[kind](run)
    assert ours not in whole.axes and theirs in whole.axes and part.figure is whole
    assert len(part.axes) == len(alone.axes) == len(whole.axes) - 1
    assert [text.get_text() for text in part.texts] == [text.get_text() for text in alone.texts]
    drawn = [panel.get_position().transformed(part.transSubfigure - whole.transFigure) for panel in part.axes]
    assert all(0.0 <= box.x0 < box.x1 <= theirs.get_position().x0 for box in drawn)


def test_axes_that_lie_in_no_grid_are_refused(run: ws.Trajectory) -> None:
    with pytest.raises(ValueError, match="axes of a grid"):
        ws.plot_timing(run, ax=ShownFigure().add_axes((0.1, 0.1, 0.8, 0.8)))


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
    monkeypatch.setattr("watchsim.render.force_plot.MOST_INSTANTS", 300)
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
    assert {"unlock", "impulse on stone", "drop"} <= words
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


@pytest.mark.slow
def test_each_column_of_a_long_record_keeps_its_first_last_least_and_largest_dot() -> None:
    """1500 columns divide the time of a panel evenly: by plain counting, one column after the other."""
    scene = ws.load(ws.profiles_dir() / "balance").set("damping.0.q_factor", 5000.0)
    run = ws.simulate(scene, duration=2500.0)
    figure, found = ws.plot_timing(run), ws.beats(run)
    own = np.flatnonzero(found.end_at > found.start_at)
    t, y = found.t[own], found.amplitude_deg[own]
    assert len(t) > 6000
    place = np.minimum(np.floor(1500 * (t - t[0]) / (t[-1] - t[0])), 1499)
    expected = set()
    for k in range(1500):
        inside = np.flatnonzero(place == k)
        expected |= {t[i] for i in (inside[0], inside[-1], inside[np.argmin(y[inside])], inside[np.argmax(y[inside])])}
    assert set(named(figure, "amplitude forward")[1].get_data()[0]) == expected


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


@pytest.mark.parametrize(("profile", "name", "way"), [("jumper", "finger", -1.0), ("geneva", "driver", 1.0)])
def test_the_torque_of_a_drive_stands_over_its_angle(profile: str, name: str, way: float) -> None:
    """The finger of a calendar turns clockwise: its torque is drawn with its motion, and time runs to the right."""
    run = ws.simulate(ws.load(ws.profiles_dir() / profile), duration=2.0)
    figure = ws.plot_torque(run)
    assert faults(figure) == []
    (axes,) = figure.axes
    (curve,) = (line for line in axes.lines if line.get_gid() == f"drive {name}")
    angle, torque = np.radians(np.asarray(curve.get_xdata())), 1e-6 * np.asarray(curve.get_ydata())
    left, right = axes.get_xlim()
    assert axes.get_ylabel() == "torque (µN·m)" and (right - left) * way > 0.0
    instants = np.linspace(0.3, 0.9, 40)  # of the contacts there; the pin is driven evenly
    there = np.interp(instants, (angle - angle[0]) / (angle[-1] - angle[0]) * 2.0, torque)
    assert there == pytest.approx(-way * torque_on(run, name, instants), abs=1e-3 * torque.max())
    if profile == "geneva":  # blows on the pin of a finger do work, too; here they do hardly any
        work = float(np.sum(0.5 * (torque[1:] + torque[:-1]) * np.diff(angle)))
        assert work == pytest.approx(energy_shares(run).supplied, rel=1e-3)


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
        assert {text.get_text() for text in figure.axes[0].get_legend().get_texts()} == {
            body.name.replace("_", " ") for body in bodies
        }


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


def curves(figure):
    """(title, y label, x data, y data) of every curve, in reading order."""
    return [
        (axes.get_title(loc="left"), axes.get_ylabel(), *line.get_data()) for axes in figure.axes for line in axes.get_lines()
    ]


def test_one_panel_per_moving_body_and_quantity_in_degrees():
    shown = curves(plot_kinematics(watch_run(), window=(0.2, 0.8)))
    assert [(title, label) for title, label, _, _ in shown] == [
        (body, quantity) for body in ("wheel", "lever", "balance") for quantity in ("angle (°)", "angular velocity (°/s)")
    ]
    x, angle = shown[4][2:]
    assert (x[0], x[-1]) == pytest.approx((200.0, 800.0))  # ms
    assert angle == pytest.approx(np.degrees(5.0 * np.cos(0.025 * x)), abs=1e-6)
    x, velocity = shown[5][2:]
    assert velocity == pytest.approx(np.degrees(-125.0 * np.sin(0.025 * x)), abs=1e-3)


def test_the_jump_of_an_impact_is_a_jump():
    _, _, x, velocity = curves(plot_kinematics(watch_run(), ["lever"], ["velocity"], (0.9, 1.1)))[0]
    jump = np.flatnonzero(np.diff(x) == 0.0)
    assert len(jump) == 1
    assert velocity[jump[0] + 1] - velocity[jump[0]] == pytest.approx(math.degrees(4.0))


def test_free_and_sliding_bodies_in_millimetres():
    disc = curves(plot_kinematics(disc_run()))
    assert [label for _, label, _, _ in disc] == [
        *("position (mm)", "position (mm)", "velocity (mm/s)", "velocity (mm/s)"),
        *("angle (°)", "angular velocity (°/s)"),
    ]
    pull = 9.81 * math.sin(math.radians(20.0)) / 1.5
    assert disc[0][3][-1] == pytest.approx(1e3 * 0.5 * pull * 9.0)
    assert disc[1][3][-1] == pytest.approx(50.0)
    assert disc[5][3][-1] == pytest.approx(-math.degrees(pull * 3.0 / 0.05))
    assert curves(plot_kinematics(slide_run(), quantities="angle"))[0][1] == "travel (mm)"  # from its position, not where it is
    slide = curves(plot_kinematics(slide_run(), quantities="velocity"))
    assert slide[0][1] == "velocity (mm/s)"
    assert slide[0][3][0] == pytest.approx(20.0)


def test_unknown_names_are_refused_with_the_choices():
    run = watch_run()
    with pytest.raises(ValueError, match="'lver'; there are: wheel, lever, balance"):
        plot_kinematics(run, bodies=["lver"])
    with pytest.raises(ValueError, match="'speed'; choose from angle, velocity"):
        plot_kinematics(run, quantities=["angle", "speed"])
    with pytest.raises(ValueError, match="0 s to 2 s was recorded"):
        plot_kinematics(run, window=(19.4, 19.75))


def test_axes_say_which_time_they_show():
    run = watch_run()
    assert plot_kinematics(run).axes[-1].get_xlabel() == "time (s)"
    assert plot_kinematics(run, window=(0.2, 0.5)).axes[-1].get_xlabel() == "time (ms)"
    assert plot_kinematics(run, window=(1.4, 1.75)).axes[-1].get_xlabel() == "time after 1.4 s (ms)"
    assert clock((1.4, 1.4005)).label == "time after 1.4 s (µs)"


@pytest.mark.parametrize("window", few([(0.0, 0.9), (0.0, 2.0), (0.5, 0.5001), (0.3, 0.31)], 2))
def test_tick_labels_tell_the_value_at_the_tick(window):
    run = watch_run()
    for scale in (1.0, 0.01, 0.9, 30.0):  # the lever then swings by ±5.7°, ±0.06°, ±5.2°, ±172°
        columns = {name: getattr(run, name) * np.array([1.0, scale, *np.ones(run.q.shape[1] - 2)]) for name in ("q", "u", "a")}
        run = dataclasses.replace(run, **columns)
        figure = plot_kinematics(run, ["lever"], window=window)
        figure.canvas.draw()
        for axes in figure.axes:
            offset = axes.yaxis.get_major_formatter().get_offset()
            for label in axes.get_yticklabels() if not offset else ():
                told = float(label.get_text().replace("−", "-").replace(",", ""))
                assert told == pytest.approx(label.get_position()[1], abs=1e-9), axes.get_ylabel()


def test_rounding_noise_of_a_resting_body_is_not_magnified():
    run = watch_run()
    q, still = run.q.copy(), np.zeros_like(run.q)
    q[:, 0] = 0.1 + 1e-14 * np.sin(1e3 * run.t)
    run = dataclasses.replace(run, q=q, u=still, a=still)
    low, high = plot_kinematics(run, ["wheel"], ["angle"]).axes[0].get_ylim()
    assert high - low > 1e-7


def test_figures_save_in_every_format_without_pyplot(tmp_path):
    figure = plot_kinematics(watch_run(), window=(0.4, 0.75))
    for ending, start in (("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")):
        figure.savefig(tmp_path / f"beat.{ending}")
        assert (tmp_path / f"beat.{ending}").read_bytes().startswith(start)
    assert not any(name == "matplotlib.pyplot" for name in vars(matplotlib))


def test_a_second_window_is_drawn_as_in_a_figure_of_its_own():
    kept = Kinematics(watch_run())
    for window in (None, (0.5, 0.5001), (1.4, 1.75), None):
        shown = [plot_kinematics(watch_run(), window=window), kept.show(window)]
        for figure in shown:
            figure.canvas.draw()
        first, second = (np.asarray(figure.canvas.buffer_rgba()) for figure in shown)
        assert np.array_equal(first, second), window


def test_panels_drawn_empty_before_show_a_run_as_others_do():
    """As the command makes them while a run goes on."""
    run = watch_run()
    nothing = {name: getattr(run, name)[:1] for name in ("t", "q", "u", "a")}
    panels = Kinematics(dataclasses.replace(run, **nothing))
    panels.figure.canvas.draw()
    for window in (None, (1.4, 1.75)):
        shown = [plot_kinematics(run, window=window), panels.of(run).show(window)]
        for figure in shown:
            figure.canvas.draw()
        first, second = (np.asarray(figure.canvas.buffer_rgba()) for figure in shown)
        assert np.array_equal(first, second), window


def test_the_light_png_shows_the_same_pixels(tmp_path):
    figure = plot_kinematics(watch_run(), window=(0.4, 0.75))
    figure.savefig(tmp_path / "usual.png")
    write_png(figure, tmp_path / "light.png")
    usual, light = (matplotlib.image.imread(tmp_path / f"{name}.png") for name in ("usual", "light"))
    assert np.array_equal(usual[..., :3], light)
    assert (usual[..., 3] == 1.0).all()


@pytest.mark.parametrize("window", [None, (0.5, 0.5001), (1.4, 1.75)])
@pytest.mark.parametrize("turned", few([1e4, 0.0], 1))
def test_nothing_is_clipped_and_no_words_overlap(window, turned):
    run = watch_run(title="A rather long title of a scene with an escapement in it")
    small = np.array([1e-3, 1e-6, *np.ones(run.q.shape[1] - 2)])
    columns = {name: getattr(run, name) * small for name in ("q", "u", "a")}
    columns["q"][:, 0] += turned
    run = dataclasses.replace(run, **columns)
    figure = plot_kinematics(run, window=window)
    figure.canvas.draw()
    renderer, whole = figure.canvas.get_renderer(), figure.bbox
    texts = [figure._suptitle]
    for axes in figure.axes:
        texts += [axes.xaxis.label, axes.yaxis.label, axes._left_title, axes.yaxis.get_offset_text()]
        texts += [*in_view(axes.yaxis), *(in_view(axes.xaxis) if axes in figure.axes[-2:] else ())]
    boxes = [(text.get_text(), text.get_window_extent(renderer)) for text in texts if text.get_text()]
    assert any("e5" in told for told, _ in boxes) or not turned
    for told, box in boxes:
        assert box.x0 >= whole.x0 and box.y0 >= whole.y0 and box.x1 <= whole.x1 and box.y1 <= whole.y1, told
    overlaps = [(one, other) for (one, a), (other, b) in itertools.combinations(boxes, 2) if a.overlaps(b)]
    assert not overlaps


def in_view(axis):
    """The tick labels that are drawn."""
    low, high = axis.get_view_interval()
    return [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high and tick.label1.get_visible()]


@pytest.mark.parametrize("amplitude", [250.0, 275.0, 305.0, 325.0])
def test_a_full_swing_has_ticks_at_quarter_turns(amplitude):
    run = watch_run()
    factor = math.radians(amplitude) / np.abs(run.q[:, 2]).max()
    scaled = replace(run, q=factor * run.q, u=factor * run.u, a=factor * run.a)
    panel = plot_kinematics(scaled, bodies=["balance"], quantities=["angle"]).axes[0]
    low, high = panel.get_ylim()
    assert [tick for tick in panel.get_yticks() if low <= tick <= high] == [
        tick for tick in range(-720, 721, 90) if low <= tick <= high
    ]


def test_a_body_has_one_colour_in_plot_and_movie():
    run = watch_run()
    worn = looks(run.scene)
    figure = plot_kinematics(run)
    shown = {axes.get_title(loc="left"): axes.lines[0].get_color() for axes in figure.axes}
    assert shown == {name: worn[name].line for name in run.slices}
    filled = {part.body: part.finish.fill for part in parts(run.scene, 1e-6, 1e-3) if part.finish is worn[part.body]}
    for name in run.slices:
        (hue, _, grey), (other, _, pale) = (rgb_to_hsv(to_rgb(colour)) for colour in (shown[name], filled[name]))
        assert abs(hue - other) < 0.08 and grey < pale


def test_arrows_of_forces_lie_in_their_pictures_and_have_a_scale(run: ws.Trajectory) -> None:
    figure = ws.plot_timeline(run)
    arrows = [(axes, one) for axes in figure.axes for one in axes.texts if getattr(one, "arrow_patch", None) is not None]
    (key,) = [one for one in arrows if not one[0].axison]
    for axes, arrow in arrows:
        for x, y in (arrow.xy, arrow.xyann):
            assert axes.get_xlim()[0] <= x <= axes.get_xlim()[1] and axes.get_ylim()[0] <= y <= axes.get_ylim()[1]
    # The longest arrow by the scale is the largest of the forces on the lever, worked out alone.
    instants = [one.t for beat in shown_beats(run, rubbed=False)[-2:] for one in key_instants.key_instants(beat)]
    found = ws.forces(run, instants)
    on_lever = [k for k, contact in enumerate(found.pairs) if "lever" in str(run.pairs[int(contact)])]
    largest = float(np.hypot(*np.nan_to_num(found.on_a[:, on_lever]).reshape(-1, 2).T).max())
    number, unit = next(text.get_text() for text in figure.texts if text.get_text().endswith("N")).split()
    dots = [math.dist(*axes.transData.transform((arrow.xy, arrow.xyann))) for axes, arrow in arrows]
    of_key = next(length for length, one in zip(dots, arrows, strict=True) if one is key)
    newtons = float(number) * {"N": 1.0, "mN": 1e-3, "µN": 1e-6}[unit]
    assert newtons * max(dots) / of_key == pytest.approx(max(largest, newtons), rel=1e-3)


def test_an_impulse_on_the_balance_itself_has_its_arrow_and_what_does_not_last_has_no_picture() -> None:
    """A co-axial: the wheel pushes the balance every other beat, and the lever is on its bank before the lock."""
    run = ws.simulate(ws.load(ws.profiles_dir() / "coaxial").set("run.record", "events"), duration=1.5)
    beats = shown_beats(run, rubbed=False)[-2:]
    kinds = [{stage.name for stage in beat.stages if stage.phase.end <= stage.phase.start} for beat in beats]
    figure = ws.plot_timeline(run)
    words = [text.get_text() for text in figure.texts]
    assert kinds == [{"run to banking"}] * 2 and not any("banking" in one for one in words)
    (pushed,) = (stage for beat in beats for stage in beat.stages if title(stage) == "impulse on balance")
    found = ws.forces(run, 0.5 * (pushed.phase.start + pushed.phase.end))
    pairs = [run.pairs[int(contact)] for contact in found.pairs]
    (k,) = (k for k, pair in enumerate(pairs) if {"wheel", "balance"} == {pair.body_a, pair.body_b})
    tips = [one.xy for axes in figure.axes for one in axes.texts if getattr(one, "arrow_patch", None) is not None]
    assert min(math.dist(tip, 1e3 * found.point[0, k]) for tip in tips) < 1e-9


def test_few_pictures_use_the_width_and_slow_bodies_have_degrees_per_second() -> None:
    run = ws.simulate(ws.load(ws.profiles_dir() / "graham"), duration=4.0)
    figure = ws.plot_timeline(run)
    right = max(axes.get_position().x1 for axes in figure.axes if not axes.get_xticks().size)
    assert right > 0.98
    labels = [axes.get_ylabel() for axes in ws.plot_phases(run).axes]
    assert "pendulum (°/s)" in labels
    assert ws.verdict(run).message is None or "watch" not in ws.verdict(run).message


def test_pictures_of_a_lever_that_is_carried_round_go_with_it() -> None:
    run = ws.simulate(ws.load(ws.profiles_dir() / "tourbillon"), duration=3.0)  # the carriage turns by 18°
    instants = [one.t for beat in shown_beats(run, rubbed=False)[-2:] for one in key_instants.key_instants(beat)]
    pictures = [axes for axes in ws.plot_timeline(run).axes if not axes.get_xticks().size and axes.axison]
    body = run.scene.body("lever")
    (left, right), (low, high) = pictures[0].get_xlim(), pictures[0].get_ylim()
    for t in instants:
        x, y, angle = run.pose("lever", t)
        for px, py in (loop.edges[0].point(0.0) for loop in body.loops):
            c, s = math.cos(angle), math.sin(angle)
            assert left < 1e3 * (x + c * px - s * py) < right and low < 1e3 * (y + s * px + c * py) < high


def test_what_goes_to_and_fro_too_often_is_drawn_as_its_envelope() -> None:
    t = np.linspace(0.0, 100.0, 40_001)
    swell = 1.0 + 0.5 * np.sin(0.06 * t)
    ((x, low, high),) = envelope(t, swell * np.sin(math.tau * 4.0 * t), 100.0)
    assert np.allclose(high, np.interp(x, t, swell), atol=0.02) and np.allclose(low, -high, atol=0.02)
    assert envelope(t, swell * np.sin(math.tau * 0.1 * t), 100.0) == []
    assert envelope(t, np.where(t < 50.0, np.sin(math.tau * 4.0 * t), 0.0), 100.0) == []  # rests half of the time


def test_an_axis_of_nothing_but_zeros_has_round_ends() -> None:
    assert with_room(0.0, 0.0, 0.08, 1e-6, 1.0) == (-1.0, 1.0)
    low, high = with_room(1e-12, 2e-12, 0.08, 0.1, 1.0)
    assert low < -0.04 and high > 0.04  # noise does not fill a panel
