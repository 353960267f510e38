"""What do values show of themselves in a notebook? A few lines and a small picture, in 30 kB at most."""

from __future__ import annotations

import io

import numpy as np

from watchsim.analysis.timing.averages import averages, last_window
from watchsim.analysis.timing.beats import Beats, beats
from watchsim.mechanism.compile import compile_scene
from watchsim.pages.card import card, image
from watchsim.pages.charts import scatter
from watchsim.pages.html import Markup
from watchsim.pages.player.stretch_shown import shown
from watchsim.pages.study_cards import cycle_html as cycle_html
from watchsim.pages.study_cards import sensitivity_html as sensitivity_html
from watchsim.pages.study_cards import sweep_html as sweep_html
from watchsim.pages.timing_sheet.timekeeping import both_ways, with_error
from watchsim.render.frame.pose_history import Window, poses
from watchsim.render.frame.stage import Stage
from watchsim.render.stills.still import at_rest
from watchsim.scene.oscillation import frequency
from watchsim.scene.roles import swings
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import Trajectory

SIZE = (560, 315)
COLOURS = 40  # of a picture: a palette makes it small
NAMED = 8  # bodies
DOTS = 120  # of a chart


def scene_html(scene: Scene) -> str:
    """Title, bodies, contacts, frequency, and the mechanism at its start."""
    names = [body.name for body in scene.bodies]
    told = f"{', '.join(names[:NAMED])}{f' and {len(names) - NAMED} more' if len(names) > NAMED else ''}"
    lines = [
        f"{_count(len(names), 'body', 'bodies')}: {told}",
        _count(len(scene.contacts), "contact", "contacts") + " declared",
    ]
    hertz = frequency(scene) if swings(scene) else None
    if hertz:
        lines.append(f"{hertz:.6g} Hz, {7200.0 * hertz:.6g} vph")
    run = at_rest(scene, compile_scene(scene))
    return card(scene.title, lines, _picture(run, (0.0, 1.0), 0.0))


def trajectory_html(run: Trajectory) -> str:
    """Title, amplitude, rate and beat error, how it ended, and the mechanism at the end."""
    lines = [f"{run.simulated:g} s simulated, {len(run.t)} rows, {len(run.events)} events", *_timing(run), run.stop.sentence]
    try:
        window = shown(run, None)
    except ValueError:  # no rows were kept
        return card(run.scene.title, lines, None)
    return card(run.scene.title, lines, _picture(run, window, window[1]))


def beats_html(found: Beats) -> str:
    """How many, the last of them, and a chart of the amplitude."""
    if len(found) < 3:
        return card(f"Beats of {found.body}", [_count(len(found), "half swing", "half swings")], None)
    unit, scale = ("°", float(np.degrees(1.0))) if found.angular else ("mm", 1e3)
    step = -(-len(found) // DOTS) | 1  # odd, so that both directions stay in sight
    dots = [
        type(one)(one.name, one.x[::step], one.y[::step], one.look)
        for one in both_ways(found, found.t, scale * found.amplitude)
    ]
    chart = scatter(dots, "time (s)", f"amplitude ({unit})", f"Amplitude of {len(found)} half swings")
    return card(f"Beats of {found.body}", repr(found).strip("<>").split(": ", 1)[1].split("; "), chart)


def _timing(run: Trajectory) -> list[str]:
    if not swings(run.scene):
        return []
    found = beats(run)
    means = averages(found, last_window(run, found.nominal_period))
    values = (
        ("amplitude", means.amplitude_deg, means.amplitude_deg_error, "°"),
        ("rate", means.rate_s_per_d, means.rate_s_per_d_error, " s/d"),
        ("beat error", means.beat_error_ms, means.beat_error_ms_error, " ms"),
    )
    told = [(name, *with_error(value, error, unit)) for name, value, error, unit in values if value is not None]
    return [", ".join(" ".join(filter(None, parts)) for parts in told)] if told else []


def _count(number: int, one: str, more: str) -> str:
    return f"{number} {one if number == 1 else more}"


def _picture(run: Trajectory, window: Window, t: float) -> Markup | None:
    """The mechanism at the instant `t` (s) as a small PNG; None where there is nothing to draw."""
    from PIL import Image

    frames = {name: rows[0] for name, rows in poses(run, np.array([t])).items()}
    try:
        pixels = Stage(run, SIZE, window).draw(t, frames)[..., :3]
    except ValueError:  # no body has an outline
        return None
    out = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(pixels)).quantize(COLOURS).save(out, "PNG", optimize=True)
    return image(out.getvalue(), f"The mechanism at {t:g} s", SIZE[0] // 4 * 3)
