"""Which figures measured on real clocks does the program give, where their geometry need not be known?

    python scripts/reports/measured_clocks.py

Prints the figures of docs/reports/measured_clocks.md; tests/analysis/test_measured_clocks.py asks for the same.
"""

import argparse
import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from watchsim.paths import profiles_dir
from watchsim.scene.load import load
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind

Array = NDArray[np.float64]

DAY, G = 86400.0, 9.81
AIR = 1.20 / 1013.0  # kg/m³ by mbar, at 20 °C: density goes with pressure
IRON = (7100.0, 7850.0)  # kg/m³: cast iron to steel
CARRIED = (0.0, 1.0)  # share of the displaced air that swings with the bob: 1 for a round cylinder across, less for a lens
STEEL = (11e-6, 13e-6)  # 1/K


def pendulum(friction: float = 0.0, linear: bool = True, driven: bool = True) -> Scene:
    """The Graham profile with impulses of constant work, as a gravity arm gives: frictionless pallets, one law of resistance.

    The quadratic law takes as much as the linear one at an amplitude of 2°.
    """
    scene = load(profiles_dir() / "graham")
    viscous = scene.damping[0].viscous
    speed = math.radians(2.0) * math.tau  # at the middle, rad/s, of a half-seconds pendulum
    # Over a swing c u² takes c w² / 2 and d |u|³ takes 4 d w³ / (3 π).
    drag = replace(scene.damping[0], quadratic=viscous * 3.0 * math.pi / (8.0 * speed), viscous=0.0)
    contacts = tuple(replace(one, friction=friction) for one in scene.contacts) if driven else ()
    return replace(scene, contacts=contacts, damping=(scene.damping[0] if linear else drag,))


def changed(scene: Scene, **values: float) -> Scene:
    """The scene with a pendulum that differs in these."""
    bodies = tuple(replace(body, **values) if body.name == "pendulum" else body for body in scene.bodies)  # type: ignore[arg-type]
    return replace(scene, bodies=bodies)


def amplitudes(scene: Scene, start: float, duration: float) -> tuple[Array, Array]:
    """(times, amplitudes in rad) at every other turning point, from a start at that angle."""
    found = simulate(changed(scene, angle=start), duration=duration).events
    turns = found[(found["kind"] == EventKind.TURN)]
    both = 0.5 * np.abs(np.diff(turns["value"]))
    return turns["t"][1::2], both[::2]


def pace(times: Array, values: Array) -> float:
    """Of an exponential through these values, 1/s."""
    return -float(np.polyfit(times, np.log(np.abs(values)), 1)[0])


def restart_over_decay(linear: bool) -> tuple[float, float]:
    """(steady amplitude in rad; how many times as fast a driven pendulum comes back to it as an undriven one loses it)."""
    scene = pendulum(linear=linear)
    steady = float(amplitudes(scene, math.radians(2.0), 600.0)[1][-1])
    times, below = amplitudes(scene, 0.97 * steady, 90.0)
    back = pace(times[5:60], (steady - below)[5:60])
    times, free = amplitudes(pendulum(linear=linear, driven=False), 1.01 * steady, 30.0)
    return steady, back / pace(times[:2], free[:2])


def barometric(density: float, carried: float) -> float:
    """s per day by mbar: a bob of that density (kg/m³) loses weight, and carries air along."""

    def hertz(pressure: float) -> float:
        share = AIR * pressure / density
        scene = pendulum(driven=False)
        scene = replace(scene, damping=(), gravity=(0.0, -G * (1.0 - share)))
        scene = changed(scene, inertia=scene.body("pendulum").inertia * (1.0 + carried * share))
        found = simulate(scene, duration=20.0, tolerance=1e-11).events
        turns = found["t"][found["kind"] == EventKind.TURN]
        return float(1.0 / np.mean(np.diff(turns[::2])))

    return DAY * (hertz(1113.0) - hertz(913.0)) / hertz(1013.0) / 200.0


def temperature(expansion: float) -> float:
    """s per day by K of a pendulum of one metal."""
    return -0.5 * expansion * DAY


def drive_and_period() -> float:
    """Of the Graham profile, Q 200: by what share the period changes as its drive grows by a tenth."""
    periods = []
    for share in (1.0, 1.1):
        scene = load(profiles_dir() / "graham")
        scene = scene.set("torques.0.value", share * scene.torques[0].value)
        found = simulate(scene, duration=300.0).events
        turns = found["t"][found["kind"] == EventKind.TURN]
        periods.append(float(np.mean(np.diff(turns[-21::2]))))
    return periods[1] / periods[0] - 1.0


def circular(amplitude: float) -> float:
    """s per day against small swings, by the arithmetic-geometric mean."""
    a, b = 1.0, math.cos(0.5 * amplitude)
    for _ in range(6):
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    return DAY * (a - 1.0)


def main() -> None:
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    for linear in (True, False):
        steady, ratio = restart_over_decay(linear)
        word = "linear" if linear else "quadratic"
        print(f"{word} resistance: steady {math.degrees(steady):.3f}°, comes back {ratio:.3f} times as fast as it decays")
    found = [1e3 * barometric(density, share) for density in IRON for share in CARRIED]
    print("barometric, ms/d by mbar:", ", ".join(f"{value:.2f}" for value in sorted(found)))
    print("steel, ms/d by K:", ", ".join(f"{1e3 * temperature(one):.0f}" for one in STEEL))
    print(f"Graham, drive + 10 %: period {1e6 * drive_and_period():+.1f} ppm")
    print("circular error, s/d:", ", ".join(f"{1e3 * a:.2f} mrad {circular(a):.2f}" for a in (0.048, 0.053319, 0.055)))


if __name__ == "__main__":
    main()
