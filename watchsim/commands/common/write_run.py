"""How does a finished run get onto the disk, whatever happens?

It may have taken a night. So what it needs from the disk is read before it begins; where its place can no longer be written it
goes to another one; and what a fault of this program leaves of its numbers and pictures does not keep the motion from it.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim import stopping
from watchsim.commands.common.console import InputError, Progress, announce_compile, say

if TYPE_CHECKING:
    from watchsim.render.figures.kinematics_plot import Kinematics
    from watchsim.results.tables import EventLines
    from watchsim.scene.scene import Scene
    from watchsim.simulation.record.trajectory import Trajectory


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
    keeps_later: bool = False  # movies, plots, pages made of the earlier results stay where they are not made anew


def goal_of(scene: Scene, folder: Path, replace: bool, keeps_later: bool = False) -> Goal:
    """To be made before the run: its scene and drawings may be gone when it ends."""
    from watchsim.results.scene_copy import travelling

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
    from watchsim.commands.common.run_pictures import page, pictures
    from watchsim.simulation.stops import Stop
    from watchsim.storage.write import real

    if run.stop == Stop.INTERRUPTED:
        say("Interrupted: writing what was simulated; a second Ctrl-C abandons it ...")
    try:
        beside_folder = real(goal.folder).parent
        drawn = pictures(run, extras.plots, extras.movie, extras.gif, beside_folder, panels)
        packed = _begun(run, beside_folder, lines)
        numbers = _numbers(run, extras, changed, goal.folder)
        said = [*(f"Note: {note}" for note in numbers["notes"]), report_text(run, numbers)]
        told = {name: text.write for name, text in tables(run, beside_folder).items()}
        report = "\n".join([*said, *_timeline(run)]) + "\n"
        beside: dict[str, Any] = {**goal.scene, **packed, **told, "report.txt": report}
    except Exception:
        say(f"The numbers of this run could not be computed. Its motion is kept in {_bare(run, goal)}")
        raise
    drawn |= page(run, numbers) if extras.report else {}
    _save(run, goal, numbers, beside, drawn)
    return numbers


def _begun(run: Trajectory, folder: Path, lines: EventLines | None) -> dict[str, Any]:
    """What writes the motion, which is being packed from now on, and the events."""
    from watchsim.results.write_results import EVENTS, TRAJECTORY, Packed

    begun: dict[str, Any] = {TRAJECTORY: Packed(run, folder).write}
    if lines is not None:
        lines.settle(run)
        begun[EVENTS] = functools.partial(lines.write, run)
    return begun


def report_text(run: Trajectory, summary: dict[str, Any]) -> str:
    """What the terminal says of a run; report.txt keeps it, with the timeline of the last oscillation."""
    from watchsim.analysis.summary import summary_text

    text = summary_text(run, summary)
    if "profile" in summary:
        from watchsim.bench.profile.run_profile import profile_text

        text += "\n" + profile_text(summary["profile"])
    return text


def _timeline(run: Trajectory) -> list[str]:
    """The tables of the last oscillation, for report.txt; none where its phases are not known."""
    from watchsim.analysis.timeline.timeline_table import timeline_text

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
        from watchsim.bench.profile.run_profile import profile_of

        announce_compile("repeated_work.moments_again", "what times the kernels", "a minute")
        numbers["profile"] = plain(profile_of(run))
    return numbers


def _with_error_bars(run: Trajectory, folder: Path) -> dict[str, Any]:
    """The summary with errors from a second, more exact run."""
    from watchsim.analysis.error_bars import more_exact, with_error_bars
    from watchsim.analysis.summary import summary
    from watchsim.storage.write import real

    progress = Progress("once more, more exactly; simulated s:")
    try:
        return with_error_bars(summary(run), summary(more_exact(run, progress, real(folder).parent)))
    finally:
        progress.close()


def _save(run: Trajectory, goal: Goal, numbers: Mapping[str, Any], beside: dict[str, Any], drawn: dict[str, Any]) -> None:
    from watchsim.results.write_results import LOCK, filler, pictures_in, write_results
    from watchsim.storage.rescue import write_elsewhere

    keep = sorted(set(pictures_in(goal.folder)) - set(drawn)) if goal.keeps_later else []
    if keep:
        say(f"{', '.join(keep)} in {goal.folder}: kept, of the run's earlier end. --force removes what is not made anew.")
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
    from watchsim.results.write_results import bare_filler
    from watchsim.storage.rescue import write_elsewhere

    return write_elsewhere(goal.folder.name, bare_filler(run, goal.scene), "the motion")
