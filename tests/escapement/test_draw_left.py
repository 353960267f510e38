"""Is the lever drawn to its bank as long as friction in face and pivot leaves draw, and not beyond?"""

import math
from dataclasses import replace

import pytest

from watchsim.escapement.function_report import draw_left, held_by_pivot, judgements
from watchsim.escapement.measure import Function, measure
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Bearing
from watchsim.scene.load import load
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate

FRICTION = 0.12  # of the faces


@pytest.fixture(scope="module")
def lever() -> tuple[Scene, Function]:
    scene = load(profiles_dir() / "swiss_lever" / "scene.toml").set("bodies.lever.mass", 5e-6)
    return scene, measure(scene)


def pivoted(scene: Scene, grip: float, play: float = 0.0) -> Scene:
    """The lever in a bearing whose circle of friction has that radius, m."""
    return replace(scene, bearings=(Bearing("lever", grip / 0.1, 0.1, play=play),))


@pytest.mark.parametrize(("share", "drawn"), [(0.97, True), (1.03, False)])
def test_the_draw_that_is_left_decides_whether_the_lever_moves(
    lever: tuple[Scene, Function], share: float, drawn: bool
) -> None:
    """A lever a twentieth of a degree off its bank, pressed by the wheel, in a run without the balance."""
    scene, function = lever
    assert function.arms is not None and function.pallets is not None and function.banks is not None
    k = 0 if function.sides[0] > 0.0 else 1  # locks on the upper bank, where the scene begins
    draw, arm = function.pallets[k].draw.value, function.arms[k]
    grip = share * arm * math.sin(draw - math.atan(FRICTION))
    alone = replace(
        scene, contacts=tuple(one for one in scene.contacts if "balance" not in {side.body for side in one.sides})
    ).set("bodies.lever.angle", function.banks[0] - math.radians(0.05))
    alone = alone.set("bodies.wheel.angle", alone.body("wheel").angle + math.radians(0.0066))
    run = simulate(pivoted(alone, grip), duration=0.05)
    assert run.failure is None
    moved = float(run.end_q[run.slices["lever"]][0]) - function.banks[0]
    assert (abs(moved) < 1e-5) == drawn


def test_check_says_what_is_left(lever: tuple[Scene, Function]) -> None:
    scene, function = lever
    assert list(draw_left(scene, function)) == []
    first, second = draw_left(pivoted(scene, 5e-6), function)
    least = min(function.pallets[0].draw_end.value, function.pallets[0].draw.value)
    left = math.degrees(least - math.atan(FRICTION) - math.asin(5e-6 / function.arms[0]))
    assert f"{left:.3f}°" in first and "pivot" in second
    assert held_by_pivot(pivoted(scene, 5e-6, 1e-6), function)[0] < held_by_pivot(pivoted(scene, 5e-6), function)[0]
    sticks = [one for one in judgements(pivoted(scene, 4e-4), function) if one.code == "draw"]
    assert sticks and "with that of the pivot" in sticks[0].message
