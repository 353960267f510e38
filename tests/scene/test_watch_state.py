"""Which way is up, how warm is it, when was it wound: what [watch] makes of a scene, against doing it by hand."""

import math
from pathlib import Path

import numpy as np
import pytest

import watchsim as ws
from watchsim.paths import profiles_dir
from watchsim.scene.errors import SceneError
from watchsim.scene.load import from_mapping, load_set
from watchsim.scene.roles import nominal_frequency, oscillators
from watchsim.scene.scene import Scene
from watchsim.scene.toml import parsed

G = 9.80665
BALANCE = """
[bodies.balance]
circle = "1 mm"
mass = "50 mg"
inertia = "12 mg·cm²"
centre_of_mass = ["2 µm", "-1 µm"]
angle = "200°"
[[springs]]
body = "balance"
{spring}
[[damping]]
body = "balance"
q_factor = 250
coulomb = "1 nN·m"
[[bearings]]
body = "balance"
radius = "0.05 mm"
friction = 0.2
"""
BARREL = """
[[torques]]
body = "wheel"
over = "barrel"
table = [["0 rev", "9.7 mN·m"], ["3.5 rev", "7.9 mN·m"], ["7 rev", "3 mN·m"]]
ratio = -6480
run_down = "1 rev"
"""


def scene(watch: str = "", spring: str = 'frequency = "28800 vph"') -> Scene:
    return from_mapping(parsed(BALANCE.format(spring=spring) + watch), Path("x/scene.toml"))


def turned(vector: complex, degrees: float) -> complex:
    return vector * np.exp(1j * math.radians(degrees))


@pytest.mark.parametrize("twelve", [90.0, 0.0, -135.5])
@pytest.mark.parametrize("seen_from", ["dial", "back"])
@pytest.mark.parametrize("position, minutes", [("12H", 0), ("3H", 180), ("6h", 360), ("9H", 540), ("10H30", 630), ("1H07", 67)])
def test_gravity_pulls_away_from_the_hour_that_is_up(twelve: float, seen_from: str, position: str, minutes: int) -> None:
    """An hour hand that goes round from 12 h points to it: clockwise from the dial, counter-clockwise from the back."""
    clockwise = -1.0 if seen_from == "dial" else 1.0
    hand = turned(turned(1.0, twelve), clockwise * 0.5 * minutes)
    x, y = scene(f'[watch]\nposition = "{position}"\ntwelve = "{twelve}°"\nseen_from = "{seen_from}"').gravity
    assert complex(x, y) == pytest.approx(-G * hand, abs=1e-12)


@pytest.mark.parametrize("position, pull", [("12H", (0, -G)), ("3H", (-G, 0)), ("6H", (0, G)), ("9H", (G, 0)), ("CH", (0, 0))])
def test_twelve_is_at_y_where_nothing_else_is_said(position: str, pull: tuple[float, float]) -> None:
    """Right angles to the last bit, so that a lever on the line of centres stays symmetric."""
    made = scene(f'[watch]\nposition = "{position}"')
    assert made.gravity == pull
    assert scene('[watch]\nposition = "CB"\n[scene]\ngravity = ["1 m/s²", "0 m/s²"]').gravity == (0.0, 0.0)


@pytest.mark.parametrize("spring", ['frequency = "28800 vph"', 'stiffness = "0.758 µN·m/rad"'])
def test_warmth_changes_what_it_says_and_the_rate_stays_against_the_train(spring: str) -> None:
    """x(T) = x exp(c (T - 23 °C)) for each of the four; half the difference of two of them is the rate."""
    thermal = (
        '[watch]\nthermal = { stiffness = "-28 ppm/K", inertia = "22 ppm/K", damping = "-2 %/K", friction = "-0.5 %/K" }\n'
    )
    home, warm = scene(thermal, spring), scene(thermal + 'temperature = "38 °C"', spring)
    assert home == scene("", spring)
    (before,), (after,) = oscillators(home), oscillators(warm)
    assert after.spring / before.spring == pytest.approx(math.exp(-28e-6 * 15), rel=1e-14)
    assert after.inertia / before.inertia == pytest.approx(math.exp(22e-6 * 15), rel=1e-14)
    assert warm.damping[0].viscous / home.damping[0].viscous == pytest.approx(math.exp(-0.02 * 15), rel=1e-14)
    assert warm.damping[0].coulomb / home.damping[0].coulomb == pytest.approx(math.exp(-0.005 * 15), rel=1e-14)
    assert warm.bearings[0].friction / home.bearings[0].friction == pytest.approx(math.exp(-0.005 * 15), rel=1e-14)
    assert nominal_frequency(warm) == nominal_frequency(home)
    assert after.hertz is not None and before.hertz is not None
    assert after.hertz / before.hertz == pytest.approx(math.exp(-25e-6 * 15), rel=1e-12)


