"""From which gap on does a contact close, where faces too flat to count have let one body sink into the other?

Where two bodies move past each other in one direction only, faces that lie along it take no part in the motion
(events/immovable.py), and what they rise the bodies sink in. The next face, which may rise more, is then met at its joint with
a gap that is already negative. It closes there as it would with a gap of zero (docs/theory/method.md 2.6). Faces met so have
a concave joint: past a convex one the next face falls away.
"""

from __future__ import annotations

from watchsim.contact.kinematics import contact_kinematics
from watchsim.contact.poses import point_of
from watchsim.jit import kernel
from watchsim.model.records import LINE
from watchsim.simulation.events.immovable import has_one_way
from watchsim.tolerances import NEAR_POINTS


@kernel
def sunk_level(model, options, k, gap, inside_b, path):
    """The gap of contact k if it counts as sunk in by that, else 0. `inside_b`: how far it is inside B's primitive, m.

    Its bodies must stand in `path` where it has this gap.
    """
    if gap >= -options.behind or gap < -options.sunk or inside_b > NEAR_POINTS * options.extent:
        return 0.0
    if not _by_concave_joint(model, k, path.pose):
        return 0.0
    contact_kinematics(model, k, path.pose, 0, path.probe)
    return gap if has_one_way(model, path.probe, 0, options.sunk) else 0.0


@kernel
def _by_concave_joint(model, k, pose):
    """True if the nearer end of B's line is no convex joint; of an arc, if either end is none."""
    contact = model.contacts[k]
    a, b = model.primitives[contact.a], model.primitives[contact.b]
    if b.kind != LINE:
        return b.before < 0 or b.after < 0
    pa, pb = pose[a.body], pose[b.body]
    ax, ay = point_of(pa, a.x, a.y)
    bx, by = point_of(pb, b.x + 0.5 * b.length * b.tx, b.y + 0.5 * b.length * b.ty)
    mx, my = point_of(pb, b.x, b.y)
    beyond = (pa.x + ax - pb.x - bx) * (bx - mx) + (pa.y + ay - pb.y - by) * (by - my) > 0.0
    return (b.after if beyond else b.before) < 0
