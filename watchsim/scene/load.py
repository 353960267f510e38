"""How does a scene file become a scene?

Everything is read before anything is refused: one SceneError lists all faults with file, line, key and cure.
"""

from __future__ import annotations

import copy
import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from watchsim.drawing.write import Files
from watchsim.paths import profiles_dir
from watchsim.scene.assign import assign
from watchsim.scene.designed import in_full, with_design
from watchsim.scene.errors import Fault, Faults, SceneError
from watchsim.scene.keys import LISTED, LOCK, SECTIONS, words_of
from watchsim.scene.read_bodies import read_bodies
from watchsim.scene.read_contacts import read_contacts
from watchsim.scene.read_forces import read_bearings, read_damping, read_line_springs, read_springs, read_torques
from watchsim.scene.read_settings import read_expectations, read_heading, read_run, read_timegrapher
from watchsim.scene.read_shocks import read_shocks
from watchsim.scene.read_tolerances import read_tolerances
from watchsim.scene.read_trains import note_carriers, read_gears, with_trains
from watchsim.scene.read_watch import in_state, read_watch
from watchsim.scene.roles import frequency
from watchsim.scene.scene import Scene, Written
from watchsim.scene.toml import file_digest, key_lines, parsed
from watchsim.scene.values import Table, shortened, shown, understood

# How does the mapping of a scene file become a scene, and what does it become with some of its keys changed?
#
# A scene carries the reader that made it (`Scene.reader`), so that `Scene.set` reads it again without knowing this file.

FAR_OFF = 0.1  # of the frequency of small swings: what a rate may be measured against


def from_mapping(
    mapping: dict[str, Any],
    path: Path | None,
    faults: Faults | None = None,
    changes: Mapping[str, object] | None = None,
    drawings: Mapping[str, bytes] | None = None,
) -> Scene:
    """The scene of a TOML mapping; `path` is the file it stands for, drawings are looked for beside it.

    `changes` are made first, in the mapping itself; of a scene with a design after it has been put together. `drawings` are
    those that need not be looked for.
    """
    faults = faults or Faults(str(path) if path else "scene")
    folder = path.parent if path else Path()
    written, made, changes = None, None, changes or {}
    mapping = understood(mapping, SECTIONS, "section", "", faults)
    if "design" in mapping:
        written = Written(mapping, in_full(mapping, changes, faults))
        mapping, made = with_design(written, faults)
        written = replace(written, made=frozenset(made))
    else:
        for key, value in changes.items():
            assign(mapping, key, value, faults)
    heading = read_heading(mapping, faults)
    read = read_bodies(mapping.get("bodies", {}), folder, faults, {**(drawings or {}), **(made or {})})
    if not read.bodies:  # all that names one would be wrong
        mapping = {section: value for section, value in mapping.items() if section not in LISTED}
    bodies, sound = with_trains(mapping, read.bodies, faults), read.sound
    state = read_watch(mapping, faults)
    geared = read_gears(mapping, bodies, heading.gravity if state.gravity is None else state.gravity, faults)
    bodies = geared.bodies
    springs = read_springs(mapping, bodies, faults)
    torques = read_torques(mapping, bodies, faults)
    damping = read_damping(mapping, bodies, springs, heading.gravity, faults)
    bearings = read_bearings(mapping, bodies, springs, geared.gears, faults)
    contacts = read_contacts(mapping, bodies, sound, heading.tangential_law, faults)
    line_springs = read_line_springs(mapping, bodies, faults)
    shocks, recordings = read_shocks(mapping, folder, faults, drawings)
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
        bearings=bearings,
        contacts=contacts,
        gears=geared.gears,
        rigid_gears=geared.rigid,
        line_springs=line_springs,
        shocks=shocks,
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
        drawings=Files({**read.drawings, **recordings}),
        written=written,
        reader=changed,
    )
    _check_nominal(scene, faults)
    scene = in_state(scene, state, faults)
    if "tolerances" in mapping:
        tolerances, correlated = read_tolerances(scene, faults)
        scene = replace(scene, tolerances=tolerances, correlated=correlated)
    faults.raise_any()
    return scene


def changed(scene: Scene, changes: Mapping[str, object], faults: Faults | None = None) -> Scene:
    """The scene with those dotted keys changed and everything checked again; SceneError lists what does not fit.

    Its drawings and recordings stay those that were read, whatever has become of the files since.
    """
    name = str(scene.path) if scene.path else "scene"
    designed = scene.written.made if scene.written is not None else ()
    held = {drawing: scene.drawings[drawing] for drawing in scene.drawings if drawing not in designed}
    held = {drawing: data for drawing, data in held.items() if data}
    if scene.written is not None:
        later = {**scene.written.changes, **changes}
        return from_mapping(scene.written.mapping, scene.path, Faults(name, changed=frozenset(later)), later, held)
    implied = {key: value for key, value in changes.items() if unwritten(scene.source, key)}
    if 0 < len(implied) < len(changes):  # the others may move what the drawing implies, as a new pivot does
        scene = changed(scene, {key: value for key, value in changes.items() if key not in implied})
        changes = implied
    mapping = copy.deepcopy(scene.source)
    for key in implied:
        body, what, _ = words_of(key)[1:]
        pair = {"position": scene.body(body).position, "centre_of_mass": scene.body(body).centre_of_mass}[what]
        mapping["bodies"][body][what] = [f"{one!r} m" for one in pair]
    return from_mapping(mapping, scene.path, faults or Faults(name, changed=frozenset(changes)), changes, held)


