"""Where did the energy go, in the whole run and in each phase of a beat?

plot_energy(run).savefig("energy.pdf")
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from watchsim.analysis.energy import energy_shares
from watchsim.analysis.timeline import Beat, Stage, shown_beats
from watchsim.analysis.timeline import title as phase_title
from watchsim.render import style
from watchsim.render.palette import FAINT, INK
from watchsim.render.phase_bands import beat_name
from watchsim.simulation.trajectory import Trajectory
from watchsim.units import metric

LEFT, RIGHT, ROW, OVER, UNDER, KEY = 27.0, 4.0, 5.0, 6.0, 9.0, 4.0  # mm
WORDS = 27.0  # mm, beside a bar
PARTS = ("stored", "damping", "friction", "impacts")  # of what is supplied
COLOURS = dict(zip((*PARTS, "given back to the drive"), style.SERIES, strict=False))
HATCHES = {"friction": "////", "impacts": "xxxx"}
MANY = 2  # beats


def plot_energy(
    run: Trajectory, window: Sequence[float] | None = None, width: float = style.FULL, beats: list[Beat] | None = None
) -> Figure:
    """Bars: what the drive, springs and weights put in over the whole run and where it went; below, phase by phase of the last
    two beats of a window where there is an escapement.

    ValueError where nothing was put in: there is no share of nothing.
    """
    shares = energy_shares(run)
    if not shares.went_to:
        raise ValueError("no energy was put into this run, so there are no shares to draw")
    beats_shown = (_beats(run, window) if beats is None else beats)[-MANY:]
    stages = [[one for one in beat.stages if one.name != "locked"] for beat in beats_shown]
    across = len(stages) if width >= style.NARROW else 1
    rows = -(-len(stages) // across) if stages else 0
    whole = ROW * len(shares.went_to)
    each = ROW * max((len(own) for own in stages), default=0)
    step = OVER + each + UNDER
    made = style.figure(width, style.HEADING + OVER + whole + UNDER + (KEY if rows else 0.0) + rows * step)
    closes = f", the account closes to {abs(run.energy.get('residual_relative', 0.0)):.0e}"
    style.heading(made, run.scene.title, f"{metric(shares.supplied, 'J', 4)} put in over {run.simulated:.6g} s{closes}")
    top = style.HEADING + OVER
    _whole(style.panel(made, LEFT, top, width - LEFT - RIGHT, whole), shares.went_to, shares.supplied)
    top += whole + UNDER
    wide = width / max(across, 1) - LEFT - RIGHT
    reach = max((abs(_sum(one)) for own in stages for one in own), default=0.0)
    for k, (beat, own) in enumerate(zip(beats_shown, stages, strict=True)):
        left, up = (k % across) * (LEFT + wide + RIGHT) + LEFT, top + KEY + (k // across) * step + OVER
        axes = style.panel(made, left, up, wide, ROW * len(own))
        _phases(axes, own, reach)
        style.title(axes, beat_name(beat))
        if k == 0:
            _key(made, axes, top)
    return made


def _beats(run: Trajectory, window: Sequence[float] | None) -> list[Beat]:
    try:
        return shown_beats(run, window, rubbed=False)
    except ValueError:
        return []


def _whole(axes: Axes, went: dict[str, float], supplied: float) -> None:
    """A bar for each way that energy took, with its share and its amount."""
    style.dress(axes, grid="x")
    names = list(went)
    values = [100.0 * went[name] for name in names]
    colours = [COLOURS.get(name, FAINT) for name in names]
    bars = axes.barh(range(len(names)), values, height=0.66, color=colours, edgecolor="white", linewidth=0.0)
    for bar, name, value in zip(bars, names, values, strict=True):
        bar.set_gid(f"energy {name}")
        bar.set_hatch(HATCHES.get(name))
        words = style.minus(f"{value:.1f} %, {metric(went[name] * supplied, 'J', 4)}")
        place = (max(value, 0.0), bar.get_y() + 0.5 * bar.get_height())
        axes.annotate(words, place, (3, 0), textcoords="offset points", va="center", fontsize=style.SMALL, color=INK)
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    wide = style.width_mm(axes)
    axes.set_xlim(min(*values, 0.0) * 1.1, max(*values, 1e-9) * wide / (wide - WORDS))
    axes.axvline(0.0, color=FAINT, linewidth=style.HAIR)
    axes.set_xlabel("share of what was put in (%)", labelpad=1.5)
    axes.tick_params(axis="y", length=0.0, labelsize=style.LABEL)
    style.title(axes, "The whole run")


def _sum(stage: Stage) -> float:
    values = _parts(stage).values()
    return max(sum(max(value, 0.0) for value in values), -sum(min(value, 0.0) for value in values))


def _parts(stage: Stage) -> dict[str, float]:
    """What the work of the drive became in a phase, J."""
    e = stage.energy
    return {"stored": e.stored, "damping": e.damping, "friction": e.friction, "impacts": sum(e.impacts.values())}


def _phases(axes: Axes, stages: list[Stage], reach: float) -> None:
    """Stacked bars: what was taken to the right of zero, what stores gave to the left; a line where the drive's work ends."""
    style.dress(axes, grid="x")
    factor, unit = style.energy_unit(reach)
    for k, stage in enumerate(stages):
        ends = {True: 0.0, False: 0.0}
        for name, value in _parts(stage).items():
            up = value >= 0.0
            bar = axes.barh(
                k, factor * value, left=factor * ends[up], height=0.66, color=COLOURS[name], gid=f"energy {k} {name}",
                hatch=HATCHES.get(name), edgecolor="white", linewidth=0.0,
            )  # fmt: skip
            bar[0].set_gid(f"energy {phase_title(stage)} {name}")
            ends[up] += value
        supplied = factor * stage.energy.supplied
        axes.plot([supplied, supplied], [k - 0.44, k + 0.44], color=INK, linewidth=1.2, gid=f"drive {phase_title(stage)}")
    axes.set_yticks(range(len(stages)), [phase_title(stage) for stage in stages])
    axes.set_ylim(len(stages) - 0.5, -0.5)
    low = min(0.0, *(factor * min(0.0, sum(min(v, 0.0) for v in _parts(stage).values())) for stage in stages))
    axes.set_xlim(1.08 * low - 0.02 * factor * reach, 1.08 * factor * reach)
    axes.axvline(0.0, color=FAINT, linewidth=style.HAIR)
    axes.set_xlabel(f"energy ({unit})", labelpad=1.5)
    axes.tick_params(axis="y", length=0.0, labelsize=style.LABEL)


def _key(made: Figure, axes: Axes, top: float) -> None:
    """What the parts of the bars stand for, above the first panel of phases."""
    handles: list[tuple[Any, str]] = [
        (Patch(facecolor=COLOURS[name], hatch=HATCHES.get(name), edgecolor="white", linewidth=0.0), name) for name in PARTS
    ]
    handles.append((Line2D([], [], color=INK, linewidth=1.2), "work of the drive"))
    width, height = style.size_mm(made)
    where: dict[str, Any] = {
        "bbox_to_anchor": (style.EDGE / width, 1.0 - (top + KEY) / height),
        "bbox_transform": made.transFigure,
    }
    style.key(axes, handles, loc="lower left", ncols=len(handles), borderaxespad=0.0, borderpad=0.0, **where)
