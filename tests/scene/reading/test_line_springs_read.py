"""How long, stiff and stretched is a spring between two points, as a scene writes it?"""

from __future__ import annotations

import math

import pytest
from scene_texts import BODIES, faults, read

from watchsim.scene.forces import LineSpring

WITH_CARRIED = BODIES + '[bodies.c]\non = "a"\ninertia = "5 g·cm²"\n'
POINTS = 'points = [["4 mm", "1 mm"], ["-2 mm", "5 mm"]]\n'
TURN = math.radians


def line(ends: str, more: str, points: str = POINTS) -> str:
    return f"[[line_springs]]\nbetween = {ends}\n{points}{more}"


def apart(other: complex, turned: complex) -> float:
    """m, at the start, of (4, 1) mm on the body a from (-2, 5) mm on another."""
    first = 3e-3 - 2e-3j + (4e-3 + 1e-3j) * complex(math.cos(TURN(30)), math.sin(TURN(30)))
    return abs(first - (other + (-2e-3 + 5e-3j) * turned))


FIXED = apart(11e-3 + 6e-3j, complex(math.cos(TURN(50)), -math.sin(TURN(50))))
FREE = apart(0j, 1 + 0j)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (line('["a", "b"]', 'stiffness = "20 N/m"\nlength = "0.5 mm"\n'), (("a", "b"), 20.0, 5e-4, 0.0)),
        (line('["a", "b"]', 'stiffness = "20 N/m"\nlength = "0 mm"\n'), (("a", "b"), 20.0, 0.0, 0.0)),
        (line('["a", "b"]', 'stiffness = "20 N/m"\n'), (("a", "b"), 20.0, FIXED, 0.0)),
        (line('["a", "b"]', 'stiffness = "20 N/m"\ntension = "0.08 N"\n'), (("a", "b"), 20.0, FIXED - 4e-3, 0.0)),
        (line('["a", "b"]', 'stiffness = "20 N/m"\ntension = "-0.08 N"\n'), (("a", "b"), 20.0, FIXED + 4e-3, 0.0)),
        (line('["a"]', 'stiffness = "20 N/m"\nviscous = "3 N·s/m"\n'), (("a", None), 20.0, FREE, 3.0)),
    ],
)
def test_a_line_spring_between_two_points(text: str, expected: tuple[tuple[str, str | None], float, float, float]) -> None:
    (found,) = read(WITH_CARRIED + text).line_springs
    assert isinstance(found, LineSpring) and found.between == expected[0]
    assert (found.stiffness, found.length, found.viscous) == pytest.approx(expected[1:], rel=1e-12, abs=0.0)
    assert found.points == ((4e-3, 1e-3), (-2e-3, 5e-3))


STIFF = 'stiffness = "20 N/m"\n'
REFUSED = [
    (line('["a", "b"]', 'stiffness = "20 N/m"\nlength = "-0.1 µm"\n'), ["line_springs.0.length: a length is not negative"]),
    (
        line('["a", "b"]', f'stiffness = "20 N/m"\ntension = "{20 * FIXED + 1e-6!r} N"\n'),
        ["line_springs.0.tension: without force"],
    ),
    (line('["a", "b"]', STIFF + 'length = "1 mm"\ntension = "1 N"\n'), ["line_springs.0.tension: length and tension say"]),
    (line('["a", "b"]', STIFF + 'viscous = "-0.1 N·s/m"\n'), ["line_springs.0.viscous: negative damping"]),
    (line('["a", "b"]', ""), ["line_springs.0: missing: stiffness"]),
    (line('["a", "b"]', STIFF, ""), ["line_springs.0: a point of each is needed"]),
    (line('["a", "b"]', STIFF, 'points = [["1 mm", "2 mm"]]\n'), ["line_springs.0.points: a point of each is needed"]),
    (line('["a", "b"]', STIFF, 'points = [["1 mm", "2 mm"], ["3 mm", 4]]\n'), ["line_springs.0.points.1.1: a bare number"]),
    (line('["b"]', STIFF), ["line_springs.0.between: nothing that it holds can give way"]),
    (line('["d", "b"]', STIFF), ["line_springs.0.between: nothing that it holds can give way"]),
    (line('["d"]', STIFF), ["line_springs.0.between: nothing that it holds can give way"]),
    (line('["a", "b", "d"]', STIFF), ["line_springs.0.between: one or two bodies are needed"]),
    (line('["a", "a"]', STIFF), ["line_springs.0.between: one or two bodies are needed"]),
    (line("[]", STIFF), ["line_springs.0.between: one or two bodies are needed"]),
    ("[[line_springs]]\n" + STIFF + POINTS, ["line_springs.0: one or two bodies are needed"]),
    (line('["a", "e"]', STIFF), ['line_springs.0.between.1: there is no body "e"']),
    (line('["c"]', STIFF), ["line_springs.0.between.0: c is carried by a"]),
    (line('["a"]', STIFF, 'points = [["0 mm", "0 mm"], ["3 mm", "-2 mm"]]\n'), ["line_springs.0.points: lie on each other"]),
]


@pytest.mark.parametrize(("text", "expected"), REFUSED)
def test_what_cannot_be_is_said_once(text: str, expected: list[str]) -> None:
    said = faults(WITH_CARRIED + text)
    assert len(said) == len(expected) and all(one.startswith(words) for one, words in zip(said, expected, strict=True)), said
