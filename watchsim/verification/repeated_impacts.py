"""Which motions of many impacts, and of friction that comes and goes, have an exact answer?

Each is a small scene that other codes fail on, with numbers that follow from the law by hand; the derivation stands beside it.
"""

from __future__ import annotations

import math

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line
from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.state import EventKind
from watchsim.verification.benchmarks import Benchmark, Check, Measure, count_of, soundness, time_of, value_of
from watchsim.verification.checks import box, circle, ground

GRAVITY = 9.81
FORCES = 1e-9  # a contact is kept until its forces fail by more than their rounding, `Options.force_zero`
SPEEDS = 1e-9  # m/s; slower is zero in scenes of these sizes, `Options.speed_zero`


def repeated_impacts() -> list[Benchmark]:
    """All of them."""
    return [pulled_block(), rocking_block(), cradle(0.0), cradle(1e-9), groove()]


def pulled_block(cycles: int = 40) -> Benchmark:
    """A block on a moving belt, held by a spring: stick-slip.

    Seen from the belt: the block rests on it, and the far end of the spring travels with the belt's speed v. The block
    sticks until the spring carries the friction, at t0 = mu N / (k v); then, with s = t - t0 and w = sqrt(k/m),
    x = v (s - sin(w s) / w), x' = v (1 - cos(w s)): it slips by v T in each period T = 2 pi / w and has the belt's speed
    once in it, without staying there, since Coulomb's friction of rest equals that of motion. The spring's stretch swings
    with the amplitude v / w about mu N / k.
    """
    mass, stiffness, speed, friction, press = 2e-3, 50.0, 0.03, 0.4, 0.05
    w, start = math.sqrt(stiffness / mass), friction * press / (stiffness * speed)
    period = 2.0 * math.pi / w
    end = start + cycles * period
    ramp = ((0.0, 0.0), (2.0 * end, stiffness * speed * 2.0 * end))
    block = Body("block", "slide", mass=mass, loops=(Loop((Line(0.01, 0.0, -0.06, 0.0),), closed=False),))
    tip = Loop((Arc(0.0, 1e-3, 1e-3, 0.0, TURN),))
    pad = Body("pad", "slide", mass=1e-3, axis=(0.0, 1.0), loops=(tip,))
    scene = Scene(
        "block on a moving belt",
        (block, pad),
        springs=(Spring("block", stiffness),),
        torques=(Torque("block", over="time", table=ramp), Torque("pad", -press)),
        contacts=(Contact((Side("pad"), Side("block")), friction),),
        duration=end,
        tolerance=1e-12,
    )
    middle = start + (cycles - 0.5) * period
    checks = (
        Check("slipping begins [s]", start, time_of(EventKind.SLIDE, 1), FORCES),
        Check(f"way after {cycles} periods [m]", speed * cycles * period, lambda run: float(run.q[-1, 0])),
        Check("speed then [m/s]", 0.0, lambda run: float(run.u[-1, 0]), SPEEDS),
        Check("fastest slip [m/s]", 2.0 * speed, lambda run: float(run.at(middle)[1][0])),
        Check(
            "stretch of the spring half a period later [m]",
            speed * (start + 0.25 * period) - _slipped(speed, w, 0.25 * period),
            lambda run: speed * (start + 0.25 * period) - float(run.at(start + 0.25 * period)[0][0]),
        ),
    )
    source = "m x'' = k (v t - x) - mu N by hand, watchsim/verification/repeated_impacts.py"
    return Benchmark("block on a moving belt (stick-slip)", scene, (*checks, *soundness()), source)


def _slipped(speed: float, w: float, s: float) -> float:
    return speed * (s - math.sin(w * s) / w)


def rocking_block(impacts: int = 7000) -> Benchmark:
    """A slender block rocks from corner to corner until it stands: each change of corner costs the same share of its spin.

    All the impulse acts at the corner that lands, the other one lifts off: it needs none, since it leaves upwards. Angular
    momentum about the landing corner is kept: (J + m R²) w+ = (J + m R² - 2 m b²) w-, for a rectangle w+/w- = 1 - 3/2 sin²a
    with tan a = b/h (Housner 1963). That is the law's answer with restitution 0 and friction enough to hold the corner.
    Between impacts energy is kept, so the n-th impact finds the spin w0 r^(n-1). They accumulate: the block stands in the end.
    """
    half_width, half_height, mass = 0.5e-3, 20e-3, 0.01
    inertia = mass * (half_width**2 + half_height**2) / 3.0
    sine = half_width / math.hypot(half_width, half_height)
    ratio = 1.0 - 1.5 * sine * sine
    spin = 0.25
    block = Body(
        "block",
        "free",
        position=(0.0, half_height),
        # Turning about its right corner, counter-clockwise would be about the left one.
        velocity=(spin * half_height, spin * half_width, -spin),
        mass=mass,
        inertia=inertia,
        loops=(box(half_width, half_height),),
    )
    scene = Scene(
        "rocking block",
        (block, ground(1.0)),
        contacts=(Contact((Side("block"), Side("ground")), friction=1.0),),
        gravity=(0.0, -GRAVITY),
        duration=1.05 * rocking_time(half_width, half_height, spin, ratio),
        tolerance=1e-13,
    )

    def after(number: int, tolerance: float) -> Check:
        """The landing corner's approach is 2 b w-. The integrator's error is one of the angle, which dies out too."""
        return Check(
            f"approach of the corner at impact {number} [m/s]",
            -2.0 * half_width * spin * ratio ** (number - 1),
            value_of(EventKind.IMPACT, number),
            tolerance,
        )

    checks = (
        *(after(*check) for check in ((1, 1e-9), (10, 1e-8), (100, 1e-8), (1000, 1e-6), (3000, 1e-4), (impacts, 1e-3))),
        Check("fastest coordinate at the end [m/s, rad/s]", 0.0, lambda run: float(abs(run.u[-1]).max()), 0.0),
        Check("tilt at the end [rad]", 0.0, lambda run: float(run.q[-1, 2]), 1e-12),
    )
    source = "Housner, Bull. Seismol. Soc. Am. 53 (1963) 403; from Poisson's law with restitution 0 in repeated_impacts.py"
    return Benchmark("rocking block, thousands of impacts", scene, (*checks, *soundness(1e-6)), source)


