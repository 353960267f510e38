"""Are teeth counted, and is the way that they lean seen, however a wheel is drawn?

The wheels are drawn here from their number of teeth by seeds, and by programs that know neither arcs nor rotation.
"""

import json
import math
import random
from pathlib import Path

import ezdxf
import pytest

from watchsim.cli import main
from watchsim.proposal.propose import propose
from watchsim.proposal.roles import Role, lean_of

TURN = 2.0 * math.pi
Corners = list[tuple[float, float]]


def toothed(teeth: int, kind: str, mirrored: bool) -> tuple[Corners, int]:
    """Corners of a wheel of radius 1 in (r, angle), and +1 where its tips lean counter-clockwise."""
    pitch = TURN / teeth
    low = 1.0 - (min(0.22, max(0.9 * pitch, 0.01)) if teeth >= 8 else 0.35)
    middle = 0.5 * (low + 1.0)
    tooth, lean = {
        "ratchet": ([(low, 0.0), (1.0, 0.92)], 1),
        "escape": ([(low, 0.0), (middle, 0.42), (1.0, 0.55), (1.0, 0.63), (low, 0.5)], 1),
        "gear": ([(low, -0.32), (middle, -0.25), (1.0, -0.12), (1.0, 0.12), (middle, 0.25), (low, 0.32)], 0),
        "star": ([(low, -0.5), (1.0, 0.0)], 0),
    }[kind]
    way = -1 if mirrored else 1
    corners = [(r, way * (k + share) * pitch) for k in range(teeth) for r, share in tooth]
    return corners[::way], way * lean


def drawn_by(seed: int, path: Path) -> tuple[int, int, tuple[float, float]]:
    """A wheel turned, mirrored, off the origin, in mm or inches, rounded or not, with a bore, facets for one, or spokes.

    Its teeth, its lean, and its centre (m).
    """
    dice = random.Random(seed)
    teeth = dice.choice([dice.randint(3, 200), dice.randint(55, 200), dice.randint(8, 60)])
    kind = dice.choice(["ratchet", "escape", "gear", "star"]) if teeth >= 6 else "ratchet"
    inches = dice.random() < 0.25
    corners, lean = toothed(teeth, kind, dice.random() < 0.5)
    radius, turn, x, y = dice.uniform(1.5, 30.0), dice.uniform(0.0, 6.28), dice.uniform(-50.0, 50.0), dice.uniform(-50.0, 50.0)
    decimals = dice.choice([16, 6, 6 if inches else 4])
    unit = 25.4 if inches else 1.0

    def put(r: float, angle: float) -> tuple[float, float]:
        places = x + radius * r * math.cos(angle + turn), y + radius * r * math.sin(angle + turn)
        return round(places[0] / unit, decimals), round(places[1] / unit, decimals)

    document = ezdxf.new("R2010", units=ezdxf.units.IN if inches else ezdxf.units.MM)
    space = document.modelspace()
    space.add_lwpolyline([put(*corner) for corner in corners], close=True)
    inside = dice.choice(["bore", "facets", "spokes", "nothing"])
    if inside in ("bore", "spokes"):
        space.add_circle(put(0.0, 0.0), 0.1 * radius / unit)
    if inside == "facets":
        space.add_lwpolyline([put(0.1, TURN * k / 64) for k in range(64)], close=True)
    windows = dice.choice([4, 5, 6]) if inside == "spokes" else 0
    for k in range(windows):
        way = [TURN * (k + 0.05 * j) / windows for j in range(15)]
        space.add_lwpolyline([*(put(0.2, angle) for angle in way), *(put(0.5, angle) for angle in way[::-1])], close=True)
    document.saveas(path)
    return teeth, lean, (1e-3 * x, 1e-3 * y)


def the_wheel(path: Path) -> Role:
    (role,) = propose([path]).roles
    return role


