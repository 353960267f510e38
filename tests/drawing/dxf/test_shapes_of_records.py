"""Which shapes does each record draw, group by group, and where do copies of blocks lie?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.drawing.dxf import READERS, heavyweight, insert, is_mesh, points_of, traced
from watchsim.drawing.dxf_records import DxfError, Record
from watchsim.drawing.projection import IDENTITY, Conic, Dot, Shape, Spline, Straight
from watchsim.geometry.primitives import TURN

Tag = tuple[int, object]
DOWN: list[Tag] = [(210, 0), (220, 0), (230, -1)]


def record(kind: str, *tags: Tag) -> Record:
    return Record(kind, [code for code, _ in tags], [value for _, value in tags], "line 1")


def drawn(kind: str, *tags: Tag) -> list[Shape]:
    return READERS[kind](record(kind, *tags))


def at(code: int, x: float, y: float, z: float | None = None) -> list[Tag]:
    return [(code, x), (code + 10, y), *([] if z is None else [(code + 20, z)])]


def oval(shape: Shape, share: float) -> np.ndarray:
    assert isinstance(shape, Conic)
    t = shape.start + share * shape.sweep
    return np.array(shape.centre) + math.cos(t) * np.array(shape.u) + math.sin(t) * np.array(shape.v)


def test_lines_and_points() -> None:
    assert drawn("LINE", *at(10, 1, 2, 3), *at(11, 4, 5)) == [Straight((1.0, 2.0, 3.0), (4.0, 5.0, 0.0))]
    assert drawn("POINT", *at(10, 1, 2, 3)) == [Dot((1.0, 2.0, 3.0))]


@pytest.mark.parametrize(
    ("start", "end", "sweep"), [(10, 50, 40), (350, 20, 30), (20, 20, 360), (0, 360, 360), (90, 0, 270), (-30, 30, 60)]
)
def test_arcs_run_counter_clockwise_from_start_to_end(start: float, end: float, sweep: float) -> None:
    (shape,) = drawn("ARC", *at(10, 1, 2, 3), (40, 5), (50, start), (51, end))
    assert isinstance(shape, Conic) and math.degrees(shape.sweep) == pytest.approx(sweep)
    for share, degrees in ((0.0, start), (0.5, start + sweep / 2), (1.0, start + sweep)):
        t = math.radians(degrees)
        assert oval(shape, share) == pytest.approx([1.0 + 5.0 * math.cos(t), 2.0 + 5.0 * math.sin(t), 3.0])
    (mirrored,) = drawn("ARC", *at(10, 1, 2, 3), (40, 5), (50, start), (51, end), *DOWN)
    assert oval(mirrored, 0.5) == pytest.approx(oval(shape, 0.5) * [-1.0, 1.0, -1.0])


def test_circles_lie_in_their_plane() -> None:
    for radius in (5.0, -5.0, 0.0):
        (shape,) = drawn("CIRCLE", *at(10, 1, 2, 3), (40, radius))
        assert shape == Conic((1.0, 2.0, 3.0), (abs(radius), 0.0, 0.0), (0.0, abs(radius), 0.0), 0.0, TURN)
    (tilted,) = drawn("CIRCLE", *at(10, 0, 0, 2), (40, 1), (210, 0.6), (220, 0.0), (230, 0.8))
    for share in (0.0, 0.2, 0.7):
        assert oval(tilted, share) @ [0.6, 0.0, 0.8] == pytest.approx(2.0)
        assert np.linalg.norm(oval(tilted, share) - 2.0 * np.array([0.6, 0.0, 0.8])) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("start", "end", "sweep"),
    [
        (0.0, TURN, TURN),
        (0.0, 0.9e-9, TURN),
        (0.0, 1.1e-9, 1.1e-9),
        (0.0, -0.9e-9, TURN),
        (1.0, 3.0, 2.0),
        (3.0, 1.0, TURN - 2.0),
        (-1.0, 1.0, 2.0),
    ],
)
def test_ellipses_run_from_parameter_to_parameter(start: float, end: float, sweep: float) -> None:
    """The minor axis lies a quarter turn ahead of the major one about the normal."""
    for normal, side in (((0, 0, 1), 1.0), ((0, 0, -3), -1.0)):
        (shape,) = drawn("ELLIPSE", *at(10, 1, 2, 3), *at(11, 3, 4, 0), (40, 0.5), (41, start), (42, end), *at(210, *normal))
        assert isinstance(shape, Conic) and (shape.centre, shape.u) == ((1.0, 2.0, 3.0), (3.0, 4.0, 0.0))
        assert shape.v == pytest.approx((-2.0 * side, 1.5 * side, 0.0)) and (shape.start, shape.sweep) == pytest.approx(
            (start, sweep)
        )
    (upright,) = drawn("ELLIPSE", *at(10, 0, 0), *at(11, 0, 0, 2), (40, 0.5), *at(210, 1, 0, 0))
    assert isinstance(upright, Conic) and upright.v == pytest.approx((0.0, -1.0, 0.0)) and upright.sweep == TURN
    for ratio, major in ((0.0, (1, 0, 0)), (0.5, (0, 0, 0))):
        with pytest.raises(DxfError, match="no length"):
            drawn("ELLIPSE", *at(10, 0, 0), *at(11, *major), (40, ratio))
    assert drawn("ELLIPSE", *at(10, 0, 0), *at(11, 1, 0), (40, 5e-4))


CORNERS = [(90, 3), (38, 7.0), *at(10, 1, 2), *at(10, 4, 2), (42, 1.0), *at(10, 4, 6)]


@pytest.mark.parametrize(("flags", "closed"), [(0, False), (1, True), (128, False), (129, True)])
def test_a_lightweight_polyline_has_its_height_and_its_bulges(flags: int, closed: bool) -> None:
    shapes = drawn("LWPOLYLINE", (70, flags), *CORNERS)
    assert len(shapes) == 2 + closed and shapes[0] == Straight((1.0, 2.0, 7.0), (4.0, 2.0, 7.0))
    assert oval(shapes[1], 0.5) == pytest.approx([6.0, 4.0, 7.0]) and oval(shapes[1], 1.0) == pytest.approx([4.0, 6.0, 7.0])
    assert shapes[2:] == [Straight((4.0, 6.0, 7.0), (1.0, 2.0, 7.0))] * closed
    below = drawn("LWPOLYLINE", (70, flags), *CORNERS, *DOWN)
    assert below[0] == Straight((-1.0, 2.0, -7.0), (-4.0, 2.0, -7.0))


@pytest.mark.parametrize(
    "tags",
    [
        *([(20, 1.0)], [(10, 1.0)], [*at(10, 1, 2), (20, 3.0)], [(42, 1.0), *at(10, 1, 2)], [*at(10, 1, 2), (42, 1), (42, 1)]),
        *([(10, 1.0), (42, 1.0), (20, 1.0)], [(90, 2), *at(10, 1, 2)], [], [(10, 1.0), (10, 2.0), (20, 1.0)]),
    ],
)
def test_a_lightweight_polyline_whose_groups_do_not_match_is_refused(tags: list[Tag]) -> None:
    with pytest.raises(DxfError):
        drawn("LWPOLYLINE", *tags)


def vertices(*flags: int) -> list[Record]:
    return [record("VERTEX", *at(10, 2.0 * k, k * k, 5.0), (70, flag), (42, 0.5)) for k, flag in enumerate(flags)]


def test_an_old_polyline_lies_flat_or_runs_through_space() -> None:
    flat = heavyweight(record("POLYLINE", (70, 0), *at(10, 0, 0, 7)), vertices(0, 0, 0))
    assert len(flat) == 2 and all(isinstance(shape, Conic) and shape.centre[2] == 7.0 for shape in flat)
    space = heavyweight(record("POLYLINE", (70, 8), *at(10, 0, 0, 7), *DOWN), vertices(32, 32, 32))
    assert space == [Straight((0.0, 0.0, 5.0), (2.0, 1.0, 5.0)), Straight((2.0, 1.0, 5.0), (4.0, 4.0, 5.0))]
    assert (
        len(heavyweight(record("POLYLINE", (70, 9)), vertices(32, 32, 32)))
        == len(heavyweight(record("POLYLINE", (70, 1)), vertices(0, 0, 0)))
        == 3
    )
    turned = heavyweight(record("POLYLINE", (70, 0), *DOWN), vertices(0, 0))
    assert oval(turned[0], 0.0) == pytest.approx([0.0, 0.0, 0.0]) and oval(turned[0], 1.0) == pytest.approx([-2.0, 1.0, 0.0])


@pytest.mark.parametrize(("flags", "count"), [(4, 2), (5, 3), (0, 4), (2, 4)])
def test_the_frame_of_a_fitted_polyline_is_not_drawn(flags: int, count: int) -> None:
    """Its control points (16) are left out where the curve through them (8) follows."""
    assert len(heavyweight(record("POLYLINE", (70, flags)), vertices(16, 8, 16, 8, 8))) == count


@pytest.mark.parametrize(
    ("kind", "flags", "is_so"),
    [
        ("POLYLINE", 16, True),
        ("POLYLINE", 64, True),
        ("POLYLINE", 65, True),
        ("POLYLINE", 0, False),
        ("POLYLINE", 47, False),
        ("LWPOLYLINE", 16, False),
    ],
)
def test_meshes_are_told_by_their_flags(kind: str, flags: int, is_so: bool) -> None:
    assert is_mesh(record(kind, (70, flags))) is is_so


def test_corners_become_segments() -> None:
    a, b, c = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)
    assert traced([(a, 0.0)], False, IDENTITY) == traced([(a, 0.0)], True, IDENTITY) == [Straight(a, a)]
    assert traced([(a, 0.0), (b, 0.0)], True, IDENTITY) == traced([(a, 0.0), (b, 0.0)], False, IDENTITY) == [Straight(a, b)]
    assert len(traced([(a, 1.0), (b, 0.0)], True, IDENTITY)) == len(traced([(a, 0.0), (b, 1.0)], True, IDENTITY)) == 2
    assert len(traced([(a, 5e-4), (b, 5e-4)], True, IDENTITY)) == 2
    assert traced([(a, 0.0), (b, 0.0), (c, 0.0)], True, IDENTITY) == [Straight(a, b), Straight(b, c), Straight(c, a)]
    with pytest.raises(DxfError, match="no corners"):
        traced([], True, IDENTITY)


SPLINE: list[Tag] = [(71, 2), *[(40, k) for k in (0, 0, 0, 1, 1, 1)], *at(10, 0, 0, 5), *at(10, 1, 2, 5), *at(10, 3, 0, 5)]


def test_splines_hold_what_they_announce() -> None:
    assert drawn("SPLINE", *SPLINE) == [Spline(2, [0, 0, 0, 1, 1, 1], [(0, 0, 5), (1, 2, 5), (3, 0, 5)], [])]
    assert drawn("SPLINE", (72, 6), (73, 3), (74, 0), *SPLINE, (41, 1), (41, 2), (41, 1))[0] == Spline(
        2, [0, 0, 0, 1, 1, 1], [(0, 0, 5), (1, 2, 5), (3, 0, 5)], [1, 2, 1]
    )
    for wrong in ((72, 5), (73, 4), (74, 1)):
        with pytest.raises(DxfError, match=f"announces {wrong[1]}"):
            drawn("SPLINE", wrong, *SPLINE)
    (cubic,) = drawn("SPLINE", *at(10, 0, 0), *at(10, 1, 2), *at(10, 3, 0), *at(10, 4, 4))
    (round_one,) = drawn("SPLINE", (70, 1), *at(10, 0, 0), *at(10, 1, 2), *at(10, 3, 0), *at(10, 4, 4))
    assert isinstance(cubic, Spline) and (cubic.degree, len(cubic.points)) == (3, 4)
    assert isinstance(round_one, Spline) and len(round_one.points) == 7


def test_fit_points_with_their_tangents() -> None:
    fit: list[Tag] = [*at(11, 0, 0), *at(11, 2, 0), *at(11, 4, 0)]
    for tags, slope in (([*at(12, 1, 1), *at(13, 1, -1)], 1.0), ([*at(12, 1, 1)], 0.0), ([*at(13, 1, 1)], 0.0)):
        (shape,) = drawn("SPLINE", *fit, *tags)
        assert isinstance(shape, Spline)
        (x0, y0, _), (x1, y1, _) = shape.points[:2]
        assert (y1 - y0) / (x1 - x0) == pytest.approx(slope, abs=1e-9)


def test_points_need_all_their_coordinates() -> None:
    assert points_of(record("SPLINE", *at(10, 1, 2), *at(10, 3, 4)), 10) == [(1.0, 2.0, 0.0), (3.0, 4.0, 0.0)]
    for tags in ([(10, 1)], [*at(10, 1, 2), *at(10, 3, 4, 5)], [*at(10, 1, 2), (20, 3)]):
        with pytest.raises(DxfError, match="do not match up"):
            points_of(record("SPLINE", *tags), 10)


def test_copies_of_a_block_stand_in_rows_and_columns() -> None:
    """Steps run along the turned axes and are not scaled; the map of each copy takes the block's points to the world."""
    grid: list[Tag] = [(70, 3), (71, 2), (44, 10), (45, 20), (50, 90), (41, 2), (42, 3), (43, 4)]
    found = insert(record("INSERT", (2, "B"), *at(10, 100, 200, 5), *grid), 6)
    assert found.block == "B"
    places = [map_.point((1.0, 1.0, 1.0)) for map_ in found.maps]
    expected = [(100 - 20 * row - 3, 200 + 10 * column + 2, 9) for row in range(2) for column in range(3)]
    assert np.array(places) == pytest.approx(np.array(expected, dtype=float))
    (below,) = insert(record("INSERT", (2, "B"), *at(10, 100, 200, 5), *DOWN), 1).maps
    assert below.point((1.0, 2.0, 3.0)) == pytest.approx((-101.0, 202.0, -8.0))
    (plain,) = insert(record("INSERT", (2, "B"), *at(10, 1, 2), (70, 0), (71, -1)), 1).maps
    assert plain.point((1.0, 2.0, 3.0)) == (2.0, 4.0, 3.0)


def test_blocks_of_no_size_and_too_many_copies_are_refused() -> None:
    head: list[Tag] = [(2, "B"), *at(10, 0, 0)]
    assert len(insert(record("INSERT", *head, (70, 3), (71, 2)), 6).maps) == 6
    with pytest.raises(DxfError, match="3 × 2 copies"):
        insert(record("INSERT", *head, (70, 3), (71, 2)), 5)
    for code in (41, 42):
        with pytest.raises(DxfError, match="nothing would be left"):
            insert(record("INSERT", *head, (code, 0)), 1)
        assert insert(record("INSERT", *head, (code, 5e-4)), 1)
    assert insert(record("INSERT", *head, (43, 0)), 1)
