"""Where did the energy go, in the whole run and in each phase of a beat?

plot_energy(run).savefig("energy.pdf")
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from watchsim.analysis.energy import energy_shares
from watchsim.analysis.timeline import Beat, Stage, shown_beats
from watchsim.analysis.timeline import title as phase_title
from watchsim.render.palette import FAINT, INK
from watchsim.render.style import (
    EDGE,
    FULL,
    HAIR,
    HEADING,
    LABEL,
    MM,
    NARROW,
    SERIES,
    SMALL,
    dress,
    energy_unit,
    figure,
    heading,
    key,
    panel,
    title,
)
from watchsim.simulation.trajectory import Trajectory
from watchsim.units import metric

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


LEFT, RIGHT, ROW, OVER, UNDER, KEY = 27.0, 4.0, 5.0, 6.0, 9.0, 4.0  # mm
WORDS = 27.0  # mm, beside a bar
PARTS = ("stored", "damping", "friction", "impacts")  # of what is supplied
COLOURS = dict(zip((*PARTS, "given back to the drive"), SERIES, strict=False))
HATCHES = {"friction": "////", "impacts": "xxxx"}
MANY = 2  # beats


def plot_energy(
    run: Trajectory, window: Sequence[float] | None = None, width: float = FULL, beats: list[Beat] | None = None
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
    across = len(stages) if width >= NARROW else 1
    rows = -(-len(stages) // across) if stages else 0
    whole = ROW * len(shares.went_to)
    each = ROW * max((len(own) for own in stages), default=0)
    step = OVER + each + UNDER
    made = figure(width, HEADING + OVER + whole + UNDER + (KEY if rows else 0.0) + rows * step)
    closes = f", the account closes to {abs(run.energy.get('residual_relative', 0.0)):.0e}"
    heading(made, run.scene.title, f"{metric(shares.supplied, 'J', 4)} put in over {run.simulated:.6g} s{closes}")
    top = HEADING + OVER
    _whole(panel(made, LEFT, top, width - LEFT - RIGHT, whole), shares.went_to, shares.supplied)
    top += whole + UNDER
    wide = width / max(across, 1) - LEFT - RIGHT
    reach = max((abs(_sum(one)) for own in stages for one in own), default=0.0)
    for k, (beat, own) in enumerate(zip(beats_shown, stages, strict=True)):
        left, up = (k % across) * (LEFT + wide + RIGHT) + LEFT, top + KEY + (k // across) * step + OVER
        axes = panel(made, left, up, wide, ROW * len(own))
        _phases(axes, own, reach)
        stone = beat.stages[0].pallet
        title(axes, f"beat {beat.stages[0].beat}{f', {stone} stone' if stone else ''}")
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
    dress(axes, grid="x")
    names = list(went)
    values = [100.0 * went[name] for name in names]
    bars = axes.barh(
        range(len(names)),
        values,
        height=0.66,
        color=[COLOURS.get(name, FAINT) for name in names],
        edgecolor="white",
        linewidth=0.0,
    )
    for bar, name, value in zip(bars, names, values, strict=True):
        bar.set_gid(f"energy {name}")
        bar.set_hatch(HATCHES.get(name))
        amount = metric(went[name] * supplied, "J", 4)
        words = f"{value:.1f} %, {amount}".replace("-", "−")
        place = (max(value, 0.0), bar.get_y() + 0.5 * bar.get_height())
        axes.annotate(words, place, (3, 0), textcoords="offset points", va="center", fontsize=SMALL, color=INK)
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    wide = axes.get_window_extent().width / axes.figure.dpi / MM
    axes.set_xlim(min(*values, 0.0) * 1.1, max(*values, 1e-9) * wide / (wide - WORDS))
    axes.axvline(0.0, color=FAINT, linewidth=HAIR)
    axes.set_xlabel("share of what was put in (%)", labelpad=1.5)
    axes.tick_params(axis="y", length=0.0, labelsize=LABEL)
    title(axes, "The whole run")


def _sum(stage: Stage) -> float:
    return max(
        sum(max(value, 0.0) for value in _parts(stage).values()), -sum(min(value, 0.0) for value in _parts(stage).values())
    )


def _parts(stage: Stage) -> dict[str, float]:
    """What the work of the drive became in a phase, J."""
    e = stage.energy
    return {"stored": e.stored, "damping": e.damping, "friction": e.friction, "impacts": sum(e.impacts.values())}


def _phases(axes: Axes, stages: list[Stage], reach: float) -> None:
    """Stacked bars: what was taken to the right of zero, what stores gave to the left; a line where the drive's work ends."""
    dress(axes, grid="x")
    factor, unit = energy_unit(reach)
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
    axes.axvline(0.0, color=FAINT, linewidth=HAIR)
    axes.set_xlabel(f"energy ({unit})", labelpad=1.5)
    axes.tick_params(axis="y", length=0.0, labelsize=LABEL)


def _key(made: Figure, axes: Axes, top: float) -> None:
    """What the parts of the bars stand for, above the first panel of phases."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles: list[tuple[Any, str]] = [
        (Patch(facecolor=COLOURS[name], hatch=HATCHES.get(name), edgecolor="white", linewidth=0.0), name) for name in PARTS
    ]
    handles.append((Line2D([], [], color=INK, linewidth=1.2), "work of the drive"))
    width, height = (inches / MM for inches in made.get_size_inches())
    where: dict[str, Any] = {"bbox_to_anchor": (EDGE / width, 1.0 - (top + KEY) / height), "bbox_transform": made.transFigure}
    key(axes, handles, loc="lower left", ncols=len(handles), borderaxespad=0.0, borderpad=0.0, **where)
