"""Are the phases those that the drawn outlines and other engines show?"""

import functools
import json
import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import pytest
import shapely
from shapely.affinity import affine_transform
from shapely.ops import nearest_points

import watchsim as ws
from watchsim.analysis.phases import Phase, phases
from watchsim.analysis.summary import summary, summary_text, tables
from watchsim.analysis.timeline import shown_beats
from watchsim.analysis.timing import beats, mean_over
from watchsim.escapement.measure import measure
from watchsim.geometry.primitives import Arc, Edge
from watchsim.paths import profiles_dir
from watchsim.scene.load import load
from watchsim.scene.roles import hinged_pallets
from watchsim.scene.scene import Body
from watchsim.simulation.simulate import simulate
from watchsim.simulation.trajectory import Trajectory

# Are the phases of cylinder and duplex those that the outlines show, placed by the motion alone?

TOUCHING, FREE, RISE = 2e-8, 1e-7, 2e-9  # m; RISE: of an arc above its chords
BEGUN = 0.3  # of a phase: a gap opens with the square of time
PARTS = {  # profile -> phase -> layers that touch in it, wheel and balance
    "cylinder": dict.fromkeys(("unlock", "impulse", "locked"), ("TEETH", "SHELL")),
    "duplex": {"unlock": ("RESTING", "ROLLER"), "impulse": ("IMPULSE", "PALLET"), "locked": ("RESTING", "ROLLER")},
}


@functools.cache
def run_of(name: str) -> Trajectory:
    return ws.simulate(ws.load(ws.profiles_dir() / name / "scene.toml"), duration=2.2)


@functools.cache
def lines(name: str, body: str, layer: str) -> tuple[shapely.LineString, ...]:
    """The edges of a layer in the body's frame."""
    found: Body = run_of(name).scene.body(body)
    edges = (edge for loop in found.loops if loop.layer == layer for edge in loop.edges)
    return tuple(shapely.LineString([edge.point(i / n) for i in range(n + 1)]) for edge in edges for n in (chords(edge),))


def chords(edge: Edge) -> int:
    """So many that none is further than RISE from its arc."""
    return math.ceil(abs(edge.sweep) / math.sqrt(8.0 * RISE / edge.radius)) if isinstance(edge, Arc) and edge.radius else 1


def arcs_about_the_axis(name: str, layer: str) -> list[float]:
    """The radii of those arcs of the balance's layer, m."""
    edges = [edge for loop in run_of(name).scene.body("balance").loops if loop.layer == layer for edge in loop.edges]
    return sorted({edge.radius for edge in edges if isinstance(edge, Arc) and math.hypot(edge.x, edge.y) < 1e-9})


def placed(run: Trajectory, name: str, body: str, layer: str, t: float) -> list[shapely.LineString]:
    x, y, angle = run.pose(body, t)
    c, s = math.cos(angle), math.sin(angle)
    return [affine_transform(line, [c, -s, s, c, x, y]) for line in lines(name, body, layer)]


def apart(name: str, layers: tuple[str, str], t: float) -> tuple[float, float, float]:
    """Distance of two layers, and how far their nearest points are from the axes of wheel and balance, m."""
    run = run_of(name)
    wheel, balance = (placed(run, name, body, layer, t) for body, layer in zip(("wheel", "balance"), layers, strict=True))
    whole = shapely.MultiLineString(balance)
    near = shapely.MultiLineString([line for line in wheel if line.distance(whole.envelope) < 1e-5] or wheel[:1])
    a, b = nearest_points(near, whole)
    axes = (run.scene.body(body).position for body in ("wheel", "balance"))
    return a.distance(b), *(math.dist((point.x, point.y), axis) for point, axis in zip((a, b), axes, strict=True))


def of(name: str, kind: str) -> Iterator[tuple[float, float]]:
    """Start and end of the phases of that name in the last oscillations."""
    found = [(one.start, one.end) for one in phases(run_of(name))[-15:] if one.name == kind]
    assert found
    return iter(found)


@pytest.mark.parametrize("kind", ["catch-up", "drop"])
@pytest.mark.parametrize("name", PARTS)
def test_the_wheel_is_free_while_it_catches_up_and_drops(name: str, kind: str) -> None:
    """From when the tooth leaves what it touched until it meets what comes next, and not a moment longer."""
    pairs = set(PARTS[name].values())
    before, after = ("unlock", "impulse") if kind == "catch-up" else ("impulse", "locked")
    for start, end in of(name, kind):
        inside = start + (end - start) * np.linspace(BEGUN, 0.97, 7)
        assert min(apart(name, pair, t)[0] for t in inside for pair in pairs) > FREE
        assert apart(name, PARTS[name][before], start)[0] < TOUCHING
        assert apart(name, PARTS[name][after], end)[0] < TOUCHING


