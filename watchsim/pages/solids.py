"""What does the page need to show a mechanism in space? Triangles of each body, packed as the graphics card takes them."""

from __future__ import annotations

import base64
from collections.abc import Iterable
from typing import Any

import numpy as np

from watchsim.geometry.meshes import MM, Piece, triangles
from watchsim.render.keyframes import placed_solids
from watchsim.scene.layer_heights import slabs
from watchsim.scene.scene import Scene
from watchsim.scene.solids import HAIRSPRING

THICKNESS = 0.2e-3  # m, of layers whose solids say none, as in `watchsim export`
CHORD = 2e-4  # of the picture: what chords may be off, at first
COARSER = 4.0  # from one try to the next
MOST_VERTICES = 24_000  # 10 bytes each, and as much again for the triangles
CREASE = np.radians(30.0)  # sharper edges stay sharp
SHORT, BYTE = 32767, 127  # the largest values of what the card reads as -1 to 1


def packed_solids(scene: Scene, size: float) -> dict[str, Any] | None:
    """Solids of every body in its own frame, for a picture `size` metres wide; None where nothing has a volume.

    Places come as shares of `scale` (m) from the middle, normals as shares of 127. The page itself bends the hairspring.
    """
    stacked = tuple(s for s in slabs(scene, THICKNESS) if s.thickness > 0.0 and (s.solid is None or s.solid.kind != HAIRSPRING))
    deviation = CHORD * size
    bodies = placed_solids(scene, stacked, deviation)
    while sum(len(piece.mesh.vertices) for body in bodies for piece in body.pieces) > MOST_VERTICES and deviation < 0.1 * size:
        deviation *= COARSER
        bodies = placed_solids(scene, stacked, deviation)
    if not bodies:
        return None
    names = [body.name for body in scene.bodies]
    heights = np.concatenate([piece.mesh.bounds[:, 2] for body in bodies for piece in body.pieces]) / MM
    middle = 0.5 * float(heights.min() + heights.max())
    found = [
        {"body": names.index(body.name), "fill": fill, "metal": metal, **_packed(pieces, middle)}
        for body in bodies
        for (fill, metal), pieces in _by_look(body.pieces).items()
    ]
    return {"pieces": found, "top": float(heights.max()) - middle}


def _by_look(pieces: Iterable[Piece]) -> dict[tuple[str, bool], list[Piece]]:
    looks: dict[tuple[str, bool], list[Piece]] = {}
    for piece in pieces:
        looks.setdefault((piece.colour, piece.metal), []).append(piece)
    return looks


def _packed(pieces: Iterable[Piece], middle: float) -> dict[str, Any]:
    """Vertices, normals and triangles, heights from `middle` (m)."""
    points, normals, faces = triangles(pieces, CREASE)
    points = points - (0.0, 0.0, middle)
    scale = float(np.abs(points).max()) or 1.0
    kind = "<u2" if len(points) <= 2 * SHORT else "<u4"
    return {
        "scale": scale,
        "points": _text(np.round(SHORT * points / scale).astype("<i2")),
        "normals": _text(np.round(BYTE * normals).astype("i1")),
        "faces": _text(faces.astype(kind)),
        "wide": kind == "<u4",
    }


def _text(values: np.ndarray) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode("ascii")
