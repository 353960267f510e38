"""What do the kernels read?

A scene compiled once into flat, read-only record arrays in SI units. Record fields read like the theory
(`model.primitives[k].radius`) with the compiler on and off.
"""

from __future__ import annotations

import functools
from typing import Any, NamedTuple, TypeVar, cast, get_args, get_type_hints

import numpy as np
from numpy.typing import NDArray

from watchsim.jit import by_reference

# How does a class of named fields become a record that kernels read and write?
#
# The class lists the fields: `float`, `int`, or an annotated array with its length. A record is one row of a numpy record
# array; numba passes it as one pointer, so that `state.clock.time` costs what `state.clock[0]` did.

Fields = TypeVar("Fields")

_CODES = {float: "f8", int: "i8"}


@functools.cache
def dtype_of(fields: type) -> np.dtype[Any]:
    """The numpy type with the fields of that class, eight bytes each; `Annotated[Integers, 5]` is five of them."""
    described: list[tuple[Any, ...]] = []
    for name, kind in get_type_hints(fields, include_extras=True).items():
        if kind in _CODES:
            described.append((name, _CODES[kind]))
        else:
            array, length = get_args(kind)
            described.append((name, _element(array), (length,)))
    return np.dtype(described)


def _element(kind: Any) -> Any:
    """`np.float64` of `NDArray[np.float64]`: an alias whose parts lie elsewhere from numpy 2.5 on."""
    parts = get_args(kind)
    return _element(parts[-1]) if parts else kind


def blank(fields: type[Fields]) -> Fields:
    """A record with these fields, all zero."""
    return cast(Fields, np.zeros(1, dtype_of(cast(Any, fields))).view(np.recarray)[0])


def row_of(record: Any) -> NDArray[Any]:
    """(1,): the record array to which a record belongs, sharing its memory."""
    return np.asarray(record).reshape(1)


def words_of(record: Any, kind: type) -> NDArray[Any]:
    """(fields,): all fields of a record one after another, sharing its memory; they must be of one kind, float or int."""
    return row_of(record).view(_CODES[kind])


def copy_of(record: Fields) -> Fields:
    """A record of its own with the same values."""
    return cast(Fields, row_of(record).copy().view(np.recarray)[0])


Records = Any  # a numpy recarray; numba infers the record type

FIXED, PIVOT, SLIDE, FREE = 0, 1, 2, 3
MOTION_CODE = {"fixed": FIXED, "pivot": PIVOT, "slide": SLIDE, "free": FREE}

CORNER, LINE, ARC = 0, 1, 2
KIND_WORD = ("corner", "line", "arc")

CONSTANT, OVER_ANGLE, OVER_TIME, REPEATED = 0, 1, 2, 3  # REPEATED: over time, again and again

BODY = np.dtype(
    [
        ("motion", "i8"),
        ("first", "i8"),  # its first coordinate, -1 when fixed
        ("x", "f8"),
        ("y", "f8"),
        ("angle", "f8"),
        ("axis_x", "f8"),
        ("axis_y", "f8"),
        ("c", "f8"),  # cosine and sine of `angle`
        ("s", "f8"),
        ("carrier", "i8"),  # the moving body in whose frame (x, y) lies, -1: the movement
        ("ratio", "f8"),  # its angle, or the way along its axis, is ratio q + phase of its first coordinate: 1 and 0 but for
        ("phase", "f8"),  # bodies geared to the one whose coordinate that is
    ]
)

# Laws of damping and the power of the speed that each force goes with: a new one is a key of `scene.keys`, a field of
# `scene.forces.Damping`, and a line here and in `resistance`.
DAMPING_LAWS = {"viscous": 1, "quadratic": 2}


def resistance(row: Any, speed: Any) -> Any:
    """Force of damping by speed, N·s/m or N·m·s/rad, for a row of COORDINATE or JOINT; `speed` is not negative."""
    return row.viscous + row.quadratic * speed


