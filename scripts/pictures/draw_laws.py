"""How do the pictures of the contact laws in docs/laws come about?

The characteristics of the expansion are read off the solver itself: one contact of a rigid body, the slip before it swept,
the impulses and rates of both phases as the solver's own `impact` gives them. The characteristics of normal contact, of
friction while bodies touch and of a dry bearing are drawn from their definitions.

    python scripts/pictures/draw_laws.py
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from watchsim.render.figures.figure_style import HAIR, LABEL, SERIES, SMALL, TICK, figure, save
from watchsim.render.figures.figure_style import title as named
from watchsim.render.palette import FAINT, INK
from watchsim.verification.bare_contacts import BareContacts

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images"
GREY = FAINT
COLOURS = dict(zip(("coulomb", "pg1996", "shifted"), SERIES, strict=False))
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


def draw_expansion() -> None:
    """Left: friction impulse of the expansion over the slip after it. Right: slip after over slip before the impact."""
    made = figure(height=68.0, layout="constrained")
    left, right = made.subplots(1, 2)
    slips = np.linspace(-2.5, 2.5, 2001)
    for law, colour in COLOURS.items():
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
    save(made, IMAGES / "law_expansion.png")


def draw_intervals() -> None:
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
        ax.plot([-1.0, 0.0, 0.0, 1.0], [high, high, low, low], color=COLOURS[law], lw=1.6, zorder=3)
        for x, y, side in ((-1.0, high, "left"), (1.0, low, "right")):
            text = f"{y:+.3f}".replace("-", "\N{MINUS SIGN}")
            ax.annotate(text, (x, y), (0, 4), textcoords="offset points", fontsize=SMALL, ha=side, color=INK)
        ax.set(ylim=(-0.3, 0.3), xlim=(-1.1, 1.1), xticks=[], yticks=[-0.2, -0.1, 0.1, 0.2])
        axes_through_zero(ax, r"$\dot g_{TE}$", r"$\Lambda_{TE}$")
        named(ax, law)
    save(made, IMAGES / "law_intervals.png")


def draw_definitions() -> None:
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
    save(made, IMAGES / "law_definitions.png")


def main() -> None:
    IMAGES.mkdir(parents=True, exist_ok=True)
    draw_definitions()
    draw_intervals()
    draw_expansion()


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    arguments(__doc__)
    main()
