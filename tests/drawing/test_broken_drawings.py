"""Does a broken file give findings, never a traceback and never a drawing with something missing in silence?"""

import gzip
import io
import random
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import dxf_text as d
import judge_mutation
import mutate_dxf
import mutate_svg
import pytest
import svg_text as s
from every_time import few
from ezdxf import recover

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.inspection import inspect_report, inspect_text
from watchsim.drawing.read import LARGEST_FILE, read
from watchsim.drawing.svg_elements import DEEPEST, MOST_UNPACKED

Reader = Callable[..., Drawing]
DATA = Path(__file__).resolve().parents[1] / "data"


def errors(drawing: Drawing) -> dict[str, str]:
    return {finding.code: finding.message for finding in drawing.findings if finding.severity == "error"}


@pytest.mark.parametrize(
    ("data", "word"),
    [
        (b"", "empty"),
        (b"\n  \r\n", "empty"),
        (b"hello world\nthis is a letter\n", "not a DXF file"),
        (bytes(range(256)) * 20, "not a DXF file"),
        (b"AC1027\x00\x01\x02", "DWG"),
        (b"AutoCAD Binary DXF\r\n\x1a\x00\xff\xff\xff", "not a DXF file"),
        (b"\x89PNG\r\n\x1a\n" + bytes(100), "not a DXF file"),
        (b"<html></html>", "not a DXF file"),
    ],
)
def test_what_is_no_dxf(read_bytes: Reader, data: bytes, word: str) -> None:
    drawing = read_bytes(data)
    assert word in errors(drawing)["unreadable"]
    assert not drawing.loops
    assert inspect_report(drawing)["lines"] == 0
    assert word in inspect_text(drawing)


def test_files_that_are_not_there_or_not_read(tmp_path: Path) -> None:
    assert "no such file" in errors(read(tmp_path / "none.dxf"))["unreadable"]
    (tmp_path / "folder.dxf").mkdir()
    assert "is a folder" in errors(read(tmp_path / "folder.dxf"))["unreadable"]
    assert "no such file" in errors(read(tmp_path / "wheel.svg"))["unreadable"]
    assert "no such file" in errors(read(tmp_path / "wheel.step"))["unreadable"]
    assert "wheel.sldprt" in errors(read(tmp_path / "wheel.sldprt"))["format"]
    with pytest.raises(ValueError, match="positive"):
        read(tmp_path / "none.dxf", snap=0.0)


@pytest.mark.parametrize("name", ["open_outline", "truncated", "two_faults", "no_units", "lost_boundary", "bad_number"])
def test_small_files_that_broke_importers(name: str) -> None:
    expected = {
        "open_outline": {"open-outline"},
        "truncated": {"truncated", "open-outline"},
        "two_faults": {"damaged", "block-missing"},
        "no_units": {"units-missing"},
        "lost_boundary": {"damaged", "open-outline"},
        "bad_number": {"damaged"},
    }
    assert set(errors(read(DATA / f"{name}.dxf"))) == expected[name]


def test_truncated_files_name_the_last_whole_entity(read_bytes: Reader) -> None:
    whole = d.dxf(
        d.line((0, 0), (1, 0), handle="A1") + d.line((1, 0), (1, 1), handle="A2") + d.line((1, 1), (0, 0), handle="A3")
    )
    cut = whole[: whole.index(b"A3") + 20]
    assert "LINE #A2" in errors(read_bytes(cut))["truncated"]
    for length in range(1, len(whole) - 4, 3):
        found = errors(read_bytes(whole[:length]))
        assert found, f"cut after {length} bytes and nothing said"


def test_why_ezdxf_does_not_read_the_entities(read_bytes: Reader) -> None:
    """It recovers a file that was cut short as an empty drawing and calls it sound. If this fails, look at it again."""
    whole = d.dxf(d.line((0, 0), (1, 0)) + d.line((1, 0), (1, 1)) + d.line((1, 1), (0, 0)))
    cut = whole[: whole.rindex(b"LINE")]
    assert [len(recover.read(io.BytesIO(data))[0].modelspace()) for data in (whole, cut)] == [3, 0]
    audit = recover.read(io.BytesIO(cut))[1]
    assert not audit.errors and not audit.fixes
    assert "truncated" in errors(read_bytes(cut))


