"""How fast does Moreau's time stepping come to the event-driven answer? Writes docs/reports/convergence.md and its picture.

    python scripts/reports/convergence.py [--quick] [--page FILE]

The incline is measured against its closed form, the others against the event-driven solver at its scene's tolerance.
The exit status is 1 where an error hardly falls with the step.
"""

import argparse
import dataclasses
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
from measured import REDRAW, keep, kept

from watchsim.paths import profiles_dir
from watchsim.scene.forces import Damping
from watchsim.scene.load import load
from watchsim.scene.scene import EVERYTHING, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.trajectory import Trajectory
from watchsim.verification.checks import Incline, incline_state
from watchsim.verification.hard_cases import dry_balance
from watchsim.verification.repeated_impacts import pulled_block

PAGE = Path(__file__).resolve().parents[2] / "docs" / "reports" / "convergence.md"
PICTURE = "convergence.png"
IMAGES = PAGE.parents[1] / "images"
STEPS = (5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6)
SLOWEST = 0.25  # order of an error that falls: first order scatters down to 0.4 over three steps, an error that lasts has 0
INSTANTS = 4001  # at which levers are compared
Found = dict[tuple[str, str], tuple[list[float], list[float]]]
Errors = Callable[[Trajectory], dict[str, float]]


@dataclasses.dataclass(frozen=True)
class Case:
    """A scene, how long, the steps, and the errors of a run."""

    name: str
    scene: Scene
    duration: float
    steps: tuple[float, ...]
    errors: Errors


def inclines(steps: tuple[float, ...]) -> list[Case]:
    """The disc after a second: place along the plane."""
    out = []
    for file, mu in (("scene.toml", 0.3), ("scene_mu013.toml", 0.13), ("scene_mu010.toml", 0.10)):
        truth = incline_state(Incline(mu), 1.0).x

        def errors(run: Trajectory, truth: float = truth) -> dict[str, float]:
            return {"place, m/m": abs(run.q[-1, 0] / truth - 1.0)}

        out.append(Case(f"incline, friction {mu:g}", load(profiles_dir() / "incline" / file), 1.0, steps, errors))
    return out


def levers(steps: tuple[float, ...], duration: float) -> list[Case]:
    """The bench lever without and with restitution and with dry bearings, and the Swiss lever."""
    bench, swiss = (load(profiles_dir() / name / "scene.toml") for name in ("bench_lever", "swiss_lever"))
    inelastic = dataclasses.replace(bench, contacts=tuple(dataclasses.replace(c, restitution=0.0) for c in bench.contacts))
    dry = tuple(Damping(body.name, coulomb=2e-9) for body in bench.bodies if body.motion == "pivot")
    dried = dataclasses.replace(bench, damping=(*bench.damping, *dry))
    named = (
        ("bench lever, restitution 0", inelastic),
        ("bench lever, restitution 0.2", bench),
        ("bench lever, dry bearings", dried),
        ("Swiss lever", swiss),
    )
    return [_lever(name, scene, duration, steps) for name, scene in named]


def sticking(steps: tuple[float, ...]) -> list[Case]:
    """What sticks and slips: a balance with dry bearings, a block on a moving belt."""
    return [
        _at_the_end("balance with dry bearings", dry_balance().scene, 1.0, steps),
        _at_the_end("block on a moving belt", pulled_block().scene, 1.5, steps),
    ]


def _at_the_end(name: str, scene: Scene, duration: float, steps: tuple[float, ...]) -> Case:
    scene = dataclasses.replace(scene, record=EVERYTHING)
    truth = simulate(scene, duration)
    size = np.abs(truth.q).max()

    def errors(run: Trajectory) -> dict[str, float]:
        return {"place, m/m": float(np.abs(run.q[-1] - truth.q[-1]).max() / size)}

    return Case(name, scene, duration, steps, errors)


def _lever(name: str, scene: Scene, duration: float, steps: tuple[float, ...]) -> Case:
    scene = dataclasses.replace(scene, record=EVERYTHING)
    times = np.linspace(0.0, duration, INSTANTS)
    truth = simulate(scene, duration)
    exact = truth.sample(times)[0]

    def errors(run: Trajectory) -> dict[str, float]:
        apart = np.abs(run.sample(times)[0] - exact).mean(axis=0)
        return {f"{body}, rad": float(apart[truth.slices[body]][0]) for body in ("balance", "lever", "wheel")}

    return Case(name, scene, duration, steps, errors)


def study(cases: list[Case]) -> Found:
    """Steps and errors of each quantity of each case; prints them as they come."""
    found: Found = {}
    for case in cases:
        for step in case.steps:
            run = simulate(case.scene, case.duration, method="moreau", step=step)
            errors = case.errors(run)
            print(
                f"{case.name:28} {step:8.0e} s  " + "  ".join(f"{name} {value:.2e}" for name, value in errors.items()),
                flush=True,
            )
            for name, value in errors.items():
                steps, values = found.setdefault((case.name, name), ([], []))
                steps.append(step)
                values.append(value)
    return found


