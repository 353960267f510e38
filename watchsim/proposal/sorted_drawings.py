"""Which drawings does the scene need, and on which layers of them do the bodies lie?

The drawing as it is, where every layer belongs to one body; else a copy of its outlines in which it does.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from watchsim.drawing.dxf.write_dxf import dxf_text
from watchsim.proposal.roles import Role
from watchsim.proposal.source import Source
from watchsim.proposal.words import tokens

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
        owners = Counter(layer for role in own for layer in role.part.layers)
        if source.blocks or any(count > 1 for count in owners.values()):
            found.append(_sorted(f"{prefix}{source.path.stem}_sorted.dxf", own))
        else:
            layers = {(role.name, layer): layer for role in own for layer in role.part.layers}
            found.append(Drawn(prefix + source.path.name, source.drawing.data, False, layers))
    return found


def _sorted(name: str, roles: Sequence[Role]) -> Drawn:
    layers: dict[tuple[str, str], str] = {}
    loops, points = [], []
    for role in roles:
        plain = role.name.upper()
        for layer in role.part.layers:
            layers[role.name, layer] = f"{plain}_{layer.strip()}" if tokens(layer) and len(role.part.layers) > 1 else plain
        loops += [replace(loop, layer=layers[role.name, piece.layer]) for piece in role.part.pieces for loop in piece.loops]
        if role.moves and role.part.centre is not None:
            points.append((f"{plain}_{PIVOT}", role.part.centre.at))
    return Drawn(name, dxf_text(loops, points).encode(), True, layers)
