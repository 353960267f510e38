"""Where do parts go that were drawn each by itself, so that none lies on another?"""

from __future__ import annotations

import math
from collections.abc import Sequence

from watchsim.proposal.bodies.part_roles import Role

OVER = 0.3  # of the smaller area: parts of two files that share more were not drawn where they belong
SAME = 2e-6  # m, of pivots
ROOM = 1.2  # times their width


def side_by_side(roles: Sequence[Role], files: int) -> dict[str, tuple[float, float]]:
    """Positions (m) in a row by name; none where the drawings show the parts where they belong, or are one.

    What stands still keeps its place against the first part, whose pivot is often the origin of the movement.
    """
    if files < 2 or not _on_top_of_each_other(roles):
        return {}
    places = {role.name: (0.0, 0.0) for role in roles if not role.moves}
    x = 0.0
    for role in (role for role in roles if role.moves):
        at = role.part.centre.at if role.moves and role.part.centre is not None else (0.0, 0.0)
        around = [math.dist(at, (px, py)) for piece in role.part.pieces for px, py in piece.points.tolist()]
        reach = ROOM * max(around)
        x = x + reach if any(other.moves and other.name in places for other in roles) else 0.0
        places[role.name] = (round(x, 4), 0.0)
        x += reach
    return places


def _on_top_of_each_other(roles: Sequence[Role]) -> bool:
    for k, one in enumerate(roles):
        for other in roles[k + 1 :]:
            if one.part.file == other.part.file:
                continue
            centres = one.part.centre, other.part.centre
            if centres[0] is not None and centres[1] is not None and math.dist(centres[0].at, centres[1].at) <= SAME:
                return True
            shared = max(
                p.region.intersection(q.region).area / min(p.area, q.area) for p in one.part.pieces for q in other.part.pieces
            )
            if shared > OVER:
                return True
    return False
