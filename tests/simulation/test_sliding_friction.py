"""Is friction that depends on the speed of slip what its law says, with exact events where stick turns into slip?"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from simulation.moving_scenes import box, ground

import watchsim as ws
from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Contact, LineSpring, Shock, Side, SlipLaw
from watchsim.scene.scene import Body, Prescribed, Scene
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Trajectory

MASS, STIFFNESS, SPEED, STATIC, SLIDING, GRAVITY = 2e-3, 50.0, 0.03, 0.4, 0.25, 9.81
W = math.sqrt(STIFFNESS / MASS)
SIDE, POST, BELT = 4e-3, -20e-3, 40e-3  # of the block; where the spring is held; half of the belt


def belt(slip: SlipLaw, duration: float, static: float = STATIC) -> Scene:
    """A block on two corners, on a belt of constant speed; a horizontal spring at the height of the belt holds it."""
    strip = replace(ground(BELT), name="belt", motion="slide", velocity=(SPEED,), prescribed=Prescribed())
    block = Body(
        "block",
        "free",
        position=(0.0, 0.5 * SIDE),
        velocity=(SPEED, 0.0, 0.0),
        mass=MASS,
        inertia=MASS * SIDE**2 / 6.0,
        loops=(box(SIDE, SIDE),),
    )
    return Scene(
        "block on a belt",
        (block, strip),
        contacts=(Contact((Side("block"), Side("belt")), static, slip=slip),),
        line_springs=(LineSpring(("block", None), ((0.0, -0.5 * SIDE), (POST, 0.0)), STIFFNESS, -POST),),
        gravity=(0.0, -GRAVITY),
        duration=duration,
        tolerance=1e-12,
    )


def begins(run: Trajectory, kind: EventKind) -> list[float]:
    """When the block changes to another mode: both corners do at one instant."""
    times = run.events["t"][run.events["kind"] == kind].tolist()
    return [t for i, t in enumerate(times) if i == 0 or t - times[i - 1] > 1e-6]


def stick_slip() -> tuple[float, float]:
    """How long the block slips and sticks. It is held until the spring carries static friction; then X = x − μ N / k swings
    freely from D = (μs − μ) N / k, where it has the belt's speed, until it has that again, by symmetry at −D.
    """
    D = (STATIC - SLIDING) * MASS * GRAVITY / STIFFNESS
    return (math.pi + 2.0 * math.atan(SPEED / (W * D))) / W, 2.0 * D / SPEED


def test_the_period_of_stick_slip_is_the_closed_form() -> None:
    run = ws.simulate(belt(SlipLaw(STATIC - SLIDING), 1.0))
    begun, held = begins(run, EventKind.SLIDE), begins(run, EventKind.STICK)
    slips, sticks = stick_slip()
    assert len(begun) > 20
    assert begun[0] == pytest.approx(STATIC * MASS * GRAVITY / STIFFNESS / SPEED, abs=1e-10)
    assert np.diff(begun) == pytest.approx(slips + sticks, rel=1e-9)
    first = next(i for i, t in enumerate(held) if t > begun[0])
    assert np.subtract(held[first:], begun[: len(held) - first]) == pytest.approx(slips, rel=1e-9)
    assert run.energy["residual_relative"] < 1e-9


@pytest.mark.parametrize(
    "slip", [SlipLaw(STATIC - SLIDING), SlipLaw(STATIC - SLIDING, 0.02), SlipLaw(STATIC - SLIDING, 0.02, 0.5)]
)
@pytest.mark.parametrize("tolerance", [1e-8, 1e-9])
def test_the_ledger_closes_at_usual_tolerances_where_slips_end_long_steps(slip: SlipLaw, tolerance: float) -> None:
    assert ws.simulate(belt(slip, 1.0), tolerance=tolerance).energy["residual_relative"] < 0.01 * tolerance


def test_what_stands_in_a_shaken_case_goes_on_standing() -> None:
    """All energy is rounding there, and the ledger must not ask for ever shorter steps."""
    block = Body("block", "free", (0.0, 0.5 * SIDE), mass=MASS, inertia=MASS * SIDE**2 / 6.0, loops=(box(SIDE, SIDE),))
    scene = Scene(
        "block in a shaken case",
        (block, ground(BELT)),
        contacts=(Contact((Side("block"), Side("ground")), STATIC),),
        gravity=(0.0, -GRAVITY),
        shocks=(Shock(0.01, 2e-4, (0.76, -1.36)),),
        duration=0.05,
    )
    run = ws.simulate(scene)
    assert not run.stop.gave_up
    assert len(run.t) < 200
    assert np.abs(run.q[:, :2] - (0.0, 0.5 * SIDE)).max() < 1e-12 * SIDE


def test_time_stepping_slips_as_long_to_its_order() -> None:
    """The error of the period goes with the step."""
    errors = []
    for step in (2e-5, 1e-5, 5e-6):
        run = ws.simulate(belt(SlipLaw(STATIC - SLIDING), 0.4), method="moreau", step=step)
        x, u = run.q[:, 0], run.u[:, 0]
        assert run.energy["dissipated"]["friction"] > 0.0
        slow = np.flatnonzero((u[:-1] > 0.0) & (u[1:] <= 0.0))
        tops = run.t[slow] + (run.t[slow + 1] - run.t[slow]) * u[slow] / (u[slow] - u[slow + 1])
        errors.append(abs(float(np.mean(np.diff(tops))) - sum(stick_slip())))
        assert x.max() < 1.01 * (STATIC * MASS * GRAVITY / STIFFNESS + SPEED / W)
    assert errors[-1] < 5e-6
    assert errors[-1] < 0.5 * errors[0]


def test_friction_that_falls_and_grows_with_speed_has_the_limit_cycle_of_its_differential_equation() -> None:
    """m x\'\' = −k x + μ(v − x\') N while it slips, by another integrator; held, x\' = v until k x = μs N."""
    decay, rise = 0.02, 0.5
    weight = MASS * GRAVITY

    def coefficient(slip: float) -> float:
        return SLIDING + (STATIC - SLIDING) * math.exp(-slip / decay) + rise * slip

    def back(t: float, y: np.ndarray) -> float:
        return float(SPEED - y[1])

    back.terminal, back.direction = True, -1.0  # type: ignore[attr-defined]
    start = np.array([STATIC * weight / STIFFNESS, SPEED])
    # Without slip nothing pulls: the block begins with next to none.
    swung = solve_ivp(
        lambda t, y: (y[1], (-STIFFNESS * y[0] + coefficient(SPEED - y[1]) * weight) / MASS),
        (0.0, 1.0),
        start - (0.0, 1e-13),
        method="DOP853",
        events=back,
        rtol=1e-13,
        atol=1e-16,
    )
    slips, end = float(swung.t_events[0][-1]), float(swung.y_events[0][-1][0])
    period = slips + (start[0] - end) / SPEED
    run = ws.simulate(belt(SlipLaw(STATIC - SLIDING, decay, rise), 1.0))
    begun = begins(run, EventKind.SLIDE)
    assert len(begun) > 5
    assert np.diff(begun) == pytest.approx(period, rel=1e-8)
    assert run.energy["residual_relative"] < 1e-9


