"""What are the coordinates of a model, how heavy are they, and what acts on them besides contacts?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from watchsim.model.records import (
    CONSTANT,
    COORDINATE,
    FREE,
    JOINT,
    MOTION_CODE,
    OVER_ANGLE,
    OVER_TIME,
    PIVOT,
    SLIDE,
    TABLE,
    Records,
    records,
)
from watchsim.scene.body import Body
from watchsim.scene.carriers import Ride, Weighed, weigh
from watchsim.scene.force import Torque
from watchsim.scene.oscillation import oscillators
from watchsim.scene.scene import Scene

OVER = {"constant": CONSTANT, "angle": OVER_ANGLE, "time": OVER_TIME}


@dataclass(frozen=True)
class Forced:
    """Coordinates, joints, force tables and their knots, in the model's order; the largest natural frequency."""

    parts: tuple[Records, Records, Records, np.ndarray]
    fastest: float


class _Targets:
    """On which record do the springs, torques and damping of a body act: its coordinate, or the joint with its carrier?"""

    def __init__(self, scene: Scene, hung: tuple[Ride, ...], slices: dict[str, slice], rows: Records) -> None:
        self.scene, self.rows = scene, rows
        numbers = {body.name: i for i, body in enumerate(scene.bodies)}
        acting = dict.fromkeys(
            [one.body for one in oscillators(scene)] + [one.body for one in scene.torques] + [one.body for one in scene.damping]
        )
        self.slices, self.rides = slices, {name: hung[numbers[name]] for name in acting}
        jointed = [name for name in acting if self.rides[name].turns_with >= 0]
        self.joints = records(JOINT, len(jointed))
        self._joint = dict(zip(jointed, self.joints, strict=True))
        for name, joint in self._joint.items():
            carrier = scene.bodies[self.rides[name].turns_with]
            joint.coordinate, joint.on = slices[name].start, slices[carrier.name].stop - 1

    def number(self, name: str) -> int:
        """The coordinate: a body's angle, or a sliding body's travel."""
        part = self.slices[name]
        return part.stop - 1 if self.scene.body(name).motion == "free" else part.start

    def on(self, name: str) -> int:
        """The angle of its carrier, against which it acts; -1 for none."""
        return int(self._joint[name].on) if name in self._joint else -1

    def row(self, name: str) -> Any:
        return self._joint[name] if name in self._joint else self.rows[self.number(name)]

    def offset(self, name: str) -> float:
        """From an angle as the scene gives it to the coordinate, or to the difference of the two."""
        return self.rides[name].angle if self.scene.body(name).motion == "pivot" else 0.0


def forced_coordinates(scene: Scene, hung: tuple[Ride, ...], slices: dict[str, slice], size: float) -> Forced:
    """Coordinates with their forces; joints; force tables and their knots."""
    count = sum(part.stop - part.start for part in slices.values())
    rows = records(COORDINATE, count)
    weighed = weigh(scene.bodies, hung)
    for i, body in enumerate(scene.bodies):
        if body.name in slices:
            _inertias(scene, body, i, weighed[i], hung[i], rows[slices[body.name]], size)
    targets = _Targets(scene, hung, slices, rows)
    for spring in scene.springs:
        row = targets.row(spring.body)
        # Several springs on one coordinate add up to one: stiffnesses add, rests average.
        total = row.stiffness + spring.stiffness
        rest = spring.rest + targets.offset(spring.body)
        row.rest = (row.stiffness * row.rest + spring.stiffness * rest) / total
        row.stiffness = total
    stiffest = _watch(scene, targets)
    for damping in scene.damping:
        row = targets.row(damping.body)
        row.viscous += damping.viscous
        row.quadratic += damping.quadratic
        row.coulomb += damping.coulomb
    tables, knots = _tables(scene, targets)
    joints = targets.joints
    if joints.coulomb.any():
        raise ValueError("dry friction between a carried body and a carrier that turns is not simulated")
    rows.load = np.abs(rows.force) + np.hypot(rows.weight_x, rows.weight_y)
    tabled = {int(table.coordinate) for table in tables}
    jointed = {*joints.coordinate.tolist(), *joints.on.tolist()}
    for i, row in enumerate(rows):
        row.linear = row.quadratic == 0.0 and row.weight_x == 0.0 and row.weight_y == 0.0 and i not in tabled | jointed
    light = 1.0 / (1.0 / rows.mass[joints.coordinate] + 1.0 / rows.mass[joints.on])
    fastest = float(np.sqrt(np.max([*(rows.stiffness / rows.mass), stiffest, *(joints.stiffness / light)], initial=0.0)))
    push = [*(np.abs(rows.force) / (rows.mass * rows.scale)), *(np.abs(joints.force) / light)]
    rows.rate = fastest or float(np.sqrt(np.max(push, initial=0.0))) or 1.0
    return Forced((rows, joints, tables, knots), fastest)


