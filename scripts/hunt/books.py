"""Does one run obey mechanics, whatever the right motion is?

Energy is computed here from the rows of the motion and the scene, not taken from the ledger; overlap by shapely; impulses by
`hunt.impulses`.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from hunt.parts import Material, reach
from watchsim.geometry.primitives import TURN, Arc, Edge, Line, Point, moved
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Trajectory

# Which jumps of velocity can contacts make?
#
# Where outlines touch, found here from their edges alone, an impulse pushes along the normal, with friction up to μ times as
# much across. A jump of velocities outside the cone that all such impulses span is no impact, whatever the law.


Array = NDArray[np.float64]

LEANING = 1e-3  # rad: a face that leans less against a normal is flush with it
STRAY = 1e-3  # share of a jump: the directions of two faces that pass for one differ by their turn, with levers of all lengths


class Touches:
    """The contacts of a scene at given coordinates: where outlines come as `near` as that share of the size."""

    def __init__(self, scene: Scene, slices: Mapping[str, slice], masses: Array, near: float) -> None:
        self._scene, self._slices, self._root = scene, slices, np.sqrt(masses)
        self._near = near * reach(scene)

    def unexplained(self, q: Array, jump: Array) -> tuple[float, int]:
        """The share of a jump (m/s, rad/s) that no pushing impulses explain, and the number of touching points."""
        columns = []
        rows = list(self.rows(q))
        for friction, normal, tangent in rows:
            columns += [normal + mu * tangent for mu in {friction, -friction}]
        return self._left(columns, jump), len(rows)

    def turn(self, q: Array, before: Array, jump: Array) -> float:
        """By what angle (rad) a face must turn where a body slides on to it, to make this jump by the force on it.

        A face taken for a smooth continuation also pulls. Infinity where neither push nor pull at one place makes the jump.
        """
        smallest, slip = math.inf, 0.0
        for _, normal, tangent in self.rows(q):
            slip = max(slip, float(abs(tangent @ before)))
            if self._left([normal, -normal], jump) <= STRAY:
                smallest = min(smallest, float(abs(normal @ jump)))
        return smallest / slip if slip > 0.0 else math.inf

    def rows(self, q: Array, apart: bool = False) -> Iterator[tuple[float, Array, Array]]:
        """Friction, and the generalised directions along normal and tangent, (n,) each, of each place where bodies touch.

        Where corners meet, edges that cannot be touched there have normals, too; `apart`: only those that part the bodies.
        """
        placed = {body.name: self._placed(body, q) for body in self._scene.bodies}
        for contact in self._scene.contacts:
            a, b = (self._scene.body(side.body) for side in contact.sides)
            for at, (nx, ny) in touching(placed[a.name], placed[b.name], self._near):
                sides = ((placed[a.name], (nx, ny)), (placed[b.name], (-nx, -ny)))
                if apart and not all(_beyond(edges, at, outward, self._near) for edges, outward in sides):
                    continue
                normal, tangent = (self._column(a, q, at, e) - self._column(b, q, at, e) for e in ((nx, ny), (-ny, nx)))
                yield contact.friction, normal, tangent

    def _left(self, columns: list[Array], jump: Array) -> float:
        """The share of a jump that no sum of these impulses with factors of at least zero makes."""
        wanted = self._root * jump
        length = float(np.linalg.norm(wanted))
        if not columns or length == 0.0:
            return float(length > 0.0)
        matrix = np.array(columns).T / self._root[:, None]
        scales = np.linalg.norm(matrix, axis=0)
        matrix = matrix[:, scales > 0.0] / scales[scales > 0.0]
        if not matrix.shape[1]:
            return 1.0
        return float(nnls(matrix, wanted / length, maxiter=50 * matrix.shape[1] + 100)[1])

    def gap_rates(self, q: Array, u: Array, pair: tuple[str, str]) -> list[tuple[Point, float]]:
        """Normal and opening rate (m/s) of each place where two bodies touch."""
        a, b = (self._scene.body(name) for name in pair)
        found = touching(self._placed(a, q), self._placed(b, q), self._near)
        return [(normal, float((self._column(a, q, at, normal) - self._column(b, q, at, normal)) @ u)) for at, normal in found]

    def _placed(self, body: Body, q: Array) -> list[Edge]:
        x, y, angle = _pose(body, q[self._slices.get(body.name, slice(0, 0))])
        return [moved(edge, angle, (x, y)) for loop in body.loops for edge in loop.edges]

    def _column(self, body: Body, q: Array, point: Point, push: Point) -> Array:
        """The generalised impulse of a push on a body."""
        out = np.zeros(len(q))
        if body.motion == "fixed":
            return out
        own = self._slices[body.name]
        x, y, _ = _pose(body, q[own])
        turn = (point[0] - x) * push[1] - (point[1] - y) * push[0]
        if body.motion == "slide":
            out[own] = push[0] * body.axis[0] + push[1] * body.axis[1]
        else:
            out[own] = (turn,) if body.motion == "pivot" else (*push, turn)
        return out


def _pose(body: Body, own: Array) -> tuple[float, float, float]:
    x, y = body.position
    if body.motion == "free":
        return float(own[0]), float(own[1]), float(own[2])
    if body.motion == "slide":
        return x + float(own[0]) * body.axis[0], y + float(own[0]) * body.axis[1], body.angle
    return x, y, float(own[0]) if body.motion == "pivot" else body.angle


def touching(first: list[Edge], second: list[Edge], near: float) -> Iterator[tuple[Point, Point]]:
    """Points where two outlines come within `near`, with the normal that points from the second to the first."""
    boxes_a, boxes_b = _boxes(first, near), _boxes(second, near)
    low = np.maximum(boxes_a[:, None, :2], boxes_b[None, :, :2])
    high = np.minimum(boxes_a[:, None, 2:], boxes_b[None, :, 2:])
    for i, j in np.argwhere((low <= high).all(axis=2)):
        a, b = first[i], second[j]
        for corner in (a.start, a.end):
            if normal := _at(b, corner, near):
                yield corner, normal
        for corner in (b.start, b.end):
            if normal := _at(a, corner, near):
                yield corner, (-normal[0], -normal[1])
        yield from _round(a, b, near)


def _beyond(edges: list[Edge], point: Point, normal: Point, near: float) -> bool:
    """Do all edges that end at a point lead away from it to the side to which the normal points?"""
    ways = [(edge.start, edge.tangent(0.0), 1.0) for edge in edges] + [(edge.end, edge.tangent(1.0), -1.0) for edge in edges]
    return all(
        way * (tx * normal[0] + ty * normal[1]) >= -LEANING
        for (x, y), (tx, ty), way in ways
        if math.hypot(x - point[0], y - point[1]) <= near
    )


def _boxes(edges: list[Edge], near: float) -> Array:
    rows = []
    for edge in edges:
        points = [edge.point(f / 8.0) for f in range(9)] if isinstance(edge, Arc) else [edge.start, edge.end]
        # A chord of an eighth of an arc hides at most its sagitta.
        slack = near + (edge.radius * (1.0 - math.cos(edge.sweep / 16.0)) if isinstance(edge, Arc) else 0.0)
        x, y = zip(*points, strict=True)
        rows.append((min(x) - slack, min(y) - slack, max(x) + slack, max(y) + slack))
    return np.array(rows)


def _at(edge: Edge, point: Point, near: float) -> Point | None:
    """The outward normal of an edge at a point on it; None where the point is not on it."""
    if isinstance(edge, Line):
        tx, ty = edge.tangent(0.0)
        dx, dy = point[0] - edge.x0, point[1] - edge.y0
        along = tx * dx + ty * dy
        on = -near <= along <= edge.length + near and abs(tx * dy - ty * dx) <= near
        return (ty, -tx) if on else None
    dx, dy = point[0] - edge.x, point[1] - edge.y
    far = math.hypot(dx, dy)
    if abs(far - edge.radius) > near or far == 0.0 or not _within(edge, (dx / far, dy / far), near):
        return None
    side = math.copysign(1.0, edge.sweep)
    return side * dx / far, side * dy / far


def _within(arc: Arc, direction: Point, near: float) -> bool:
    way = math.copysign(1.0, arc.sweep)
    turn = (way * (math.atan2(direction[1], direction[0]) - arc.start_angle)) % TURN
    slack = near / arc.radius
    return turn <= abs(arc.sweep) + slack or turn >= TURN - slack


def _round(a: Edge, b: Edge, near: float) -> Iterator[tuple[Point, Point]]:
    """Where the inside of an arc touches the inside of another edge."""
    directions: list[Point]
    if isinstance(a, Arc) and isinstance(b, Arc):
        dx, dy = a.x - b.x, a.y - b.y
        far = math.hypot(dx, dy)
        directions = [(dx / far, dy / far), (-dx / far, -dy / far)] if far > 0.0 else []
    elif isinstance(a, Arc) or isinstance(b, Arc):
        tx, ty = (b if isinstance(a, Arc) else a).tangent(0.0)
        directions = [(ty, -tx), (-ty, tx)]
    else:
        return
    arc, other = (a, b) if isinstance(a, Arc) else (b, a)
    assert isinstance(arc, Arc)
    for e in directions:
        point = (arc.x + arc.radius * e[0], arc.y + arc.radius * e[1])
        normal = _at(other, point, near)
        if normal and _within(arc, e, near):
            yield point, normal if arc is a else (-normal[0], -normal[1])


RESIDUAL = 1e-6  # of the energy turned over, at tolerances up to 1e-8
OVERLAP = 2e-5  # of the size: what counts as material inside material, at tolerances up to 1e-8
JUMP = (
    3e-5  # of the largest speed, in the metric of the masses: joints up to 1e-5 rad are handed over as tangent, without impact
)
NEAR = 1e-6  # of the size: outlines this close touch
ONWARD = 1e-4  # of the size: bodies that turn this far part by its square, less than `NEAR`
OUTSIDE = 1e-3  # share of a jump that no impulses of the contacts explain
AUDITED = 6  # jumps of a run
LOOKS = 8  # for overlap, evenly spread over the run
SHIFT = 1e3  # tolerances of the size: drift of one tolerance, between faces at the smallest angle that is corrected, 1e-3
OPPOSED = 1e-13  # rounding of forces that cancel, as a share of what they would give without each other
MANY = 20_000  # events
NESTED = 10.0  # times the square of the rebounds until a contact rests: bodies that rattle on what rattles itself
AT_REST = 1e-6  # of the first rebound's speed
SUDDEN = (EventKind.IMPACT, EventKind.ACCUMULATION, EventKind.JAM)


def faults(run: Trajectory, material: Material) -> Iterator[str]:
    """What is wrong with the run by itself, a phrase each: the first word names the class."""
    if run.stop.gave_up or run.stop == Stop.INTERRUPTED:
        yield f"{'hanging' if run.stop == Stop.INTERRUPTED else 'gave up'}: {run.stop.name} at t = {run.simulated:.6g} s"
    if len(run.t) == 0:
        return
    loose = max(1.0, run.tolerance / 1e-8)
    scene, m = run.scene, masses(run.scene)
    kinetic = 0.5 * (run.u**2) @ m
    turned_over = max(float(kinetic.max()), abs(run.energy["in_J"]), sum(run.energy["dissipated"].values()))
    turned_over = max(turned_over, abs(run.energy["stored_J"]))
    residual = abs(run.energy["residual_J"])
    allowed = RESIDUAL * loose * turned_over + OPPOSED * unopposed(scene, run.simulated)
    allowed += of_a_step(scene, run.tolerance, float(kinetic.max()))
    if turned_over > 0.0 and residual > allowed:
        yield f"residual: {residual / turned_over:.1e} of the energy turned over"
    yield from _rise(run, kinetic + potential(scene, run), allowed, turned_over)
    if len(run.events) > most_events(run.scene):
        yield f"events: {len(run.events)}"
    deep, when = _overlap(run, material)
    if deep > OVERLAP * loose * material.size:
        share, told = deep / material.size, run.worst_penetration / material.size
        yield f"overlap: {share:.1e} of the size at t = {when:.6g} s, reported {told:.1e}"
    yield from _shifts(run, SHIFT * max(run.tolerance, 1e-9) * material.size)
    yield from _jumps(run, m, float(kinetic.max()), loose)


def most_events(scene: Scene) -> float:
    """More are wrong. What loses nothing, or stands on it, may go on bouncing, however low; what loses little bounces long."""
    restitution = max((contact.restitution for contact in scene.contacts), default=0.0)
    if restitution in (0.0, 1.0):
        return math.inf if restitution else MANY
    return max(MANY, NESTED * (math.log(AT_REST) / math.log(restitution)) ** 2)


def _rise(run: Trajectory, total: Array, allowed: float, scale: float) -> Iterator[str]:
    """Energy with that of the drives never grows."""
    rise = total - np.minimum.accumulate(total)
    worst = int(np.argmax(rise))
    if rise[worst] > allowed:
        yield f"energy: rises by {rise[worst] / scale:.1e} of what is turned over, until t = {run.t[worst]:.6g} s"


def _overlap(run: Trajectory, material: Material) -> tuple[float, float]:
    times = np.linspace(0.0, run.simulated, LOOKS + 1)[1:]
    q, _ = run.sample(times)
    deepest, when = 0.0, 0.0
    for t, row in zip(times, q, strict=True):
        depth = material.depth({body.name: run.pose_of(body.name, row) for body in run.scene.bodies})
        if depth > deepest:
            deepest, when = depth, float(t)
    return deepest, when


def _shifts(run: Trajectory, allowed: float) -> Iterator[str]:
    """Bodies are where they were: positions do not jump. Angles count with the body's reach."""
    jump = np.abs(np.diff(run.q, axis=0))[np.diff(run.t) == 0.0]
    if len(jump):
        worst = int(np.argmax(jump.max(axis=1)))
        far = float((jump[worst] * _lengths(run.scene)).max())
        if far > allowed:
            t = run.t[:-1][np.diff(run.t) == 0.0][worst]
            yield f"shift: coordinates jump by {far:.1e} m at t = {t:.9g} s"


