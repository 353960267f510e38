"""What does a scene look like in three dimensions, and at which instants must a player know where its bodies are?

A player draws straight lines between keys, so keys stand as close as the motion asks for.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from watchsim.geometry.meshes import MOST_TURN, Piece, Placed, Track, laid, plate, revolved, turned_about, united
from watchsim.render.palette import BLUED, BRASS, GILT, PLATE, RUBY, STEEL, Finish, finish, looks
from watchsim.render.rows import kept_rows, off_line
from watchsim.render.view import Window, poses, stretch
from watchsim.scene.layer_heights import Slab
from watchsim.scene.scene import Body, Scene
from watchsim.scene.solids import HAIRSPRING, LYING, UPRIGHT
from watchsim.scene.trains import at_start, is_still
from watchsim.simulation.trajectory import Array, Trajectory

EVENLY = 2000  # instants besides the rows of the run
TURN = math.radians(0.02)  # what an angle may be off between keys
SHARE = 2e-4  # of its body's travel: what a place may be
CLOSEST = 1e-6  # s on the screen between two keys: single precision must distinguish them


def keyframes(run: Trajectory, window: Sequence[float] | None, speed: float) -> list[Track]:
    """A track for every body that can move; the window begins at 0 s and is played at `speed` (1/20: slow motion).

    ValueError for a window that was not recorded, or a speed that is not positive.
    """
    if not (math.isfinite(speed) and speed > 0.0):
        raise ValueError(f"speed = {speed}: give seconds of the watch per second of the animation, such as 1 or 1/20")
    span = stretch(run, window, unbroken=True)
    times = _instants(run, span, CLOSEST * speed)
    placed = poses(run, times)
    return [
        _track(body.name, (times - span[0]) / speed, placed[body.name])
        for body in run.scene.bodies
        if not is_still(run.scene, body)
    ]


def _instants(run: Trajectory, span: Window, apart: float) -> Array:
    inside = run.t[(run.t > span[0]) & (run.t < span[1])]
    times = np.union1d(np.linspace(*span, EVENLY), inside)
    # Of instants that lie closer together than that, the first is kept; both ends always.
    slots = np.floor((times - span[0]) / apart)
    first = np.concatenate(([True], np.diff(slots) > 0.0))
    return np.append(times[first][:-1], span[1]) if len(times) > 1 else times


def _track(name: str, t: Array, frames: Array) -> Track:
    """As few keys as straight lines allow."""
    travel = max(float(np.ptp(frames[:, :2], axis=0).max()), 1e-9)

    def fits(i: int, j: int) -> bool:
        if abs(frames[j, 2] - frames[i, 2]) > MOST_TURN:
            return False
        off = off_line(t, frames, i, j)
        return bool(np.all(off[:, 2] <= TURN) and np.all(off[:, :2] <= SHARE * travel))

    kept = kept_rows(len(t), fits)
    return Track(name, t[kept], frames[kept, :2], frames[kept, 2])


METALS = ((12e3, GILT), (8.0e3, BRASS), (5e3, STEEL), (3e3, RUBY))  # kg/m³ from which on: gold, copper alloys, steel, stones


def placed_solids(scene: Scene, slabs: tuple[Slab, ...], deviation: float) -> list[Placed]:
    """The solids of every body that has any, in its frame, with its pose at the start; chords within `deviation` metres."""
    found, worn = [], looks(scene)
    for body in at_start(scene).bodies:
        pieces = [
            piece for slab in slabs if slab.body == body.name for piece in _pieces(slab, body, worn[body.name], deviation)
        ]
        if pieces:
            found.append(Placed(body.name, _named_apart(pieces), body.position, body.angle))
    return found


def closed_solids(scene: Scene, slabs: tuple[Slab, ...], deviation: float) -> list[Placed]:
    """The same for programs that want closed surfaces: plates of a body that lie at one height and meet become one.

    Colours are lost, which such files do not hold anyway.
    """
    found = []
    for body in placed_solids(scene, tuple(slab for slab in slabs if not _is_plate(slab)), deviation) + _bare(scene, slabs):
        levels: dict[tuple[float, float], list[Slab]] = {}
        for slab in slabs:
            if slab.body == body.name and _is_plate(slab):
                levels.setdefault((slab.middle - 0.5 * slab.thickness, slab.thickness), []).append(slab)
        pieces = list(body.pieces)
        for (bottom, thickness), layers in levels.items():
            mesh = united([slab.loops for slab in layers], bottom, thickness, deviation)
            if mesh is not None:
                pieces.append(Piece("+".join(slab.layer for slab in layers), mesh, PLATE.fill, True))
        if pieces:
            found.append(Placed(body.name, pieces, body.position, body.angle))
    return found


def _bare(scene: Scene, slabs: tuple[Slab, ...]) -> list[Placed]:
    """The bodies that have nothing but plates."""
    turned = {slab.body for slab in slabs if not _is_plate(slab)}
    return [Placed(body.name, (), body.position, body.angle) for body in at_start(scene).bodies if body.name not in turned]


def _is_plate(slab: Slab) -> bool:
    return slab.solid is None or slab.solid.kind not in (UPRIGHT, LYING)


def _pieces(slab: Slab, body: Body, own: Finish, deviation: float) -> Iterator[Piece]:
    solid = slab.solid
    look = _finish(slab, body, own)
    metal = look is not RUBY
    if solid is not None and solid.kind in (UPRIGHT, LYING):
        mesh = revolved(solid.upright_profile(), deviation)
        if mesh is None:
            return
        if solid.kind == UPRIGHT:
            middle = 0.5 * float(mesh.bounds[0][2] + mesh.bounds[1][2])
            mesh.apply_translation((1e3 * solid.pivot[0], 1e3 * solid.pivot[1], 1e3 * slab.middle - middle))
            yield Piece(slab.layer, mesh, look.fill, metal)
            return
        lying = laid(mesh, *solid.axis, slab.middle)
        for k in range(solid.count):
            yield Piece(slab.layer, turned_about(lying, solid.pivot, math.tau * k / solid.count), look.fill, metal)
        return
    mesh = plate(slab.loops, slab.middle - 0.5 * slab.thickness, slab.thickness, deviation)
    if mesh is not None:
        yield Piece(slab.layer, mesh, look.fill, metal)


def _finish(slab: Slab, body: Body, own: Finish) -> Finish:
    """By its density where the scene gives one, else by the words of body and layer as in the plane."""
    if slab.solid is None:
        return finish(body, slab.layer, own)
    if slab.solid.kind == HAIRSPRING:
        return BLUED
    return next((look for lightest, look in METALS if slab.solid.density >= lightest), PLATE)


def _named_apart(pieces: list[Piece]) -> list[Piece]:
    """Numbers for pieces of the same name."""
    seen: dict[str, int] = {}
    apart = []
    for piece in pieces:
        seen[piece.name] = seen.get(piece.name, 0) + 1
        name = piece.name if seen[piece.name] == 1 else f"{piece.name} {seen[piece.name]}"
        apart.append(Piece(name, piece.mesh, piece.colour, piece.metal))
    return apart
