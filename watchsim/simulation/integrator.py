"""How is one smooth step made where contacts couple bodies?

Explicit Runge-Kutta of order 8 with error control and a continuous extension of order 7 (Hairer, Noersett & Wanner 1993,
II.5, II.6), in which events are found without stepping again; of order 5 where the next event is near. Where the extension
misses more than the step, it is repeated.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.gaps import OPEN, STICK, contact_kinematics, gap_of_arc, normal_gap, place, place_body
from watchsim.dynamics.delassus import copy
from watchsim.dynamics.forces import stored_energy
from watchsim.jit import kernel
from watchsim.simulation.closed_contacts import is_explained, kinetic_energy, refresh
from watchsim.simulation.coupled_motion import (
    EXTENT,
    TANGENTIAL,
    engage,
    motion,
    place_contacts,
    project_positions,
    project_velocities,
)
from watchsim.simulation.curb_pins import begin_on_pins, energy_on_side
from watchsim.simulation.options import longest_step
from watchsim.simulation.scratch import COUPLED, MONITORS, SUMS
from watchsim.simulation.state import NO_CONTACT
from watchsim.simulation.step_path import (
    bound_accelerations,
    dense,
    dense_value,
    flow,
    is_open,
    narrowed,
    next_time,
    opened,
    turning_time,
)
from watchsim.tolerances import (
    DEFECT,
    DEPENDENT_IN_STEPS,
    HIDDEN_REBOUND,
    LEAST_FOR_LEDGER,
    LEDGER_ROUNDING,
    LOOKS_PER_GAP,
    MONITOR_SAMPLES,
    PASSES_GAP,
    RATES_TURNED,
    ROOT_RESOLUTION,
    SLIP_SLACK,
    SLOW,
    SLOW_ERROR,
    SMALLEST_STEP,
    TOUCH_STEPS,
    WITHIN_ENDS,
)

# Which numbers define the method DOP853?
#
# Dormand & Prince's pair of orders 8(5,3) with a continuous extension of order 7, coefficients as published by Hairer,
# Noersett & Wanner, Solving Ordinary Differential Equations I, 2nd ed. (1993), II.5 and II.6. Stage 12 is the first stage of
# the next step; stages 13 to 15 serve the continuous extension alone.

STAGES = 12


def _table(rows: int, columns: int, text: str) -> NDArray[np.float64]:
    """A matrix from its entries, "row: column value, column value, ..."; all others are zero."""
    table = np.zeros((rows, columns))
    for line in text.replace(",\n", ",").strip().splitlines():
        row, entries = line.split(":")
        for column, value in (entry.split() for entry in entries.split(",")):
            table[int(row), int(column)] = float(value)
    return table


A = _table(
    16,
    16,
    """
     1: 0 0.05260015195876773
     2: 0 0.0197250569845379, 1 0.0591751709536137
     3: 0 0.02958758547680685, 2 0.08876275643042054
     4: 0 0.2413651341592667, 2 -0.8845494793282861, 3 0.924834003261792
     5: 0 0.037037037037037035, 3 0.17082860872947386, 4 0.12546768756682242
     6: 0 0.037109375, 3 0.17025221101954405, 4 0.06021653898045596, 5 -0.017578125
     7: 0 0.03709200011850479, 3 0.17038392571223998, 4 0.10726203044637328, 5 -0.015319437748624402,
        6 0.008273789163814023
     8: 0 0.6241109587160757, 3 -3.3608926294469414, 4 -0.868219346841726, 5 27.59209969944671,
        6 20.154067550477894, 7 -43.48988418106996
     9: 0 0.47766253643826434, 3 -2.4881146199716677, 4 -0.590290826836843, 5 21.230051448181193,
        6 15.279233632882423, 7 -33.28821096898486, 8 -0.020331201708508627
    10: 0 -0.9371424300859873, 3 5.186372428844064, 4 1.0914373489967295, 5 -8.149787010746927,
        6 -18.52006565999696, 7 22.739487099350505, 8 2.4936055526796523, 9 -3.0467644718982196
    11: 0 2.273310147516538, 3 -10.53449546673725, 4 -2.0008720582248625, 5 -17.9589318631188,
        6 27.94888452941996, 7 -2.8589982771350235, 8 -8.87285693353063, 9 12.360567175794303,
        10 0.6433927460157636
    12: 0 0.054293734116568765, 5 4.450312892752409, 6 1.8915178993145003, 7 -5.801203960010585,
        8 0.3111643669578199, 9 -0.1521609496625161, 10 0.20136540080403034, 11 0.04471061572777259
    13: 0 0.056167502283047954, 6 0.25350021021662483, 7 -0.2462390374708025, 8 -0.12419142326381637,
        9 0.15329179827876568, 10 0.00820105229563469, 11 0.007567897660545699, 12 -0.008298
    14: 0 0.03183464816350214, 5 0.028300909672366776, 6 0.053541988307438566, 7 -0.05492374857139099,
        10 -0.00010834732869724932, 11 0.0003825710908356584, 12 -0.00034046500868740456, 13 0.1413124436746325
    15: 0 -0.42889630158379194, 5 -4.697621415361164, 6 7.683421196062599, 7 4.06898981839711,
        8 0.3567271874552811, 12 -0.0013990241651590145, 13 2.9475147891527724, 14 -9.15095847217987
    """,
)
C = np.array(
    (
        *(
            0.0,
            0.05260015195876773,
            0.0789002279381516,
            0.1183503419072274,
            0.2816496580927726,
            0.3333333333333333,
            0.25,
            0.3076923076923077,
        ),
        *(0.6512820512820513, 0.6, 0.8571428571428571, 1.0, 1.0, 0.1, 0.2, 0.7777777777777778),
    )
)
# Estimates of the error, of order 3 and of order 5, combined as in the book.
E3, E5 = _table(
    2,
    13,
    """
     0: 0 -0.18980075407240762, 5 4.450312892752409, 6 1.8915178993145003, 7 -5.801203960010585,
        8 -0.4226823213237919, 9 -0.1521609496625161, 10 0.20136540080403034, 11 0.02265179219836082
     1: 0 0.01312004499419488, 5 -1.2251564463762044, 6 -0.4957589496572502, 7 1.6643771824549864,
        8 -0.35032884874997366, 9 0.3341791187130175, 10 0.08192320648511571, 11 -0.022355307863886294
    """,
)
# Rows 3 to 6 of the continuous extension.
D = _table(
    4,
    16,
    """
     0: 0 -8.428938276109013, 5 0.5667149535193777, 6 -3.0689499459498917, 7 2.38466765651207,
        8 2.117034582445028, 9 -0.871391583777973, 10 2.2404374302607883, 11 0.6315787787694688,
        12 -0.08899033645133331, 13 18.148505520854727, 14 -9.194632392478356, 15 -4.436036387594894
     1: 0 10.427508642579134, 5 242.28349177525817, 6 165.20045171727028, 7 -374.5467547226902,
        8 -22.113666853125306, 9 7.733432668472264, 10 -30.674084731089398, 11 -9.332130526430229,
        12 15.697238121770845, 13 -31.139403219565178, 14 -9.35292435884448, 15 35.81684148639408
     2: 0 19.985053242002433, 5 -387.0373087493518, 6 -189.17813819516758, 7 527.8081592054236,
        8 -11.57390253995963, 9 6.8812326946963, 10 -1.0006050966910838, 11 0.7777137798053443,
        12 -2.778205752353508, 13 -60.19669523126412, 14 84.32040550667716, 15 11.99229113618279
     3: 0 -25.69393346270375, 5 -154.18974869023643, 6 -231.5293791760455, 7 357.6391179106141,
        8 93.40532418362432, 9 -37.45832313645163, 10 104.0996495089623, 11 29.8402934266605,
        12 -43.53345659001114, 13 96.32455395918828, 14 -39.17726167561544, 15 -149.72683625798564
    """,
)

# Which numbers define the method DOPRI5, for short steps?
#
# Dormand & Prince's pair of orders 5(4) with a continuous extension of order 4, which needs no stage of its own (same source).
# Stage 6 is the first stage of the next step.

SHORT_STAGES = 6

A_SHORT = _table(
    7,
    7,
    """
     1: 0 0.2
     2: 0 0.075, 1 0.225
     3: 0 0.9777777777777777, 1 -3.7333333333333334, 2 3.5555555555555554
     4: 0 2.9525986892242035, 1 -11.595793324188385, 2 9.822892851699436, 3 -0.2908093278463649
     5: 0 2.8462752525252526, 1 -10.757575757575758, 2 8.906422717743473, 3 0.2784090909090909, 4 -0.2735313036020583
     6: 0 0.09114583333333333, 2 0.44923629829290207, 3 0.6510416666666666, 4 -0.322376179245283,
        5 0.13095238095238096
    """,
)
C_SHORT = np.array((0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0))
# Estimate of the error, of order 4; row 3 of the continuous extension.
E_SHORT, D_SHORT = _table(
    2,
    7,
    """
     0: 0 0.0012326388888888888, 2 -0.0042527702905061394, 3 0.03697916666666667, 4 -0.05086379716981132,
        5 0.0419047619047619, 6 -0.025
     1: 0 -1.1270175653862835, 2 2.675424484351598, 3 -5.685526961588504, 4 3.5219323679207912, 5 -1.7672812570757455,
        6 2.382468931778144
    """,
)

# When, within a coupled step, does a decided mode end?

NONE_FIRED = -1  # in the place of a monitor's code


@kernel
def _slack(model, regime, options, code, smooth):
    """How far beyond zero velocity the monitors of slips and of moving bearings fire; the reversal is where it vanishes."""
    j = code - MONITORS * smooth.held.contacts
    if j >= 0:
        if regime.grip[j] == STICK:
            return 0.0
        return 0.5 * smooth.held.lenience * options.speed_zero / options.size * model.coordinates[j].scale
    slides = code % MONITORS == TANGENTIAL and regime.mode[regime.active[code // MONITORS]] != STICK
    return smooth.held.lenience * SLIP_SLACK * options.speed_zero if slides else 0.0


@kernel
def _evaluate(model, regime, options, tau, smooth, out_counts):
    """Evaluate the motion, and with it all monitors, at time tau of the step; returns the smallest."""
    step = smooth.step
    for i in range(len(smooth.y)):
        smooth.y[i] = dense_value(step, i, tau)
    return motion(model, regime, options, step.span.start + tau, smooth, out_counts)


@kernel
def _root(model, regime, options, which, low, high, smooth, out_counts):
    """Time at which one monitor, positive at low, passes zero; `high` where it is still positive then.

    The monitors at low are in `smooth.before`, those at high in `smooth.monitors`.
    """
    monitors = smooth.monitors
    f_low, f_high = smooth.before[which], monitors[which]
    if f_high > 0.0:
        return high  # another one has fired before
    slack = _slack(model, regime, options, which, smooth)
    if f_low <= slack:
        slack = 0.0
    f_low -= slack
    f_high -= slack
    bracket = opened(low, f_low, high, f_high)
    tau = next_time(bracket)
    while is_open(bracket, tau, ROOT_RESOLUTION * (smooth.step.span.start + bracket.high)):
        _evaluate(model, regime, options, tau, smooth, out_counts)
        f = monitors[which] - slack
        bracket = narrowed(bracket, tau, f, f <= 0.0)
        if f == 0.0:
            break
        tau = next_time(bracket)
    return bracket.high


@kernel
def first_leave(model, regime, options, smallest, smooth, out_counts):
    """(time, code of the monitor): when in the coupled step one is first no longer positive; infinity if all stay positive.

    `smallest`: the smallest monitor at the stages of the step. Beyond the end of a primitive forces mean nothing: where two
    contacts change places, the one that pulls before pushes then, so that monitors are read again just before one leaves.
    """
    looks = _looks_for_gaps(model, regime, smooth)
    if smallest > 0.0 and looks == 0:
        return math.inf, NONE_FIRED
    looks = max(looks, MONITOR_SAMPLES)
    length = smooth.step.span.length
    codes = MONITORS * smooth.held.contacts + len(model.coordinates)
    for code in range(codes):
        if smooth.before[code] <= 0.0:
            return 0.0, code
    before = 0.0
    for sample in range(1, looks + 1):
        tau = length * sample / looks
        if _evaluate(model, regime, options, tau, smooth, out_counts) <= 0.0:
            return _first_before(model, regime, options, before, tau, smooth, out_counts)
        before = tau
        copy(smooth.monitors, smooth.before)
    return math.inf, NONE_FIRED


# Between two stages of a step a contact may pass the whole gap between the ends of an arc: the notch of a duplex roller.


@kernel
def _looks_for_gaps(model, regime, smooth):
    """At how many places of the step the monitors have to be read so that no contact passes the gap of an arc unseen."""
    step, n, most = smooth.step, len(model.coordinates), 0.0
    for j in range(smooth.held.contacts):
        contact = model.contacts[regime.active[j]]
        a, b = model.primitives[contact.a], model.primitives[contact.b]
        gap = min(gap_of_arc(a), gap_of_arc(b))
        if gap == math.inf:
            continue
        turning = 0.0
        for at in range(3):  # at the step's start, middle and end
            for i in range(2 * n):
                smooth.y[i] = dense_value(step, i, 0.5 * at * step.span.length)
            for body in (a.body, b.body):
                place_body(model, body, smooth.y[:n], smooth.y[n : 2 * n], smooth.pose)
            contact_kinematics(model, regime.active[j], smooth.pose, 0, smooth.closed)
            slip, reach = abs(smooth.closed.kin[0].gT_dot), min(_reach(a), _reach(b))
            turning = max(turning, abs(smooth.pose[a.body].w - smooth.pose[b.body].w) + slip / reach)
        most = max(most, turning * step.span.length / gap)
    return math.ceil(LOOKS_PER_GAP * most) if most > PASSES_GAP else 0


@kernel
def _reach(primitive):
    """Radius of an arc whose gap could be passed, m; infinite of other primitives."""
    return primitive.radius if gap_of_arc(primitive) < math.inf else math.inf


@kernel
def _first_before(model, regime, options, before, tau, smooth, out_counts):
    """(time, code of the monitor): the first to end between `before`, where all are positive, and tau, where some are not."""
    best, code, left = _earliest(model, regime, options, before, tau, smooth, out_counts)
    for _ in range(MONITOR_SAMPLES):
        if not (left and before < best and smooth.held.contacts > 1):
            break
        tau = _while_within(options, before, best, smooth)
        if _evaluate(model, regime, options, tau, smooth, out_counts) > 0.0:
            break
        best, code, left = _earliest(model, regime, options, before, tau, smooth, out_counts)
    return best, code


@kernel
def _while_within(options, before, best, smooth):
    """A time just before `best`, at which the contacts that have left by then were within their primitives."""
    nearest = math.inf
    for j in range(smooth.held.contacts):
        nearest = min(nearest, smooth.before[MONITORS * j + EXTENT])
    return best - min(WITHIN_ENDS * options.extent / nearest, 0.5) * (best - before)


@kernel
def _earliest(model, regime, options, before, tau, smooth, out_counts):
    """The earliest root among the monitors that fire at tau and not `before`; its code; had a contact left by tau?"""
    fired, left = 0, False
    for code in range(MONITORS * smooth.held.contacts + len(model.coordinates)):
        if smooth.monitors[code] <= 0.0:
            smooth.fired[fired] = code
            fired += 1
            left = left or (code < MONITORS * smooth.held.contacts and code % MONITORS == EXTENT)
    best, first = tau, smooth.fired[0]
    for j in range(fired):
        if j > 0:
            _evaluate(model, regime, options, best, smooth, out_counts)
        root = _root(model, regime, options, smooth.fired[j], before, best, smooth, out_counts)
        if root < best:
            best, first = root, smooth.fired[j]
    return best, first, left


@kernel
def first_turn(model, regime, q, u):
    """First time in an exact flight at which a bearing with dry friction comes to a stop; infinity if none does."""
    first = math.inf
    for i in range(len(model.coordinates)):
        if regime.awake[i] and regime.grip[i] != STICK and model.coordinates[i].coulomb > 0.0:
            if regime.grip[i] * u[i] < 0.0:
                return 0.0  # it turned at the very end of the last flight
            first = min(first, turning_time(model.coordinates[i], regime.grip[i], q[i], u[i]))
    return first


# Safety is smaller than usual: the motion of coupled bodies grows sharper from step to step, and repeating a step costs more
# than shortening it.
SAFETY, SHRINK, GROW = 0.78, 0.2, 6.0

# Of the proposed step: so soon a contact may close that the step ends there; with no more left, order 5 is tried; the shortest
# step. Of the way to that event: how far a step goes, which is hardly beyond: at its end the extension is as exact as the step,
# at five sixths it may be off by some hundred times more. Of the error that a step may have: the most at order 5.
SOON, SHORT, LEAST_SHORT, BEYOND_EVENT = 0.25, 0.2, 0.01, 1.02
SHORT_ERROR = 0.1

PROBE = 0.75  # share of a step after which its extension's defect is largest


@kernel
def _stage(model, regime, options, short, s, h, smooth, out_counts):
    """Derivative of stage s, of DOPRI5 if `short`, into `stages[s]`; returns the smallest monitor."""
    step = smooth.step
    y0, y, stages = step.y0, smooth.y, step.stages
    width = len(y0)
    for i in range(width):
        y[i] = 0.0
    for j in range(s):
        share = A_SHORT[s, j] if short else A[s, j]
        if share != 0.0:
            for i in range(width):
                y[i] += share * stages[j, i]
    for i in range(width):
        y[i] = y0[i] + h * y[i]
    node = C_SHORT[s] if short else C[s]
    smallest = motion(model, regime, options, step.span.start + node * h, smooth, out_counts)
    copy(smooth.dy, stages[s])
    return smallest


@kernel
def _tolerance(model, options, step):
    """The relative error of this step: less where all is slow, since what leaves an unstable rest multiplies its errors."""
    n, fastest = len(model.coordinates), 0.0
    for i in range(n):
        coordinate = model.coordinates[i]
        fastest = max(fastest, max(abs(step.y0[n + i]), abs(step.y1[n + i])) / (coordinate.scale * coordinate.rate))
    if fastest >= SLOW:
        return options.tolerance
    return min(options.tolerance, max(options.tolerance * fastest / SLOW, SLOW_ERROR))


@kernel
def _error(model, tolerance, short, h, step):
    """Estimated error of the step over the tolerance; above 1 it must be repeated."""
    n = len(model.coordinates)
    five, three = 0.0, 0.0
    for i in range(2 * n):
        coordinate = model.coordinates[i % n]
        scale = coordinate.scale
        if i >= n:
            scale = max(scale * coordinate.rate, abs(step.y0[i]), abs(step.y1[i]))
        e5, e3 = 0.0, 0.0
        for s in range((SHORT_STAGES if short else STAGES) + 1):
            e5 += (E_SHORT[s] if short else E5[s]) * step.stages[s, i]
            e3 += 0.0 if short else E3[s] * step.stages[s, i]
        five += (e5 / scale) ** 2
        three += (e3 / scale) ** 2
    if five == 0.0:
        return 0.0
    return abs(h) * five / math.sqrt((five + 0.01 * three) * 2 * n) / tolerance


@kernel
def _extend(model, regime, options, short, h, smooth, out_counts):
    """Coefficients of the continuous extension into `dense`; returns the smallest monitor at its stages."""
    step, smallest, end = smooth.step, math.inf, SHORT_STAGES if short else STAGES
    for s in range(end + 1, end + 1 if short else end + 4):
        smallest = min(smallest, _stage(model, regime, options, short, s, h, smooth, out_counts))
    for i in range(len(step.y0)):
        change = step.y1[i] - step.y0[i]
        first, last = h * step.stages[0, i], h * step.stages[end, i]
        step.dense[0, i] = change
        step.dense[1, i] = first - change
        step.dense[2, i] = 2.0 * change - last - first
        for row in range(4):
            total = 0.0
            if short and row == 0:
                for s in range(end + 1):
                    total += D_SHORT[s] * step.stages[s, i]
            for s in range(0 if short else end + 4):
                total += D[row, s] * step.stages[s, i]
            step.dense[3 + row, i] = h * total
    return smallest


@kernel
def _defect(model, tolerance, h, step):
    """How far the slope of the extended places is from the extended velocities, over what it may be; above 1: to be repeated.

    Neither is exact, and the error of both has the order of h^8. Times the step, so that it compares with a place.
    """
    n = len(model.coordinates)
    worst = 0.0
    for i in range(n):
        slope = dense(step, i, PROBE * h)[1]
        worst = max(worst, abs(slope - dense_value(step, n + i, PROBE * h)) / model.coordinates[i].scale)
    return abs(h) * worst / (DEFECT * tolerance)


@kernel
def _imbalance(model, options, h, greatest, smooth):
    """By how much energy on the extended path misses the work done, over what it may; above 1: to be repeated.

    Where an event cuts the step, its sums are read there. `greatest`: of the kinetic energy so far, J.
    """
    step, n = smooth.step, len(model.coordinates)
    for i in range(len(step.y0)):
        smooth.y[i] = dense_value(step, i, PROBE * h)
    before = stored_energy(model, step.y0[:n], step.y0[n : 2 * n])
    after = stored_energy(model, smooth.y[:n], smooth.y[n : 2 * n]) + energy_on_side(model, step.side, smooth.y[:n])
    drive, damping, friction = smooth.y[2 * n], smooth.y[2 * n + 1], smooth.y[2 * n + 2]
    turned = before + after + abs(drive) + abs(damping) + abs(friction)
    allowed = options.ledger * max(greatest, kinetic_energy(model, smooth.y[n : 2 * n])) + LEDGER_ROUNDING * turned
    for i in range(n):  # what the tolerance leaves to what stands
        coordinate = model.coordinates[i]
        allowed += 0.5 * coordinate.mass * (options.tolerance * coordinate.scale * coordinate.rate) ** 2
    return abs(after - before - drive + damping + friction) / allowed if allowed > 0.0 else 0.0


@kernel
def _begin_step(model, state, smooth):
    """Begin a coupled step at the state."""
    step, regime = smooth.step, state.regime
    n = len(model.coordinates)
    step.span.kind, step.span.start = COUPLED, state.clock.time
    for i in range(n):
        step.q[i], step.u[i], step.awake[i], step.grip[i] = state.q[i], state.u[i], regime.awake[i], regime.grip[i]
        step.y0[i], step.y0[n + i] = state.q[i], state.u[i]
    for i in range(SUMS):
        step.y0[2 * n + i] = 0.0
    smooth.held.pinned = begin_on_pins(model, state.a, step)
    engage(model, regime.active, state.instant, smooth)


@kernel
def coupled_step(model, state, options, longest, event_after, smooth):
    """One accepted step of at most `longest` seconds from the state, left in `smooth.step`; not far beyond `event_after` (s).

    Returns (made: False if it gets too small, the smallest monitor met at its stages). Proposes the next length in
    `state.clock.step`.
    """
    step, regime = smooth.step, state.regime
    _begin_step(model, state, smooth)
    h, beyond = min(state.clock.step, longest), max(BEYOND_EVENT * event_after, LEAST_SHORT * state.clock.step)
    # Only where a contact is to close: what ends at a knot of a force over time may turn back twice on the way.
    short, shrunk = beyond < min(h, SHORT * state.clock.step), False
    h = min(h, beyond)
    smooth.held.jammed, least = 0, 0.0
    at_start = _stage(model, regime, options, short, 0, h, smooth, state.counts)  # whatever the length of the step
    copy(smooth.monitors, smooth.before)
    if smooth.held.jammed:
        return False, at_start
    while True:
        smallest, smooth.held.jammed = at_start, 0
        for s in range(1, (SHORT_STAGES if short else STAGES) + 1):
            smallest = min(smallest, _stage(model, regime, options, short, s, h, smooth, state.counts))
        for i in range(len(step.y0)):
            step.y1[i] = smooth.y[i]
        tolerance = _tolerance(model, options, step) * (SHORT_ERROR if short else 1.0)
        error = _error(model, tolerance, short, h, step)
        if error <= 1.0:
            step.span.length = h
            smallest = min(smallest, _extend(model, regime, options, short, h, smooth, state.counts))
            defect = _defect(model, tolerance, h, step)
            if options.ledger > 0.0 and h > least:
                least = max(least, LEAST_FOR_LEDGER * h)
                defect = max(defect, _imbalance(model, options, h, state.worst.kinetic_energy, smooth))
            error = defect if defect > 1.0 else error
            error = math.inf if smooth.held.jammed else error
        factor = min(GROW, max(SHRINK, SAFETY * error**-0.125)) if error > 0.0 else GROW
        if error <= 1.0:
            break
        if not h > SMALLEST_STEP * longest_step(options, state.clock.time):
            return False, smallest
        state.counts.rejected_steps += 1
        if short:  # of the higher order it may well be good enough
            short = False
            continue
        shrunk = True
        h *= factor if error < math.inf else SHRINK
    if not short:
        proposed = h * (min(1.0, factor) if shrunk else factor)
        if h <= least:  # rounding of the ledger says nothing against a longer one either
            proposed = max(proposed, least / LEAST_FOR_LEDGER)
        elif not shrunk:  # a step cut short says nothing against a longer next one
            proposed = max(proposed, min(state.clock.step, h * GROW))
        state.clock.step = min(longest_step(options, state.clock.time), proposed)
    bound_accelerations(step, len(model.coordinates))
    state.counts.steps += 1
    return True, smallest


# The path of a step drifts off the contacts in force. Drift is taken back, and a contact that ends the step closes where that
# has been done (docs/theory/method.md 2.10): the next one of two nearly parallel faces would be met late otherwise.


@kernel
def accept_coupled(model, state, options, end, touched, scratch):
    """Bring the state to time `end` of a coupled step, or to when `touched` closes: sums, positions and velocities.

    Returns (that time, True; False where drift is no rounding).
    """
    before = _follow_step(model, state, options, end, scratch)
    if touched != NO_CONTACT:
        end, before = _follow_to_touch(model, state, options, (end, before), touched, scratch)
    smooth = scratch.smooth
    n = len(model.coordinates)
    state.sums.drive += smooth.y[2 * n]
    state.sums.damping += smooth.y[2 * n + 1]
    state.sums.friction += smooth.y[2 * n + 2]
    for i in range(n):
        state.a[i] = smooth.dy[n + i]
    state.worst.kinetic_energy = max(state.worst.kinetic_energy, before)
    change = kinetic_energy(model, state.u) - before
    return end, is_explained(model, options, before, change, state.worst.kinetic_energy)


@kernel
def _follow_to_touch(model, state, options, followed, touched, scratch):
    """Bring the state, which is where a coupled step ends, to where contact `touched` closes on the way without drift.

    `followed` and what is returned: (time, kinetic energy before drift is taken back, J). The end of the step stays the end
    where the contact does not close before. Between nearly parallel faces the drift of a contact in force is a long way to the
    next face.
    """
    pose, (end, before) = scratch.smooth.pose, followed
    tau, kinetic = end, before
    for _ in range(TOUCH_STEPS):
        place(model, state.q, state.u, pose)
        look = normal_gap(model, touched, pose)
        if abs(look.gap) <= HIDDEN_REBOUND * options.gap_zero:
            return tau, kinetic
        if (tau == end and look.gap > 0.0) or look.rate >= 0.0:
            break
        earlier = min(tau - look.gap / look.rate, end)
        if earlier <= 0.0:
            break
        tau, kinetic = earlier, _follow_step(model, state, options, earlier, scratch)
    if tau < end:
        _follow_step(model, state, options, end, scratch)
    return end, before


@kernel
def _follow_step(model, state, options, end, scratch):
    """Positions and velocities at time `end` of a coupled step, drift taken back; returns the kinetic energy before that, J."""
    step, smooth, projection = scratch.step, scratch.smooth, scratch.projection
    closed, pose, inverse = smooth.closed, smooth.pose, scratch.work.system.inverse
    n = len(model.coordinates)
    for i in range(2 * n + SUMS):
        value = dense_value(step, i, end) if end < step.span.length else step.y1[i]
        smooth.y[i] = value
        if i < n:
            state.q[i] = value
        elif i < 2 * n:
            state.u[i - n] = value
    for i in range(n):
        coordinate = model.coordinates[i]
        if coordinate.driven and coordinate.linear:  # known in closed form: no error of steps adds up
            state.q[i], state.u[i] = flow(coordinate, OPEN, step.y0[i], step.y0[n + i], end)
            smooth.y[i], smooth.y[n + i] = state.q[i], state.u[i]
    motion(model, state.regime, options, step.span.start + end, smooth, state.counts)
    before = kinetic_energy(model, state.u)
    first = 0
    while first < state.instant.awake_contacts:
        m = place_contacts(model, state.regime.active, first, state.regime.upto[first], pose, closed)
        deepest = project_positions(closed, m, True, options.behind, inverse, projection, state.q)
        state.worst.penetration = max(state.worst.penetration, deepest)
        if _turns_rates(model, state.u, options, m, closed):
            place(model, state.q, state.u, pose)
            refresh(model, m, closed, pose)
        project_velocities(closed, m, state.regime.mode, DEPENDENT_IN_STEPS, inverse, projection, state.u)
        first += m
    return before


@kernel
def _turns_rates(model, u, options, m, closed):
    """True if taking back the gaps of the m contacts changes their rates, by the gap times how fast bodies turn."""
    furthest, fastest = 0.0, 0.0
    for i in range(m):
        furthest = max(furthest, abs(closed.kin[i].g))
    for i in range(len(u)):
        fastest = max(fastest, abs(u[i]) / model.coordinates[i].scale)
    return furthest * fastest > RATES_TURNED * options.speed_zero
