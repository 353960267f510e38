"""How far do the parts of an escapement slide along each other in one oscillation, and what does that take?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from coaxial_scenes import NAMES

import watchsim as ws
from watchsim.analysis.timing.phases import phases
from watchsim.scene.scene import Scene

AROUND, POINTS = 0.012, 4801  # s to either side of the passage of rest, and instants in it
EVEN = 5e-2  # s before a passage: there nothing touches


@dataclass(frozen=True)
class Slide:
    """How far two layers slid along each other in one oscillation (m), and what friction took there (J)."""

    way: float
    work: float


def slides(run: ws.Trajectory) -> dict[tuple[str, str], Slide]:
    """Of the last whole oscillation of a run, by pairs of layers and phase: slip and friction force, summed over fine steps."""
    events = run.events
    passes = events[(events["kind"] == ws.EventKind.CROSS) & (events["value"] > 0.0)]["t"]
    start, stop = passes[-2] - EVEN, passes[-1] - EVEN
    near = [t + np.linspace(-AROUND, AROUND, POINTS) for t in (passes[-2], 0.5 * (passes[-2] + passes[-1]))]
    times = np.unique(np.concatenate((run.t, *near)))
    times = times[(times > start) & (times < stop)]
    found, steps = ws.forces(run, times), np.diff(times)
    _, u = run.sample(times)
    spans = [(one.start, one.end) for one in phases(run) if one.name == "unlock"]
    unlocking = np.any([(times[:-1] >= a) & (times[1:] <= b) for a, b in spans], axis=0)
    out: dict[tuple[str, str], Slide] = {}
    for column, k in enumerate(found.pairs.tolist()):
        pair = run.pairs[k]
        slip = np.zeros(len(times))
        for name, sign in ((pair.body_a, 1.0), (pair.body_b, -1.0)):
            if name in run.slices:
                x, y = run.scene.body(name).position
                arm = found.point[:, column] - (x, y)
                nx, ny = found.direction[:, column].T
                slip += sign * u[:, run.slices[name].start] * (arm[:, 1] * ny + arm[:, 0] * nx)
        on = np.isfinite(slip) & (found.normal[:, column] > 0.0)
        speed = np.where(on, np.abs(np.nan_to_num(slip)), 0.0)
        power = speed * np.abs(found.tangential[:, column])
        both = on[1:] & on[:-1]
        names = " – ".join(sorted((f"{pair.body_a}.{pair.layer_a}", f"{pair.body_b}.{pair.layer_b}")))
        for phase, chosen in (("unlocking", both & unlocking), ("impulse", both & ~unlocking)):
            was = out.get((names, phase), Slide(0.0, 0.0))
            way, work = (float(np.sum((0.5 * (f[1:] + f[:-1]) * steps)[chosen])) for f in (speed, power))
            out[names, phase] = Slide(was.way + way, was.work + work)
    return {name: one for name, one in out.items() if one.way > 1e-9}


def table(both: dict[str, Scene]) -> str:
    """Both escapements on their limit cycles."""
    lines = ["| escapement | layers | while | slid per oscillation, µm | friction's work, nJ |", "|---|---|---|---:|---:|"]
    for name, scene in both.items():
        amplitude = ws.steady(scene).amplitude_deg
        assert amplitude is not None
        found = slides(ws.simulate(scene.set("bodies.balance.angle", f"{-amplitude}°"), duration=2.0))
        for (layers, phase), one in sorted(found.items(), key=lambda item: -item[1].way):
            lines.append(f"| {NAMES[name]} | {layers} | {phase} | {1e6 * one.way:.1f} | {1e9 * one.work:.4f} |")
    return "\n".join(lines)
