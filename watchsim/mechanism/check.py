"""What does a scene amount to before anything is simulated?

Echoes units, sizes, centre distances, mass, inertia and frequency, so that a wrong unit or a slipped digit is seen.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from watchsim.drawing.findings import Finding
from watchsim.geometry.extent import extents
from watchsim.mechanism.body import Body
from watchsim.mechanism.carry import at_start, is_still
from watchsim.mechanism.force import Damping, Spring
from watchsim.mechanism.overlap import overlaps
from watchsim.mechanism.pair_count import PairCount, pair_lines, pairs_entry
from watchsim.mechanism.roles import keeps_time
from watchsim.mechanism.scene import Scene
from watchsim.mechanism.solid import HAIRSPRING, LYING, PLATE, UPRIGHT, Solid, total
from watchsim.units import show, to

DIGITS = 9  # of places: a nanometre still shows at a position of a metre
POISED = 1e-9  # of a body's size: below that, a centre of mass beside the pivot is rounding
LENGTHS, MASSES, INERTIAS = ("mm", "m"), ("mg", "g", "kg"), ("mg·cm²", "g·cm²", "kg·m²")
COORDINATES = {"fixed": 0, "pivot": 1, "slide": 1, "free": 3}


def check_report(scene: Scene, pairs: Sequence[PairCount]) -> dict[str, Any]:
    """What `check --json` prints; `pairs` holds the numbers of each pair of bodies that may touch."""
    hertz = frequency(scene)
    return {
        "bodies": {body.name: _body_entry(body) for body in scene.bodies},
        "theory": {"frequency_hz": hertz, "vph": None if hertz is None else 7200.0 * hertz},
        "pairs": pairs_entry(pairs),
        "statics": {},
        "findings": [
            finding.as_dict() for finding in (*scene.findings, *_overlap_findings(scene), *_poised(scene), *_weightless(scene))
        ],
    }


def frequency(scene: Scene) -> float | None:
    """Undamped frequency (Hz) of the first sprung body; None where no body has a spring."""
    if not scene.springs:
        return None
    body = scene.body(scene.springs[0].body)
    stiffness = sum(spring.stiffness for spring in scene.springs if spring.body == body.name)
    return math.sqrt(stiffness / _moving_mass(body)) / math.tau


def check_text(report: Mapping[str, Any], scene: Scene) -> str:
    """The same for people, in watch units."""
    parts = [scene.title, *_body_lines(scene), *_distance_lines(scene), *_force_lines(scene), *_contact_lines(scene)]
    if scene.contacts and all(finding["code"] != "overlap" for finding in report["findings"]):
        parts.append("  nothing overlaps at the start, among all pairs that may touch")
    parts += pair_lines(report["pairs"])
    parts += [f"{finding['severity']}: {finding['message']}. {finding['fix']}".rstrip() for finding in report["findings"]]
    return "\n".join(parts)


def _body_entry(body: Body) -> dict[str, Any]:
    return {
        "mass_kg": body.mass,
        "inertia_kg_m2": body.inertia,
        "centre_of_mass_m": list(body.centre_of_mass),
        "solids": [_solid_entry(solid) for solid in body.solids],
        "position_m": list(body.position),
        "coordinates": COORDINATES[body.motion],
        **({"on": body.on} if body.on is not None else {}),
    }


def _solid_entry(solid: Solid) -> dict[str, Any]:
    """Inertia about the origin of the body's frame, like that of the body."""
    return {
        "layer": solid.layer,
        "kind": solid.kind,
        "count": solid.count,
        "bores": list(solid.bores),
        "mass_kg": solid.weight.mass,
        "centre_of_mass_m": list(solid.weight.centre),
        "inertia_kg_m2": solid.weight.about((0.0, 0.0)),
    }


def _overlap_findings(scene: Scene) -> Iterator[Finding]:
    for overlap in overlaps(scene):
        x, y = (1e3 * value for value in overlap.place)
        yield Finding("overlap", "error", str(overlap), "Move or turn one of them.", x_mm=x, y_mm=y)


