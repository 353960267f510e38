"""Do rows of rebounds end where they must, and does what rests stay at rest?"""

import dataclasses
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from moving_scenes import box, circle, ground, of_kind, on_slope, polygon, touching, turned
from plain_kernels import in_python

from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.impacts import stop_repeated_rebounds
from watchsim.simulation.options import options_for
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

# When does a contact count as one that rebounds without end? Against rows of hits whose times are known.

ENDLESS_REBOUNDS = 1000  # within one accumulation time of each other
LONGEST = 1e-6  # s, between hits
CONTACT = 3


class Hits:
    """A contact that is hit again and again, and another one beside it."""

    def __init__(self) -> None:
        self.watch, self.time = SimpleNamespace(contact=-1, last=0.0, hits=0, away=0.0, rate=0.0), 1.0
        self.kernel = in_python(stop_repeated_rebounds)

    def hit(self, wait: float, rate: float = -1.0, contact: int = CONTACT, restitution: float = 0.5) -> bool:
        """Is the restitution of the one that is hit after that time taken away, and only that?"""
        self.time += wait
        kin = [SimpleNamespace(gN_dot=0.0), SimpleNamespace(gN_dot=rate)]
        event = SimpleNamespace(closed=SimpleNamespace(kin=kin, ids=[9, contact]), zero=[1e-9, 1e-9])
        left = np.array([0.7, restitution])
        found = self.kernel(self.watch, self.time, 2, SimpleNamespace(accumulation_time=LONGEST), event, left)
        assert left.tolist() == [0.7, 0.0 if found else restitution]
        return bool(found)

    def row(self, waits: np.ndarray, **how: float) -> list[bool]:
        return [self.hit(float(wait), **how) for wait in waits]


def closing(share: float, count: int) -> np.ndarray:
    """Waits that shrink evenly from 2^-20 s to that share of it, in binary numbers so that their sums are exact."""
    return 2.0**-20 * np.linspace(1.0, share, count)


def begun() -> Hits:
    hits = Hits()
    assert not hits.hit(1.0)  # nothing is known of it before
    return hits


def test_a_play_that_has_closed_to_half_of_it_ends_after_so_many_hits() -> None:
    found = begun().row(closing(0.4, ENDLESS_REBOUNDS + 5))
    assert found == [False] * ENDLESS_REBOUNDS + [True] * 5


@pytest.mark.parametrize("share", [0.51, 1.0])
def test_a_play_that_stays_goes_on(share: float) -> None:
    assert not any(begun().row(closing(share, ENDLESS_REBOUNDS + 50)))


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("rate", [-1.0, -0.02, -30.0])
def test_hits_that_change_their_rate_by_a_tenth_begin_anew(rate: float, way: float) -> None:
    hits = begun()
    waits = closing(0.4, ENDLESS_REBOUNDS + 50)
    assert not any(hits.row(waits[:500], rate=rate)) and not any(hits.row(waits[500:], rate=rate * (1.0 + 0.11 * way)))
    hits = begun()
    assert not any(hits.row(waits[:500], rate=rate)) and any(hits.row(waits[500:], rate=rate * (1.0 + 0.09 * way)))


def test_a_long_wait_begins_anew() -> None:
    hits, waits = begun(), closing(0.4, ENDLESS_REBOUNDS + 50)
    assert not any(hits.row(waits[:500])) and not hits.hit(1.01 * LONGEST) and not any(hits.row(waits[500:]))


def test_another_contact_between_changes_nothing_unless_it_comes_late() -> None:
    hits, waits = begun(), closing(0.4, ENDLESS_REBOUNDS + 50)
    assert not any(hits.row(waits[:500]))
    assert not hits.hit(2.0**-22, contact=7)
    assert any(hits.row(waits[500:]))
    hits = begun()
    assert not any(hits.row(waits[:500])) and not hits.hit(1.01 * LONGEST, contact=7)
    assert hits.watch.contact == 7 and hits.watch.hits == 0


