"""Which short runs are recorded, and what numbers does each come to?

Random mechanisms of the hunt, scenes of the library, and benchmarks: together they go through every part of the solver.
"""

import dataclasses
import functools
import sys
from pathlib import Path
from typing import Any

import numpy as np
from moving_scenes import profile

from watchsim.contact import cells as pair_cache
from watchsim.scene.scene import EVERYTHING, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory
from watchsim.verification.hard_cases import edge_cases, hard_cases
from watchsim.verification.repeated_impacts import repeated_impacts

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))

SEED = 271828
LIBRARY = {  # seconds, of each some beats or engagements
    **{"balance": 0.5, "bench_lever": 0.16, "swiss_lever": 0.16, "coaxial": 0.1, "detent": 0.1, "duplex": 0.1, "cylinder": 0.1},
    **{"pin_pallet": 0.1, "pin_wheel": 0.3, "graham": 0.3, "recoil_anchor": 0.3, "grasshopper": 0.2, "verge": 0.2},
    **{"incline": 0.6, "cam": 0.3, "carriage": 0.1, "cycloidal_pair": 0.05, "involute_pair": 0.05, "geneva": 0.2},
    **{"geneva_stop": 0.2, "governor": 0.1, "jumper": 0.2, "ratchet": 0.1, "remontoir": 0.1, "snail": 0.2, "tourbillon": 0.1},
    "winding_click": 0.2,
}
STEPPED = {"bench_lever": (0.02, 1e-4), "incline": (0.1, 1e-3), "swiss_lever": (0.02, 1e-4)}  # s, s: by Moreau
STEPPED_HUNT = 100  # steps by Moreau of a mechanism of the hunt
Short = tuple[Scene, float, dict[str, Any]]  # the scene, how long, how
BEFORE = (0.31, 0.77)  # of a run's duration: when it is looked at besides its end


@dataclasses.dataclass(frozen=True)
class Told:
    """What a run comes to."""

    values: dict[str, list[float]]  # SI
    counts: dict[str, int]
    worst: list[float]  # penetration (m), residual of ledger and contact problems: bounds


def scene_of(name: str) -> Short:
    """The run of a name: KIND/WHAT, KIND being hunt, library, case, hunt-moreau or library-moreau."""
    kind, what = name.split("/", 1)
    if kind == "case":
        return _cases()[what]
    if kind.startswith("hunt"):
        from hunt.generate import mechanism

        scene = mechanism(SEED, int(what.rsplit("-", 1)[1]))
        short: Short = _everything(scene), scene.duration, {}
        return (short[0], short[1], {"method": "moreau", "step": short[1] / STEPPED_HUNT}) if kind != "hunt" else short
    if kind == "library":
        return _everything(profile(what)), LIBRARY[what], {}
    duration, step = STEPPED[what]
    return _everything(profile(what)), duration, {"method": "moreau", "step": step}


@functools.cache
def _cases() -> dict[str, Short]:
    found: dict[str, Short] = {}
    for case in (*hard_cases(), *edge_cases(), *repeated_impacts()):
        found.setdefault(case.name, (_everything(case.scene), min(case.scene.duration, 0.6), {}))
    return found


def all_names(of_the_hunt: int) -> list[str]:
    """Everything that could be recorded."""
    from hunt.generate import mechanism

    hunted = [f"{mechanism(SEED, k).title}-{k}" for k in range(of_the_hunt)]
    names = [*(f"library/{name}" for name in LIBRARY), *(f"case/{name}" for name in _cases())]
    names += [f"library-moreau/{name}" for name in STEPPED]
    return [*names, *(f"hunt/{name}" for name in hunted), *(f"hunt-moreau/{name}" for name in hunted[:: len(hunted) // 20])]


def _everything(scene: Scene) -> Scene:
    return dataclasses.replace(scene, record=EVERYTHING)


def nudged(scene: Scene, share: float, seed: int) -> Scene:
    """Every speed, mass, force and law changed by up to that share of itself: what rounding elsewhere may come to."""
    rng = np.random.default_rng(seed)

    def near(value: float) -> float:
        return value * (1.0 + share * float(rng.uniform(-1.0, 1.0)))

    bodies = tuple(
        dataclasses.replace(body, velocity=tuple(map(near, body.velocity)), mass=near(body.mass), inertia=near(body.inertia))
        for body in scene.bodies
    )
    return dataclasses.replace(
        scene,
        bodies=bodies,
        gravity=(near(scene.gravity[0]), near(scene.gravity[1])),
        torques=tuple(dataclasses.replace(one, value=near(one.value)) for one in scene.torques),
        springs=tuple(dataclasses.replace(one, stiffness=near(one.stiffness)) for one in scene.springs),
        contacts=tuple(
            dataclasses.replace(one, friction=near(one.friction), restitution=min(near(one.restitution), 1.0))
            for one in scene.contacts
        ),
    )


def run_of(short: Short) -> Trajectory:
    """As the first run of a process: no cell is known from another run."""
    scene, duration, how = short
    pair_cache.forget()
    return simulate(scene, duration, **how)


def told(run: Trajectory) -> Told:
    """Where everything is at the end and twice before, what happened, where energy went, and how much work it was."""
    energy, events = run.energy, run.events
    q, u = run.sample(np.array(BEFORE) * run.simulated)
    values: dict[str, list[float]] = {"t": [run.simulated]}
    for i in range(len(run.end_q)):
        values[f"q{i}"] = [*q[:, i].tolist(), float(run.end_q[i])]
        values[f"u{i}"] = [*u[:, i].tolist(), float(run.end_u[i])]
        values[f"a{i}"] = [float(run.a[-1, i]), float(np.abs(run.a[:, i]).mean())]
    values["energy"] = [energy["in_J"], energy["stored_J"], *energy["dissipated"].values()]
    for name in ("impulse_normal", "impulse_tangential", "energy_lost"):
        values[name] = [float(np.abs(events[name]).sum())]
    counts = {"stop": int(run.stop), "rows": len(run.t)} | run.counts
    for kind in EventKind:
        own = events[events["kind"] == kind]
        name = f"{kind.name.lower()} events"
        values[name] = [float(own["t"].sum()), float(np.abs(own["value"]).sum())]
        counts[name] = len(own)
    counts |= {f"{what} of events": int(events[what].sum(dtype=np.int64)) for what in ("contact", "body")}  # their numbers
    return Told(values, counts, [run.worst_penetration, max(run.worst_residual, abs(energy["residual_relative"]))])
