"""Which records does a DXF file hold, where do they begin, and what is said first of a drawing?"""

from __future__ import annotations

from collections.abc import Callable

import dxf_text as d
import pytest

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.dxf_records import DxfError, Record, as_number, decoded, read_tags
from watchsim.drawing.findings import named_length
from watchsim.drawing.read import SMALLEST, smallness, units_missing
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Arc, Line

WHOLE = "0\nSECTION\n2\nENTITIES\n0\nline\n8\nA\n5\n4f\n0\nENDSEC\n0\nEOF\n"


@pytest.mark.parametrize("ends", ["\n", "\r\n", "\r"])
def test_records_begin_with_group_0_and_know_their_line(ends: str) -> None:
    tags = read_tags(WHOLE.replace("\n", ends).encode())
    assert [(one.kind, one.place) for one in tags.records] == [("SECTION", "line 1"), ("LINE", "line 5"), ("ENDSEC", "line 11")]
    assert list(tags.records[1].codes) == [8, 5] and list(tags.records[1].values) == ["A", "4f"]
    assert tags.records[1].name == "LINE #4F" and tags.records[0].name == "SECTION (line 1)"
    assert (tags.fault, tags.trash, tags.beyond) == ("", False, ())


def test_what_follows_the_end_is_told() -> None:
    more = read_tags((WHOLE + "0\ncircle\n8\nA\n0\nLINE\n").encode())
    assert more.trash and more.beyond == ("CIRCLE", "LINE") and len(more.records) == 3
    garbage = read_tags((WHOLE + "what\never\n").encode())
    assert garbage.trash and not garbage.fault


def test_a_file_that_is_cut_short_loses_its_last_record_only() -> None:
    for text, kinds in (
        (WHOLE[: WHOLE.index("0\nENDSEC")], ["SECTION"]),
        (WHOLE[: WHOLE.index("0\nEOF")], ["SECTION", "LINE", "ENDSEC"]),
    ):
        tags = read_tags(text.encode())
        assert [one.kind for one in tags.records] == kinds and "without EOF" in tags.fault
    broken = read_tags(WHOLE.replace("\n5\n", "\nfive\n").encode())
    assert broken.fault == 'line 9 reads "five" where a group code belongs' and [one.kind for one in broken.records] == [
        "SECTION"
    ]


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b" \n", "empty"),
        (b"AC1032\x00\x01", "DWG"),
        (b"solid\nfacet\n", 'begins with "solid"'),
        (b"8\nA\n", "holds no record"),
        (b"\x07\x00%PDF\n1\n", 'begins with "??%PDF"'),
    ],
)
def test_what_is_no_dxf_file_is_refused(data: bytes, why: str) -> None:
    with pytest.raises(DxfError, match=why.replace("?", r"\?")):
        read_tags(data)


@pytest.mark.parametrize(
    ("page", "data"),
    [
        ("ANSI_1251", "Ж".encode("cp1251")),
        ("dos850", "ø".encode("cp850")),
        ("ANSI_9999", "é".encode("latin-1")),
        ("", "€".encode("cp1252")),
    ],
)
def test_old_files_are_read_in_their_code_page(page: str, data: bytes) -> None:
    head = f"9\n$DWGCODEPAGE\n3\n{page}\n" if page else ""
    text = f"0\nSECTION\n{head}0\nLINE\n8\n".encode() + data + b"\n0\nENDSEC\n0\nEOF\n"
    expected = {"ANSI_1251": "Ж", "dos850": "ø", "ANSI_9999": "é", "": "€"}[page]
    assert read_tags(text).records[1].text(8) == expected
    assert read_tags("\ufeff".encode() + WHOLE.replace("A", "µ").encode()).records[1].text(8) == "µ"


def test_values_are_numbers_of_sensible_size() -> None:
    assert as_number(" 1.5 ", 10) == 1.5 and as_number("-1e11", 10) == -1e11 and as_number(1e11, 10) == 1e11
    for wrong in ("1.1e11", "-1.1e11", "nan", "inf", "x", None, ""):
        with pytest.raises(DxfError, match="group 10"):
            as_number(wrong, 10)
    record = Record("X", [70, 40, 40, 10, 20, 71], ["3", "1", "2", "5", "6", "2.5"], "line 1")
    assert (
        record.integer(70) == 3 and record.integer(99) == 0 and record.integer(99, 4) == 4 and record.numbers(40) == [1.0, 2.0]
    )
    assert (
        record.point(10) == (5.0, 6.0, 0.0)
        and record.point(11, (1.0, 2.0, 3.0)) == (1.0, 2.0, 3.0)
        and record.number(41, 7.0) == 7.0
    )
    for fault in (lambda: record.integer(71), lambda: record.number(40), lambda: record.number(41), lambda: record.point(20)):
        with pytest.raises(DxfError):
            fault()
    assert decoded(r" \U+00B5m ") == "µm" and decoded(r"a\b") == r"a\b"


@pytest.mark.parametrize(
    ("name", "usual", "metres"),
    [
        ("mm", "mm", 1e-3),
        (" inch ", "inch", 0.0254),
        ("µm", "µm", 1e-6),
        ("cm", "cm", 1e-2),
        ("US survey ft", "US survey ft", 1200 / 3937),
    ],
)
def test_units_are_known_by_name(name: str, usual: str, metres: float) -> None:
    assert named_length(name) == (usual, pytest.approx(metres, rel=1e-15))
    for wrong in ("kg", "furlong", ""):
        with pytest.raises(ValueError, match="Write"):
            named_length(wrong)


@pytest.mark.parametrize(("share", "told"), [(0.9, True), (1.1, False)])
def test_a_drawing_of_the_size_of_a_point_is_told(share: float, told: bool) -> None:
    size = share * SMALLEST * 1e-6
    for loop in (
        Loop((Line(1.0, 2.0, 1.0 + size, 2.0),)),
        Loop((Line(0.0, 0.0, 0.0, size),)),
        Loop((Arc(0.0, 0.0, 0.5 * size, 0.0, TURN),)),
    ):
        found = smallness((loop,), 1e-6)
        assert [finding.code for finding in found] == ["tiny"] * told
        assert all(f"{1e6 * size:.3g} µm across" in finding.message and "within 1 µm" in finding.message for finding in found)
    assert smallness((), 1e-6) == []


def test_missing_units_are_said_first_with_both_sizes(read_bytes: Callable[..., Drawing]) -> None:
    finding = units_missing((Loop((Line(-1e-3, 0.0, 3e-3, 1e-3),)), Loop((Line(0.0, 0.0, 0.0, -9e-3),))))
    assert finding.severity == "error" and "would be 10 mm or 254 mm across" in finding.message
    entities = d.record("CIRCLE", (10, "1"), (20, "2"), (40, "-3")) + d.line((0, 0), (0, 0))
    assert read_bytes(d.dxf(entities, units=None)).findings[0].code == "units-missing"
    assert read_bytes(d.dxf(d.record("TEXT", (1, "x")))).findings[0].code == "empty"
