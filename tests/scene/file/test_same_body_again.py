"""What of a body stays when another file gives it another outline, or solids?"""

from __future__ import annotations

import pytest

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.designed import OUTLINE, _over, designed
from watchsim.scene.errors import Faults, SceneError
from watchsim.scene.keys import SHAPES
from watchsim.scene.placing import _centre

BODY = {key: key for key in (*OUTLINE, "inertia", "mass", "angle", "motion")}


@pytest.mark.parametrize("shape", SHAPES)
def test_another_outline_replaces_all_that_belongs_to_the_old_one(shape: str) -> None:
    left = _over(BODY, {shape: "new"})
    assert left == {"inertia": "inertia", "mass": "mass", "angle": "angle", "motion": "motion", shape: "new"}


def test_solids_replace_numbers_for_mass_and_inertia() -> None:
    assert _over(BODY, {"solids": []}) == {k: v for k, v in BODY.items() if k not in ("inertia", "mass")} | {"solids": []}
    assert _over(BODY, {"angle": 1}) == BODY | {"angle": 1}
    assert _over(BODY, 3) == 3 and _over(3, {"angle": 1}) == {"angle": 1}


@pytest.mark.parametrize(("of", "said"), [(None, "missing. Known: "), ("nonsuch", "there is no such design. ")])
def test_a_design_of_no_known_name(of: object, said: str) -> None:
    with pytest.raises(SceneError, match=said):
        designed(of)
    faults = Faults("scene.toml", {})
    with pytest.raises(SceneError):
        designed(of, faults)
    (fault,) = faults.found
    assert said in str(fault) and ("nonsuch" in str(fault)) is (of is not None)


def test_the_middle_of_open_lines_is_that_of_their_box() -> None:
    corner = Loop((Line(1.0, 2.0, 4.0, 2.0), Line(4.0, 2.0, 4.0, 9.0)), closed=False)
    assert _centre([corner]) == pytest.approx((2.5, 5.5))