def test_what_is_hit_twice_at_once_or_leaves_or_does_not_rebound_does_not_count() -> None:
    hits = begun()
    hits.hit(2.0**-20)
    before = vars(hits.watch).copy()
    assert not hits.hit(0.0) and not hits.hit(2.0**-21, rate=-0.9e-9) and not hits.hit(2.0**-21, restitution=0.0)
    assert vars(hits.watch) == before


# Do rebounds without loss go on where something resists or their play stays, and end where it closes without resistance?

WIDTH, SPEED = 0.01, 1.0  # m, m/s
ROCKING = Path(__file__).resolve().parents[1] / "data" / "hunt" / "levers-2001-15091.toml"
SHORT = options_for(1.0, 1e-9, 1.0).accumulation_time


def slider(name: str, place: float, velocity: float, mass: float) -> Body:
    """A box that slides along x, its middle at `place`."""
    return Body(name, "slide", (place, 0.0), axis=(1.0, 0.0), velocity=(velocity,), mass=mass, loops=(box(WIDTH, WIDTH),))


def wall(name: str, place: float) -> Body:
    return Body(name, "fixed", (place, 0.0), loops=(box(WIDTH, WIDTH),))


@pytest.mark.parametrize("ratio", [1e2, 1e6])
def test_a_light_body_between_a_wall_and_a_heavy_one_counts_the_digits_of_pi(ratio: float) -> None:
    """Galperin: unfolded, the motion is a straight line past a corner of atan(sqrt(m/M)), each of whose faces it meets."""
    bodies = wall("wall", -WIDTH), slider("light", 0.001, 0.0, 1.0), slider("heavy", 0.002 + WIDTH, -SPEED, ratio)
    contacts = touching("wall", "light", restitution=1.0) + touching("light", "heavy", restitution=1.0)
    run = simulate(Scene("pi", bodies, contacts=contacts, duration=0.02))
    hits = of_kind(run, EventKind.IMPACT)
    angle = math.atan(math.sqrt(1.0 / ratio))
    assert len({hit["t"] for hit in hits}) == math.ceil(math.pi / angle) - 1
    assert 0.5 * (run.u[-1] ** 2) @ [1.0, ratio] == pytest.approx(0.5 * ratio * SPEED**2, rel=1e-9)
    if ratio > 1e4:  # closer than the time within which rebounds may be ended
        assert np.diff([hit["t"] for hit in hits]).min() < 0.1 * SHORT


def test_a_body_between_two_walls_goes_on() -> None:
    play, many = 2e-7, 5000
    bodies = wall("left", -WIDTH), slider("body", 0.5 * play, SPEED, 1.0), wall("right", WIDTH + play)
    contacts = touching("left", "body", restitution=1.0) + touching("body", "right", restitution=1.0)
    run = simulate(Scene("play", bodies, contacts=contacts, duration=many * play / SPEED))
    assert play < 0.5 * SPEED * SHORT
    assert len(of_kind(run, EventKind.IMPACT)) == pytest.approx(many, abs=1)
    assert abs(run.u[-1, 0]) == pytest.approx(SPEED, rel=1e-12)


def test_levers_that_rock_flat_on_each_other_end_where_any_loss_leaves_them() -> None:
    """Nearly flat, two levers throw each other from corner to corner; their play closes by a factor e in 6 ms."""
    scene = load(ROCKING)
    run = simulate(scene)
    lossy = tuple(dataclasses.replace(contact, restitution=min(contact.restitution, 0.99)) for contact in scene.contacts)
    assert of_kind(run, EventKind.ACCUMULATION)
    assert abs(run.u[-1]).max() == 0.0
    assert run.q[-1] == pytest.approx(simulate(dataclasses.replace(scene, contacts=lossy)).q[-1], abs=1e-11)


def test_which_rebounds_end_belongs_to_the_state() -> None:
    scene = load(ROCKING)
    whole, first = simulate(scene, 0.106), simulate(scene, 0.1055)
    after = whole.t >= 0.1055
    assert not of_kind(first, EventKind.ACCUMULATION)
    rest = simulate(scene, 0.106, start=first)
    assert np.array_equal(rest.events, whole.events)
    assert np.array_equal(rest.q[rest.t >= 0.1055], whole.q[after])


