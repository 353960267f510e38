"""Which arcs follow the curves of a drawing?

All curves at once: thousands of them take little longer than a few.
"""

from __future__ import annotations

from collections.abc import Sequence

from watchsim.drawing.content import Stroke
from watchsim.drawing.curves.ellipse_to_arcs import ellipses_edges
from watchsim.drawing.curves.plane_projection import Gathering, TooLarge, Waiting, cannot_follow
from watchsim.drawing.curves.plane_shapes import Conic, Spline, forward
from watchsim.drawing.curves.spline_copies import SAME, Follower
from watchsim.geometry.fitting.fit import Fit
from watchsim.geometry.primitives import Arc

AT_ONCE = 4096  # curves: then it is looked whether they become too many pieces


def follow(found: Gathering) -> None:
    """Puts the lines and arcs of all waiting curves among the strokes, in the order of the file. May raise TooLarge."""
    waiting, found.waiting = found.waiting, []
    strokes: list[Stroke] = []
    follower = Follower(found.scale)
    taken = 0
    for first in range(0, len(waiting), AT_ONCE):
        chosen = waiting[first : first + AT_ONCE]
        for curve, (fit, fitted) in zip(chosen, _fits(chosen, follower), strict=True):
            strokes += found.strokes[taken : curve.before]
            taken = curve.before
            strokes += [Stroke(edge, curve.layer, curve.source, curve.run) for edge in fit.edges]
            if fitted:
                _count(found, curve, fit)
        if len(strokes) > found.most:
            raise TooLarge
    found.strokes = strokes + found.strokes[taken:]


def _count(found: Gathering, curve: Waiting, fit: Fit) -> None:
    found.curves += curve.curves
    found.arcs += sum(isinstance(edge, Arc) for edge in fit.edges)
    found.deviation = max(found.deviation, fit.deviation + curve.moved)
    if fit.deviation > curve.limit * (1.0 + SAME):
        cannot_follow(found, curve, fit.deviation)


def _fits(waiting: Sequence[Waiting], follower: Follower) -> list[tuple[Fit, bool]]:
    """Lines and arcs for each curve, and whether anything had to be fitted."""
    splines = [(k, curve.shape, curve.limit) for k, curve in enumerate(waiting) if isinstance(curve.shape, Spline)]
    conics = [(k, forward(curve.shape), curve.limit) for k, curve in enumerate(waiting) if isinstance(curve.shape, Conic)]
    result = [(Fit((), 0.0), False)] * len(waiting)
    followed = follower.edges([shape for _, shape, _ in splines], [limit for _, _, limit in splines])
    for (k, _, _), fit in zip(splines, followed, strict=True):
        result[k] = fit
    rounded = ellipses_edges([shape for _, shape, _ in conics], follower.scale, [limit for _, _, limit in conics])
    for (k, _, _), ellipse in zip(conics, rounded, strict=True):
        result[k] = ellipse, True
    return result
