"""Which scene do these drawings suggest?

What is found is tried as a scene: contacts that would overlap at the start are taken out again, so that it loads.
"""

from __future__ import annotations

import json
import math
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.material import is_mark
from watchsim.mechanism.overlap import overlaps
from watchsim.proposal.doubts import doubts, lie_over
from watchsim.proposal.facing import Facing, facings, named_facings
from watchsim.proposal.parts import parts_of, toothing
from watchsim.proposal.pieces import Piece, Source, pieces_of, read_sources, size_of
from watchsim.proposal.roles import Role, apart, first_of, lean_of, roles_of
from watchsim.proposal.start import PIVOT, Amounts, Drawn, Start, amounts_of, drawn, side_by_side, start_of
from watchsim.proposal.words import CLICK, OSCILLATOR, WHEEL
from watchsim.scene.errors import SceneError
from watchsim.scene.load import load
from watchsim.scene.scene import Scene

FRICTION, RESTITUTION = 0.12, 0.2
DURATION = "5 s"
TASKS = {
    "wheel": "the wheel",
    "lever": "the lever",
    "passing": "the passing spring",
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
    doubts: Sequence[str] = ()
    guesses: list[Guess] = field(default_factory=list)

    def side(self, role: Role, layer: str) -> str:
        """A layer of a body as a contact names it."""
        return f"{role.name}.{self.drawn[role.part.file].layers[role.name, layer]}"

    def note(self, key: str, value: str, why: str) -> str:
        """A comment of the scene that says what is guessed."""
        self.guesses.append(Guess(key, value, why))
        return f"# guess: {value}; {why}"

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
        *map(_doubt, plan.doubts),
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
    if plan.amounts.lift is not None:
        lift = plan.amounts.lift
        lines += ["", "[timegrapher]"]
        lines += [plan.guess("timegrapher.lift_angle", _text(f"{math.degrees(lift.value):.4g}°"), lift.why)]
    lines += ["", "[run]", plan.guess("run.duration", _text(DURATION), "long enough to see whether it works")]
    return "\n".join(lines) + "\n"


def _doubt(words: str) -> str:
    return f"# Doubtful: {words}."


def _body(plan: Plan, role: Role) -> Iterator[str]:
    drawing, source, key = plan.drawn[role.part.file], plan.sources[role.part.file], f"bodies.{role.name}"
    yield f"[{key}]"
    if role.task:
        yield plan.note(key, TASKS[role.task], role.why)
    if role.part.why:
        yield plan.note(f"{key}.layers", "one body", "; ".join(role.part.why))
    yield f"drawing = {_text(drawing.name)}"
    if source.units is not None and not drawing.is_sorted:
        yield plan.guess(f"{key}.units", _text(source.units), "the drawing does not say; in this unit its size is likely")
    if source.section is not None and not drawing.is_sorted:
        height = _text(f"{1e3 * source.section:.6g} mm")
        yield plan.guess(f"{key}.section", height, "the section changes with the height; inspect lists where")
    touching = _touching(plan, role)
    layers = [drawing.layers[role.name, layer] for layer in role.part.layers]
    if role.on is not None:
        yield f"on = {_text(role.on.name)}"
    yield f"layers = {_texts([layer for layer in layers if layer in touching] or layers)}"
    if touching and (rest := [layer for layer in layers if layer not in touching]):
        yield f"draw = {_texts(rest)}"
    yield from _pivot(plan, role, key)
    place = plan.places.get(role.name)
    if place is None:
        yield 'position = "as drawn"'
    else:
        why = "these drawings do not show where the parts stand; they are put side by side"
        yield plan.guess(f"{key}.position", _pair(place), why)
    if not role.moves:
        yield 'motion = "fixed"'
        return
    angle = plan.start.angles.get(role.name, 0.0)
    if angle:
        yield plan.guess(f"{key}.angle", _text(f"{math.degrees(angle):.6g}°"), plan.start.why.get(role.name, "as needed"))
    if plan.amounts.turned == role.name:
        yield 'motion = "driven"'
        moved = "the wheel on" if first_of(plan.roles, WHEEL) is not None else "what follows it"
        why = f"it turns {'clockwise' if plan.direction < 0 else 'counter-clockwise'}, evenly, and moves {moved}"
        yield plan.guess(f"{key}.velocity", _text(f"{60 * plan.direction} rpm"), why)
        return
    axis = next((spring.axis for spring in plan.amounts.clicks if spring.body == role.name), None)
    if axis is not None:
        yield 'motion = "slide"'
        why = "it cannot give way to the cam by turning about its pivot, which lies behind it: it is guided straight"
        yield plan.guess(f"{key}.axis", f"[{axis[0]:.6g}, {axis[1]:.6g}]", why)
    mass = plan.amounts.mass.get(role.name)
    if mass is not None:
        yield plan.guess(f"{key}.mass", _text(f"{1e3 * mass.value:.3g} g"), mass.why)
    if axis is not None:
        return
    inertia = plan.amounts.inertia[role.name]
    yield plan.guess(f"{key}.inertia", _text(_inertia(inertia.value)), inertia.why)


def _inertia(value: float) -> str:
    """In the first usual unit in which the number is short."""
    factor, unit = next(((1e-10 * k, name) for k, name in ((1, "mg·cm²"), (1e3, "g·cm²")) if value < 1e-6 * k), (1.0, "kg·m²"))
    return f"{value / factor:.3g} {unit}"


def _torque(value: float) -> str:
    factor, unit = next(((one, name) for one, name in ((1e-6, "µN·m"), (1e-3, "mN·m")) if abs(value) < 1e3 * one), (1.0, "N·m"))
    return f"{value / factor:.3g} {unit}"


def _pivot(plan: Plan, role: Role, key: str) -> Iterator[str]:
    centre, drawing = role.part.centre, plan.drawn[role.part.file]
    if centre is None or not role.moves:
        if plan.places.get(role.name) is not None:
            yield "pivot = " + _pair((0.0, 0.0))
        return
    mark = centre.mark
    if drawing.is_sorted:
        value = _text(f"{role.name.upper()}_{PIVOT}")
    elif mark is not None:
        x, y = map(_mm, centre.at)
        value = _text(mark.layer if mark.single else f"{'point' if mark.point else 'circle'} near [{x}, {y}]")
    else:
        value = _pair(centre.at)
    yield plan.guess(f"{key}.pivot", value, centre.why)


def _touching(plan: Plan, role: Role) -> set[str]:
    layers = plan.drawn[role.part.file].layers
    return {layers[role.name, layer] for facing in plan.facings for one, layer in facing.sides if one is role}


def _forces(plan: Plan) -> Iterator[str]:
    amounts = plan.amounts
    swinging = first_of(plan.roles, OSCILLATOR)
    if swinging is not None and amounts.vph is not None and amounts.q_factor is not None:
        yield from ("", "[[springs]]")
        yield plan.guess("springs.0.body", _text(swinging.name), f"the oscillator: {swinging.why}")
        yield plan.guess("springs.0.frequency", _text(f"{amounts.vph.value:g} vph"), amounts.vph.why)
        if plan.start.rest:
            yield plan.guess("springs.0.rest", _text(f"{math.degrees(plan.start.rest):.6g}°"), plan.start.rest_why)
        yield from ("", "[[damping]]", f"body = {_text(swinging.name)}")
        yield plan.guess("damping.0.q_factor", f"{amounts.q_factor.value:g}", amounts.q_factor.why)
    for k, spring in enumerate(amounts.clicks, 0 if amounts.vph is None else 1):
        rest = plan.start.angles.get(spring.body, 0.0) + spring.way
        turned, slid = f"{1e6 * spring.stiffness.value:.3g} µN·m/rad", f"{1e-3 * spring.stiffness.value:.3g} N/mm"
        yield from ("", "[[springs]]", f"body = {_text(spring.body)}")
        yield plan.guess(f"springs.{k}.stiffness", _text(slid if spring.axis else turned), spring.stiffness.why)
        place = _text(f"{1e3 * rest:.6g} mm" if spring.axis else f"{math.degrees(rest):.6g}°")
        yield plan.guess(f"springs.{k}.rest", place, spring.rest_why)
    if amounts.driven is not None and amounts.torque is not None and amounts.turned is None:
        value = plan.direction * amounts.torque.value
        yield from ("", "[[torques]]", f"body = {_text(amounts.driven)}")
        why = f"{plan.direction_why}; {amounts.torque.why}"
        yield plan.guess("torques.0.value", _text(_torque(value)), why)
    if amounts.driven is not None and amounts.viscous is not None:
        moving = [role for role in plan.roles if role.moves and role.task != CLICK and role.name != amounts.turned]
        for k, role in enumerate(moving):
            yield from ("", "[[damping]]", f"body = {_text(role.name)}")
            value, why = amounts.viscous.value, amounts.viscous.why
            yield plan.guess(f"damping.{k}.viscous", _text(f"{1e9 * value:.3g} nN·m·s/rad"), why)


def _contact(plan: Plan, facing: Facing, number: int) -> Iterator[str]:
    yield "[[contacts]]"
    yield plan.guess(f"contacts.{number}.between", _sides(plan, facing), facing.why)
    yield plan.guess(f"contacts.{number}.friction", f"{FRICTION}", "steel on ruby, lightly oiled")
    yield plan.guess(f"contacts.{number}.restitution", f"{RESTITUTION}", "as measured on watch parts it is small")


def _sides(plan: Plan, facing: Facing) -> str:
    return _texts([plan.side(*side) for side in facing.sides])


def _text(value: str) -> str:
    return json.dumps(value, ensure_ascii=False)


def _texts(values: Sequence[Any]) -> str:
    return json.dumps(list(values), ensure_ascii=False)


def _pair(place: tuple[float, float]) -> str:
    return _texts([_mm(place[0]), _mm(place[1])])


def _mm(value: float) -> str:
    return f"{round(1e3 * value, 9) + 0.0:.12g} mm"


SCENE = "scene.toml"
LARGE = 0.5  # m: the units of a wheel of this size are rather wrong; pendulums may be long
MOST_PIECES = 2000  # more is a picture, not a mechanism


class NothingToPropose(ValueError):
    """The drawings hold nothing that could move; the text says why."""


@dataclass(frozen=True)
class Proposal:
    """Files of the scene by name, and what was guessed. `roles` and `contacts` are in the order of the scene.

    `doubts` are sentences on what cannot be true as it is proposed, or was mended.
    """

    files: dict[str, bytes]
    guesses: tuple[Guess, ...]
    roles: tuple[Role, ...]
    contacts: tuple[tuple[str, str], ...]
    left_out: tuple[str, ...]
    doubts: tuple[str, ...] = ()
    meets: bool = True  # off where no two parts of the drawings can meet, so that there is nothing to try
    either_way: bool = False  # nothing in the drawing says which way its wheel turns
    way: int = -1  # in which it is driven, +1 counter-clockwise

    def doubting(self, doubts: Sequence[str]) -> Proposal:
        """The same with more doubts, which stand at the top of the scene as well."""
        head, rest = self.files[SCENE].split(b"\n\n", 1)
        scene = b"\n".join([head, *(_doubt(words).encode() for words in doubts)]) + b"\n\n" + rest
        return replace(self, files={**self.files, SCENE: scene}, doubts=(*self.doubts, *doubts))


def propose(paths: Sequence[Path], way: int = 0, because: str = "") -> Proposal:
    """A scene from drawings of parts, or of a whole assembly; `way` (±1) is how the wheel turns, whatever its teeth say.

    NothingToPropose where there is no closed outline, or where outlines have faults that no scene takes.
    """
    sources = read_sources(paths)
    pieces, left_out = _pieces(sources)
    parts = parts_of(sources, pieces)
    apart(parts, [source.crowded for source in sources])
    roles = roles_of(parts)
    size = size_of([source.drawing for source in sources])
    places = side_by_side(roles, len(sources))
    met, others = (named_facings(roles), []) if places else facings(roles, size)
    met = met or named_facings(roles)  # of a layout for cutting
    unlikely = [(facing, "the names of other surfaces of these bodies fit better") for facing in others]
    lean, why = _direction(first_of(roles, WHEEL), {role.task for role in roles}, way, because)
    start = start_of(roles, () if places else met, lean or -1)
    amounts = amounts_of(roles, size, start.swing, met)
    title = ", ".join(path.stem for path in paths)
    copies = drawn(sources, roles)
    plan = Plan(title, sources, copies, roles, met, unlikely, start, amounts, places, lean or -1, why, left_out)
    mended = [words for source in sources for words in source.mended]
    wheel = first_of(roles, WHEEL)
    teeth = None if wheel is None else toothing(wheel.part)
    if wheel is not None and teeth is not None and 2.0 * teeth.outer > LARGE:
        mended.append(f"{wheel.name} is {2.0 * teeth.outer:.3g} m across: look at the units of the drawing")
    pivots = [mark.at for source in sources for mark in source.marks if mark.point and is_mark(mark.layer)]
    while True:
        plan.doubts = [*doubts(roles, plan.facings, bool(places), bool(lean), bool(left_out), pivots), *mended]
        files = {drawing.name: drawing.data for drawing in plan.drawn}
        files[SCENE] = scene_text(plan).encode()
        wrong = _overlapping(files)
        if not wrong:
            break
        kept = [facing for k, facing in enumerate(plan.facings) if k not in wrong]
        gone = [(facing, "they overlap at the start") for k, facing in enumerate(plan.facings) if k in wrong]
        plan = replace(plan, facings=kept, others=[*plan.others, *gone], guesses=[])
    pairs = [facing for facing in plan.facings if facing.first.moves and facing.second.moves and not places]
    meets = any(not facing.by_name_alone or lie_over(facing.first, facing.second) for facing in pairs)
    sides = tuple((plan.side(*facing.sides[0]), plan.side(*facing.sides[1])) for facing in plan.facings)
    either = not way and why == UNKNOWN_WAY
    return Proposal(
        files, tuple(plan.guesses), tuple(roles), sides, tuple(left_out), tuple(plan.doubts), meets, either, plan.direction
    )


def _pieces(sources: Sequence[Source]) -> tuple[list[Piece], list[str]]:
    pieces: list[Piece] = []
    left_out: list[str] = []
    for number, source in enumerate(sources):
        bad = source.bad_layers
        loops = [loop for loop in source.drawing.loops if loop.layer not in bad | source.marking]
        pieces += pieces_of(number, loops, source.crowded)
        left_out += [f"layer {layer} of {source.path.name}: {_fault(source.drawing, layer)}" for layer in sorted(bad)]
    if not pieces:
        raise NothingToPropose(_why_nothing(sources))
    if len(pieces) > MOST_PIECES:
        raise NothingToPropose(
            f"the drawings hold {len(pieces)} separate outlines, more than the {MOST_PIECES} that are looked through. "
            "Leave out layers that are no parts of the mechanism"
        )
    return pieces, left_out


def _fault(drawing: Drawing, layer: str) -> str:
    found = [one.message for one in drawing.findings if one.severity == "error" and one.layer == layer]
    return f"{found[0]}{f' ({len(found) - 1} more)' if len(found) > 1 else ''}. Mend the drawing and begin again"


def _why_nothing(sources: Sequence[Source]) -> str:
    reasons = []
    for source in sources:
        faults = [one.message for one in source.drawing.findings if one.severity == "error"]
        reasons.append(f"{source.path}: {faults[0] if faults else 'it holds no closed outline'}")
    advice = "A scene is made of closed outlines. `watchsim inspect` says what each drawing holds, and where it is open"
    return "\n".join([*reasons, advice])


UNKNOWN_WAY = "clockwise: the drawing does not say which way it is driven"


def _direction(wheel: Role | None, tasks: set[str], tried: int, because: str) -> tuple[int, str]:
    """Which way the wheel is driven, 0 where the drawing does not say, and why: a click lets it turn against its teeth."""
    lean = lean_of(wheel.part) if wheel is not None else 0
    if tried:
        words = "clockwise" if tried < 0 else "counter-clockwise"
        says = "the tips of the teeth lean the other way, but" if lean else "the drawing does not say;"
        return tried, f"{words}: {says} {because}"
    if not lean:
        return 0, UNKNOWN_WAY
    held = CLICK in tasks and OSCILLATOR not in tasks
    way = "clockwise" if (lean < 0) != held else "counter-clockwise"
    if held:
        return -lean, f"{way}: the tips of the teeth lean the other way, which a click should hold; that it does is not shown"
    return lean, f"{way}: the tips of the teeth lean that way"


def _overlapping(files: dict[str, bytes]) -> set[int]:
    """Numbers of the contacts whose outlines overlap at the start."""
    with tempfile.TemporaryDirectory() as folder:
        for name, data in files.items():
            (Path(folder) / name).write_bytes(data)
        try:
            scene: Scene = load(Path(folder) / SCENE)
        except SceneError as error:
            faults = "\n".join(f"{fault.key}: {fault.message.rstrip('.')}" for fault in error.faults)
            raise NothingToPropose(f"the outlines cannot be used as they are drawn\n{faults}") from error
        return {met.contact for met in overlaps(scene)} if scene.contacts else set()
