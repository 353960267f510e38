"""Does the reader say of everything that it left out how much of it there was, whether it matters, and why?"""

from collections.abc import Callable

import dxf_text as d
import pytest
import svg_text as s

from watchsim.drawing.drawing import Drawing

Reader = Callable[..., Drawing]
NO_OUTLINE, MOVES = "it is not an outline", "it moves"
DAMAGED = "here; the file may be damaged"
DRAW_IT = "Draw it with lines and arcs where it matters."


def ignored(drawing: Drawing) -> list[tuple[str, str, str]]:
    return [(one.severity, one.message, one.fix) for one in drawing.findings if one.code == "ignored"]


@pytest.mark.parametrize(
    ("kinds", "severity", "why", "fix"),
    [
        (
            "TEXT MTEXT ATTDEF DIMENSION ARC_DIMENSION TOLERANCE LEADER MULTILEADER VIEWPORT HATCH IMAGE WIPEOUT ACAD_TABLE",
            *("notice", f": {NO_OUTLINE}", ""),
        ),
        (
            "3DFACE SOLID TRACE MLINE REGION 3DSOLID MESH RAY XLINE SHAPE SURFACE HELIX ACAD_PROXY_ENTITY",
            "warning",
            "",
            DRAW_IT,
        ),
        (f"LIME {'X' * 60}", "warning", f": no type of entity known {DAMAGED}", ""),
    ],
)
def test_entities_of_a_dxf_file(kinds: str, severity: str, why: str, fix: str, read_bytes: Reader) -> None:
    """A name of more than forty letters is cut."""
    for kind in kinds.split():
        drawing = read_bytes(d.dxf(d.circle(0, 0, 1) + 3 * d.record(kind, *d.point(10, (0, 0)))))
        assert ignored(drawing) == [(severity, f"3 × {kind[:40]} not read{why}", fix)]
        assert drawing.ignored == {kind: 3} and len(drawing.loops) == 1


@pytest.mark.parametrize(
    ("kinds", "severity", "why"),
    [
        ("text image", "notice", NO_OUTLINE),
        ("animateMotion animateTransform", "warning", MOVES),
        (f"crcle {'x' * 60}", "warning", f"no element known {DAMAGED}"),
    ],
)
def test_elements_of_an_svg_file(kinds: str, severity: str, why: str, read_svg: Reader) -> None:
    for kind in kinds.split():
        drawing = read_svg(s.svg('<circle r="1"/>' + 2 * f"<{kind}/>"))
        assert ignored(drawing) == [(severity, f"2 × {kind[:40]} not read: {why}", "")]
        assert drawing.ignored == {kind: 2} and len(drawing.loops) == 1


@pytest.mark.parametrize(("x", "left_out"), [("5%", 1), ("0%", 0), ("5", 0)])
def test_a_part_of_a_page_without_a_size_is_no_length(x: str, left_out: int, read_svg: Reader) -> None:
    """Nothing of it is still nothing."""
    drawing = read_svg(s.svg(f'<circle cy="3" r="2"/><circle cx="{x}" cy="9" r="1"/>', ""))
    said = [one.message for one in drawing.findings if one.code == "damaged"]
    assert len(said) == left_out and len(drawing.loops) == 2 - left_out
    assert all(f'"{x}" is a part of a page whose size is not given' in one for one in said)