@pytest.mark.parametrize("kind", ["unlock", "impulse", "locked"])
@pytest.mark.parametrize("name", PARTS)
def test_the_tooth_touches_what_the_phase_is_named_after(name: str, kind: str) -> None:
    """At most instants: impacts may throw it off for a moment."""
    for start, end in of(name, kind):
        inside = start + (end - start) * np.linspace(0.1, 0.99, 10)
        touching = [apart(name, PARTS[name][kind], t)[0] < TOUCHING for t in inside]
        assert sum(touching) >= 8, kind


@pytest.mark.parametrize("name", PARTS)
def test_a_locked_tooth_rests_on_an_arc_about_the_balance(name: str) -> None:
    """On the shell, outside or inside, or on the roller, by one and the same point of the tooth."""
    radii, toes = arcs_about_the_axis(name, PARTS[name]["locked"][1]), []
    for start, end in of(name, "locked"):
        for t in start + (end - start) * np.linspace(0.3, 0.95, 4):
            _, toe, rest = apart(name, PARTS[name]["locked"], t)
            assert min(abs(rest - radius) for radius in radii) < TOUCHING
            toes.append(toe)
    assert np.ptp(toes) < 1e-5


def test_the_cylinder_is_pushed_at_its_lips() -> None:
    """Between the inner and the outer radius of the shell, while the point of contact goes along the tooth's face."""
    radii = arcs_about_the_axis("cylinder", "SHELL")
    for start, end in of("cylinder", "impulse"):
        found = [apart("cylinder", ("TEETH", "SHELL"), t) for t in start + (end - start) * np.linspace(0.2, 0.9, 6)]
        lips = [rest for gap, _, rest in found if gap < TOUCHING]
        along = [toe for gap, toe, _ in found if gap < TOUCHING]
        assert all(radii[0] - TOUCHING < rest < radii[-1] + TOUCHING for rest in lips)
        assert np.ptp(along) > 5e-6


# Are the phases of a grasshopper those that the drawn outlines show, placed by the motion alone?

TOUCHING_HINGED_PHASES, FREE_HINGED_PHASES, RISE_HINGED_PHASES = 1e-7, 1e-5, 1e-8  # m; RISE: of an arc above its chords


@functools.cache
def run_of_hinged_phases(amplitude: str = "") -> Trajectory:
    scene = ws.load(ws.profiles_dir() / "grasshopper")
    return ws.simulate(scene.set("bodies.pendulum.angle", amplitude) if amplitude else scene, duration=4.2)


@functools.cache
def edges(body: str) -> tuple[shapely.LineString, ...]:
    found = run_of_hinged_phases().scene.body(body)
    return tuple(chain(edge) for loop in found.loops for edge in loop.edges)


def chain(edge: Edge) -> shapely.LineString:
    count = (
        math.ceil(abs(edge.sweep) / math.sqrt(8.0 * RISE_HINGED_PHASES / edge.radius))
        if isinstance(edge, Arc) and edge.radius
        else 1
    )
    return shapely.LineString([edge.point(i / count) for i in range(count + 1)])


def apart_hinged_phases(pallet: str, t: float) -> float:
    """m."""
    placed = []
    for body in ("wheel", pallet):
        x, y, angle = run_of_hinged_phases().pose(body, t)
        c, s = math.cos(angle), math.sin(angle)
        placed.append([affine_transform(line, [c, -s, s, c, x, y]) for line in edges(body)])
    whole = shapely.MultiLineString(placed[1])
    near = [line for line in placed[0] if line.distance(whole.envelope) < 1e-4]
    return float(shapely.MultiLineString(near).distance(whole)) if near else math.inf


def told() -> list[Phase]:
    return phases(run_of_hinged_phases())[4:]


