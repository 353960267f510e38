"""How do co-axial and Swiss lever compare: amplitude, losses, friction, restitution, torque, inertias?

Every point is a limit cycle by `watchsim.steady`; losses are those of ten oscillations that begin on it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from coaxial_runs import STARTS, held_up_to, missing, near_amplitude
from coaxial_scenes import IMAGES, NAMES, bound, everywhere, pulled, supplied

import watchsim as ws
from watchsim.geometry.solids.mass import mass_properties
from watchsim.render.figures.figure_style import CURVE, SERIES, dress, figure, key, save
from watchsim.scene.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FRICTIONS, RESTITUTIONS = (0.0, 0.05, 0.10, 0.15, 0.20), (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)
PULLS = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3)  # shares of the torque
INERTIAS = (0.05, 0.07, 0.085, 0.1, 0.15, 0.2)  # mg·cm², of the co-axial wheel
INKS = {"coaxial": SERIES[0], "swiss_lever": SERIES[1]}
MARKS = {"coaxial": "o", "swiss_lever": "s"}
STEEL = 7850.0  # kg/m³
KEYS = {  # of both scenes alike; contacts have other numbers
    "torques.0.value": "torque",
    "damping.0.viscous": "damping of the balance",
    "springs.0.stiffness": "stiffness of the spring",
    "bodies.balance.inertia": "inertia of the balance",
    "bodies.wheel.inertia": "inertia of the wheel",
    "bodies.lever.inertia": "inertia of the lever",
}
CONTACTS = {  # what the scenes' contacts do
    "coaxial": {"contacts.0": "friction, locking", "contacts.1": "friction, direct impulse", "contacts.2": "friction, indirect impulse", "contacts.3": "friction, fork"},
    "swiss_lever": {"contacts.0": "friction, stones", "contacts.1": "friction, fork"},
}  # fmt: skip


@dataclass(frozen=True)
class Point:
    """A limit cycle and where its energy goes, shares of what is lost in an oscillation; nan where there is none."""

    amplitude: float
    rate: float
    beat_error: float
    efficiency: float
    friction: float
    impacts: float
    verdict: str


def settled(scene: Scene) -> Point:
    """The limit cycle, and ten oscillations of it."""
    cycle = ws.steady(scene)
    if not cycle.found or cycle.amplitude_deg is None or cycle.rate_s_per_d is None or cycle.beat_error_ms is None:
        return Point(math.nan, math.nan, math.nan, math.nan, math.nan, math.nan, str(cycle.verdict))
    assert cycle.period_s is not None
    run = ws.simulate(scene.set("bodies.balance.angle", f"{-cycle.amplitude_deg}°"), duration=10.0 * cycle.period_s)
    lost = run.energy["dissipated"]
    air, friction, impacts = (lost[name] / sum(lost.values()) for name in ("damping", "friction", "impacts"))
    return Point(cycle.amplitude_deg, cycle.rate_s_per_d, cycle.beat_error_ms, air, friction, impacts, "ticks")


def compared(both: dict[str, Scene]) -> str:
    """The table of the two as they are, without friction, and at best."""
    ends = {name: settled(scene) for name, scene in both.items()}
    smooth = {name: settled(everywhere(scene, 0.0, 0.0)) for name, scene in both.items()}
    weak = {name: settled(everywhere(pulled(scene, 0.6), 0.0, 0.0)) for name, scene in both.items()}
    drawn = {name: settled(pulled(scene, 0.6)) for name, scene in both.items()}
    rows = [
        ("work of the drive per oscillation, nJ", *(f"{1e9 * supplied(n, both[n]):.2f}" for n in both)),
        ("amplitude, °", *(f"{ends[n].amplitude:.4f}" for n in both)),
        ("amplitude without friction, °", *(number(smooth[n].amplitude, 2, smooth[n].verdict) for n in both)),
        ("amplitude if nothing were lost but to the air, °", *(f"{bound(supplied(n, both[n])):.2f}" for n in both)),
        ("at 0.6 of the torque: amplitude, °", *(f"{drawn[n].amplitude:.2f}" for n in both)),
        ("… without friction, °", *(number(weak[n].amplitude, 2, weak[n].verdict) for n in both)),
        ("… if nothing were lost but to the air, °", *(f"{bound(0.6 * supplied(n, both[n])):.2f}" for n in both)),
        ("rate, s/d", *(f"{ends[n].rate:+.3f}" for n in both)),
        ("beat error, ms", *(f"{ends[n].beat_error:.4f}" for n in both)),
        ("reaches the balance (efficiency)", *(f"{100 * ends[n].efficiency:.1f} %" for n in both)),
        ("lost in friction", *(f"{100 * ends[n].friction:.1f} %" for n in both)),
        ("lost in impacts", *(f"{100 * ends[n].impacts:.1f} %" for n in both)),
    ]
    return "| | co-axial | Swiss lever |\n|---|---:|---:|\n" + "\n".join("| " + " | ".join(row) + " |" for row in rows)


def number(value: float, digits: int, instead: str) -> str:
    return instead if math.isnan(value) else f"{value:.{digits}f}"


def series(both: dict[str, Scene], values: Iterable[float], made: Callable[[Scene, float], Scene]) -> dict[str, list[Point]]:
    """Limit cycles of both over one quantity."""
    at = list(values)
    return {name: [settled(made(scene, value)) for value in at] for name, scene in both.items()}


def table(title: str, values: Iterable[float], found: dict[str, list[Point]]) -> str:
    """Amplitude, rate and efficiency of both, row by row."""
    head = f"| {title} | " + " | ".join(f"{NAMES[n]}: amplitude, ° | rate, s/d | efficiency" for n in found) + " |"
    lines = [head, "|---:|" + "---:|---:|---:|" * len(found)]
    for k, value in enumerate(values):
        points = [found[name][k] for name in found]
        cells = [
            f"{one.amplitude:.2f} | {one.rate:+.2f} | {100 * one.efficiency:.1f} %"
            if one.verdict == "ticks"
            else f"{one.verdict} | |"
            for one in points
        ]
        lines.append(f"| {value:g} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def rubbed(both: dict[str, Scene]) -> tuple[str, str]:
    """Tables over friction and restitution, at 0.6 of the torque, where neither knocks; and their picture."""
    weak = {name: pulled(scene, 0.6) for name, scene in both.items()}
    friction = series(weak, FRICTIONS, lambda scene, x: everywhere(scene, x, 0.0))
    restitution = series(weak, RESTITUTIONS, lambda scene, x: everywhere(scene, 0.15, x))
    made, axes = _panels(2, 2)
    for column, (values, found, words) in enumerate(
        ((FRICTIONS, friction, "friction in all contacts"), (RESTITUTIONS, restitution, "restitution in all contacts"))
    ):
        for name, points in found.items():
            for row, quantity in enumerate(("amplitude", "rate")):
                _line(axes[2 * row + column], values, [getattr(one, quantity) for one in points], name)
        axes[2 + column].set_xlabel(words)
    axes[0].set_ylabel("amplitude (°)")
    axes[2].set_ylabel("rate (s/d)")
    key(axes[0], [(one, str(one.get_label())) for one in axes[0].lines])
    _saved(made, "friction")
    return table("friction", FRICTIONS, friction), table("restitution", RESTITUTIONS, restitution)


def driven(both: dict[str, Scene]) -> str:
    """The table over torque; two pictures: amplitude over the work of the drive, and rate over amplitude."""
    found = series(both, PULLS, pulled)
    smooth = series({n: everywhere(s, 0.0, 0.0) for n, s in both.items()}, PULLS, pulled)
    work = 1e9 * supplied("coaxial", both["coaxial"]) * np.array(PULLS)
    made, (axes,) = _panels(1, 1)
    for name in both:
        _line(axes, work, [one.amplitude for one in found[name]], name)
        _line(axes, work, [one.amplitude for one in smooth[name]], name, dashed=True, words=f"{NAMES[name]}, no friction")
    axes.plot(work, [bound(1e-9 * one) for one in work], color="#777777", label="all of the work reaches the balance")
    axes.set_xlabel("work of the drive in an oscillation (nJ)")
    axes.set_ylabel("amplitude (°)")
    key(axes, [(one, str(one.get_label())) for one in axes.lines])
    _saved(made, "best")
    made, (axes,) = _panels(1, 1)
    for name in both:
        _line(axes, [one.amplitude for one in found[name]], [one.rate for one in found[name]], name)
    axes.set_xlabel("amplitude (°), by torque")
    axes.set_ylabel("rate (s/d)")
    key(axes, [(one, str(one.get_label())) for one in axes.lines])
    _saved(made, "isochronism")
    return table("share of the torque", PULLS, found)


def wheels(scene: Scene) -> str:
    """What the inertia of the co-axial wheel does, at one torque and with the torque that makes up for it."""
    lines = [
        "| inertia of the wheel, mg·cm² | amplitude, ° | rate, s/d | efficiency | lost in impacts "
        "| torque for 290°, µN·m | there every impulse given from 60° up to, ° |",
        "|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for inertia in INERTIAS:
        own = scene.set("bodies.wheel.inertia", f"{inertia} mg·cm²")
        one, torque = settled(own), near_amplitude(own, 290.0)
        if torque is None:
            strong = "no cycle found | "
        else:
            strong = f"{torque:.3f} | {held_up_to([missing(own, torque, start) for start in STARTS]):.0f}"
        if one.verdict == "ticks":
            shares = f"{100 * one.efficiency:.1f} % | {100 * one.impacts:.1f} %"
            lines.append(f"| {inertia:g} | {one.amplitude:.2f} | {one.rate:+.2f} | {shares} | {strong} |")
        else:
            hovers = ws.steady(own).amplitude_deg
            lines.append(f"| {inertia:g} | about {hovers:.0f}, no cycle found | | | | {strong} |")
    return "\n".join(lines)


def matters(both: dict[str, Scene]) -> str:
    """What 1 % more of each number, or 0.01 more friction, does to amplitude and rate (`sweep --sensitivity`)."""
    rows: dict[str, dict[str, tuple[float, float]]] = {}
    for name, scene in both.items():
        meaning = KEYS | {f"{key}.friction": text for key, text in CONTACTS[name].items()}
        found = ws.sensitivity(scene, meaning, outputs=["amplitude", "rate"])
        for effect in found.effects:
            change = 0.01 * (1.0 if effect.quantity.key.startswith("contacts") else effect.quantity.value)
            values = [effect.of(column, change) for column in ("amplitude_deg", "rate_s_per_d")]
            amplitude, rate = (math.nan if value is None else value for value in values)
            rows.setdefault(meaning[effect.quantity.key], {})[name] = (amplitude, rate)
    lines = [
        "| | co-axial: amplitude, ° | rate, s/d | Swiss lever: amplitude, ° | rate, s/d |",
        "|---|---:|---:|---:|---:|",
    ]
    for words, by in sorted(rows.items(), key=lambda item: item[0].startswith("friction")):
        cells = [f"{by[n][0]:+.3f} | {by[n][1]:+.3f}" if n in by else " | " for n in both]
        lines.append(f"| {words}, {'0.01' if words.startswith('friction') else '1 %'} more | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def weighed(scene: Scene) -> str:
    """The inertia of the wheel as drawn, in steel, from its outlines."""
    wheel = scene.body("wheel")
    lines = ["| large wheel, mm thick | small wheel, mm thick | together in steel, mg·cm² |", "|---:|---:|---:|"]
    for large, small in ((0.10, 0.12), (0.12, 0.15), (0.15, 0.20)):
        total = 0.0
        for layer, thickness in (("TEETH", large), ("SMALL_TEETH", small)):
            own = [loop for loop in wheel.loops if loop.layer == layer]
            total += 1e10 * mass_properties(own, 1e-3 * thickness, STEEL).inertia
        lines.append(f"| {large:.2f} | {small:.2f} | {total:.4f} |")
    return "\n".join(lines)


def _panels(rows: int, columns: int) -> tuple[Figure, list[Axes]]:
    made = figure(height=58.0 * rows + 17.0 * (rows == 1), layout="constrained")
    found: list[Any] = list(made.subplots(rows, columns, squeeze=False, sharex="col").flat)
    for axes in found:
        dress(axes)
        axes.ticklabel_format(useOffset=False)
    return made, found


def _line(axes: Axes, x: Any, y: list[float], name: str, *, dashed: bool = False, words: str = "") -> None:
    style = "--" if dashed else "-"
    axes.plot(x, y, style, marker=MARKS[name], markersize=2.6, color=INKS[name], linewidth=CURVE, label=words or NAMES[name], alpha=0.6 if dashed else 1.0)  # fmt: skip


def _saved(made: Figure, name: str) -> None:
    save(made, IMAGES / f"coaxial_{name}.png")