def unwritten(mapping: Mapping[str, Any], key: str) -> bool:
    """Does that key name one value of a pair that the drawing gives and the scene does not write?"""
    path, bodies = words_of(key), mapping.get("bodies")
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


# Which keys and values does KEY=VALUE on the command line name?


def assignments(texts: Iterable[str]) -> dict[str, object]:
    """{"torques.0.value": "-1.2 µN·m"} from "torques.0.value=-1.2 µN·m"; lists are written as in the file."""
    found: dict[str, object] = {}
    for text in texts:
        key, equals, value = (part.strip() for part in text.partition("="))
        key = key.strip('"') if key.count('"') == 2 and key[0] == key[-1] else key  # "design.lock", as below [tolerances]
        if not equals or not key or not value:
            raise SceneError([Fault(text, 'write KEY=VALUE, such as "torques.0.value=-1.2 µN·m"', place="--set")])
        found[key] = _literal(text, value) if value[0] in "[{\"'" else value
    return found


def _literal(text: str, value: str) -> object:
    try:
        return parsed(f"value = {value}")["value"]
    except ValueError:
        raise SceneError([Fault(text, "the value is not a list or text as in a scene file", place="--set")]) from None


# How does a scene file become a scene?

QUOTES = "Text and quantities need quotes; plain numbers (0.15), true, false and lists do not"
CURES = {  # what the TOML reader complains of -> what is mostly amiss
    "Cannot declare": "This table is there already: give it another name, or make one of both",
    "Cannot overwrite": "This key has a value already: leave one of them out",
    "Illegal character '\\n'": "A quotation mark is missing at the end of the line",
    "Unclosed array": "Between the entries of a list stand commas, and ] ends it",
    "Expected newline": QUOTES,
    "Invalid value": QUOTES,
    "Expected '='": "A line is KEY = VALUE, or a [table]",
}
SCENE_FILES = ("scene.toml", "scene.lock.toml")  # in a folder, the first that is there


def load(path: str | Path) -> Scene:
    """The scene of a TOML file or of the folder that holds one, in SI units. SceneError lists all that is wrong with it.

    Of a folder it is `scene.toml`, else `scene.lock.toml`, the scene of a results folder.
    """
    return load_set(path, {})


def load_set(path: str | Path, changes: Mapping[str, object]) -> Scene:
    """The same with the keys and values of --set in it, put there before anything is judged: they may replace faulty ones."""
    path = scene_file(Path(path))
    text, mapping = _read(path)
    faults = Faults(str(path), key_lines(text), changed=frozenset(changes), by="--set")
    later = {key: value for key, value in changes.items() if unwritten(mapping, key)}
    scene = from_mapping(mapping, path, faults, {key: value for key, value in changes.items() if key not in later})
    return changed(scene, later, faults) if later else scene


def read_mapping(path: Path) -> dict[str, Any]:
    """What stands in a scene file, unjudged; SceneError where it is no TOML."""
    return _read(path)[1]


def _read(path: Path) -> tuple[str, dict[str, Any]]:
    text = _text(path)
    try:
        return text, parsed(text)
    except ValueError as error:
        raise SceneError([_syntax_fault(path, text, str(error))]) from error


def scene_file(path: Path) -> Path:
    """The file itself, or of a folder the scene in it; SceneError where that holds none.

    `profiles/NAME` is that of the package where no folder `profiles` is here.
    """
    if path.parts[:1] == ("profiles",) and not Path("profiles").exists():
        path = profiles_dir().joinpath(*path.parts[1:])
    if not path.is_dir():
        return path
    found = next((path / name for name in SCENE_FILES if (path / name).is_file()), None)
    if found is None:
        message = f"this folder holds no scene: neither {' nor '.join(SCENE_FILES)} is in it"
        raise SceneError([Fault("", message, place=str(path))])
    return found


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        message = "there is no such scene file"
    except UnicodeDecodeError as error:
        message = f"not UTF-8: byte {error.start} is 0x{error.object[error.start]:02x}. Save the file as UTF-8"
    except OSError as error:
        message = f"cannot be read: {error.strerror or error}"
    raise SceneError([Fault("", message, place=str(path))])


def _syntax_fault(path: Path, text: str, complaint: str) -> Fault:
    """TOML's own complaint, its line moved to where all faults have it."""
    found = re.search(r" \(at line (\d+), column \d+\)", complaint)
    line = int(found[1]) if found else len(text.splitlines())
    what = re.sub(r" \(at .*\)", "", complaint)
    cure = next((advice for words, advice in CURES.items() if words in complaint), "")
    seen = [*text.splitlines(), ""][line - 1].strip() if line else ""
    return Fault("", f"not valid TOML: {what}. {cure}".strip(), shown=shortened(seen), place=f"{path}:{line}")