def _lengths(scene: Scene) -> Array:
    """(n,): what makes lengths of coordinates."""
    found: list[float] = []
    for body in scene.bodies:
        own = 0.0 if body.motion == "fixed" else reach(replace(scene, bodies=(body,)))
        found += {"fixed": [], "pivot": [own], "slide": [1.0], "free": [1.0, 1.0, own]}[body.motion]
    return np.array(found)


def _held(run: Trajectory, events: NDArray[Any], row: int, m: Array) -> Iterator[Array]:
    """What contact forces will do while impacts end by rule, which such an end has taken back; nothing at all comes first.

    The rule (method, 2.9) sets the velocities such that the motion is right at the end of that time T: the contacts make
    the jump and what their forces do within T.
    """
    yield np.zeros(len(m))
    ends = events["value"][events["kind"] == EventKind.ACCUMULATION]
    if len(ends):
        yield (run.a[row] - pulls(run.scene, run, row) / m) * float(ends.max() - run.t[row])


def _onward(run: Trajectory, row: int) -> Array:
    """(n,): where the motion before a jam leads to within `ONWARD` of the size.

    On the line of centres the two ends of a cone are parallel. What locks there is found from the cones that open behind it.
    """
    way: Array = run.u[row] * (ONWARD * reach(run.scene) / float(np.abs(run.u[row] * _lengths(run.scene)).max()))
    return run.q[row] + way


