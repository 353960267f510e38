"""What is said of a watch that stands, by what holds it? With made-up contacts, torques and faces."""

from __future__ import annotations

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.analysis.verdicts import standing as module
from watchsim.analysis.verdicts.faces import Face
from watchsim.analysis.verdicts.standing import _still_moving, standing

TOOTH, OTHER_TOOTH, PIN, OTHER_PIN, BANKING, HOOK = range(6)  # contacts
SIDES = [
    ("wheel", "lever"),
    ("lever", "wheel"),
    ("lever", "balance"),
    ("balance", "lever"),
    ("lever", "plate"),
    ("wheel", "arm"),
]
LOCKING, IMPULSE = Face(3, "entry", False, -1.0), Face(4, "exit", True, 1.0)


class Contact:
    def __init__(self, number: int) -> None:
        self.number, (self.body_a, self.body_b) = number, SIDES[number]

    def __str__(self) -> str:
        return f"contact {self.number}"


def told(
    monkeypatch: pytest.MonkeyPatch,
    holding: list[int],
    face: Face = LOCKING,
    torques: Mapping[int, float | None] | None = None,
    moved: float = 0.0,
    **changed: Any,
) -> Any:
    """`torques` by contact, N·m on the lever along the way out; `moved` is how far the balance went in the last half period."""
    given = torques or {}
    pairs = [Contact(k) for k in range(6)]

    def at_lever(found: Any, row: int, other: str, lever: str, way: float) -> float | None:
        pair = found.pairs[row]
        assert {pair.body_a, pair.body_b} == {other, lever} == {other, "lever"} and way == face.out
        return given[pair.number]

    def arms(run: Any, compiled: Any, t: float, rows: list[int]) -> Any:
        assert t == 9.0 and compiled == "model"
        return SimpleNamespace(pairs=tuple(pairs[k] for k in rows), of=lambda row, body: changed["gaps"][rows[row]][body])

    monkeypatch.setattr(module, "standstill", lambda run, found: SimpleNamespace(since=7.25, message="it stands"))
    monkeypatch.setattr(module, "in_force", lambda run, times: [holding] if times == [9.0] else [])
    monkeypatch.setattr(module, "arms", arms)
    monkeypatch.setattr(module, "face", lambda watch, found, row: face if row == 0 else IMPULSE)
    monkeypatch.setattr(module, "at_lever", at_lever)
    t = np.array([8.0, 8.7, 8.8, 9.0])
    q = np.column_stack((np.zeros(4), [0.5, 0.9, 0.5 + moved, 0.5]))
    run = SimpleNamespace(pairs=pairs, simulated=9.0, t=t, q=q, slices={"balance": slice(1, 2), "lever": slice(0, 1)})
    found = type("Found", (), {"__len__": lambda self: 1, "amplitude_deg": np.array([99.0, 31.24]), "nominal_period": 0.5})()
    values: dict[str, Any] = {
        **{"run": run, "found": found, "oscillator": "balance", "wheel": "wheel", "lever": "lever", "compiled": "model"},
        **{"has_shapes": True, "has_modes": True, "rest": 0.25, "recorded": lambda times: times == 9.0},
        **{"drive": lambda t: 1e-6 * t, "angle": lambda body, times: np.array([0.5])},
    }
    return standing(SimpleNamespace(**(values | changed)))  # type: ignore[arg-type]


def why(monkeypatch: pytest.MonkeyPatch, *args: Any, **changed: Any) -> str:
    """What stands between when it stopped and the last amplitude; "" where nothing better is known than that it stands."""
    message = str(told(monkeypatch, *args, **changed).message)
    assert message.startswith("t = 7.2500 s  the watch stands: ")
    said = message.removeprefix("t = 7.2500 s  the watch stands: ")
    return "" if said == "it stands" else said.removesuffix(". Last amplitude 31.2°")


PUSHES, HOLDS = {TOOTH: -4.3e-6, PIN: 1.6e-6}, {TOOTH: 1.6e-6, PIN: -4.3e-6}
ON_LOCK = "the torque of balance at lever, 1.6 µN·m, is below the 4.3 µN·m needed to unlock (set on lock)"
ON_IMPULSE = "the torque of wheel at lever, 1.6 µN·m, is below the 4.3 µN·m needed to move balance (set on impulse)"


def test_what_is_known_besides(monkeypatch: pytest.MonkeyPatch) -> None:
    found = told(monkeypatch, [PIN, TOOTH], torques=PUSHES)
    assert (found.name, found.t, found.body, found.pair, found.torque) == ("stops", 7.25, "wheel", "contact 0", 9e-6)
    assert found.message.endswith("(set on lock). Last amplitude 31.2°")
    for changed in ({"lever": None}, {"has_shapes": False}, {"recorded": lambda times: times > 9.0}):
        blind = told(monkeypatch, [PIN, TOOTH], torques=PUSHES, **changed)
        assert blind.message.endswith("stands: it stands") and blind.pair is None
    monkeypatch.setattr(module, "standstill", lambda run, found: None)
    assert standing(SimpleNamespace(run=None, found=None)) is None  # type: ignore[arg-type]


