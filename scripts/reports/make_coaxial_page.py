"""How does the co-axial escapement do, beside the Swiss lever? Writes docs/guide/coaxial.md and its pictures.

    python scripts/reports/make_coaxial_page.py [folder]

Everything is run here, with the package's public functions; nothing is copied from anywhere. Takes some minutes.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import watchsim as ws
from watchsim.analysis.contact_forces import forces
from watchsim.analysis.timing.phases import phases
from watchsim.render.movies.run_movie import frame
from watchsim.render.stills.turn_picture import turn_picture
from watchsim.scene.file.read_scene import changed
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import EventKind, Trajectory
from watchsim.turning.happenings import passings
from watchsim.turning.report import turn_text
from watchsim.turning.turn import turn

TORQUES = (0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.48, 0.6, 0.8, 1.0)  # µN·m
STARTS = (60.0, 90.0, 120.0, 150.0, 180.0, 210.0, 240.0, 270.0, 290.0, 310.0, 330.0)  # degrees
LONG, SHORT, SETTLE = 180.0, 4.0, 90.0  # s
FRICTIONS, RESTITUTIONS, PULLS = (0.0, 0.05, 0.10, 0.15, 0.20), (0.0, 0.2, 0.4, 0.5), (0.6, 0.8, 1.0, 1.2, 1.4)
INERTIAS = (0.05, 0.1, 0.15, 0.2)  # mg·cm²
TORQUE = 0.48  # µN·m on the co-axial wheel
PULL = TORQUE * 15.0 / 8.0  # on the lever's escape wheel: the same work in an oscillation
NAMES = {"coaxial": "co-axial", "swiss_lever": "Swiss lever"}


def scenes() -> dict[str, Scene]:
    """Both at 12 mg·cm², 25 200 vph, Q 250, friction 0.15, restitution 0, and the same energy put in per oscillation."""
    found = {}
    for name, pull in (("coaxial", TORQUE), ("swiss_lever", PULL)):
        scene = ws.load(ws.profiles_dir() / name)
        alike = {
            "springs.0.frequency": "25200 vph",
            "torques.0.value": f"{-pull} µN·m",
            "damping.0.q_factor": 250,
            "run.record": "all",
        }
        found[name] = rubbed(changed(scene, {**alike, "bodies.balance.inertia": "12 mg·cm²"}), 0.15, 0.0)
    return found


def rubbed(scene: Scene, friction: float, restitution: float) -> Scene:
    """All contacts alike."""
    asked: dict[str, float] = {}
    for number in range(len(scene.contacts)):
        asked |= {f"contacts.{number}.friction": friction, f"contacts.{number}.restitution": restitution}
    return changed(scene, asked)


@dataclass(frozen=True)
class Outcome:
    """A settled run in numbers."""

    amplitude: float
    rate: float
    beat_error: float
    efficiency: float
    friction: float
    impacts: float
    missed: int


def settled(scene: Scene, start: float = 285.0) -> Outcome:
    """From a start near the end to the end."""
    run = ws.simulate(scene.set("bodies.balance.angle", f"{-start}°"), duration=SETTLE)
    told = ws.summary(run)
    found = run.energy["dissipated"]
    spent = sum(found.values())
    shares = [found[name] / spent for name in ("damping", "friction", "impacts")]
    amplitude, rate = told["amplitude_deg"], told["rate_s_per_d"]
    return Outcome(amplitude, rate, told["beat_error_ms"], shares[0], shares[1], shares[2], told["missed_beats"])


def touched(run: Trajectory) -> dict[str, list[bool]]:
    """For every passage of the rest position, whether its impulse was given: counter-clockwise direct, clockwise indirect."""
    events = run.events
    closing = events[events["kind"] == EventKind.CLOSE]
    layers = [{run.pairs[k].layer_a, run.pairs[k].layer_b} if k >= 0 else set() for k in closing["contact"].tolist()]
    bodies = [{run.pairs[k].body_a, run.pairs[k].body_b} if k >= 0 else set() for k in closing["contact"].tolist()]
    direct = closing["t"][[bool({"wheel", "balance"} == pair) for pair in bodies]]
    indirect = closing["t"][["SMALL_TEETH" in pair for pair in layers]]
    crossings = events[events["kind"] == EventKind.CROSS]
    quarter = 0.25 / 3.5
    out: dict[str, list[bool]] = {"direct": [], "indirect": []}
    for t, way in zip(crossings["t"], crossings["value"], strict=True):
        if t < run.t[-1] - quarter:
            name, own = ("direct", direct) if way > 0.0 else ("indirect", indirect)
            out[name].append(bool(np.any(np.abs(own - t) < quarter)))
    return out


def teeth(run: Trajectory) -> float:
    """By which the wheel went on."""
    column = run.slices["wheel"].start
    return float(abs(run.end_q[column] - run.q[0, column]) / (math.tau / 8.0))


def range_map(scene: Scene, folder: Path) -> str:
    """The map of starts and torques; picture and text."""
    from watchsim.render.figures.style import CURVE, SERIES, dress, figure, key, save
    from watchsim.render.palette import INK

    kinds = np.zeros((len(STARTS), len(TORQUES)), int)
    for i, start in enumerate(STARTS):
        for j, torque in enumerate(TORQUES):
            asked = {"torques.0.value": f"{-torque} µN·m", "bodies.balance.angle": f"{-start}°"}
            run = ws.simulate(changed(scene, asked), duration=SHORT)
            given = touched(run)
            missed = [not all(given[name]) for name in ("direct", "indirect")]
            knocks = float(ws.beats(run).amplitude_deg.max(initial=0.0)) > 337.0
            kinds[i, j] = 3 if knocks else 2 if missed[0] else 1 if missed[1] else 0
    steady = []
    for torque in TORQUES:
        start = min(330.0, 290.0 * math.sqrt(torque / TORQUE))
        steady.append(settled(scene.set("torques.0.value", f"{-torque} µN·m"), start).amplitude)
    made = figure(height=105.0, layout="constrained")
    axes = made.add_subplot()
    looks = (
        (0, SERIES[2], "o", "every impulse given"),
        (1, SERIES[4], "s", "indirect impulse missed"),
        (2, SERIES[1], "v", "direct impulse missed too"),
        (3, SERIES[0], "X", "knocks"),
    )
    for kind, colour, mark, words in looks:
        rows, columns = np.nonzero(kinds == kind)
        if len(rows):
            axes.plot(np.array(TORQUES)[columns], np.array(STARTS)[rows], mark, color=colour, markersize=5, label=words)
    axes.plot(TORQUES, steady, "-", color=INK, linewidth=CURVE, label="where it settles")
    axes.set_xscale("log")
    axes.set_xticks(TORQUES, [f"{t:g}" for t in TORQUES])
    axes.minorticks_off()
    axes.set_xlabel("torque on the escape wheel (µN·m)")
    axes.set_ylabel("amplitude at the start (°)")
    axes.set_ylim(40.0, 350.0)
    dress(axes)
    handles, names = axes.get_legend_handles_labels()
    key(axes, list(zip(handles, names, strict=True)), loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=5)
    save(made, folder / "images" / "coaxial_range.png")
    held = [
        max((a for i, a in enumerate(STARTS) if kinds[i, j] == 0 and all(kinds[k, j] == 0 for k in range(i))), default=math.nan)
        for j in range(len(TORQUES))
    ]
    lines = [f"| {t:g} | {a:.1f} | {h:.0f} |" for t, a, h in zip(TORQUES, steady, held, strict=True)]
    return "| torque, µN·m | settles at, ° | every impulse given from 60° up to, ° |\n|---:|---:|---:|\n" + "\n".join(lines)


@dataclass(frozen=True)
class Rubbing:
    """How far two layers slid along each other in one oscillation (m), and what that took (J)."""

    way: float
    work: float


def rubbing(run: Trajectory) -> dict[str, Rubbing]:
    """Of the last whole oscillation of a run, by pairs of layers: slip and friction force, summed over fine steps."""
    turns = run.events[(run.events["kind"] == EventKind.CROSS) & (run.events["value"] > 0.0)]["t"]
    start, stop = turns[-2] - 0.05, turns[-1] - 0.05
    inside = run.t[(run.t > start) & (run.t < stop)]
    times = np.unique(
        np.concatenate((inside, *(t + np.linspace(-0.012, 0.012, 4801) for t in (turns[-2], 0.5 * (turns[-2] + turns[-1])))))
    )
    times = times[(times > start) & (times < stop)]
    found = forces(run, times)
    _, u = run.sample(times)
    steps = np.diff(times)
    out: dict[str, Rubbing] = {}
    for column, k in enumerate(found.pairs.tolist()):
        pair = run.pairs[k]
        slip = np.zeros(len(times))
        for name, sign in ((pair.body_a, 1.0), (pair.body_b, -1.0)):
            if name in run.slices:
                x, y = run.scene.body(name).position
                arm = found.point[:, column] - (x, y)
                w = u[:, run.slices[name].start]
                nx, ny = found.direction[:, column].T
                slip += sign * w * (-arm[:, 1] * -ny + arm[:, 0] * nx)
        on = np.isfinite(slip) & (found.normal[:, column] > 0.0)
        speed = np.where(on, np.abs(np.nan_to_num(slip)), 0.0)
        power = speed * np.abs(found.tangential[:, column])
        both = on[1:] & on[:-1]
        names = " – ".join(sorted((f"{pair.body_a}.{pair.layer_a}", f"{pair.body_b}.{pair.layer_b}")))
        was = out.get(names, Rubbing(0.0, 0.0))
        way, work = (float(np.sum((0.5 * (f[1:] + f[:-1]) * steps)[both])) for f in (speed, power))
        out[names] = Rubbing(was.way + way, was.work + work)
    return {name: one for name, one in out.items() if one.way > 1e-9}


def best(pull: float, count: int) -> float:
    """Amplitude (°) if all the drive's work reached the oscillator: π k A²/Q·2/2 per oscillation."""
    k = 12e-10 * (math.tau * 3.5) ** 2
    return math.degrees(math.sqrt(1e-6 * pull * math.tau / count * 250.0 / (math.pi * k)))