def _poised(scene: Scene) -> Iterator[Finding]:
    """Gravity turns a pivoted body only if its mass is known; saying nothing must not pass for poise."""
    for body in scene.bodies if any(scene.gravity) else ():
        if body.motion == "pivot" and body.mass == 0.0:
            message = f"{body.name} has no mass, so gravity does not turn it: it counts as poised"
            yield Finding("poised", "notice", message, f"Give mass or solids under [bodies.{body.name}] if it is not.")


def _weightless(scene: Scene) -> Iterator[Finding]:
    """A carrier must swing what it carries; saying nothing must not pass for no mass."""
    for body in scene.bodies:
        if body.on is not None and body.motion == "pivot" and body.mass == 0.0 and not is_still(scene, scene.body(body.on)):
            message = f"{body.name} has no mass, so it adds nothing to what {body.on} weighs"
            cure = f"Give mass or solids under [bodies.{body.name}] unless the inertia of {body.on} holds it already."
            yield Finding("weightless", "notice", message, cure)


def _moving_mass(body: Body) -> float:
    return body.mass if body.motion == "slide" else body.inertia


def _body_lines(scene: Scene) -> Iterator[str]:
    width = max(len(body.name) for body in scene.bodies)
    for body in scene.bodies:
        yield f"  {body.name:{width}}  {body.motion:5}  " + ", ".join((_place(body), _size(body), *_weights(body)))
        yield from _solid_lines(body)
        yield from _poise_lines(scene, body)


def _solid_lines(body: Body) -> Iterator[str]:
    """Every solid with what it adds, and their sum: what a designer checks a wrong density by."""
    if not body.solids:
        return
    rows = [
        (solid.name + (f" × {solid.count}" if solid.count > 1 else ""), _kind(solid), solid.weight) for solid in body.solids
    ]
    whole = total(body.solids)
    if whole is not None:
        rows.append(("together", "", whole))
    width, kinds = max(len(row[0]) for row in rows), max(len(row[1]) for row in rows)
    for name, kind, weight in rows:
        x, y = (_millimetres(value) for value in weight.centre)
        inertia = _fitting(weight.about((0.0, 0.0)), INERTIAS)
        yield f"      {name:{width}}  {kind:{kinds}}  {_fitting(weight.mass, MASSES):>12}  {inertia:>16}  centre ({x}, {y}) mm"


def _millimetres(value: float) -> str:
    """To the nanometre, so that rounding does not look like a place."""
    return f"{round(to(value, 'mm'), 6) + 0.0:.6f}".rstrip("0").rstrip(".")


def _kind(solid: Solid) -> str:
    """Of what shape, in words."""
    return {
        PLATE: f"plate of {show(solid.thickness, 'mm')}" + _less(len(solid.drilled)),
        UPRIGHT: "turned, upright on the pivot",
        LYING: "turned, lying",
        HAIRSPRING: "hairspring, one third",
    }[solid.kind]


def _less(bores: int) -> str:
    return f" less {bores} bore{'' if bores == 1 else 's'}" if bores else ""


def _poise_lines(scene: Scene, body: Body) -> Iterator[str]:
    """What a centre of mass beside the pivot does: gravity turns the body; the pull on the pivot itself moves nothing."""
    distance = math.hypot(*body.centre_of_mass)
    if body.motion != "pivot" or body.mass == 0.0 or distance <= POISED * (_reach(body) or distance):
        return
    pull = math.hypot(*scene.gravity)
    what = f"its centre of mass lies {show(distance, 'mm' if distance >= 0.1e-3 else 'µm', 4)} beside the pivot"
    if pull > 0.0:
        yield f"      {what}: gravity turns it with up to {show(body.mass * distance * pull, 'nN·m')}"
    else:
        yield f"      {what}; the scene has no gravity, so this does nothing"


def _reach(body: Body) -> float:
    """Half the larger side of the box around everything drawn."""
    box = extents((*body.loops, *body.decoration))
    return 0.5 * max(box[2] - box[0], box[3] - box[1]) if box else 0.0