def test_a_day_of_the_mainspring_is_so_many_teeth() -> None:
    """4 oscillations a second, one of 15 teeth each, 6480 turns of the wheel for one of the barrel: 3.5556 turns in a day."""
    lever = parsed((profiles_dir() / "swiss_lever" / "scene.toml").read_text(encoding="utf-8"))
    lever["torques"] = parsed(BARREL)["torques"]
    made = from_mapping(lever, profiles_dir() / "swiss_lever" / "scene.toml")
    day = made.set("watch.since_wound", "24 h")
    by_hand = made.set("torques.0.run_down", f"{86400 * 4 / 15 / 6480!r} rev")
    assert np.array(day.torques[0].table) == pytest.approx(np.array(by_hand.torques[0].table), rel=1e-12)
    assert day.torques[0].value == pytest.approx(by_hand.torques[0].value, rel=1e-12)
    spring, other = day.torques[0].mainspring, by_hand.torques[0].mainspring
    assert spring is not None and other is not None
    assert (spring.run_down, spring.torque) == pytest.approx((other.run_down, other.torque), rel=1e-12)
    wound = made.set("watch.since_wound", 0.0)
    assert np.array(wound.torques[0].table) == pytest.approx(
        np.array(made.set("torques.0.run_down", 0.0).torques[0].table), rel=1e-12, abs=1e-10
    )
    with pytest.raises(SceneError, match="wound before now"):
        made.set("watch.since_wound", "-1 h")


BAD = [
    ({"watch.position": "13H"}, '"13H" is no position. There are CH, CB, 12H, 3H, 6H, 9H, and those between, such as 10H30'),
    ({"watch.position": "3H60"}, "is no position"),
    ({"watch.position": "dial up"}, "is no position"),
    ({"watch.temperature": "311 K"}, "must lie between −60 °C and 120 °C"),
    ({"watch.temperature": "38"}, "a bare number needs a unit here"),
    ({"watch.twelve": "90 mm"}, "an angle is needed"),
    ({"watch.seen_from": "front"}, "not one of dial, back"),
    ({"watch.since_wound": "24 h"}, 'needs a mainspring: a torque with over = "barrel"'),
    ({"watch.thermal.stiffness": "-28 ppm"}, "a temperature coefficient is needed"),
    ({"watch.thermal.damping": "-20 %/K"}, "at most 10 %/K"),
    ({"watch.thermal.oil": "1 %/K"}, "unknown key"),
    ({"watch.postion": "3H"}, 'Did you mean "position"?'),
    ({"watch.position": "13H", "watch.temperature": "300 °C"}, "must lie between"),
]


@pytest.mark.parametrize("changes, words", BAD, ids=lambda one: "" if isinstance(one, str) else " ".join(one))
def test_what_it_cannot_be_is_refused(changes: dict[str, object], words: str) -> None:
    with pytest.raises(SceneError) as refused:
        load_set(profiles_dir() / "swiss_lever", changes)
    assert words in str(refused.value) and len(refused.value.faults) == len(changes)


def test_an_empty_state_changes_nothing() -> None:
    plain = ws.load(profiles_dir() / "swiss_lever")
    for changes in ({"watch.twelve": "0°"}, {"watch.temperature": "38 °C"}, {"watch.thermal.stiffness": "1 ppm/K"}):
        assert load_set(profiles_dir() / "swiss_lever", changes) == plain
