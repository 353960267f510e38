"""How do bodies move while contacts couple them?

Right-hand side of the smooth motion in the decided modes, and the monitors that show when a mode ends: a normal force that
vanishes, a slip that reverses, a friction force that reaches its cone, a contact that leaves its primitive, a contact that
comes near Painlevé's paradox, a bearing with dry friction that stops or breaks loose.
"""

from __future__ import annotations

import math

from watchsim.contact.gaps import BACKWARD, FORWARD, OPEN, STICK, contact_kinematics, place_body
from watchsim.dynamics.acceleration import accelerate, solve_mode
from watchsim.dynamics.bearings import (
    LOAD_ROUNDS,
    begin_loads,
    has_settled,
    lay_on,
    note_bare,
    note_share,
    poise,
    press_contacts,
    rub,
    rub_shares,
    share_friction,
)
from watchsim.dynamics.delassus import apply, copy, drive_through_contacts, fill_delassus, own_acceleration
from watchsim.dynamics.forces import add_drag, add_loads, damping_power, drag_power, drive_power, forces
from watchsim.dynamics.friction import jams, share_left
from watchsim.dynamics.moving_frame import is_shaken
from watchsim.dynamics.redundant import keep_independent, solve_small, unit_scale
from watchsim.jit import hot_kernel, kernel
from watchsim.model import FREE, OVER_TIME, REPEATED
from watchsim.simulation.curb_pins import stay_on_side
from watchsim.simulation.scratch import MONITORS
from watchsim.tolerances import (
    DEPENDENT_IN_STEPS,
    LOAD_ROUGH,
    LOOSE,
    PAINLEVE,
    PAINLEVE_WATCHED,
    SLEEP_LOOSE,
    SLIP_SLACK,
    SLIP_WEIGHT,
    TAKEN_BACK_ALONG,
)

# Which closed contacts and coordinates act on each other?
#
# Coordinates that closed contacts join, or that belong to a free body or to a body and its carrier, form an island. No force
# or impulse passes from one island to another: every contact problem is posed for one island, and what happens in it leaves
# the others as they are.


@kernel
def _join(label, i, j):
    """Give both coordinates' islands one label, the smaller."""
    low, high = min(label[i], label[j]), max(label[i], label[j])
    if low == high:
        return
    for k in range(len(label)):
        if label[k] == high:
            label[k] = low


@kernel
def _mover(model, b):
    """A coordinate that moves body b, -1 where none does."""
    body = model.bodies[b]
    if body.first >= 0 or body.carrier < 0:
        return body.first
    return model.bodies[body.carrier].first


@kernel
def label_islands(model, ids, m, out_label):
    """Number the islands that the contacts ids[:m] make: by coordinate, the smallest coordinate of its island."""
    for i in range(len(out_label)):
        out_label[i] = i
    for b in range(len(model.bodies)):
        body = model.bodies[b]
        if body.motion == FREE:
            _join(out_label, body.first, body.first + 1)
            _join(out_label, body.first, body.first + 2)
        if body.first >= 0 and body.carrier >= 0:
            _join(out_label, body.first, model.bodies[body.carrier].first)
    for j in range(len(model.joints)):
        _join(out_label, model.joints[j].coordinate, model.joints[j].on)
    for j in range(len(model.lines)):
        a, b = model.lines[j].a, model.lines[j].b
        if b >= 0 and model.bodies[a].first >= 0 and model.bodies[b].first >= 0:
            _join(out_label, model.bodies[a].first, model.bodies[b].first)
    for row in range(m):
        contact = model.contacts[ids[row]]
        i, j = _mover(model, model.primitives[contact.a].body), _mover(model, model.primitives[contact.b].body)
        if i >= 0 and j >= 0:
            _join(out_label, i, j)


@kernel
def island_of(model, label, k):
    """The island that contact k belongs to."""
    contact = model.contacts[k]
    i = _mover(model, model.primitives[contact.a].body)
    return label[i if i >= 0 else _mover(model, model.primitives[contact.b].body)]


@kernel
def sort_by_island(model, label, m, ids, out_upto):
    """Put the contacts of each island in `ids` side by side, islands ascending, else in the order found.

    upto[i] becomes the place behind the last contact of the island to which ids[i] belongs.
    """
    for row in range(m):
        k, island = ids[row], island_of(model, label, ids[row])
        place = row
        while place > 0 and out_upto[place - 1] > island:
            ids[place], out_upto[place] = ids[place - 1], out_upto[place - 1]
            place -= 1
        ids[place], out_upto[place] = k, island
    end, island = m, -1
    for row in range(m - 1, -1, -1):
        if out_upto[row] != island:
            end, island = row + 1, out_upto[row]
        out_upto[row] = end


