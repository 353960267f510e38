"""What does a scene amount to before anything is simulated?

Echoes units, sizes, centre distances, mass, inertia and frequency, so that a wrong unit or a slipped digit is seen.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.cell_frames import named_rows
from watchsim.contact.cells import PairCells
from watchsim.drawing.findings import Finding
from watchsim.drawing.material import layer_roles
from watchsim.geometry.loops import extents, points_along
from watchsim.geometry.solids import section
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.mechanism.contacts import PairCount, pair_lines, pairs_entry
from watchsim.mechanism.overlap import cure_of, overlaps
from watchsim.mechanism.words import force_lines, law_words, length, place, turned
from watchsim.scene.roles import frequency, keeps_time, loads, only_presses, oscillators, partners, pitch, reach_of, roles
from watchsim.scene.scene import Body, Scene, Tolerance
from watchsim.scene.solids import HAIRSPRING, LYING, PLATE, UPRIGHT, Solid, total
from watchsim.scene.teeth import train
from watchsim.scene.trains import ON_PIVOT, Weighed, is_still
from watchsim.tolerances import HANGS_STILL
from watchsim.units import metric, show, to

# How many pairs of primitives are declared between two bodies, how many can ever touch, how many are candidates at a time?

Integers = NDArray[np.int64]


class ModelledPairs(NamedTuple):
    """What a scene declares and what of it matters."""

    counts: tuple[PairCount, ...]
    reachable: Integers  # primitives (rows of the model) of which some pair can ever touch
    candidates: Integers  # those among them of which some pair is a candidate at the start


def modelled_pairs(compiled: Compiled, names: Sequence[str]) -> ModelledPairs:
    """Count all pairs of bodies of a compiled scene; `names` are those of its bodies, in order."""
    model = compiled.model
    counts, here = [], [np.zeros(0, np.int64)]
    for p, pair in enumerate(model.pairs):
        near = model.near[pair.near_start : pair.near_stop]
        around, at_start = np.array([len(near)]), near
        if pair.listed:
            cells = PairCells(model, p)
            at_start = cells.here(compiled.q)
            _, around, _ = cells.around(compiled.q)
            if not len(around):  # beyond the cells
                around = np.array([len(at_start)])
        here.append(at_start)
        bodies = (_named(compiled, pair, pair.a, names), _named(compiled, pair, pair.b, names))
        numbers = (compiled.declared[p], len(near), round(float(np.median(around))), int(around.max()), len(at_start))
        counts.append(PairCount(bodies, *numbers))
    return ModelledPairs(tuple(counts), _primitives(compiled, model.near), _primitives(compiled, np.concatenate(here)))


def _primitives(compiled: Compiled, contacts: Integers) -> Integers:
    """The primitives of some contacts, each once."""
    declared = compiled.model.contacts
    return named_rows(np.concatenate([declared.a[contacts], declared.b[contacts]]), len(compiled.model.primitives))[0]


def _named(compiled: Compiled, pair: Any, body: int, names: Sequence[str]) -> str:
    """What the scene calls one side of a pair: outlines fixed on a moving body keep the name of the part they belong to."""
    contacts, primitives = compiled.model.contacts[pair.start : pair.stop], compiled.model.primitives
    rows, _ = named_rows(np.concatenate([contacts.a, contacts.b]), len(primitives))
    owners = [compiled.owners[row] for row in rows if primitives.body[row] == body]
    return ", ".join(dict.fromkeys(owners)) or names[body]


# What does a scene leave unsaid that changes its motion, and what does it say without effect?
#
# None of it is wrong by itself; all of it is easily overlooked. `watchsim check` lists it, `watchsim run` says it first.

SHARES = np.linspace(0.0, 1.0, 33)  # of each edge
ROUNDING = 1e-9  # relative: of an inertia that is written in decimals
UNCOUNTED = 0.5  # of the area that counts: with so much more drawn beside it, the mass is hardly where it is said to be


def notes(scene: Scene) -> tuple[Finding, ...]:
    """A notice for each, with what to do."""
    return (
        *_massless(scene),
        *_too_light(scene),
        *_weightless(scene),
        *_by_outline(scene),
        *_by_one_layer(scene),
        *_unused_lift(scene),
        *_at_rest(scene),
        *_apart(scene),
        *_pressed_on_nothing(scene),
    )


def _massless(scene: Scene) -> Iterator[Finding]:
    """Gravity turns a pivoted body only if its mass is known; saying nothing must not pass for poise.

    What is moved as the scene says feels none, and a driven wheel of equal teeth is poised.
    """
    weighed = loads(scene.bodies)[1] if any(scene.gravity) else ()
    wheel = roles(scene).wheel
    poised = train(scene, wheel) if wheel is not None and pitch(scene, wheel) else ()
    for body, load in zip(scene.bodies, weighed, strict=False):
        if body.motion == "pivot" and load.mass == 0.0 and body.prescribed is None and body.name not in poised:
            message = f"{body.name} has no mass, so gravity does not turn it: it counts as poised"
            yield Finding("poised", "notice", message, f"Give mass or solids under [bodies.{body.name}] if it is not.")


def _too_light(scene: Scene) -> Iterator[Finding]:
    """About its pivot a body has at least the inertia of its whole mass in its centre of mass."""
    for body in scene.bodies:
        least = body.mass * math.hypot(*body.centre_of_mass) ** 2
        if body.motion == "pivot" and body.inertia < least * (1.0 - ROUNDING):
            inertia, most = (show(value, _unit(least, INERTIAS), 5) for value in (body.inertia, least))
            message = (
                f"no body has the inertia of {body.name}, {inertia} about its pivot: its mass, "
                f"{length(math.hypot(*body.centre_of_mass))} beside the pivot, alone makes {most}"
            )
            cure = f"Look at mass, inertia and centre_of_mass under [bodies.{body.name}]; inertia is that about the pivot."
            yield Finding("inertia", "warning", message, cure)


def _apart(scene: Scene) -> Iterator[Finding]:
    """A contact of bodies that never come near each other holds nothing."""
    compiled = compile_scene(scene)
    for pair in compiled.model.pairs:
        if pair.near_start == pair.near_stop and pair.start < pair.stop:
            one, other = (_named(compiled, pair, body, [body.name for body in scene.bodies]) for body in (pair.a, pair.b))
            message = f"{one} and {other} never come within reach of each other, at whatever angles: their contact does nothing"
            yield Finding("apart", "warning", message, "Look at their places with --png, or leave the contact out.")


def _pressed_on_nothing(scene: Scene) -> Iterator[Finding]:
    """A spring that should press a body on what turns relaxes before the body comes within reach of it."""
    name = roles(scene).oscillator if only_presses(scene) else None
    rest = next((one.rest for one in scene.springs if one.body == name and one.stop is None), None)
    if name is None or rest is None or scene.body(name).motion != "pivot" or scene.body(name).on is not None:
        return
    body, others = scene.body(name), [scene.body(one) for one in sorted(partners(scene, name))]
    if any(other.motion != "pivot" or other.on is not None for other in others) or not (others and body.loops):
        return
    points = np.concatenate([points_along(edge, SHARES) for loop in body.loops for edge in loop.edges])
    way = np.linspace(body.angle, rest, len(SHARES))  # a spring may be bent so far that the body would pass through at rest
    turned = complex(*body.position) + points * np.exp(1j * way[:, None])
    for other in others:
        reach = max((reach_of([loop]) for loop in other.loops), default=0.0)
        if np.abs(turned - complex(*other.position)).min() < reach * (1.0 + ROUNDING):
            return
    names = " and ".join(other.name for other in others)
    message = f"the spring of {name} presses it on nothing: on its way to rest it is out of reach of {names}"
    yield Finding("unpressed", "warning", message, f"Look at the place of {name} with --png, and at rest under [[springs]].")


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


def _by_one_layer(scene: Scene) -> Iterator[Finding]:
    """A mass alone is spread over what can touch: the bob of a pendulum is drawn, and weighs nothing."""
    for body in scene.bodies:
        entry = scene.source.get("bodies", {}).get(body.name, {})
        if "mass" not in entry or {"inertia", "solids"} & set(entry) or body.motion not in ("pivot", "free"):
            continue
        closed = [loop for loop in (*body.loops, *body.decoration) if loop.closed and loop.layer != entry.get("pivot")]
        kinds = layer_roles(closed)
        drawn = [loop for loop in closed if loop.layer not in body.layers and kinds[loop.layer] == "material"]
        if section(drawn).area > UNCOUNTED * section(loop for loop in body.loops if loop.closed).area:
            left = list(dict.fromkeys(loop.layer for loop in drawn if not loop.hole))
            message = (
                f"the mass of {body.name} is spread over what can touch, {' and '.join(body.layers)}: {' and '.join(left)} "
            )
            message += f"{'counts' if len(left) == 1 else 'count'} for nothing"
            cure = f"Give solids with the layers that weigh something, or inertia, under [bodies.{body.name}]."
            yield Finding("mass-by-layer", "notice", message, cure)


def _is_off(body: Body) -> bool:
    return math.hypot(*body.centre_of_mass) > ON_PIVOT * math.sqrt(body.inertia / body.mass) if body.mass > 0.0 else False


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
    """A clock that hangs still at the start may never begin to tick; a body that its own drive pulls along does not hang."""
    found = oscillators(scene)
    if not found or not keeps_time(scene):
        return
    one, body = found[0], scene.body(found[0].body)
    if any(torque.body == body.name for torque in scene.torques):
        return
    start = body.angle if body.motion == "pivot" else 0.0
    if abs(start - one.rest) <= HANGS_STILL and all(abs(speed) <= HANGS_STILL for speed in body.velocity):
        message = f"{body.name} starts at rest in its rest position: it swings only if the drive sets it going"
        yield Finding("at-rest", "notice", message, f"Give an angle or a velocity under [bodies.{body.name}].")


LENGTHS, MASSES, INERTIAS = ("mm", "m"), ("mg", "g", "kg"), ("mg·cm²", "g·cm²", "kg·m²")
COORDINATES = {"fixed": 0, "pivot": 1, "slide": 1, "free": 3}


def check_report(scene: Scene, pairs: Sequence[PairCount]) -> dict[str, Any]:
    """What `check --json` prints; `pairs` holds the numbers of each pair of bodies that may touch."""
    hertz = frequency(scene)
    return {
        "bodies": {
            body.name: {**_body_entry(body), **_loaded_entry(body, load)}
            for body, load in zip(scene.bodies, loads(scene.bodies)[1], strict=True)
        },
        "theory": {"frequency_hz": hertz, "vph": None if hertz is None else 7200.0 * hertz},
        "pairs": pairs_entry(pairs),
        "statics": {},
        "tolerances": [_tolerance_entry(one) for one in scene.tolerances],
        "findings": [finding.as_dict() for finding in (*scene.findings, *_overlap_findings(scene), *notes(scene))],
    }


def check_text(report: Mapping[str, Any], scene: Scene, function: Iterable[str] = ()) -> str:
    """The same for people, in watch units; `function` are the lines about the geometry of function."""
    parts = [scene.title, *_body_lines(scene), *force_lines(scene)]
    if scene.contacts and all(finding["code"] != "overlap" for finding in report["findings"]):
        parts.append("  nothing overlaps at the start, among all pairs that may touch")
    parts += [*pair_lines(report["pairs"]), *function, *_tolerance_lines(scene)]
    said = Counter(f"{finding['severity']}: {finding['message']}. {finding['fix']}".rstrip() for finding in report["findings"])
    parts += [f"{words} ({number} times)" if number > 1 else words for words, number in said.items()]
    return "\n".join(parts)


def _tolerance_entry(one: Tolerance) -> dict[str, Any]:
    """In SI: the nominal value and the deviations that are the limits."""
    kind = {"unit": one.dimension.si, "distribution": one.shape, "sigma": one.sigma or None, "group": one.group or None}
    return {"key": one.key, "nominal": one.nominal, "low": one.low, "high": one.high, **kind, "each": one.count}


def _tolerance_lines(scene: Scene) -> Iterator[str]:
    if scene.tolerances:
        yield "  tolerances:"
    width = max((len(one.key) for one in scene.tolerances), default=0)
    values = [one.shown(one.nominal) for one in scene.tolerances]
    for one, value in zip(scene.tolerances, values, strict=True):
        yield f"      {one.key:{width}}  {value:>{max(map(len, values))}}  {one.words}"
    for pair in scene.correlated:
        yield f"      {' and '.join(pair.between)}: correlated by {pair.coefficient:g}"


def _body_entry(body: Body) -> dict[str, Any]:
    return {
        "mass_kg": body.mass,
        "inertia_kg_m2": body.inertia,
        "centre_of_mass_m": list(body.centre_of_mass),
        "solids": [_solid_entry(solid) for solid in body.solids],
        "position_m": list(body.position),
        "coordinates": COORDINATES[body.motion] if body.geared is None else 0,
        "driven": body.prescribed is not None,
        **({"on": body.on} if body.on is not None else {}),
        **({"geared": {"to": body.geared.to, "ratio": body.geared.ratio}} if body.geared is not None else {}),
    }


def _loaded_entry(body: Body, load: Weighed) -> dict[str, Any]:
    """Of a body that carries others: what moves with its coordinate, about its origin."""
    if body.motion == "fixed" or (load.mass, load.inertia) == (body.mass, body.inertia):
        return {}
    return {"loaded_mass_kg": load.mass, "loaded_inertia_kg_m2": load.inertia}


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
        yield Finding("overlap", "error", str(overlap), f"{cure_of(scene, overlap)}.", x_mm=x, y_mm=y)


def _body_lines(scene: Scene) -> Iterator[str]:
    width = max(len(body.name) for body in scene.bodies)
    for body, load in zip(scene.bodies, loads(scene.bodies)[1], strict=True):
        yield f"  {body.name:{width}}  {body.motion:5}  " + ", ".join((_place(body), _size(body), *_weights(body)))
        yield from _load_lines(scene, body, load)
        yield from _solid_lines(body)
        yield from _poise_lines(scene, body, load)


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
    heaviest = _unit(max(weight.mass for _, _, weight in rows), MASSES, 1e3)
    largest = _unit(max(weight.about((0.0, 0.0)) for _, _, weight in rows), INERTIAS)  # one for the column: it is added up
    for name, kind, weight in rows:
        x, y = (_millimetres(value) for value in weight.centre)
        mass, inertia = show(weight.mass, heaviest, 5), show(weight.about((0.0, 0.0)), largest, 5)
        yield f"      {name:{width}}  {kind:{kinds}}  {mass:>12}  {inertia:>16}  centre ({x}, {y}) mm"


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


def _poise_lines(scene: Scene, body: Body, load: Weighed) -> Iterator[str]:
    """What a centre of mass beside the pivot does: gravity turns the body; the pull on the pivot itself moves nothing."""
    moment = math.hypot(*load.moment)
    distance = moment / load.mass if load.mass > 0.0 else 0.0
    if body.motion != "pivot" or body.prescribed is not None or distance <= ON_PIVOT * (_reach(body) or distance):
        return
    pull = math.hypot(*scene.gravity)
    whose = "the common" if load.mass > body.mass else "its"
    what = f"{whose} centre of mass lies {length(distance)} beside the pivot"
    if pull > 0.0:
        yield f"      {what}: gravity turns it with up to {metric(moment * pull, 'N·m')}"
    else:
        yield f"      {what}; the scene has no gravity, so this does nothing"


def _reach(body: Body) -> float:
    """Half the larger side of the box around everything drawn."""
    box = extents((*body.loops, *body.decoration))
    return 0.5 * max(box[2] - box[0], box[3] - box[1]) if box else 0.0


def _place(body: Body) -> str:
    on = f"on {body.on} " if body.on is not None else ""
    return f"{on}at ({place(body.position[0])}, {place(body.position[1])}), turned by {turned(body.angle)}"


def _size(body: Body) -> str:
    """Width and height of all outlines as drawn."""
    box = extents(body.loops)
    if box is None:
        return "no outline"
    return f"{_fitting(box[2] - box[0], LENGTHS)} × {_fitting(box[3] - box[1], LENGTHS)}"


def _weights(body: Body) -> Iterator[str]:
    if body.prescribed is not None:
        yield law_words(body)
        return
    if (body.motion != "fixed" or body.on is not None) and body.mass > 0.0:
        yield f"mass {_fitting(body.mass, MASSES, 1e3)}"
    if body.motion in ("pivot", "free"):
        yield f"inertia {_fitting(body.inertia, INERTIAS)}"


def _load_lines(scene: Scene, body: Body, load: Weighed) -> Iterator[str]:
    """What a body weighs together with what it carries."""
    carried = [other.name for other in scene.bodies if other.on == body.name and other.mass > 0.0]
    if body.motion == "fixed" or not carried:
        return
    weights = [f"mass {_fitting(load.mass, MASSES, 1e3)}"] if load.mass > 0.0 else []
    weights += [f"inertia {_fitting(load.inertia, INERTIAS)}"] if body.motion != "slide" else []
    yield f"      with {' and '.join(carried)}: {', '.join(weights)}"


def _fitting(value: float, units: tuple[str, ...], most: float = 1e4) -> str:
    return show(value, _unit(value, units, most), 5)


def _unit(value: float, units: tuple[str, ...], most: float = 1e4) -> str:
    """The first unit in which it is less than that."""
    return next((unit for unit in units if abs(to(value, unit)) < most), units[-1])