@pytest.mark.parametrize("seeds", [range(6), pytest.param(range(6, 300), marks=pytest.mark.slow)], ids=["few", "many"])
def test_a_wheel_by_seed(seeds: range, tmp_path: Path) -> None:
    """Of all wheels teeth, lean and centre; those with 59 teeth or more come within 0.2 % of a radius of one tooth more."""
    for seed in seeds:
        teeth, lean, centre = drawn_by(seed, tmp_path / f"{seed}.dxf")
        role = the_wheel(tmp_path / f"{seed}.dxf")
        assert (role.teeth, lean_of(role.part)) == (teeth, lean), f"seed {seed}"
        assert role.part.centre is not None
        assert math.dist(role.part.centre.at, centre) < 1e-6, f"seed {seed}"


@pytest.mark.parametrize("lean", [0.4, 0.7, 1.1, 1.6])
@pytest.mark.parametrize(("teeth", "way"), [(15, 1), (15, -1), (60, -1), (120, 1)])
def test_hooks_may_lean_over_more_than_a_pitch(teeth: int, way: int, lean: float, tmp_path: Path) -> None:
    depth, pitch, steps = min(0.25, 1.2 * TURN / teeth), TURN / teeth, [k / 12 for k in range(13)]
    up = [(1.0 - depth * (1.0 - share), lean * share**1.5) for share in steps]
    down = [(r, place + 0.1 + 0.35 * (1.0 - share)) for share, (r, place) in zip(steps[::-1], up[::-1], strict=True)]
    corners = [(r, way * (k + place) * pitch) for k in range(teeth) for r, place in (*up, *down)]
    document = ezdxf.new("R2010", units=ezdxf.units.MM)
    places = [(10.0 * r * math.cos(angle), 10.0 * r * math.sin(angle)) for r, angle in corners[::way]]
    document.modelspace().add_lwpolyline(places, close=True)
    document.saveas(tmp_path / "wheel.dxf")
    role = the_wheel(tmp_path / "wheel.dxf")
    assert (role.teeth, lean_of(role.part)) == (teeth, way)


@pytest.mark.parametrize("pieces", [24, 30, 64])
@pytest.mark.parametrize("teeth", [7, 15, 60])
def test_a_wheel_on_a_rim_of_straight_pieces(pieces: int, teeth: int, tmp_path: Path) -> None:
    """As OpenSCAD writes it: rim and bore of 24, 30 or 64 pieces, which do not go with the teeth."""
    shapely = pytest.importorskip("shapely")
    low, pitch = (0.92, TURN / teeth) if teeth > 40 else (0.78, TURN / teeth)

    def at(r: float, angle: float) -> tuple[float, float]:
        return r * math.cos(angle), r * math.sin(angle)

    made = shapely.Polygon([at(low, TURN * k / pieces) for k in range(pieces)])
    for k in range(teeth):
        tooth = [(low - 0.1, -0.1), (low - 0.1, 0.2), (1.0, 0.42), (1.0, 0.36)]
        made = made.union(shapely.Polygon([at(r, (k + share) * pitch) for r, share in tooth]))
    document = ezdxf.new("R2010", units=ezdxf.units.MM)
    bore = [at(0.12, TURN * k / pieces) for k in range(pieces)]
    for ring in (list(made.exterior.coords)[:-1], bore):
        places = [(round(17.3 + 5.0 * x, 6), round(-8.1 + 5.0 * y, 6)) for x, y in ring]
        for start, end in zip(places, [*places[1:], places[0]], strict=True):
            document.modelspace().add_line(start, end)
    document.saveas(tmp_path / "wheel.dxf")
    role = the_wheel(tmp_path / "wheel.dxf")
    assert (role.teeth, lean_of(role.part)) == (teeth, 1)
    assert role.part.centre is not None
    assert math.dist(role.part.centre.at, (17.3e-3, -8.1e-3)) < 1e-8


def test_the_command_counts_the_teeth_of_a_wheel(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    document = ezdxf.new("R2010", units=ezdxf.units.MM)
    corners = [(10.0 * r * math.cos(angle), 10.0 * r * math.sin(angle)) for r, angle in toothed(120, "ratchet", True)[0]]
    document.modelspace().add_lwpolyline(corners, close=True)
    document.saveas(tmp_path / "wheel.dxf")
    assert main(["new", str(tmp_path / "wheel.dxf"), "-o", str(tmp_path / "out"), "--json"]) == 0
    (body,) = json.loads(capsys.readouterr().out)["bodies"]
    assert body["task"] == "wheel" and body["teeth"] == 120
