"""How is a proposed scene written, so that its reader sees what is a guess and why?"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from watchsim.proposal.amounts import Amount, Amounts
from watchsim.proposal.bodies.part_names import CLICK, OSCILLATOR
from watchsim.proposal.bodies.part_roles import Role
from watchsim.proposal.bodies.source import Source
from watchsim.proposal.facing import Facing
from watchsim.proposal.sorted_drawings import PIVOT, Drawn
from watchsim.proposal.start import Start

FRICTION, RESTITUTION = 0.12, 0.2
DURATION = "5 s"
TASKS = {
    "wheel": "the wheel",
    "lever": "the lever",
    "oscillator": "the oscillator",
    "click": "the click",
    "driver": "the driver",
    "fixed": "stands still",
}


@dataclass(frozen=True)
class Guess:
    """A value of the scene that the drawing does not state: its key, what is written, and the reason."""

    key: str
    value: str
    why: str


@dataclass
class Plan:
    """All that the scene is written from. `places` are positions (m) of bodies that do not stand where they are drawn."""

    title: str
    sources: Sequence[Source]
    drawn: Sequence[Drawn]
    roles: Sequence[Role]
    facings: Sequence[Facing]
    others: Sequence[tuple[Facing, str]]
    start: Start
    amounts: Amounts
    places: dict[str, tuple[float, float]]
    direction: int
    direction_why: str
    left_out: Sequence[str] = ()
    guesses: list[Guess] = field(default_factory=list)

    def side(self, role: Role, layer: str) -> str:
        """A layer of a body as a contact names it."""
        return f"{role.name}.{self.drawn[role.part.file].layers[role.name, layer]}"

    def guess(self, key: str, value: str, why: str) -> str:
        """A line of the scene with its comment."""
        self.guesses.append(Guess(key, value, why))
        return f"{key.rsplit('.', maxsplit=1)[-1]} = {value}  # guess: {why}"


def scene_text(plan: Plan) -> str:
    """The scene file; fills `plan.guesses`."""
    plan.guesses.clear()
    names = ", ".join(source.path.name for source in plan.sources)
    lines = [
        f"# Proposed from {names}. What is a guess says so, and why: put right what you know better, then",
        "# `watchsim check`, `watchsim check --png start.png` and `watchsim run` say what comes of it.",
        *(f"# Left out: {words}" for words in plan.left_out),
        "",
        "[scene]",
        f"title  = {_text(plan.title)}",
        "schema = 1",
    ]
    for role in plan.roles:
        lines += ["", *_body(plan, role)]
    lines += _forces(plan)
    for k, facing in enumerate(plan.facings):
        lines += ["", *_contact(plan, facing, k)]
    if plan.others:
        lines += ["", "# Not taken for contacts, though they come near:"]
        lines += [f"# {_sides(plan, facing)}: {why}" for facing, why in plan.others]
    lines += ["", "[run]", plan.guess("run.duration", _text(DURATION), "long enough to see whether it works")]
    return "\n".join(lines) + "\n"


def _body(plan: Plan, role: Role) -> Iterator[str]:
    drawing, source, key = plan.drawn[role.part.file], plan.sources[role.part.file], f"bodies.{role.name}"
    yield f"[{key}]"
    if role.task:
        plan.guesses.append(Guess(key, TASKS[role.task], role.why))
        yield f"# guess: {TASKS[role.task]}; {role.why}"
    if role.part.why:
        plan.guesses.append(Guess(f"{key}.layers", "one body", "; ".join(role.part.why)))
        yield f"# guess: one body; {'; '.join(role.part.why)}"
    yield f"drawing = {_text(drawing.name)}"
    if source.units is not None and not drawing.is_sorted:
        yield plan.guess(f"{key}.units", _text(source.units), "the drawing does not say; in this unit its size is likely")
    touching = _touching(plan, role)
    layers = [drawing.layers[role.name, layer] for layer in role.part.layers]
    yield f"layers = {_texts([layer for layer in layers if layer in touching] or layers)}"
    if touching and (rest := [layer for layer in layers if layer not in touching]):
        yield f"draw = {_texts(rest)}"
    yield from _pivot(plan, role, key)
    place = plan.places.get(role.name)
    if place is None:
        yield 'position = "as drawn"'
    else:
        value = _pair(place)
        yield plan.guess(
            f"{key}.position", value, "these drawings do not show where the parts stand; they are put side by side"
        )
    if not role.moves:
        yield 'motion = "fixed"'
        return
    angle = plan.start.angles.get(role.name, 0.0)
    if angle:
        yield plan.guess(f"{key}.angle", _text(f"{math.degrees(angle):.6g}°"), plan.start.why.get(role.name, "as needed"))
    if plan.amounts.turned == role.name:
        yield 'motion = "driven"'
        way = "clockwise" if plan.direction < 0 else "counter-clockwise"
        yield plan.guess(
            f"{key}.velocity", _text(f"{60 * plan.direction} rpm"), f"it turns {way}, evenly, and moves the wheel on"
        )
        return
    inertia = plan.amounts.inertia[role.name]
    yield plan.guess(f"{key}.inertia", _text(f"{1e10 * inertia.value:.3g} mg·cm²"), inertia.why)


def _pivot(plan: Plan, role: Role, key: str) -> Iterator[str]:
    centre, drawing = role.part.centre, plan.drawn[role.part.file]
    if centre is None or not role.moves:
        if plan.places.get(role.name) is not None:
            yield "pivot = " + _pair((0.0, 0.0))
        return
    mark = centre.mark
    if drawing.is_sorted:
        value = _text(f"{role.name.upper()}_{PIVOT}")
    elif mark is not None and mark.single:
        value = _text(mark.layer)
    elif mark is not None:
        value = _text(f"{'point' if mark.point else 'circle'} near {_bare(centre.at)}")
    else:
        value = _pair(centre.at)
    yield plan.guess(f"{key}.pivot", value, centre.why)


def _touching(plan: Plan, role: Role) -> set[str]:
    layers = plan.drawn[role.part.file].layers
    found = set()
    for facing in plan.facings:
        for one, layer in ((facing.first, facing.first_layer), (facing.second, facing.second_layer)):
            if one is role:
                found.add(layers[role.name, layer])
    return found


def _forces(plan: Plan) -> Iterator[str]:
    amounts = plan.amounts
    swinging = next((role for role in plan.roles if role.task == OSCILLATOR), None)
    if swinging is not None and amounts.vph is not None and amounts.q_factor is not None:
        yield from ("", "[[springs]]")
        yield plan.guess("springs.0.body", _text(swinging.name), f"the oscillator: {swinging.why}")
        yield plan.guess("springs.0.frequency", _text(f"{amounts.vph.value:g} vph"), amounts.vph.why)
        if plan.start.rest:
            yield plan.guess("springs.0.rest", _text(f"{math.degrees(plan.start.rest):.6g}°"), plan.start.rest_why)
        yield from ("", "[[damping]]", f"body = {_text(swinging.name)}")
        yield plan.guess("damping.0.q_factor", f"{amounts.q_factor.value:g}", amounts.q_factor.why)
    for k, spring in enumerate(amounts.clicks):
        rest = plan.start.angles.get(spring.body, 0.0) + spring.way
        yield from ("", "[[springs]]", f"body = {_text(spring.body)}")
        yield plan.guess(f"springs.{k}.stiffness", _text(f"{1e6 * spring.stiffness.value:.3g} µN·m/rad"), spring.stiffness.why)
        yield plan.guess(
            f"springs.{k}.rest", _text(f"{math.degrees(rest):.6g}°"), "in the teeth: it presses the click on the wheel"
        )
    if amounts.driven is not None and amounts.torque is not None and amounts.turned is None:
        value = plan.direction * amounts.torque.value
        yield from ("", "[[torques]]", f"body = {_text(amounts.driven)}")
        why = f"{plan.direction_why}; {amounts.torque.why}"
        yield plan.guess("torques.0.value", _text(f"{1e6 * value:.3g} µN·m"), why)
    if amounts.driven is not None and amounts.viscous is not None:
        yield from _slowed(plan, amounts.viscous)


def _slowed(plan: Plan, viscous: Amount) -> Iterator[str]:
    for k, role in enumerate(
        role for role in plan.roles if role.moves and role.task != CLICK and role.name != plan.amounts.turned
    ):
        yield from ("", "[[damping]]", f"body = {_text(role.name)}")
        yield plan.guess(f"damping.{k}.viscous", _text(f"{1e9 * viscous.value:.3g} nN·m·s/rad"), viscous.why)


def _contact(plan: Plan, facing: Facing, number: int) -> Iterator[str]:
    yield "[[contacts]]"
    yield plan.guess(f"contacts.{number}.between", _sides(plan, facing), facing.why)
    yield plan.guess(f"contacts.{number}.friction", f"{FRICTION}", "steel on ruby, lightly oiled")
    yield plan.guess(f"contacts.{number}.restitution", f"{RESTITUTION}", "as measured on watch parts it is small")


def _sides(plan: Plan, facing: Facing) -> str:
    return _texts([plan.side(facing.first, facing.first_layer), plan.side(facing.second, facing.second_layer)])


def _text(value: str) -> str:
    return json.dumps(value, ensure_ascii=False)


def _texts(values: Sequence[Any]) -> str:
    return json.dumps(list(values), ensure_ascii=False)


def _bare(place: tuple[float, float]) -> str:
    return f"[{_mm(place[0])}, {_mm(place[1])}]"


def _pair(place: tuple[float, float]) -> str:
    return _texts([_mm(place[0]), _mm(place[1])])


def _mm(value: float) -> str:
    return f"{round(1e3 * value, 9) + 0.0:.12g} mm"
