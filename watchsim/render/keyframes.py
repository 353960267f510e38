"""What does a scene look like in three dimensions, and at which instants must a player know where its bodies are?

A player draws straight lines between keys, so keys stand as close as the motion asks for.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.meshes import (
    MM,
    MOST_TURN,
    Bend,
    Piece,
    Placed,
    Track,
    laid,
    plate,
    revolved,
    sheet,
    turned_about,
    united,
)
from watchsim.render.palette import BLUED, BRASS, GILT, PLATE, RUBY, STEEL, Finish, finish, looks
from watchsim.render.rows import kept_rows, off_line
from watchsim.render.view import Hairspring, Window, hairsprings, poses, stretch
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


# A hairspring is a ribbon that stands on its edge above its balance. Between shapes some degrees apart its points go straight.

SHAPES = math.radians(20.0)  # between two shapes: a point of the ribbon strays from its arc by 0.3 % of the spring's radius
RIBBON = 300  # chords
STANDS = 2.5  # widths of the strip that it is high, or
HIGH = 0.015  # of its radius, whichever is more
STRIP = "strip"


def ribbons(scene: Scene, bodies: Sequence[Placed]) -> list[Placed]:
    """The hairsprings that are drawn, as the scene has them at the start, each a body of its own above all `bodies`."""
    top = max((float(piece.mesh.bounds[1][2]) for body in bodies for piece in body.pieces), default=0.0) / MM
    frames = {body.name: np.array([*body.position, body.angle]) for body in at_start(scene).bodies}
    found = []
    known = {body.name for body in bodies}
    for spring in (spring for spring in hairsprings(scene) if spring.body in known):
        points, faces = _ribbon(spring, spring.turned(frames), top)
        mesh = sheet(MM * points, faces)
        x, y, _ = frames[spring.body].tolist()
        turn = 0.0 if spring.on is None else float(frames[spring.on][2])
        found.append(Placed(_name(spring), [Piece(STRIP, mesh, BLUED.line, True)], (x, y), turn))
    return found


def bends(scene: Scene, tracks: Sequence[Track], ribbons: Sequence[Placed]) -> tuple[list[Track], list[Bend]]:
    """How the ribbons move with their carriers, and bend, by the tracks of the balances."""
    own, springs = {track.name: track for track in tracks}, {_name(spring): spring for spring in hairsprings(scene)}
    moved, bent = [], []
    for ribbon in ribbons:
        spring = springs[ribbon.name]
        track = own[spring.body]
        base = np.zeros(len(track.t)) if spring.on is None else np.interp(track.t, own[spring.on].t, own[spring.on].angles)
        if spring.on is not None:
            moved.append(Track(ribbon.name, track.t, track.places, base))
        turned = track.angles - base - spring.rest
        knots = np.linspace(turned.min(), turned.max(), 2 + int(float(np.ptp(turned)) / SHAPES))
        # Between two keys the angle goes evenly: keys where it passes a shape make every share a straight line.
        passing = [
            t0 + (t1 - t0) * (knot - a) / (b - a)
            for t0, t1, a, b in zip(track.t, track.t[1:], turned, turned[1:], strict=False)
            for knot in knots[(knots > min(a, b)) & (knots < max(a, b))]
        ]
        t = np.union1d(track.t, passing)
        t = t[np.concatenate(([True], np.diff(t.astype(np.float32)) > 0.0))]
        angle = np.interp(t, track.t, turned)
        height = float(ribbon.pieces[0].mesh.bounds[0][2]) / MM
        drawn = np.asarray(ribbon.pieces[0].mesh.vertices) / MM
        shapes = np.stack([drawn, *(_ribbon(spring, knot, height, lifted=False)[0] for knot in knots)])
        shares = np.maximum(0.0, 1.0 - np.abs(angle[:, None] - knots) / (knots[1] - knots[0]))
        bent.append(Bend(f"{ribbon.name}.{STRIP}", t, shapes, np.column_stack((1.0 - shares.sum(axis=1), shares))))
    return moved, bent


def _ribbon(spring: Hairspring, turned: float, height: float, lifted: bool = True) -> tuple[Array, NDArray[np.int64]]:
    """Vertices (2 n, 3), m, in the frame that holds the stud, from `height` or a little above it, and faces to both sides."""
    line = spring.coil.line(turned, RIBBON)
    high = max(STANDS * spring.coil.width, HIGH * spring.coil.outer)
    bottom = height + (0.5 * high if lifted else 0.0)
    points = np.concatenate([np.column_stack((line, np.full(len(line), z))) for z in (bottom, bottom + high)])
    k, n = np.arange(len(line) - 1), len(line)
    one = np.concatenate((np.column_stack((k, k + 1, k + n)), np.column_stack((k + 1, k + n + 1, k + n))))
    return points, np.concatenate((one, one[:, ::-1]))


def _name(spring: Hairspring) -> str:
    return f"hairspring of {spring.body}"


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
