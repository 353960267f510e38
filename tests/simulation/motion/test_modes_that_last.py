"""When does a mode end, when is a body still, and which gaps are closed? Asked of single contacts and bearings."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact.edge_distance import edge_records
from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.geometry.primitives import Arc, Line
from watchsim.model.records import OVER_ANGLE, OVER_TIME, REPEATED
from watchsim.simulation.events import released_contacts
from watchsim.simulation.loop_state.scratch import MONITORS
from watchsim.simulation.motion import coupled_motion, drift_projection, sleeping

OPTIONS = SimpleNamespace(force_zero=1e-3, speed_zero=1e-2, size=4.0, extent=1e-4, sleep=1e-3)


def bearing(grip: int, *, awake: int = 1, load: float = 0.0, speed: float = 0.0, lenience: float = 1.0) -> float:
    """The monitor of the second of three coordinates, whose dry friction is 2 and whose scale is 0.5."""
    model = SimpleNamespace(coordinates=[None, SimpleNamespace(coulomb=2.0, scale=0.5), None])
    state = SimpleNamespace(grip=[9, grip, 9], awake=[0, awake, 0], now=SimpleNamespace(lenience=lenience))
    smooth = SimpleNamespace(load=[99.0, load, 99.0], terms=[99.0, 7.0, 99.0], y=[99.0] * 4 + [speed, 99.0])
    return float(in_python(coupled_motion.bearing_monitor)(model, state, OPTIONS, 1, smooth))


def test_a_bearing_holds_while_its_friction_can_and_slips_while_it_goes_on() -> None:
    assert bearing(OPEN, load=9.0, speed=-9.0) == 1.0 == bearing(STICK, awake=0, load=9.0)
    for sign in (1.0, -1.0):
        assert bearing(STICK, load=sign * 1.5, lenience=3.0) == pytest.approx(2.0 - 1.5 + 3.0 * 1e-3 * 7.0)
    slack = 0.5 * 3.0 * 1e-2 / 4.0 * 0.5  # half a speed that counts as none
    assert bearing(FORWARD, speed=0.25, lenience=3.0) == pytest.approx(0.25 + slack)
    assert bearing(BACKWARD, speed=0.25, lenience=3.0) == pytest.approx(-0.25 + slack)


def solved(normal: float, tangential: float, size: float = 0.5) -> SimpleNamespace:
    """Forces of the second of two contacts; its own mobility is 4."""
    return SimpleNamespace(force=[9.0, 9.0, normal, tangential], size=[99.0, 99.0, size, 99.0], G=np.diag([9.0, 9.0, 4.0, 9.0]))


def test_how_much_of_a_force_is_left() -> None:
    """With the share of its terms on top; where nothing acts there is no force to end."""
    press, grip = in_python(coupled_motion.press_left), in_python(coupled_motion.grip_left)
    assert press(solved(-0.2, 0.0), 1, 0.1) == pytest.approx(-0.2 + 0.1 * 0.5 / 4.0)
    assert press(solved(0.0, 0.0), 1, 0.1) == pytest.approx(0.1 * 0.5 / 4.0)
    assert press(solved(0.0, 0.0, 0.0), 1, 0.1) == 1.0 == grip(0.3, solved(0.0, 0.0, 0.0), 1, 0.1)
    assert grip(0.3, solved(0.0, 0.0), 1, 0.1) == pytest.approx(0.1 * 0.5 / 4.0)
    assert grip(0.3, solved(2.0, 0.0, 0.0), 1, 0.1) == pytest.approx(0.3 * 2.0)
    for sign in (1.0, -1.0):
        assert grip(0.3, solved(2.0, sign * 0.5), 1, 0.1) == pytest.approx(0.3 * 2.0 - 0.5 + 0.1 * 0.5 / 4.0)


@pytest.mark.parametrize("mode", [STICK, FORWARD, BACKWARD])
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_all_that_can_end_the_mode_of_a_contact(mode: int, friction: float) -> None:
    """Its force, its grip or slip, its primitives, a jam: in this order, at the place of the contact among all."""
    model = SimpleNamespace(contacts=[SimpleNamespace(group=0)] * 9, laws=[SimpleNamespace(friction=friction)])
    state = SimpleNamespace(mode={5: STICK, 7: mode}, now=SimpleNamespace(lenience=2.0))
    kin = [SimpleNamespace(gT_dot=0.0, margin=1.0), SimpleNamespace(gT_dot=-0.06, margin=-1e-3)]
    values = np.full(5 * MONITORS, np.nan)
    smooth = SimpleNamespace(closed=SimpleNamespace(ids=[5, 7], kin=kin), monitors=values)
    work = solved(2.0, 0.4)
    work.force[:2] = [3.0, 0.1]
    work.size[0] = 0.7
    for jammed in (-1, 1):
        watched = in_python(coupled_motion._watch, is_paradox=lambda work, m, i, share, which=jammed: i == which)
        smallest = watched(model, state, OPTIONS, 3, 2, work, smooth)
        found = values[4 * MONITORS : 5 * MONITORS]
        slack = 2.0 * 1e-3 * 0.5 / 4.0
        ways = {STICK: 0.3 * 2.0 - 0.4 + slack, FORWARD: -0.06 + 2.0 * 2.0 * 1e-2, BACKWARD: 0.06 + 2.0 * 2.0 * 1e-2}
        expected = [2.0 + slack, ways[mode] if friction else 1.0, -1e-3 + 2e-4, -float(jammed)]
        assert found == pytest.approx(expected)
        assert smallest == min(values[3 * MONITORS :]) and np.isnan(values[: 3 * MONITORS]).all()


@pytest.mark.parametrize(("speed", "acceleration", "still"), [
    (0.9, 0.9, True), (-0.9, -0.9, True), (1.1, 0.0, False), (-1.1, 0.0, False), (0.0, 1.1, False), (0.0, -1.1, False),
])  # fmt: skip
def test_a_coordinate_is_still_without_speed_and_acceleration_but_for_rounding(
    speed: float, acceleration: float, still: bool
) -> None:
    """In shares of a speed that counts as none, in the coordinate's own scale, and of the forces' terms."""
    model = SimpleNamespace(coordinates=[None, SimpleNamespace(scale=0.5, mass=3.0)])
    state = SimpleNamespace(u=[9.0, speed * 1e-2 * 0.5 / 4.0], a=[9.0, acceleration * 1e-3 * 7.0 / 3.0])
    assert in_python(sleeping._is_still)(model, state, OPTIONS, 1, 7.0) == still


def test_terms_are_the_sizes_of_all_that_acts() -> None:
    rng = np.random.default_rng(2)
    w_N, w_T, force, h = rng.normal(size=(2, 3)), rng.normal(size=(2, 3)), rng.normal(size=4), rng.normal(size=4)
    closed, terms = SimpleNamespace(slots=[2, 3], coord=np.array([[0, 3, 9], [3, 1, 0]]), w_N=w_N, w_T=w_T), np.zeros(4)
    in_python(sleeping.begin_terms)(h, terms)
    in_python(sleeping.add_terms)(closed, 2, force, terms)
    expected = np.abs(h)
    for i, coords in enumerate(([0, 3], [3, 1, 0])):
        for k, j in enumerate(coords):
            expected[j] += abs(w_N[i, k] * force[2 * i]) + abs(w_T[i, k] * force[2 * i + 1])
    assert terms == pytest.approx(expected)


@pytest.mark.parametrize(("over", "t", "changes"), [
    (REPEATED, 99.0, True), (OVER_TIME, 2.9, True), (OVER_TIME, 3.0, False), (OVER_TIME, 0.0, True), (OVER_ANGLE, 0.0, False),
])  # fmt: skip
def test_a_force_changes_as_long_as_it_has_knots_ahead(over: int, t: float, changes: bool) -> None:
    model = SimpleNamespace(knots=np.array([[9.0, 0.0], [1.0, 0.0], [3.0, 0.0], [8.0, 0.0]]))
    assert in_python(sleeping._will_change)(model, SimpleNamespace(over=over, start=1, count=2), t) == changes


@pytest.mark.parametrize("seed", range(12))
def test_gaps_are_chosen_deepest_first_without_those_that_depend_on_them(seed: int) -> None:
    """Scaled by how their own force moves them; of equals the first one. Against ranks of whole matrices."""
    rng = np.random.default_rng(seed)
    m = 5
    directions = rng.normal(size=(m, 3)) * rng.uniform(0.5, 2.0, (m, 1))
    G = np.zeros((2 * m, 2 * m))
    G[::2, ::2] = directions @ directions.T
    gaps = -rng.uniform(0.0, 1e-9, m)
    closed = SimpleNamespace(kin=[SimpleNamespace(g=gap) for gap in gaps])
    work = SimpleNamespace(G=G, rhs=np.zeros(m), row=np.zeros(m, int), scale=np.zeros(m), A=np.zeros((m, m)))
    count = in_python(drift_projection._choose)(closed, m, True, 1e-6, work)
    chosen: list[int] = []
    for i in np.argsort(gaps / np.linalg.norm(directions, axis=1), kind="stable"):
        if np.linalg.matrix_rank(directions[[*chosen, i]], tol=1e-6) > len(chosen):
            chosen.append(int(i))
    assert work.row[:count].tolist() == [2 * i for i in chosen]


@pytest.mark.parametrize(("gap", "both", "along", "wanted"), [
    (-1e-7, True, 0.0, 1e-7), (1e-7, True, 0.0, -1e-7), (1e-7, False, 0.0, 0.0), (-1e-7, False, 0.0, 1e-7),
    (-1.1e-6, True, 0.0, 0.0), (-0.9e-6, True, 0.0, 0.9e-6), (-0.9e-6, True, 59.0, 0.0), (-0.8e-6, True, -61.0, 0.8e-6),
    (-0.9e-6, True, -59.0, 0.0), (-0.9e-6, True, 54.0, 0.9e-6),
])  # fmt: skip
def test_which_gaps_are_taken_back(gap: float, both: bool, along: float, wanted: float) -> None:
    """No deeper than drift can be, and not where that is a way of fifty times as much along the face; open ones where asked."""
    G = np.eye(4)
    G[2, 3] = along
    closed = SimpleNamespace(kin=[SimpleNamespace(g=9.0), SimpleNamespace(g=gap)])
    assert in_python(drift_projection._wanted)(closed, 2, both, 1e-6, SimpleNamespace(G=G)) == wanted


def test_edges_are_written_with_their_middle_outward_normal_curvature_and_half_length() -> None:
    """A line; a quarter and three quarters of a circle; one as flat as a line; none without length."""
    flat = Arc(0.0, -1e6, 1e6, 0.5 * math.pi + 1e-6, -2e-6)
    edges = [Line(1.0, 1.0, 4.0, 5.0), Arc(1.0, 2.0, 2.0, 0.0, 0.5 * math.pi), Arc(0.0, 0.0, 1.0, 0.0, -1.5 * math.pi), flat]
    rows = edge_records([*edges, Line(1.0, 1.0, 1.0, 1.0)])
    assert len(rows) == 4
    assert rows["half"] == pytest.approx([2.5, 0.5 * math.pi, 0.75 * math.pi, 1.0])
    assert rows["curvature"] == pytest.approx([0.0, 0.5, 1.0, 1e-6])
    middle = np.column_stack([rows["x"], rows["y"]])
    root = math.sqrt(0.5)
    assert middle == pytest.approx(
        np.array([[2.5, 3.0], [1.0 + 2.0 * root, 2.0 + 2.0 * root], [-root, -root], [0.0, 0.0]]), abs=1e-9
    )


def weakest(forces: list[float], modes: list[int], friction: tuple[float, ...] = (0.5, 0.5, 0.0)) -> tuple[bool, int, bool]:
    """Of three contacts without slack, each in a group of its own."""
    model = SimpleNamespace(
        contacts=[SimpleNamespace(group=i) for i in range(3)], laws=[SimpleNamespace(friction=mu) for mu in friction]
    )
    work = SimpleNamespace(force=forces, size=[1e-3] * 6, G=np.eye(6))
    state, options = SimpleNamespace(mode=modes, now=SimpleNamespace(lenience=2.0)), SimpleNamespace(force_zero=1e-3)
    found, row, pulls = in_python(released_contacts._weakest)(model, state, 3, options, work, SimpleNamespace(ids=[0, 1, 2]))
    return bool(found), int(row), bool(pulls)


@pytest.mark.parametrize(("forces", "modes", "expected"), [
    ([1.0, 0.4, 1.0, -0.4, 1.0, 9.0], [STICK] * 3, (False, 0, False)),
    ([-0.1, 0.0, -0.2, 0.0, 1.0, 0.0], [FORWARD] * 3, (True, 1, True)),
    ([1.0, 0.6, 1.0, -0.7, 1.0, 9.0], [STICK] * 3, (True, 1, False)),
    ([1.0, 0.6, 1.0, -0.7, 1.0, 9.0], [STICK, FORWARD, STICK], (True, 0, False)),
    ([1.0, 0.6, 1.0, 0.0, -0.05, 9.0], [STICK] * 3, (True, 0, False)),
    ([1.0, 0.6, 1.0, 0.0, -0.15, 9.0], [STICK] * 3, (True, 2, True)),
    ([-0.9e-6, 0.0, 0.0, 0.0, 0.0, 0.0], [FORWARD] * 3, (False, 0, False)),
    ([-1.1e-6, 0.0, 0.0, 0.0, 0.0, 0.0], [FORWARD] * 3, (True, 0, True)),
    ([-0.9e-6, 0.0, 1e9, 0.0, 0.0, 0.0], [FORWARD] * 3, (True, 0, True)),  # far less than the largest has no sign
])  # fmt: skip
def test_the_contact_furthest_from_its_law_is_let_go_first(
    forces: list[float], modes: list[int], expected: tuple[bool, int, bool]
) -> None:
    """One that pulls, or one that sticks beyond its cone; with half the slack with which modes end, and that is lenient."""
    assert weakest(forces, modes) == expected


def test_contacts_are_let_go_one_by_one_until_all_hold() -> None:
    """What pulls opens and leaves the list, what cannot stick slides against its friction; each change is written down."""
    answers = iter([(True, 1, True), (True, 0, False), (True, 1, False), (False, 0, False)])
    friction, changes, asked = {0: -0.3, 1: 0.2}, [], []
    state = SimpleNamespace(mode=[STICK] * 9, now=SimpleNamespace(lenience=1.0))
    rest = SimpleNamespace(ids=[7, 5, 3, 99])
    work = SimpleNamespace(force=[1.0, friction[0], 1.0, friction[1], 1.0, 0.0])

    def solve_mode(model, rest, m, mode, lenience, work) -> bool:
        asked.append((m, rest.ids[:m]))
        return len(asked) == 4

    instead = {
        "solve_mode": solve_mode,
        "_weakest": lambda *_: next(answers),
        "refresh": lambda model, m, rest, pose: None,
        "keep_change": lambda state, record, k, old: changes.append((k, old, state.mode[k])),
    }
    event = SimpleNamespace(rest=rest, pose=None)
    found = in_python(released_contacts.let_go, **instead)(None, state, 3, None, work, event, None)
    assert found == (2, True)
    assert asked == [(3, [7, 5, 3]), (2, [7, 3]), (2, [7, 3]), (2, [7, 3])]
    assert changes == [(5, STICK, OPEN), (7, STICK, FORWARD), (3, STICK, BACKWARD)]
