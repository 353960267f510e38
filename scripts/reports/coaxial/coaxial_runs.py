"""Does the co-axial escapement run: long runs, the range in which no impulse is missed, and how exact is all that?"""

from __future__ import annotations

import math
import time

import numpy as np
from coaxial_scenes import IMAGES, TORQUE

import watchsim as ws
from watchsim.scene.file.read_scene import changed
from watchsim.scene.scene import Scene

TORQUES = (0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.48, 0.6, 0.8, 1.0)  # µN·m
STARTS = (60.0, 90.0, 120.0, 150.0, 180.0, 210.0, 240.0, 270.0, 290.0, 310.0, 330.0)  # degrees
LONG, SHORT = 180.0, 4.0  # s
KNOCKS = 337.0  # degrees: there the pin strikes the outside of the fork
PERIOD = 1.0 / 3.5  # s
CLOSE = 0.05  # degrees
LOOKS = (
    (0, "#009e73", "o", "every impulse given"),
    (1, "#e69f00", "s", "indirect impulse missed"),
    (2, "#d55e00", "v", "direct impulse missed too"),
    (3, "#cc79a7", "X", "knocks"),
)


def given(run: ws.Trajectory) -> dict[str, list[bool]]:
    """For every passage of the rest position, whether its impulse was given: counter-clockwise direct, clockwise indirect."""
    events = run.events
    closing = events[events["kind"] == ws.EventKind.CLOSE]
    pairs = [run.pairs[k] if k >= 0 else None for k in closing["contact"].tolist()]
    on_balance = [pair is not None and {pair.body_a, pair.body_b} == {"wheel", "balance"} for pair in pairs]
    by_small = [pair is not None and "SMALL_TEETH" in (pair.layer_a, pair.layer_b) for pair in pairs]
    direct, indirect = closing["t"][on_balance], closing["t"][by_small]
    crossings = events[events["kind"] == ws.EventKind.CROSS]
    out: dict[str, list[bool]] = {"direct": [], "indirect": []}
    for t, way in zip(crossings["t"], crossings["value"], strict=True):
        if t < run.t[-1] - 0.25 * PERIOD:
            name, own = ("direct", direct) if way > 0.0 else ("indirect", indirect)
            out[name].append(bool(np.any(np.abs(own - t) < 0.25 * PERIOD)))
    return out


def teeth(run: ws.Trajectory) -> float:
    """By which the wheel went on."""
    column = run.slices["wheel"].start
    return float(abs(run.end_q[column] - run.q[0, column]) / (math.tau / 8.0))


def long_runs(scene: Scene) -> str:
    """180 s from three starts."""
    lines = [
        "| start, ° | teeth in 630 oscillations | impulses missed | amplitude, ° | rate, s/d | energy account | × real time |",
        "|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for start in (150.0, 330.0, 290.0):
        began = time.process_time()
        run = ws.simulate(scene.set("bodies.balance.angle", f"{-start}°"), duration=LONG)
        speed = LONG / (time.process_time() - began)
        told, found = ws.summary(run), given(run)
        missed = sum(not one for name in found for one in found[name])
        counted = f"{teeth(run):.4f} | {missed} of {sum(map(len, found.values()))}"
        timed = f"{told['amplitude_deg']:.6f} | {told['rate_s_per_d']:.6f} | {run.energy['residual_relative']:.1e}"
        lines.append(f"| {start:.0f} | {counted} | {timed} | {speed:.0f} |")
    return "\n".join(lines)


def missing(scene: Scene, torque: float, start: float) -> int:
    """0: every impulse given in 4 s; 1, 2, 3: as in LOOKS."""
    asked = {"torques.0.value": f"{-torque} µN·m", "bodies.balance.angle": f"{-start}°"}
    run = ws.simulate(changed(scene, asked), duration=SHORT)
    if float(ws.beats(run).amplitude_deg.max(initial=0.0)) > KNOCKS:
        return 3
    found = given(run)
    return 2 if not all(found["direct"]) else 1 if not all(found["indirect"]) else 0


def held_up_to(kinds: list[int]) -> float:
    """The largest start up to which no impulse is missed from any start, °."""
    count = next((i for i, kind in enumerate(kinds) if kind), len(kinds))
    return STARTS[count - 1] if count else math.nan


def range_map(scene: Scene) -> str:
    """The map of starts and torques; picture and text."""
    from watchsim.render.figures.figure_style import CURVE, dress, figure, key, save
    from watchsim.render.palette import INK

    kinds = np.array([[missing(scene, torque, start) for torque in TORQUES] for start in STARTS])
    steady = [ws.steady(scene.set("torques.0.value", f"{-torque} µN·m")).amplitude_deg for torque in TORQUES]
    made = figure(height=100.0, layout="constrained")
    axes = made.subplots()
    for kind, colour, mark, words in LOOKS:
        rows, columns = np.nonzero(kinds == kind)
        if len(rows):
            axes.plot(np.array(TORQUES)[columns], np.array(STARTS)[rows], mark, color=colour, markersize=4.5, label=words)
    settles = [math.nan if value is None else value for value in steady]
    axes.plot(TORQUES, settles, "-", color=INK, linewidth=CURVE, label="where it settles")
    axes.set_xscale("log")
    axes.set_xticks(TORQUES, [f"{t:g}" for t in TORQUES])
    axes.minorticks_off()
    axes.set_xlabel("torque on the escape wheel (µN·m)")
    axes.set_ylabel("amplitude at the start (°)")
    axes.set_ylim(40.0, 350.0)
    dress(axes)
    entries = [(line, str(line.get_label())) for line in axes.lines]
    key(axes, entries, loc="upper center", bbox_to_anchor=(0.5, 1.1), ncols=5)
    save(made, IMAGES / "coaxial_range.png")
    lines = ["| torque, µN·m | settles at, ° | every impulse given from 60° up to, ° |", "|---:|---:|---:|"]
    for j, torque in enumerate(TORQUES):
        settled = "knocks" if steady[j] is None else f"{steady[j]:.1f}"
        lines.append(f"| {torque:g} | {settled} | {held_up_to(kinds[:, j].tolist()):.0f} |")
    return "\n".join(lines)


def accuracy(scene: Scene) -> str:
    """Tolerances: the end of a run, and the cycle itself."""
    near = scene.set("bodies.balance.angle", "-289.9°")
    lines = [
        "| tolerance | amplitude after 60 s, ° | rate, s/d | amplitude of the cycle, ° | rate, s/d |",
        "|---|---:|---:|---:|---:|",
    ]
    for tolerance in (1e-8, 1e-9, 1e-10, 1e-11):
        told, cycle = ws.summary(ws.simulate(near, duration=60.0, tolerance=tolerance)), ws.steady(near, tolerance=tolerance)
        run = f"{told['amplitude_deg']:.7f} | {told['rate_s_per_d']:.7f}"
        lines.append(f"| {tolerance:g} | {run} | {cycle.amplitude_deg:.7f} | {cycle.rate_s_per_d:.7f} |")
    return "\n".join(lines)


def near_amplitude(scene: Scene, wanted: float) -> float | None:
    """The torque (µN·m) at which the scene settles at that amplitude (°): it grows as the square root; None where no cycle is found."""
    torque = TORQUE
    for _ in range(6):
        cycle = ws.steady(scene.set("torques.0.value", f"{-torque} µN·m"))
        assert cycle.amplitude_deg is not None
        if cycle.found and abs(cycle.amplitude_deg - wanted) < CLOSE:
            return torque
        torque *= (wanted / cycle.amplitude_deg) ** 2
    return None