def test_purely_viscous_friction_slows_a_block_exponentially() -> None:
    """m v\' = −c v m g: v = v₀ exp(−c g t), x = v₀ (1 − exp(−c g t)) / (c g), without an event however slow it gets."""
    c, speed = 2.0, 0.1
    scene = replace(belt(SlipLaw(0.0, 0.0, c), 0.5, 0.0), line_springs=())
    strip = replace(ground(BELT), name="belt")
    block = replace(scene.bodies[0], velocity=(speed, 0.0, 0.0))
    run = ws.simulate(replace(scene, bodies=(block, strip)))
    left = np.exp(-c * GRAVITY * run.t)
    assert run.u[:, 0] == pytest.approx(speed * left, rel=1e-9)
    assert run.q[:, 0] == pytest.approx(speed * (1.0 - left) / (c * GRAVITY), rel=1e-9, abs=1e-15)
    assert run.energy["residual_relative"] < 1e-9


@pytest.mark.parametrize(
    ("friction", "said"),
    [
        ("{ sliding = 0.1 }", "missing: static"),
        ("{ static = 0.1, sliding = 0.2 }", "must not be above static"),
        ("{ static = -0.1 }", "negative friction"),
        ('{ static = 0.1, decay = "1 mm/s" }', "write sliding"),
        ('{ static = 0.2, sliding = 0.1, decay = "0 mm/s" }', "above zero"),
        ('{ static = 0.2, sliding = 0.1, decay = "1 mm" }', "length"),
        ("{ static = 0.2, viscous = 3 }", "unit"),
        ("{ static = 0.2, slidng = 0.1 }", 'Did you mean "sliding"'),
        ("[0.2, 0.1]", "number"),
    ],
)
def test_a_law_that_cannot_be_meant_is_refused_with_its_place(tmp_path: Path, friction: str, said: str) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(f"""[bodies.a]
motion = "free"
shape = {{ circle = "1 mm" }}
mass = "1 g"
[bodies.b]
motion = "fixed"
polygon = [["-9 mm", "-3 mm"], ["9 mm", "-3 mm"], ["9 mm", "-2 mm"], ["-9 mm", "-2 mm"]]
[[contacts]]
between = ["a", "b"]
friction = {friction}
[run]
duration = "1 s"
""")
    with pytest.raises(SceneError, match=said) as caught:
        ws.load(file)
    assert "contacts.0.friction" in str(caught.value)
