"""How are gears described to people?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.scene.oscillation import loads
from watchsim.scene.scene import Scene
from watchsim.units import metric, show


def gear_lines(scene: Scene) -> Iterator[str]:
    """A line for each body geared to another, for what they all weigh there, and for each pair of gears with play."""
    held = dict.fromkeys(body.geared.to for body in scene.bodies if body.geared is not None)
    for body in scene.bodies:
        if body.geared is not None:
            ratio = ratio_words(scene, body.geared.to, body.name, body.geared.ratio)
            yield f"  {body.name} is geared to {body.geared.to}: {ratio} of it"
    for body, mass in zip(scene.bodies, loads(scene.bodies)[2], strict=True):
        if body.name in held and body.prescribed is None:
            text = show(mass, "mg·cm²", 5) if body.motion == "pivot" else show(mass, "g", 5)
            yield f"  felt at {body.name} with all that is geared to it: {text}"
    for gear in scene.gears:
        first, second = gear.between
        turns = scene.body(second).motion == "pivot"
        play = f"{math.degrees(gear.backlash):.6g}°" if turns else metric(gear.backlash, "m")
        text = f"play {play}, restitution {gear.restitution:g}, efficiency {100.0 * gear.efficiency:g} %"
        yield f"  gears {first} - {second}: {ratio_words(scene, first, second, gear.ratio)}, {text}"


def ratio_words(scene: Scene, first: str, second: str, ratio: float) -> str:
    """How far the second goes for one turn, or one millimetre, of the first."""
    turns, other_turns = scene.body(first).motion == "pivot", scene.body(second).motion == "pivot"
    one = "turn" if turns else "mm"
    if turns == other_turns:
        return f"{ratio:.6g} {'turns' if turns else 'mm'} for one {one}"
    if turns:
        return f"{show(ratio * math.tau, 'mm')} for one turn"
    return f"{ratio * 1e-3 / math.tau:.6g} turns for one mm"
