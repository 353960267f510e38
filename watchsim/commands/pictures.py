"""Which plots and movies are there of a run, which come with it, and what is drawn of a mechanism turned by hand?"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import watchsim
from watchsim import stopping
from watchsim.commands.beside import drawn_beside
from watchsim.commands.console import InputError, Progress, parse_positive, say

if TYPE_CHECKING:
    from watchsim.analysis.timeline import Beat
    from watchsim.render.kinematics_plot import Kinematics
    from watchsim.render.style import Figure
    from watchsim.scene.scene import Scene
    from watchsim.simulation.trajectory import Trajectory


ALL = "all"  # kinds of plots


@dataclass(frozen=True)
class Request:
    """What was asked for: bodies (None: all), quantities, window (s; None: the usual one of each kind), width (mm)."""

    run: Trajectory
    bodies: list[str] | None
    quantities: tuple[str, ...]
    window: tuple[float, float] | None
    width: float

    @cached_property
    def beats(self) -> list[Beat] | None:
        """The beats that the plots of a beat share; None where there are none, and each plot says why."""
        from watchsim.analysis.timeline import shown_beats

        try:
            return shown_beats(self.run, self.window, rubbed=False)
        except ValueError:
            return None

    def figure(self, kind: str) -> Figure:
        """The plot of that kind."""
        plot: Callable[..., Figure] = getattr(watchsim, f"plot_{kind.replace('-', '_')}")
        return plot(self.run, **{name: getattr(self, name) for name in KINDS[kind]})


KINDS = {  # kind -> what `watchsim.plot_KIND` takes besides the run
    "kinematics": ("bodies", "quantities", "window", "width"),
    "phases": ("window", "width", "beats"),
    "timeline": ("window", "width", "beats"),
    "phase-portrait": ("bodies", "window", "width"),
    "torque": ("window", "width", "beats"),
    "forces": ("window", "width"),
    "energy": ("window", "width", "beats"),
    "sound": ("window", "width"),
    "timing": ("window", "width"),
    "tape": ("window", "width"),
    "wear": ("window", "width"),
}


def chosen(names: Sequence[str]) -> list[str]:
    """The kinds of those names, in order and each once; InputError with the choices."""
    wrong = [name for name in names if name not in (*KINDS, ALL)]
    if wrong or not names:
        raise InputError(f"--kind {','.join(names)}: choose from {', '.join(KINDS)}, or {ALL}.")
    return list(KINDS) if ALL in names else list(dict.fromkeys(names))


Draw = Callable[[Path | IO[bytes]], object]
Draws = Mapping[str, Draw]  # by the name of the picture in the results folder


class LeftOut(Exception):
    """The process is to stop: a picture under way is given up, it can be drawn later."""


MOST_PLOTTED = 12  # bodies, in the plots that come with a run; each costs a fiftieth of a second and an inch of paper
WHOLE_RUN = 10.0  # s that the movie of a whole run takes


def pictures(
    run: Trajectory, plotted: bool, movie: bool, gif: bool, folder: Path | None = None, panels: Kinematics | None = None
) -> dict[str, Callable[[Path], object]]:
    """Name in the results folder -> what draws it into the file it is given.

    Where there is a `folder`, plots may be drawn from now on by another process, and wait there in files without names.
    """
    draws = plots(run, panels) if plotted else {}
    moving = sum(body.motion != "fixed" for body in run.scene.bodies)
    if draws and moving > MOST_PLOTTED:
        say(f"Plots of {MOST_PLOTTED} of {moving} moving bodies; watchsim plot RUN --bodies NAMES draws others.")
    found: dict[str, Any] = dict(drawn_beside(draws, folder) if folder else draws)
    if movie:
        found["movie.mp4"] = lambda path: _movie(run, path, slow=1 / 20)
    if gif:
        found["movie.gif"] = lambda path: _movie(run, path, slow=1 / 40)
    return {name: _drawn(draw) for name, draw in found.items()}


def page(run: Trajectory, numbers: Mapping[str, Any]) -> dict[str, Callable[[Path], object]]:
    """The same for report.html; `numbers` are those of summary.json."""

    def write(path: Path) -> None:
        from watchsim.pages.report_page import page_text

        path.write_bytes(page_text(run, numbers=numbers).encode("utf-8", "replace"))

    return {"report.html": _drawn(write)}


def _drawn(draw: Callable[[Path], object]) -> Callable[[Path], None]:
    """The same, but a picture that cannot be drawn costs a line, not the run."""

    def attempt(path: Path) -> None:
        if stopping.requested():
            return
        try:
            draw(path)
        except LeftOut:
            path.unlink(missing_ok=True)
        except Exception as error:
            path.unlink(missing_ok=True)
            say(f"{path.name} could not be drawn: {error}")

    return attempt


def empty_panels(scene: Scene) -> Kinematics:
    """The panels of the plots that come with a run, drawn once, which is half the work: made while the run goes on."""
    from watchsim.analysis.expectation_faults import not_begun

    _load()
    from watchsim.render.kinematics_plot import Kinematics

    panels = Kinematics(not_begun(scene), _shown(scene))
    panels.figure.canvas.draw()
    return panels


def _load() -> None:
    """Load what draws, in a process of the command line without what nobody reads there."""
    from watchsim.render import without_help

    if stopping.installed():
        without_help()


def _shown(scene: Scene) -> list[str]:
    return [body.name for body in scene.bodies if body.motion != "fixed"][:MOST_PLOTTED]


def plots(run: Trajectory, panels: Kinematics | None = None) -> dict[str, Draw]:
    """Kinematic plots of all that was recorded and of its last part, in the `panels` of `empty_panels` where there are any."""
    if len(run.t) < 2:
        return {}
    from watchsim.scene.roles import keeps_time, only_presses

    @functools.cache
    def shown() -> Kinematics:
        _load()
        from watchsim.render.kinematics_plot import Kinematics

        return panels.of(run) if panels else Kinematics(run, _shown(run.scene))

    def plot(window: Callable[[], tuple[float, float] | None]) -> Draw:
        def draw(target: Path | IO[bytes]) -> None:
            from watchsim.render.kinematics_plot import write_png

            write_png(shown().show(window(), dots=True), target)

        return draw

    last = "last_beats" if keeps_time(run.scene) and not only_presses(run.scene) else "last_stretch"
    return {"plots/kinematics.png": plot(lambda: None), f"plots/{last}.png": plot(lambda: whole_beats(run))}


def whole_beats(run: Trajectory) -> tuple[float, float]:
    """The same, moved back by less than a half swing to the last turning point, where the phases of all beats are known."""
    from watchsim.analysis.timing import beats
    from watchsim.render.opening import last_beats
    from watchsim.render.view import recorded
    from watchsim.scene.roles import keeps_time

    start, end = last_beats(run)
    if not keeps_time(run.scene) or not len(found := beats(run)):
        return start, end
    rest = end - float(found.end[-1])
    return (
        (start - rest, end - rest)
        if 0.0 <= rest < (end - start) / 3.0 and start - rest >= recorded(run)[-1][0]
        else (start, end)
    )


def filmed(run: Trajectory, slow: float) -> tuple[tuple[float, float], float]:
    """What a movie shows, and how fast: the last oscillation at the speed `slow`; where nothing keeps time, all of it.

    All means the last stretch that was recorded without a gap, in WHOLE_RUN seconds.
    """
    from watchsim.render.opening import last_beats
    from watchsim.render.view import recorded
    from watchsim.scene.roles import keeps_time, only_presses

    if keeps_time(run.scene) and not only_presses(run.scene):
        return last_beats(run, 1.1), slow
    start, end = recorded(run)[-1]
    return (start, end), (end - start) / WHOLE_RUN


def _movie(run: Trajectory, path: Path, slow: float) -> None:
    from watchsim.render.movie import movie

    window, speed = filmed(run, slow)
    progress = Progress(f"{path.name}, frames:")

    def drawn(done: int, whole: int) -> None:
        if stopping.requested():
            raise LeftOut
        progress(done, whole)

    try:
        movie(run, path, window=window, speed=speed, progress=drawn)
    finally:
        progress.close()


def turned_by_hand(
    scene: Scene, swing: str | None, movie: str | None, picture: str | None, on_dark: bool
) -> tuple[dict[str, Any], str]:
    """Turn the scene, write a movie and a picture where requested; what came out, for `--json` and for people.

    SceneError where the scene is none that can be turned.
    """
    from watchsim.commands.inputs import secured_file
    from watchsim.escapement.turn import swinging, turn, turn_report, turn_text
    from watchsim.units import ANGLE, LENGTH

    target = None
    if movie:
        from watchsim.render.encoder import check_path

        target = secured_file(check_path(movie), "the movie")
    way = None  # rad or m to either side
    if swing is not None:
        found = swinging(scene)
        if found is None:
            raise InputError(f'--swing "{swing}": nothing swings in this scene; its wheel is turned by one pitch.')
        way = parse_positive("--swing", swing, ANGLE if scene.body(found.body).motion == "pivot" else LENGTH)
    turned = turn(scene, way)
    if picture:
        from watchsim.render.turn_picture import turn_picture

        turn_picture(turned, Path(picture), on_dark)
    if target is not None:
        from watchsim.render.movie import turn_movie

        turn_movie(turned, target, on_dark)
        say(f"Movie: {target}")
    return turn_report(turned), turn_text(turned)
