"""The pictures of the pages, and the pages that hold little else.

    python scripts/draw_pictures.py kinds|laws|beat|mechanisms|movies|gallery|plots|tolerances|positions|shrink [profile]

kinds: the kinds of contact (docs/theory/contact-geometry.md); laws: the laws of contact, the expansion read off the solver
itself; beat: angles and velocities of the Swiss lever; mechanisms, movies: those of docs/guide/mechanisms.md, of one profile
or all; gallery, plots: docs/guide/gallery.md and plots.md, from the commands that they show;
tolerances: the studies of docs/guide/tolerances.md; positions: the dials of docs/guide/positions.md. shrink goes last.
"""

from __future__ import annotations

import math
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Curve
from PIL import Image

import watchsim as ws
from watchsim.geometry.loops import Loop, polyline
from watchsim.geometry.primitives import Arc, Line, Point
from watchsim.render.palette import BRASS, FAINT, INK, STEEL
from watchsim.render.style import HAIR, LABEL, SERIES, SMALL, TICK, figure, save
from watchsim.render.style import title as named
from watchsim.verification.random_problems import BareContacts

ROOT = Path(__file__).resolve().parents[1]
IMAGES = ROOT / "docs" / "images"

KINDS = IMAGES / "contact_kinds.png"
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


def contact_kinds() -> None:
    made = figure(height=100.0, layout="constrained")
    axes = made.subplots(2, 3)
    for ax, (title, a, pose, b) in zip(axes.ravel(), PANELS, strict=True):
        panel(ax, title, a, pose, b)
    KINDS.parent.mkdir(parents=True, exist_ok=True)
    save(made, KINDS)


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


def draw_expansion() -> None:
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
        ax.plot([-1.0, 0.0, 0.0, 1.0], [high, high, low, low], color=LAW_COLOURS[law], lw=1.6, zorder=3)
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


def laws() -> None:
    IMAGES.mkdir(parents=True, exist_ok=True)
    draw_definitions()
    draw_intervals()
    draw_expansion()


SIZE = (960, 540)
SHOWN = {  # profile: simulated (s), instant (s), bodies to show close (None: all)
    "geneva": (1.0, 0.2, None),
    "geneva_stop": (4.0, 4.0, None),
    "graham": (2.0, 1.76, ["wheel"]),
    "recoil_anchor": (2.0, 1.76, ["wheel"]),
    "detent": (2.5, 2.1275, None),
    "pin_pallet": (2.2, 2.101, None),
    "pin_wheel": (4.0, 3.52, ["wheel"]),
    "cylinder": (2.2, 2.1, None),
    "duplex": (2.2, 2.1055, None),
    "involute_pair": (0.2, 0.2, None),
    "cycloidal_pair": (0.2, 0.2, ["pinion"]),
    "jumper": (0.6, 0.49, None),
    "cam": (0.2, 0.1, None),
    "ratchet": (0.2, 0.15, None),
    "verge": (4.5, 4.42, ["verge"]),
    "winding_click": (0.5, 0.2, None),
    "snail": (3.4, 3.3, None),
    "grasshopper": (1.5, 1.35, ["wheel", "entry", "exit"]),
    "remontoir": (1.0, 0.942, ["stop_wheel", "stop_lever", "wheel"]),
    "tourbillon": (5.1, 5.0, None),
    "governor": (1.1, 1.0, None),
}


def mechanisms(names: list[str]) -> None:
    for name in names or SHOWN:
        duration, instant, close = SHOWN[name]
        run = ws.simulate(ws.load(ws.profiles_dir() / name / "scene.toml"), duration=duration)
        imageio.imwrite(IMAGES / f"{name}.png", ws.frame(run, instant, size=SIZE, zoom=close))


DURATION = 1.0  # s
BEATS = 0.2  # s to each side of the instant in the plot


def middle_of_an_impulse(run: ws.Trajectory) -> float:
    """Time of the passage through rest that is nearest to the middle of the run."""
    times = run.events["t"][run.events["kind"] == ws.EventKind.CROSS]
    return float(times[np.argmin(np.abs(times - 0.5 * run.simulated))])


