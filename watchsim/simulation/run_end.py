"""What is known of where and why a run ended, in words?"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Container, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from watchsim.contact.gaps import BACKWARD, FORWARD
from watchsim.dynamics.lcp import LcpOutcome, Level
from watchsim.model import PIVOT, Model
from watchsim.simulation.coupled_motion import EXTENT, NORMAL, PARADOX, TANGENTIAL
from watchsim.simulation.event_loop import BEARING, KINDS, TOUCHED
from watchsim.simulation.recording import Pair
from watchsim.simulation.scratch import RECENT, Ended, Scratch
from watchsim.simulation.state import State
from watchsim.tolerances import LEDGER_PER_TOLERANCE, LEDGER_SHARE

# Where did the energy of a run go, and does its ledger close?


def ledger(drive: float, dissipated: dict[str, float], stored: tuple[float, float], turned_over: float) -> dict[str, Any]:
    """Work in = stored + dissipated + residual, J; `stored` at the start and at the end, `turned_over`: see the function."""
    at_start, at_end = stored
    more, lost = at_end - at_start, sum(dissipated.values())
    residual = drive - more - lost
    # A swing that loses nothing gets nothing and stores nothing more: what it turns over is the scale of its rounding.
    scale = max(abs(drive), abs(more), lost, at_end, at_start, turned_over)
    return {
        "in_J": drive,
        "dissipated": dissipated,
        "stored_J": float(more),
        "residual_J": float(residual),
        "residual_relative": float(abs(residual) / scale) if scale else 0.0,
    }


def turned_over(model: Model) -> float:
    """What constant forces give to springs and take back in each swing, J."""
    coordinates = model.coordinates
    sprung = coordinates[(coordinates.stiffness > 0.0) & (coordinates.driven == 0)]
    return float(np.max(2.0 * sprung.force**2 / sprung.stiffness, initial=0.0))


def usual_energy(model: Model) -> float:
    """Kinetic energy (J) below which motion is computed less closely: see the error control of integrator.py."""
    own = model.coordinates[model.coordinates.driven == 0]
    return float(0.5 * np.sum(own.mass * (own.scale * own.rate) ** 2))


def ledger_fails(energy: dict[str, Any], held: float, tolerance: float) -> bool:
    """True if the residual of the ledger is more than rounding; `held` (J): the most energy that was ever in the motion."""
    moved = held + abs(energy["in_J"]) + abs(energy["stored_J"]) + sum(energy["dissipated"].values())
    return bool(abs(energy["residual_J"]) > max(LEDGER_SHARE, LEDGER_PER_TOLERANCE * tolerance) * moved)


# What is known about a complementarity problem that nothing solved?
#
# All that is needed to look at it elsewhere: the matrices, the contacts in words, and the state it arose in.

LEMKE_ENDS = {
    LcpOutcome.SOLVED: "a solution",
    LcpOutcome.RAY: "ray",
    LcpOutcome.TOO_MANY_PIVOTS: "too many pivots",
    LcpOutcome.INEXACT: "not a solution",
}
ADVICE = (
    "Less friction at the contacts named here: near mu |b| = |a| of a rotor's lever arms bodies jam.",
    "Restitution 0 at these contacts: then only the compression must be solved.",
    "A tighter tolerance, or a start a little away from this position.",
)
JAM = (
    "This is a jam: a driven body goes on whatever is in its way. See it with watchsim movie RUN --contacts. Let the other be "
    "out of the way by then, make room in the drawing, or drive by a torque instead"
)


def failure_of(state: State, scratch: Scratch, pairs: Sequence[Pair]) -> dict[str, Any]:
    """The last problem posed, as plain values. Units SI.

    level       of the problem: acceleration, compression or expansion
    contacts    bodies and primitives in words with contact number, mode, gap rate and slip; two rows of G each, N then T
    G, b        Delassus matrix and the accelerations or velocities of its rows without contact forces
    reversed    rows of G and b that A and rhs have with the opposite sign (`friction_sign`)
    A, rhs      of y = A x + rhs in the scaling of dynamics/friction.py
    """
    system, problem, last = scratch.work.system, scratch.work.problem, scratch.work.problem.last
    m, elements, bearings, level = int(last.contacts), int(last.elements), int(last.bearings), Level(int(last.level))
    b = system.b if level == Level.ACCELERATION else scratch.work.phases.rates
    closed = scratch.event.rest if level == Level.ACCELERATION else scratch.event.closed
    rows, n = 2 * m + bearings, m + 2 * elements
    return {
        "level": level.name.lower(),
        "lemke_ended_with": LEMKE_ENDS[LcpOutcome(int(last.lemke))],
        "what_to_try": list(ADVICE),
        "t": float(state.clock.time),
        "q": state.q.tolist(),
        "u": state.u.tolist(),
        "contacts": [_contact(int(k), closed.kin[row], state, pairs) for row, k in enumerate(closed.ids[:m])],
        "bearings": problem.bearing[:bearings].tolist(),
        "G": system.G[:rows, :rows].tolist(),
        "b": b[:rows].tolist(),
        "reversed": np.flatnonzero(problem.friction_sign[:rows] < 0.0).tolist(),
        "A": problem.A[:n, :n].tolist(),
        "rhs": problem.rhs[:n].tolist(),
    }


def driven_into(contacts: Iterable[int], pairs: Sequence[Pair], driven: Container[str]) -> str:
    """Which driven body jams which other at the contacts, and what to change; "" where none takes part in them."""
    found: dict[str, None] = {}  # each sentence once, in order
    for contact in contacts:
        pair = pairs[contact]
        for own, other in ((pair.body_a, pair.body_b), (pair.body_b, pair.body_a)):
            if own in driven:
                found[f"{own}, which is driven, leaves {other} no way out at {pair}"] = None
    return f"{'; '.join(found)}. {JAM}" if found else ""


def _contact(k: int, kinematics: Any, state: State, pairs: Sequence[Pair]) -> dict[str, Any]:
    return {
        "number": k,
        "between": str(pairs[k]),
        "mode": int(state.regime.mode[k]),
        "gap_m": float(kinematics.g),
        "gap_rate_m_per_s": float(kinematics.gN_dot),
        "slip_m_per_s": float(kinematics.gT_dot),
    }


ADVICE_STOP_DETAILS = "Try a tighter tolerance; if that does not help, this is a fault of the program, and the scene shows it"
MANY = 6  # different causes named

_WORDS = {
    NORMAL: "the force ends at {}",
    TANGENTIAL: "slip or grip ends at {}",
    EXTENT: "an edge ends at {}",
    PARADOX: "no finite force holds {}",
    TOUCHED: "{} touch",
}


def unaccounted(energy: Mapping[str, Any]) -> str:
    """How far the ledger is from closing."""
    return f"{energy['residual_J']:.3g} J are unaccounted for, of {energy['in_J']:.3g} J put in. {ADVICE_STOP_DETAILS}"


def unexplained(state: State, pairs: Sequence[Pair]) -> str:
    """The contacts in force where velocities changed by more than impulses explain."""
    ids = state.regime.active[: state.instant.awake_contacts].tolist()
    touching = "in contact: " + "; ".join(str(pairs[k]) for k in ids[:MANY]) if ids else ""
    return ". ".join(filter(None, (touching, ADVICE_STOP_DETAILS)))


CROWDED = 20.0  # instants with events in a thousandth of the scene's unit of time: a watch has one or two
FEWEST_CROWDED = 50  # such instants between two looks; fewer say nothing about their pace


class Crowd:
    """Do events crowd, so that a run crawls? Looked at between slices; `unit` is the scene's unit of time, s."""

    def __init__(self, unit: float) -> None:
        self._unit, self._time, self._instants = unit, 0.0, 0
        self.since: float | None = None  # s
        self.pace = 0.0  # instants with events in a thousandth of the unit

    def look(self, time: float, instants: int) -> None:
        """Note how many `instants` with events there were by `time` (s)."""
        more, passed = instants - self._instants, time - self._time
        if more < FEWEST_CROWDED and not passed > FEWEST_CROWDED / CROWDED * 1e-3 * self._unit:
            return
        self.pace = more / passed * 1e-3 * self._unit if passed > 0.0 else math.inf
        self.since = None if self.pace < CROWDED else self._time if self.since is None else self.since
        self._time, self._instants = time, instants

    def words(self, who: str) -> str:
        """ "" unless they do."""
        per = "ms" if self._unit == 1.0 else f"{self._unit:.3g} ms"
        return "" if self.since is None else f"slow since t = {self.since:.6g} s, {self.pace:.3g} events per {per}: {who}"


