"""Are the values of a sweep read as a scene file reads them?"""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import watchsim as ws
from watchsim.studies.axes import axes_from_texts, axes_from_values, slug

SCENE = ws.load(ws.profiles_dir() / "bench_lever")


def values(text):
    return axes_from_texts(SCENE, [text])[0].values


@pytest.mark.parametrize(
    "told",
    ["-4:-8:3 µN·m", "-4 µN·m:-8 µN·m:3", "-4e-3 mN·m : -8 µN·m : 3", "-4,-6,-8 µN·m", "-4 µN·m,-6 µN·m, -0.008 mN·m"],
)
def test_units_at_either_end(told):
    assert values(f"torques.0.value={told}") == pytest.approx([-4e-6, -6e-6, -8e-6], rel=1e-12)


def test_plain_numbers_and_texts():
    assert values("contacts.0.friction=0.1:0.2:3") == pytest.approx([0.1, 0.15, 0.2])
    assert values("contacts.0.friction=10:20:3 %") == pytest.approx([0.1, 0.15, 0.2])
    assert values("bodies.wheel.drawing=wheel.dxf") == ("wheel.dxf",)
    assert values("torques.0.value=-6 µN·m") == pytest.approx([-6e-6])


def test_columns_carry_units():
    axis = axes_from_texts(SCENE, ["springs.0.stiffness=0.7:0.8:2 µN·m/rad"])[0]
    assert axis.column == "springs.0.stiffness_N_m_per_rad"
    assert slug("m/s²") == "m_per_s2"


@given(st.lists(st.floats(0.01, 0.5), min_size=1, max_size=5))
def test_numbers_from_python_stay_to_the_last_bit(numbers):
    assert axes_from_values(SCENE, {"contacts.0.friction": numbers})[0].values == tuple(numbers)


@pytest.mark.parametrize(
    "text, words",
    [
        ("torques.0.value=1:2:3", "a bare number needs a unit"),
        ("torques.0.value=1:2 µN·m", "FROM:TO:N"),
        ("torques.0.value=1:2:0 µN·m", "whole number"),
        ("torques.0.value=1:2:1 µN·m", "one value"),
        ("torques.0.value=1:2:1000000000 µN·m", "more than"),
        ("torques.0.value=1:2:3 mm", "length"),
        ("torques.0.value", "KEY=FROM:TO:N"),
        ("torques.0.valeu=1,2 µN·m", "value"),
        ("torques.7.value=1,2 µN·m", "no entry 7"),
        ("contacts.0.friction=-1,0.2", "friction"),
    ],
)
def test_what_cannot_be_read(text, words):
    with pytest.raises(ws.SceneError, match=words):
        axes_from_texts(SCENE, [text])


def test_all_faults_at_once():
    with pytest.raises(ws.SceneError) as error:
        axes_from_texts(
            SCENE,
            ["torques.0.value=1:2:3", "nonsense", "contacts.9.friction=0.1,0.2", "run.duration=1,2 s", "run.duration=3 s"],
        )
    assert len(error.value.faults) == 4