# Do rebounds end that are lower than what counts as closed, though they lose next to nothing?

RADIUS, ACCELERATION = 0.01, 10.0


def dropped(restitution, speed):
    """A disc that slides along y, pressed down, leaves the ground with that speed and would do so some 200 times."""
    disc = Body("disc", "slide", (0.0, RADIUS), axis=(0.0, 1.0), velocity=(speed,), mass=1.0, loops=(circle(RADIUS),))
    contacts = (Contact((Side("ground"), Side("disc")), 0.0, restitution),)
    duration = 400.0 * speed / ACCELERATION
    return Scene("hops", (ground(0.1), disc), torques=(Torque("disc", -ACCELERATION),), contacts=contacts, duration=duration)


@pytest.mark.parametrize("loss", [0.0, 1e-9, 1e-3, 0.5])
def test_a_hop_of_a_twentieth_of_a_picometre_ends(loss):
    run = simulate(dropped(1.0 - loss, 1e-6))
    assert len(run.events) < 40
    assert abs(run.u[-1]).max() == 0.0


def test_a_hop_of_a_micrometre_goes_on():
    run = simulate(dropped(1.0 - 1e-9, 5e-3))
    assert len(run.events) > 190
    assert abs(run.u[-1]).max() > 0.0


# Do bodies part where a spring that pushes one against the other passes its rest?

STIFFNESS, PUSHING, PUSHED, DRAWN = 32.45, 0.02, 0.03, 6e-3


def pushed(tilt: float, place: float, friction: float) -> Scene:
    """A corner at the rest of its spring + DRAWN pushes a face that leans by `tilt`; the pusher is drawn at `place`."""
    corner = polygon((-0.01, -0.004), (0.0, 0.0), (-0.01, 0.004))
    lean = 0.01 * math.tan(tilt)
    face = polygon((0.01, -0.01), (0.01, 0.01), (-lean, 0.01), (lean, -0.01))
    a = Body("a", "slide", (-DRAWN + place, 0.0), velocity=(0.0,), mass=PUSHING, loops=(corner,))
    b = Body("b", "slide", (-DRAWN + place, 0.0), velocity=(0.0,), mass=PUSHED, loops=(face,))
    return Scene(
        "pushed",
        (a, b),
        springs=(Spring("a", STIFFNESS, DRAWN),),
        contacts=(Contact((Side("a"), Side("b")), friction, 0.0),),
        duration=0.15,
    )


@pytest.mark.parametrize("friction", [0.0, 0.79])
@pytest.mark.parametrize("place", [0.0, 1e-3 / 3.0, -1e-3 / 7.0])
@pytest.mark.parametrize("tilt", [0.0, 0.3, -0.4])
@pytest.mark.parametrize("tolerance", [1e-7, 1e-9, 1e-11])
def test_part_at_rest(tilt: float, place: float, friction: float, tolerance: float) -> None:
    run = simulate(pushed(tilt, place, friction), tolerance=tolerance)
    assert not run.stop.gave_up
    rate = math.sqrt(STIFFNESS / (PUSHING + PUSHED))
    quarter = 0.5 * math.pi / rate
    opened = run.events[run.events["kind"] == EventKind.OPEN]
    # The force may vanish within its rounding, 1e-10 of that of a spring stretched by the size.
    assert opened["t"] == pytest.approx([quarter], abs=10.0 * tolerance * quarter)
    assert run.u[-1, 1] == pytest.approx(rate * DRAWN, rel=10.0 * tolerance)
    travelled = DRAWN + rate * DRAWN * (run.simulated - quarter)
    assert run.q[-1, 1] - run.q[0, 1] == pytest.approx(travelled, rel=10.0 * tolerance)


