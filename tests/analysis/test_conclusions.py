"""Is what is concluded from a run the same whatever is recorded of it, and whatever train drives the escape wheel?"""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from every_time import few
from ordinary.geared_escapements import with_train

import watchsim as ws
from watchsim.scene.roles import Roles, oscillators, pitch, roles
from watchsim.scene.scene import Scene

OTHERWISE = {"wall_s", "compile_s", "realtime_factor", "kept", "scene_file", "versions", "counts", "expect"}


def profile(name: str) -> Scene:
    return ws.load(ws.profiles_dir() / name)


SWINGING = sorted(
    path.name for path in ws.profiles_dir().iterdir() if (path / "scene.toml").is_file() and oscillators(ws.load(path))
)


def concluded(scene: Scene, duration: float, record: str) -> dict[str, Any]:
    numbers = ws.summary(ws.simulate(scene, duration, record=record))
    return {key: value for key, value in numbers.items() if key not in OTHERWISE}


def same_by_any_record(scene: Scene, duration: float) -> dict[str, Any]:
    everything = concluded(scene, duration, "all")
    assert concluded(scene, duration, "events") == everything
    assert concluded(scene, duration, "statistics") == everything
    return everything


@pytest.mark.parametrize("name", few(SWINGING, lambda name: name in ("swiss_lever", "detent", "graham")))
def test_what_is_recorded_changes_no_number(name: str) -> None:
    same_by_any_record(profile(name), 8.0)


def test_teeth_in_contact_are_gears() -> None:
    """Four pairs, 30 teeth on 8: the wheel that the lever locks has 15 teeth, and a pinion of 8 on its arbor."""
    from watchsim.scene.teeth import train

    scene = with_train(profile("swiss_lever"), 4)
    assert roles(scene) == Roles("balance", "wheel", "lever")
    assert pitch(scene, "wheel") == pytest.approx(0.41887902047863906, rel=1e-12)
    assert train(scene, "gear 4")["wheel"] == pytest.approx((30.0 / 8.0) ** 4, rel=1e-12)


@pytest.mark.parametrize("name", few(["swiss_lever", "detent", "coaxial", "cylinder", "duplex"], 1))
@pytest.mark.parametrize("pairs", few([1, 2, 3], lambda pairs: pairs == 2))
def test_through_real_gears_it_goes_as_driven_directly(name: str, pairs: int) -> None:
    """Without friction the wheel is driven as before, but for the play and inertia of the gears: it goes as far in as many
    beats, and none is missed, whatever is recorded."""
    scene = profile(name)
    geared = with_train(scene, pairs)
    assert roles(geared) == roles(scene)
    numbers = same_by_any_record(geared, 8.0)
    assert numbers["missed_beats"] == 0
    assert numbers["verdict"] in ("ticks", "unsettled")
    direct = concluded(scene, 8.0, "statistics")
    assert numbers["amplitude_deg"] == pytest.approx(direct["amplitude_deg"], rel=0.02)
    assert numbers["beats"] == direct["beats"]


@pytest.mark.parametrize("record", ["all", "statistics"])
def test_an_escapement_that_does_nothing_has_no_rate(record: str) -> None:
    """The wheel stands 90 mm away from the anchor of a pendulum that swings on its own."""
    run = ws.simulate(profile("graham").set("bodies.wheel.position.1", "-90 mm"), 20.0, record=record, to_the_end=False)
    numbers = ws.summary(run)
    assert (numbers["amplitude_deg"], numbers["rate_s_per_d"]) == (None, None)
    assert "wheel never touched anything" in numbers["timing_message"]
    assert numbers["verdict"] == "trips"
    assert numbers["verdict_details"]["t_s"] == pytest.approx(0.0, abs=0.01)


def test_without_a_lift_angle_it_is_still_said_that_it_has_not_settled() -> None:
    """What swings through its rest position is judged; a click on its ratchet never does."""
    assert concluded(replace(profile("graham"), lift_angle=None), 30.0, "statistics")["verdict"] == "unsettled"
    assert concluded(profile("ratchet"), 1.0, "statistics")["verdict"] is None


def test_a_wheel_that_goes_to_and_fro_stands() -> None:
    """An escape wheel moved by 0.2 mm: after 14 s each tooth is thrown back to where it came from. Three half swings end half a
    pitch further than they began."""
    scene = profile("grasshopper")
    for k, torque in enumerate((-1.0427935734281793e-06, 1.0427935734281793e-06, -0.0004171174293712717)):
        scene = scene.set(f"torques.{k}.value", torque)
    wheel, *others = scene.bodies
    scene = replace(scene, bodies=(replace(wheel, position=(-0.00013023634525889351, -0.00014087605510079267)), *others))
    run = ws.simulate(scene, 20.13)
    assert np.ptp(run.sample(np.linspace(18.0, 20.13, 500))[0][:, run.slices["wheel"].start]) > 0.05
    assert ws.verdict(run).name == "stops"