def beat() -> None:
    run = ws.simulate(ws.load(ROOT / "profiles" / "swiss_lever" / "scene.toml"), duration=DURATION)
    t = middle_of_an_impulse(run)
    IMAGES.mkdir(parents=True, exist_ok=True)
    ws.plot_kinematics(run, window=(t - BEATS, t + BEATS)).savefig(IMAGES / "swiss_lever_beat.png")


FILMS = IMAGES / "movies"
LOOK = ("--size", "480x320", "--fps", "12")
MOVIES = {  # profile: simulated, window, speed, further options
    "geneva": ("1.5 s", "0 s:1.5 s", "1/2", ""),
    "geneva_stop": ("4 s", "0 s:4 s", "1", ""),
    "graham": ("5 s", "4 s:5 s", "1/4", "--zoom wheel"),
    "recoil_anchor": ("5 s", "4 s:5 s", "1/4", "--zoom wheel"),
    "grasshopper": ("5 s", "4 s:5 s", "1/4", "--zoom wheel,entry,exit"),
    "detent": ("2.6 s", "2 s:2.5 s", "adaptive", "--length 4s"),
    "pin_pallet": ("2.6 s", "2 s:2.4 s", "adaptive", "--length 4s --zoom wheel,lever"),
    "pin_wheel": ("6 s", "4 s:6 s", "1/2", "--zoom wheel"),
    "cylinder": ("2.6 s", "2 s:2.4 s", "adaptive", "--length 4s"),
    "duplex": ("2.6 s", "2 s:2.4 s", "adaptive", "--length 4s"),
    "involute_pair": ("0.4 s", "0.1 s:0.4 s", "1/12", "--zoom pinion"),
    "cycloidal_pair": ("0.4 s", "0.1 s:0.4 s", "1/12", "--zoom pinion"),
    "jumper": ("1 s", "0 s:1 s", "1/4", ""),
    "cam": ("0.3 s", "0 s:0.3 s", "1/10", ""),
    "snail": ("7.3 s", "4.95 s:7.25 s", "1/2", ""),
    "governor": ("1.2 s", "0 s:1.2 s", "1/4", ""),
    "ratchet": ("0.5 s", "0 s:0.5 s", "1/8", ""),
    "winding_click": ("0.5 s", "0 s:0.5 s", "1/8", ""),
    "remontoir": ("1 s", "0.93 s:0.96 s", "1/120", "--zoom stop_wheel,stop_lever,wheel"),
}


def movies(names: list[str]) -> None:
    from watchsim.cli import main as watchsim

    FILMS.mkdir(exist_ok=True)
    profiles = ROOT / "profiles"
    with tempfile.TemporaryDirectory() as folder:
        for name in names or MOVIES:
            duration, window, speed, options = MOVIES[name]
            run, movie = f"{folder}/{name}", str(FILMS / f"{name}.gif")
            assert watchsim(["run", str(profiles / name), "--duration", duration, "--no-plots", "-o", run]) == 0
            shown = ["--window", window, "--speed", speed, *LOOK, *options.split()]
            assert watchsim(["movie", run, *shown, "-o", movie]) == 0


GALLERY_PAGE = ROOT / "docs" / "guide" / "gallery.md"
GALLERY = IMAGES / "gallery"
LARGEST = 2_000_000  # bytes of one picture
SWISS = 'watchsim run profiles/swiss_lever --duration "1.2 s" -o swiss'
BEAT = '--window "0.69 s:0.94 s"'


@dataclass(frozen=True)
class Exhibit:
    """A picture: its file, what it shows, and the command that makes it; `also` is run before."""

    picture: str
    title: str
    words: str
    command: str
    also: str = ""