def rocking_time(half_width: float, half_height: float, spin: float, ratio: float) -> float:
    """Time until the block stands, s: for a slender block sin(a - angle) is a - angle to the third order.

    Half a rock that begins with spin w takes (2/p) artanh(w / (a p)) with p² = 3 g / (4 R).
    """
    radius, tilt = math.hypot(half_width, half_height), math.atan2(half_width, half_height)
    p = math.sqrt(0.75 * GRAVITY / radius)
    total, rock = 0.0, math.inf
    while total + rock > total:
        rock = 2.0 / p * math.atanh(spin / (tilt * p))
        total += rock
        spin *= ratio
    return total


def cradle(split: float) -> Benchmark:
    """Newton's cradle: one ball with speed 1 meets four at rest, restitution 1.

    Touching (split 0), all contacts share one impact: compression ends with all at 1/5, by impulses 4/5, 3/5, 2/5, 1/5, which
    expansion gives back once more: -3/5 and four times +2/5. Momentum and energy are kept. With gaps between the balls,
    however small, the impacts follow each other, and the last ball takes all. Both are the law's answers; a rigid model does
    not say which a cradle of steel follows.
    """
    count, radius, mass = 5, 5e-3, 0.05
    places = [i * (2.0 * radius + split) for i in range(count)]
    places[0] -= 1e-3
    disc = circle(radius)
    balls = tuple(
        Body(f"ball{i}", "slide", position=(x, 0.0), velocity=(1.0 if i == 0 else 0.0,), mass=mass, loops=(disc,))
        for i, x in enumerate(places)
    )
    contacts = tuple(Contact((Side(f"ball{i}"), Side(f"ball{i + 1}")), restitution=1.0) for i in range(count - 1))
    scene = Scene("cradle", balls, contacts=contacts, duration=2e-3, tolerance=1e-10)
    wanted = (-0.6, 0.4, 0.4, 0.4, 0.4) if split == 0.0 else (0.0, 0.0, 0.0, 0.0, 1.0)
    checks = tuple(Check(f"speed of ball {i + 1} [m/s]", v, _last_speed(i), 1e-12) for i, v in enumerate(wanted))
    name = "Newton's cradle, touching" if split == 0.0 else f"Newton's cradle, gaps of {1e9 * split:g} nm"
    impacts = Check("impulses", 4.0, count_of(EventKind.IMPACT), 0.0)
    kept = Check("energy residual [J]", 0.0, lambda run: float(run.energy["residual_J"]), 1e-15)
    return Benchmark(name, scene, (*checks, impacts, kept), "Poisson's law by hand, watchsim/verification/repeated_impacts.py")


def _last_speed(column: int) -> Measure:
    return lambda run: float(run.u[-1, column])


def groove() -> Benchmark:
    """A disc falls into a symmetric groove: both flanks at every impact, and infinitely many impacts in a finite time.

    By symmetry the disc moves upright like a ball on a floor: falling from h, it touches at t1 = sqrt(2 h / g) and has done
    bouncing at t1 (1 + e) / (1 - e); from then on it rests at the bottom, at r / sin(half angle) above the groove's root.
    """
    radius, drop, restitution, half = 4e-3, 2e-3, 0.6, math.radians(40.0)
    bottom = radius / math.sin(half)
    far = 20.0 * radius
    x, y = far * math.sin(half), far * math.cos(half)
    flanks = (Line(x, y, 0.0, 0.0), Line(0.0, 0.0, -x, y))
    disc = Body(
        "disc", "free", position=(0.0, bottom + drop), mass=0.01, inertia=0.5 * 0.01 * radius**2, loops=(circle(radius),)
    )
    scene = Scene(
        "disc in a groove",
        (disc, Body("groove", "fixed", loops=(Loop(flanks, closed=False),))),
        contacts=(Contact((Side("disc"), Side("groove")), restitution=restitution),),
        gravity=(0.0, -GRAVITY),
        duration=0.2,
        tolerance=1e-10,
    )
    first = math.sqrt(2.0 * drop / GRAVITY)
    # The k-th rebound lasts 2 t1 e^k; the rule ends the bouncing where less than a microsecond is left.
    most = 2.0 * (2.0 + math.log(1e-6 * (1.0 - restitution) / (2.0 * first)) / math.log(restitution))
    checks = (
        Check("first touch [s]", first, time_of(EventKind.IMPACT, 1)),
        Check(
            "end of the bouncing [s]", first * (1.0 + restitution) / (1.0 - restitution), value_of(EventKind.ACCUMULATION, 1)
        ),
        Check("height at the end [m]", bottom, lambda run: float(run.q[-1, 1])),
        Check("sideways at the end [m]", 0.0, lambda run: float(run.q[-1, 0]), 1e-12),
        Check("impulses beyond the most there may be", 0.0, lambda run: max(0.0, count_of(EventKind.IMPACT)(run) - most), 0.0),
    )
    return Benchmark(
        "disc in a groove, two contacts at once", scene, (*checks, *soundness()), "geometric series, repeated_impacts.py"
    )
