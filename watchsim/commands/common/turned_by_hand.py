"""What does `watchsim check SCENE --turn` do? Lead the mechanism through its cycle, report what happens, draw it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim.commands.common.console import InputError, parse_positive, say

if TYPE_CHECKING:
    from watchsim.scene.scene import Scene


@dataclass(frozen=True)
class Turned:
    """What came out, for machines and for people."""

    report: dict[str, Any]
    text: str
    passes: bool


def turned_by_hand(scene: Scene, swing: str | None, movie: str | None, picture: str | None, on_dark: bool) -> Turned:
    """Turn the scene; write a movie and a picture where asked. SceneError where the scene is none that can be turned."""
    from watchsim.commands.common.output_place import secured_file
    from watchsim.turning.turn import turn
    from watchsim.turning.turning_report import PASSES, turn_report, turn_text

    target = None
    if movie:
        from watchsim.render.movies.encoder import check_path

        target = secured_file(check_path(movie), "the movie")
    found = turn(scene, None if swing is None else _swing(scene, swing))
    if picture:
        from watchsim.render.stills.turn_picture import turn_picture

        turn_picture(found, Path(picture), on_dark)
    if target is not None:
        from watchsim.render.movies.turn_movie import turn_movie

        turn_movie(found, target, on_dark)
        say(f"Movie: {target}")
    report = turn_report(found)
    return Turned(report, turn_text(found), report["verdict"] == PASSES)


def _swing(scene: Scene, text: str) -> float:
    """How far the oscillator is led to either side, rad or m."""
    from watchsim.turning.turn import swinging
    from watchsim.units import ANGLE, LENGTH

    found = swinging(scene)
    if found is None:
        raise InputError(f'--swing "{text}": nothing swings in this scene; its wheel is led by one pitch.')
    return parse_positive("--swing", text, ANGLE if scene.body(found.body).motion == "pivot" else LENGTH)
