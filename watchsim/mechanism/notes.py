"""What does a scene leave unsaid that changes its motion, and what does it say without effect?

None of it is wrong by itself; all of it is easily overlooked. `watchsim check` lists it, `watchsim run` says it first.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.drawing.findings import Finding
from watchsim.mechanism.scene_in_words import length
from watchsim.scene.body import Body
from watchsim.scene.carriers import is_still
from watchsim.scene.oscillation import loads, oscillators
from watchsim.scene.roles import keeps_time, partners, roles
from watchsim.scene.scene import Scene

AT_REST = 1e-9  # rad or m, and per s: nearer than that to its rest position a body stands there
POISED = 1e-9  # of a body's radius of gyration


def notes(scene: Scene) -> tuple[Finding, ...]:
    """A notice for each, with what to do."""
    return (*_massless(scene), *_weightless(scene), *_by_outline(scene), *_unused_lift(scene), *_at_rest(scene))


def _massless(scene: Scene) -> Iterator[Finding]:
    """Gravity turns a pivoted body only if its mass is known; saying nothing must not pass for poise."""
    weighed = loads(scene.bodies)[1] if any(scene.gravity) else ()
    for body, load in zip(scene.bodies, weighed, strict=False):
        if body.motion == "pivot" and load.mass == 0.0:
            message = f"{body.name} has no mass, so gravity does not turn it: it counts as poised"
            yield Finding("poised", "notice", message, f"Give mass or solids under [bodies.{body.name}] if it is not.")


def _weightless(scene: Scene) -> Iterator[Finding]:
    """A carrier must swing what it carries; saying nothing must not pass for no mass."""
    for body in scene.bodies:
        if body.on is not None and body.motion == "pivot" and body.mass == 0.0 and not is_still(scene, scene.body(body.on)):
            message = f"{body.name} has no mass, so it adds nothing to what {body.on} weighs"
            cure = f"Give mass or solids under [bodies.{body.name}] unless the inertia of {body.on} holds it already."
            yield Finding("weightless", "notice", message, cure)


def _by_outline(scene: Scene) -> Iterator[Finding]:
    """Mass beside inertia leaves the centre of mass to the outline, which gravity then turns the body by."""
    for body in scene.bodies if any(scene.gravity) else ():
        entry = scene.source.get("bodies", {}).get(body.name, {})
        written = "mass" in entry and "inertia" in entry and not {"solids", "centre_of_mass"} & set(entry)
        if written and body.motion == "pivot" and body.on is None and _is_off(body):
            message = (
                f"the centre of mass of {body.name} is taken from its outline as of a uniform plate, "
                f"{length(math.hypot(*body.centre_of_mass))} beside the pivot: gravity turns it"
            )
            cure = f"Write centre_of_mass under [bodies.{body.name}], or give solids; leave out mass if it is poised."
            yield Finding("centre-of-mass", "notice", message, cure)


def _is_off(body: Body) -> bool:
    return math.hypot(*body.centre_of_mass) > POISED * math.sqrt(body.inertia / body.mass) if body.mass > 0.0 else False


def _unused_lift(scene: Scene) -> Iterator[Finding]:
    """A lift angle is what noises of the oscillator are turned into an amplitude by."""
    if scene.lift_angle is None:
        return
    name = roles(scene).oscillator
    if name is None:
        why = "nothing swings on a spring or by gravity"
    elif not partners(scene, name):
        why = f"nothing may touch {name}, so no beat is heard"
    else:
        return
    cure = "Leave it out, or look at [[springs]] and [[contacts]]."
    yield Finding("lift-angle", "notice", f"timegrapher.lift_angle has no effect: {why}", cure)


def _at_rest(scene: Scene) -> Iterator[Finding]:
    """A clock that hangs still at the start may never begin to tick."""
    found = oscillators(scene)
    if not found or not keeps_time(scene):
        return
    one, body = found[0], scene.body(found[0].body)
    start = body.angle if body.motion == "pivot" else 0.0
    if abs(start - one.rest) <= AT_REST and all(abs(speed) <= AT_REST for speed in body.velocity):
        message = f"{body.name} starts at rest in its rest position: it swings only if the drive sets it going"
        yield Finding("at-rest", "notice", message, f"Give an angle or a velocity under [bodies.{body.name}].")
