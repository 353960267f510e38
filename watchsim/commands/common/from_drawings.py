"""How does a scene start from drawings?"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from watchsim.commands.common.console import InputError, print_json, say

if TYPE_CHECKING:
    from watchsim.proposal.propose import Proposal

ENDINGS = (".dxf", ".svg", ".svgz")


def is_drawing(name: str) -> bool:
    """Is it the path of a drawing, and not the name of a design?"""
    return Path(name).suffix.lower() in ENDINGS or Path(name).is_file()


def start_from_drawings(names: Sequence[str], output: str | None, as_json: bool, force: bool) -> None:
    """Write a folder with the scene that the drawings suggest, and the drawings it needs, whole or not at all."""
    from watchsim.commands.common.output_place import secured_folder
    from watchsim.proposal.propose import NothingToPropose, propose
    from watchsim.storage.write import write_folder

    paths = [Path(name) for name in names]
    missing = [f"{path}: {'is a folder' if path.is_dir() else 'there is no such file'}" for path in paths if not path.is_file()]
    if missing:
        raise InputError("\n".join(missing))
    folder = Path(output or paths[0].stem)
    if folder.is_file():
        raise FileExistsError(f"{folder} is a file; drawings and scene need a folder of their own")
    if not force and folder.is_dir() and next(folder.iterdir(), None) is not None:
        raise FileExistsError(f"{folder} exists already and is left alone. Choose another folder, or replace with --force")
    secured_folder(folder, "drawings and scene")
    try:
        found = propose(paths)
    except NothingToPropose as error:
        raise InputError(f"{error}.") from error

    def fill(place: Path) -> None:
        for name, data in found.files.items():
            (place / name).write_bytes(data)

    write_folder(folder, fill, found.files.__contains__, "drawings and scene")
    if as_json:
        print_json(as_mapping(found, folder))
        return
    print(f"{folder}: {', '.join(found.files)}")
    for role in found.roles:
        print(f"  {role.name}: {role.why}")
    for first, second in found.contacts:
        print(f"  {first} can meet {second}")
    say(f"{len(found.guesses)} guesses, each with its reason in {folder / 'scene.toml'}.")
    say(f"watchsim check {folder} --png start.png shows the start; watchsim run {folder} simulates it.")


def as_mapping(found: Proposal, folder: Path) -> dict[str, object]:
    """For `--json`."""
    bodies = [
        {
            "name": role.name,
            "task": role.task,
            "teeth": role.teeth or None,
            "layers": role.part.layers,
            "pivot_mm": [1e3 * value for value in role.part.centre.at] if role.part.centre is not None else None,
            "why": role.why,
        }
        for role in found.roles
    ]
    return {
        "folder": str(folder),
        "files": list(found.files),
        "bodies": bodies,
        "contacts": [list(pair) for pair in found.contacts],
        "guesses": [{"key": guess.key, "value": guess.value, "why": guess.why} for guess in found.guesses],
        "left_out": list(found.left_out),
    }