COORDINATE = np.dtype(
    [
        ("mass", "f8"),  # kg or kg·m²; 1 where the motion is prescribed: `force` is then an acceleration
        ("driven", "i8"),  # 1: its motion is prescribed, no contact changes it
        ("force", "f8"),  # constant part, N or N·m
        *((law, "f8") for law in DAMPING_LAWS),
        ("coulomb", "f8"),  # dry friction of the bearing, N or N·m; of a loaded one what it is without contacts, poised
        ("loaded", "i8"),  # 1: friction of the bearing goes with its load, see BEARING
        ("stiffness", "f8"),
        ("cubic", "f8"),  # of the spring: force by the cube of the way from rest, N·m/rad³ or N/m³
        ("pinned", "f8"),  # stiffness that the spring has more beyond its curb pins
        ("pin_low", "f8"),  # ways from rest at which the coil touches either pin
        ("pin_high", "f8"),
        ("coil", "i8"),  # 1 + its row of `coils`; 0: the spring has no weight and does not press on the pivot
        ("bent", "i8"),  # 1: `cubic`, `pinned` or `coil` is not zero
        ("rest", "f8"),
        ("level", "f8"),  # where it stands in balance: passages of it are events
        ("watched", "i8"),  # 1: its turning points and passages are events
        ("weight_x", "f8"),  # gravity torque on an excentric rotor: cos(q) weight_y - sin(q) weight_x, see applied_forces.py
        ("weight_y", "f8"),
        ("load", "f8"),  # of drive, weight and spring wherever the body is: the scale of their rounding, N or N·m
        ("scale", "f8"),  # 1 rad, or the scene's size for a length
        ("rate", "f8"),  # 1/s: scale × rate is the velocity that error control treats as small
        ("linear", "i8"),  # 1: exact flight is possible (constant force, spring, viscous and dry damping only)
        ("body", "i8"),
    ]
)

# What acts between two coordinates, on the one and back on the other: at the pivot of a body that is carried by a turning one
# (the fields of `coordinate` itself are then zero), or between any two bodies. Angles are differences of the two.
JOINT = np.dtype(
    [
        ("coordinate", "i8"),
        ("on", "i8"),  # the carrier's angle, or the other body's coordinate
        ("watched", "i8"),  # 1: turning points and passages of the difference are events
        ("force", "f8"),
        *((law, "f8") for law in DAMPING_LAWS),
        ("coulomb", "f8"),  # always 0
        ("stiffness", "f8"),
        ("rest", "f8"),
    ]
)

# A spring and damper along the line between a point of one body and a point of another, in their frames.
LINE_SPRING = np.dtype(
    [
        ("a", "i8"),
        ("b", "i8"),  # -1: the movement
        ("xa", "f8"),
        ("ya", "f8"),
        ("xb", "f8"),
        ("yb", "f8"),
        ("stiffness", "f8"),
        ("length", "f8"),  # without force
        ("viscous", "f8"),
    ]
)

# A pivot whose friction goes with what it carries; `coulomb` of its coordinate holds what its weight alone makes.
BEARING = np.dtype(
    [
        ("body", "i8"),
        ("coordinate", "i8"),
        ("grip", "f8"),  # m: friction by load, coefficient times radius
        ("moment_x", "f8"),  # kg·m: mass times centre of mass, in the body's frame
        ("moment_y", "f8"),
        ("weight_x", "f8"),  # N
        ("weight_y", "f8"),
    ]
)

# An acceleration of the case: a half sine of these heights, or rows of `jolts`.
SHOCK = np.dtype(
    [
        ("start", "f8"),  # s
        ("duration", "f8"),
        ("over", "f8"),  # from when on nothing changes any more; infinite where the case turns on
        ("x", "f8"),  # m/s²
        ("y", "f8"),
        ("turn", "f8"),  # rad/s²
        ("first", "i8"),
        ("count", "i8"),  # 0: a half sine
        ("about_x", "f8"),  # of all: the point of the case that is accelerated so, m
        ("about_y", "f8"),
        ("gravity_x", "f8"),  # of the scene, which turns against the case
        ("gravity_y", "f8"),
    ]
)

# Mass, first moment and inertia of a body with what it carries, about the origin of its frame; rows only in scenes with shocks.
WEIGHED = np.dtype([("body", "i8"), ("mass", "f8"), ("moment_x", "f8"), ("moment_y", "f8"), ("inertia", "f8")])

# A hairspring that bends and weighs: series in the way from rest over `furthest`, rows first..first + count of `windings`.
COIL = np.dtype([("first", "i8"), ("count", "i8"), ("furthest", "f8")])
COIL_TORQUE, COIL_ENERGY, COIL_X, COIL_Y = range(4)  # columns of `windings`

TABLE = np.dtype(
    [
        ("coordinate", "i8"),
        ("over", "i8"),
        ("start", "i8"),
        ("count", "i8"),
        ("on", "i8"),  # the carrier's angle, as of a joint; -1: none
    ]
)

PRIMITIVE = np.dtype(
    [
        ("kind", "i8"),
        ("body", "i8"),
        ("x", "f8"),  # corner, arc centre or start of the line, in the body's frame
        ("y", "f8"),
        ("tx", "f8"),  # line: direction of travel, material on its left
        ("ty", "f8"),
        ("length", "f8"),  # line: its length; corner: the scene's size (turns angles into lengths)
        ("radius", "f8"),
        ("side", "f8"),  # arc: +1 convex, -1 concave (material outside)
        ("px", "f8"),  # a point on it: the corner, the line's start, the middle of the arc
        ("py", "f8"),
        ("nx", "f8"),  # outward unit normal there; of a corner, the middle of its fan of normals
        ("ny", "f8"),
        ("half_cos", "f8"),  # arc or corner: cosine and sine of half the angle that its normals fill
        ("half_sin", "f8"),
        ("extent", "i8"),  # PART, or FULL circle
        # Neighbours on the outline, where a body that touches one from outside cannot touch the other: at corners, and where
        # lines and convex arcs join smoothly. -1: none.
        ("before", "i8"),
        ("after", "i8"),
    ]
)
PART, FULL = 0, 1