EXHIBITS = (
    Exhibit(
        "swiss_lever.gif",
        "An oscillation of a Swiss lever",
        "At adaptive speed: unlocking, impulse and drop get most of the frames, and the speed stands at the upper right. "
        "Arrows are the forces on the lever from the wheel, and on the roller's pin from the fork.",
        f"watchsim movie swiss {BEAT} --speed adaptive --length 5s --fps 16 --size 720x406 --phases --forces "
        '--inset "entry stone" --inset lever.FORK -o swiss_lever.gif',
        SWISS,
    ),
    Exhibit(
        "tall.gif",
        "The same, for a phone",
        "A tall picture has its insets above, and its strip of angle and velocity below; here on dark ground.",
        f"watchsim movie swiss {BEAT} --speed adaptive --length 4s --fps 12 --size 450x800 --dark --phases --strip "
        '--inset "entry stone" --inset "exit stone" -o tall.gif',
    ),
    Exhibit(
        "start.png",
        "The scene before it runs",
        "Edges that can ever touch another body are in colour.",
        "watchsim check profiles/swiss_lever --png start.png",
    ),
    Exhibit(
        "start_function.png",
        "Geometry of function",
        "Lock, draw, lift, drop and the freedoms of the safety action, measured on the drawing; the same command makes it.",
        "",
    ),
    Exhibit(
        "beat.png", "Angles and velocities", "Of all bodies over one oscillation.", f"watchsim plot swiss {BEAT} -o beat.png"
    ),
    Exhibit(
        "phases.png", "The phases of a beat", "From unlocking to the banking.", "watchsim plot swiss --phases -o phases.png"
    ),
    Exhibit(
        "timeline.png",
        "The mechanism during each phase",
        "With the forces on the lever. More [plots](plots.md).",
        "watchsim plot swiss --kind timeline -o timeline.png",
    ),
    Exhibit(
        "torque.png",
        "Torque on the balance",
        "What unlocking takes and the impulse gives is the area under the curve.",
        "watchsim plot swiss --kind torque -o torque.png",
    ),
    Exhibit(
        "cylinder.gif",
        "Before the lever: the cylinder",
        "A tooth rests on the cylinder outside and inside by turns; in between it lifts its lips.",
        'watchsim movie cylinder --window "1.3 s:1.7 s" --speed adaptive --length 4s --fps 12 --size 400x640 --dark '
        "--phases --forces -o cylinder.gif",
        'watchsim run profiles/cylinder --duration "2 s" -o cylinder',
    ),
    Exhibit(
        "duplex.png",
        "A duplex during each phase",
        "The wheel goes on in every other half swing: out of the notch, onto the pallet, and to rest on the roller.",
        "watchsim plot duplex --kind timeline -o duplex.png",
        'watchsim run profiles/duplex --duration "2 s" -o duplex',
    ),
    Exhibit(
        "pin_wheel.gif",
        "A tower clock",
        "The pin wheel with its pendulum of two seconds, at 4/3 of the true speed, and the pallets enlarged.",
        'watchsim movie tower --window "4 s:8 s" --speed 4/3 --fps 12 --size 320x640 --phases '
        "--inset pendulum.PALLETS -o pin_wheel.gif",
        'watchsim run profiles/pin_wheel --duration "8 s" -o tower',
    ),
    Exhibit(
        "incline.gif",
        "Not only watches",
        "A disc rolls, slides and sticks on an incline: one of the benchmarks with a closed form.",
        "watchsim movie incline --size 640x360 --fps 20 --forces --contacts -o incline.gif",
        "watchsim run profiles/incline -o incline",
    ),
)


def gallery() -> None:
    made(EXHIBITS, GALLERY)
    GALLERY_PAGE.write_text(page(EXHIBITS), encoding="utf-8")


def made(exhibits: Sequence[Exhibit], images: Path, first: str = "") -> None:
    """Run all commands in a folder of their own and keep the pictures."""
    images.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "profiles").symlink_to(ROOT / "profiles", target_is_directory=True)
        if first:
            run(first, place)
        for one in exhibits:
            for command in filter(None, (one.also, one.command)):
                run(command, place)
            picture = place / one.picture
            if picture.stat().st_size > LARGEST:
                raise SystemExit(f"{one.picture}: {picture.stat().st_size / 1e6:.1f} MB are too many")
            shutil.copyfile(picture, images / one.picture)