def _place(body: Body) -> str:
    x, y = body.position
    on = f"on {body.on} " if body.on is not None else ""
    return f"{on}at ({show(x, 'mm', DIGITS)}, {show(y, 'mm', DIGITS)}), turned by {show(body.angle, '°')}"


def _size(body: Body) -> str:
    """Width and height of all outlines as drawn."""
    box = extents(body.loops)
    if box is None:
        return "no outline"
    return f"{_fitting(box[2] - box[0], LENGTHS)} × {_fitting(box[3] - box[1], LENGTHS)}"


def _weights(body: Body) -> Iterator[str]:
    if body.motion != "fixed" and body.mass > 0.0:
        yield f"mass {_fitting(body.mass, MASSES)}"
    if body.motion in ("pivot", "free"):
        yield f"inertia {_fitting(body.inertia, INERTIAS)}"


def _fitting(value: float, units: tuple[str, ...]) -> str:
    """In the first unit that needs at most four digits before the point."""
    return show(value, next((unit for unit in units if abs(to(value, unit)) < 1e4), units[-1]), 5)


def _distance_lines(scene: Scene) -> Iterator[str]:
    """Between the pivots of bodies that are declared to touch."""
    seen, start = set(), at_start(scene)
    for contact in scene.contacts:
        names = tuple(dict.fromkeys(side.body for side in contact.sides))
        first, second = (start.body(name) for name in names)
        if frozenset(names) not in seen and first.motion == second.motion == "pivot":
            seen.add(frozenset(names))
            yield f"  centre distance {names[0]} - {names[1]}: {show(math.dist(first.position, second.position), 'mm', DIGITS)}"


def _force_lines(scene: Scene) -> Iterator[str]:
    for spring in scene.springs:
        yield f"  spring on {spring.body}: {_spring(scene, spring)}"
    for torque in scene.torques:
        unit = "mN" if scene.body(torque.body).motion == "slide" else "µN·m"
        text = show(torque.value, unit) if not torque.table else f"{len(torque.table)} values over {torque.over}"
        yield f"  drive on {torque.body}: {text}"
    for damping in scene.damping:
        yield f"  damping on {damping.body}: {_damping(scene, damping)}"


def _spring(scene: Scene, spring: Spring) -> str:
    body = scene.body(spring.body)
    linear = body.motion == "slide"
    hertz = math.sqrt(spring.stiffness / _moving_mass(body)) / math.tau
    stiffness, rest = show(spring.stiffness, "N/m" if linear else "µN·m/rad"), show(spring.rest, "mm" if linear else "°")
    beats = f" = {show(hertz, 'vph')}" if keeps_time(scene) else " while it touches nothing"
    return f"{stiffness}, {show(hertz, 'Hz')}{beats}, at rest at {rest}"


def _damping(scene: Scene, damping: Damping) -> str:
    body, viscous, quadratic = scene.body(damping.body), damping.viscous, damping.quadratic
    linear = body.motion == "slide"
    parts = [show(viscous, "N·s/m" if linear else "nN·m·s/rad")] if viscous else []
    stiffness = sum(spring.stiffness for spring in scene.springs if spring.body == body.name)
    if viscous and stiffness:
        parts.append(f"Q = {math.sqrt(stiffness * _moving_mass(body)) / viscous:.6g}")
    if quadratic:
        parts.append(show(quadratic, "N·s²/m²" if linear else "nN·m·s²/rad²"))
    if damping.coulomb:
        parts.append(f"dry friction {show(damping.coulomb, 'mN' if linear else 'nN·m')}")
    return ", ".join(parts) or "none"


def _contact_lines(scene: Scene) -> Iterator[str]:
    for contact in scene.contacts:
        first, second = contact.sides
        text = f"friction {contact.friction:g}, restitution {contact.restitution:g}"
        if contact.tangential_restitution:
            text += f", tangential {contact.tangential_restitution:g} ({scene.tangential_law})"
        yield f"  contact {first} - {second}: {text}"
