"""How does a scene file become a scene?

Everything is read before anything is refused: one SceneError lists all faults with file, line, key and cure.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from watchsim.scene.errors import Fault, Faults, SceneError
from watchsim.scene.file.keys.key_values import shortened
from watchsim.scene.file.keys.locate import key_lines
from watchsim.scene.file.parsed import parsed
from watchsim.scene.file.read_scene import changed, from_mapping, unwritten
from watchsim.scene.scene import Scene

QUOTES = "Texts and quantities stand in quotes; plain numbers (0.15), true, false and lists do not"
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
    path = _scene_file(Path(path))
    text = _text(path)
    try:
        mapping = parsed(text)
    except ValueError as error:
        raise SceneError([_syntax_fault(path, text, str(error))]) from error
    faults = Faults(str(path), key_lines(text), changed=frozenset(changes), by="--set")
    later = {key: value for key, value in changes.items() if unwritten(mapping, key)}
    scene = from_mapping(mapping, path, faults, {key: value for key, value in changes.items() if key not in later})
    return changed(scene, later, faults) if later else scene


def _scene_file(path: Path) -> Path:
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