def run(command: str, folder: Path) -> None:
    """One command line of the page, with the watchsim of this folder tree."""
    words = shlex.split(command)
    found = os.environ.get("PYTHONPATH")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join((str(ROOT), found)) if found else str(ROOT)}
    if subprocess.run([sys.executable, "-m", *words], cwd=folder, env=environment, check=False).returncode != 0:
        raise SystemExit(f"failed: {command}")


def page(exhibits: Sequence[Exhibit]) -> str:
    """The page in Markdown."""
    parts = ["# Gallery\n\nEvery picture with the commands that make it. `scripts/draw_pictures.py gallery` makes this page.\n"]
    for one in exhibits:
        parts.append(f"## {one.title}\n\n{one.words}\n")
        if commands := "\n".join(filter(None, (one.also, one.command))):
            parts.append(f"```\n{commands}\n```\n")
        parts.append(f"![{one.title}](../images/gallery/{one.picture})\n")
    return "\n".join(parts)


PLOTS_PAGE = ROOT / "docs" / "guide" / "plots.md"
PLOT_IMAGES = IMAGES / "plots"
RUN = 'watchsim run profiles/swiss_lever --duration "20 s" -o swiss --no-plots'


PLOTS = (
    Exhibit(
        "kinematics.png",
        "Kinematics",
        "Angle and velocity of every body (`--bodies`, `--quantities angle,velocity,acceleration`) over the run or a `--window`. Where the window shows a few beats, their phases are shaded and named. Impacts are jumps. However many rows a run has, every spike is drawn: of each column of dots the curve keeps the first, last, least and largest value.",
        'watchsim plot swiss --window "19.55 s:19.85 s" -o kinematics.png',
    ),
    Exhibit(
        "phases.png",
        "The phases of a beat",
        "The last oscillation, and its two beats at large. `--phases` prints the tables of motion and energy, too.",
        "watchsim plot swiss --kind phases -o phases.png",
    ),
    Exhibit(
        "timeline.png",
        "The mechanism during each phase",
        "The parts around the lever in the middle of every phase, with the contact forces on the lever as arrows of one scale; numbers show when.",
        "watchsim plot swiss --kind timeline -o timeline.png",
    ),
    Exhibit(
        "torque.png",
        "Torque on the balance",
        "The moment of all contact forces on the balance over its angle, positive with its swing: below zero the balance unlocks, above it is driven. An area is the work of the forces; on it stands what the phase gives in all, with the impacts, the number of `phases.csv`. The table has both parts. They are worked out twice: from contact forces and jumps here, from the books of the balance there.",
        "watchsim plot swiss --kind torque -o torque.png",
    ),
    Exhibit(
        "forces.png",
        "Forces",
        "What the bodies of each pair press and rub, summed over their contacts, and the loads of the bearings. Impacts have impulses, not forces, and are not shown.",
        "watchsim plot swiss --kind forces -o forces.png",
    ),
    Exhibit(
        "portrait.png",
        "Phase portrait",
        "Velocity over angle of one oscillation, phases in colour.",
        "watchsim plot swiss --kind phase-portrait -o portrait.png",
    ),
    Exhibit(
        "energy.png",
        "Energy",
        "What was put in over the whole run, and where it went; below, each phase of the last two beats. The black line is the work of the drive; where bars reach beyond it stores gave the rest, to the left of zero.",
        "watchsim plot swiss --kind energy -o energy.png",
    ),
    Exhibit(
        "timing.png",
        "Amplitude, rate and beat error",
        "Of every half swing of whatever swings, heard or not.",
        "watchsim plot swiss --kind timing -o timing.png",
    ),
    Exhibit(
        "tape.png",
        "Paper of a timegrapher",
        "As an instrument would write it that hears the first noise of each beat.",
        "watchsim plot swiss --kind tape -o tape.png",
    ),
)
HEAD = f"""# Plots

`watchsim plot RUN --kind NAME` draws what is shown here, several kinds with commas, `--kind all` every one that the run has. Files are PNG,
SVG or PDF (`--format svg,pdf`, or the ending of `-o`). In Python each is a function that returns a matplotlib figure:
`ws.plot_kinematics`, `plot_phases`, `plot_timeline`, `plot_torque`, `plot_forces`, `plot_phase_portrait`, `plot_energy`, `plot_timing`, `plot_tape`; of studies
`plot_sweep` and `plot_sensitivity` ([studies](studies.md)). A notebook shows a figure that stands on the last line of a cell.

A figure is as wide as it will be printed: 170 mm for a page, `--width "85 mm"` (`width=85`) for a column, letters of 6 pt or more in both. Colours can
be told apart with every kind of colour vision, and no colour stands alone: names, dashes, marks or hatching go with it. `--dark` (`watchsim.render.palette.dark`) gives any of them dark ground. The same style draws all pictures
of these pages (`watchsim.render.style`). `scripts/draw_pictures.py plots` makes this page from

```
{RUN}
```
"""