def studies(both: dict[str, Scene]) -> tuple[str, str, str]:
    """Tables over friction, restitution and torque: amplitude and rate of both."""
    tables = []
    for title, values, make in (
        ("friction", FRICTIONS, lambda scene, x: rubbed(scene, x, 0.0)),
        ("restitution", RESTITUTIONS, lambda scene, x: rubbed(scene, 0.15, x)),
        ("torque, share", PULLS, lambda scene, x: scene.set("torques.0.value", f"{scene.torques[0].value * x * 1e6} µN·m")),
    ):
        head = (
            f"| {title} | "
            + " | ".join(f"{NAMES[n]}: amplitude, ° | rate, s/d | efficiency | missed beats" for n in both)
            + " |"
        )
        lines = [head, "|---:|" + "---:|---:|---:|---:|" * len(both)]
        for x in values:
            cells = []
            for scene in both.values():
                start = min(320.0, 285.0 * (math.sqrt(x) if title.startswith("torque") else 1.0))
                one = settled(make(scene, x), start)
                cells.append(f"{one.amplitude:.2f} | {one.rate:+.2f} | {100 * one.efficiency:.1f} % | {one.missed}")
            lines.append(f"| {x:g} | " + " | ".join(cells) + " |")
        tables.append("\n".join(lines))
    return tables[0], tables[1], tables[2]