def what_alternates(ended: Ended, pairs: Sequence[Pair], bodies: Sequence[str]) -> str:
    """What ended the last steps, most frequent first, with bodies and edges; "" where nothing did."""
    counted = Counter(ended.by[: min(int(ended.number), RECENT)].tolist())
    words = [f"{_cause(code, pairs, bodies)} ({times}×)" for code, times in counted.most_common(MANY)]
    return f"what alternates: {'; '.join(words)}" if words else ""


def _cause(code: int, pairs: Sequence[Pair], bodies: Sequence[str]) -> str:
    number, kind = divmod(code, KINDS)
    if kind == BEARING:
        return f"dry friction in the bearing of {bodies[number]} holds or lets go"
    return _WORDS[kind].format(pairs[number])


def accelerating(state: State, model: Model, bodies: Sequence[str], pairs: Sequence[Pair]) -> str:
    """The body that accelerates most, in words, and the contacts that slide; "" where none slides."""
    ids = [
        k for k in state.regime.active[: state.instant.awake_contacts].tolist() if state.regime.mode[k] in (FORWARD, BACKWARD)
    ]
    if not ids:
        return ""
    i = int(np.argmax(np.abs(state.a) / model.coordinates.scale))
    b = int(model.coordinates[i].body)
    unit = "rad/s²" if model.bodies[b].motion == PIVOT or i == model.bodies[b].first + 2 else "m/s²"
    where = "; ".join(str(pairs[k]) for k in ids[:MANY])
    return (
        f"{bodies[b]} accelerates at {abs(float(state.a[i])):.2g} {unit} while friction acts at {where}. Where friction nearly "
        "jams what slides, forces grow without bound (Painlevé's paradox): less friction there helps"
    )


def furthest(state: State, model: Model, bodies: Sequence[str]) -> str:
    """The body that has gone furthest, in words: how far, and to what its position is rounded."""
    i = int(np.argmax(np.abs(state.q) / model.coordinates.scale))
    b = int(model.coordinates[i].body)
    turns = model.bodies[b].motion == PIVOT or i == model.bodies[b].first + 2
    place, unit = abs(float(state.q[i])), "rad" if turns else "m"
    return f"{bodies[b]} is at {place:.2g} {unit}, rounded to {np.spacing(place):.1g} {unit}. Check forces, masses and gravity"
