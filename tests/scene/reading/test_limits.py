"""Where exactly does the reader of scenes draw the line? Every limit from either side, close by."""

from __future__ import annotations

import pytest
from scene_texts import read

from watchsim.scene.errors import SceneError

BODIES = """
[bodies.wheel]
circle = "1 mm"
inertia = "2 g·cm²"
[bodies.pinion]
circle = "0.5 mm"
inertia = "3 g·cm²"
position = ["5 mm", "0 mm"]
"""
SPRING = '[[springs]]\nbody = "wheel"\nstiffness = "5 µN·m/rad"\n'
GEARS = '[[gears]]\nbetween = ["wheel", "pinion"]\nratio = -3\nbacklash = "2°"\n'
CONTACT = '[[contacts]]\nbetween = ["wheel", "pinion"]\n'
LAW = f"{CONTACT}restitution = 0.5\n"
TRAIN = """[[torques]]
body = "wheel"
over = "barrel"
table = [["0 rev", "9 mN·m"], ["7 rev", "3 mN·m"]]
"""
WIRE = '[bodies.b]\n[[bodies.b.solids]]\nhairspring = true\nthickness = "0.1 mm"\ndensity = "8 g/cm³"\n'
SCREW = """[bodies.b]
polygon = [["3 mm", "0 mm"], ["5 mm", "0 mm"], ["4 mm", "1 mm"]]
[[bodies.b.solids]]
layer = "polygon"
turned = [["0 mm", "0 mm"], ["1 mm", "0 mm"]]
lying = true
density = "8 g/cm³"
"""
LEAF = """[[springs]]
body = "wheel"
leaf = {{ modulus = "200 GPa", length = "5 mm", width = "2 mm", thickness = "{}", arm = "3 mm" }}
"""