def wheels(scene: Scene) -> str:
    """What the wheel's inertia does to the co-axial."""
    lines = [
        "| inertia of the wheel, mg·cm² | amplitude, ° | rate, s/d | efficiency | lost in impacts |",
        "|---:|---:|---:|---:|---:|",
    ]
    for inertia in INERTIAS:
        one = settled(scene.set("bodies.wheel.inertia", f"{inertia} mg·cm²"))
        shares = f"{100 * one.efficiency:.1f} % | {100 * one.impacts:.1f} %"
        lines.append(f"| {inertia:g} | {one.amplitude:.2f} | {one.rate:+.2f} | {shares} |")
    return "\n".join(lines)


def long_runs(scene: Scene) -> tuple[str, Trajectory]:
    """180 s from three starts."""
    lines = [
        "| start, ° | teeth in 630 oscillations | impulses missed | amplitude, ° | rate, s/d | ledger |",
        "|---:|---:|---:|---:|---:|---:|",
    ]
    run = None
    for start in (150.0, 330.0, 290.0):
        run = ws.simulate(scene.set("bodies.balance.angle", f"{-start}°"), duration=LONG)
        told, given = ws.summary(run), touched(run)
        missed = sum(not one for name in given for one in given[name])
        counted = f"{teeth(run):.4f} | {missed} of {sum(map(len, given.values()))}"
        timed = f"{told['amplitude_deg']:.6f} | {told['rate_s_per_d']:.6f} | {run.energy['residual_relative']:.1e}"
        lines.append(f"| {start:.0f} | {counted} | {timed} |")
    assert run is not None
    return "\n".join(lines), run


