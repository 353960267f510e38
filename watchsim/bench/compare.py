"""Which scenes are compared, how far off is each engine at each setting, and how long does it take for a simulated second?"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing import DAY, Window, mean_over
from watchsim.bench.engines import MODULES, Setup, build, is_installed, version_of
from watchsim.contact.cells import forget
from watchsim.mechanism.compile import compile_scene
from watchsim.paths import profiles_dir
from watchsim.scene.load import load
from watchsim.scene.outlines import forget_drawings
from watchsim.scene.scene import Recording, Scene
from watchsim.simulation import EVENT_DRIVEN, MOREAU
from watchsim.simulation.recording import half_swings, since_two_before
from watchsim.simulation.runner import Run, trajectory_of
from watchsim.simulation.simulate import MoreauRun, simulate
from watchsim.simulation.state import EVENT_DTYPE, EventKind, Stop
from watchsim.simulation.trajectory import Trajectory
from watchsim.verification.checks import Incline, incline_state

# For engines that know no events. Turning points are those of parabolas through three samples, passages those of cubics
# through four: with a hundred samples in a period both are off by less than 10⁻⁷ of the swing.

Array = NDArray[np.float64]


def swing(times: Array, angle: Array, window: tuple[float, float]) -> tuple[float | None, float | None, int]:
    """Mean amplitude (rad) and period (s) of the half swings whose passage lies in the window, and their number.

    `angle` is measured from the rest position. None where there are too few.
    """
    turns, crossings = _turns(times, angle), _crossings(times, angle)
    complete, before, after = half_swings(crossings, turns)
    t = crossings["t"][complete]
    inside = (t >= window[0]) & (t <= window[1])
    amplitudes = 0.5 * np.abs(turns["value"][after] - turns["value"][before])[inside]
    lasted = since_two_before(crossings["t"])[complete]
    periods = lasted[inside & (t - lasted >= window[0])]
    mean = float(amplitudes.mean()) if len(amplitudes) else None
    return mean, float(periods.mean()) if len(periods) else None, int(inside.sum())


def _events(kind: EventKind, times: Array, values: Array) -> NDArray[np.void]:
    found = np.zeros(len(times), EVENT_DTYPE)
    found["t"], found["kind"], found["value"] = times, kind, values
    return found


def _turns(times: Array, angle: Array) -> NDArray[np.void]:
    """Of each run of samples that go one way, the end."""
    step = np.diff(angle)
    i = 1 + np.flatnonzero(step[:-1] * step[1:] < 0.0)
    left, right = angle[i - 1] - angle[i], angle[i + 1] - angle[i]
    place = 0.5 * (left - right) / (left + right)  # in steps from sample i
    h = times[1] - times[0]
    value = angle[i] + 0.5 * place * (right - left) + 0.5 * place**2 * (right + left)
    return _events(EventKind.TURN, times[i] + h * place, value)


def _crossings(times: Array, angle: Array) -> NDArray[np.void]:
    """Where the angle changes sign, by two steps of Newton's method on the cubic through two samples on either side."""
    i = np.flatnonzero(angle[1:-2] * angle[2:-1] < 0.0) + 1
    a, b, c, d = angle[i - 1], angle[i], angle[i + 1], angle[i + 2]
    c1 = c - a / 3.0 - b / 2.0 - d / 6.0
    c2, c3 = 0.5 * (a + c) - b, (d - a) / 6.0 + 0.5 * (b - c)
    s = b / (b - c)
    for _ in range(3):
        s = s - (b + s * (c1 + s * (c2 + s * c3))) / (c1 + s * (2.0 * c2 + s * 3.0 * c3))
    h = times[1] - times[0]
    return _events(EventKind.CROSS, times[i] + h * s, (c - b) / h)


REFERENCE_TOLERANCE = 1e-13

# Of the settings tolerances are relative errors per step; all others are steps in seconds. Units, slop and iterations are those
# that were found best for each engine: lengths of the order of the engine's own, and as little softness as it allows.


