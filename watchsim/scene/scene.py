"""What did the user declare?"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Any

from watchsim.displays import notebook_html
from watchsim.drawing.findings import Finding
from watchsim.geometry.primitives import Point
from watchsim.scene.body import Body
from watchsim.scene.errors import Fault, SceneError
from watchsim.scene.force import Contact, Damping, LineSpring, Spring, Torque
from watchsim.scene.gearing import Gear
from watchsim.scene.recording import EVERYTHING, Recording


@dataclass(frozen=True, slots=True)
class Expectation:
    """A number the scene promises, in the units it was written in."""

    key: str
    value: float
    tolerance: float
    unit: str


@dataclass(frozen=True)
class Written:
    """Of a scene made from a design: what its file says, the keys changed since (path -> value, in that order), and the names
    of the drawings that the design makes."""

    mapping: dict[str, Any]
    changes: Mapping[str, object]
    made: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Scene:
    """A mechanism in SI units, ready to be compiled. Two scenes are equal when all but the last six fields are.

    bodies, springs, torques, damping, contacts  what it consists of
    gravity         (x, y), m/s²
    tangential_law  "coulomb", "pg1996" or "shifted": what friction does in the expansion of impacts; `nu` belongs to pg1996
                    (docs/theory/laws.md)
    duration        of a run, s; `tolerance` its relative error per step, `record` what is kept of it
    lift_angle      rad; `nominal` (Hz) is what the rate is measured against. None where the scene says nothing
    expect          numbers that a run promises
    gears           with play; those without are `Body.geared`, and, two by two, `rigid_gears`
    line_springs    between points of two bodies, or of a body and the movement
    path, source    the file, and the TOML mapping that it holds
    findings        what the drawings said besides errors; `drawings` the files as they were read, by their names in the scene
    written         of a scene made from a design: `source` then holds the design's scene as well
    reader          reader(scene, {key: value}) reads `source` anew with keys changed; None for a scene made in Python
    """

    title: str
    bodies: tuple[Body, ...]
    springs: tuple[Spring, ...] = ()
    torques: tuple[Torque, ...] = ()
    damping: tuple[Damping, ...] = ()
    contacts: tuple[Contact, ...] = ()
    gravity: Point = (0.0, 0.0)
    tangential_law: str = "coulomb"
    nu: float = 0.0
    duration: float = 1.0
    record: Recording = EVERYTHING
    tolerance: float = 1e-9
    lift_angle: float | None = None
    nominal: float | None = None
    expect: tuple[Expectation, ...] = ()
    gears: tuple[Gear, ...] = ()
    rigid_gears: tuple[Gear, ...] = ()
    line_springs: tuple[LineSpring, ...] = ()
    path: Path | None = field(default=None, compare=False)
    source: dict[str, Any] = field(default_factory=dict, repr=False, compare=False)
    findings: tuple[Finding, ...] = field(default=(), repr=False, compare=False)
    drawings: Mapping[str, bytes] = field(default_factory=dict, repr=False, compare=False)
    written: Written | None = field(default=None, repr=False, compare=False)
    reader: Callable[[Scene, Mapping[str, object]], Scene] | None = field(default=None, repr=False, compare=False)

    def __repr__(self) -> str:
        names = ", ".join(body.name for body in self.bodies)
        return f"<Scene {self.title!r}: {names}; {len(self.contacts)} contacts declared>"

    def _repr_html_(self) -> str:
        return notebook_html(self)

    def body(self, name: str) -> Body:
        """The body of that name; KeyError if there is none."""
        return self._by_name[name]

    def __getstate__(self) -> dict[str, Any]:
        """Without `_by_name`, which one thread may be adding while another one pickles the scene."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @cached_property
    def _by_name(self) -> dict[str, Body]:
        return {body.name: body for body in self.bodies}

    def set(self, key: str, value: object) -> Scene:
        """A copy with one key of the scene file changed, everything else checked again.

        `key` is a dotted path such as "torques.0.value", "bodies.lever.position.1"; `value` a text as in the file
        ("-1.2 µN·m") or a number in SI units. Raises SceneError for an unknown path, for a value that does not fit, and
        for a scene that was made in Python.
        """
        if self.reader is None:
            message = "this scene was made in Python and has no file to read again. Change it with dataclasses.replace"
            raise SceneError([Fault(key, message, place="changed value")])
        return self.reader(self, {key: value})
