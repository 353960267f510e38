"""Is a design that cannot be drawn, or would not go, refused with the reason, and with the dimension to change first?"""

import pytest

import watchsim as ws
from watchsim import designs
from watchsim.construction.registry import design

Dimensions = dict[str, str | float]
ANCHORS: list[tuple[Dimensions, str]] = [
    ({"embraced": 7.0}, "whole number and a half"),
    ({"drop": "5 °", "teeth": 36, "embraced": 9.5}, "nothing would be left of the pallets"),
    ({"lock": "2.5 °"}, "must be less than the lift"),
    ({"start": "1 °"}, "no tooth is let off"),
    ({"undercut": "15 °"}, "thinner at its foot"),
    ({"teeth": 60, "embraced": 2.5}, "can be drawn"),
]
REFUSED: dict[str, list[tuple[Dimensions, str]]] = {  # design: dimensions, and why they are refused
    "verge": [
        *(({"teeth": 26}, "teeth"), ({"lift": "39°"}, "lift"), ({"drop": "4.5 mm"}, "drop"), ({"slope": "26°"}, "slope"))
    ],
    "graham": ANCHORS,
    "recoil_anchor": ANCHORS,
    "grasshopper": [
        *(
            ({"torque": "1.2 mN·m"}, "would sustain"),
            ({"torque": "0.4 mN·m"}, "would sustain"),
            ({"span": 30}, "puts the pallets"),
        ),
        ({"teeth": 58, "tip_radius": "24.9 mm", "span": 9, "release": "1.13°", "overswing": "0.8°"}, "cut into the teeth"),
        ({"span": 9}, "would swing into the teeth"),
        ({"nib": "1.15 mm"}, "stays among the teeth"),
        ({"nib": "1.4 mm"}, "meets the floor"),
        ({"overswing": "0.85°"}, "passes over its tooth"),
        ({"pallet_torque": "0.1 µN·m"}, "slow to clear the teeth"),
        ({"pallet_torque": "60 µN·m"}, "pulls the pallets off"),
        ({"height": "3 mm"}, "at this pitch"),
    ],
    "remontoir": [
        ({"train": "6 µN·m"}, "the wound spring asks for 6.28 µN·m"),
        ({"eccentricity": "0.03 mm"}, "clear of both pallets"),
        ({"eccentricity": "0.5 mm"}, "leave its fork"),
        ({"arm": "2 mm"}, "no room"),
        ({"lock": "2°", "guard_freedom": "2.5°"}, "less than the total lock"),
    ],
    "geneva": [
        *(
            ({"slots": 3, "pin_radius": "2 mm"}, "run into each other"),
            ({"lock_radius": "3 mm"}, "does not reach into the wheel"),
        ),
        ({"lock_radius": "8.6 mm"}, "the pin stands beside the disc"),
    ],
    "jumper": [
        ({"depth": "3.5 mm"}, "root radius"),
        ({"teeth": 16, "pin_radius": "0.45 mm"}, "does not fit between"),
        ({"crank": "1 mm"}, "does not carry a tooth that far"),
        ({"beak_radius": "3 mm"}, "too large to lie"),
    ],
    "ratchet": [
        *(
            ({"click_angle": "75°"}, "else the click lies in the teeth"),
            ({"winding": "0.5 mN·m"}, "does not wind the mainspring"),
        ),
        ({"nose_radius": "0.4 mm"}, "does not reach deep enough"),
    ],
    "winding_click": [
        ({"reach": "0.6 mm"}, "else the nose meets the roots"),
        ({"bank": "-30°"}, "the nose is out of the teeth"),
        ({"winding": "0.5 mN·m"}, "does not wind the mainspring"),
        ({"teeth": 40, "nose_radius": "0.2 mm"}, "meets the back of a tooth"),
        ({"nose_radius": "0.5 mm"}, "does not meet a locking face"),
        ({"bank": "-22°"}, "does not meet a locking face"),
    ],
    "snail": [
        *(
            ({"tail": "16 mm", "least": "5 mm"}, "find room on step 1 "),
            ({"tail": "24.5 mm", "least": "5 mm"}, "find room on step 12"),
        ),
        ({"tail": "10 mm"}, "does not bring the pin to the lowest step"),
        *(
            ({"leaf_force": "15 mN"}, "the leaf slackens before the lowest step"),
            ({"lifting": "0.13 mN·m"}, "to gather the rack up"),
        ),
        ({"hour": "0.2 s"}, "no time to come to rest"),
        ({"pin_radius": "1.6 mm"}, "find room on step 12"),
        ({"tooth": "4.5°", "least": "2 mm", "leaf_force": "80 mN", "lifting": "1 mN·m"}, "would reach the rack's axis"),
    ],
    "cycloidal_pair": [
        ({"addendum": 1.9}, "pointed"),
        ({"pinion_teeth": 6, "pinion_dedendum": 2.5, "addendum": 1.9}, "pointed"),
        ({"tooth": 1.8, "leaf": 1.4}, "no play"),
        ({"pinion_dedendum": 1.2}, "meet the floor of the pinion"),
        ({"wheel_dedendum": 0.6}, "meet the floor of the wheel"),
    ],
    "involute_pair": [
        ({"addendum": 1.2, "pinion_teeth": 6, "shift": 0.7}, "pointed"),
        ({"pinion_teeth": 8}, "cut in"),
        ({"spread": 0.3, "addendum": 0.5}, "contact ratio"),
        ({"arcs": 1, "spread": 0.01}, "more arcs"),
        ({"dedendum": 0.7}, "meet the floor"),
    ],
    "governor": [({"root": "29 mm"}, "no vane is left"), ({"thickness": "8 mm"}, "at most 6 mm")],
}