def plots() -> None:
    made(PLOTS, PLOT_IMAGES, RUN)
    parts = [HEAD]
    for one in PLOTS:
        words = f"## {one.title}\n\n{one.words}\n\n```\n{one.command}\n```\n"
        parts.append(f"{words}\n![{one.title}](../images/plots/{one.picture})\n")
    PLOTS_PAGE.write_text("\n".join(parts), encoding="utf-8")


TOLERANCE_DPI = 160


def tolerances() -> None:
    """The studies of docs/guide/tolerances.md: 256 watches each, some minutes; what results/ holds is gone on with."""
    for scene in sorted((ROOT / "docs" / "guide" / "tolerances").glob("*.toml")):
        folder = ROOT / "results" / f"tolerances_{scene.stem}"
        study = ws.tolerance(scene, 256, workers=2, folder=folder, resume=True)
        ws.plot_tolerance(study).savefig(IMAGES / f"tolerances_{scene.stem}.png", dpi=TOLERANCE_DPI)
        print(f"{scene.stem}: {study.message}")


def positions() -> None:
    """The dials of docs/guide/positions.md."""
    found = ws.positions(ROOT / "docs" / "guide" / "positions" / "swiss_lever.toml", workers=2)
    ws.plot_positions(found).savefig(IMAGES / "positions.png", dpi=TOLERANCE_DPI)


def shrink() -> None:
    """PNG files with a palette of 256 colours where no pixel changes by more than can be seen (24 of 255, 0.3 on average)."""
    for path in IMAGES.rglob("*.png"):
        with Image.open(path) as picture:
            if picture.mode == "P":
                continue
            rgb = picture.convert("RGB")
        small = rgb.quantize(256, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
        off = np.abs(np.asarray(rgb, int) - np.asarray(small.convert("RGB"), int))
        if off.max() <= 24 and off.mean() <= 0.3:
            small.save(path, optimize=True)


PARTS = {
    "kinds": contact_kinds,
    "laws": laws,
    "beat": beat,
    "gallery": gallery,
    "plots": plots,
    "tolerances": tolerances,
    "positions": positions,
    "shrink": shrink,
}
OF_PROFILES = {"mechanisms": mechanisms, "movies": movies}

if __name__ == "__main__":
    from usage import arguments

    asked = arguments(
        __doc__, part=(..., ", ".join((*PARTS, *OF_PROFILES))), profile=("", "of mechanisms and movies, one of them")
    )
    if asked.part in PARTS:
        PARTS[asked.part]()
    elif asked.part in OF_PROFILES:
        OF_PROFILES[asked.part]([asked.profile] if asked.profile else [])
    else:
        raise SystemExit(f"{asked.part}: one of {', '.join((*PARTS, *OF_PROFILES))}")