@dataclass(frozen=True)
class Scenario:
    """A scene for `duration` s; amplitude and rate are averaged over `window`, the state is that at the end.

    `settings` from coarse to fine, by method. `closed_form` is the exact answer where there is one.
    """

    name: str
    scene: Scene
    duration: float
    settings: Mapping[str, tuple[float, ...]]
    setups: Mapping[str, Setup]
    window: Window | None = None
    closed_form: Incline | None = None

    def quick(self) -> Scenario:
        """Coarser, for a look."""
        return replace(self, settings={method: values[:2] for method, values in self.settings.items()})


def scenarios() -> list[Scenario]:
    """All that are compared."""
    return [*_inclines(), *_bench_levers(), _swiss_lever()]


def _inclines() -> list[Scenario]:
    setups = {
        "pymunk": Setup(units=1.0, slop=1e-6),
        "box2d": Setup(units=100.0),
        "mujoco": Setup(units=1.0, ring=10.0),
    }
    tolerances = (1e-6, 1e-8, 1e-10)
    steps = {
        EVENT_DRIVEN: tolerances,
        MOREAU: (1e-3, 1e-4, 1e-5),
        "pymunk": (1e-2, 1e-3, 1e-4, 1e-5),
        "box2d": (1e-2, 1e-3, 1e-4),
        "mujoco": (1e-3, 1e-4),
    }
    folder = profiles_dir() / "incline"
    found = [Scenario("incline", load(folder / "scene.toml"), 3.0, steps, setups, closed_form=Incline(0.3))]
    for friction, file in ((0.13, "scene_mu013.toml"), (0.10, "scene_mu010.toml")):
        scene = load(folder / file)
        only = {EVENT_DRIVEN: tolerances}
        found.append(Scenario(f"incline, friction {friction:g}", scene, 3.0, only, {}, closed_form=Incline(friction)))
    return found


def _bench_levers() -> list[Scenario]:
    setups = {"pymunk": Setup(units=1e3), "box2d": Setup(units=1e5), "mujoco": Setup(units=1e3)}
    steps = {
        EVENT_DRIVEN: (1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11),
        MOREAU: (2e-5, 1e-5, 4e-6, 2e-6),
        "pymunk": (5e-5, 2e-5, 1e-5, 5e-6),
        "box2d": (1e-4, 5e-5, 2e-5, 1e-5),
        "mujoco": (5e-6,),
    }
    scene = load(profiles_dir() / "bench_lever" / "scene.toml")
    dead = scene
    for number in range(len(scene.contacts)):
        dead = dead.set(f"contacts.{number}.restitution", 0.0)
    fewer = {"pymunk": (2e-5, 5e-6), "box2d": (5e-5,)}
    settled = {EVENT_DRIVEN: (1e-5, 1e-7, 1e-9), MOREAU: (1e-5, 4e-6), "pymunk": (2e-5, 5e-6), "box2d": (5e-5, 2e-5, 1e-5)}
    return [
        Scenario("bench_lever", scene, 3.0, steps, setups, (1.0, 3.0)),
        Scenario("bench_lever, restitution 0", dead, 3.0, {**steps, **fewer}, setups, (1.0, 3.0)),
        # Settled, the first beats are forgotten: what is left is the error of a steady watch.
        Scenario("bench_lever, settled", scene, 15.0, {**steps, **settled}, setups, (13.0, 15.0)),
    ]


def _swiss_lever() -> Scenario:
    units = {"pymunk": 1e3, "box2d": 1e5, "mujoco": 1e3}
    setups = {name: Setup(units=value, deviation=4e-6) for name, value in units.items()}
    steps = {
        EVENT_DRIVEN: (1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11),
        MOREAU: (1e-5, 4e-6, 2e-6),
        "pymunk": (2e-5,),
        "box2d": (5e-5,),
        "mujoco": (5e-6,),
    }
    return Scenario("swiss_lever", load(profiles_dir() / "swiss_lever" / "scene.toml"), 3.0, steps, setups, (1.0, 3.0))


# The compiled code is loaded before. The first run of a geometry reads the drawings and learns the cells that it meets (other
# engines make their polygons); the second one finds both known.


@dataclass(frozen=True, slots=True)
class Whole:
    """s by the clock: getting ready and stepping of the first run of a geometry, and of the one after it."""

    scene: str
    method: str
    setting: float
    simulated: float
    first_ready: float
    first_stepping: float
    again_ready: float
    again_stepping: float


