"""Which scene do these drawings suggest?

What is found is tried as a scene: contacts that would overlap at the start are taken out again, so that it loads.
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from watchsim.drawing.drawing import Drawing
from watchsim.mechanism.overlap import overlaps
from watchsim.proposal.amounts import amounts_of
from watchsim.proposal.bodies.grouped_pieces import parts_of
from watchsim.proposal.bodies.layers import apart
from watchsim.proposal.bodies.part_names import CLICK, OSCILLATOR, WHEEL
from watchsim.proposal.bodies.part_roles import Role, roles_of
from watchsim.proposal.bodies.piece import Piece, pieces_of
from watchsim.proposal.bodies.source import Source, is_mark, read_source, size_of
from watchsim.proposal.bodies.teeth_direction import lean_of
from watchsim.proposal.facing import Facing, facings, named_facings
from watchsim.proposal.proposed_scene import Guess, Plan, scene_text
from watchsim.proposal.side_by_side import side_by_side
from watchsim.proposal.sorted_drawings import drawn
from watchsim.proposal.start import start_of
from watchsim.scene.errors import SceneError
from watchsim.scene.file.load import load
from watchsim.scene.scene import Scene

SCENE = "scene.toml"
MOST_PIECES = 2000  # more is a picture, not a mechanism


class NothingToPropose(ValueError):
    """The drawings hold nothing that could move; the text says why."""


@dataclass(frozen=True)
class Proposal:
    """Files of the scene by name, and what was guessed. `roles` and `contacts` are in the order of the scene."""

    files: dict[str, bytes]
    guesses: tuple[Guess, ...]
    roles: tuple[Role, ...]
    contacts: tuple[tuple[str, str], ...]
    left_out: tuple[str, ...]


def propose(paths: Sequence[Path]) -> Proposal:
    """A scene from drawings of parts, or of a whole assembly.

    NothingToPropose where there is no closed outline, or where outlines have faults that no scene takes.
    """
    sources = [read_source(path) for path in paths]
    pieces, left_out = _pieces(sources)
    parts = parts_of(sources, pieces)
    apart(parts, [source.crowded for source in sources])
    roles = roles_of(parts)
    size = size_of([source.drawing for source in sources])
    places = side_by_side(roles, len(sources))
    met, others = _facings(roles, size, bool(places))
    unlikely = [(facing, "the names of other surfaces of these bodies fit better") for facing in others]
    plan = _plan(paths, sources, roles, met, unlikely, size, places, left_out)
    while True:
        files = {drawing.name: drawing.data for drawing in plan.drawn}
        files["scene.toml"] = scene_text(plan).encode()
        wrong = _overlapping(files)
        if not wrong:
            break
        kept = [facing for k, facing in enumerate(plan.facings) if k not in wrong]
        gone = [(facing, "they overlap at the start") for k, facing in enumerate(plan.facings) if k in wrong]
        plan = replace(plan, facings=kept, others=[*plan.others, *gone], guesses=[])
    sides = tuple((plan.side(f.first, f.first_layer), plan.side(f.second, f.second_layer)) for f in plan.facings)
    return Proposal(files, tuple(plan.guesses), tuple(roles), sides, tuple(left_out))


def _pieces(sources: Sequence[Source]) -> tuple[list[Piece], list[str]]:
    pieces: list[Piece] = []
    left_out: list[str] = []
    for number, source in enumerate(sources):
        bad = source.bad_layers
        loops = [loop for loop in source.drawing.loops if loop.layer not in bad and not is_mark(loop.layer)]
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
    return f"{found[0]}{f' ({len(found) - 1} more)' if len(found) > 1 else ''}"


def _why_nothing(sources: Sequence[Source]) -> str:
    told = []
    for source in sources:
        faults = [one.message for one in source.drawing.findings if one.severity == "error"]
        told.append(f"{source.path}: {faults[0] if faults else 'it holds no closed outline'}")
    return "\n".join(
        [*told, "A scene is made of closed outlines. `watchsim inspect` says what each drawing holds, and where it is open"]
    )


def _facings(roles: Sequence[Role], size: float, apart: bool) -> tuple[list[Facing], list[Facing]]:
    return (named_facings(roles), []) if apart else facings(roles, size)


def _plan(
    paths: Sequence[Path],
    sources: Sequence[Source],
    roles: Sequence[Role],
    met: Sequence[Facing],
    unlikely: Sequence[tuple[Facing, str]],
    size: float,
    places: dict[str, tuple[float, float]],
    left_out: Sequence[str],
) -> Plan:
    wheel = next((role for role in roles if role.task == WHEEL), None)
    lean, why = _direction(wheel, {role.task for role in roles})
    start = start_of(roles, () if places else met, lean or -1)
    amounts = amounts_of(roles, size, start.swing)
    title = paths[0].stem if len(paths) == 1 else ", ".join(path.stem for path in paths)
    return Plan(title, sources, drawn(sources, roles), roles, met, unlikely, start, amounts, places, lean or -1, why, left_out)


def _direction(wheel: Role | None, tasks: set[str]) -> tuple[int, str]:
    """Which way the wheel is driven, 0 where the drawing does not say, and why: a click lets it turn against its teeth."""
    lean = lean_of(wheel.part) if wheel is not None else 0
    if not lean:
        return 0, "clockwise: the drawing does not say which way it is driven"
    held = CLICK in tasks and OSCILLATOR not in tasks
    way = "clockwise" if (lean < 0) != held else "counter-clockwise"
    if held:
        return -lean, f"{way}: the click slides over the backs of the teeth, whose tips lean the other way; that way it holds"
    return lean, f"{way}: the tips of the teeth lean that way"


def _overlapping(files: dict[str, bytes]) -> set[int]:
    """Numbers of the contacts whose outlines overlap at the start."""
    with tempfile.TemporaryDirectory() as folder:
        for name, data in files.items():
            (Path(folder) / name).write_bytes(data)
        try:
            scene: Scene = load(Path(folder) / SCENE)
        except SceneError as error:
            told = "\n".join(f"{fault.key}: {fault.message}" for fault in error.faults)
            raise NothingToPropose(f"the outlines cannot be used as they are drawn\n{told}") from error
        return {met.contact for met in overlaps(scene)} if scene.contacts else set()