LIMITS = [  # (text with a place for the value, the last that is taken, the first that is not, what is said of it)
    (BODIES + "[run]\ntolerance = {}", "1.0e-13", "0.99e-13", "between 1e-13 and 0.01"),
    (BODIES + "[run]\ntolerance = {}", "0.01", "0.0101", "between 1e-13 and 0.01"),
    (BODIES + '[run]\nrecord = "every {}"', "999999999", "1000000000", "every 10"),
    (BODIES + '[run]\nrecord = "every {}"', "1", "0", "every 10"),
    (BODIES + '[run]\nrecord = ["{} s", "0.5 s"]', "0", "-0.001", "from an earlier"),
    (BODIES + '[run]\nrecord = ["0.5 s", "{} s"]', "0.5001", "0.5", "from an earlier"),
    (BODIES + '[run]\nduration = "{} s"', "1e-100", "0.9e-100", "too small"),
    (BODIES + '[run]\nduration = "{} s"', "1e50", "1.1e50", "too large"),
    (BODIES + '[bodies.far]\nmotion = "fixed"\nposition = ["{} m", "0 m"]', "1e9", "1.1e9", "too large"),
    (BODIES + '[bodies.far]\nmotion = "fixed"\nposition = ["{} m", "0 m"]', "-1e9", "-1.1e9", "too large"),
    (BODIES + '[bodies.far]\nmotion = "fixed"\nangle = "{} rad"', "1e9", "1.1e9", "too large"),
    (BODIES + "[scene]\nschema = {}", "1", "2", "reads schema 1"),
    (BODIES + '[scene]\ntangential_law = "pg1996"\nnu = {}', "0", "-0.001", "between 0 and 1"),
    (BODIES + '[scene]\ntangential_law = "pg1996"\nnu = {}', "1", "1.001", "between 0 and 1"),
    (BODIES + '[scene]\ntangential_law = "shifted"\nnu = {}', "0", "0.0001", "the law here is shifted"),
    (BODIES + '[timegrapher]\nlift_angle = "{}°"', "359.9", "360", "below a full turn"),
    (BODIES + "[expect]\nimpacts = {{ value = 3, tolerance = {} }}", "0.001", "0", "above zero"),
    (BODIES + CONTACT + "friction = {}", "0", "-0.001", "would drive"),
    (BODIES + CONTACT + "restitution = {}", "0", "-0.001", "must lie"),
    (BODIES + CONTACT + "restitution = {}", "1", "1.001", "must lie"),
    (BODIES + LAW + 'tangential_restitution = {}\n[scene]\ntangential_law = "pg1996"', "1", "1.001", "must lie"),
    (BODIES + LAW + 'tangential_restitution = {}\n[scene]\ntangential_law = "pg1996"', "0", "-0.001", "must lie"),
    (BODIES + LAW + 'tangential_restitution = {}\n[scene]\ntangential_law = "shifted"', "0.5", "0.501", "not be above"),
    (BODIES + LAW + "tangential_restitution = {}", "0", "0.0001", "gives no tangential impulse"),
    (BODIES + GEARS + "restitution = {}", "0", "-0.001", "must lie"),
    (BODIES + GEARS + "restitution = {}", "1", "1.001", "must lie"),
    (BODIES + GEARS + "efficiency = {}", "1", "1.001", "share of the work"),
    (BODIES + GEARS + "efficiency = {}", "0.001", "0", "share of the work"),
    (BODIES + GEARS + 'pressure_angle = "{}°"', "0", "-0.1", "between 0° and 45°"),
    (BODIES + GEARS + 'pressure_angle = "{}°"', "44.9", "45", "between 0° and 45°"),
    (BODIES + GEARS.replace("2°", "{}°"), "0", "-0.1", "cannot be negative"),
    (BODIES + GEARS.replace("-3", "{}"), "-0.001", "0", "must not be 0"),
    (BODIES + TRAIN + "ratio = -3\nefficiency = {}", "1", "1.001", "share of the work"),
    (BODIES + TRAIN + "ratio = -3\nefficiency = {}", "0.001", "0", "share of the work"),
    (BODIES + TRAIN + "ratio = {}", "1.0e-6", "0.99e-6", "must not be 0"),
    (BODIES + TRAIN + "ratio = {}", "-1.0e-6", "-0.99e-6", "must not be 0"),
    (BODIES + LEAF, "4.9 mm", "5 mm", "a leaf is thin"),
    (BODIES + SPRING + 'rest = "5°"\nstop = "2°"\nrestitution = {}', "1", "1.001", "lies between"),
    (BODIES + SPRING + 'rest = "5°"\nstop = "2°"\nrestitution = {}', "0", "-0.001", "lies between"),
    (BODIES + SPRING + 'rest = "5°"\nstop = "{}°"', "0", "-0.1", "stands beyond it"),
    (BODIES + SPRING + 'draw = {{ inner = "1 mm", outer = "2 mm", turns = {} }}', "1", "0.99", "1 to 100 turns"),
    (BODIES + SPRING + 'draw = {{ inner = "1 mm", outer = "2 mm", turns = {} }}', "100", "100.1", "1 to 100 turns"),
    (BODIES + SPRING + 'draw = {{ inner = "1 mm", outer = "{} mm", turns = 9 }}', "1.001", "1", "outside the collet"),
    (BODIES + '[[damping]]\nbody = "wheel"\nviscous = "{} nN·m·s"', "0", "-0.001", "would drive"),
    (BODIES + '[[damping]]\nbody = "wheel"\nquadratic = "{} nN·m·s²/rad²"', "0", "-0.001", "would drive"),
    (BODIES + '[[damping]]\nbody = "wheel"\ncoulomb = "{} nN·m"', "0", "-0.001", "would drive"),
    (BODIES + SPRING + '[timegrapher]\nfrequency = "{} Hz"', "0.8753", "0.8754", "more than 10 % off"),
    (BODIES + SPRING + '[timegrapher]\nfrequency = "{} Hz"', "0.7162", "0.7161", "more than 10 % off"),
    (WIRE + 'inner = "0.6 mm"\nouter = "{} mm"\nwidth = "1 nm"\nturns = 9', "0.61", "0.6", "larger than inner"),
    (WIRE + 'inner = "0.6 mm"\nouter = "1.5 mm"\nwidth = "{} mm"\nturns = 9', "0.099", "0.101", "only 0.1 mm of room"),
    (WIRE + 'inner = "0.1 mm"\nouter = "4.6 mm"\nwidth = "{} mm"\nturns = 9', "0.199", "0.2", "only 0.2 mm of room"),
    (SCREW + "count = {}", "1", "0", "from 1 to 1000"),
    (SCREW + "count = {}", "1000", "1001", "from 1 to 1000"),
]


@pytest.mark.parametrize(("text", "taken", "refused", "said"), LIMITS)
def test_the_last_value_is_taken_and_the_next_refused(text: str, taken: str, refused: str, said: str) -> None:
    read(text.format(taken))
    with pytest.raises(SceneError) as caught:
        read(text.format(refused))
    (fault,) = caught.value.faults
    assert said in str(fault)
