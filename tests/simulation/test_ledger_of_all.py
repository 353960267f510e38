"""Does the energy balance with loaded and loose pivots, slip laws, a shaken case and a bent hairspring at once?"""

import math
from dataclasses import replace

import pytest

from watchsim.geometry.hairspring import Coil
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Bearing, Curb, Shock, SlipLaw
from watchsim.scene.load import load
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop


@pytest.mark.slow
@pytest.mark.parametrize("loose", ["", "lever", "balance"])
def test_a_swiss_lever_with_all_of_it(loose: str) -> None:
    scene = load(profiles_dir() / "swiss_lever")
    for body, mass in (("lever", 1e-6), ("balance", 4.5e-5)):
        scene = scene.set(f"bodies.{body}.mass", mass)
    bearings = tuple(
        Bearing(body, radius, 0.1, 0.0, 4e-6 if body == loose else 0.0) for body, radius in (("lever", 5e-5), ("balance", 4e-5))
    )
    slip = SlipLaw(0.04, 2e-3, 0.5)
    coil = Coil(0.6e-3, 2.8e-3, 12.25, 1.0, 3e-5)
    spring = replace(scene.springs[0], curb=Curb(0.05, math.radians(20.0)), wound=coil, coil_mass=2.4e-6)
    run = simulate(
        replace(
            scene,
            gravity=(0.0, -9.81),
            bearings=bearings,
            contacts=tuple(replace(one, slip=slip) for one in scene.contacts),
            shocks=(Shock(0.31, 4e-3, (300.0, -200.0), 50.0),),
            springs=(spring,),
        ),
        duration=1.5,
    )
    assert run.stop == Stop.DURATION
    assert run.energy["residual_relative"] < 1e-9
