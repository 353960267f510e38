"""How are sensitivities drawn?"""

from __future__ import annotations

from typing import TYPE_CHECKING

from watchsim.render.figures.figure_style import BAD, FULL, GOOD, HAIR, LABEL, NARROW, SMALL, TITLE, cut, dress, figure
from watchsim.render.palette import FAINT, INK
from watchsim.studies.sensitivity import Effect, Sensitivity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from watchsim.studies.outputs import Output

MOST = 30  # bars in a panel
UP, DOWN = GOOD, BAD
ROW, REST = 4.2, 18.0  # mm, of a bar and of all around the bars
WORDS = 10.0  # mm, beside a bar
LETTERS, LEAST_WIDE = 1.15, 30.0  # mm, of a letter of the names; of a panel at least
LEAST = 1e-4  # of the longest bar: shorter ones are none
TOLD = 1e-4  # of the longest bar: shorter ones have no number beside them


def plot_sensitivity(found: Sensitivity, width: float = FULL) -> Figure:
    """A panel of bars for each output, the quantities in one order for all of them; a figure `width` mm wide to save as
    PNG, SVG or PDF. In a column the panels stand one below the other.

    A bar is the effect of 1 % more, of 10 µm or of 0.1°. What two step sizes disagree about is hatched.
    """
    shown = [effect for effect in found.effects if _matters(found, effect)][:MOST]
    across = len(found.outputs) if width >= NARROW else 1
    rows = -(-len(found.outputs) // across)
    made = figure(width, rows * (ROW * max(len(shown), 2) + REST), layout="constrained")
    panels = made.subplots(rows, across, sharey=True, squeeze=False).flat
    made.suptitle(f"{cut(found.title)}: what matters", x=0.01, ha="left", fontsize=TITLE, weight="bold", color=INK)
    names = [f"{effect.quantity.key}, {_signed(effect)}" for effect in shown]
    # A panel's width is known only when it is laid out; before, all are alike beside the names.
    wide = (width - LETTERS * max(map(len, names), default=0)) / across
    for axes, output in zip(panels, found.outputs, strict=True):
        _bars(axes, shown, output, max(wide, LEAST_WIDE))
    for axes in (panels[0],) if across > 1 else panels:
        axes.set_yticks(range(len(shown)), names, fontsize=SMALL)
    panels[0].invert_yaxis()
    return made


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


def _bars(axes: Axes, shown: list[Effect], output: Output, wide: float) -> None:
    from matplotlib.ticker import MaxNLocator

    dress(axes, grid="x")
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
        axes.text(*place, text, va="center", ha="left" if side > 0 else "right", fontsize=SMALL, color=INK)
    room = longest * wide / max(wide - 2.0 * WORDS, 0.2 * wide)
    axes.set_xlim(-room, room)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 2, 5, 10]))
    axes.axvline(0.0, color=FAINT, linewidth=HAIR)
    axes.set_title(
        f"change of {output.label} ({output.unit})" if output.unit else output.label, fontsize=LABEL, loc="left", color=INK
    )
    axes.spines["left"].set_visible(False)
    axes.tick_params(left=False)