def _jumps(run: Trajectory, m: Array, largest: float, loose: float) -> Iterator[str]:
    """Each jump of velocity must come from impulses that push, within the cones of friction, where outlines touch."""
    first = np.flatnonzero((np.diff(run.t) == 0.0) & np.append(True, np.diff(run.t)[:-1] > 0.0))
    if not len(first):
        return
    last = np.searchsorted(run.t, run.t[first], side="right") - 1
    size = 0.5 * ((run.u[last] - run.u[first]) ** 2) @ m
    touches = None
    for k in np.argsort(-size)[:AUDITED]:
        if size[k] <= JUMP**2 * largest:
            return
        row, then = int(first[k]), int(last[k])
        t, jump = run.t[row], run.u[then] - run.u[row]
        here = run.events[run.events["t"] == t]
        touches = touches or Touches(run.scene, run.slices, m, NEAR * loose)
        if not np.isin(here["kind"], SUDDEN).any():
            if touches.turn(run.q[then], run.u[row], jump) <= JUMP:
                continue
            yield f"jump: without an impact at t = {t:.9g} s, of {math.sqrt(size[k] / largest):.1e} of the speed"
            return
        found = [touches.unexplained(run.q[then], jump + held) for held in _held(run, here, then, m)]
        if (here["kind"] == EventKind.JAM).any():
            found.append(touches.unexplained(_onward(run, row), jump))
        share, points = min(found)
        part = math.sqrt(size[k] / largest)
        if share > OUTSIDE and share * part > JUMP * loose:
            yield (
                f"impulse: {share:.1e} of a jump of {part:.1e} of the speed at t = {t:.9g} s lies outside the cones of "
                f"{points} contacts"
            )
            return


