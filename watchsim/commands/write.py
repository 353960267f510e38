"""How does a finished run or study get onto the disk, whatever happens?

A run may have taken a night. So what it needs from the disk is read before it begins; where its place can no longer be
written it goes to another one; and what a fault of this program leaves of its numbers and pictures does not keep the motion
from it.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim import stopping
from watchsim.commands.console import InputError, Progress, announce_compile, say

if TYPE_CHECKING:
    from watchsim.render.kinematics_plot import Kinematics
    from watchsim.results.tables import EventLines
    from watchsim.scene.scene import Scene
    from watchsim.simulation.trajectory import Trajectory


@dataclass(frozen=True, slots=True)
class Extras:
    """What a results folder is to hold besides the motion and its numbers."""

    plots: bool = True
    movie: bool = False
    gif: bool = False
    error_bars: bool = False
    profile: bool = False
    report: bool = False


@dataclass(frozen=True, slots=True)
class Goal:
    """Where a run is to be kept, and what travels with it there, or anywhere else: the locked scene and its drawings."""

    folder: Path
    replace: bool
    scene: Mapping[str, str | bytes]  # name in the results folder -> content
    keeps_later: bool = False  # movies, plots, pages made of the earlier results stay where they are not made again


def goal_of(scene: Scene, folder: Path, replace: bool, keeps_later: bool = False) -> Goal:
    """To be made before the run: its scene and drawings may be gone when it ends."""
    from watchsim.results.folder import travelling

    return Goal(folder, replace, travelling(scene), keeps_later)


def write(
    run: Trajectory,
    goal: Goal,
    extras: Extras,
    changed: Sequence[str] = (),
    lines: EventLines | None = None,
    panels: Kinematics | None = None,
) -> dict[str, Any]:
    """Write the results folder; returns the summary as written.

    `changed` holds the options by which the run is another than the scene's own: its expectations are then not judged;
    `lines` are its events as far as they were made into text while it went on, `panels` those of its plots, still empty.
    InputError where the results had to go elsewhere.
    """
    from watchsim.analysis.summary import tables
    from watchsim.commands.pictures import page, pictures
    from watchsim.results.folder import EVENTS, TRAJECTORY, Packed
    from watchsim.simulation.state import Stop
    from watchsim.storage.write import real

    if run.stop == Stop.INTERRUPTED:
        say("Interrupted: writing what was simulated; a second Ctrl-C abandons it ...")
    try:
        beside_folder = real(goal.folder).parent
        drawn = pictures(run, extras.plots, extras.movie, extras.gif, beside_folder, panels)
        packed: dict[str, Any] = {TRAJECTORY: Packed(run, beside_folder).write}  # it is being packed from now on
        if lines is not None:
            lines.settle(run)
            packed[EVENTS] = functools.partial(lines.write, run)
        numbers = _numbers(run, extras, changed, goal.folder)
        said = [*(f"Note: {note}" for note in numbers["notes"]), report_text(run, numbers)]
        texts = {name: text.write for name, text in tables(run, beside_folder).items()}
        report = "\n".join([*said, *_timeline(run)]) + "\n"
        beside: dict[str, Any] = {**goal.scene, **packed, **texts, "report.txt": report}
    except Exception:
        say(f"The numbers of this run could not be computed. Its motion is kept in {_bare(run, goal)}")
        raise
    drawn |= page(run, numbers) if extras.report else {}
    _save(run, goal, numbers, beside, drawn)
    return numbers


def report_text(run: Trajectory, summary: dict[str, Any]) -> str:
    """What the terminal says of a run; report.txt keeps it, with the timeline of the last oscillation."""
    from watchsim.analysis.summary import summary_text

    text = summary_text(run, summary)
    if "profile" in summary:
        from watchsim.bench.profile import profile_text

        text += "\n" + profile_text(summary["profile"])
    return text


def _timeline(run: Trajectory) -> list[str]:
    """The tables of the last oscillation, for report.txt; none where its phases are not known."""
    from watchsim.analysis.timeline import timeline_text

    try:
        return ["", timeline_text(run)]
    except ValueError:
        return []


def _numbers(run: Trajectory, extras: Extras, changed: Sequence[str], folder: Path) -> dict[str, Any]:
    from watchsim.analysis.expectations import not_judged
    from watchsim.analysis.summary import summary
    from watchsim.results.tables import plain

    numbers: dict[str, Any] = plain(
        _with_error_bars(run, folder) if extras.error_bars and not stopping.requested() else summary(run)
    )
    if changed:
        numbers["expect"] = [not_judged(entry, changed) for entry in numbers["expect"]]
    if extras.profile:
        from watchsim.bench.profile import profile_of

        announce_compile("profile.moments_again", "what times the kernels", "a minute")
        numbers["profile"] = plain(profile_of(run))
    return numbers


def _with_error_bars(run: Trajectory, folder: Path) -> dict[str, Any]:
    """The summary with errors from a second, more exact run."""
    from watchsim.analysis.summary import more_exact, summary, with_error_bars
    from watchsim.storage.write import real

    progress = Progress("once more, with tighter tolerance; simulated s:")
    try:
        return with_error_bars(summary(run), summary(more_exact(run, progress, real(folder).parent)))
    finally:
        progress.close()


def _save(run: Trajectory, goal: Goal, numbers: Mapping[str, Any], beside: dict[str, Any], drawn: dict[str, Any]) -> None:
    from watchsim.results.folder import LOCK, filler, pictures_in, write_results
    from watchsim.storage.destination import write_elsewhere

    keep = sorted(set(pictures_in(goal.folder)) - set(drawn)) if goal.keeps_later else []
    if keep:
        say(f"{', '.join(keep)} in {goal.folder}: kept, of the run's earlier end. --force removes what is not made again.")
    try:
        write_results(run, goal.folder, numbers, str(beside[LOCK]), extra={**beside, **drawn}, force=goal.replace, keep=keep)
    except OSError as error:
        # Without pictures, which take most of the room, and which can be drawn later.
        place = write_elsewhere(goal.folder.name, filler(run, numbers, beside), "the results")
        raise InputError(f"{error}.\nThe results were saved, without pictures, in {place}") from error
    except Exception:
        say(f"The results could not be written as intended. The motion is kept in {_bare(run, goal)}")
        raise


def _bare(run: Trajectory, goal: Goal) -> Path:
    """Save the motion alone, which everything else can be made from."""
    from watchsim.results.folder import filler
    from watchsim.storage.destination import write_elsewhere

    return write_elsewhere(goal.folder.name, filler(run, None, goal.scene), "the motion")


def write_study(folder: Path, numbers: dict[str, Any], table: dict[str, list[Any]], figure: Any, name: str = "sweep") -> None:
    """NAME.json, NAME.csv, NAME.parquet where pyarrow is installed, the plot as PNG, SVG and PDF.

    Those of an earlier study are there until then. InputError where numbers and table had to go elsewhere.
    """
    from watchsim.storage.destination import write_elsewhere
    from watchsim.storage.write import write_file

    files = {f"{name}{ending}": write for ending, write in _tables(numbers, table).items()}
    try:
        for file, write in files.items():
            write_file(folder / file, write, "the table")
    except OSError as error:
        place = write_elsewhere(folder.name, lambda made: [write(made / file) for file, write in files.items()], "the table")
        raise InputError(f"{error}.\nThe table was saved, without plots, in {place}") from error
    from watchsim.studies.journal import FIGURES, FILES

    drawn = [] if figure is None or stopping.requested() else [f"{name}{ending}" for ending in FIGURES]
    if drawn:
        from watchsim.render.style import save  # half a second to load

        for file in drawn:
            write_file(folder / file, lambda path: save(figure, path), "the plot")
    for file in set(FILES) - {*files, *drawn}:
        _remove(folder / file)


def _tables(numbers: dict[str, Any], table: dict[str, list[Any]]) -> dict[str, Callable[[Path], object]]:
    from watchsim.results.tables import json_text
    from watchsim.studies.study_report import csv_text, parquet_writer

    text, rows, parquet = json_text(numbers), csv_text(table), parquet_writer(table)
    files: dict[str, Callable[[Path], object]] = {
        ".json": lambda path: path.write_text(text, encoding="utf-8"),
        ".csv": lambda path: path.write_text(rows, encoding="utf-8"),
    }
    return files if parquet is None else {**files, ".parquet": parquet}


def _remove(path: Path) -> None:
    """Away with what an earlier study has left; InputError where it stays."""
    from watchsim.storage.write import reason

    try:
        if path.exists():
            path.unlink()
    except OSError as error:
        raise InputError(
            f"{path} is of an earlier study and could not be removed: {reason(error)}. The table is the new one."
        ) from error
