"""How much will a run record, and where is that held until it is written?

Rows and events lie in memory while they are few. What is more goes to files without a name beside the results, so that a run of
hours takes no more memory than one of minutes, and keeps the same.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from watchsim.commands.console import InputError, print_json, say
from watchsim.storage.destination import LEAST_ROOM, secure_file, secure_folder
from watchsim.storage.write import size_text, sweep

if TYPE_CHECKING:
    from watchsim.proposal.propose import Proposal
    from watchsim.scene.scene import Recording, Scene
    from watchsim.simulation.trajectory import Trajectory


# How does a command get its scene, and a results folder its trajectory?


def load_scene(name: str, changes: list[str] | None = None, overlap: bool = True) -> Scene:
    """The scene of a file or folder with the KEY=VALUE of --set in it; SceneError lists all that is wrong, expectations that no
    run can answer and overlaps included.
    """
    from watchsim.analysis.expectation_faults import expectation_faults
    from watchsim.mechanism.overlap import overlap_faults
    from watchsim.scene.errors import SceneError
    from watchsim.scene.load import assignments, load_set

    scene = load_set(name, assignments(changes or ()))
    faults = [*(overlap_faults(scene) if overlap else ()), *expectation_faults(scene)]
    if faults:
        raise SceneError(faults)
    return scene


def with_lift(run: Trajectory) -> Trajectory:
    """Where a scene names no lift angle of its anchor, that which its geometry has; the lift angle is printed then."""
    from math import degrees

    from watchsim.escapement.measure import with_measured_lift

    found = with_measured_lift(run)
    if found is not run:
        lift = f"{degrees(found.scene.lift_angle or 0.0):.4g}°"
        say(f'Lift angle: {lift}, as check measures it; the scene names none (timegrapher.lift_angle = "{lift}").')
    return found


def read_run(folder: str) -> Trajectory:
    """The trajectory kept in a results folder."""
    from watchsim.results.folder import read_results

    try:
        return with_lift(read_results(folder))
    except (OSError, ValueError, KeyError) as error:
        words = str(error)
        raise InputError(words if words.startswith(folder) else f"{folder}: {words}") from error


# Where does a command write, and can it?


def secured_folder(folder: Path, what: str, room: float = LEAST_ROOM, default: bool = False) -> Path:
    """The folder, if it can be made or replaced; one that was not named (`default`) gets the folders above it."""
    if default:
        folder.parent.mkdir(parents=True, exist_ok=True)
    for line in secure_folder(folder, what, room):
        say(line)
    return folder


def secured_file(path: Path, what: str) -> Path:
    """The path, if a file can be written there."""
    for line in secure_file(path, what):
        say(line)
    return path


@contextlib.contextmanager
def claimed(folder: Path) -> Iterator[None]:
    """Keep an existing folder for this command; InputError where another process writes there.

    The folder itself is locked: nothing is left in it, and a lock ends with its holder.
    """
    try:
        import fcntl

        number = os.open(folder, os.O_RDONLY)
    except (ImportError, OSError):  # Windows knows no such locks; there may be no folder yet
        yield
        return
    try:
        with contextlib.suppress(OSError):  # a file system without locks
            try:
                fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise InputError(
                    f"{folder}: another process is writing results there. Wait for it, or choose another folder (-o)."
                ) from None
        yield
    finally:
        os.close(number)


def interrupted_place(folder: Path) -> Path:
    """Beside a results folder, for a part of a run that is not to replace it: a name that nobody has yet."""
    number, place = 1, folder.with_name(f"{folder.name}-interrupted")
    while os.path.lexists(place):
        number, place = number + 1, folder.with_name(f"{folder.name}-interrupted-{number + 1}")
    return place


def swept_run(folder: str) -> None:
    """Clear up what killed processes have left beside a results folder and in it."""
    place = Path(folder).absolute()
    for parent in (place.parent, place, place / "plots"):
        for line in sweep(parent):
            say(line)


# How does a scene start from drawings?


def is_drawing(name: str) -> bool:
    """Is it the path of a drawing, and not the name of a design?"""
    from watchsim.drawing.read import ENDINGS

    return Path(name).suffix.lower().lstrip(".") in ENDINGS or Path(name).is_file()


def unused_folder(folder: Path, force: bool) -> Path:
    """The folder, if a new scene can be written there; FileExistsError where something is there already, unless by `force`."""
    if folder.is_file():
        raise FileExistsError(f"{folder} is a file; drawings and scene need a folder of their own")
    if not force and folder.is_dir() and next(folder.iterdir(), None) is not None:
        raise FileExistsError(f"{folder} already exists and was not changed. Choose another folder, or replace with --force")
    return secured_folder(folder, "drawings and scene")


def write_start(folder: Path, files: dict[str, bytes], design: str = "") -> list[str]:
    """Write a new scene, of that `design`, with its drawings and the schema that editors check it by, whole or not at all.

    The names of all files.
    """
    from watchsim.scene import schema
    from watchsim.storage.write import write_folder

    header, text = schema.HEADER.encode(), files.pop("scene.toml")
    files |= {
        "scene.toml": text if text.startswith(header) else header + text,
        schema.FILE: schema.schema_text(design).encode(),
    }

    def fill(place: Path) -> None:
        for name, data in files.items():
            (place / name).write_bytes(data)

    write_folder(folder, fill, files.__contains__, "drawings and scene")
    return list(files)


def start_from_drawings(names: Sequence[str], output: str | None, as_json: bool, force: bool) -> None:
    """Write a folder with the scene that the drawings suggest, and the drawings it needs, whole or not at all."""
    from watchsim.commands.console import announce_compile
    from watchsim.proposal.propose import TASKS, NothingToPropose
    from watchsim.proposal.trial import tried

    paths = [Path(name) for name in names]
    missing = [f"{path}: {'is a folder' if path.is_dir() else 'there is no such file'}" for path in paths if not path.is_file()]
    if missing:
        raise InputError("\n".join(missing))
    folder = unused_folder(Path(output or paths[0].stem), force)
    announce_compile()
    try:
        found = tried(paths)
    except NothingToPropose as error:
        raise InputError(f"{error}.") from error
    names = write_start(folder, dict(found.files))
    if as_json:
        print_json({**as_mapping(found, folder), "files": names})
        return
    print(f"{folder}: {', '.join(names)}")
    for role in found.roles:
        print(f"  {role.name}: {TASKS[role.task]}; {role.why}")
    for first, second in found.contacts:
        print(f"  {first} can meet {second}")
    for words in found.left_out:
        say(f"Left out: {words}.")
    for words in found.doubts:
        say(f"Doubtful: {words}.")
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
        "bodies": bodies,
        "contacts": [list(pair) for pair in found.contacts],
        "guesses": [{"key": guess.key, "value": guess.value, "why": guess.why} for guess in found.guesses],
        "left_out": list(found.left_out),
        "doubts": list(found.doubts),
    }


# How much will a run record, and where is that held until it is written?

ROWS, EVENTS = 500, 160  # of a period of an escapement, measured: 395 and 156 (Swiss lever), 479 and 125 (bench lever)
EVENT_BYTES = 52
WORTH_A_NOTE = 64e6  # bytes on the disk that somebody may want to know of before a run
WRITTEN = 2.7  # times what is recorded: the files in which it is held, the archive, and the tables of events and phases


def record_size(scene: Scene, duration: float) -> float:
    """About how many bytes of rows and events are kept of a run of `duration` (s); 0 where nothing swings."""
    from watchsim.mechanism.check import COORDINATES
    from watchsim.scene.roles import frequency, oscillators

    hertz = frequency(scene) or 0.0
    width = 1 + 3 * sum(COORDINATES[body.motion] for body in scene.bodies)
    rows, events = kept_times(scene.record, duration)
    return hertz * len(oscillators(scene)) * (rows * ROWS * width * 8 + events * EVENTS * EVENT_BYTES)


def kept_times(record: Recording, duration: float) -> tuple[float, float]:
    """For how long (s) rows are kept, but for the last seconds, and for how long events."""
    from watchsim.scene.scene import STATISTICS

    inside = sum(max(0.0, min(stop, duration) - max(start, 0.0)) for start, stop in record.row_windows)
    return min(inside, duration) / record.stride, inside if record.keep == STATISTICS else duration


def room_for(scene: Scene, duration: float, folder: Path) -> float:
    """The bytes that the disk of `folder` should have; says so where they are many."""
    from watchsim.storage.columns import IN_MEMORY

    size, in_memory = record_size(scene, duration), 2.0 * IN_MEMORY  # of rows and of events
    if size > WORTH_A_NOTE:
        say(
            f"Note: rows and events of this run take some {size_text(size)}. More than {size_text(in_memory)} are not held in "
            f"memory but in files beside {folder}, until the results are written. --record statistics keeps the last seconds "
            'and sums over the whole run, --record "every 10" every tenth row, --record FROM:TO a window.'
        )
    return max(LEAST_ROOM, WRITTEN * size)
