"""Do the outlines in the rendered SVG frame lie on those of the model?"""

import math
import re
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from render.fake_runs import watch_run

import watchsim as ws
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc
from watchsim.pages.charts import poster
from watchsim.pages.player import drawn_parts
from watchsim.render.view import poses
from watchsim.simulation.trajectory import Trajectory

SHARE = 1e-6  # of the picture's width
OPENING = 0.437


def swiss() -> Trajectory:
    """The bodies of the Swiss lever, each turned to an angle of its own."""
    scene = ws.load(str(ws.profiles_dir() / "swiss_lever"))
    t = np.linspace(0.0, 1.0, 50)
    slices = {"wheel": slice(0, 1), "lever": slice(1, 2), "balance": slice(2, 3)}
    u = np.tile([1.234567891, 0.1, -3.0], (len(t), 1))
    made = watch_run()
    return Trajectory(
        **{
            **made.__dict__,
            "scene": scene,
            "t": t,
            "q": u * t[:, None],
            "u": u,
            "a": 0.0 * u,
            "slices": slices,
            "events": made.events[:0],
        }
    )


def matrix(text: str) -> np.ndarray:
    a, b, c, d, e, f = map(float, re.fullmatch(r"matrix\((.*)\)", text)[1].split())
    return np.array([[a, c, e], [b, d, f], [0.0, 0.0, 1.0]])


def points(data: str) -> Iterator[tuple[float, float]]:
    """Every vertex of path data of M, L, A and Z, and the middle of every arc."""
    x = y = 0.0
    for letter, body in re.findall(r"([MLAZ])([^MLAZ]*)", data):
        numbers = [float(word) for word in body.split()]
        if letter == "Z":
            continue
        ex, ey = numbers[-2:]
        if letter == "A":
            radius, sweep = numbers[0], numbers[4]
            dx, dy = ex - x, ey - y
            chord = math.hypot(dx, dy)
            height = radius - math.sqrt(max(radius * radius - 0.25 * chord * chord, 0.0))
            side = 1.0 if sweep else -1.0  # no arc here spans half a turn
            yield 0.5 * (x + ex) + side * height * dy / chord, 0.5 * (y + ey) - side * height * dx / chord
        x, y = ex, ey
        yield x, y


def distance(point: np.ndarray, loops: tuple[Loop, ...]) -> float:
    """From a point to the nearest edge of some outlines."""
    best = math.inf
    for edge in (edge for loop in loops for edge in loop.edges):
        ends = [math.dist(point, edge.start), math.dist(point, edge.end)]
        if isinstance(edge, Arc):
            angle = math.atan2(point[1] - edge.y, point[0] - edge.x)
            way = (angle - edge.start_angle) * math.copysign(1.0, edge.sweep) % math.tau
            on = abs(math.dist(point, (edge.x, edge.y)) - edge.radius) if way <= abs(edge.sweep) else math.inf
        else:
            a, b = np.array(edge.start), np.array(edge.end)
            share = np.clip((point - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
            on = math.dist(point, a + share * (b - a))
        best = min(best, on, *ends)
    return best


@pytest.mark.parametrize("made", [watch_run, swiss])
def test_outline_points_read_back_lie_on_the_model(made) -> None:
    run = made()
    window = (0.0, float(run.t[-1]))
    shapes = drawn_parts(run.scene, 1e-2)
    tree = ElementTree.fromstring(str(poster(run, window, shapes, OPENING)))
    _, _, width, height = map(float, tree.get("viewBox").split())
    ((place),) = (group for group in tree if group.tag == "g")
    whole = matrix(place.get("transform"))
    frames = {name: rows[0] for name, rows in poses(run, np.array([OPENING])).items()}
    seen = 0
    for group in place:
        if group.tag != "g":
            continue
        body = run.scene.body(shapes[int(group.get("data-part"))].body)
        own, (x, y, angle) = matrix(group.get("transform")), frames[body.name]
        c, s = math.cos(angle), math.sin(angle)
        for vertex in points(group[0].get("d")):
            shown = whole @ own @ (*vertex, 1.0)
            assert -1e-9 <= shown[0] <= width and -1e-9 <= shown[1] <= height
            moved = np.linalg.solve(whole, shown)[:2] * 1e-3 - (x, y)
            at_home = np.array([c * moved[0] + s * moved[1], -s * moved[0] + c * moved[1]])
            assert distance(at_home, (*body.loops, *body.decoration)) <= SHARE * 1e-3 * width, body.name
            seen += 1
    assert seen > 20


def test_the_small_whole_of_a_printed_clock_has_lines_as_fine_as_it_is_small() -> None:
    """Lines that kept their width on paper made it a dark blob."""
    run = ws.simulate(ws.load(ws.profiles_dir() / "graham"), duration=1.2, record="all")
    text = str(poster(run, (0.0, 1.2), drawn_parts(run.scene, 0.1), 1.0))
    left, _, width, height = map(float, re.search(r'viewBox="([^"]*)"', text)[1].split())
    scale = matrix(re.search(r"<use[^>]*transform=\"([^\"]*)\"", text)[1])[0, 0]
    pens = [float(pen) for pen in re.findall(r'stroke-width="([^"]*)"', text)]
    assert 0.0 < scale < 0.5 and -left < 0.35 * width
    assert max(pens) < 0.01 * height and scale * max(pens) < 0.02 * -left
    css = (Path(ws.__file__).parent / "pages" / "assets" / "page.css").read_text()
    assert "non-scaling-stroke" not in text + css