# What do the forces of a scene give its bodies? Computed from the scene and the rows of a run, not taken from the ledger.


def masses(scene: Scene) -> Array:
    """(n,): of each coordinate."""
    each = {"fixed": lambda b: (), "pivot": lambda b: (b.inertia,), "slide": lambda b: (b.mass,)}
    each["free"] = lambda b: (b.mass, b.mass, b.inertia)
    return np.array([m for body in scene.bodies for m in each[body.motion](body)])


def potential(scene: Scene, run: Trajectory) -> Array:
    """(rows,): of springs, constant drives and gravity, J."""
    found = np.zeros(len(run.t))
    for spring in scene.springs:
        q = run.q[:, run.slices[spring.body].start]
        found += 0.5 * spring.stiffness * (q - spring.rest) ** 2
    for torque in scene.torques:
        q = run.q[:, run.slices[torque.body].start]
        found -= torque.value * (q - q[0])
    gx, gy = scene.gravity
    for body in scene.bodies if gx or gy else ():
        if body.motion == "fixed":
            continue
        q = run.q[:, run.slices[body.name]]
        if body.motion == "pivot":
            (x, y), c, s = body.centre_of_mass, np.cos(q[:, 0]), np.sin(q[:, 0])
            found -= body.mass * (gx * (c * x - s * y) + gy * (s * x + c * y))
        elif body.motion == "slide":
            found -= body.mass * q[:, 0] * (gx * body.axis[0] + gy * body.axis[1])
        else:
            found -= body.mass * (gx * q[:, 0] + gy * q[:, 1])
    return found