def test_each_half_swing_has_an_impulse_and_a_recoil_by_the_pallets_in_turn() -> None:
    rows = told()
    assert hinged_pallets(run_of_hinged_phases().scene) == ("entry", "exit")
    assert [row.name for row in rows] == ["impulse", "recoil"] * (len(rows) // 2)
    assert len(rows) >= 8
    for one, after in pairwise(rows):
        assert after.start == pytest.approx(one.end, abs=1e-12)
        assert (one.on == after.on) == (one.name == "recoil")  # a pallet that has caught a tooth keeps it over the turn


def test_the_pallet_that_a_phase_names_touches_and_the_other_does_not() -> None:
    for row in told():
        other = "exit" if row.on == "entry" else "entry"
        for t in row.start + (row.end - row.start) * np.array([0.1, 0.5, 0.9]):
            assert apart_hinged_phases(row.on, t) < TOUCHING_HINGED_PHASES
        # The other has no tooth yet while one pushes; after the change it jumps off.
        assert apart_hinged_phases(other, 0.5 * (row.start + row.end)) > FREE_HINGED_PHASES


def test_the_wheel_goes_on_in_the_impulse_and_back_in_the_recoil() -> None:
    for row in told():
        inside = np.linspace(row.start, row.end, 40)
        way = -np.diff(run_of_hinged_phases().sample(inside)[0][:, run_of_hinged_phases().slices["wheel"].start])
        assert (way > 0.0).all() if row.name == "impulse" else (way < 0.0).all()


def test_the_beats_account_closes() -> None:
    for beat in shown_beats(run_of_hinged_phases()):
        assert abs(beat.residual) < 1e-4 * sum(stage.energy.supplied for stage in beat.stages)


def test_a_pendulum_that_swings_too_little_has_no_phases() -> None:
    """Where no pallet takes over, the wheel only goes to and fro."""
    assert phases(run_of_hinged_phases("2°")) == []


def test_check_says_why_there_is_no_lock() -> None:
    found = measure(run_of_hinged_phases().scene)
    assert found.pallets is None
    assert any(what == "lock, draw, drop" and "hinged on pendulum" in why for what, why in found.missing)


# What is read from a simulated lever escapement, against other engines and against the drawing?

NAMES = ["unlock", "catch-up", "impulse", "drop", "run to banking", "locked"]


def test_beats_agree_with_other_engines(bench_lever):
    means = mean_over(bench_lever, (1.0, 3.0))
    assert means.amplitude_deg == pytest.approx(283.01, abs=0.6)  # it still grows by 3° within the window
    assert means.period_s == pytest.approx(0.25007014, abs=1e-6)
    assert means.amplitude_deg_error > 0.6  # and says so


@pytest.mark.slow
def test_the_settled_window():
    run = simulate(load(profiles_dir() / "bench_lever" / "scene.toml"), duration=15.0)
    means = mean_over(run, (13.0, 15.0))
    assert means.amplitude_deg == pytest.approx(290.73, abs=0.05) and means.amplitude_deg_error < 0.02
    assert means.period_s == pytest.approx(0.25006568, abs=1e-6) and means.period_s_error < 1e-8
    assert summary(run)["missed_beats"] == 0


def test_amplitudes_are_those_of_the_recorded_motion(bench_lever):
    found = beats(bench_lever)
    column = bench_lever.slices["balance"].start
    assert bench_lever.sample(found.end)[0][:, column] == pytest.approx(found.end_at, abs=1e-9)
    assert bench_lever.sample(found.end)[1][:, column] == pytest.approx(0.0, abs=1e-6)
    assert bench_lever.sample(found.t)[0][:, column] == pytest.approx(0.0, abs=1e-8)


def test_every_beat_is_heard_counted_and_told(bench_lever):
    found = ws.beats(bench_lever)
    assert len(found) == 22 and np.isfinite(found.tick).all() and np.diff(found.t).max() < 0.126
    numbers = summary(bench_lever)
    assert numbers["missed_beats"] == 0 and not numbers["stopped"]
    assert numbers["beat_error_ms"] < 0.02 and numbers["timegrapher"]["amplitude_deg"] > numbers["amplitude_deg"]
    assert json.loads(json.dumps(numbers, allow_nan=False)) == numbers
    assert "missed beats none in 22 half swings" in summary_text(bench_lever, numbers)
    assert len(str(tables(bench_lever)["beats.csv"]).splitlines()) == 23


def test_phases_have_the_angles_of_the_drawing(bench_lever):
    rows = phases(bench_lever)
    assert [row.name for row in rows[:120]] == NAMES * 20
    degrees = {name: [[math.degrees(x) for x in row.turns] for row in rows if row.name == name] for name in NAMES}
    # Total lock, 2.0°, is what the lever turns to unlock; impulse, drop and run bring it to the other bank, 11.0° in all.
    assert [abs(turn[1]) for turn in degrees["unlock"]] == pytest.approx([2.0] * 22, abs=1e-4)
    assert all(turn[0] > 0.2 for turn in degrees["unlock"])  # draw makes the wheel recoil
    for first in range(0, 120, 6):
        beat = rows[first : first + 6]
        assert sum(math.degrees(row.turns[0]) for row in beat) == pytest.approx(-12.0, abs=0.06)  # half a pitch
        assert abs(sum(math.degrees(row.turns[1]) for row in beat)) == pytest.approx(11.0, abs=1e-6)
        assert all(a.end == b.start for a, b in pairwise(beat))
    assert max(abs(turn[1]) for turn in degrees["locked"]) < 1e-9


def test_energy_of_the_run(bench_lever):
    assert bench_lever.energy["residual_relative"] < 1e-8
    wheel = bench_lever.slices["wheel"].start
    assert bench_lever.energy["in_J"] == pytest.approx(
        6e-6 * abs(bench_lever.q[-1, wheel] - bench_lever.q[0, wheel]), rel=1e-9, abs=0.0
    )


def test_a_balance_out_of_beat_by_one_and_a_half_degrees():
    """(T1 - T2)/2 = 2 asin(offset/amplitude)/w, 0.42 ms here."""
    scene = load(profiles_dir() / "bench_lever" / "scene.toml").set("springs.0.rest", "1.5°")
    means = mean_over(simulate(scene, duration=3.0), (2.0, 3.0))
    expected = 1e3 * 2.0 * math.asin(1.5 / means.amplitude_deg) / (8.0 * math.pi)
    assert means.beat_error_ms == pytest.approx(expected, rel=0.04)
    assert means.beat_error_ms_error < 0.01 * expected
