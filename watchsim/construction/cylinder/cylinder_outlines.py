"""What are the outlines of a cylinder escapement's wheel and balance?

TEETH and SHELL touch. The teeth stand on pillars over the wheel's RIM, at the height of the shell's cut; it and the
rim of the balance (BALANCE) are drawn only. Millimetres.
"""

from __future__ import annotations

import math

from watchsim.construction.balance_wheel import BalanceWheel, balance_wheel
from watchsim.construction.cylinder.cylinder_points import Shell
from watchsim.construction.outline import arc_between, arc_of_radius, circle, fillet_chain, polar
from watchsim.construction.wheel_arms import Arms
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line, Point

BELLY_AT, BELLY_DEEP, BELLY = 228.0, 0.74, 1.7  # foot of a tooth's back, from the cylinder's middle; radius; by the inner one
RIM, WIDTH, ARM, HUB, BORE, PILLAR = 0.74, 0.09, 0.06, 0.2, 0.05, 0.022  # of the wheel, by the centre distance
ARMS, BALANCE_ARMS, FILLET = 3, 3, 0.04


def face(shell: Shell) -> tuple[Point, Point]:
    """Point and heel of a tooth in the middle of the cylinder."""
    half = shell.values.tooth_width / 2.0
    return polar(shell.point_radius, 90.0 - half), polar(shell.heel_radius, 90.0 + half)


def tooth(shell: Shell) -> Loop:
    """A wedge: impulse face, back, and a belly that keeps clear of the inside of the shell; as it stands in the middle."""
    point, heel = face(shell)
    foot = polar(BELLY_DEEP * shell.inner, BELLY_AT, shell.balance)
    edges: list[Edge] = [Line(*point, *heel), Line(*heel, *foot), arc_of_radius(foot, point, BELLY * shell.inner)]
    return Loop(tuple(fillet_chain(edges, [0.0, 0.15 * shell.inner, 0.0], closed=True)), "TEETH")


def wheel(shell: Shell) -> list[Loop]:
    """Teeth, and below them the rim from which a pillar goes out to each; at angle 0 tooth 0 is in the middle."""
    d = shell.distance
    arms = Arms(ARMS, ARM * d, HUB * d, (RIM - WIDTH) * d, FILLET * d)
    return [
        *(tooth(shell).moved(math.radians(i * shell.pitch), (0.0, 0.0)) for i in range(shell.values.teeth)),
        Loop(tuple(edge for i in range(shell.values.teeth) for edge in _pillar(shell, i * shell.pitch)), "RIM"),
        *(Loop(tuple(arms.window(i)), "RIM", hole=True) for i in range(ARMS)),
        circle("RIM", (0.0, 0.0), BORE * d, hole=True),
    ]


def _pillar(shell: Shell, turn: float) -> list[Edge]:
    """Up one pillar, down it, and along the rim to the next; counter-clockwise."""
    d, half = shell.distance, math.degrees(PILLAR / RIM)
    top = d - 0.62 * shell.inner
    first, last = 90.0 + turn - half, 90.0 + turn + half
    low, high = polar(RIM * d, first), polar(top, 90.0 + turn - 0.8 * half)
    back, foot = polar(top, 90.0 + turn + 0.8 * half), polar(RIM * d, last)
    rim = arc_between(foot, polar(RIM * d, first + shell.pitch), (0.0, 0.0), True)
    return [Line(*low, *high), Line(*high, *back), Line(*back, *foot), rim]


def balance(shell: Shell) -> list[Loop]:
    """Shell with its half-round lips, and the rim of the balance, which is at rest."""
    left, right = shell.left_lip, shell.left_lip - shell.span
    middle = (shell.inner + shell.outer) / 2.0
    edges: list[Edge] = [
        arc_between(polar(shell.outer, right), polar(shell.outer, left), (0.0, 0.0), True),
        arc_between(polar(shell.outer, left), polar(shell.inner, left), polar(middle, left), True),
        arc_between(polar(shell.inner, left), polar(shell.inner, right), (0.0, 0.0), False),
        arc_between(polar(shell.inner, right), polar(shell.outer, right), polar(middle, right), True),
    ]
    return [Loop(tuple(edges), "SHELL"), *(Loop(loop.edges, "BALANCE", hole=loop.hole) for loop in wheel_of(shell).rim())]


def wheel_of(shell: Shell) -> BalanceWheel:
    """Rim and hairspring of the balance."""
    return balance_wheel(shell.values.balance_inertia, shell.outer, 0.3 * shell.inner, BALANCE_ARMS)
