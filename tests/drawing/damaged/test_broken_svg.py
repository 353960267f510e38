"""Does a broken or hostile SVG file give findings, never a traceback and never a drawing with something missing in silence?"""

from __future__ import annotations

import gzip
import random
from collections.abc import Callable
from pathlib import Path

import judge_mutation
import mutate_svg
import pytest
import svg_text as s
from every_time import few

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.inspection import inspect_report, inspect_text
from watchsim.drawing.read import read
from watchsim.drawing.svg_elements import DEEPEST, MOST_UNPACKED

Reader = Callable[..., Drawing]
BOX = '<rect width="9" height="9"/>'


@pytest.mark.parametrize(
    ("data", "word"),
    [
        (b"", "empty"),
        (b"\n  \r\n", "empty"),
        (b"hello world", "syntax error"),
        (bytes(range(256)) * 20, "not well-formed"),
        (b"<svg", "unclosed token"),
        (b"<html></html>", "<html>"),
        (b"<x:svg xmlns:x='urn:x'/>", "another kind"),
        (b"<svg xmlns='urn:x'/>", "another kind"),
        (b"\x89PNG\r\n\x1a\n" + bytes(100), "not well-formed"),
        (b"\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\x00garbage", "unpacked"),
        (b"\xff\xfe<", "decoded"),
        (b"<?xml version='1.0' encoding='klingon'?><svg/>", "encoding"),
    ],
)
def test_what_is_no_svg(read_svg: Reader, data: bytes, word: str) -> None:
    drawing = read_svg(data)
    assert word in s.errors(drawing)["unreadable"]
    assert not drawing.loops
    assert inspect_report(drawing)["lines"] == 0
    assert word in inspect_text(drawing)


def test_the_content_decides_where_the_ending_lies(read_svg: Reader, read_bytes: Reader) -> None:
    lied = read_bytes(s.svg(BOX).encode())
    assert (lied.format, len(lied.loops), list(s.codes(lied))) == ("svg", 1, ["format"])
    dxf = read_svg(b"0\nSECTION\n2\nENTITIES\n0\nENDSEC\n0\nEOF\n")
    assert dxf.format == "dxf"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_encodings(read_svg: Reader, encoding: str) -> None:
    declared = {"utf-8-sig": "utf-8"}.get(encoding, encoding)
    text = f'<?xml version="1.0" encoding="{declared}"?>' + s.svg(f'<g id="Ankerräder">{BOX}</g>')
    assert read_svg(text.encode(encoding)).layers == ("Ankerräder",)


def test_packed_files(tmp_path: Path) -> None:
    path = tmp_path / "wheel.svgz"
    packed = gzip.compress(s.svg(BOX).encode())
    path.write_bytes(packed)
    drawing = read(path)
    assert (drawing.format, len(drawing.loops), drawing.findings) == ("svg", 1, ())
    path.write_bytes(packed[:-12])
    assert "truncated" in s.errors(read(path))
    path.write_bytes(gzip.compress(s.svg(" " * (MOST_UNPACKED + 1)).encode()))
    assert "unpacks into more" in s.errors(read(path))["unreadable"]


def test_truncated_files_name_the_last_whole_element(read_svg: Reader) -> None:
    whole = s.svg('<rect id="one" width="9" height="9"/>\n<circle id="two" r="3"/><path id="three" d="M1 1h3v3z"/>')
    cut = read_svg(whole[: whole.index("three") + 9])
    assert "circle #two" in s.errors(cut)["truncated"]
    assert len(cut.loops) == 2
    for length in range(1, len(whole) - 1):
        assert s.errors(read_svg(whole[:length])), f"cut after {length} characters and nothing said"


def test_what_stands_after_the_end(read_svg: Reader) -> None:
    assert s.codes(read_svg(s.svg(BOX) + "\x00\x00")).keys() == {"trailing"}
    assert "damaged" in s.errors(read_svg(s.svg(BOX) + s.svg(BOX)))


BOMB = "".join(f"<!ENTITY e{k + 1} '{f'&e{k};' * 10}'>" for k in range(9))