def test_missing_endsec_is_said(read_bytes: Reader) -> None:
    whole = d.dxf(d.circle(0, 0, 1)).decode()
    broken = whole[: whole.rindex("0\nENDSEC")] + "0\nEOF\n"
    assert "ENTITIES has no ENDSEC" in errors(read_bytes(broken.encode()))["truncated"]


def test_trash_after_the_end_is_only_a_notice(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1)) + b"\x1a some remains\n\x00\x01")
    assert [(finding.code, finding.severity) for finding in drawing.findings] == [("trash", "notice")]
    assert len(drawing.loops) == 1


@pytest.mark.parametrize(
    ("entity", "word"),
    [
        (d.record("CIRCLE", (10, 0.0), (20, 0.0)), "group 40 is missing"),
        (d.record("CIRCLE", (10, 0.0), (20, 0.0), (40, "one")), 'group 40 is "one"'),
        (d.record("CIRCLE", (10, 0.0), (20, 0.0), (40, "nan")), "not a sensible number"),
        (d.record("CIRCLE", (10, 1e300), (20, 0.0), (40, 1.0)), "not a sensible number"),
        (d.record("LINE", (10, 0.0), (20, 0.0), (11, 1.0)), "group 21 is missing"),
        (d.record("LINE", *d.point(10, (0, 0)), *d.point(10, (0, 0)), *d.point(11, (0, 0))), "stands there 2 times"),
        (d.record("LWPOLYLINE", (90, 3), (10, 0.0), (20, 0.0), (10, 1.0), (20, 1.0)), "announces 3 corners and holds 2"),
        (d.record("LWPOLYLINE", (10, 0.0), (10, 1.0), (20, 1.0)), "without its y coordinate"),
        (d.record("LWPOLYLINE", (20, 0.0), (10, 1.0), (20, 1.0)), "does not belong"),
        (d.record("LWPOLYLINE", (70, 1)), "no corners"),
        (d.record("ELLIPSE", *d.point(10, (0, 0)), *d.point(11, (0, 0)), (40, 0.5)), "no length"),
        (d.record("SPLINE", (71, 3)), "neither control points"),
        (d.insert("B", (0, 0), (41, 0.0)), "nothing would be left"),
        (d.insert("B", (0, 0), (70, 30000), (71, 30000)), "too many"),
    ],
)
def test_damaged_entities_are_errors_and_the_rest_is_read(read_bytes: Reader, entity: str, word: str) -> None:
    drawing = read_bytes(d.dxf(d.circle(50, 0, 1) + entity, blocks=d.block("B", d.circle(0, 0, 1))))
    assert word in errors(drawing)["damaged"]
    assert len(drawing.loops) == 1


def test_blocks_that_multiply_are_stopped(read_bytes: Reader) -> None:
    levels = "".join(
        d.block(f"L{k}", d.insert(f"L{k + 1}", (0, 0), (70, 30), (71, 30), (44, 1.0), (45, 1.0))) for k in range(6)
    )
    drawing = read_bytes(d.dxf(d.insert("L0", (0, 0)), blocks=levels + d.block("L6", "")))
    assert "too-large" in errors(drawing)


SMALL = d.dxf(
    d.insert("B", (0, 0), (70, 12_000), (44, 2.0)),
    blocks=d.block("B", d.lwpolyline([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0.5)], True)),
)


def test_a_few_bytes_do_not_unfold_into_a_large_drawing(read_bytes: Reader) -> None:
    """400 bytes asked for 60 000 pieces, which took seconds to look through."""
    assert len(SMALL) < 500 and "unfolds into more than 50" in errors(read_bytes(SMALL))["too-large"]