@kernel
def place_contacts(model, ids, first, last, pose, out_closed):
    """Kinematics of the contacts ids[first:last] into the first rows of `out_closed`; returns how many."""
    for place in range(first, last):
        contact_kinematics(model, ids[place], pose, place - first, out_closed)
    return last - first


# How is drift off the contacts taken back?
#
# Closed contacts are brought to zero gap, and their gap rates (with the slip of sticking ones) to zero, by the smallest change
# in the metric of the mass matrix: dq = -M⁻¹ W (Wᵀ M⁻¹ W)⁺ g.
#
# What is taken back is rounding, so the change must be of its size. Where two force directions are nearly parallel, or one has
# next to no lever arm (friction on the line of centres), zeroing both rates would move the bodies by far more than the rates
# themselves: directions that the others nearly determine are left as they are (docs/theory/method.md 2.10).


@kernel
def project_positions(closed, m, both, behind, inverse, projection, out_q):
    """Close the gaps of the first m contacts (only negative ones unless `both`); returns the deepest penetration found, m.

    What flat faces have let bodies sink in (`is_immovable`) is no drift and stays. `behind`: see `_wanted`.
    """
    deepest = 0.0
    for i in range(m):
        deepest = max(deepest, -closed.kin[i].g)
    if deepest == 0.0 and not both:
        return deepest
    fill_delassus(closed, m, inverse, projection.G)
    for i in range(m):
        projection.row[i] = 2 * i
    n = m
    if not _close(closed, n, both, behind, projection):
        n = _choose(closed, m, both, behind, projection)
        _close(closed, n, both, behind, projection)
    for row in range(2 * m):
        projection.correction[row] = 0.0
    for i in range(n):
        projection.correction[projection.row[i]] = projection.x[i]
    apply(closed, m, projection.correction, inverse, out_q)
    return deepest


