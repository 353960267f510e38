"""Are derivatives on the limit cycle what mechanics says they must be?"""

import math
from dataclasses import replace

import pytest

import watchsim as ws
from watchsim.cli import main
from watchsim.studies.point import outputs_named
from watchsim.studies.sensitivity import effect_of, fixed_nominal, points_of, quantities

BENCH = ws.profiles_dir() / "bench_lever"


@pytest.fixture(scope="module")
def everything():
    return ws.sensitivity(BENCH)


FORCES = [
    *("torques.0.value", "springs.0.stiffness", "damping.0.viscous"),
    *(f"bodies.{name}.inertia" for name in ("wheel", "lever", "balance")),
]


@pytest.fixture(scope="module")
def found():
    return ws.sensitivity(BENCH, FORCES)


def effects(found, column):
    return {effect.quantity.key: effect.by[column] for effect in found.effects}


@pytest.mark.slow
def test_all_numbers_of_the_scene(everything):
    assert all(one.agrees for effect in everything.effects for one in effect.by.values())
    keys = {effect.quantity.key for effect in everything.effects}
    assert {"torques.0.value", "springs.0.stiffness", "damping.0.viscous", "bodies.balance.inertia"} <= keys
    assert {"contacts.0.friction", "contacts.2.restitution", "bodies.lever.position.0", "bodies.banking.position.1"} <= keys
    assert not [key for key in keys if "velocity" in key or "run." in key or key == "bodies.balance.angle"]
    sizes = [abs(row["amplitude_deg_per_change"]) for row in everything.rows()]
    assert sizes == sorted(sizes, reverse=True)


def test_what_of_a_design_can_be_varied_and_how_far():
    """Neither counts, nor where the balance is let go, nor how a hairspring is pictured; limits are the design's own."""
    scene = ws.designs.swiss_lever(lock="0.1°", run="1.9°", q_factor=300).scene()
    by = {one.key: one for one in quantities(fixed_nominal(scene))}
    assert {"design.lock", "design.q_factor", "design.draw", "design.torque"} <= set(by)
    assert not {"design.teeth", "design.embraced", "design.start"} & set(by)
    assert not [key for key in by if key.startswith("springs.0.draw")]
    assert by["design.lock"].low == pytest.approx(math.radians(0.1), abs=1e-15)
    assert by["design.lock"].high == pytest.approx(math.radians(4.0))
    assert by["design.torque"].low == pytest.approx(1e-9)
    assert (by["design.lock"].unit, by["design.torque"].unit, by["springs.0.stiffness"].unit) == ("°", "µN·m", "nN·m/rad")
    assert all(value >= by["design.lock"].low for _, value in points_of(by["design.lock"]))


def test_a_value_that_is_refused_has_its_reason_in_the_table():
    (quantity,) = [one for one in quantities(fixed_nominal(ws.load(BENCH))) if one.key == "torques.0.value"]
    refused = {value: {"amplitude_deg": None, "verdict": None, "message": "too small"} for _, value in points_of(quantity)}
    effect = effect_of(
        quantity, refused, {"amplitude_deg": 280.0, "beat_error_ms": 0.0}, outputs_named(["amplitude", "beat_error"])
    )
    assert effect.message == "too small"
    assert all(one.value is None for one in effect.by.values())


def test_two_steps_agree(found):
    assert all(one.agrees for effect in found.effects for one in effect.by.values())


@pytest.mark.slow
@pytest.mark.parametrize("axis", ["0", "1"])
@pytest.mark.parametrize("column", ["amplitude_deg", "rate_s_per_d", "beat_error_ms"])
def test_a_watch_may_be_put_elsewhere(everything, column, axis):
    """Shifting all bodies alike changes nothing: the derivatives by their positions add up to zero."""
    by = effects(everything, column)
    each = [by[f"bodies.{name}.position.{axis}"].value for name in ("wheel", "lever", "balance", "banking")]
    assert abs(sum(each)) < 1e-5 * max(map(abs, each))


def elasticities(found, column, keys):
    values = {one.key: one.value for one in (effect.quantity for effect in found.effects)}
    by = effects(found, column)
    return sum(by[key].value * values[key] for key in keys)


def test_forces_have_no_unit_of_their_own(found):
    """All masses, stiffnesses, torques and dampings times a factor is the same motion."""
    assert abs(elasticities(found, "amplitude_deg", FORCES)) < 1e-4 * found.cycle.amplitude_deg
    assert abs(elasticities(found, "rate_s_per_d", FORCES)) < 1e-4 * 86400.0


