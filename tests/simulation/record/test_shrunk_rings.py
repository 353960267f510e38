"""Do rings shrink, and open faces move, by the depth that is asked for? Against shapely's mitred buffers."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from watchsim.simulation.record.layer_outlines import Outlines


def outlines(points: np.ndarray, hole: bool = False, closed: bool = True) -> Outlines:
    rings, faces = (((points, hole),), ()) if closed else ((), (points,))
    return Outlines(rings, faces, (0.0, 0.0), 1.0, 1.0)


def ring(seed: int, count: int = 9) -> np.ndarray:
    """A closed, star-shaped, counter-clockwise chain with corners either way, one of them flat."""
    rng = np.random.default_rng(seed)
    angle = (np.arange(count) + rng.uniform(0.2, 0.8, count)) * 2.0 * np.pi / count
    points = np.column_stack([np.cos(angle), np.sin(angle)]) * rng.uniform(0.8, 1.2, count)[:, None]
    points[4] = 0.5 * (points[3] + points[5])
    return np.concatenate([points, points[:1]])


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("depth", [1e-3, 0.02])
def test_a_ring_lies_that_far_inside_its_material_with_sharp_corners(seed: int, depth: float) -> None:
    points = ring(seed)
    ((shrunk, hole),) = outlines(points).shrunk_rings(depth)
    expected = shapely.Polygon(points).buffer(-depth, join_style="mitre", mitre_limit=100.0)
    assert not hole and len(shrunk) == len(points)
    assert shapely.Polygon(shrunk).symmetric_difference(expected).area < 1e-12


def test_a_hole_grows() -> None:
    points = ring(3)[::-1]
    ((grown, hole),) = outlines(points, hole=True).shrunk_rings(0.01)
    expected = shapely.Polygon(points).buffer(0.01, join_style="mitre", mitre_limit=100.0)
    assert hole and shapely.Polygon(grown).symmetric_difference(expected).area < 1e-12


def test_an_open_face_moves_to_its_left_and_keeps_its_ends_square() -> None:
    face = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [3.0, 1.0]])
    (moved,) = outlines(face, closed=False).shifted_faces(0.1)
    assert moved == pytest.approx(np.array([[0.0, 0.1], [0.9, 0.1], [0.9, 1.1], [3.0, 1.1]]))


def test_where_an_outline_turns_back_its_corner_stays_near() -> None:
    """It would lie nowhere: a hundred depths away at most."""
    face = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1e-9]])
    (moved,) = outlines(face, closed=False).shifted_faces(1e-3)
    assert np.isfinite(moved).all() and np.abs(moved[1] - face[1]).max() <= 0.1