def whole(scenario: Scenario, method: str, setting: float) -> Whole:
    """Both runs, one after the other; KeyboardInterrupt where one is interrupted."""
    if scenario.scene.path is None:
        raise ValueError(f"{scenario.name} has no scene file to be read")
    _once(scenario, scenario.scene.path, method, setting, 0.01)  # compiled code and libraries are loaded
    forget()
    forget_drawings()
    times = [_once(scenario, scenario.scene.path, method, setting, scenario.duration) for _ in range(2)]
    return Whole(scenario.name, method, setting, scenario.duration, *times[0], *times[1])


def _once(scenario: Scenario, path: Path, method: str, setting: float, duration: float) -> tuple[float, float]:
    """Getting ready and stepping, s."""
    begun = time.perf_counter()
    scene = load(path)
    if method in (EVENT_DRIVEN, MOREAU):
        ready = time.perf_counter()
        options = {"tolerance": setting} if method == EVENT_DRIVEN else {"step": setting}
        run = simulate(scene, duration, record="statistics", method=method, **options)  # type: ignore[arg-type]
        if run.stop == Stop.INTERRUPTED:
            raise KeyboardInterrupt
        ended = time.perf_counter()
        return ready - begun + run.compile, ended - ready - run.compile
    world = build(method, scene, setting, scenario.setups[method])
    ready = time.perf_counter()
    world.advance(round(duration / setting))
    return ready - begun, time.perf_counter() - ready


# Processor times of the stepping alone: setting up a scene, compiling and computing cells are left out for all.

SAMPLE = 2e-4  # s between looks at other engines; a swing of 4 Hz has 1250
ENOUGH = 0.9  # of the half swings: fewer, and the watch did not run


@dataclass(frozen=True, slots=True)
class Outcome:
    """amplitude in degrees, rate in s/d, x in m of the body that is free; None where there is no such thing."""

    amplitude: float | None = None
    rate: float | None = None
    x: float | None = None
    note: str = ""


def outcome(scenario: Scenario, method: str, setting: float) -> Outcome:
    """What comes out; `note` says what went wrong."""
    return (_own if method in (EVENT_DRIVEN, MOREAU) else _other)(scenario, method, setting)


def cpu_seconds(scenario: Scenario, method: str, setting: float, duration: float) -> float:
    """Processor time to step through the first `duration` seconds."""
    if method in (EVENT_DRIVEN, MOREAU):
        return _own_run(scenario, method, setting, duration)[1]
    world = build(method, scenario.scene, setting, scenario.setups[method])
    steps = round(duration / setting)
    begun = time.process_time()
    world.advance(steps)
    return time.process_time() - begun


def _own_run(scenario: Scenario, method: str, setting: float, duration: float) -> tuple[Trajectory, float]:
    scene, keep = scenario.scene, Recording(keep="statistics")
    compiled = compile_scene(scene)
    run = Run(scene, compiled, setting, keep) if method == EVENT_DRIVEN else MoreauRun(scene, compiled, 1e-9, keep, setting)
    run.warm_up()
    begun = time.process_time()
    stop = run.to_the_end(duration, None)
    taken = time.process_time() - begun
    if stop == Stop.INTERRUPTED:
        raise KeyboardInterrupt  # half a run is no result
    return trajectory_of(run, stop, taken, 0.0), taken


def _own(scenario: Scenario, method: str, setting: float) -> Outcome:
    run, _ = _own_run(scenario, method, setting, scenario.duration)
    if run.stop != Stop.DURATION:
        return Outcome(note=run.stop.sentence)
    if scenario.window is None:
        return Outcome(x=float(run.end_q[0]))
    means = mean_over(run, scenario.window)
    return Outcome(means.amplitude_deg, means.rate_s_per_d, note=_verdict(means.beats, scenario))


def _verdict(beats: int, scenario: Scenario) -> str:
    assert scenario.window is not None
    wanted = 2.0 * (scenario.window[1] - scenario.window[0]) / _period(scenario)
    return "" if beats >= ENOUGH * wanted else "does not run"


