"""How is speed against error drawn?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim.render.figures.figure_style import CURVE, FULL, HAIR, SERIES, SMALL, dress, figure, save, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = dict(
    zip(("pfeiffer-glocker", "pymunk", "mujoco", "box2d", "moreau"), (SERIES[0], *SERIES[1:4], SERIES[5]), strict=True)
)
NAMES = {
    **{"pfeiffer-glocker": "watchsim, by events", "moreau": "watchsim, Moreau's time stepping"},
    **{"pymunk": "pymunk", "box2d": "Box2D", "mujoco": "MuJoCo"},
}
MARKS = {"pfeiffer-glocker": "o", "moreau": "s", "pymunk": "^", "box2d": "v", "mujoco": "D"}
AXES = (("error_state", "error of the place after 3 s (m)"), ("error_amplitude_deg", "error of the amplitude (°)"))
ACROSS = 3  # panels beside each other
TALL = 62.0  # mm, a row of panels
LEAST = 1e-14  # what comes out exactly is drawn here


def plot_speed(rows: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Processor time per simulated second over error, both logarithmic, a panel for each scene; the file's ending decides."""
    scenes = [name for name in dict.fromkeys(row["scene"] for row in rows) if _drawn(rows, name)]
    across, down = min(ACROSS, len(scenes)), -(-len(scenes) // ACROSS)
    made = figure(FULL, TALL * down, layout="constrained")
    panels = made.subplots(down, across, squeeze=False).ravel()
    for axes, scene in zip(panels, scenes, strict=False):
        _panel(axes, scene, [row for row in rows if row["scene"] == scene])
    for empty in panels[len(scenes) :]:
        empty.set_axis_off()
    for first in panels[::across]:
        first.set_ylabel("time per simulated second (s)")
    shown = {label: line for axes in panels for line, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    made.legend(list(shown.values()), list(shown), loc="outside lower center", ncols=len(shown), frameon=False, fontsize=SMALL)
    save(made, path)


def _drawn(rows: Sequence[Mapping[str, Any]], scene: str) -> bool:
    """Scenes in which more than one engine took part."""
    return len({row["method"] for row in rows if row["scene"] == scene}) > 1


def _panel(axes: Axes, scene: str, rows: Sequence[Mapping[str, Any]]) -> None:
    name, label = next(axis for axis in AXES if any(row[axis[0]] is not None for row in rows))
    for method in dict.fromkeys(row["method"] for row in rows):
        points = [row for row in rows if row["method"] == method and row[name] is not None and not row["note"]]
        x = [max(row[name], LEAST) for row in points]
        y = [row["wall_s_per_simulated_s"] for row in points]
        spread = [[t - row["wall_least"] for t, row in zip(y, points, strict=True)]]
        spread.append([row["wall_largest"] - t for t, row in zip(y, points, strict=True)])
        if points:
            look: dict[str, Any] = {"color": COLOURS[method], "marker": MARKS[method], "label": NAMES[method]}
            axes.errorbar(x, y, yerr=spread, linewidth=CURVE, elinewidth=HAIR, markersize=3.5, **look)
    axes.set_xscale("log")
    axes.set_yscale("log")
    title(axes, scene)
    axes.set_xlabel(label)
    dress(axes)
