"""Which scenes are compared, for how long, and with which settings of each engine?

Tolerances are relative errors per step; all other settings are steps in seconds. Units, slop and iterations are those that were
found best for each engine: lengths of the order of the engine's own, and as little softness as it allows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing import Window
from watchsim.bench.engines import MODULES, Setup
from watchsim.paths import profiles_dir
from watchsim.scene.load import load
from watchsim.scene.scene import Scene
from watchsim.simulation import EVENT_DRIVEN, MOREAU
from watchsim.simulation.recording import half_swings, since_two_before
from watchsim.simulation.state import EVENT_DTYPE, EventKind
from watchsim.verification.checks import Incline

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
ENGINES = tuple(MODULES)
METHODS = (EVENT_DRIVEN, MOREAU, *ENGINES)


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
