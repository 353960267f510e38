"""What do the solids of a scene look like?

    python scripts/reports/draw_solids.py SCENE PICTURE

A small renderer for the pictures of the documents: every triangle is filled point by point, and the nearest one wins.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
from numpy.typing import NDArray

import watchsim as ws
from watchsim.geometry.solids.meshes import Placed
from watchsim.render.palette import BACKGROUND
from watchsim.render.placed_solids import placed_solids
from watchsim.scene.layer_heights import slabs

Array = NDArray[np.float64]

SIZE = (1280, 860)
FINE = 3  # points per pixel and direction, averaged at the end
TURN, TILT = math.radians(-28.0), math.radians(52.0)  # of the view, about the upright and from above
LIGHT = np.array([-0.45, 0.5, 0.74]) / np.linalg.norm([-0.45, 0.5, 0.74])
THICKNESS, DEVIATION = 0.2e-3, 0.2e-6


def triangles(bodies: list[Placed]) -> tuple[Array, Array]:
    """All triangles (n, 3, 3), mm, as seen: x right, y up, z toward the eye; and their colours (n, 3), 0 to 1."""
    corners, colours = [], []
    view = _view()
    for body in bodies:
        c, s = math.cos(body.angle), math.sin(body.angle)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        place = np.array([1e3 * body.position[0], 1e3 * body.position[1], 0.0])
        for piece in body.pieces:
            found = (piece.mesh.triangles @ turn.T + place) @ view.T
            normals = np.asarray(piece.mesh.face_normals) @ turn.T @ view.T
            base = np.array([int(piece.colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
            shade = 0.42 + 0.58 * np.clip(normals @ LIGHT, 0.0, 1.0)
            gloss = piece.metallic * 0.5 * np.clip(normals @ LIGHT, 0.0, 1.0) ** 12
            corners.append(found)
            colours.append(np.clip(shade[:, None] * base + gloss[:, None], 0.0, 1.0))
    return np.concatenate(corners), np.concatenate(colours)


def _view() -> Array:
    c, s = math.cos(TURN), math.sin(TURN)
    around = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    c, s = math.cos(TILT), math.sin(TILT)
    return np.array([[1.0, 0.0, 0.0], [0.0, s, c], [0.0, -c, s]]) @ around


def painted(corners: Array, colours: Array) -> NDArray[np.uint8]:
    """The picture (height, width, 3), everything in view."""
    width, height = FINE * SIZE[0], FINE * SIZE[1]
    low, high = corners.reshape(-1, 3).min(axis=0), corners.reshape(-1, 3).max(axis=0)
    scale = 0.92 * min(width / (high[0] - low[0]), height / (high[1] - low[1]))
    middle = 0.5 * (low + high)
    x = 0.5 * width + scale * (corners[:, :, 0] - middle[0])
    y = 0.5 * height - scale * (corners[:, :, 1] - middle[1])
    picture = np.empty((height, width, 3))
    picture[:] = [int(BACKGROUND[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    depth = np.full((height, width), -np.inf)
    for px, py, pz, colour in zip(x, y, corners[:, :, 2], colours, strict=True):
        _fill(picture, depth, (px, py, pz), colour)
    fine = picture.reshape(SIZE[1], FINE, SIZE[0], FINE, 3).mean(axis=(1, 3))
    return np.round(255.0 * fine).astype(np.uint8)


def _fill(picture: Array, depth: Array, corner: tuple[Array, Array, Array], colour: Array) -> None:
    """One triangle, where it is nearer than what is there."""
    (x, y, z) = corner
    doubled = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
    left, right = math.floor(x.min()), math.ceil(x.max()) + 1
    top, bottom = math.floor(y.min()), math.ceil(y.max()) + 1
    if doubled == 0.0:
        return
    gx, gy = np.meshgrid(np.arange(left, right) + 0.5, np.arange(top, bottom) + 0.5)
    b = ((gx - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (gy - y[0])) / doubled
    c = ((x[1] - x[0]) * (gy - y[0]) - (gx - x[0]) * (y[1] - y[0])) / doubled
    here = z[0] + b * (z[1] - z[0]) + c * (z[2] - z[0])
    window = (slice(top, bottom), slice(left, right))
    seen = (b >= 0.0) & (c >= 0.0) & (b + c <= 1.0) & (here > depth[window])
    depth[window][seen] = here[seen]
    picture[window][seen] = colour


def draw(scene_file: Path, picture: Path) -> None:
    """Write the picture of a scene's solids at its start."""
    scene = ws.load(scene_file)
    picture.parent.mkdir(parents=True, exist_ok=True)
    imageio.imwrite(picture, painted(*triangles(placed_solids(scene, slabs(scene, THICKNESS), DEVIATION))))


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    given = arguments(__doc__, scene=(..., "a scene file"), picture=(..., "the PNG to write"))
    draw(Path(given.scene), Path(given.picture))