@pytest.mark.parametrize(("name", "dimensions", "why"), [(name, *one) for name, cases in REFUSED.items() for one in cases])
def test_what_does_not_fit_is_refused(name: str, dimensions: Dimensions, why: str) -> None:
    with pytest.raises(ws.SceneError, match=why):
        getattr(designs, name)(**dimensions).scene()


BLAMED: dict[str, list[tuple[dict[str, float], str]]] = {  # design: dimensions, and which of them is to be changed first
    "detent": [
        ({"friction": 0.2, "draw": 10.0}, "draw"),
        ({"undercut": 18.0, "draw": 18.0}, "undercut"),
        ({"teeth": 18, "reach": 10.5}, "reach"),
        ({"travel": 2.0, "lock": 1.2, "clearance": 1.0}, "travel"),
        ({"tip_radius": 2.0, "discharge_radius": 0.3}, "discharge_radius"),
        ({"tip_radius": 20.0}, "tip_radius"),
    ],
    "cylinder": [
        ({"tooth_width": 11.0}, "tooth_width"),
        ({"tooth_width": 10.55}, "tooth_width"),
        ({"drop": 1.0}, "drop"),
        ({"lift": 20.0, "friction": 0.25}, "lift"),
        ({"start": 40.0, "lift": 70.0}, "start"),
        ({"torque": 0.004}, "torque"),
    ],
    "duplex": [
        ({"reach": 10.0}, "reach"),
        ({"drop": 3.0, "reach": 6.0}, "drop"),
        ({"notch": 40.0}, "undercut"),
        ({"drop": 16.0, "reach": 6.0, "intersection": 30.0}, "drop"),
        ({"teeth": 16, "reach": 7.0}, "undercut"),
        ({"intersection": 12.0, "friction": 0.2}, "intersection"),
        ({"start": 280.0, "letting_go": -30.0}, "start"),
    ],
    "pin_pallet": [
        *(
            ({"embraced": 2.0}, "embraced"),
            ({"teeth": 21, "embraced": 1.5}, "embraced"),
            ({"pallet_pin": 0.6}, "guard_freedom"),
        ),
        ({"drop": 1.5}, "drop"),
        ({"pallet_pin": 1.0}, "pallet_pin"),
        ({"guard_freedom": 2.4}, "guard_freedom"),
        *(
            ({"lock": 0.5, "guard_freedom": 0.5}, "lock"),
            ({"crescent": 15.0}, "crescent"),
            ({"tip_radius": 20.0}, "tip_radius"),
        ),
    ],
    "pin_wheel": [
        ({"lock": 2.0, "lift": 1.5}, "lock"),
        ({"start": 1.0}, "start"),
        ({"reach": 1.0}, "reach"),
        ({"pins": 60, "drop": 2.5}, "drop"),
        ({"pin_diameter": 9.0}, "pin_diameter"),
        ({"lift": 5.0, "drop": 4.0, "start": 3.5}, "lift"),
        ({"torque": 500.0}, "torque"),
        ({"torque": 1.0}, "torque"),
    ],
    "geneva_stop": [
        ({"hand": 5.0}, "hand"),
        ({"lock_radius": 1.4}, "lock_radius"),
        ({"pin_radius": 0.5, "turns": 3, "lock_radius": 0.9, "bottom_play": 0.9}, "pin_radius"),
    ],
}


@pytest.mark.parametrize(("name", "dimensions", "blamed"), [(name, *one) for name, cases in BLAMED.items() for one in cases])
def test_conflicts_name_what_to_change_first(name: str, dimensions: dict[str, float], blamed: str) -> None:
    assert blamed in [one.dimension for one in design(name).refusals(dimensions)]