@pytest.mark.slow
def test_a_file_of_that_size_unfolds_into_one(read_bytes: Reader) -> None:
    large = SMALL.replace(b"0\nEOF\n", b"999\na comment of fifty characters, which nobody reads\n" * 400 + b"0\nEOF\n")
    assert len(read_bytes(large).loops) == 12_000


def test_more_pieces_than_a_drawing_can_have_are_refused_whole(read_bytes: Reader) -> None:
    """Half a drawing would be worse than none, and takes long to look through."""
    comb = "".join(d.line((k, 0), (k, 1)) for k in range(600))
    drawing = read_bytes(d.dxf(d.insert("B", (0, 0), (70, 450), (44, 1e3)), blocks=d.block("B", comb)))
    assert "nothing was read" in errors(drawing)["too-large"]
    assert not drawing.open_chains and drawing.units == "mm"


def test_a_file_too_large_for_a_drawing_is_not_even_opened(tmp_path: Path) -> None:
    path = tmp_path / "map.dxf"
    with path.open("wb") as file:
        file.truncate(LARGEST_FILE + 1)
    assert "75 MB" in errors(read(path))["too-large"]


def test_strange_groups_are_a_warning(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1, (43, 2.0))))
    assert [(finding.code, finding.severity) for finding in drawing.findings] == [("strange-group", "warning")]


def test_an_unknown_type_of_entity_is_a_warning(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1) + d.record("CJRCLE", *d.point(10, (0, 0)), (40, 2.0))))
    assert drawing.ignored == {"CJRCLE": 1}
    assert [(finding.code, finding.severity) for finding in drawing.findings] == [("ignored", "warning")]


def test_only_hidden_or_only_text_is_empty(read_bytes: Reader) -> None:
    tables = d.layers(("A", -7, 0))
    assert "empty" in errors(read_bytes(d.dxf(d.circle(0, 0, 1, layer="A"), tables=tables)))
    assert "1 × TEXT" in errors(read_bytes(d.dxf(d.record("TEXT", (1, "x")))))["empty"]
    assert "empty" in errors(read_bytes(d.dxf("")))


def test_what_a_damaged_boundary_swallows_is_said(read_bytes: Reader) -> None:
    """The group code 0 before an entity became something else: it is part of the record before it."""
    corners = "".join(d.record("VERTEX", *d.point(10, p)) for p in ((0, 0), (4, 0), (4, 4)))
    polyline = d.record("POLYLINE", (66, 1), (70, 1)) + corners + d.record("SEQEND", layer="ROW")
    swallowed = d.circle(9, 0, 1).replace("0\n", "62\n", 1)
    after_row = read_bytes(d.dxf(polyline + swallowed))
    assert [(finding.code, finding.layer) for finding in after_row.findings] == [("strange-group", "ROW")]
    after_text = read_bytes(d.dxf(d.circle(0, 0, 1) + d.record("TEXT", *d.point(10, (0, 0)), (40, 1.0), (1, "x")) + swallowed))
    assert "names two layers" in errors(after_text)["damaged"]


def test_a_section_that_swallows_its_first_entity_is_said(read_bytes: Reader) -> None:
    data = d.dxf(d.circle(0, 0, 1) + d.circle(9, 0, 1)).replace(b"ENTITIES\n0\n", b"ENTITIES\n70\n")
    assert "section ENTITIES begins with groups of something else" in errors(read_bytes(data))["damaged"]
    block = d.block("B", d.circle(0, 0, 1) + d.circle(5, 0, 1)).replace("0\nCIRCLE", "70\nCIRCLE", 1)
    messages = [finding.message for finding in read_bytes(d.dxf(d.insert("B", (0, 0)), blocks=block)).findings]
    assert any("names two layers" in message for message in messages)


