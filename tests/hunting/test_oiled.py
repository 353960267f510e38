"""Do mechanisms with loaded or loose pivots that the hunt found wrong come to their end now?"""

import sys

import hunt_path
import pytest
from hunt.generate import mechanism
from hunt.parts import Dice
from hunt.views import views

sys.path.insert(0, str(hunt_path.ROOT / "scripts" / "fuzz"))

from oiled import missed, motion, oiled, seen

from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop

FOUND = {23: (416, 433, 472, 489), 29: (428, 81, 891), 37: (805, 79, 428, 1165, 1754, 2552), 41: (1670,)}
FOUND |= {53: (394, 190, 782, 992, 1078), 71: (914,), 73: (268,)}


@pytest.mark.parametrize(("seed", "number"), [(seed, number) for seed, numbers in FOUND.items() for number in numbers])
def test_what_the_hunt_found(seed: int, number: int) -> None:
    """416: dry friction held the shaft of a loose body in flight, and drove it. 433 to 489: contacts and a bearing at the
    limit of its friction hold the same body, and their loads were shared anew without end. 428: friction that falls with
    speed led a contact towards Painlevé's paradox, and steps became too small before it counted as jammed. 81, 891, 805: a
    shaft in its hole and what its body slides along jam together, though neither does alone. 79: what nothing presses was
    pressed by next to nothing, though no forces go with that. 428: a contact stuck and slid in turn as the load of a
    bearing followed. 1165: a bearing at the limit of its friction was held below it by contacts some time later. 1754: a
    box that leans on a wall rocked on in rebounds lower than the width of a closed gap. 1670: on the line of centres no
    impulses answer an impact. 394: a force came to pass its pivot at friction times radius, and steps became too small
    before the bearing seized. 190 to 1078: what stood still under a changing load, on contacts and bearings that share it as
    they like, left the limit of one way to share it though another way held. 2552: what nearly seized, by its own friction
    more than by the bearings', was not stopped. 914: a lock on the line of centres neither slept under a changing load nor
    parted where nothing pressed it. 268: what fell was put to sleep again at the instant of its fall."""
    run = simulate(oiled(mechanism(seed, number), Dice(seed + 1000, number)), tolerance=1e-9)
    assert run.stop == Stop.DURATION
    assert missed(run) < 1e-9


@pytest.mark.parametrize(("seed", "number"), [(37, 334), (41, 167)])
def test_no_rounding_chooses(seed: int, number: int) -> None:
    """334: at a slip of 1e-13 m/s an impact had the friction of sliding, without slip that of rest. 167: a bearing at the limit
    of its friction began to move by an acceleration of rounding size, against the friction that had just been found."""
    scene = oiled(mechanism(seed, number), Dice(seed + 1000, number))
    coarse, fine = (motion(scene, simulate(scene, tolerance=tolerance)) for tolerance in (1e-9, 1e-11))
    assert abs(coarse - fine).max() < 1e-8


@pytest.mark.parametrize(("seed", "number"), [(59, 8), (41, 163)])
def test_a_mirror_image_holds_as_well(seed: int, number: int) -> None:
    """Nothing presses a contact that friction in the bearing and its own could hold: rounding let go in one of both views."""
    scene = oiled(mechanism(seed, number), Dice(seed + 1000, number))
    view = views(scene, number, 2)[1]
    one, other = (simulate(shown, tolerance=1e-9) for shown in (scene, seen(view, scene)))
    assert abs(motion(scene, one) - motion(scene, other, view)).max() < 1e-7


def test_a_shaft_that_hardly_leaves_its_hole_meets_it_again() -> None:
    """The tangent of its gap, 1e-16 m at the top of a rebound, vanished long after the curve of the hole had closed it."""
    scene = oiled(mechanism(97, 2285), Dice(1097, 2285))
    assert simulate(scene, tolerance=1e-11).stop == Stop.DURATION
