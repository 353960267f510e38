"""Do plots show the numbers of the run, in the units they name?"""

from __future__ import annotations

import dataclasses
import itertools
import math
from dataclasses import replace

import matplotlib
import matplotlib.image
import numpy as np
import pytest
from every_time import few
from matplotlib.colors import rgb_to_hsv, to_rgb
from render.fake_runs import disc_run, slide_run, watch_run

from watchsim.render.kinematics_plot import Kinematics, plot_kinematics, write_png
from watchsim.render.marks import clock
from watchsim.render.palette import looks
from watchsim.render.parts import parts


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
