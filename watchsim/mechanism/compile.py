"""How does a scene become a model?

Bodies, forces and declared contacts are flattened once into the record arrays the kernels read. Only outlines named in
a contact enter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from watchsim.candidates.cell_frame import angle_of, choose_frames
from watchsim.candidates.cell_grid import choose_cells
from watchsim.mechanism.backlash import with_racks
from watchsim.mechanism.contact_features import features
from watchsim.mechanism.coordinates import forced_coordinates
from watchsim.mechanism.declared_pairs import declared_contacts, near_contacts
from watchsim.model.records import BODY, MOTION_CODE, PRIMITIVE, Model, Records, frozen, records
from watchsim.scene.body import Body
from watchsim.scene.carriers import Ride, rides
from watchsim.scene.force import Side
from watchsim.scene.gear_trains import Bond, bonds
from watchsim.scene.scene import Scene
from watchsim.tolerances import CLEARANCE


@dataclass(frozen=True)
class Compiled:
    """The model with what people need to read it."""

    model: Model
    layers: tuple[str, ...]  # of each primitive
    owners: tuple[str, ...]  # the body of the scene that each primitive was drawn for
    slices: dict[str, slice]  # coordinates of each body
    size: float  # m, the reach of the largest moving body
    q: np.ndarray
    u: np.ndarray
    fastest: float  # 1/s, largest natural frequency of a spring, 0 without springs
    against: tuple[tuple[int, int, float], ...] = ()  # coordinates given relative to a carrier: (own, carrier's or -1, angle)
    geared: tuple[tuple[int, float, float], ...] = ()  # further columns: `told` times that coordinate plus `shift`

    def relative(self, q: np.ndarray, rates: bool = False) -> np.ndarray:
        """Rows of coordinates, or of their `rates`, as the scene gives them: carried bodies relative to their carriers.

        Behind them stand columns of the bodies geared to others, which have no coordinate of their own.
        """
        out = np.array(q) if self.against else q
        for own, on, angle in self.against:
            out[:, own] -= (q[:, on] if on >= 0 else 0.0) + (0.0 if rates else angle)
        if self.geared:
            out = np.column_stack((out, *(told * out[:, to] + (0.0 if rates else shift) for to, told, shift in self.geared)))
        return out

    def own(self, number: int, values: np.ndarray, rates: bool = False) -> np.ndarray:
        """(rows,): the angle in the movement, or the travel, of the body of that number; `values` are rows of coordinates, or
        of their `rates`."""
        body = self.model.bodies[number]
        return np.asarray(body.ratio * values[:, body.first] + (0.0 if rates else body.phase))


_last: dict[bool, tuple[Scene, Compiled]] = {}  # by `prefilter`: the scene asked about last, which most often is the next one


def compile_scene(scene: Scene, prefilter: bool = True) -> Compiled:
    """Flatten a checked scene (SI units), into arrays that nobody writes to. Coordinates follow the order of the bodies.

    Without `prefilter` every declared pair of primitives is a candidate everywhere.
    """
    known = _last.get(prefilter)
    if known is None or known[0] is not scene:
        known = _last[prefilter] = scene, _compiled(scene, prefilter)
    return known[1]


def _compiled(scene: Scene, prefilter: bool) -> Compiled:
    size = scene_size(scene)
    scene, named = with_racks(scene, size)
    hung = rides(scene.bodies)
    bound = bonds(scene.bodies, hung)
    bodies, q, u = _bodies(scene, hung, bound)
    slices = _slices(scene, bodies)
    primitives, layers, owners, sides = _primitives(scene, hung, size)
    owners = tuple(named.get(owner, owner) for owner in owners)
    contacts, laws, pairs = declared_contacts(scene, hung, sides, primitives)
    forced = forced_coordinates(scene, hung, bound, slices, size)
    pairs.clearance = CLEARANCE * size
    choose_frames(bodies, pairs)
    near = near_contacts(bodies, primitives, contacts, pairs)
    choose_cells(bodies, primitives, contacts, pairs, near)
    if not prefilter:
        # The cells stay, so that time is parted in the same way; only their answers are not used.
        near = np.arange(len(contacts))
        pairs.near_start, pairs.near_stop, pairs.listed = pairs.start, pairs.stop, 0
    parts = (bodies, *forced.parts, primitives, contacts, laws, pairs, near)
    model = Model(*(frozen(part) for part in parts))
    told = [(body.name, bond) for body, bond in zip(scene.bodies, bound, strict=True) if body.geared and body.name not in named]
    geared = tuple((int(bodies[bond.to].first), bond.told, bond.shift) for _, bond in told)
    slices |= {name: slice(len(q) + k, len(q) + k + 1) for k, (name, _) in enumerate(told)}
    return Compiled(
        model, layers, owners, slices, size, frozen(q), frozen(u), forced.fastest, _against(hung, bodies, bound), geared
    )


def _against(hung: tuple[Ride, ...], bodies: Records, bound: tuple[Bond, ...]) -> tuple[tuple[int, int, float], ...]:
    """The angles that the scene gives relative to a carrier, of bodies with a coordinate of their own."""
    return tuple(
        (int(bodies[i].first), angle_of(bodies[ride.turns_with]) if ride.turns_with >= 0 else -1, ride.angle)
        for i, ride in enumerate(hung)
        if bodies[i].first >= 0 and bound[i].to == i and (ride.turns_with >= 0 or ride.angle != 0.0)
    )


def scene_size(scene: Scene) -> float:
    """The largest distance of an outline from its moving body's origin, m; 1 mm where nothing moving has outlines."""
    reaches = [_reach(body) for body in scene.bodies if body.motion != "fixed" and body.loops]
    return max(reaches, default=0.0) or 1e-3


