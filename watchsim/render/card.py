"""How does a run become one picture to share: the mechanism with phase and forces, and the numbers of a timing machine?"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import imageio.v3 as imageio
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from watchsim.analysis.headlines import readings
from watchsim.analysis.phases import phases_within
from watchsim.analysis.summary import summary
from watchsim.render.encoder import check_path, encode, shared_palette
from watchsim.render.marks import ContactMarks, ForceArrows
from watchsim.render.movie import GIF_FPS, SAMPLES, Film, Plan, adaptive, busy
from watchsim.render.opening import last_beats, telling
from watchsim.render.palette import DARK, LIGHT, Style, mixed
from watchsim.render.stage import DPI, Extras, Stage
from watchsim.render.view import Pixels, stretch
from watchsim.results.tables import plain
from watchsim.simulation.trajectory import Trajectory
from watchsim.storage.write import write_file

SIZE = (1200, 630)  # pixels: what sites show of a link
PANEL = 330  # pixels of the width, for the numbers
LENGTH = 5.0  # s of a GIF
ENDINGS = (".png", ".gif")
MOST = 6  # numbers
BEATS = 10  # in the last of which a PNG looks for an impulse
CLAUSE = 36  # characters that fit into the panel
SHADE = 0.4  # of the way from the ground to the colour of grid lines


def card(
    run: Trajectory,
    path: str | os.PathLike[str],
    t: float | None = None,
    *,
    dark: bool = False,
    numbers: Mapping[str, Any] | None = None,
) -> Path:
    """Write a picture of 1200 × 630 pixels to share, and return its path: PNG, or GIF of 5 s, by the ending of `path`.

    Mechanism, phase, contacts and forces, and beside them amplitude, rate and what else a watchmaker reads first.

    t        the instant of a PNG (s); default: the middle of the last impulse. A GIF shows the last oscillation, slowly where
             things happen; where nothing keeps time, the last tenth of the run
    dark     with a dark background
    numbers  those of summary.json; default: computed from the run

    ValueError for another ending or an instant that was not recorded, OSError where the file cannot be written.
    """
    target = check_card(path)
    moves = target.suffix.lower() == ".gif"
    known = plain(summary(run) if numbers is None else numbers)
    style = DARK if dark else LIGHT
    if moves and t is not None:
        raise ValueError(f"t = {t:g} s: a GIF shows the last oscillation; leave the time out, or write a PNG")
    span = last_beats(run, 1.0 if moves else BEATS / 2) if t is None else stretch(run, None)
    found = phases_within(run, span)
    if moves:
        plan = adaptive(span, busy(run, found, span), LENGTH, GIF_FPS)
    else:
        instant = telling(found, span) if t is None else float(t)
        if not span[0] <= instant <= span[1]:
            raise ValueError(f"t = {instant:.9g} s lies outside {span[0]:.9g} s to {span[1]:.9g} s")
        plan = Plan(np.array([instant]), np.ones(1), 1.0)
    film, panel = _film(run, span, plan, found, style, moves), _panel(known, style)

    def pictures(which: np.ndarray) -> Iterator[Pixels]:
        for picture in film.pictures(which):
            yield np.concatenate((picture, panel), axis=1)

    every = np.arange(len(plan.times))
    if moves:
        sampled = np.unique(np.linspace(0, len(every) - 1, SAMPLES).astype(int))
        encode(pictures(every), target, SIZE, GIF_FPS, shared_palette(list(pictures(sampled)), style.phases.values()))
        return target
    pixels = next(pictures(every))[..., :3]
    write_file(target, lambda scratch: imageio.imwrite(scratch, pixels), "the card")
    return target


def check_card(path: str | os.PathLike[str]) -> Path:
    """The path, if a card can be written there: ValueError for a wrong ending, OSError for a folder."""
    return check_path(path, ENDINGS, "a card")


def _film(run: Trajectory, span: tuple[float, float], plan: Plan, found: list[Any], style: Style, moves: bool) -> Film:
    """The mechanism; without forces or contacts where the run does not hold them."""
    try:
        arrows, marks = ForceArrows(run, plan.times), ContactMarks(run)
    except ValueError:
        arrows, marks = None, None
    extras = Extras(phases=tuple(found), force=arrows.largest if arrows else 0.0, scale=arrows.round_force if arrows else 0.0)
    step = float(plan.speeds.min()) / plan.fps if moves else None
    stage = Stage(run, (SIZE[0] - PANEL, SIZE[1]), span, step=step, extras=extras, style=style)
    return Film(stage, run, plan, marks, arrows, moves)


def _panel(numbers: Mapping[str, Any], style: Style) -> Pixels:
    """The numbers one below the other, what is to be thought of the watch, and who computed it."""
    figure = Figure(
        figsize=((PANEL + 0.5) / DPI, (SIZE[1] + 0.5) / DPI), dpi=DPI, facecolor=mixed(style.background, style.grid, SHADE)
    )
    canvas = FigureCanvasAgg(figure)

    def write(words: str, y: float, size: float, colour: str, weight: str = "normal") -> None:
        figure.text(26.0 / PANEL, 1.0 - y / SIZE[1], words, fontsize=size, color=colour, weight=weight, parse_math=False)

    found = list(readings(numbers))[:MOST] or _counted(numbers)
    for k, (label, value, below) in enumerate(found):
        top = 44.0 + k * min(96.0, 540.0 / len(found))
        write(label, top, 15.0, style.faint)
        write(value, top + 30.0, 27.0, style.ink, "bold")
        write(below if below and len(below) < CLAUSE else "", top + 50.0, 13.0, style.faint)
    said = str(numbers.get("verdict_message") or "").partition(":")[0]
    write(said[:1].upper() + said[1:] if len(said) < CLAUSE else "", SIZE[1] - 48.0, 15.0, style.ink, "bold")
    write(f"watchsim {numbers['versions']['watchsim']}", SIZE[1] - 24.0, 13.0, style.faint)
    canvas.draw()
    return np.array(canvas.buffer_rgba())[: SIZE[1], :PANEL].copy()


def _counted(numbers: Mapping[str, Any]) -> list[tuple[str, str, str | None]]:
    """What can be said of a run in which nothing keeps time."""
    return [
        ("Simulated", f"{numbers['simulated_s']:.4g} s", None),
        ("Impacts", f"{numbers['impacts']}", None),
        ("Energy balance", f"{numbers['energy']['residual_relative']:.1g}", "of what went in is not accounted for"),
    ]
