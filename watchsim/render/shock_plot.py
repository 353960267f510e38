"""What does a blow do, over its direction and the phase of the oscillation at which it strikes?"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from watchsim.render import style
from watchsim.render.palette import INK
from watchsim.studies.shock import ShockMap

TALL = 88.0  # mm
OUTCOMES = {
    "goes on": "#9fd0a8",
    "guard pin or horns at work": "#f2d479",
    "jewel on the wrong side": "#e08a5b",
    "knocks, stops or overbanks": "#a83a4c",
}
HIDDEN = "#ffffff"


def plot_shock_map(found: ShockMap, width: float = style.FULL, ax: Axes | None = None) -> Figure:
    """What becomes of the watch, and by how much it is late or early after the blows that it survives. `width` in mm."""
    made = style.figure(width, TALL, layout="constrained", ax=ax)
    title = f"{found.title}: struck as by the hammer of ISO 1413 at {found.speed_m_s:.3g} m/s"
    made.suptitle(style.cut(title), x=0.01, ha="left", fontsize=style.TITLE, weight="bold", color=INK)
    left, right = made.subplots(1, 2, sharey=True)
    shape = len(found.directions_deg), len(found.phases)
    outcome, late = np.full(shape, np.nan), np.full(shape, np.nan)
    for k, one in enumerate(found.blows):
        at = divmod(k, shape[1])
        outcome[at] = 2.0 if one.jewel_ok is False else float(one.guard_blows > 0)
        if one.verdict not in (None, "ticks", "unsettled"):
            outcome[at] = 3.0
        elif one.lost_s is not None:
            late[at] = 1e3 * one.lost_s
    _field(left, found, outcome, ListedColormap(list(OUTCOMES.values())), (-0.5, 3.5))
    handles = [Patch(color=colour, label=name) for name, colour in OUTCOMES.items()]
    made.legend(handles=handles, loc="outside lower left", ncols=2, frameon=False, fontsize=style.SMALL, labelcolor=INK)
    left.set_title("what becomes of it", fontsize=style.LABEL, color=INK)
    left.set_ylabel("direction of the blow (°)", fontsize=style.LABEL, color=INK)
    most = float(np.nanmax(np.abs(late), initial=0.0)) or 1.0
    image = _field(right, found, late, "RdBu_r", (-most, most))
    bar = made.colorbar(image, ax=right, shrink=0.9)
    bar.ax.tick_params(labelsize=style.TICK, colors=INK)
    bar.set_label("ms late", fontsize=style.LABEL, color=INK)
    right.set_title("how late it is afterwards", fontsize=style.LABEL, color=INK)
    return made


def _field(axes: Any, found: ShockMap, values: Any, colours: Any, limits: tuple[float, float]) -> Any:
    """One square for each blow, in the middle of what it stands for."""
    axes.set_facecolor(HIDDEN)
    half = 180.0 / len(found.directions_deg), 0.5 / len(found.phases)
    extent = (-half[1], 1.0 - half[1], -half[0], 360.0 - half[0])
    image = axes.imshow(
        values, origin="lower", extent=extent, aspect="auto", cmap=colours, vmin=limits[0], vmax=limits[1], interpolation="none"
    )
    axes.set_xlabel("phase of the oscillation", fontsize=style.LABEL, color=INK)
    axes.set_yticks(range(0, 360, 60))
    axes.tick_params(labelsize=style.TICK, colors=INK)
    return image
