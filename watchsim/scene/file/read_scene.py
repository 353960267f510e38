"""How does the mapping of a scene file become a scene, and what does it become with some of its keys changed?

A scene carries the reader that made it (`Scene.reader`), so that `Scene.set` reads it anew without knowing this file.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from watchsim.scene.errors import Faults
from watchsim.scene.file.assign import assign
from watchsim.scene.file.designed import with_design
from watchsim.scene.file.digests import file_digest
from watchsim.scene.file.keys.key_values import Table, shown, understood
from watchsim.scene.file.keys.schema import LISTED, LOCK, SECTIONS
from watchsim.scene.file.readers.read_bodies import read_bodies
from watchsim.scene.file.readers.read_carriers import note_carriers
from watchsim.scene.file.readers.read_contacts import read_contacts
from watchsim.scene.file.readers.read_forces import read_damping, read_springs, read_torques
from watchsim.scene.file.readers.read_gears import read_gears
from watchsim.scene.file.readers.read_line_springs import read_line_springs
from watchsim.scene.file.readers.read_settings import read_expectations, read_heading, read_run, read_timegrapher
from watchsim.scene.file.readers.read_trains import with_trains
from watchsim.scene.oscillation import frequency
from watchsim.scene.scene import Scene, Written

FAR_OFF = 0.1  # of the frequency of small swings: what a rate may be measured against


def from_mapping(
    mapping: dict[str, Any], path: Path | None, faults: Faults | None = None, changes: Mapping[str, object] | None = None
) -> Scene:
    """The scene of a TOML mapping; `path` is the file it stands for, drawings are looked for beside it.

    `changes` are made first, in the mapping itself; of a scene with a design after it has been put together.
    """
    faults = faults or Faults(str(path) if path else "scene")
    folder = path.parent if path else Path()
    written, made, changes = None, None, changes or {}
    mapping = understood(mapping, SECTIONS, "section", "", faults)
    if "design" in mapping:
        written = Written(mapping, dict(changes))
        mapping, made = with_design(written, faults)
        written = replace(written, made=frozenset(made))
    else:
        for key, value in changes.items():
            assign(mapping, key, value, faults)
    heading = read_heading(mapping, faults)
    read = read_bodies(mapping.get("bodies", {}), folder, faults, made)
    if not read.bodies:  # all that names one would be wrong
        mapping = {section: value for section, value in mapping.items() if section not in LISTED}
    bodies, sound = with_trains(mapping, read.bodies, faults), read.sound
    geared = read_gears(mapping, bodies, heading.gravity, faults)
    bodies = geared.bodies
    springs = read_springs(mapping, bodies, faults)
    torques = read_torques(mapping, bodies, faults)
    damping = read_damping(mapping, bodies, springs, heading.gravity, faults)
    contacts = read_contacts(mapping, bodies, sound, heading.tangential_law, faults)
    line_springs = read_line_springs(mapping, bodies, faults)
    note_carriers(bodies, damping, contacts, faults)
    duration, record, tolerance = read_run(mapping, faults)
    lift_angle, nominal = read_timegrapher(mapping, faults)
    expect = read_expectations(mapping, faults)
    _check_lock(mapping, folder, faults)
    faults.raise_any()
    scene = Scene(
        title=heading.title or (path.parent.name if path else ""),
        bodies=bodies,
        springs=springs,
        torques=torques,
        damping=damping,
        contacts=contacts,
        gears=geared.gears,
        rigid_gears=geared.rigid,
        line_springs=line_springs,
        gravity=heading.gravity,
        tangential_law=heading.tangential_law,
        nu=heading.nu,
        duration=duration,
        record=record,
        tolerance=tolerance,
        lift_angle=lift_angle,
        nominal=nominal,
        expect=expect,
        path=path,
        source=mapping,
        findings=read.findings,
        drawings=read.drawings,
        written=written,
        reader=changed,
    )
    _check_nominal(scene, faults)
    faults.raise_any()
    return scene


def changed(scene: Scene, changes: Mapping[str, object], faults: Faults | None = None) -> Scene:
    """The scene with those dotted keys changed and everything checked again; SceneError lists what does not fit."""
    name = str(scene.path) if scene.path else "scene"
    if scene.written is not None:
        later = {**scene.written.changes, **changes}
        return from_mapping(scene.written.mapping, scene.path, Faults(name, changed=frozenset(later)), later)
    implied = {key: value for key, value in changes.items() if unwritten(scene.source, key)}
    if 0 < len(implied) < len(changes):  # the others may move what the drawing implies, as a new pivot does
        scene = changed(scene, {key: value for key, value in changes.items() if key not in implied})
        changes = implied
    mapping = copy.deepcopy(scene.source)
    for key in implied:
        body, what, _ = key.split(".")[1:]
        pair = {"position": scene.body(body).position, "centre_of_mass": scene.body(body).centre_of_mass}[what]
        mapping["bodies"][body][what] = [f"{one!r} m" for one in pair]
    return from_mapping(mapping, scene.path, faults or Faults(name, changed=frozenset(changes)), changes)


def unwritten(mapping: Mapping[str, Any], key: str) -> bool:
    """Does that key name one value of a pair that the drawing gives and the scene does not write?"""
    path, bodies = key.split("."), mapping.get("bodies")
    if len(path) != 4 or path[0] != "bodies" or path[2] not in ("position", "centre_of_mass") or "design" in mapping:
        return False
    entry = bodies.get(path[1]) if isinstance(bodies, dict) else None
    return isinstance(entry, dict) and not isinstance(entry.get(path[2]), list)


def _check_nominal(scene: Scene, faults: Faults) -> None:
    """A rate is measured against a frequency near that of the oscillator; anything else is a slip."""
    if scene.nominal is None:
        return
    natural, given = frequency(scene), shown(scene.source["timegrapher"]["frequency"])
    if natural is None:
        faults.add("timegrapher.frequency", "nothing in this scene swings on a spring or by gravity, so it has no rate", given)
    elif abs(scene.nominal / natural - 1.0) > FAR_OFF:
        seen = f"the oscillator makes small swings at {natural:.6g} Hz ({7200.0 * natural:.6g} vph)"
        why = f"{seen}, more than {100 * FAR_OFF:.0f} % off: look at mass, inertia and spring"
        faults.add("timegrapher.frequency", why, given)


def _check_lock(mapping: Mapping[str, Any], folder: Path, faults: Faults) -> None:
    """A locked scene promises that its drawings are still the ones that were simulated."""
    if "lock" not in mapping:
        return
    table = Table(mapping["lock"], "lock", LOCK, faults)
    digests = table.mapping.get("drawings", {})
    for name, expected in digests.items() if isinstance(digests, dict) else ():
        path = folder / name
        if path.is_file() and file_digest(path) != expected:
            faults.add(
                f"lock.drawings.{name}", "the drawing was changed after this scene was locked. Load the original scene file"
            )
