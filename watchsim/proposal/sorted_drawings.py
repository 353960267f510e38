"""Which drawings does the scene need, and on which layers of them do the bodies lie?

The drawing as it is, where every layer belongs to one body; else a copy of its outlines in which it does.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from watchsim.drawing.dxf.write_dxf import dxf_text
from watchsim.proposal.bodies.layers import plain
from watchsim.proposal.bodies.part_names import tokens
from watchsim.proposal.bodies.part_roles import Role
from watchsim.proposal.bodies.source import Source

PIVOT = "PIVOT"


@dataclass(frozen=True)
class Drawn:
    """A drawing of the scene: its name and bytes; `layers` gives, by body and layer of the original, the layer there."""

    name: str
    data: bytes
    is_sorted: bool
    layers: dict[tuple[str, str], str]


def drawn(sources: Sequence[Source], roles: Sequence[Role]) -> list[Drawn]:
    """One drawing for each source; names are those of the files, which may come from different folders."""
    stems = Counter(source.path.name.casefold() for source in sources)
    found = []
    for number, source in enumerate(sources):
        own = [role for role in roles if role.part.file == number]
        prefix = f"{number + 1}_" if stems[source.path.name.casefold()] > 1 else ""
        if source.blocks or any(plain(layer)[1] for role in own for layer in role.part.layers):
            found.append(_sorted(f"{prefix}{source.path.stem}_sorted.dxf", own))
        else:
            layers = {(role.name, layer): layer for role in own for layer in role.part.layers}
            found.append(Drawn(prefix + source.path.name, source.drawing.data, False, layers))
    return found


def _sorted(name: str, roles: Sequence[Role]) -> Drawn:
    layers: dict[tuple[str, str], str] = {}
    loops, points = [], []
    for role in roles:
        own = role.name.upper()
        for layer in role.part.layers:
            layers[role.name, layer] = _layer_name(own, layer, len(role.part.layers))
        loops += [replace(loop, layer=layers[role.name, piece.layer]) for piece in role.part.pieces for loop in piece.loops]
        if role.moves and role.part.centre is not None:
            points.append((f"{own}_{PIVOT}", role.part.centre.at))
    return Drawn(name, dxf_text(loops, points).encode(), True, layers)


def _layer_name(body: str, layer: str, count: int) -> str:
    """BODY where it has only one, else BODY_LAYER, with a number where the layer was taken apart."""
    if count == 1:
        return body
    name, number = plain(layer)
    words = [
        body,
        *([name.strip()] if tokens(name) else []),
        *([number] if number and (number != "1" or not tokens(name)) else []),
    ]
    return "_".join(words)
