"""Which hard cases of contact have exact solutions, and what are they?

Each is small enough that its answer follows from momentum, energy or statics alone; the derivation stands with it.
"""

from __future__ import annotations

import math

import numpy as np

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.forces import Contact, Damping, Side, Spring, Torque
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory
from watchsim.verification.benchmarks import Benchmark, Check, Measure, coordinate, count_of, rate, time_of, value_of
from watchsim.verification.checks import box, circle, ground, polygon, shaped

GRAVITY = 9.81
EXTENT = 4e-11  # m: `Options.extent` of outlines as large as the tooth
NANOMETRES = (1.0, 0.1, 0.01, 0.001, -0.001, -0.01, -0.1, -1.0)


def edge_cases() -> list[Benchmark]:
    """Grazes and corners from +1 nm to -1 nm, and starts in exact contact on one to six contacts."""
    return [*(graze(nm) for nm in NANOMETRES), *(corner(nm) for nm in (0.0, *NANOMETRES)), *(standing(k) for k in range(1, 7))]


def graze(nanometres: float) -> Benchmark:
    """A pin flies past a round post; at its nearest the gap would be so much.

    Where it is negative, -s, they touch a time sqrt(2 R s)/v before the middle (s far below R, the distance of the centres),
    and approach with v sqrt(2 s/R), which the impact takes away. The gap is the difference of lengths of 2 mm, whose rounding
    counts where s is a picometre.
    """
    speed, radius, pin = 0.1, 1e-3, 5e-4
    clearance, reach = 1e-9 * nanometres, radius + pin
    body = Body("pin", "free", (-2e-3, reach + clearance), velocity=(speed, 0.0, 0.0), mass=1e-3, inertia=1e-10)
    post = Body("post", "fixed", loops=(circle(radius),))
    scene = Scene("graze", (shaped(body, circle(pin)), post), contacts=(Contact((Side("pin"), Side("post"))),), duration=0.04)
    touches = nanometres < 0.0
    checks = [Check("impacts", float(touches), count_of(EventKind.IMPACT), 0.0)]
    if touches:
        approach = -speed * math.sqrt(-2.0 * clearance / reach)
        checks.append(Check("approach [m/s]", approach, value_of(EventKind.IMPACT, 1), 1e-3))
        when = 0.02 - math.sqrt(-2.0 * reach * clearance) / speed
        checks.append(Check("time of the touch [s]", when, time_of(EventKind.IMPACT, 1), 1e-7))
    else:
        checks.append(Check("height at the end [m]", reach + clearance, lambda run: float(run.q[-1, 1]), 0.0))
    checks.append(Check("nearest to the post, below touching [m]", 0.0, lambda run: max(0.0, reach - _nearest(run)), 1e-15))
    return Benchmark(f"graze, gap {nanometres:+g} nm", scene, tuple(checks), "two circles and a straight line")


def _nearest(run: Trajectory) -> float:
    return float(np.hypot(run.q[:, 0], run.q[:, 1]).min())


def corner(nanometres: float) -> Benchmark:
    """A tooth slides diagonally at the corner of a block, so far to its right: it meets one neighbour.

    It misses the other one by as much and stops so far beyond the corner's place, unless it is nearer to it than contacts reach
    beyond the ends of their primitives (`Options.extent`): then the first of the two may count.
    """
    aside, start, c = 1e-9 * nanometres, 1e-3, math.sqrt(0.5)
    place = (start + c * aside, start - c * aside)
    tooth = Body("tooth", "slide", place, axis=(-c, -c), velocity=(0.05,), mass=1e-4)
    shape = polygon((0.0, 0.0), (4e-4, 2e-4), (4e-4, 6e-4), (2e-4, 4e-4))
    block = Body("block", "fixed", loops=(polygon((-2e-3, -2e-3), (0.0, -2e-3), (0.0, 0.0), (-2e-3, 0.0)),))
    scene = Scene("corner", (shaped(tooth, shape), block), contacts=(Contact((Side("tooth"), Side("block"))),), duration=0.05)
    way = math.sqrt(2.0) * start + abs(aside)
    allowed = 1e-15 + 3.0 * min(abs(aside), EXTENT)
    checks = (
        Check("faces met", 1.0, _faces, 0.0),
        Check("way until it stops [m]", way, lambda run: float(run.q[-1, 0]), allowed / way),
        Check("speed left [m/s]", 0.0, lambda run: float(run.u[-1, 0]), 1e-12),
    )
    return Benchmark(f"tooth at a corner, {nanometres:+g} nm aside", scene, checks, "geometry of the corner")


def _faces(run: Trajectory) -> float:
    """Number of different edges of the block with an impact."""
    found = run.events[run.events["kind"] == EventKind.IMPACT]
    return float(len({(run.pairs[k].primitive_b, run.pairs[k].index_b) for k in found["contact"]}))