@kernel
def _wanted(closed, row, both, behind, G):
    """By how much the gap of this row shall change, m.

    Not at all where it is deeper than `behind` (m), or so deep that taking it back would move the contact far along its face:
    bodies that have sunk in meet a face at its joint, and on the way back to where it has no gap they would leave that face.
    """
    gap = closed.kin[row // 2].g
    drifted = gap >= -behind and abs(G[row, row + 1]) * -gap <= TAKEN_BACK_ALONG * behind * G[row, row]
    return -gap if (both or gap < 0.0) and drifted else 0.0


@kernel
def _fill_system(n, projection):
    """The n rows of G in `projection.row`, each with each."""
    for i in range(n):
        for j in range(n):
            projection.A[i, j] = projection.G[projection.row[i], projection.row[j]]


@kernel
def _close(closed, n, both, behind, projection):
    """What closes the gaps of n rows into `projection.x`; False where their directions depend on each other."""
    _fill_system(n, projection)
    for i in range(n):
        projection.change[i] = _wanted(closed, projection.row[i], both, behind, projection.G)
        projection.scale[i] = _scale_of(projection.G, projection.row[i], DEPENDENT_IN_STEPS)
    return _solve(n, DEPENDENT_IN_STEPS, projection) == n


@kernel
def _solve(n, independent, projection):
    """The impulses that make the changes of n rows; returns how many of these can be made."""
    A, change, x = projection.A, projection.change, projection.x
    return solve_small(A, change, n, projection.scale, projection.order, x, independent)


@kernel
def _choose(closed, m, both, behind, projection):
    """Leave in `projection.row` gaps whose directions do not depend on each other, of m; returns their number.

    Not all can be closed: those are that the bodies meet first on the way there, so that none of the others is pressed in.
    """
    G, A, row, wanted, scale = projection.G, projection.A, projection.row, projection.wanted, projection.scale
    for i in range(m):
        own, place = _scale_of(G, 2 * i, DEPENDENT_IN_STEPS) * _wanted(closed, 2 * i, both, behind, G), i
        while place > 0 and wanted[place - 1] < own:
            wanted[place], row[place] = wanted[place - 1], row[place - 1]
            place -= 1
        wanted[place], row[place] = own, 2 * i
    for i in range(m):
        scale[i] = _scale_of(G, row[i], DEPENDENT_IN_STEPS)
    for i in range(m):
        for j in range(m):
            A[i, j] = scale[i] * G[row[i], row[j]] * scale[j]
    return keep_independent(A, m, DEPENDENT_IN_STEPS, row)


@kernel
def project_velocities(closed, m, mode, independent, inverse, projection, out_u):
    """Make the gap rates of the first m contacts in force, and the slip of the sticking ones, zero.

    `independent`: DEPENDENT_IN_STEPS or DEPENDENT_AT_EVENTS.
    """
    find_correction(closed, m, mode, independent, inverse, projection)
    apply(closed, m, projection.correction, inverse, out_u)


@kernel
def find_correction(closed, m, mode, independent, inverse, projection):
    """The impulses of `project_velocities` into `projection.correction`."""
    fill_delassus(closed, m, inverse, projection.G)
    n = 0
    for i in range(m):
        state = mode[closed.ids[i]]
        projection.correction[2 * i], projection.correction[2 * i + 1] = 0.0, 0.0
        if state != OPEN:
            n = _add_row(projection, 2 * i, -closed.kin[i].gN_dot, n, independent)
        if state == STICK:
            n = _add_row(projection, 2 * i + 1, -closed.kin[i].gT_dot, n, independent)
    _fill_system(n, projection)
    _solve(n, independent, projection)
    for i in range(n):
        projection.correction[projection.row[i]] = projection.x[i]


@kernel
def remaining_rate(closed, m, i, projection):
    """Gap rate of contact i after the correction just found, m/s."""
    rate = closed.kin[i].gN_dot
    for row in range(2 * m):
        rate += projection.G[2 * i, row] * projection.correction[row]
    return rate


@kernel
def _add_row(projection, row, rate, n, independent):
    """Append the row of G with what its rate shall change by; returns the new number of rows."""
    projection.row[n], projection.change[n] = row, rate
    projection.scale[n] = _scale_of(projection.G, row, independent)
    return n + 1


@kernel
def _scale_of(G, row, independent):
    """Unit diagonal for what can be moved, less for slips; zero for what next to no impulse along its direction moves.

    `independent`: sine² of the angle below which a direction counts as one of the others, or as immovable.
    """
    normal = row - row % 2
    easiest = G[normal, normal] + G[normal + 1, normal + 1]
    own = G[row, row]
    if own <= independent * easiest:
        return 0.0
    return unit_scale(own) if row == normal else SLIP_WEIGHT * unit_scale(own)


# Which bodies stand still on their contacts, and may be skipped until something touches them?


@kernel
def _share_terms(model, out_terms):
    """Rounding in a coordinate of a free body comes from the forces on all three, whatever angle the body has."""
    for b in range(len(model.bodies)):
        if model.bodies[b].motion == FREE:
            x, y, turn = model.bodies[b].first, model.bodies[b].first + 1, model.bodies[b].first + 2
            gyration = (model.coordinates[turn].mass / model.coordinates[x].mass) ** 0.5
            largest = max(out_terms[x], out_terms[y], out_terms[turn] / gyration)
            out_terms[x], out_terms[y], out_terms[turn] = largest, largest, largest * gyration


@kernel
def _is_still(coordinate, u, a, sleep, options, terms):
    """It has no velocity and no acceleration beyond rounding, the share `sleep` of the sum of forces on it without sign."""
    if abs(u) * options.size > options.speed_zero * coordinate.scale:
        return False
    return abs(a) * coordinate.mass <= sleep * terms


@kernel
def mark_loose(model, closed, m, mode, label, a, out_loose):
    """Mark an island, by its m contacts in force, loose where these allow its accelerations `a`.

    Rounding of contact forces moves bodies in the directions that they resist. A body beside an unstable rest moves along them.
    """
    loose = 1
    for i in range(m):
        across, along, most = 0.0, 0.0, 0.0
        easy_N, easy_T = 0.0, 0.0
        for k in range(closed.slots[i]):
            j = closed.coord[i, k]
            mass = model.coordinates[j].mass
            across += closed.w_N[i, k] * a[j]
            along += closed.w_T[i, k] * a[j]
            easy_N += closed.w_N[i, k] ** 2 / mass
            easy_T += closed.w_T[i, k] ** 2 / mass
            most += mass * a[j] * a[j]
        if abs(across) > LOOSE * math.sqrt(easy_N * most):
            loose = 0
        if mode[closed.ids[i]] == STICK and abs(along) > LOOSE * math.sqrt(easy_T * most):
            loose = 0
    island = label[closed.coord[0, 0]]
    for j in range(len(label)):
        if label[j] == island:
            out_loose[j] = loose


@kernel
def begin_terms(h, out_terms):
    """The magnitudes of the forces h."""
    for i in range(len(h)):
        out_terms[i] = abs(h[i])


@kernel
def add_terms(closed, m, force, out_terms):
    """Add the magnitudes of what the m contacts do to each coordinate."""
    for i in range(m):
        for k in range(closed.slots[i]):
            normal, tangential = closed.w_N[i, k] * force[2 * i], closed.w_T[i, k] * force[2 * i + 1]
            out_terms[closed.coord[i, k]] += abs(normal) + abs(tangential)


@kernel
def _will_change(model, table, t):
    """A force over time has knots left; behind the last one it is as constant as any other. One that repeats always has."""
    if table.over == REPEATED:
        return True
    return table.over == OVER_TIME and t < model.knots[table.start + table.count - 1, 0]


@kernel
def has_stopped(model, island, u, a, share, options, event):
    """True if every coordinate of the island is still, but for that `share` of the forces on it, sums in `event.terms`."""
    _share_terms(model, event.terms)
    for i in range(len(event.label)):
        if event.label[i] == island and not _is_still(model.coordinates[i], u[i], a[i], share, options, event.terms[i]):
            return False
    return True


@kernel
def find_sleepers(model, regime, options, time, stands, event, f, out_u, out_a):
    """Set `regime.awake`: an island with a contact or a bearing that holds sleeps if it is still and nothing depends on time.

    The f contacts in force are in `regime.active`, their islands in `event.label`, the magnitudes of the forces on each
    coordinate in `event.terms`. What sleeps has neither velocity nor acceleration. `stands`: also where the case is shaken, as
    long as standing.py finds that it is held.
    """
    label, touched = event.label, event.touched
    n = len(label)
    for i in range(n):
        regime.awake[i] = 0
    touched[:] = 0
    for j in range(f):
        touched[island_of(model, label, regime.active[j])] = 1
    _share_terms(model, event.terms)
    for i in range(n):
        if regime.grip[i] == STICK:
            touched[label[i]] = 1
    for i in range(n):
        sleep, coordinate = SLEEP_LOOSE * options.sleep if event.loose[i] else options.sleep, model.coordinates[i]
        if touched[label[i]] == 0 or not _is_still(coordinate, out_u[i], out_a[i], sleep, options, event.terms[i]):
            _wake(label, label[i], regime.awake)
    for j in range(len(model.tables)):
        if _will_change(model, model.tables[j], time):
            _wake(label, label[model.tables[j].coordinate], regime.awake)
    if is_shaken(model, time) and not stands:
        for k in range(len(model.weighed)):
            first = model.bodies[model.weighed[k].body].first
            if not model.coordinates[first].linear:
                _wake(label, label[first], regime.awake)
    for i in range(n):
        if model.coordinates[i].driven:
            _wake(label, label[i], regime.awake)
    for i in range(n):
        if regime.awake[i] == 0:
            out_u[i], out_a[i] = 0.0, 0.0


@kernel
def is_at_rest(model, awake, b):
    """True for fixed bodies and bodies asleep whose carrier, if any, is asleep as well."""
    body = model.bodies[b]
    if body.first >= 0 and awake[body.first]:
        return False
    return body.carrier < 0 or awake[model.bodies[body.carrier].first] == 0


@kernel
def _wake(label, group, out_awake):
    for i in range(len(label)):
        if label[i] == group:
            out_awake[i] = 1


NORMAL, TANGENTIAL, EXTENT, PARADOX = range(MONITORS)


@kernel
def bearing_monitor(model, grip, lenience, options, j, smooth):
    """Of coordinate j, awake, at the state being evaluated; its grip holds while it is positive."""
    coordinate = model.coordinates[j]
    if grip == OPEN:
        return 1.0
    if grip == STICK:
        return smooth.system.dry[j] - abs(smooth.load[j]) + lenience * options.force_zero * smooth.terms[j]
    slack = 0.5 * lenience * options.speed_zero / options.size * coordinate.scale
    return grip * smooth.y[len(model.coordinates) + j] + slack


@kernel
def normal_margin(system, i, zero):
    """Normal force of contact i in the modes solved, with the share `zero` of its terms on top; not positive where it pulls."""
    normal = system.force[2 * i]
    if normal == 0.0 and system.size[2 * i] == 0.0:
        return 1.0  # nothing acts on this gap: touching bodies that travel together without a force
    return normal + zero * system.size[2 * i] / system.G[2 * i, 2 * i]


@kernel
def cone_margin(friction, system, i, zero):
    """How far the friction force of contact i, which sticks, is from its bound, with the share `zero` of its terms on top."""
    normal = system.force[2 * i]
    if normal == 0.0 and system.size[2 * i] == 0.0:
        return 1.0
    slack = zero * system.size[2 * i] / system.G[2 * i, 2 * i]
    return friction * normal - abs(system.force[2 * i + 1]) + slack


@kernel
def _tangential_monitor(friction, mode, slip, lenience, options, i, system):
    if friction == 0.0:
        return 1.0
    if mode == STICK:
        return cone_margin(friction, system, i, lenience * options.force_zero)
    # A slip that counted as none may run against the mode decided: it ends only beyond what counts as none.
    return mode * slip + lenience * SLIP_SLACK * options.speed_zero


@hot_kernel
def _watch(mode, lenience, options, m, system, modes, closed, out_monitors):
    """Set the monitors of an island's m contacts, `out_monitors[MONITORS * row + kind]`; returns the smallest.

    The mode holds while all are positive.
    """
    smallest, together = math.inf, m > 1 and _slide_into_jam(m, system, modes)
    for i in range(m):
        code, kin, k = MONITORS * i, closed.kin[i], closed.ids[i]
        slides_into_jam = together and modes.drag[i] != 0.0
        slides_into_jam = slides_into_jam or (
            modes.unknown[i] < 0 and jams(system.G, modes.drag[i], m, i, PAINLEVE_WATCHED * PAINLEVE)
        )
        out_monitors[code + NORMAL] = normal_margin(system, i, lenience * options.force_zero)
        out_monitors[code + TANGENTIAL] = _tangential_monitor(
            modes.friction[i], mode[k], kin.gT_dot, lenience, options, i, system
        )
        out_monitors[code + EXTENT] = kin.margin + 2.0 * options.extent
        out_monitors[code + PARADOX] = -1.0 if slides_into_jam else 1.0
        for kind in range(MONITORS):
            smallest = min(smallest, out_monitors[code + kind])
    return smallest


SMALL_PIVOT = 1e-3  # of the first one


@kernel
def _slide_into_jam(m, system, modes):
    """True if the friction of the m contacts leaves next to nothing of how their forces together part the bodies.

    Asked only where a pivot of the system just solved, whose triangle is in `modes.A`, shows that it may.
    """
    n, least, slides = m, 0.0, False
    for i in range(m):
        slides = slides or modes.drag[i] != 0.0
        n += 1 if modes.unknown[i] >= 0 else 0
    for k in range(n):
        least = min(least, modes.A[k, k]) if k > 0 else modes.A[0, 0]
    if not slides or least > SMALL_PIVOT * abs(modes.A[0, 0]):
        return False
    n = 0
    for i in range(m):
        modes.order[n], n = 2 * i, n + 1
        if modes.unknown[i] >= 0:
            modes.order[n], n = 2 * i + 1, n + 1
    return share_left(system.G, modes.drag, modes.order, n, modes.A) <= PAINLEVE_WATCHED * PAINLEVE


@kernel
def engage(model, active, instant, smooth):
    """Find the bodies that the active contacts join, the only ones whose places matter while the modes last."""
    smooth.held.contacts, smooth.held.lenience = instant.awake_contacts, instant.lenience
    smooth.engaged[:] = 0
    for i in range(smooth.held.contacts):
        contact = model.contacts[active[i]]
        smooth.engaged[model.primitives[contact.a].body] = 1
        smooth.engaged[model.primitives[contact.b].body] = 1


@kernel
def settle_loads(model, regime, held, pose, closed, system, modes):
    """Friction of the loaded bearings with the contacts in force into `system.dry` and `system.h`; False if there is none.

    `held`: (contacts in `regime.active`, lenience). `system` holds h and the inverse masses, and what `begin_loads` finds.
    """
    copy(system.h, system.poised)
    for number in range(LOAD_ROUNDS):
        _bear(model, regime, held, pose, closed, system, modes)
        if has_settled(rub(model, regime.grip, system), number):
            return True
    return len(model.bearings) <= len(modes.x) and _settle_as_one(model, regime, held, pose, closed, system, modes)


@kernel
def _bear(model, regime, held, pose, closed, system, modes):
    """Accelerations and loads under `system.h` with the contacts in force."""
    contacts, lenience = held
    accelerate(model, closed, 0, system, system.a)
    lay_on(model, 1.0, system)
    first = 0
    while first < contacts:
        m = place_contacts(model, regime.active, first, regime.upto[first], pose, closed)
        solve_mode(model, closed, m, regime.mode, lenience, system, modes)
        apply(closed, m, system.force, system.inverse, system.a)
        press_contacts(model, closed, m, system.force, system)
        first += m


@kernel
def _settle_as_one(model, regime, held, pose, closed, system, modes):
    """The same where the rounds do not settle: loads are linear in the frictions, see `share_friction`."""
    poise(model, system)
    _bear(model, regime, held, pose, closed, system, modes)
    unit = note_bare(model, system)
    for q in range(len(model.bearings)):
        j = model.bearings[q].coordinate
        system.h[j] -= unit if regime.grip[j] == FORWARD else (-unit if regime.grip[j] == BACKWARD else 0.0)
        _bear(model, regime, held, pose, closed, system, modes)
        system.h[j] = system.poised[j]
        note_share(model, q, unit, system)
    if not share_friction(model, system, modes):
        return False
    rub_shares(model, regime.grip, modes.x, system)
    _bear(model, regime, held, pose, closed, system, modes)
    return rub(model, regime.grip, system) <= LOAD_ROUGH


@kernel
def motion(model, regime, options, t, smooth, out_counts):
    """dy/dt of `smooth.y` = (q, u, sums) at time t (s) into `smooth.dy`; returns the smallest monitor.

    What `engage` finds must be that of the active contacts; `system.inverse` is given. Code of the monitors: MONITORS * place
    in `regime.active` + kind; behind those of all contacts one for each coordinate with its bearing.
    """
    system, modes, contacts, lenience = smooth.system, smooth.modes, smooth.held.contacts, smooth.held.lenience
    n = len(model.coordinates)
    q, u = smooth.y[:n], smooth.y[n : 2 * n]
    closed, out = smooth.closed, smooth.dy
    forces(model, t, q, u, system.h)
    if smooth.held.pinned:
        stay_on_side(model, smooth.step.side, q, system.h)
    begin_loads(model, t, q, u, system)
    add_drag(system.dry, regime.grip, system.h)
    for b in range(len(model.bodies)):
        if smooth.engaged[b]:
            place_body(model, b, q, u, smooth.pose)
    if len(model.bearings) > 0 and not settle_loads(model, regime, (contacts, lenience), smooth.pose, closed, system, modes):
        smooth.held.jammed = 1
    for i in range(n):
        out[i], out[n + i] = u[i], own_acceleration(model, system, i)
        smooth.load[i], smooth.terms[i] = system.h[i], abs(system.h[i])
    smallest, friction, driven, first = math.inf, 0.0, 0.0, 0
    while first < contacts:
        m = place_contacts(model, regime.active, first, regime.upto[first], smooth.pose, closed)
        solve_mode(model, closed, m, regime.mode, lenience, system, modes)
        apply(closed, m, system.force, system.inverse, out[n : 2 * n])
        add_loads(closed, m, system.force, regime.grip, smooth.load, smooth.terms)
        driven += drive_through_contacts(model, closed, m, system.force, u)
        for i in range(m):
            friction -= system.force[2 * i + 1] * closed.kin[i].gT_dot
        monitors = smooth.monitors[MONITORS * first :]
        smallest = min(smallest, _watch(regime.mode, lenience, options, m, system, modes, closed, monitors))
        first += m
    for i in range(n):
        monitor = bearing_monitor(model, regime.grip[i], lenience, options, i, smooth) if regime.awake[i] else 1.0
        smooth.monitors[MONITORS * contacts + i] = monitor
        smallest = min(smallest, monitor)
        if regime.awake[i] == 0:
            out[n + i] = 0.0
    out[2 * n] = drive_power(model, t, q, u) + driven
    out[2 * n + 1] = damping_power(model, q, u) + drag_power(system.dry, regime.grip, u)
    out[2 * n + 2] = friction
    out_counts.evaluations += 1
    return smallest