def _period(scenario: Scenario) -> float:
    scene = scenario.scene
    spring = scene.springs[0]
    return float(2.0 * np.pi * np.sqrt(scene.body(spring.body).inertia / spring.stiffness))


def _other(scenario: Scenario, method: str, setting: float) -> Outcome:
    scene = scenario.scene
    world = build(method, scene, setting, scenario.setups[method])
    if scenario.window is None:
        free = next(body.name for body in scene.bodies if body.motion == "free")
        world.advance(round(scenario.duration / setting))
        return Outcome(x=world.place(free)[0])
    spring = scene.springs[0]
    stride = max(1, round(SAMPLE / setting))
    count = round(scenario.duration / (stride * setting))
    angles = np.empty(count)
    for i in range(count):
        world.advance(stride)
        angles[i] = world.place(spring.body)[2] - spring.rest
    times = stride * setting * np.arange(1.0, count + 1.0, dtype=np.float64)
    amplitude, period, beats = swing(times, angles, scenario.window)
    note = _verdict(beats, scenario)
    if note or amplitude is None or period is None:
        return Outcome(note=note or "does not run")
    return Outcome(float(np.degrees(amplitude)), DAY * (_period(scenario) / period - 1.0), note=note)


COLUMNS = ("engine", "setting", "time, s per simulated s", "spread", "error of amplitude", "of rate", "of place")


def table(rows: Sequence[Mapping[str, Any]], references: Sequence[Mapping[str, Any]]) -> str:
    """In Markdown: for each scene what counts as true, then a line for each setting of each engine."""
    parts = []
    for reference in references:
        own = [row for row in rows if row["scene"] == reference["scene"]]
        rows_of_table = [f"| {' | '.join(COLUMNS)} |", "|---" * len(COLUMNS) + "|", *map(_line, own)]
        parts += [f"### {reference['scene']}", "", truth_text(reference), "", *rows_of_table, ""]
    return "\n".join(parts)


def truth_text(reference: Mapping[str, Any]) -> str:
    """The reference, and what confirms it."""
    truth = reference["truth"]
    values = []
    if truth["amplitude"] is not None:
        values = [f"amplitude {truth['amplitude']:.6f}°", f"rate {truth['rate']:.6f} s/d"]
    if truth["x"] is not None:
        values = [f"x = {truth['x']:.12f} m"]
    off = [
        f"{reference[name]:.1g}{unit}"
        for name, unit in (("amplitude_off_deg", "°"), ("rate_off_s_per_d", " s/d"), ("state_off_m", " m"))
        if reference[name] is not None
    ]
    return f"Reference: {', '.join(values)} ({reference['source']}). {reference['confirmed_by']}: differs by {', '.join(off)}."


def _line(row: Mapping[str, Any]) -> str:
    step = row["method"] in MODULES or row["method"] == "moreau"
    setting = f"step {1e6 * row['setting']:g} µs" if step else f"tolerance {row['setting']:.0e}"
    time, least, most = row["wall_s_per_simulated_s"], row["wall_least"], row["wall_largest"]
    errors = [
        f"{row[name]:.1e}{unit}" if row[name] is not None else ""
        for name, unit in (("error_amplitude_deg", "°"), ("error_rate_s_per_d", " s/d"), ("error_state", " m"))
    ]
    if row["note"]:
        errors = [row["note"], "", ""]
    engine = f"{row['method']} {row['version']}".strip()
    spread = f"{least:.3g} to {most:.3g} ({row['repeats']} {'run' if row['repeats'] == 1 else 'runs'})"
    return f"| {' | '.join((engine, setting, f'{time:.3g}', spread, *errors))} |"


REPEATS = 5
ANOTHER_WAY = 30.0  # degrees of amplitude: not a matter of accuracy any more
LONG = 2.0  # s of processor time: what takes longer is timed over a part
LONGEST = 0.4  # s simulated, of that part