CONTACT = np.dtype(
    [
        ("a", "i8"),  # primitive that plays the circle: a convex arc or a corner
        ("b", "i8"),  # the line or arc that it meets
        ("group", "i8"),
        ("curvature", "f8"),  # K of B's curve with A's radius r added: 0 for a line, else s/(R + s r), 1/m
        ("reduced", "f8"),  # reduced radius r R/(R + s r) of the two, r for a line, m
    ]
)
COULOMB, PG1996, SHIFTED = 0, 1, 2
TANGENTIAL_CODE = {"coulomb": COULOMB, "pg1996": PG1996, "shifted": SHIFTED}
LAW = np.dtype(
    [
        ("friction", "f8"),  # without slip
        ("drop", "f8"),  # by how much less friction tends to as the contact slides
        ("decay", "f8"),  # m/s: slip at which all but 1/e of the drop is done; 0: it is done as soon as the contact slides
        ("rise", "f8"),  # s/m: friction grows by as much per slip
        ("restitution", "f8"),
        ("tangential", "f8"),  # tangential restitution
        ("kind", "i8"),  # which tangential law of the expansion
        ("nu", "f8"),  # of pg1996
    ]
)

BODY_PAIR = np.dtype(
    [
        ("a", "i8"),
        ("b", "i8"),
        ("start", "i8"),  # its contacts are start..stop of `contacts`
        ("stop", "i8"),
        ("near_start", "i8"),  # those that can ever touch are near_start..near_stop of `near`
        ("near_stop", "i8"),
        ("listed", "i8"),  # 0: all of `near` are candidates in every cell, no search
        ("clearance", "f8"),  # m: primitives count as able to touch when they come this close
        ("reach", "f8"),  # m: with their origins further apart they cannot; 0: unknown
        ("axes", "i8"),  # 0: no cells, all of `near` are candidates; else the number of cell coordinates
        ("c0", "i8"),  # cell coordinates and their cell sizes; a pivot's index wraps after `wrap` cells (0: no wrap)
        ("c1", "i8"),
        ("c2", "i8"),
        ("on0", "i8"),  # the cell coordinate is c less this coordinate, -1: none
        ("on1", "i8"),
        ("on2", "i8"),
        ("size0", "f8"),
        ("size1", "f8"),
        ("size2", "f8"),
        ("wrap0", "i8"),
        ("wrap1", "i8"),
        ("wrap2", "i8"),
        ("fold0", "i8"),  # the fold of the rotational symmetry of the body's outline
        ("fold1", "i8"),
        ("fold2", "i8"),
        ("frame", "i8"),  # the body that carries both, in whose frame the cells are given, -1: the movement
    ]
)


class Model(NamedTuple):
    """Everything the event loop reads; all arrays read-only."""

    bodies: Records
    coordinates: Records
    joints: Records
    lines: Records
    bearings: Records
    tables: Records
    knots: NDArray[np.float64]  # (knots, 2) abscissa, value of all tables
    primitives: Records
    contacts: Records
    laws: Records
    pairs: Records
    near: NDArray[np.int64]  # contacts that can ever touch, by pair of bodies
    shocks: Records
    jolts: NDArray[np.float64]  # (rows, 6) of recordings: time since the start, A_x, A_y, Φ'', Φ', Φ
    weighed: Records
    coils: Records
    windings: NDArray[np.float64]  # (terms, 4): torque beyond that of a linear spring, N·m; its energy, J; force x and y, N


ModelRef = by_reference(Model, __name__)


NO_KEY = -1  # in the place of a cell's key: of a free slot, and of what lies beyond the range of keys


class Cells(NamedTuple):
    """Open-addressing table: (pair, cell indices) -> candidate contacts `entries[start : start + count]`."""

    keys: NDArray[np.int64]  # NO_KEY: free slot
    start: NDArray[np.int64]
    count: NDArray[np.int64]  # type: ignore[assignment]  # hides tuple.count, which nobody needs here
    entries: NDArray[np.int64]


CellsRef = by_reference(Cells, __name__)


def records(dtype: np.dtype[Any], rows: int) -> Records:
    """A zeroed recarray."""
    return np.zeros(rows, dtype).view(np.recarray)


def frozen(array: Any) -> Any:
    """The same array, read-only."""
    array.flags.writeable = False
    return array
