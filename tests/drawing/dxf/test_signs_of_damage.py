"""What does a record give away of another one that was lost, and which runs did a block draw?"""

from __future__ import annotations

from collections.abc import Callable

import dxf_text as d
import pytest

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.dxf import odd_copies, odd_radius, read_dxf, strange_groups, swallowed
from watchsim.drawing.dxf_records import Record

Tag = tuple[int, object]


def record(kind: str, *tags: Tag) -> Record:
    return Record(kind, [code for code, _ in tags], [value for _, value in tags], "line 7")


ATTRIBUTE, LINE = record("ATTRIB"), record("LINE")


@pytest.mark.parametrize(
    ("first", "following", "code"),
    [
        (record("INSERT", (66, 1)), ATTRIBUTE, None),
        (record("INSERT", (66, 1)), LINE, "strange-group"),
        (record("INSERT", (66, 1)), None, "strange-group"),
        (record("INSERT", (66, 0)), LINE, None),
        (record("INSERT", (66, "")), None, None),
        (record("INSERT"), LINE, None),
        (record("POLYLINE", (66, 1)), LINE, None),
        (record("TEXT", (8, "A"), (8, "B")), LINE, "damaged"),
        (record("TEXT", (8, "A")), LINE, None),
        (record("LINE", (8, "A"), (8, "B")), LINE, None),
        (record("SEQEND", (8, "A"), (10, 1.0)), LINE, "strange-group"),
        (record("SEQEND", (8, "A"), (-2, 1)), LINE, None),
    ],
)
def test_what_announces_another_record_or_names_two_layers_has_lost_one(
    first: Record, following: Record | None, code: str | None
) -> None:
    assert [finding.code for finding in swallowed(first, following, "L")] == ([code] if code else [])


def test_groups_that_do_not_belong_there_are_named_up_to_six() -> None:
    assert strange_groups(record("LINE", (10, 0), (20, 0), (8, "A")), "L") == []
    (finding,) = strange_groups(record("LINE", *((code, 0) for code in (49, 47, 46, 45, 44, 43, 42))), "L")
    assert "(42, 43, 44, 45, 46, 47)" in finding.message and (finding.layer, finding.severity) == ("L", "warning")


@pytest.mark.parametrize(
    ("columns", "rows", "odd"), [(1, 1, ""), (3, 2, ""), (0, 1, "0 columns (group 70)"), (1, -2, "-2 rows (group 71)")]
)
def test_copies_in_no_row_are_told(columns: int, rows: int, odd: str) -> None:
    found = odd_copies(record("INSERT", (70, columns), (71, rows)), "L")
    assert len(found) == bool(odd) and all(odd in finding.message for finding in found)
    assert odd_copies(record("INSERT"), "L") == [] and len(odd_copies(record("INSERT", (70, 0), (71, 0)), "L")) == 2


def test_radii_below_zero_are_told() -> None:
    for kind, radius, count in (
        ("CIRCLE", -2.0, 1),
        ("ARC", -1e-4, 1),
        ("ARC", 0.0, 0),
        ("CIRCLE", 5e-4, 0),
        ("ELLIPSE", -1.0, 0),
    ):
        assert len(odd_radius(record(kind, (40, radius)), "L")) == count


def test_signs_of_damage_are_found_in_files_record_by_record(read_bytes: Callable[..., Drawing]) -> None:
    text = d.record("TEXT", (8, "B"), (1, "x"))
    insert = d.insert("B", (0, 0), (66, 1)) + d.record("ATTRIB") + d.record("SEQEND") + d.insert("B", (9, 9), (66, 1))
    drawing = read_bytes(d.dxf(text + insert + d.circle(0, 0, 5), blocks=d.block("B", d.circle(0, 0, 1))))
    assert [finding.code for finding in drawing.findings if finding.code in ("damaged", "strange-group")] == [
        "damaged",
        "strange-group",
    ]


def test_the_runs_of_each_block_are_known() -> None:
    """One run for each entity, in the order of the file; blocks within blocks belong to the outer one."""
    blocks = d.block("INNER", d.circle(0, 0, 1)) + d.block(
        "B", d.circle(0, 0, 2) + d.line((0, 0), (1, 1)) + d.insert("INNER", (5, 0))
    )
    content = read_dxf(
        d.dxf(d.circle(0, 0, 9) + d.insert("B", (20, 0)) + d.line((0, 0), (3, 3)) + d.insert("INNER", (40, 0)), blocks=blocks),
        None,
        1e-6,
    )
    runs = [stroke.run for stroke in content.strokes]
    assert [(one.block, one.last - one.first + 1) for one in content.inserted] == [("B", 3), ("INNER", 1)]
    (outer, inner), numbers = content.inserted, sorted(set(runs))
    assert [runs.index(outer.first), runs.index(outer.last), runs.index(inner.first)] == [1, 3, 5]
    assert len(numbers) == 6 and outer.last < runs[4] < inner.first == inner.last