def pulls(scene: Scene, run: Trajectory, row: int) -> Array:
    """(n,): forces of springs, constant drives and gravity at a row, the slope of `potential`, N or N·m."""
    found = np.zeros(run.q.shape[1])
    for spring in scene.springs:
        k = run.slices[spring.body].start
        found[k] -= spring.stiffness * (run.q[row, k] - spring.rest)
    for torque in scene.torques:
        found[run.slices[torque.body].start] += torque.value
    gx, gy = scene.gravity
    for body in scene.bodies:
        if body.motion == "pivot":
            k = run.slices[body.name].start
            (x, y), c, s = body.centre_of_mass, math.cos(run.q[row, k]), math.sin(run.q[row, k])
            found[k] += body.mass * (gy * (c * x - s * y) - gx * (s * x + c * y))
        elif body.motion == "slide":
            found[run.slices[body.name].start] += body.mass * (gx * body.axis[0] + gy * body.axis[1])
        elif body.motion == "free":
            found[run.slices[body.name]] += (body.mass * gx, body.mass * gy, 0.0)
    return found


def unopposed(scene: Scene, time: float) -> float:
    """What weights and constant drives would give the bodies if nothing held them, J.

    Blocks that creep down a slope of 1e-5 turn over 1e-11 J, while the floor holds off 0.1 J of weight, to rounding.
    """
    loads = {torque.body: abs(torque.value) for torque in scene.torques}
    g, found = math.hypot(*scene.gravity), 0.0
    for body in scene.bodies:
        if body.motion == "pivot":
            arm = math.hypot(*body.centre_of_mass)
            found += 0.5 * (loads.get(body.name, 0.0) + body.mass * g * arm) ** 2 / body.inertia * time**2
        elif body.motion != "fixed":
            found += 0.5 * (loads.get(body.name, 0.0) + body.mass * g) ** 2 / body.mass * time**2
    return found


def of_a_step(scene: Scene, tolerance: float, kinetic: float) -> float:
    """What errors of one step do to the energy where forces are large against the motion, J.

    The tolerance is a share of the size L (of one radian) and of the speed that a force F gives over it, sqrt(F L / m). Of
    positions it makes F L, of velocities at a kinetic energy T the share sqrt(2 T F L).
    """
    size, found = reach(scene), 0.0
    lengths = {body.name: 1.0 if body.motion == "pivot" else size for body in scene.bodies}
    work = [abs(torque.value) * lengths[torque.body] for torque in scene.torques]
    for body in scene.bodies:
        if body.motion != "fixed":
            arm = math.hypot(*body.centre_of_mass) if body.motion == "pivot" else size
            work.append(body.mass * math.hypot(*scene.gravity) * arm)
    for given in work:
        found += given + math.sqrt(2.0 * kinetic * given)
    return tolerance * found
