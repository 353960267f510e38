"""What does a scene look like in three dimensions?"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.geometry.primitives import TURN
from watchsim.geometry.solids.meshes import Piece, Placed, laid, plate, revolved, turned_about, united
from watchsim.render.palette import BLUED, BRASS, GILT, PLATE, RUBY, STEEL, Finish, finish, looks
from watchsim.scene.body import Body
from watchsim.scene.carriers import at_start
from watchsim.scene.layer_heights import Slab
from watchsim.scene.scene import Scene
from watchsim.scene.solid import HAIRSPRING, LYING, UPRIGHT

METAL, STONE = 0.55, 0.05  # how metallic the parts look
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
                pieces.append(Piece("+".join(slab.layer for slab in layers), mesh, PLATE.fill, METAL))
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
    metallic = STONE if look is RUBY else METAL
    if solid is not None and solid.kind in (UPRIGHT, LYING):
        mesh = revolved(solid.upright_profile(), deviation)
        if mesh is None:
            return
        if solid.kind == UPRIGHT:
            middle = 0.5 * float(mesh.bounds[0][2] + mesh.bounds[1][2])
            mesh.apply_translation((1e3 * solid.pivot[0], 1e3 * solid.pivot[1], 1e3 * slab.middle - middle))
            yield Piece(slab.layer, mesh, look.fill, metallic)
            return
        lying = laid(mesh, *solid.axis, slab.middle)
        for k in range(solid.count):
            yield Piece(slab.layer, turned_about(lying, solid.pivot, TURN * k / solid.count), look.fill, metallic)
        return
    mesh = plate(slab.loops, slab.middle - 0.5 * slab.thickness, slab.thickness, deviation)
    if mesh is not None:
        yield Piece(slab.layer, mesh, look.fill, metallic)


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
        apart.append(Piece(name, piece.mesh, piece.colour, piece.metallic))
    return apart