def _reach(body: Body) -> float:
    far = 0.0
    for loop in body.loops:
        for edge in loop.edges:
            far = max(far, *(math.hypot(*edge.point(f)) for f in (0.0, 0.25, 0.5, 0.75, 1.0)))
    return far


def _slices(scene: Scene, bodies: Records) -> dict[str, slice]:
    """The coordinates of each body that has some of its own."""
    count = {"fixed": 0, "pivot": 1, "slide": 1, "free": 3}
    return {
        body.name: slice(int(row.first), int(row.first) + count[body.motion])
        for body, row in zip(scene.bodies, bodies, strict=True)
        if count[body.motion] and body.geared is None
    }


def _bodies(scene: Scene, hung: tuple[Ride, ...], bound: tuple[Bond, ...]) -> tuple[Records, np.ndarray, np.ndarray]:
    rows = records(BODY, len(scene.bodies))
    q: list[float] = []
    u: list[float] = []
    for i, (body, ride) in enumerate(zip(scene.bodies, hung, strict=True)):
        carrier = ride.host if body.motion == "pivot" else -1
        direction = math.cos(ride.start), math.sin(ride.start)
        start = {"fixed": (), "pivot": (ride.start,), "slide": (0.0,), "free": (*body.position, body.angle)}[body.motion]
        # The whole record at once: writing one field takes as long.
        first = len(q) if start else -1
        line = bound[i].ratio, bound[i].phase
        rows[i] = (MOTION_CODE[body.motion], first, *ride.place, ride.start, *body.axis, *direction, carrier, *line)
        if body.geared is not None:
            continue
        q.extend(start)
        velocity = (ride.spin,) if body.motion == "pivot" else body.velocity
        u.extend(velocity if velocity else (0.0,) * len(start))
    for i, bond in enumerate(bound):
        if bond.to != i:
            rows[i].first = rows[bond.to].first
    return rows, np.array(q, float), np.array(u[: len(q)], float)


def _primitives(
    scene: Scene, hung: tuple[Ride, ...], size: float
) -> tuple[Records, tuple[str, ...], tuple[str, ...], dict[Side, np.ndarray]]:
    """All primitives that a contact names, their layers, their bodies, and by side of a contact the numbers of its primitives.

    Outlines of a part that is rigid with a moving body become outlines of that one.
    """
    asked = list(dict.fromkeys(side for contact in scene.contacts for side in contact.sides))
    numbers = {body.name: number for number, body in enumerate(scene.bodies)}
    blocks: list[Records] = []
    layers: list[str] = []
    owners: list[str] = []
    of_layer: dict[tuple[str, str], np.ndarray] = {}
    for side in asked:
        body, ride = scene.body(side.body), hung[numbers[side.body]]
        for layer in body.layers if side.layer is None else (side.layer,):
            if (side.body, layer) in of_layer:
                continue
            loops = [loop for loop in body.loops if loop.layer == layer]
            if ride.host == ride.part_of:
                loops = [loop.moved(ride.angle, ride.place) for loop in loops]
            start = len(layers)
            for block in (features(loop, ride.part_of, size) for loop in loops):
                for side_of in ("before", "after"):
                    block[side_of][block[side_of] >= 0] += len(layers)
                blocks.append(block)
                layers.extend([layer] * len(block))
                owners.extend([side.body] * len(block))
            of_layer[side.body, layer] = np.arange(start, len(layers))
    sides = {}
    for side in asked:
        chosen = scene.body(side.body).layers if side.layer is None else (side.layer,)
        sides[side] = np.concatenate([of_layer[side.body, layer] for layer in chosen] or [np.zeros(0, int)]).astype(int)
    rows = np.concatenate(blocks).view(np.recarray) if blocks else records(PRIMITIVE, 0)
    return rows, tuple(layers), tuple(owners), sides