def test_set_on_lock(monkeypatch: pytest.MonkeyPatch) -> None:
    """The strongest of all pins counts, and one that resists is no push."""
    assert why(monkeypatch, [PIN, TOOTH], torques=PUSHES) == f"{LOCKING}; {ON_LOCK}"
    two = {**PUSHES, PIN: 0.3e-6, OTHER_PIN: 1.6e-6}
    assert why(monkeypatch, [PIN, OTHER_PIN, TOOTH, BANKING], torques=two) == f"{LOCKING}; {ON_LOCK}"
    assert why(monkeypatch, [PIN, OTHER_PIN, TOOTH], torques={**PUSHES, OTHER_PIN: None}) == f"{LOCKING}; {ON_LOCK}"
    for slack in (None, -1e-6, 0.0):
        said = why(monkeypatch, [TOOTH, PIN], torques={TOOTH: -4.3e-6, PIN: slack})
        assert said == f"{LOCKING}; balance does not push lever out (set on lock)"
    assert why(monkeypatch, [TOOTH, PIN], torques={TOOTH: None, PIN: 1e-6}) == f"{LOCKING}; friction jams it there"


@pytest.mark.parametrize(("face", "strong", "weak"), [(LOCKING, PIN, TOOTH), (IMPULSE, TOOTH, PIN)])
def test_where_the_torque_would_be_enough_something_else_holds(
    monkeypatch: pytest.MonkeyPatch, face: Face, strong: int, weak: int
) -> None:
    for more in (1.001e-6, 5e-6, *([-1.001e-6] if face.impulse else [])):
        found = told(monkeypatch, [TOOTH, PIN], face, torques={strong: more, weak: -1e-6})
        assert found.message.endswith("stands: it stands") and found.pair == "contact 0"
    assert "is below the" in why(monkeypatch, [TOOTH, PIN], face, torques={strong: 1e-6, weak: -1e-6})


def test_set_on_impulse(monkeypatch: pytest.MonkeyPatch) -> None:
    assert why(monkeypatch, [PIN, TOOTH], IMPULSE, torques=HOLDS) == f"{IMPULSE}; {ON_IMPULSE}"
    two = {**HOLDS, OTHER_PIN: 0.1e-6}
    assert why(monkeypatch, [PIN, OTHER_PIN, TOOTH], IMPULSE, torques=two) == f"{IMPULSE}; {ON_IMPULSE}"


def test_without_a_pin_in_the_fork(monkeypatch: pytest.MonkeyPatch) -> None:
    """At 0.25 rad from rest, 14.3°."""
    rest = f"{LOCKING}; balance is at rest at 14.3° and does not touch lever"
    assert why(monkeypatch, [TOOTH, BANKING]) == rest
    swings = "balance still swings, now at 14.3°, "
    assert why(monkeypatch, [TOOTH], moved=1.01e-4) == f"{LOCKING}; {swings}but too little to unlock it"
    assert why(monkeypatch, [TOOTH], IMPULSE, moved=-1.01e-4) == f"{IMPULSE}; {swings}and wheel does not drive it on"
    assert why(monkeypatch, [TOOTH, PIN], torques=PUSHES, moved=1.01e-4) == f"{LOCKING}; {swings}but too little to unlock it"
    assert why(monkeypatch, [TOOTH, PIN], torques=PUSHES, moved=0.99e-4) == f"{LOCKING}; {ON_LOCK}"


def test_without_a_tooth_on_the_lever(monkeypatch: pytest.MonkeyPatch) -> None:
    assert why(monkeypatch, [PIN, BANKING]) == "wheel touches nothing that holds it"
    assert told(monkeypatch, [PIN, BANKING]).pair is None
    assert why(monkeypatch, [PIN, HOOK]) == "" == why(monkeypatch, [PIN, BANKING], has_modes=False)


@pytest.mark.parametrize(
    ("gaps", "end"),
    [
        ({0: (1.0, 2.0), 1: (3.0, 4.0)}, ""),
        ({0: (1.0, 2.0), 1: (3.0, -4.0)}, ": as lever turns clockwise, wheel cannot make way for both"),
        ({0: (-1.0, 2.0), 1: (-3.0, -4.0)}, ": as lever turns anticlockwise, wheel cannot make way for both"),
        ({0: (1.0, 0.0), 1: (-3.0, 0.0)}, ": as lever turns anticlockwise or clockwise, wheel cannot make way for both"),
    ],
)
def test_two_teeth_that_hold_at_once(monkeypatch: pytest.MonkeyPatch, gaps: dict[int, tuple[float, float]], end: str) -> None:
    arms = {k: {"lever": (lever, 9.0), "wheel": (wheel, 9.0)} for k, (lever, wheel) in gaps.items()}
    said = why(monkeypatch, [TOOTH, PIN, OTHER_TOOTH], gaps=arms)
    assert said == f"{LOCKING} (contact 0) and {IMPULSE} (contact 1){end}"
    assert told(monkeypatch, [OTHER_TOOTH, TOOTH], gaps=arms).pair == "contact 1"


@pytest.mark.parametrize(("at", "moving"), [(8.74, False), (8.75, True), (8.76, True)])
def test_the_last_half_period_says_whether_it_still_moves(at: float, moving: bool) -> None:
    t, q = np.array([8.0, at, 8.8, 9.0]), np.array([[0.5], [0.9], [0.5], [0.5]])
    run = SimpleNamespace(t=t, q=q, simulated=9.0, slices={"balance": slice(0, 1)})
    watch: Any = SimpleNamespace(run=run, found=SimpleNamespace(nominal_period=0.5), oscillator="balance")
    assert _still_moving(watch) is moving