def test_time_has_no_unit_of_its_own(found):
    """Stiffness and torque times s², damping times s: the same path in 1/s of the time."""
    by_amplitude = 2.0 * elasticities(found, "amplitude_deg", ["torques.0.value", "springs.0.stiffness"])
    by_amplitude += elasticities(found, "amplitude_deg", ["damping.0.viscous"])
    assert abs(by_amplitude) < 1e-4 * found.cycle.amplitude_deg
    # 86400 (T0/T - 1) with T0 kept: the rate grows by 86400 T0/T for each unit of ln s.
    by_rate = 2.0 * elasticities(found, "rate_s_per_d", ["torques.0.value", "springs.0.stiffness"])
    by_rate += elasticities(found, "rate_s_per_d", ["damping.0.viscous"])
    assert by_rate == pytest.approx(86400.0 + found.cycle.rate_s_per_d, rel=1e-5)


def test_against_sweeps(found):
    """The derivative by the torque is the slope of a sweep."""
    step = 0.05e-6
    rows = ws.sweep(BENCH, {"torques.0.value": [-6e-6 - step, -6e-6 + step]}).rows
    slope = (rows[1]["amplitude_deg"] - rows[0]["amplitude_deg"]) / (2.0 * step)
    assert effects(found, "amplitude_deg")["torques.0.value"].value == pytest.approx(slope, rel=1e-4)


def test_period_against_inertia_and_stiffness(found):
    """T = 2π √(I/k) (1 + δ): slopes of ±1/2 in logarithms, but for how the escapement's deviation δ itself changes.

    That change is predicted from the others: δ depends on torque, damping and inertias, whose derivatives are known.
    """
    rate, scale = effects(found, "rate_s_per_d"), 86400.0 + found.cycle.rate_s_per_d
    values = {one.quantity.key: one.quantity.value for one in found.effects}
    slope = {key: -rate[key].value * values[key] / scale for key in rate}
    others = slope["bodies.wheel.inertia"] + slope["bodies.lever.inertia"]
    torque, damping = slope["torques.0.value"], slope["damping.0.viscous"]
    # From the two similarities above, δ alone: by ln I and by ln k.
    by_inertia = -others + torque + 0.5 * damping - (torque + damping)
    by_stiffness = -torque - 0.5 * damping
    assert slope["bodies.balance.inertia"] - by_inertia == pytest.approx(0.5, abs=1e-4)
    assert slope["springs.0.stiffness"] - by_stiffness == pytest.approx(-0.5, abs=1e-4)


@pytest.mark.parametrize(
    "design, values, name, side",
    [
        ("swiss_lever", {}, "q_factor", 0),
        ("swiss_lever", {}, "frequency", 0),  # with the Q kept, as the design has it
        ("swiss_lever", {"q_factor": 2000.0, "torque": "0.15 µN·m"}, "q_factor", -1),  # at its upper bound
        ("duplex", {"friction": 0.2}, "friction", -1),
    ],
)
def test_dimensions_of_a_design_against_sweeps(design, values, name, side):
    """Also those that springs and damping are written by; at an upper bound with the sign that the amplitude has."""
    scene = getattr(ws.designs, design)(**values).scene()
    effect = ws.sensitivity(scene, [f"design.{name}"], outputs=["amplitude"]).effects[0]
    one, step = effect.quantity, 2.0 * effect.quantity.step
    assert (one.value + step > one.high) is (side < 0)
    places = [one.value + (k + side) * step for k in (-1, 0, 1)]
    low, middle, high = (row["amplitude_deg"] for row in ws.sweep(scene, {one.key: places}, outputs=["amplitude"]).rows)
    slope = (high - low + side * (2.0 * middle - high - low)) / (2.0 * step)
    assert effect.message == "" and abs(slope) > 1e-3
    assert effect.by["amplitude_deg"].value == pytest.approx(slope, rel=2e-3)


def test_what_is_only_drawn_is_no_quantity():
    scene = ws.load(ws.profiles_dir() / "swiss_lever")
    assert scene.source["springs"][0]["draw"]["outer"]  # this one has a hairspring to be seen
    assert not [one.key for one in quantities(scene) if ".draw" in one.key]


def test_springs_count_by_stiffness():
    scene = fixed_nominal(ws.load(BENCH))
    keys = {one.key for one in quantities(scene)}
    assert "springs.0.stiffness" in keys and "springs.0.frequency" not in keys
    assert scene.springs[0].stiffness == pytest.approx(12e-10 * (2.0 * math.pi * 4.0) ** 2, rel=1e-12)
    assert scene.nominal == 4.0


