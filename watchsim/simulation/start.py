"""Do the bodies stand clear of each other when a run begins?

Within the rounding of drawings bodies that touch may overlap, by more than the event loop takes for a closed contact. What
overlaps so is taken back before the run by the smallest change of the coordinates, in the metric of the mass matrix, that
leaves no gap negative. What cannot be taken back is refused, as is what overlaps by more.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.cell_lookup import cell_key, find_slot
from watchsim.contact.cells import CellFinder
from watchsim.contact.gaps import Closed, closed_contacts, every_contact, poses
from watchsim.mechanism.compile import Compiled
from watchsim.mechanism.overlap import Overlap, faults_at, meetings, overlap_faults, overlaps
from watchsim.model import NO_KEY, Model, frozen
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Scene
from watchsim.simulation.options import Options, options_of
from watchsim.tolerances import FURTHEST_TAKEN_BACK, IMMOBILE, NO_CHANGE_LEFT, OVERLAP_GONE, TOUCH_REACH

# By which smallest change of the coordinates is an overlap taken back?
#
# Contacts push only: no gap may be left negative, each may open. Among all changes that achieve this the one is taken that is
# smallest in the metric of the mass matrix.

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

ROUNDS = 6  # of Newton's method; an overlap is smaller than all radii, so that two suffice


def kinematics_at(model: Model, q: Array) -> Closed:
    """Gaps and force directions of all contacts of the model at rest at q."""
    closed = closed_contacts(len(model.contacts))
    every_contact(model, q, np.zeros(len(q)), poses(len(model.bodies)), closed)
    return closed


def overlapping_rows(model: Model, closed: Closed, options: Options, near: float, least: float) -> Integers:
    """Contacts within their primitives that overlap by more than `least`, up to `near`, without the backs of convex corners."""
    gap = closed.kin.g
    rows = np.flatnonzero((gap < -least) & (gap >= -near) & (closed.kin.margin >= -options.extent))
    return np.array([k for k in rows if not _is_back(model, gap, closed.kin.margin >= -options.extent, int(k))], np.int64)


def _is_back(model: Model, gap: Array, inside: NDArray[np.bool_], k: int) -> bool:
    """True if the same circle lies less deep behind a neighbouring edge: near a sharp corner both faces are close."""
    contact = model.contacts[k]
    beside = set(_beside(model, int(contact.b)))
    rivals = np.flatnonzero((model.contacts.a == contact.a) & inside & (gap > gap[k]))
    return any(int(model.contacts[r].b) in beside for r in rivals)


def _beside(model: Model, primitive: int) -> Iterator[int]:
    """The edges next to one on the same outline, round a convex corner too."""
    for side in ("before", "after"):
        other = int(model.primitives[primitive][side])
        if other >= 0:
            yield other
            beyond = int(model.primitives[other][side])
            if beyond >= 0:
                yield beyond


def taken_back_from(model: Model, q: Array, options: Options, near: float) -> Array | None:
    """Coordinates close to q at which nothing overlaps; None where there are none."""
    kept: set[int] = set()
    root = np.sqrt(model.coordinates.mass)
    moved = q.copy()
    for _ in range(ROUNDS):
        closed = kinematics_at(model, moved)
        # What no motion opens, as a disc about its own pivot against a bar that slides past it, stays as it is drawn.
        across, along = directions(closed, closed.w_N, len(q)) / root, directions(closed, closed.w_T, len(q)) / root
        mobile = np.linalg.norm(across, axis=1) > IMMOBILE * np.linalg.norm(np.hstack([across, along]), axis=1)
        overlapping = overlapping_rows(model, closed, options, near, 0.0)
        overlapping = overlapping[mobile[overlapping]]
        if not len(overlapping) or -closed.kin.g[overlapping].min() <= OVERLAP_GONE * options.gap_zero:
            return moved if _furthest(model, moved - q, options.size) <= FURTHEST_TAKEN_BACK * near else None
        # What touches from outside must not be pushed into.
        close = (np.abs(closed.kin.g) <= near) & (closed.kin.margin >= -options.extent) & (closed.kin.g >= 0.0)
        kept |= {*overlapping.tolist(), *np.flatnonzero(close & mobile).tolist()}
        rows = np.array(sorted(kept))
        change = _least_change(across[rows], -closed.kin.g[rows])
        if change is None:
            return None
        moved += change / root
    return None


def directions(closed: Closed, sparse: Array, n: int) -> Array:
    """(contacts, n): w_N or w_T of all contacts over the coordinates."""
    out = np.zeros((len(closed.ids), n))
    rows, slots = np.nonzero(np.arange(closed.coord.shape[1]) < np.asarray(closed.slots)[:, None])
    np.add.at(out, (rows, closed.coord[rows, slots]), sparse[rows, slots])
    return out


def _least_change(ways: Array, wanted: Array) -> Array | None:
    """The shortest y with ways · y >= wanted, None where there is none (Lawson and Hanson 1974, chapter 23)."""
    from scipy.optimize import nnls

    size = np.linalg.norm(ways, axis=1)
    scale = float(wanted.max())
    rows, bounds = ways / size[:, None], wanted / size
    unit = scale / float(size.max())
    system = np.vstack([rows.T, bounds[None] / unit])
    target = np.append(np.zeros(ways.shape[1]), 1.0)
    loads, _ = nnls(system, target)
    left = system @ loads - target
    if np.linalg.norm(left) < NO_CHANGE_LEFT:
        return None
    change: Array = -left[:-1] / left[-1] * unit
    return change


def _furthest(model: Model, change: Array, size: float) -> float:
    """A bound of how far any point moves, m."""
    return float(np.max(np.abs(change) / model.coordinates.scale * size, initial=0.0))


def clear_start(scene: Scene, compiled: Compiled, finder: CellFinder, options: Options) -> tuple[Array, float]:
    """The coordinates at which the run begins, where no touching contact overlaps, and the overlap taken back (m).

    They are `compiled.q` itself unless something overlaps by more than the event loop takes for a touch. SceneError where
    bodies overlap by more than rounding, or where the overlap cannot be taken back.
    """
    if faults := overlap_faults(scene):
        raise SceneError(faults)
    q, taken_back, refused = _clear(scene, compiled, finder, options)
    if refused:
        raise SceneError(faults_at(scene, refused))
    return q, taken_back


def refusals(scene: Scene, compiled: Compiled) -> list[tuple[Overlap, str]]:
    """What touches at the start in a way that no run can begin with, each with a sentence; overlaps beyond rounding apart."""
    if overlaps(scene):
        return []
    return _clear(
        scene,
        compiled,
        CellFinder(compiled.seen or compiled.model),
        options_of(scene, compiled, scene.tolerance),
    )[2]


def _clear(
    scene: Scene, compiled: Compiled, finder: CellFinder, options: Options
) -> tuple[Array, float, list[tuple[Overlap, str]]]:
    """Coordinates, the overlap taken back, and what cannot be taken back."""
    touching = meetings(scene)
    q = compiled.q
    if not touching or not len(q):
        return q, 0.0, []
    near = TOUCH_REACH * max(met.allowed for met in touching)
    ids = _candidates(compiled.model, finder, q)
    model = compiled.model._replace(contacts=frozen(compiled.model.contacts[ids]))
    closed = kinematics_at(model, q)
    if unknown := [met for met in touching if not _is_known(met, compiled, model, closed, near)]:
        return q, 0.0, [(met, _words(met, NO_GAP)) for met in unknown]
    overlapping = overlapping_rows(model, closed, options, near, options.behind)
    if not len(overlapping):
        return q, 0.0, []
    moved = taken_back_from(model, q, options, near)
    if moved is None:
        worst = max(touching, key=lambda met: met.depth)
        return q, 0.0, [(worst, _words(worst, WEDGED))]
    return moved, float(-closed.kin.g[overlapping].min()), []


def warm_up(scene: Scene, model: Model) -> None:
    """Load or compile the kernel that a start in contact needs."""
    if meetings(scene):
        kinematics_at(model._replace(contacts=frozen(model.contacts[:0].copy())), np.zeros(len(model.coordinates)))


NO_GAP = (
    "but no contact can be computed there: an arc in a hollow of the same radius touches everywhere at once. Give it play, or "
    "move one of them"
)
WEDGED = "and no rounding-size motion takes that back: they are wedged in, or cannot move that way. Move or turn one of them"


def _words(met: Overlap, why: str) -> str:
    (first, second), (x, y) = met.sides, (f"{1e3 * value:.4g}" for value in met.place)
    how = f"overlap by {1e3 * met.depth:.3g} mm" if met.depth > 0.0 else "touch"
    layers = f"layers {first.layer} and {second.layer}"
    return f"{first.body} and {second.body} {how} at the start, at ({x}, {y}) mm ({layers}), {why}"


def _candidates(model: Model, finder: CellFinder, q: Array) -> Integers:
    """The contacts that could be closed at q, ascending."""
    found = [np.zeros(0, np.int64)]
    for p, pair in enumerate(model.pairs):
        key = cell_key(model, p, q) if pair.listed else NO_KEY
        if key == NO_KEY:
            found.append(model.near[pair.near_start : pair.near_stop])
            continue
        slot = find_slot(finder.cells.keys, key)
        if finder.cells.keys[slot] == NO_KEY:
            finder.learn(p, q)
            slot = find_slot(finder.cells.keys, key)
        start = finder.cells.start[slot]
        found.append(finder.cells.entries[start : start + finder.cells.count[slot]])
    return np.unique(np.concatenate(found))


def _is_known(met: Overlap, compiled: Compiled, model: Model, closed: Closed, near: float) -> bool:
    """Is there a contact for what touches as outlines? Its gap and place are known to within their rounding."""
    here = (model.contacts.group == met.contact) & (np.abs(closed.kin.g) <= near) & (closed.kin.margin >= -near)
    sides = {(side.body, side.layer) for side in met.sides}
    for k in np.flatnonzero(here):
        ends = (int(model.contacts[k].a), int(model.contacts[k].b))
        if {(compiled.owners[end], compiled.layers[end]) for end in ends} == sides:
            return True
    return False
