"""How are sensitivities drawn?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from watchsim.render.palette import FAINT, GRID, INK
from watchsim.studies.sensitivity import Effect, Sensitivity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from watchsim.studies.outputs import Output

MOST = 30  # bars in a panel
UP, DOWN = "#1f4e79", "#b5452c"
WIDTH, ROW = 4.2, 0.24  # inches, of a panel and of a bar
LEAST = 1e-4  # of the longest bar: shorter ones are none
TOLD = 1e-4  # of the longest bar: shorter ones have no number beside them
ROOM = 1.4  # longest bars, on either side


def plot_sensitivity(found: Sensitivity) -> Figure:
    """A panel of bars for each output, the quantities in one order for all of them; a figure to save as PNG, SVG or PDF.

    A bar is the effect of 1 % more, of 10 µm or of 0.1°. What two step sizes disagree about is hatched.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    shown = [effect for effect in found.effects if _matters(found, effect)][:MOST]
    size = (WIDTH * len(found.outputs) + 2.6, ROW * len(shown) + 1.3)
    figure = Figure(figsize=size, dpi=150, layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(1, len(found.outputs), sharey=True, squeeze=False)[0]
    figure.suptitle(f"{found.title}: what matters", x=0.01, ha="left", fontsize=11, weight="bold", color=INK)
    for axes, output in zip(panels, found.outputs, strict=True):
        _bars(axes, shown, output)
    names = [f"{effect.quantity.key}, {_signed(effect)}" for effect in shown]
    panels[0].set_yticks(range(len(shown)), names)
    panels[0].invert_yaxis()
    return figure


def _signed(effect: Effect) -> str:
    return f"+{effect.quantity.change_words}"


def _matters(found: Sensitivity, effect: Effect) -> bool:
    """Does it move any output by more than a trace?"""
    for one in found.outputs:
        longest = max((_length(other, one) for other in found.effects), default=0.0)
        if longest > 0.0 and _length(effect, one) > LEAST * longest:
            return True
    return False


def _length(effect: Effect, output: Output) -> float:
    return abs(effect.of(output.column, effect.quantity.change) or 0.0)


def _bars(axes: Axes, shown: list[Effect], output: Output) -> None:
    values = [effect.of(output.column, effect.quantity.change) or 0.0 for effect in shown]
    hatches = ["" if effect.by[output.column].agrees else "////" for effect in shown]
    bars = axes.barh(range(len(shown)), values, height=0.68, color=[UP if value > 0.0 else DOWN for value in values])
    longest = max((abs(value) for value in values), default=0.0) or 1.0
    for bar, value, hatch in zip(bars, values, hatches, strict=True):
        bar.set_hatch(hatch)
        if abs(value) < TOLD * longest:
            continue
        side = 1.0 if value >= 0.0 else -1.0
        place = (value + 0.02 * side * longest, bar.get_y() + 0.5 * bar.get_height())
        text = f"{value:+.3g}".replace("-", "−")
        axes.text(*place, text, va="center", ha="left" if side > 0 else "right", fontsize=7, color=INK)
    axes.set_xlim(-ROOM * longest, ROOM * longest)
    axes.axvline(0.0, color=FAINT, linewidth=0.8)
    axes.set_title(
        f"change of {output.label} ({output.unit})" if output.unit else output.label, fontsize=9, loc="left", color=INK
    )
    axes.grid(True, axis="x", color=GRID, linewidth=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right", "left"]].set_visible(False)
    axes.spines["bottom"].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=8, left=False)