def test_a_drawing_of_a_few_micrometres_is_told_of(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 0.004)))
    assert [(finding.code, finding.severity) for finding in drawing.findings] == [("tiny", "warning")]
    assert not read_bytes(d.dxf(d.circle(0, 0, 0.05))).findings


def test_entities_outside_their_sections_are_said(read_bytes: Reader) -> None:
    tables = "0\nSECTION\n2\nTABLES\n" + d.circle(5, 0, 1) + "0\nENDSEC\n"
    assert "stands in section TABLES" in errors(read_bytes(d.dxf(d.circle(0, 0, 1), tables=tables)))["damaged"]


def test_a_block_that_is_there_twice_is_said(read_bytes: Reader) -> None:
    blocks = d.block("B", d.circle(0, 0, 1)) + d.block("b", "")
    assert 'block "b" is defined twice' in errors(read_bytes(d.dxf(d.insert("B", (0, 0)), blocks=blocks)))["damaged"]


def test_a_last_block_without_its_end_is_used_and_said(read_bytes: Reader) -> None:
    whole = d.block("Wheel", d.circle(0, 0, 1))
    blocks = whole.replace("0\nENDBLK\n8\n0\n", "")
    assert blocks != whole
    drawing = read_bytes(d.dxf(d.insert("wheel", (3, 4)), blocks=blocks))
    assert 'block "Wheel" has no ENDBLK' in errors(drawing)["damaged"]
    (loop,) = drawing.loops
    assert loop.edges[0].point(0.5) == pytest.approx((2e-3, 4e-3))


def test_entities_after_the_end_are_an_error(read_bytes: Reader) -> None:
    """Two files in one, or an EOF gone astray: what is drawn behind it must not get lost in silence."""
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1)) + d.line((0, 0), (1, 0)).encode() + d.circle(5, 0, 1).encode())
    assert "2 entities (LINE)" in errors(drawing)["trash"]
    assert len(drawing.loops) == 1


def test_polylines_of_one_corner_are_told(read_bytes: Reader) -> None:
    drawing = read_bytes(d.dxf(d.circle(0, 0, 1) + d.lwpolyline([(3, 4)], False)))
    (finding,) = drawing.findings
    assert finding.code == "zero-length" and finding.message.startswith("LWPOLYLINE")
    assert (finding.x_mm, finding.y_mm) == pytest.approx((3.0, 4.0))


@pytest.mark.parametrize(("tag", "word"), [((70, 0), "0 columns"), ((71, -3), "-3 rows"), ((66, 1), "attributes")])
def test_inserts_with_something_amiss_are_told(read_bytes: Reader, tag: d.Tag, word: str) -> None:
    drawing = read_bytes(d.dxf(d.insert("B", (0, 0), tag), blocks=d.block("B", d.circle(0, 0, 1))))
    (finding,) = drawing.findings
    assert (finding.code, finding.severity) == ("strange-group", "warning") and word in finding.message
    assert len(drawing.loops) == 1


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


Accident = Callable[[random.Random, bytes], bytes]
MUTATORS = [mutate_dxf, mutate_svg]
ACCIDENTS = [(mutator, accident) for mutator in MUTATORS for accident in mutator.ACCIDENTS]


def judged(folder: Path, mutator: ModuleType, seeds: range) -> list[str]:
    path = folder / f"drawing.{mutator.ENDING}"
    wholes = []
    for sample in mutator.samples():
        path.write_bytes(sample)
        wholes.append(read(path))
        assert not wholes[-1].findings
    faults = []
    for seed in seeds:
        rng = random.Random(seed)
        k = rng.randrange(len(wholes))
        data = mutator.mutate(rng, mutator.samples()[k])
        path.write_bytes(data)
        faults.append(judge_mutation.fault(path, wholes[k], mutator))
    return faults


@pytest.mark.parametrize("mutator", MUTATORS, ids=lambda mutator: mutator.ENDING)
def test_tens_of_accidents(tmp_path: Path, mutator: ModuleType) -> None:
    assert not any(judged(tmp_path, mutator, range(30)))


