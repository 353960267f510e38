"""Is a pin-pallet escapement what was asked for, does it tick, and does more drive take rate and amplitude where it should?"""

from __future__ import annotations

import math

import pytest
from every_time import few
from profiles.running import check_running, of_profile, stepping_errors

import watchsim as ws
from watchsim import designs
from watchsim.construction.registry import design
from watchsim.escapement.function_report import judgements
from watchsim.escapement.measure import measure


@pytest.mark.parametrize(
    "chosen",
    few([{}, {"lock": 2.5, "lift": 8.5, "drop": 3.4, "draw": 14.0}, {"teeth": 18, "pallet_pin": 0.2, "lift_angle": 46.0}], 1),
)
def test_led_by_hand_it_has_the_angles_chosen(chosen):
    """Lever and wheel are turned against each other along the drawn outlines, which knows nothing of the construction."""
    values = design("pin_pallet").chosen(chosen)
    scene = designs.pin_pallet(**{name: design("pin_pallet").dimension(name).shown(x) for name, x in chosen.items()}).scene()
    found = measure(scene)
    assert found.missing == () and found.pallets and found.fork and found.teeth == values.teeth
    for one in found.pallets:
        assert math.degrees(one.lock.value) == pytest.approx(values.lock, abs=1e-4)
        assert math.degrees(one.run.value) == pytest.approx(values.run, abs=1e-4)
        assert math.degrees(one.lift.value) == pytest.approx(values.lift, abs=1e-4)
        assert math.degrees(one.drop.value) == pytest.approx(values.drop, abs=1e-4)
        assert math.isnan(one.draw_end.value), "a corner rounds the pin as it unlocks"
    assert math.degrees(min(one.draw.value for one in found.pallets)) == pytest.approx(values.draw, abs=1e-4)
    for one in found.fork.lift_angle:
        assert math.degrees(one.value) == pytest.approx(values.lift_angle, abs=1e-3)
    assert [one.code for one in judgements(scene, found) if one.severity == "warning"] == []


def test_twenty_seconds():
    check_running(of_profile("pin_pallet", 20.0), 24.0, 100.0)


@pytest.mark.slow
def test_five_minutes():
    check_running(of_profile("pin_pallet", 300.0), 24.0, 1500.0)


def test_the_amplitude_goes_as_the_root_of_the_drive():
    """Free but for the lift: A ∝ √T, were there no losses that grow less than the drive; and a weaker drive loses more."""
    weak, strong = (ws.steady(designs.pin_pallet(torque=f"{torque} µN·m").scene()) for torque in (1.4, 2.8))
    assert strong.amplitude_deg / weak.amplitude_deg == pytest.approx(math.sqrt(2.0), rel=0.01)
    assert weak.rate_s_per_d < strong.rate_s_per_d < 0.0


def test_without_draw_friction_holds_the_lever_where_it_is():
    with pytest.raises(ws.SceneError, match=r"does not hold at a friction of 0\.25"):
        designs.pin_pallet(friction=0.25)


@pytest.mark.parametrize(
    ("chosen", "blamed"),
    [
        ({"embraced": 2.0}, "embraced"),
        ({"teeth": 21, "embraced": 1.5}, "embraced"),
        ({"pallet_pin": 0.6}, "guard_freedom"),
        ({"drop": 1.5}, "drop"),
        ({"pallet_pin": 1.0}, "pallet_pin"),
        ({"guard_freedom": 2.4}, "guard_freedom"),
        ({"lock": 0.5, "guard_freedom": 0.5}, "lock"),
        ({"crescent": 15.0}, "crescent"),
        ({"tip_radius": 20.0}, "tip_radius"),
    ],
)
def test_conflicts_name_what_to_change_first(chosen, blamed):
    assert blamed in [one.dimension for one in design("pin_pallet").refusals(chosen)]


def test_the_drop_that_is_asked_for_is_just_enough():
    """Then the wheel can be turned back by next to nothing as a pin is about to be unlocked."""
    (conflict,) = design("pin_pallet").refusals({"drop": 1.5})
    needed = float(conflict.message.split("must be at least ")[1].split("°")[0])
    enough = measure(designs.pin_pallet(drop=f"{needed + 0.01} °").scene())
    assert enough.pallets is not None
    assert 0.0 <= min(math.degrees(one.shake.value) for one in enough.pallets) < 0.2


@pytest.mark.slow
def test_time_stepping_comes_to_the_same():
    coarse, fine = stepping_errors(designs.pin_pallet().scene(), 2.0, (1.6e-5, 4e-6))
    assert fine < 0.01 and fine < 0.5 * coarse