def standing(count: int) -> Benchmark:
    """Blocks and discs at rest on one another and on the ground with exactly that many contacts: nothing happens."""
    side, radius = 0.05, 0.02

    def block(name: str, layer: int) -> Body:
        body = Body(name, "free", (0.0, (2 * layer + 1) * side), mass=0.1, inertia=1e-4)
        return shaped(body, box((1.0 - 0.2 * layer) * side, side))

    def disc(name: str, x: float, y: float) -> Body:
        return shaped(Body(name, "free", (x, y), mass=0.1, inertia=0.05 * radius**2), circle(radius))

    blocks = [block(f"block{layer}", layer) for layer in range(count // 2)]
    pairs = [(one.name, blocks[k - 1].name if k else "ground") for k, one in enumerate(blocks)]
    bodies = list(blocks)
    if count % 2:
        bodies.append(disc("disc", side + 2.0 * radius, radius))
        pairs.append(("disc", "ground"))
    contacts = tuple(Contact((Side(one), Side(other)), 0.4, 0.5) for one, other in pairs)
    scene = Scene("standing", (*bodies, ground()), contacts=contacts, gravity=(0.0, -GRAVITY), duration=1.0)
    checks = (
        Check("impacts", 0.0, count_of(EventKind.IMPACT), 0.0),
        Check("contacts found", float(count), count_of(EventKind.CLOSE), 0.0),
        Check("largest way in a second [m]", 0.0, lambda run: float(np.abs(run.q[-1] - run.q[0]).max()), 1e-12),
    )
    return Benchmark(f"start at rest on {count} contacts", scene, checks, "statics")


EXACT = 1e-10
NEAR = 1e-3  # how far from a limit the two cases beside it lie, as a share or in radians


def hard_cases() -> list[Benchmark]:
    """Superball, dry friction in a bearing, a block at its friction angle, Painlevé's rod, a pin on a roller, a wedge."""
    return [superball(), dry_balance(), *friction_angle(), *painleve_rods(), *pins_on_rollers(), *wedges()]


def superball(radius: float = 0.02, drop: float = 0.1, speed: float = 0.4, spin: float = 30.0) -> Benchmark:
    """A disc bounces with restitution 1, normal and tangential: at each touch its slip changes sign and nothing else is lost.

    Slip s = v + R w; the impulse -2 m s k/(1+k), k = J/(m R²), reverses it. Two touches give the first velocities again.
    """
    kappa = 0.5
    disc = Body("disc", "free", (0.0, radius + drop), velocity=(speed, 0.0, spin), mass=1.0, inertia=kappa * radius**2)
    disc = shaped(disc, circle(radius))
    contact = Contact((Side("disc"), Side("ground")), 1.0, 1.0, 1.0)
    scene = Scene(
        "superball", (disc, ground()), contacts=(contact,), gravity=(0.0, -GRAVITY), duration=1.2, tangential_law="pg1996"
    )
    push = -2.0 * (speed + radius * spin) * kappa / (1.0 + kappa)
    speeds, spins = (speed, speed + push), (spin, spin + push / (kappa * radius))
    fall = math.sqrt(2.0 * drop / GRAVITY)
    checks = []
    for touches in (1, 2, 3):
        t = 2.0 * touches * fall  # at the top of the following bounce
        travel = fall * (speeds[0] + sum(2.0 * speeds[k % 2] for k in range(1, touches)) + speeds[touches % 2])
        checks += [
            Check(f"spin after touch {touches} [rad/s]", spins[touches % 2], rate(2, t), EXACT),
            Check(f"speed after touch {touches} [m/s]", speeds[touches % 2], rate(0, t), EXACT),
            Check(f"x at the top after touch {touches} [m]", travel, coordinate(0, t), 1e-9),
        ]
    energy = 0.5 * (speed**2 + kappa * (radius * spin) ** 2) + GRAVITY * drop
    checks.append(Check("share of the energy lost", 0.0, lambda run: run.energy["dissipated"]["impacts"] / energy, 1e-12))
    return Benchmark("superball", scene, tuple(checks), "momentum and energy; derived in verification/hard_cases.py")


def dry_balance(friction: float = 2e-7, stiffness: float = 7.58e-7, angle: float = 4.7) -> Benchmark:
    """A balance with nothing but dry friction T in its bearings.

    Each half swing takes the undamped half period and 2 T/k of amplitude; the first turning point within T/k of rest is
    its last.
    """
    inertia = 1.2e-9
    half = math.pi * math.sqrt(inertia / stiffness)
    lost = 2.0 * friction / stiffness
    swings = math.ceil((angle - 0.5 * lost) / lost)
    balance = Body("balance", angle=angle, inertia=inertia)
    scene = Scene(
        "dry balance",
        (balance,),
        springs=(Spring("balance", stiffness),),
        damping=(Damping("balance", coulomb=friction),),
        duration=(swings + 2) * half,
    )
    final = (-1.0) ** swings * (angle - swings * lost)
    spent = 0.5 * stiffness * (angle**2 - final**2)
    checks = (
        Check("third turning point [s]", 3.0 * half, time_of(EventKind.TURN, 3), EXACT),
        Check("angle there [rad]", -(angle - 3.0 * lost), value_of(EventKind.TURN, 3), EXACT),
        Check("turning points but the last", float(swings - 1), count_of(EventKind.TURN), 0.0),
        Check("angle at which it stays [rad]", final, lambda run: float(run.q[-1, 0]), EXACT),
        Check("rate there [rad/s]", 0.0, lambda run: float(run.u[-1, 0]), 0.0),
        Check("energy taken by the bearings [J]", spent, lambda run: run.energy["dissipated"]["damping"], EXACT),
    )
    return Benchmark("balance with dry friction in its bearings", scene, checks, "textbook: linear decay 2 T/k per half swing")


def friction_angle(slope: float = 0.3, side: float = 0.1) -> list[Benchmark]:
    """A block on an incline with friction just above, at and just below tan(slope): it stays for 1000 s, or slides."""
    loop = polygon((-side, -side), (side, -side), (side, side), (-side, side))
    gravity = (GRAVITY * math.sin(slope), -GRAVITY * math.cos(slope))
    cases = []
    for word, share in (("above", 1.0 + 1e-6), ("at", 1.0), ("below", 1.0 - 1e-6)):
        mu = share * math.tan(slope)
        block = shaped(Body("block", "free", (0.0, side), mass=1.0, inertia=2.0 / 3.0 * side**2), loop)
        contact = Contact((Side("block"), Side("ground")), mu)
        scene = Scene("block", (block, ground()), contacts=(contact,), gravity=gravity, duration=1000.0)
        pull = GRAVITY * math.cos(slope) * math.tan(slope) * 1e-6 if word == "below" else 0.0
        t = scene.duration if word != "below" else 100.0
        # The difference of two accelerations a million times larger than it is.
        checks = [Check(f"way down at {t:g} s [m]", 0.5 * pull * t**2, coordinate(0, t), 1e-8)]
        checks.append(Check(f"height at {t:g} s [m]", side, coordinate(1, t), EXACT))
        checks.append(Check(f"tilt at {t:g} s [rad]", 0.0, coordinate(2, t), EXACT))
        checks.append(Check("impacts", 0.0, count_of(EventKind.IMPACT), 0.0))
        cases.append(Benchmark(f"block on an incline, friction {word} the limit", scene, tuple(checks), "statics, g"))
    return cases


def painleve_rods(half: float = 0.1, friction: float = 1.6, speed: float = 2.0) -> list[Benchmark]:
    """A uniform rod slides on its tip, leaning at the angle th. With friction above 4/3 some angles know no finite force.

    G_N - mu G_c = (1 + 3 cos² th - 3 mu sin th cos th)/m is negative between tan th = (3 mu ± sqrt(9 mu² - 16))/2. There the
    tip jams: it stops at once, and the rod's moment of momentum about it, m v l sin th, becomes the spin (3/4) (v/l) sin th.
    """
    root = math.sqrt(9.0 * friction**2 - 16.0)
    low, high = (math.atan(0.5 * (3.0 * friction + sign * root)) for sign in (-1.0, 1.0))
    cases = []
    limits = (("below the lower", low - NEAR), ("above the lower", low + NEAR))
    for word, angle in (*limits, ("below the upper", high - NEAR), ("above the upper", high + NEAR)):
        jams = low < angle < high
        spin = 0.75 * speed / half * math.sin(angle) if jams else 0.0
        checks = [
            Check("jams at the start", float(jams), count_of(EventKind.JAM, 0.0), 0.0),
            Check("spin right after the start [rad/s]", spin, rate(2, 0.0), EXACT),
            Check("speed of the tip right after it [m/s]", 0.0 if jams else -speed, _tip_speed(half), EXACT),
        ]
        cases.append(
            Benchmark(
                f"rod, friction {friction:g}, angle {word} limit of jamming",
                _rod(half, friction, speed, angle),
                tuple(checks),
                "Painlevé 1895; moment of momentum about the tip",
            )
        )
    return cases


def _rod(half: float, friction: float, speed: float, angle: float) -> Scene:
    """The tip slides towards -x with the rod's middle to its right; a needle with the mass of a uniform rod."""
    loop = polygon((-half, 0.0), (half, -0.01 * half), (half, 0.01 * half))
    rod = Body("rod", "free", (0.0, half * math.sin(angle)), angle, (-speed, 0.0, 0.0), mass=1.0, inertia=half**2 / 3.0)
    contact = Contact((Side("rod"), Side("ground")), friction)
    return Scene("rod", (shaped(rod, loop), ground()), contacts=(contact,), gravity=(0.0, -GRAVITY), duration=1e-4)


def _tip_speed(half: float) -> Measure:
    def measure(run: Trajectory) -> float:
        q, u = run.at(0.0)
        return float(u[0] + half * math.sin(q[2]) * u[2])

    return measure


def pins_on_rollers(friction: float = 0.2, radius: float = 2e-3, arm: float = 3e-3) -> list[Benchmark]:
    """A pin of an arm rests on a turning roller, the normal passing the arm's own pivot at the angle d off the arm.

    The roller's pull turns the arm into it or out of it: with tan d < mu no finite force keeps them apart and both stop at
    once. Otherwise the torque M on the arm gives the force M/(arm (sin d - mu cos d)), and friction slows the roller evenly.
    """
    limit, press, spin = math.atan(friction), 1e-6, 20.0
    inertia = 1e-10
    cases = []
    for word, angle in (("below", limit - NEAR), ("above", limit + 0.1)):
        pin = shaped(
            Body("arm", "pivot", (radius + arm * math.cos(angle), arm * math.sin(angle)), angle, inertia=2e-11),
            polygon((-arm, 0.0), (-0.5 * arm, -0.02 * arm), (-0.5 * arm, 0.02 * arm)),
        )
        roller = shaped(Body("roller", velocity=(spin,), inertia=inertia), circle(radius))
        jams = angle < limit
        force = 0.0 if jams else press / (arm * (math.sin(angle) - friction * math.cos(angle)))
        t = 1e-3
        scene = Scene(
            "pin on a roller",
            (roller, pin),
            torques=(Torque("arm", -press),),
            contacts=(Contact((Side("arm"), Side("roller")), friction),),
            duration=t,
        )
        left = 0.0 if jams else spin - friction * force * radius / inertia * t
        checks = (
            Check("jams", float(jams), count_of(EventKind.JAM), 0.0),
            Check(f"spin of the roller at {t:g} s [rad/s]", left, rate(0, t), EXACT),
            Check("rate of the arm [rad/s]", 0.0, rate(1, t), EXACT),
        )
        name = f"pin on a roller, {word} the limit of jamming"
        cases.append(Benchmark(name, scene, checks, "moments about both pivots; derived in verification/hard_cases.py"))
    return cases


def wedges(half_angle: float = 0.2, size: float = 0.05, speed: float = 1.0, restitution: float = 0.5) -> list[Benchmark]:
    """A wedge is driven into a slot of its own angle. With friction above tan(angle) it stays, below it comes out again.

    At the end of the compression it stands still on four contacts. The share of their impulses that the expansion returns
    pushes it out with eps_N N (sin a - mu cos a) for each, so it leaves if and only if mu < tan a; its speed is at most
    eps_N times that it came with.
    """
    s, c = math.sin(half_angle), math.cos(half_angle)
    width = size * s / c
    top, depth = (width * 1.5, 0.5 * size), -0.5 * size
    loop = polygon((-0.5 * width, depth), (0.5 * width, depth), top, (-top[0], top[1]))
    reach = 10.0 * size
    # The walls go through the wedge's sides; material outside.
    right = (0.5 * width - 2.0 * size * s, depth - 2.0 * size * c), (0.5 * width + reach * s, depth + reach * c)
    walls = (
        Loop((Line(*right[1], *right[0]),), "RIGHT", closed=False),
        Loop((Line(-right[0][0], right[0][1], -right[1][0], right[1][1]),), "LEFT", closed=False),
    )
    cases = []
    for word, share in (("above", 1.0 + NEAR), ("below", 0.5)):
        wedge = shaped(Body("wedge", "free", velocity=(0.0, -speed, 0.0), mass=0.1, inertia=1e-4), loop)
        contact = Contact((Side("wedge"), Side("slot")), share * math.tan(half_angle), restitution)
        slot = Body("slot", "fixed", loops=walls)
        scene = Scene("wedge", (wedge, slot), contacts=(contact,), duration=1e-3)
        out = 1.0 if share < 1.0 else 0.0
        checks = [
            Check("comes out", out, lambda run: float(1e-9 < run.u[-1, 1] <= restitution * speed), 0.0),
            Check("energy gains", 0.0, lambda run: float(abs(run.u[-1, 1]) > speed), 0.0),
            Check("speed sideways [m/s]", 0.0, lambda run: float(run.u[-1, 0]), 1e-12),
        ]
        if not out:
            checks.append(Check("speed left [m/s]", 0.0, lambda run: float(run.u[-1, 1]), 1e-12))
        name = f"wedge in a slot, friction {word} the limit"
        cases.append(Benchmark(name, scene, tuple(checks), "statics of the friction cone"))
    return cases
