"""Which inertias, frequencies and torques are likely, where a drawing can say none?

Plates of steel, a balance as usual for the size, and a torque that makes up for what the oscillator loses in a beat.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from watchsim.geometry.primitives import Point
from watchsim.geometry.solids.mass import section
from watchsim.proposal.bodies.one_sided import nose_of, toothing
from watchsim.proposal.bodies.part import Part
from watchsim.proposal.bodies.part_names import CLICK, DRIVER, LEVER, OSCILLATOR, WHEEL
from watchsim.proposal.bodies.part_roles import Role

STEEL = 7850.0  # kg/m³
WATCH = 40e-3  # m: what is larger is a clock
THICKNESS = {True: 0.2e-3, False: 2e-3}  # m, of the parts of a watch, of a clock
BALANCE = 1.2e-9  # kg·m²: 12 mg·cm², usual for a wristwatch
BEATS = {True: 28800.0, False: 7200.0}  # vph
Q_FACTOR = {True: 250.0, False: 1000.0}
SHARE = 0.35  # of the drive's work that reaches the oscillator: usual for a lever escapement
LIGHT = 30.0  # times the lever's inertia: a balance with less is drawn without its rim
HEAVY = 100.0  # times the wheel's inertia: an anchor with less is drawn without its pendulum
STEPPED = 8  # teeth: a wheel with fewer is driven step by step, as in a Geneva drive
LIFTING = 0.2  # of the drive's work that lifts a click
BENT = 0.5  # rad by which the spring of a click is bent at the start: its force hardly changes
TURNS = 1.0  # per second, of what has nothing to hold it back but damping


@dataclass(frozen=True)
class Amount:
    """A number in SI units and why."""

    value: float
    why: str


@dataclass(frozen=True)
class ClickSpring:
    """What presses a click into the teeth: stiffness in N·m/rad, and the way (rad) from its start to its rest."""

    body: str
    stiffness: Amount
    way: float


@dataclass(frozen=True)
class Amounts:
    inertia: dict[str, Amount]
    vph: Amount | None
    q_factor: Amount | None
    torque: Amount | None
    viscous: Amount | None
    driven: str | None  # the body that the torque turns
    clicks: tuple[ClickSpring, ...] = ()
    turned: str | None = None  # the body that turns evenly, as a finger does that moves a star on against its jumper


def amounts_of(roles: Sequence[Role], size: float, swing: float) -> Amounts:
    """Inertias of all that moves, and what drives it."""
    watch = size < WATCH
    thick = THICKNESS[watch]
    plate = f"its outlines as steel {1e3 * thick:g} mm thick"
    inertia = {role.name: Amount(_plate(role.part, thick), plate) for role in roles if role.moves}
    wheel = next((role for role in roles if role.task == WHEEL), None)
    lever = next((role for role in roles if role.task == LEVER), None)
    swinging = next((role for role in roles if role.task == OSCILLATOR), None)
    if swinging is not None:
        inertia[swinging.name] = _oscillators(inertia, swinging, lever, wheel)
    driven = _driven(roles, wheel, swinging)
    clicks = any(role.task == CLICK for role in roles)
    turned = driven if clicks and any(role.task == DRIVER and role.name == driven for role in roles) else None
    if swinging is None:
        torque = Amount(1e-6 if watch else 1e-4, "nothing in the drawing says how strong the drive is")
        slow = Amount(torque.value / (2.0 * math.pi * TURNS), f"so that {driven} comes to about {TURNS:g} turn per second")
        return Amounts(
            inertia,
            None,
            None,
            torque if driven else None,
            slow if driven else None,
            driven,
            _clicks(roles, wheel, torque.value),
            turned,
        )
    beats = Amount(BEATS[watch], f"usual for {'a watch' if watch else 'a clock'} of this size ({1e3 * size:.3g} mm)")
    q = Amount(Q_FACTOR[watch], "usual; the escapement's own losses come on top")
    torque_amount = None
    if wheel is not None and wheel.teeth:
        omega = 2.0 * math.pi * beats.value / 7200.0
        loss = math.pi * inertia[swinging.name].value * (omega * swing) ** 2 / q.value
        value = loss / (SHARE * 2.0 * math.pi / wheel.teeth)
        why = f"it makes up for what the {swinging.name} loses at {math.degrees(swing):.3g}°, {SHARE:.0%} of it reaching it"
        torque_amount = Amount(value, why)
    return Amounts(inertia, beats, q, torque_amount, None, driven)


def _clicks(roles: Sequence[Role], wheel: Role | None, torque: float) -> tuple[ClickSpring, ...]:
    """Springs so strong that lifting the click over a tooth takes a share of the drive's work."""
    found = []
    for role in roles:
        teeth = toothing(wheel.part) if wheel is not None else None
        if role.task != CLICK or wheel is None or teeth is None:
            continue
        nose = nose_of(role.part, wheel.part)
        lift = (teeth.outer - teeth.inner) / nose.arm  # rad, about
        bent = max(BENT, 2.0 * lift)
        moment = LIFTING * torque * 2.0 * math.pi / teeth.fold / lift
        why = f"lifting it over a tooth takes about {LIFTING:.0%} of the drive's work"
        found.append(ClickSpring(role.name, Amount(moment / bent, why), nose.inward * bent))
    return tuple(found)


def _plate(part: Part, thickness: float) -> float:
    centre: Point = part.centre.at if part.centre is not None else (0.0, 0.0)
    return sum(abs(section(piece.loops).about(centre).polar) for piece in part.pieces) * thickness * STEEL


def _oscillators(inertia: dict[str, Amount], swinging: Role, lever: Role | None, wheel: Role | None) -> Amount:
    own = inertia[swinging.name]
    if lever is not None and own.value < LIGHT * inertia[lever.name].value:
        return Amount(
            max(BALANCE, LIGHT * inertia[lever.name].value), "a balance's; what is drawn is too light to be all of it"
        )
    if lever is None and wheel is not None and own.value < HEAVY * inertia[wheel.name].value:
        return Amount(
            HEAVY * inertia[wheel.name].value, "with its pendulum or balance; what is drawn is too light to be all of it"
        )
    return own


def _driven(roles: Sequence[Role], wheel: Role | None, swinging: Role | None) -> str | None:
    driver = next((role for role in roles if role.task == DRIVER), None)
    if driver is not None and (wheel is None or wheel.teeth < STEPPED):
        return driver.name
    if wheel is not None:
        return wheel.name
    return next((role.name for role in roles if role.moves and role is not swinging), None)