def accuracy(scene: Scene) -> str:
    """Tolerances, and the twin by fixed steps."""
    near = scene.set("bodies.balance.angle", "-289.9°")
    lines = ["| method | setting | amplitude, ° | rate, s/d |", "|---|---|---:|---:|"]
    for tolerance in (1e-8, 1e-9, 1e-10, 1e-11):
        told = ws.summary(ws.simulate(near, duration=60.0, tolerance=tolerance))
        lines.append(f"| by events, 60 s | {tolerance:g} | {told['amplitude_deg']:.7f} | {told['rate_s_per_d']:.7f} |")
    told = ws.summary(ws.simulate(near, duration=SHORT, tolerance=1e-11))
    lines.append(f"| by events, 4 s | 1e-11 | {told['amplitude_deg']:.5f} | {told['rate_s_per_d']:.5f} |")
    for step in (4e-6, 2e-6, 1e-6, 5e-7, 2.5e-7):
        told = ws.summary(ws.simulate(near, duration=SHORT, method="moreau", step=step))
        lines.append(f"| Moreau, 4 s | {1e6 * step:g} µs | {told['amplitude_deg']:.5f} | {told['rate_s_per_d']:.5f} |")
    return "\n".join(lines)


def timeline(run: Trajectory) -> str:
    """The phases of the last whole oscillation."""
    rows = [one for one in phases(run) if 179.65 < one.start < 180.0]
    lines = [
        "| beat | phase | from, s | lasts, ms | wheel turns, ° | lever turns, ° | balance from, ° | turns, ° |",
        "|---:|---|---:|---:|---:|---:|---:|---:|",
    ]
    for one in rows:
        wheel, lever, balance = (math.degrees(x) for x in one.turns)
        when = f"{one.start:.6f} | {1e3 * (one.end - one.start):.4f}"
        turns = f"{wheel:.3f} | {lever:.3f} | {math.degrees(one.angles[2]):.3f} | {balance:.3f}"
        lines.append(f"| {one.beat} | {one.name} | {when} | {turns} |")
    return "\n".join(lines)


