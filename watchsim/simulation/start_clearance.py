"""Do the bodies stand clear of each other when a run begins?

Within the rounding of drawings bodies that touch may overlap, by more than the event loop takes for a closed contact. What
overlaps so is taken back before the run by the smallest change of the coordinates, in the metric of the mass matrix, that
leaves no gap negative. What cannot be taken back is refused, as is what overlaps by more.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.cell_lookup import cell_key, find_slot
from watchsim.candidates.cell_table import CellFinder
from watchsim.contact.kinematics import Closed
from watchsim.mechanism.compile import Compiled
from watchsim.mechanism.overlap import Overlap, faults_at, meetings, overlap_faults, overlaps
from watchsim.model.records import NO_KEY, Model, frozen
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Scene
from watchsim.simulation.options import Options, options_for
from watchsim.simulation.overlap_removal import kinematics_at, overlapping_rows, taken_back_from
from watchsim.tolerances import TOUCH_REACH

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


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
    return _clear(scene, compiled, CellFinder(compiled.model), options_for(compiled.size, scene.tolerance, scene.duration))[2]


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
