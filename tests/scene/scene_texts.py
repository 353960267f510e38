"""What does the reader make of a scene written as a text, and what does it refuse? With bodies that forces act on."""

import pytest
import tomllib

from watchsim.scene.errors import SceneError
from watchsim.scene.load import from_mapping
from watchsim.scene.scene import Scene

BODIES = """
[bodies.a]
position = ["3 mm", "-2 mm"]
angle = "30°"
inertia = "5 g·cm²"
[bodies.b]
motion = "fixed"
position = ["11 mm", "6 mm"]
angle = "-50°"
[bodies.s]
motion = "slide"
axis = [3, 4]
mass = "2 g"
position = ["0 mm", "30 mm"]
[bodies.t]
motion = "slide"
axis = [3, 4]
mass = "7 g"
[bodies.d]
motion = "driven"
velocity = "2 rad/s"
position = ["50 mm", "0 mm"]
"""


def read(text: str) -> Scene:
    return from_mapping(tomllib.loads(text), None)


def faults(text: str) -> list[str]:
    with pytest.raises(SceneError) as caught:
        read(text)
    return [f"{fault.key}: {fault.message}" for fault in caught.value.faults]


def spring(body: str, more: str) -> str:
    return f'[[springs]]\nbody = "{body}"\n{more}'