def main(folder: Path) -> None:
    """Write the page."""
    import imageio.v3 as imageio

    for name in ("images", "guide"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    both = scenes()
    scene = both["coaxial"]
    found = turn(scene, math.radians(60.0))
    turn_picture(found, folder / "images" / "coaxial_turn.png")
    longs, run = long_runs(scene)
    for name, t in (("direct", 179.524), ("indirect", 179.6665)):
        imageio.imwrite(folder / "images" / f"coaxial_{name}.png", frame(run, t, contacts=True))
    ends = {name: settled(one) for name, one in both.items()}
    rubs = {
        name: rubbing(ws.simulate(one.set("bodies.balance.angle", f"{-ends[name].amplitude}°"), duration=2.0))
        for name, one in both.items()
    }
    pulls = {"coaxial": (TORQUE, 8), "swiss_lever": (PULL, 15)}
    smooth = {name: settled(rubbed(one, 0.0, 0.0)).amplitude for name, one in both.items()}
    rows = [
        ("amplitude, °", *(f"{ends[n].amplitude:.2f}" for n in both)),
        ("amplitude without friction, °", *(f"{smooth[n]:.2f}" for n in both)),
        ("amplitude if nothing were lost, °", *(f"{best(*pulls[n]):.2f}" for n in both)),
        ("rate, s/d", *(f"{ends[n].rate:+.2f}" for n in both)),
        ("beat error, ms", *(f"{ends[n].beat_error:.4f}" for n in both)),
        ("efficiency", *(f"{100 * ends[n].efficiency:.1f} %" for n in both)),
        ("lost in friction", *(f"{100 * ends[n].friction:.1f} %" for n in both)),
        ("lost in impacts", *(f"{100 * ends[n].impacts:.1f} %" for n in both)),
    ]
    compared = "| | co-axial | Swiss lever |\n|---|---:|---:|\n" + "\n".join("| " + " | ".join(row) + " |" for row in rows)
    slides = ["| escapement | layers | slid per oscillation, µm | friction's work, nJ |", "|---|---|---:|---:|"]
    for name in both:
        for layers, one in sorted(rubs[name].items(), key=lambda item: -item[1].way):
            slides.append(f"| {NAMES[name]} | {layers} | {1e6 * one.way:.1f} | {1e9 * one.work:.4f} |")
    friction, restitution, torque = studies(both)
    near = "\n".join(
        f"- {1e6 * one.distance:.1f} µm: {' and '.join(found.cycle.assembly.couples[one.couple].layers)}"
        for one in passings(found)[:5]
    )
    page = TEXT.format(
        turn=turn_text(found),
        near=near,
        map=range_map(scene, folder),
        longs=longs,
        accuracy=accuracy(scene),
        timeline=timeline(run),
        compared=compared,
        slides="\n".join(slides),
        friction=friction,
        restitution=restitution,
        torque=torque,
        wheels=wheels(scene),
        dimensions=dimension_table(),
    )
    (folder / "guide" / "coaxial.md").write_text(page, encoding="utf-8")


def dimension_table() -> str:
    """The one table of dimensions."""
    from watchsim.construction.known import design

    lines = ["| dimension | default | limits | what | from |", "|---|---:|---|---|---|"]
    for one in design("coaxial").dimensions:
        limits = f"{one.shown(one.low)} to {one.shown(one.high)}"
        lines.append(f"| `{one.name}` | {one.shown(one.default)} | {limits} | {one.meaning} | {one.source} |")
    return "\n".join(lines)


TEXT = """\
# The co-axial escapement, beside the Swiss lever

George Daniels' escapement in its flat form: eight and eight teeth on one arbor. Written by
`scripts/reports/make_coaxial_page.py`.

    watchsim new coaxial -o my_coaxial          # every dimension below is an option
    watchsim check my_coaxial --turn --png turn.png --movie turn.mp4
    watchsim run profiles/coaxial -o run
    watchsim movie run --window "179.516 s:179.529 s" --speed 1/1000 --contacts --forces -o direct.mp4
    watchsim movie run --window "179.659 s:179.670 s" --speed 1/1000 --contacts --forces -o indirect.mp4

## How it is laid out

The wheel's centre is O, the lever's pivot P, the balance's centre B. Two locking stones stand on the tip circle, one and a
half pitches apart, where its tangents from P touch: both lockings push through P, and draw alone turns the lever. Each
impulse is given where two circles overlap. With wheel angle α and balance angle β on either side of the line of centres, R
sin α = r sin β and OB = R cos α + r cos β; the same holds for the small wheel and the lever's stone about P. Of a pitch of
45° each locking takes half: a waiting tooth stands 11.25° before or behind the line OB, outside the overlap, so that the
roller's stone passes freely between two teeth in both locked states. No maker's drawing is public; the proportions are
constructed, and found by running.

{dimensions}

## Turned by hand

`watchsim check --turn` leads the balance through an oscillation and presses the wheel on, without forces:

```
{turn}
```

![turned by hand](../images/coaxial_turn.png)

The closest passings tell what a maker has to hold:

{near}

## Does it run?

180 s from a cold start, balance let go at the angle named:

{longs}

How far it may swing before an impulse is missed, 4 s from each start. Let go, the wheel has to catch up with a stone that runs
away from it. The time for that falls as 1 over the amplitude, the way that the wheel makes grows as the square of the time: the
limit rises as the square root of torque over inertia, as the steady amplitude does. What settles never misses. A swing well
beyond the steady one loses the indirect impulse first, then the direct one, and nothing worse happens: the next stone locks the
wheel all the same, one tooth in each oscillation.

![range](../images/coaxial_range.png)

{map}

## How exact

{accuracy}

## The last oscillation of 180 s

{timeline}

Direct impulse (balance counter-clockwise) and indirect impulse:

![direct](../images/coaxial_direct.png)
![indirect](../images/coaxial_indirect.png)

## Beside the Swiss lever

Both with the same balance (12 mg·cm²), spring (25 200 vph), damping (Q 250), friction 0.15, restitution 0, and the same work
of the drive in an oscillation (0.48 µN·m · 45° and 0.9 µN·m · 24°). Wheels and levers keep the inertias of their profiles
(co-axial 0.1 and 0.06 mg·cm², Swiss lever 0.05 and 0.03 mg·cm²).

{compared}

How far things slide in one oscillation of the settled watch, and what friction takes there outside impacts:

{slides}

What changes when friction, restitution or torque do (settled, 90 s):

{friction}

{restitution}

{torque}

Beyond 337° the pin strikes the outside of the fork: there the watch knocks, gains minutes, and its amplitude says nothing.
The last table is isochronism as well: what changes the amplitude changes the rate by so much.

The inertia of the co-axial wheel:

{wheels}

In plain words: with the same energy both swing equally far, but lose it in different places. The lever rubs away a third of
what it gets, on long ways and under load; the co-axial next to nothing, since its teeth push more than they slide. Its
price is paid in impacts: at each beat the wheel starts from rest, runs after a stone that already moves fast, and strikes
it. So the co-axial hardly notices whether its oil is fresh, where the amplitude of the lever follows friction closely; both
follow the torque alike. A lighter wheel would catch up sooner and lose less: there lies what is still to be gained. All of
this is for rigid parts, dry friction and inertias that are estimates.

Random designs are tried with `python scripts/try_designs.py 100 100 1 coaxial`: each is refused with its reason, ticks, or does
not and says why.
"""

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    default = Path(__file__).resolve().parents[2] / "docs"
    main(arguments(__doc__, folder=(default, "where the page goes")).folder)