@pytest.mark.slow
@pytest.mark.parametrize("mutator", MUTATORS, ids=lambda mutator: mutator.ENDING)
def test_hundreds_of_accidents(tmp_path: Path, mutator: ModuleType) -> None:
    assert not any(judged(tmp_path, mutator, range(1000, 1800)))


@pytest.mark.parametrize(
    ("mutator", "accident"),
    [(m, a) for m in MUTATORS for a in m.ACCIDENTS],
    ids=lambda one: one.__name__.removeprefix("mutate_"),
)
def test_every_kind_of_accident_changes_the_file(
    mutator: ModuleType, accident: Callable[[random.Random, bytes], bytes]
) -> None:
    data = mutator.samples()[0]
    assert sum(accident(random.Random(seed), data) != data for seed in range(20)) > 8


@pytest.mark.parametrize("mutator", MUTATORS, ids=lambda mutator: mutator.ENDING)
def test_both_readers_agree_on_the_whole_files(tmp_path: Path, mutator: ModuleType) -> None:
    path = tmp_path / f"drawing.{mutator.ENDING}"
    for sample in mutator.samples():
        path.write_bytes(sample)
        assert judge_mutation.agreed(read(path), mutator.length(path))
        assert not judge_mutation.agreed(read(path), 0.9 * (mutator.length(path) or 0.0))


def test_a_loss_in_silence_would_be_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "drawing.dxf"
    path.write_bytes(mutate_dxf.every_entity())
    whole = read(path)
    assert mutate_dxf.entities(mutate_dxf.every_entity()) == 11
    assert not judge_mutation.fault(path, whole, mutate_dxf)
    path.write_bytes(mutate_dxf.samples()[2])
    assert not judge_mutation.fault(path, whole, mutate_dxf), "ezdxf agrees that there is less"
    monkeypatch.setattr(mutate_dxf, "length", lambda _: 9.0)
    assert judge_mutation.fault(path, whole, mutate_dxf).startswith("silent loss: 17 before")
    monkeypatch.setattr(mutate_dxf, "entities", lambda _: 5)
    assert judge_mutation.fault(path, read(path), mutate_dxf).startswith("silent loss: 5 entities in the file, 4 read")
    assert mutate_dxf.lost(mutate_dxf.every_entity().replace(b"0\nINSERT", b"70\nINSERT"))
    assert not any(map(mutate_dxf.lost, mutate_dxf.samples()))


def test_an_exception_would_be_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise ZeroDivisionError

    path = tmp_path / "drawing.dxf"
    path.write_bytes(mutate_dxf.every_entity())
    whole = read(path)
    monkeypatch.setattr(judge_mutation, "inspect_text", broken)
    assert judge_mutation.fault(path, whole, mutate_dxf).startswith("exception:")


def test_a_loss_in_silence_would_be_noticed_in_svg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "drawing.svg"
    path.write_bytes(mutate_svg.every_element())
    whole = read(path)
    assert mutate_svg.entities(mutate_svg.every_element()) == 10
    path.write_bytes(mutate_svg.layered().replace(b'width="10" height="12"', b'width="20" height="12"'))
    assert not judge_mutation.fault(path, whole, mutate_svg), "the plain reading agrees that there is less"
    monkeypatch.setattr(mutate_svg, "length", lambda _: 9.0)
    assert judge_mutation.fault(path, whole, mutate_svg).startswith("silent loss: 18 before")
    monkeypatch.setattr(mutate_svg, "entities", lambda _: 5)
    assert judge_mutation.fault(path, read(path), mutate_svg).startswith("silent loss: 5 entities in the file, 3 read")
    assert mutate_svg.lost(b"<svg><text><![CDATA[<rect width='4'/>]]></text></svg>") and mutate_svg.lost(b"<svg><g></svg>")
    assert not any(map(mutate_svg.lost, mutate_svg.samples()))


# Does the reader say of everything that it left out how much of it there was, whether it matters, and why?
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
