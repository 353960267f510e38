"""Which scenes are compared, for how long, and with which settings of each engine?

Tolerances are relative errors per step; all other settings are steps in seconds. Units, slop and iterations are those that were
found best for each engine: lengths of the order of the engine's own, and as little softness as it allows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from watchsim.analysis.timing.averages import Window
from watchsim.bench.engines.world import MODULES, Setup
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load
from watchsim.scene.scene import Scene
from watchsim.simulation.methods import EVENT_DRIVEN, MOREAU
from watchsim.verification.closed_forms import Incline

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
