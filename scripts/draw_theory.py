"""The pictures of docs/theory: the kinds of contact, and the laws of contact, whose expansion is read off the solver itself."""

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Curve

import watchsim as ws
from watchsim.geometry.loops import Loop, polyline
from watchsim.geometry.primitives import Arc, Line, Point
from watchsim.render.palette import BRASS, FAINT, INK, STEEL
from watchsim.render.style import HAIR, LABEL, SERIES, SMALL, TICK, figure, save
from watchsim.render.style import title as named
from watchsim.verification.random_problems import BareContacts

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
        *(Line(-1.5, 0.6, -1.5, -0.5), Line(-1.5, -0.5, 1.5, -0.5), Line(1.5, -0.5, 1.5, 0.6), Line(1.5, 0.6, 1.2, 0.6)),
        *(Arc(0.0, 0.95, 1.25, -0.2838, -2.574), Line(-1.2, 0.6, -1.5, 0.6)),
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


def contact_kinds(path: Path) -> None:
    made = figure(height=100.0, layout="constrained")
    axes = made.subplots(2, 3)
    for ax, (title, a, pose, b) in zip(axes.ravel(), PANELS, strict=True):
        panel(ax, title, a, pose, b)
    save(made, path)


GREY = FAINT
LAW_COLOURS = dict(zip(("coulomb", "pg1996", "shifted"), SERIES, strict=False))
DASHES = {"coulomb": "-", "pg1996": "--", "shifted": (0, (1.2, 1.0))}
WIDE = 1.4  # pt, of a characteristic
MU, EPS, BACK = 0.3, 0.8, 0.6


