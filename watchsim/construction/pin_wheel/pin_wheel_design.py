"""What makes the pin-wheel escapement a design?"""

from __future__ import annotations

from watchsim.construction.design import Design
from watchsim.construction.pin_wheel.pin_wheel_conflicts import conflicts
from watchsim.construction.pin_wheel.pin_wheel_dimensions import PinWheel
from watchsim.construction.pin_wheel.pin_wheel_outlines import pendulum, wheel
from watchsim.construction.pin_wheel.pin_wheel_points import PinAnchor
from watchsim.construction.pin_wheel.pin_wheel_scene import scene_text
from watchsim.drawing.sheet import Sheet


def draw(values: PinWheel) -> dict[str, Sheet]:
    """Wheel, and pendulum with its anchor."""
    anchor = PinAnchor(values)
    return {"escape_wheel": Sheet(tuple(wheel(anchor))), "pendulum": Sheet(tuple(pendulum(anchor)))}


DESIGN = Design("pin_wheel", "Pin-wheel escapement of a tower clock with its pendulum", PinWheel, draw, scene_text, conflicts)