@pytest.mark.parametrize("turn", [0.0, 1.3, 0.16 * 26])  # the last was one of 360 starts in which no time went on
def test_a_row_parts_at_rest(turn: float) -> None:
    """The middle one of three has no spring: what it passes on has the rounding of the force that the spring loses."""
    place = 1e-3 / 3.0
    wedge = polygon((-0.004, -0.004), (0.004, 0.0), (-0.004, 0.004))
    blocks = tuple(
        Body(name, "slide", (0.008 * i - DRAWN + place, 0.0), velocity=(0.0,), mass=PUSHED, loops=(wedge,))
        for i, name in enumerate("abc")
    )
    contacts = tuple(Contact((Side(one), Side(other)), 0.0, 0.0) for one, other in ("ab", "bc"))
    scene = Scene("row", blocks, springs=(Spring("a", STIFFNESS, DRAWN),), contacts=contacts, duration=0.15)
    run = simulate(turned(scene, turn))
    assert not run.stop.gave_up
    rate = math.sqrt(STIFFNESS / (3.0 * PUSHED))
    assert run.u[-1, 1:] == pytest.approx([rate * DRAWN] * 2, rel=1e-8)
    after = run.simulated - 0.5 * math.pi / rate
    assert run.q[-1, 1:] - run.q[0, 1:] == pytest.approx([DRAWN + rate * DRAWN * after] * 2, rel=1e-8)


# Does what starts in exact contact at rest stay there, without an impact nobody asked for?

R, S = 0.02, 0.05


def disc(name: str, x: float, y: float) -> Body:
    return Body(name, "free", (x, y), mass=0.1, inertia=0.05 * R**2, loops=(circle(R),))


def block(name: str, y: float) -> Body:
    return Body(name, "free", (0.0, y), mass=0.1, inertia=1e-4, loops=(box(2.0 * S, 2.0 * S),))


SCENES = {
    1: ((disc("a", 0.0, R), ground()), (("a", "ground"),)),
    2: ((block("a", S), ground()), (("a", "ground"),)),
    3: ((block("a", S), disc("b", S + R, R), ground()), (("a", "ground"), ("b", "ground"))),
    4: ((block("a", S), block("b", 3.0 * S), ground()), (("a", "ground"), ("b", "a"))),
    5: ((block("a", S), block("b", 3.0 * S), disc("c", 0.0, 4.0 * S + R), ground()), (("a", "ground"), ("b", "a"), ("c", "b"))),
    6: ((block("a", S), block("b", 3.0 * S), block("c", 5.0 * S), ground()), (("a", "ground"), ("b", "a"), ("c", "b"))),
}


def started(count: int, friction: float, restitution: float, slope: float = 0.0) -> Trajectory:
    bodies, pairs = SCENES[count]
    contacts = tuple(Contact((Side(first), Side(last)), friction, restitution) for first, last in pairs)
    return simulate(Scene("start", bodies, contacts=contacts, gravity=on_slope(slope), duration=1.0))


@pytest.mark.parametrize("count", SCENES)
@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_no_artificial_impact(count: int, restitution: float, friction: float) -> None:
    run = started(count, friction, restitution)
    assert run.simulated == 1.0
    assert not np.any(run.events["kind"] == EventKind.IMPACT)
    assert np.any(run.events["kind"] == EventKind.CLOSE)
    # What rounding leaves of the balance of forces acts for a second on what nothing holds.
    assert run.q[-1] == pytest.approx(run.q[0], abs=1e-10)
    assert run.u[-1] == pytest.approx(np.zeros(run.u.shape[1]), abs=1e-10)


@pytest.mark.parametrize("count", [2, 4, 6])
def test_a_stack_on_a_slope_slides_as_one(count: int) -> None:
    """With little friction at the ground only, g (sin a - mu cos a) for all; between the blocks it sticks."""
    slope, mu = 0.2, 0.1
    bodies, pairs = SCENES[count]
    contacts = tuple(Contact((Side(first), Side(last)), mu if last == "ground" else 0.5, 0.0) for first, last in pairs)
    run = simulate(Scene("start", bodies, contacts=contacts, gravity=on_slope(slope), duration=0.5))
    way = 0.5 * 9.81 * (math.sin(slope) - mu * math.cos(slope)) * 0.5**2
    assert not np.any(run.events["kind"] == EventKind.IMPACT)
    assert run.q[-1, ::3] == pytest.approx(np.full(count // 2, way), rel=1e-9)
    assert run.q[-1, 2::3] == pytest.approx(np.zeros(count // 2), abs=1e-10)