def one_contact(law: str, eps: float, u: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Total impulses N, T and rates after the impact; unit mass, no coupling, G = diag(1, 3) as for a uniform disc."""
    contact = BareContacts(np.array([1.0, 1.0 / 3.0]), np.eye(2), np.array([MU]), np.array([eps]), law, tangential=BACK)
    solved, after, impulses = contact.impact(np.array(u))
    if not solved:
        raise SystemExit(f"{law}: the impact at {u} was not solved")
    return impulses, after


def axes_through_zero(ax: Axes, x: str, y: str) -> None:
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    ax.spines[["left", "bottom"]].set_position("zero")
    ax.spines[["left", "bottom"]].set_color(GREY)
    ax.spines[["left", "bottom"]].set_linewidth(HAIR)
    for side in ("left", "bottom"):
        ax.spines[side].set_zorder(1)
    ax.tick_params(colors=GREY, labelsize=TICK, length=2.0, width=HAIR)
    ax.set_xlabel(x, loc="right", color=INK, fontsize=LABEL)
    ax.annotate(y, (0.0, 1.0), (6, 0), ax.get_xaxis_transform(), "offset points", va="top", color=INK, fontsize=LABEL)


def draw_expansion(path: Path) -> None:
    """Left: friction impulse of the expansion over the slip after it. Right: slip after over slip before the impact."""
    made = figure(height=68.0, layout="constrained")
    left, right = made.subplots(1, 2)
    slips = np.linspace(-2.5, 2.5, 2001)
    for law, colour in LAW_COLOURS.items():
        impulses, after = [], []
        for slip in slips:
            compression, _ = one_contact(law, 0.0, (-1.0, slip))
            total, rates = one_contact(law, EPS, (-1.0, slip))
            impulses.append((total - compression)[1])
            after.append(rates[1])
        right.plot(slips, after, color=colour, label=law, lw=WIDE, ls=DASHES[law])
        left.plot(slips, impulses, color=colour, label=law, lw=WIDE, ls=DASHES[law])
    left.axhline(MU * EPS, color=GREY, lw=HAIR, ls="--")
    left.axhline(-MU * EPS, color=GREY, lw=HAIR, ls="--")
    left.text(2.45, MU * EPS + 0.012, r"$+\mu\,\Lambda_{NE}$", ha="right", color=GREY, fontsize=LABEL)
    left.text(-2.45, -MU * EPS - 0.03, r"$-\mu\,\Lambda_{NE}$", color=GREY, fontsize=LABEL)
    left.set(ylim=(-0.3, 0.32), yticks=[-0.2, -0.1, 0.1, 0.2], xticks=[-2, -1, 1, 2])
    right.set(ylim=(-1.0, 1.1), yticks=[-0.8, -0.4, 0.4, 0.8], xticks=[-2, -1, 1, 2])
    axes_through_zero(left, r"slip before  $\dot g_{TA}$", r"$\Lambda_{TE}$")
    axes_through_zero(right, r"slip before  $\dot g_{TA}$", r"slip after  $\dot g_{TE}$")
    named(left, "Friction impulse of the expansion")
    named(right, "What becomes of the slip")
    right.legend(frameon=False, loc="upper left", fontsize=SMALL)
    save(made, path)


def draw_intervals(path: Path) -> None:
    """The set-valued characteristic of the expansion for each law, after a compression that pulled with half its cone."""
    made = figure(height=56.0, layout="constrained")
    panels = made.subplots(1, 3, sharey=True)
    pulled = 0.5 * MU  # Lambda_TC for Lambda_NC = 1
    share = min(BACK, EPS)
    ends = {
        "coulomb": (-MU * EPS, MU * EPS),
        "pg1996": (EPS * BACK * pulled, MU * EPS),
        "shifted": (share * pulled - MU * (EPS - share), share * pulled + MU * (EPS - share)),
    }
    for ax, (law, (low, high)) in zip(panels, ends.items(), strict=True):
        ax.plot([-1.0, 0.0, 0.0, 1.0], [high, high, low, low], color=LAW_COLOURS[law], lw=1.6, zorder=3)
        for x, y, side in ((-1.0, high, "left"), (1.0, low, "right")):
            text = f"{y:+.3f}".replace("-", "\N{MINUS SIGN}")
            ax.annotate(text, (x, y), (0, 4), textcoords="offset points", fontsize=SMALL, ha=side, color=INK)
        ax.set(ylim=(-0.3, 0.3), xlim=(-1.1, 1.1), xticks=[], yticks=[-0.2, -0.1, 0.1, 0.2])
        axes_through_zero(ax, r"$\dot g_{TE}$", r"$\Lambda_{TE}$")
        named(ax, law)
    save(made, path)


def draw_definitions(path: Path) -> None:
    """Unilateral contact, Coulomb friction and a dry bearing."""
    made = figure(height=54.0, layout="constrained")
    normal, friction, bearing = made.subplots(1, 3)
    normal.plot([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], color=INK, lw=1.6, zorder=3)
    axes_through_zero(normal, r"$\ddot g_N$ or $\dot g_N$", r"$\lambda_N$")
    named(normal, "normal: never pulls, never penetrates")
    friction.plot([-1.0, 0.0, 0.0, 1.0], [0.6, 0.6, -0.6, -0.6], color=INK, lw=1.6, zorder=3)
    axes_through_zero(friction, r"$\dot g_T$", r"$\lambda_T$")
    friction.text(-0.95, 0.66, r"$\mu\lambda_N$", color=INK, fontsize=LABEL)
    named(friction, "friction: grows with the normal force")
    bearing.plot([-1.0, 0.0, 0.0, 1.0], [0.6, 0.6, -0.6, -0.6], color=INK, lw=1.6, zorder=3)
    axes_through_zero(bearing, r"$\dot q$", "torque")
    bearing.text(-0.95, 0.66, r"$T$", color=INK, fontsize=LABEL)
    named(bearing, "dry bearing: a fixed bound")
    for ax in (normal, friction, bearing):
        ax.set(xticks=[], yticks=[], ylim=(-1.1, 1.1), xlim=(-1.1, 1.1))
    save(made, path)


PICTURES = {
    "contact_kinds.png": contact_kinds,
    "law_definitions.png": draw_definitions,
    "law_intervals.png": draw_intervals,
    "law_expansion.png": draw_expansion,
}