def order(steps: list[float], errors: list[float]) -> float:
    """Slope of the straight line through the logarithms."""
    good = np.isfinite(errors) & (np.array(errors) > 0.0)
    return float(np.polyfit(np.log(np.array(steps)[good]), np.log(np.array(errors)[good]), 1)[0])


def picture(found: Found, path: Path) -> None:
    """Errors over steps, doubly logarithmic, with a line of slope 1."""
    from watchsim.render.palette import FAINT
    from watchsim.render.style import CURVE, MARKERS, SERIES, dress, figure, key, save
    from watchsim.render.style import title as named

    made = figure(height=80.0, layout="constrained")
    axes = made.subplots(1, 2)
    panels = (
        ("place, m/m", "Incline, dry bearings, stick and slip", "relative error of place"),
        ("balance, rad", "Levers: balance", "mean difference of angle, rad"),
    )
    for axis, (quantity, title, label) in zip(axes, panels, strict=True):
        shown = [(case, *both) for (case, name), both in found.items() if name == quantity]
        for (case, steps, errors), colour, mark in zip(shown, SERIES, MARKERS, strict=False):
            look = {"color": colour, "marker": mark, "markersize": 3.0, "linewidth": CURVE}
            axis.loglog(steps, errors, label=f"{case}: order {order(steps, errors):.2f}", **look)
        low, high = axis.get_xlim()
        middle = math.sqrt(np.prod(axis.get_ylim()))
        ends = np.array([low, high])
        axis.loglog(
            ends, middle * ends / math.sqrt(low * high), color=FAINT, linestyle="--", linewidth=CURVE, label="slope 1", zorder=0
        )
        axis.set(xlabel="step, s", ylabel=label)
        named(axis, title)
        dress(axis)
        axis.set_ylim(top=20.0 * axis.get_ylim()[1])  # room for the legend
        key(axis, [(line, str(line.get_label())) for line in axis.lines], loc="upper left")
    save(made, path)


HEAD = """# Two methods, one motion

Moreau's time stepping ([method](../theory/method.md) 6) shares the model and the gap functions with the event-driven solver,
but neither its search for events nor its complementarity solver. As its step shrinks it must come to the same motion, at first
order. The incline is compared with its closed form after 1 s; a balance with dry bearings, a block on a moving belt and the
levers against the event-driven solver: of the levers, the mean difference of angles over the first {levers:g} s, four
beats. Written by `scripts/reports/convergence.py`.

![errors over step](../images/{picture})

*Order* is the slope of the straight line through the logarithms of step and error. Which step an impact falls into is a
matter of chance, so errors scatter about the line.

| case | error of | {steps} | order |
|---|---|{rules}---:|"""


def page(found: Found, steps: tuple[float, ...], seconds: float) -> str:
    """The whole page."""
    head = HEAD.format(
        levers=seconds, picture=PICTURE, steps=" | ".join(f"{step:.0e} s" for step in steps), rules="---:|" * len(steps)
    )
    lines = [head]
    for (case, name), (sizes, errors) in found.items():
        told = dict(zip(sizes, errors, strict=True))
        cells = " | ".join(f"{told[step]:.1e}" for step in steps)
        lines.append(f"| {case} | {name} | {cells} | {order(sizes, errors):.2f} |")
    return "\n".join(lines) + "\n"


def _keep(found: Found) -> None:
    """One row for each error in docs/reports/convergence.csv."""
    rows = ((case, what, *pair) for (case, what), columns in found.items() for pair in zip(*columns, strict=True))
    keep("convergence", (dict(zip(("case", "quantity", "step_s", "error"), row, strict=True)) for row in rows))


def _kept() -> Found:
    found: Found = {}
    for row in kept("convergence"):
        steps, errors = found.setdefault((row["case"], row["quantity"]), ([], []))
        steps.append(row["step_s"])
        errors.append(row["error"])
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="three steps, a fifth of a second")
    parser.add_argument("--page", type=Path, default=PAGE)
    parser.add_argument("--redraw", action="store_true", help=REDRAW)
    args = parser.parse_args()
    if args.redraw:
        picture(_kept(), IMAGES / PICTURE)
        return
    steps = STEPS[:3] if args.quick else STEPS
    seconds = 0.2 if args.quick else 0.5
    found = study([*inclines(steps), *sticking(steps), *levers(steps, seconds)])
    args.page.write_text(page(found, steps, seconds), encoding="utf-8")
    if not args.quick:
        _keep(found)
    picture(found, args.page.parent.parent / "images" / PICTURE)
    orders = {" ".join(names): order(*both) for names, both in found.items()}
    if away := [f"{names}: order {slope:.2f}" for names, slope in orders.items() if slope < SLOWEST]:
        raise SystemExit("\n".join(away))


if __name__ == "__main__":
    main()