@pytest.mark.parametrize(
    ("doctype", "content", "word"),
    [
        (f"<!DOCTYPE svg [<!ENTITY e0 'ha'>{BOMB}]>", "<text>&e9;</text>", "made of other entities"),
        ("<!DOCTYPE svg [<!ENTITY a SYSTEM 'file:///etc/passwd'>]>", "<text>&a;</text>", "outside the file"),
        ("<!DOCTYPE svg [<!ENTITY % a SYSTEM 'http://127.0.0.1/a.dtd'> %a;]>", "", "outside the file"),
        ("<!DOCTYPE svg [<!ENTITY % a '<!ENTITY b \"c\">'> %a;]>", "", "steers"),
        (f"<!DOCTYPE svg [<!ENTITY a '{'x' * 100_000}'>]>", f"<text>{'&a;' * 1000}</text>", "unfold into more"),
        ("<!DOCTYPE svg>", "<text>&a;</text>", "not declared"),
        ("<!DOCTYPE svg SYSTEM 'a.dtd'>", "<path d='&a;'/>", "not declared"),
    ],
)
def test_entities_that_unfold_or_lead_outside_are_refused(read_svg: Reader, doctype: str, content: str, word: str) -> None:
    drawing = read_svg(doctype + s.svg(BOX + content))
    assert word in s.errors(drawing)["unreadable"]
    assert not drawing.loops


def test_plain_entities_are_read_as_drawing_programs_write_them(read_svg: Reader) -> None:
    doctype = "<!DOCTYPE svg PUBLIC '-//W3C//DTD SVG 1.1//EN' 'http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd' [{}]>"
    entities = "<!ENTITY ns 'http://www.w3.org/2000/svg'><!ENTITY box '<rect width=\"9\" height=\"9\"/>'>"
    text = s.svg("<g id='A &amp; B'>&box;</g>").replace("http://www.w3.org/2000/svg", "&ns;")
    drawing = read_svg(doctype.format(entities) + text)
    assert (drawing.layers, len(drawing.loops), drawing.findings) == (("A & B",), 1, ())


def test_deep_files_do_not_exhaust_the_stack(read_svg: Reader) -> None:
    deep = DEEPEST - 2
    assert len(read_svg(s.svg("<g>" * deep + BOX + "</g>" * deep)).loops) == 1
    too_deep = read_svg(s.svg("<g>" * 5000 + BOX + "</g>" * 5000))
    assert "nested more than" in s.errors(too_deep)["unreadable"]
    chain = "".join(f'<g id="c{k}"><use href="#c{k + 1}"/></g>' for k in range(3000)) + f'<g id="c3000">{BOX}</g>'
    assert "use-loop" in s.errors(read_svg(s.svg(f"<defs>{chain}</defs><use href='#c0'/>")))


def test_trees_of_use_that_explode_are_refused(read_svg: Reader) -> None:
    doubling = "".join(f'<g id="d{k}"><use href="#d{k + 1}"/><use href="#d{k + 1}" x="1"/></g>' for k in range(30))
    bomb = read_svg(s.svg(f'<defs>{doubling}<g id="d30">{BOX}</g></defs><use href="#d0"/>'))
    assert "too-large" in s.errors(bomb)
    assert not bomb.loops


@pytest.mark.parametrize("seed", few(range(3), 1))
@pytest.mark.parametrize("sample", range(3))
def test_damage_never_raises_and_never_goes_unnoticed(read_svg: Reader, sample: int, seed: int, damages: int = 25) -> None:
    rng = random.Random(f"{sample} {seed}")
    data = mutate_svg.samples()[sample]
    whole = read_svg(data)
    assert not whole.findings
    for _ in range(damages):
        drawing = read_svg(mutate_svg.mutate(rng, data))
        report = inspect_report(drawing)
        inspect_text(drawing)
        assert set(report) >= {"file", "units", "loops", "findings"}
        # A name changed may make another file in which nothing is wrong: then the independent reader draws as little.
        if not drawing.findings and len(drawing.loops) < len(whole.loops):
            assert judge_mutation.agreed(drawing, mutate_svg.length(drawing.path))


@pytest.mark.slow
@pytest.mark.parametrize("sample", range(3))
def test_much_damage_never_raises(read_svg: Reader, sample: int) -> None:
    test_damage_never_raises_and_never_goes_unnoticed(read_svg, sample, 99, damages=1000)
