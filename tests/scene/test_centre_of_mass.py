"""Does gravity act where the scene says the centre of mass lies?"""

from __future__ import annotations

import math

import pytest
from every_time import few
from scipy.special import j1

import watchsim as ws
from watchsim.mechanism.check import notes
from watchsim.scene.errors import SceneError
from watchsim.studies.steady import steady

BALANCE = """
[scene]
schema  = 1
gravity = ["0 m/s²", "-9.81 m/s²"]

[bodies.balance]
circle         = "4.5 mm"
pivot          = ["1 mm", "0 mm"]
position       = ["0 mm", "3 mm"]
angle          = "-90°"
mass           = "50 mg"
inertia        = "12 mg·cm²"
centre_of_mass = ["0.3 µm", "0.4 µm"]
"""


def loaded(tmp_path, text):
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    return ws.load(tmp_path)


def test_it_stands_instead_of_that_of_the_outline(tmp_path):
    scene = loaded(tmp_path, BALANCE)
    body = scene.body("balance")
    assert body.centre_of_mass == pytest.approx((0.3e-6, 0.4e-6), rel=1e-6, abs=0.0)
    assert (body.mass, body.inertia) == pytest.approx((50e-6, 12e-10))
    assert not any(note.code == "centre-of-mass" for note in notes(scene))


def test_without_it_the_outline_says_where(tmp_path):
    text = BALANCE.replace('centre_of_mass = ["0.3 µm", "0.4 µm"]', "")
    scene = loaded(tmp_path, text)
    assert scene.body("balance").centre_of_mass == pytest.approx((-1e-3, 0.0))
    assert any(note.code == "centre-of-mass" for note in notes(scene))


def test_it_is_a_path_like_any_other(tmp_path):
    scene = loaded(tmp_path, BALANCE).set("bodies.balance.centre_of_mass.1", "5 µm")
    assert scene.body("balance").centre_of_mass == pytest.approx((0.3e-6, 5e-6), rel=1e-6, abs=0.0)


@pytest.mark.parametrize(
    "old, new, why",
    [
        ('mass           = "50 mg"\n', "", "needs mass and inertia"),
        ('inertia        = "12 mg·cm²"\n', "", "needs mass and inertia"),
        ('"0.4 µm"]', '"0.4 mg"]', "mass"),
        ('["0.3 µm", "0.4 µm"]', '"0.3 µm"', "two values"),
        ("pivot          = ", 'motion = "free"\npivot = ', "a free body turns about its centre of mass"),
        ("pivot          = ", 'motion = "fixed"\npivot = ', "cannot turn"),
        ("centre_of_mass", "center_of_mass", "centre_of_mass"),
    ],
)
def test_what_does_not_go_with_it_is_refused(tmp_path, old, new, why):
    assert old in BALANCE
    with pytest.raises(SceneError, match=why):
        loaded(tmp_path, BALANCE.replace(old, new))


def test_beside_solids_it_is_refused(tmp_path):
    solids = '\n[[bodies.balance.solids]]\nlayer = "circle"\nthickness = "0.1 mm"\ndensity = "8 g/cm³"\n'
    text = BALANCE.replace('mass           = "50 mg"\n', "").replace('inertia        = "12 mg·cm²"\n', "")
    with pytest.raises(SceneError, match="solids already give the centre of mass"):
        loaded(tmp_path, text + solids)


@pytest.mark.parametrize("down", few([(0.0, 1.0), (1.0, 0.0), (-1.0, 0.0), (0.0, -1.0)], 1))
def test_poise_error_in_four_positions(down):
    """(m g r / k) J₁(A)/A, times the cosine between the heavy place at rest and down; a harmonic swing about rest, in s/d."""
    watch = ws.load(ws.profiles_dir() / "bench_lever")
    inertia, stiffness = watch.body("balance").inertia, watch.springs[0].stiffness
    watch = watch.set("bodies.balance.mass", "50 mg").set("bodies.balance.inertia", inertia)
    poised = steady(watch.set("bodies.balance.centre_of_mass", ["0 µm", "0 µm"]))
    x, y = 0.2e-6, -0.35e-6
    hanging = watch.set("bodies.balance.centre_of_mass", (x, y)).set("scene.gravity", tuple(9.81 * one for one in down))
    cycle = steady(hanging)
    swing = math.radians(cycle.amplitude_deg)
    law = 86400.0 * 50e-6 * 9.81 * (x * down[0] + y * down[1]) / stiffness * j1(swing) / swing
    assert abs(law) > 0.3
    assert cycle.rate_s_per_d - poised.rate_s_per_d == pytest.approx(law, rel=0.01)
