"""Does anything keep an oscillator going? If not, there is no limit cycle to ask for."""

from __future__ import annotations

from watchsim.scene.errors import Faults, SceneError
from watchsim.scene.file.keys.locate import key_lines
from watchsim.scene.roles import is_driven, only_presses, roles
from watchsim.scene.scene import Scene

WHAT = "nothing keeps an oscillator going here"
WHY = "so there is no limit cycle to look for"
INSTEAD = "Give the wheel of an escapement a torque, or simulate the scene with `watchsim run`"


def nothing_swings(scene: Scene) -> SceneError | None:
    """Where no body swings, or the only ones that do are lifted and let go by bodies that move as the scene says."""
    oscillator = roles(scene).oscillator
    if oscillator is None:
        return _refused(scene, "no body swings on a spring or by gravity")
    if only_presses(scene) and not is_driven(scene):
        moved = [body.name for body in scene.bodies if body.prescribed is not None]
        moves = "moves" if len(moved) == 1 else "move"
        return _refused(scene, f"{oscillator} is sprung, {' and '.join(moved)} {moves} as the scene says, and no torque acts")
    return None


def nothing_lets_go(scene: Scene) -> SceneError | None:
    """Where a driven wheel touches a sprung body that did not swing: a click holds it, and no escapement lets it go."""
    found = roles(scene)
    if found.wheel is None or not only_presses(scene):
        return None
    return _refused(scene, f"{found.wheel} is driven, {found.oscillator} is sprung and rests on it, and did not swing")


def _refused(scene: Scene, seen: str) -> SceneError:
    lines = key_lines(scene.path.read_text(encoding="utf-8-sig")) if scene.path and scene.path.is_file() else {}
    faults = Faults(str(scene.path or "scene"), lines)
    faults.add("torques" if scene.torques else "springs", f"{WHAT}: {seen}, {WHY}. {INSTEAD}")
    return SceneError(faults.found)