@dataclass(frozen=True, slots=True)
class Row:
    """One engine at one setting. Times in s of processor time per simulated second: median, smallest and largest of `repeats`.

    Errors are absolute: rate in s/d, amplitude in degrees, state (x of the free body) in m; None where there is none.
    """

    scene: str
    method: str
    version: str
    setting: float
    wall_s_per_simulated_s: float
    wall_least: float
    wall_largest: float
    repeats: int
    error_rate_s_per_d: float | None
    error_amplitude_deg: float | None
    error_state: float | None
    note: str = ""


@dataclass(frozen=True, slots=True)
class Reference:
    """What counts as true for a scenario, from where, and how far another method is from it."""

    scene: str
    truth: Outcome
    source: str
    confirmed_by: str
    amplitude_off_deg: float | None = None
    rate_off_s_per_d: float | None = None
    state_off_m: float | None = None


def missing_engines() -> list[str]:
    """Engines that are not installed."""
    return [engine for engine in MODULES if not is_installed(engine)]


def compare(scenario: Scenario, repeats: int, say: Callable[[str], None]) -> tuple[Reference, list[Row]]:
    """The reference of a scenario, and a row for each setting of each installed engine."""
    say(f"{scenario.name}: reference")
    truth = reference(scenario)
    rows = []
    for method, settings in scenario.settings.items():
        if method in MODULES and not is_installed(method):
            continue
        for setting in settings:
            say(f"{scenario.name}: {method} {setting:g}")
            rows.append(_row(scenario, method, setting, truth.truth, repeats))
    return truth, rows


def reference(scenario: Scenario) -> Reference:
    """The closed form where there is one, else the tightest event-driven run; both confirmed by another method."""
    tight = outcome(scenario, EVENT_DRIVEN, REFERENCE_TOLERANCE)
    if scenario.closed_form is not None:
        exact = Outcome(x=incline_state(scenario.closed_form, scenario.duration).x)
        off = _apart(exact.x, tight.x)
        return Reference(scenario.name, exact, "closed form", f"event-driven, {REFERENCE_TOLERANCE:g}", state_off_m=off)
    steps = scenario.settings[MOREAU][-2:]
    coarse, fine = (outcome(scenario, MOREAU, step) for step in steps)
    ratio, words = steps[0] / steps[1], " and ".join(f"{1e6 * step:g} µs" for step in steps)
    return Reference(
        scenario.name,
        tight,
        f"event-driven, {REFERENCE_TOLERANCE:g}",
        f"Moreau's time stepping, extrapolated from steps of {words}",
        amplitude_off_deg=_apart(tight.amplitude, _extrapolated(coarse.amplitude, fine.amplitude, ratio)),
        rate_off_s_per_d=_apart(tight.rate, _extrapolated(coarse.rate, fine.rate, ratio)),
    )


def _extrapolated(coarse: float | None, fine: float | None, ratio: float) -> float | None:
    """To step zero, where errors go with the step."""
    if coarse is None or fine is None:
        return None
    return fine + (fine - coarse) / (ratio - 1.0)


def _row(scenario: Scenario, method: str, setting: float, truth: Outcome, repeats: int) -> Row:
    got = outcome(scenario, method, setting)
    times = _times(scenario, method, setting, repeats)
    off = _apart(got.amplitude, truth.amplitude)
    return Row(
        scene=scenario.name,
        method=method,
        version=version_of(method) if method in MODULES else "",
        setting=setting,
        wall_s_per_simulated_s=statistics.median(times),
        wall_least=min(times),
        wall_largest=max(times),
        repeats=len(times),
        error_rate_s_per_d=_apart(got.rate, truth.rate),
        error_amplitude_deg=off,
        error_state=_apart(got.x, truth.x),
        note=got.note or ("runs another way" if off is not None and off > ANOTHER_WAY else ""),
    )


def _times(scenario: Scenario, method: str, setting: float, repeats: int) -> list[float]:
    """Per simulated second; after a first one that nobody sees."""
    duration = scenario.duration
    first = cpu_seconds(scenario, method, setting, min(duration, LONGEST))
    if first / min(duration, LONGEST) * duration > LONG:
        duration = min(duration, LONGEST)
    return [cpu_seconds(scenario, method, setting, duration) / duration for _ in range(repeats)]


def _apart(one: float | None, two: float | None) -> float | None:
    return None if one is None or two is None else abs(one - two)
