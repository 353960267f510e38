"""How are the places, springs, drives, damping and contacts of a scene described to people, in the units they choose?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.mechanism.coiled import coil_lines
from watchsim.model import DAMPING_LAWS
from watchsim.scene.forces import Damping, LineSpring, Mainspring, Spring
from watchsim.scene.keys import DAMPING
from watchsim.scene.roles import Oscillator, keeps_time, loads, oscillator, oscillators
from watchsim.scene.scene import Body, Scene
from watchsim.scene.trains import at_start
from watchsim.units import metric, show, to

# How are gears described to people?


def gear_lines(scene: Scene) -> Iterator[str]:
    """A line for each body geared to another, for what they all weigh there, and for each pair of gears with play."""
    held = dict.fromkeys(body.geared.to for body in scene.bodies if body.geared is not None)
    for body in scene.bodies:
        if body.geared is not None:
            ratio = ratio_words(scene, body.geared.to, body.name, body.geared.ratio)
            yield f"  {body.name} is geared to {body.geared.to}: {ratio} of it"
    for body, mass in zip(scene.bodies, loads(scene.bodies)[2], strict=True):
        if body.name in held and body.prescribed is None:
            text = show(mass, "mg·cm²", 5) if body.motion == "pivot" else show(mass, "g", 5)
            yield f"  felt at {body.name} with all that is geared to it: {text}"
    for gear in scene.gears:
        first, second = gear.between
        turns = scene.body(second).motion == "pivot"
        play = f"{math.degrees(gear.backlash):.6g}°" if turns else metric(gear.backlash, "m")
        text = f"play {play}, restitution {gear.restitution:g}, efficiency {100.0 * gear.efficiency:g} %"
        yield f"  gears {first} - {second}: {ratio_words(scene, first, second, gear.ratio)}, {text}"


def ratio_words(scene: Scene, first: str, second: str, ratio: float) -> str:
    """How far the second goes for one turn, or one millimetre, of the first."""
    turns, other_turns = scene.body(first).motion == "pivot", scene.body(second).motion == "pivot"
    one = "turn" if turns else "mm"
    if turns == other_turns:
        return f"{ratio:.6g} {'turns' if turns else 'mm'} for one {one}"
    if turns:
        return f"{show(ratio * math.tau, 'mm')} for one turn"
    return f"{ratio * 1e-3 / math.tau:.6g} turns for one mm"


NANOMETRES = 6  # decimals of a millimetre: rounding of a position does not look like a place
SMALL = 0.1e-3  # m: less is not given in millimetres


def force_lines(scene: Scene) -> Iterator[str]:
    """A line for each centre distance, gear, spring, drive, damper and contact, and for what swings by its weight."""
    yield from _distance_lines(scene)
    yield from gear_lines(scene)
    yield from _force_lines(scene)
    yield from _contact_lines(scene)


def place(value: float) -> str:
    """A coordinate, to the nanometre: "7.131281 mm"."""
    return f"{round(to(value, 'mm'), NANOMETRES) + 0.0:.{NANOMETRES}f}".rstrip("0").rstrip(".") + " mm"


def length(value: float) -> str:
    """A small or large distance: "12.5 mm", "3.71 nm"."""
    return show(value, "mm", 4) if SMALL <= abs(value) < 1.0 else metric(value, "m", 4)


def turned(value: float) -> str:
    """An angle in degrees, without the digits of rounding."""
    return f"{round(math.degrees(value), 9) + 0.0:.6g}°"


def _distance_lines(scene: Scene) -> Iterator[str]:
    """Between the pivots of bodies that are declared to touch."""
    seen, start = set(), at_start(scene)
    for contact in scene.contacts:
        names = tuple(dict.fromkeys(side.body for side in contact.sides))
        first, second = (start.body(name) for name in names)
        if frozenset(names) not in seen and first.motion == second.motion == "pivot":
            seen.add(frozenset(names))
            yield f"  centre distance {names[0]} - {names[1]}: {place(math.dist(first.position, second.position))}"


def _force_lines(scene: Scene) -> Iterator[str]:
    for spring in scene.springs:
        yield f"  spring on {_ends(spring.body, spring.against)}: {_spring(scene, spring)}"
        if spring.wound is not None:
            yield from coil_lines(spring)
    yield from map(_line_spring, scene.line_springs)
    yield from (_swing(scene, one) for one in oscillators(scene) if one.weight)
    for torque in scene.torques:
        unit = "N" if scene.body(torque.body).motion == "slide" else "N·m"
        text = metric(torque.value, unit) if not torque.table else f"{len(torque.table)} values over {torque.over}"
        if torque.period is not None:
            text = f"{len(torque.table) - 1} values over time, again after {metric(torque.period, 's')}"
        if torque.mainspring is not None:
            text = f"{metric(torque.value, unit)}, {_mainspring(torque.mainspring)}"
        yield f"  drive on {_ends(torque.body, torque.against)}: {text}"
    for damping in scene.damping:
        yield f"  damping on {_ends(damping.body, damping.against)}: {_damping(scene, damping)}"
    masses = {body.name: load.mass for body, load in zip(scene.bodies, loads(scene.bodies)[1], strict=True)}
    for bearing in scene.bearings:
        friction = metric(bearing.torque(masses[bearing.body], scene.gravity), "N·m", 4)
        radii = f"radius {metric(bearing.radius, 'm')}" + (f", flat {metric(bearing.flat, 'm')}" if bearing.flat else "")
        radii += f", play {metric(bearing.play, 'm')}" if bearing.play else ""
        yield f"  bearing of {bearing.body}: {radii}, friction {bearing.friction:g}, dry friction {friction} under its weight"


def _line_spring(spring: LineSpring) -> str:
    first, second = spring.between
    text = f"{metric(spring.stiffness, 'N/m')}, {length(spring.length)} long without force"
    damped = f", damping {metric(spring.viscous, 'N·s/m')}" if spring.viscous else ""
    return f"  spring from a point of {first} to one of {second or 'the movement'}: {text}{damped}"


def _ends(body: str, against: str | None) -> str:
    return body if against is None else f"{body} against {against}"


def _mainspring(spring: Mainspring) -> str:
    """Where a torque comes from, and what its train weighs at the body."""
    turns = f"{spring.run_down / math.tau:.6g} turns from full wind"
    felt = f", train felt as {show(spring.inertia, 'mg·cm²')}" if spring.inertia else ""
    return (
        f"from {metric(spring.torque, 'N·m')} at the barrel {turns}, ratio {spring.ratio:g}, "
        f"efficiency {100.0 * spring.efficiency:g} %{felt}"
    )


def _swing(scene: Scene, one: Oscillator) -> str:
    """What gravity adds to the springs of a body, and how fast the two make it swing."""
    pull = metric(one.gravity, "N·m/rad")
    by = f"gravity alone, {pull}" if not one.spring else f"its springs and gravity together, {pull} of it from gravity"
    if one.hertz is None:
        return f"  {one.body} does not swing: gravity topples it from {turned(one.rest)}"
    beats = f" = {show(one.hertz, 'vph')}" if keeps_time(scene) else ""
    return f"  {one.body} makes small swings at {show(one.hertz, 'Hz')}{beats} about {turned(one.rest)} by {by}"


def _spring(scene: Scene, spring: Spring) -> str:
    body = scene.body(spring.body)
    linear = body.motion == "slide"
    hertz = _hertz(scene, spring)
    stiffness = metric(spring.stiffness, "N/m" if linear else "N·m/rad")
    rest = place(spring.rest) if linear else turned(spring.rest)
    timed = keeps_time(scene) and spring.against is None
    beats = (
        f" = {show(hertz, 'vph')}" if timed else " while they touch nothing" if spring.against else " while it touches nothing"
    )
    if spring.curb is not None:
        stiffness += f", more by {100.0 * spring.curb.share / (1.0 - spring.curb.share):.4g} % beyond its curb pins"
    if spring.cubic:
        stiffness += f" and {metric(spring.cubic, 'N/m³' if linear else 'N·m/rad³')}"
    return f"{stiffness}, {show(hertz, 'Hz')}{beats}, at rest at {'a travel of ' * linear}{rest}{_stop(spring, linear)}"


def _stop(spring: Spring, linear: bool) -> str:
    if spring.stop is None:
        return ""
    at = place(spring.stop) if linear else turned(spring.stop)
    preload = metric(abs(spring.stiffness * (spring.rest - spring.stop)), "N" if linear else "N·m", 4)
    return f", pressed on its stop at {at} with {preload}, restitution {spring.restitution:g}"


def _hertz(scene: Scene, spring: Spring) -> float:
    """Of the body on this spring alone; between two bodies, of both against each other."""
    if spring.against is None:
        swinging = oscillator(scene.bodies, (spring,), (0.0, 0.0), spring.body)
        return swinging.hertz if swinging and swinging.hertz else math.nan
    masses = dict(zip((body.name for body in scene.bodies), loads(scene.bodies)[2], strict=True))
    mobility = sum(1.0 / masses[name] for name in (spring.body, spring.against) if scene.body(name).prescribed is None)
    return math.sqrt(spring.stiffness * mobility) / math.tau


def _damping(scene: Scene, damping: Damping) -> str:
    motion, parts = scene.body(damping.body).motion, []
    single = damping.against is None
    swinging = oscillator(scene.bodies, scene.springs, scene.gravity, damping.body) if single else None
    for law in (*DAMPING_LAWS, "coulomb"):
        dimension, value = DAMPING[law].dimension_for(motion), getattr(damping, law)
        if value and dimension:
            parts.append(f"{'dry friction ' if law == 'coulomb' else ''}{metric(value, dimension.si)}")
        if value and law == "viscous" and swinging and swinging.hertz:
            parts.append(f"Q = {math.sqrt(swinging.stiffness * swinging.inertia) / value:.6g}")
    return ", ".join(parts) or "none"


def _contact_lines(scene: Scene) -> Iterator[str]:
    for contact in scene.contacts:
        first, second = contact.sides
        slip, text = contact.slip, f"friction {contact.friction:g}"
        if slip.drop:
            text += f", sliding {contact.friction - slip.drop:g}"
            text += f" (decay {metric(slip.decay, 'm/s')})" if slip.decay else ""
        if slip.rise:
            text += f", viscous {slip.rise:g} s/m"
        text += f", restitution {contact.restitution:g}"
        if contact.tangential_restitution:
            text += f", tangential {contact.tangential_restitution:g} ({scene.tangential_law})"
        yield f"  contact {first} - {second}: {text}"


def law_words(body: Body) -> str:
    """How a driven body moves."""
    law = body.prescribed
    assert law is not None
    if law.table:
        return f"driven along a path of {law.table[-1][0]:.6g} s"
    if law.square > 0.0:
        return f"driven, swings at {metric(math.sqrt(law.square) / math.tau, 'Hz')}"
    speed = body.velocity[0] if body.velocity else 0.0
    return f"driven at {metric(speed, 'm/s') if body.motion == 'slide' else f'{math.degrees(speed):.6g} °/s'}"
