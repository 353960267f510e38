"""How does the picture of the kinds of contact in docs/theory/contact-geometry.md come about?

Every kind of pair with its gap, normal, contact point and force directions as `watchsim.kinematics` gives them.

    python scripts/pictures/draw_contact_kinds.py
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Curve

import watchsim as ws
from watchsim.geometry.loop import Loop
from watchsim.geometry.polyline import polyline
from watchsim.geometry.primitives import Arc, Line, Point
from watchsim.render.figures.figure_style import LABEL, SERIES, SMALL, figure, save
from watchsim.render.figures.figure_style import title as named
from watchsim.render.palette import BRASS, INK, STEEL

IMAGE = Path(__file__).resolve().parents[2] / "docs" / "images" / "contact_kinds.png"
A_FILL, B_FILL = BRASS.fill, STEEL.fill
TANGENT, NORMAL, GAP, *_ = SERIES
STILL = (0.0, 0.0, 0.0)
FINE = 1e-3


def polygon(*points: Point) -> Loop:
    """Counter-clockwise corners."""
    return Loop(tuple(Line(*p, *q) for p, q in zip(points, points[1:] + points[:1], strict=True)))


def disc(radius: float) -> Loop:
    return Loop((Arc(0.0, 0.0, radius, 0.0, math.tau),))


TOOTH = polygon((0.0, 0.0), (0.5, 1.2), (-0.45, 1.2))
GROUND = polygon((-1.6, -0.5), (1.6, -0.5), (1.6, 0.0), (-1.6, 0.0))
NOSE = Loop(
    (
        Arc(0.0, -1.2, 1.2, math.pi / 4, math.pi / 2),
        Line(-0.8485, -0.3515, -0.8485, -0.7),
        Line(-0.8485, -0.7, 0.8485, -0.7),
        Line(0.8485, -0.7, 0.8485, -0.3515),
    )
)
BOWL = Loop(
    (
        Line(-1.5, 0.6, -1.5, -0.5),
        Line(-1.5, -0.5, 1.5, -0.5),
        Line(1.5, -0.5, 1.5, 0.6),
        Line(1.5, 0.6, 1.2, 0.6),
        Arc(0.0, 0.95, 1.25, -0.2838, -2.574),
        Line(-1.2, 0.6, -1.5, 0.6),
    )
)

PANELS = (
    ("corner on line", TOOTH, (0.2, 0.35, 0.15), GROUND),
    ("convex arc on line", disc(0.5), (0.1, 0.82, 0.0), GROUND),
    ("corner on convex arc", TOOTH, (0.3, 0.28, -0.1), NOSE),
    ("corner on concave arc", TOOTH, (0.3, 0.08, -0.1), BOWL),
    ("convex arc on convex arc", disc(0.45), (0.35, 0.7, 0.0), NOSE),
    ("convex arc in concave arc", disc(0.8), (0.18, 0.72, 0.0), BOWL),
)


def fill(ax: Axes, loop: Loop, pose: tuple[float, float, float], colour: str) -> None:
    points = polyline(loop.moved(pose[2], pose[:2]), FINE)
    ax.add_patch(PathPatch(Curve(points), facecolor=colour, edgecolor=INK, linewidth=0.7, joinstyle="round"))


def arrow(ax: Axes, start: np.ndarray, way: np.ndarray, colour: str, word: str) -> None:
    look = {"arrowstyle": "-|>", "color": colour, "linewidth": 1.2, "mutation_scale": 7.0, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", tuple(start + way), tuple(start), arrowprops=look)
    ax.annotate(word, tuple(start + 1.16 * way), color=colour, ha="center", va="center", fontsize=LABEL)


def panel(ax: Axes, title: str, a: Loop, pose: tuple[float, float, float], b: Loop) -> None:
    """One kind of pair: the contact with the smallest gap inside both primitives."""
    rows = ws.gap(a, pose, b, STILL)
    rows = rows[(rows["margin"] >= 0.0) & (rows["g"] > 0.0)]
    row = rows[np.argmin(rows["g"])]
    fill(ax, b, STILL, B_FILL)
    fill(ax, a, pose, A_FILL)
    point, n = row["point"], row["n"]
    foot = point - row["g"] * n
    ax.plot(*np.array([point, foot]).T, color=GAP, linewidth=1.6, solid_capstyle="round")
    t = np.array([-n[1], n[0]])
    ax.annotate("g", 0.5 * (point + foot) - 0.14 * t, color=GAP, ha="center", va="center", fontsize=LABEL)
    ax.plot(*foot, "o", color=GAP, markersize=2.5)
    arrow(ax, point, 0.55 * n, NORMAL, "n")
    arrow(ax, point, 0.55 * t, TANGENT, "t")
    ax.plot(*point, "o", color=INK, markersize=3)
    named(ax, title)
    words = f"{row['kind_a']}–{row['kind_b']}, g = {row['g']:.3f}"
    ax.text(0.0, 0.99, words, transform=ax.transAxes, fontsize=SMALL, va="top", color=INK)
    ax.set_aspect("equal")
    ax.set_xlim(-1.65, 1.65)
    ax.set_ylim(-0.75, 1.95)
    ax.axis("off")


def main() -> None:
    made = figure(height=100.0, layout="constrained")
    axes = made.subplots(2, 3)
    for ax, (title, a, pose, b) in zip(axes.ravel(), PANELS, strict=True):
        panel(ax, title, a, pose, b)
    IMAGE.parent.mkdir(parents=True, exist_ok=True)
    save(made, IMAGE)


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    arguments(__doc__)
    main()
