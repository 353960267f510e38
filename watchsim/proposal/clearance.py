"""How far apart is what can meet, at given angles of the bodies?"""

from __future__ import annotations

import math
from collections.abc import Sequence

from watchsim.mechanism.material_polygons import material
from watchsim.proposal.bodies.part_roles import Role
from watchsim.proposal.bodies.piece import Piece, Region
from watchsim.proposal.facing import Facing, about


def overlaps(facings: Sequence[Facing], angles: dict[str, float]) -> bool:
    return clearance(facings, angles) <= 0.0


def clearance(facings: Sequence[Facing], angles: dict[str, float]) -> float:
    """The least distance of what can meet, m; 0 where something overlaps."""
    least = math.inf
    for facing in facings:
        first = [
            _turned(facing.first, piece, angles) for piece in facing.first.part.pieces if piece.layer == facing.first_layer
        ]
        second = [
            _turned(facing.second, piece, angles) for piece in facing.second.part.pieces if piece.layer == facing.second_layer
        ]
        least = min([least, *(float(p.distance(q)) for p in first for q in second)])
        if least <= 0.0:
            break
    return least


def _turned(role: Role, piece: Piece, angles: dict[str, float]) -> Region:
    angle = angles.get(role.name, 0.0)
    if angle == 0.0 or role.part.centre is None:
        return piece.region
    parts = material([(about(points, role.part.centre.at, angle), hole) for points, hole in piece.rings])
    whole = parts[0]
    for part in parts[1:]:
        whole = whole.union(part)
    return whole
