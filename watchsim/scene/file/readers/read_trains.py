"""What does a mainspring do to a body that it drives through a train?

One turn of the barrel turns the body `ratio` times. Its torque arrives divided by that, less what the train loses; the inertia
of a wheel between them counts divided by the square of its own ratio to the body.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any

from watchsim.scene.body import Body
from watchsim.scene.errors import Faults
from watchsim.scene.file.keys.key_values import NAN, Table
from watchsim.scene.file.keys.schema import TRAIN
from watchsim.scene.force import Mainspring, Torque

BARREL = "barrel"
KEYS = ("ratio", "efficiency", "run_down", "train")  # of [[torques]], with over = "barrel" only
LEAST = 1e-6  # of a ratio: nearer to 0 it is a slip

Rows = tuple[tuple[float, float], ...]


def with_trains(mapping: Mapping[str, Any], bodies: tuple[Body, ...], faults: Faults) -> tuple[Body, ...]:
    """The bodies, with the inertia of the trains that drive them."""
    torques = mapping.get("torques", [])
    added: dict[str, float] = {}
    for i, entry in enumerate(torques if isinstance(torques, (list, tuple)) else ()):
        if isinstance(entry, Mapping) and "train" in entry:
            name = str(entry.get("body"))
            added[name] = added.get(name, 0.0) + _felt(entry["train"], f"torques.{i}", faults)
    return tuple(replace(body, inertia=body.inertia + added[body.name]) if body.name in added else body for body in bodies)


def _felt(train: object, path: str, faults: Faults | None) -> float:
    """kg·m² at the body, of all wheels listed; without `faults` they have been reported before."""
    noted = faults or Faults("")
    if not isinstance(train, (list, tuple)) or not all(isinstance(one, Mapping) for one in train):
        noted.add(f"{path}.train", 'write a list such as [{ ratio = 10, inertia = "0.5 mg·cm²" }], an entry for each wheel')
        return NAN
    return math.fsum(_felt_wheel(Table(one, f"{path}.train.{i}", TRAIN, noted)) for i, one in enumerate(train))


def _felt_wheel(table: Table) -> float:
    if table.lacks(("ratio", "inertia"), '{ ratio = 10, inertia = "0.5 mg·cm²" }, ratio as turns of the body'):
        return NAN
    return table.positive("inertia", "it is the wheel's moment of inertia") / ratio_of(table) ** 2


def ratio_of(table: Table) -> float:
    """The ratio of a table; NaN where it is none."""
    ratio = table.quantity("ratio", NAN)
    if abs(ratio) < LEAST:
        table.fault("ratio", "must not be 0: it is how often the body turns in one turn", with_value=True)
        return NAN
    return ratio


def mainspring_torque(table: Table, body: Body, rows: Rows) -> Torque:
    """The torque on the body, whose table in the scene has turns (rad) of the barrel and torque (N·m) at it."""
    if "ratio" not in table:
        table.fault("", "missing: ratio, turns of the body for one of the barrel, negative where the body turns clockwise")
    ratio, efficiency, run_down = ratio_of(table), table.quantity("efficiency", 1.0), table.quantity("run_down")
    if efficiency <= 0.0 or efficiency > 1.0:
        table.fault("efficiency", "is a share of the work: above 0, at most 1", with_value=True)
    if math.isnan(ratio) or not rows:
        return Torque(body.name)
    factor = efficiency / ratio
    angles = sorted((body.angle + (turned - run_down) * ratio, factor * torque) for turned, torque in rows)
    at_start = interpolated(rows, run_down)
    train = table.mapping.get("train")
    inertia = _felt(train, table.path, None) if train is not None else 0.0
    spring = Mainspring(ratio, efficiency, run_down, at_start, inertia)
    return Torque(body.name, factor * at_start, over="angle", table=tuple(angles), mainspring=spring)


def interpolated(rows: Rows, at: float) -> float:
    """Linear between the rows, constant beyond them."""
    before, after = rows[0], rows[-1]
    for first, second in pairwise(rows):
        if first[0] <= at <= second[0]:
            before, after = first, second
            break
    else:
        return before[1] if at < before[0] else after[1]
    return before[1] + (after[1] - before[1]) * (at - before[0]) / (after[0] - before[0])