def _watch(scene: Scene, targets: _Targets) -> float:
    """Marks the coordinates that swing, with their rest positions; returns the largest stiffness over inertia among them."""
    largest = 0.0
    for one in oscillators(scene):
        if targets.on(one.body) < 0:
            row = targets.row(one.body)
            plain = one.weight == 0.0 and scene.body(one.body).motion == "pivot"
            row.watched, row.level = 1, row.rest if plain else one.rest + targets.offset(one.body)
            largest = max(largest, (one.spring + one.weight) / one.inertia)
    return largest


def _inertias(scene: Scene, body: Body, number: int, weighed: Weighed, ride: Ride, rows: Records, size: float) -> None:
    """Masses, scales and gravity of one body's coordinates, with all that it carries."""
    gx, gy = scene.gravity
    rows.body = number
    motion = MOTION_CODE[body.motion]
    if body.prescribed is not None:
        rows.mass, rows.driven, rows.scale = 1.0, 1, 1.0 if motion == PIVOT else size
        rows.stiffness, rows.rest = body.prescribed.square, body.prescribed.middle
    elif motion == PIVOT:
        rows.mass, rows.scale = weighed.inertia, 1.0
        if ride.host < 0:  # a carried body is poised
            sx, sy = weighed.moment
            rows.weight_x, rows.weight_y = sx * gx + sy * gy, sx * gy - sy * gx
    elif motion == SLIDE:
        rows.mass, rows.scale = weighed.mass, size
        rows.force = weighed.mass * (gx * body.axis[0] + gy * body.axis[1])
    elif motion == FREE:
        rows.mass, rows.scale = (weighed.mass, weighed.mass, weighed.inertia), (size, size, 1.0)
        rows.force = (weighed.mass * gx, weighed.mass * gy, 0.0)


def _tables(scene: Scene, targets: _Targets) -> tuple[Records, np.ndarray]:
    """Constant torques go into the coordinates, the others into tables."""
    tabled: list[Torque] = []
    for torque in scene.torques:
        if torque.over == "constant":
            targets.row(torque.body).force += torque.value
        else:
            tabled.append(torque)
    paths = [body for body in scene.bodies if body.prescribed is not None and body.prescribed.table]
    tables = records(TABLE, len(tabled) + len(paths))
    knots: list[tuple[float, float]] = []
    for row, torque in zip(tables, tabled, strict=False):
        row.coordinate, row.on, row.over = targets.number(torque.body), targets.on(torque.body), OVER[torque.over]
        row.start, row.count = len(knots), len(torque.table)
        shift = targets.offset(torque.body) if torque.over == "angle" else 0.0
        knots.extend((x + shift, value) for x, value in torque.table)
    for row, body in zip(tables[len(tabled) :], paths, strict=True):
        assert body.prescribed is not None
        row.coordinate, row.on, row.over = targets.slices[body.name].start, -1, OVER_TIME
        row.start, row.count = len(knots), len(body.prescribed.table)
        knots.extend(body.prescribed.table)
    return tables, np.array(knots, float).reshape(len(knots), 2)