def test_where_a_moving_body_starts_is_no_quantity():
    scene = ws.load(BENCH).set("bodies.banking.angle", "0°")
    keys = {one.key for one in quantities(scene)}
    moving = [body.name for body in scene.bodies if body.motion != "fixed"]
    assert "bodies.banking.angle" in keys and len(moving) == 3
    assert not {f"bodies.{name}.angle" for name in moving} & keys
    assert {f"bodies.{name}.position.1" for name in moving} <= keys


def test_bounds_are_kept():
    """Friction 0 has nothing below it: the difference looks upwards only."""
    scene = ws.load(BENCH).set("contacts.1.friction", 0.0)
    one = ws.sensitivity(scene, ["contacts.1.friction"]).effects[0]
    assert one.message == ""
    rows = ws.sweep(scene, {"contacts.1.friction": [0.0, 0.002, 0.004]}, outputs=["amplitude"]).rows
    first, second, third = (row["amplitude_deg"] for row in rows)
    assert one.by["amplitude_deg"].value == pytest.approx((4.0 * second - third - 3.0 * first) / 0.004, rel=0.01)


@pytest.mark.parametrize("jump, agrees", [(0.0, True), (0.01, False)])
def test_a_jump_is_told(jump, agrees):
    """Where the amplitude jumps two steps cannot agree, and the row says so."""
    friction = next(one for one in quantities(ws.load(BENCH)) if one.key == "contacts.0.friction")

    def row(value):
        amplitude = 290.0 - 30.0 * (value - friction.value) + jump * (value > friction.value)
        return {"amplitude_deg": amplitude, "message": "", "verdict": "ticks"}

    rows = {value: row(value) for _, value in points_of(friction)}
    effect = effect_of(friction, rows, {"amplitude_deg": 290.0}, outputs_named(["amplitude"]))
    assert effect.by["amplitude_deg"].agrees is agrees
    assert ("disagree" in effect.message) is not agrees
    if agrees:
        assert effect.by["amplitude_deg"].value == pytest.approx(-30.0, rel=1e-6)


@pytest.mark.parametrize("near", ["low", "high", "neither"])
def test_a_slope_beside_a_bound_has_its_sign(near):
    """Of a parabola, which both kinds of quotients differentiate exactly."""
    one = next(one for one in quantities(ws.load(BENCH)) if one.key == "contacts.0.friction")
    bounds = {"low": {"low": one.value, "high": None}, "high": {"low": None, "high": one.value}}
    friction = replace(one, **bounds.get(near, {"low": None, "high": None}))
    values = [value for _, value in points_of(friction)]
    assert {"low": min(values) > one.value, "high": max(values) < one.value, "neither": True}[near]
    rows = {x: {"amplitude_deg": 290.0 - 30.0 * x + 50.0 * x * x, "message": "", "verdict": "ticks"} for x in values}
    level = {"amplitude_deg": 290.0 - 30.0 * one.value + 50.0 * one.value**2}
    effect = effect_of(friction, rows, level, outputs_named(["amplitude"]))
    assert effect.by["amplitude_deg"].value == pytest.approx(-30.0 + 100.0 * one.value, rel=1e-6)


def test_no_cycle_no_sensitivity():
    with pytest.raises(ValueError, match="no limit cycle"):
        ws.sensitivity(ws.profiles_dir() / "balance")
    with pytest.raises(ws.SceneError, match="holds no number"):
        ws.sensitivity(BENCH, ["contacts.0.between"])


def test_the_command(tmp_path, capsys):
    folder = tmp_path / "what_matters"
    assert main(["sweep", str(BENCH), "torques.0.value", "--sensitivity", "--workers", "1", "-o", str(folder)]) == 0
    assert "torques.0.value" in capsys.readouterr().out
    assert (folder / "sweep.png").stat().st_size > 5_000
    assert "amplitude_deg_per_percent" in (folder / "sweep.csv").read_text(encoding="utf-8")


def test_a_dimension_and_a_quantity_of_the_same_words_are_kept_apart():
    scene = ws.designs.swiss_lever().scene()
    found = ws.sensitivity(scene, ["design.balance_inertia", "bodies.balance.inertia"])
    labels = [label.get_text() for label in ws.plot_sensitivity(found).axes[0].get_yticklabels()]
    assert sorted(labels) == ["balance inertia, +1 %", "design balance inertia, +1 %"]
