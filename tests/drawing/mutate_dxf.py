"""How is a small DXF file damaged at random?

One accident per file: bytes, numbers, group codes, lines, the nesting of blocks, or the end of the file.
"""

import random
from itertools import pairwise
from pathlib import Path

import accidents
import dxf_text as d
from accidents import Accident, after_accidents, bytes_overwritten, cut_off, line_lost, lines_swapped

ENDING = "dxf"
TOLD = ("layer-off", "paper-space", "edge-on")  # findings that account for entities not drawn
NUMBERS = (*accidents.NUMBERS, b"0x10", b"1,5")
CODES = (
    *(b"0", b"1", b"2", b"5", b"8", b"10", b"11", b"20", b"40", b"41", b"42", b"50", b"62", b"66", b"67", b"70", b"210"),
    b"-5",
)
WORDS = (b"INSERT", b"BLOCK", b"ENDBLK", b"SECTION", b"ENDSEC", b"EOF", b"SPLINE", b"VERTEX", b"SEQEND", b"LINE", b"POLYLINE")


KINDS = (b"LINE", b"ARC", b"CIRCLE", b"ELLIPSE", b"SPLINE", b"LWPOLYLINE", b"POLYLINE", b"VERTEX", b"INSERT", b"POINT")

NAMING = (b"1", b"2", b"3", b"8")  # groups that hold names


def samples() -> list[bytes]:
    """Whole files without any finding."""
    return [
        marked(every_entity()),
        marked(nested_blocks()),
        d.dxf(d.polygon([(0, 0), (4, 0), (4, 3)]) + d.circle(3, 1, 0.5), units=1),
    ]


def marked(data: bytes) -> bytes:
    """With the subclass markers without which the other reader refuses some entities."""
    for kind, marker in ((b"LWPOLYLINE", b"AcDbPolyline"), (b"SPLINE", b"AcDbSpline"), (b"ELLIPSE", b"AcDbEllipse")):
        data = data.replace(b"0\n%s\n8\n0\n" % kind, b"0\n%s\n100\nAcDbEntity\n8\n0\n100\n%s\n" % (kind, marker))
    return data.replace(b"HEADER\n", b"HEADER\n9\n$ACADVER\n1\nAC1015\n")


def every_entity() -> bytes:
    """Every entity that is read, all outlines closed."""
    half = [(0, 0, 1.0), (2, 0, 1.0)]
    entities = (
        d.polygon([(0, 0), (1, 0), (1, 1)]) + d.circle(9, 0, 1) + d.lwpolyline([(x + 20, y, b) for x, y, b in half], True)
    )
    entities += d.arc(30, 0, 1, 0, 180) + d.line((29, 0), (31, 0))
    vertices = "".join(d.record("VERTEX", *d.point(10, p)) for p in ((40, 0), (41, 0), (41, 2)))
    entities += d.record("POLYLINE", (66, 1), (70, 1)) + vertices + d.record("SEQEND")
    entities += d.record("ELLIPSE", *d.point(10, (50, 0)), *d.point(11, (2, 1)), (40, 0.5), (41, 0.0), (42, 6.283185307179586))
    knots = [(40, float(k)) for k in (0, 0, 0, 0, 1, 1, 1, 1)]
    control = [tag for p in ((60, 0), (62, 3), (64, -1), (60, 0)) for tag in d.point(10, p)]
    entities += d.record("SPLINE", (70, 8), (71, 3), (72, 8), (73, 4), *knots, *control)
    entities += d.insert("B", (70, 0), (41, 2.0), (42, 2.0), (50, 30.0)) + d.record("POINT", *d.point(10, (75, 3)))
    return d.dxf(entities, tables=d.layers(("OFF", -7, 0)), blocks=d.block("B", d.circle(0, 0, 1)))


def nested_blocks() -> bytes:
    """Blocks in blocks, arrays, mirrored and unequally scaled."""
    inner = d.block("INNER", d.circle(0, 0, 1) + d.lwpolyline([(3, 0), (5, 0), (5, 2, -0.3)], True))
    middle = d.insert("INNER", (0, 0), (50, 15.0)) + d.insert("INNER", (20, 0), (41, -1.0), (42, 1.0), (43, 0.0))
    outer = d.insert("MIDDLE", (0, 0), (70, 2), (71, 2), (44, 60.0), (45, 60.0)) + d.line((-50, -50), (-40, -50))
    outer += d.line((-40, -50), (-40, -40)) + d.line((-40, -40), (-50, -50))
    blocks = inner + d.block("MIDDLE", middle) + d.block("OUTER", outer, base=(1.0, 2.0))
    squashed = d.insert("INNER", (300, 0), (41, 2.0), (42, 1.0))
    return d.dxf(d.insert("OUTER", (0, 0), (210, 0.0), (220, 0.0), (230, -1.0)) + squashed, blocks=blocks)


def entities(data: bytes) -> int:
    """How many entities stand in model space by a plain look at the lines; blocks are not unfolded."""
    lines = [line.strip().decode("latin-1") for line in data.splitlines()]
    inside, count = False, 0
    for code, value, following in zip(lines[::2], lines[1::2], [*lines[3::2], ""], strict=False):
        if code == "0" and value.upper() in ("SECTION", "ENDSEC"):
            inside = value.upper() == "SECTION" and following.upper() == "ENTITIES"
        elif code == "0" and value.upper() == "EOF":
            break
        elif code == "0" and inside:
            count += value.upper() not in ("VERTEX", "SEQEND", "INSERT")
    return count


def lost(data: bytes) -> bool:
    """Does the name of an entity stand anywhere but after a group code 0, or as the name of something, in what is drawn?"""
    lines = [line.strip() for line in without_unused_blocks(data).splitlines()]
    end = lines.index(b"EOF") if b"EOF" in lines else len(lines)
    begun = sum(code == b"0" and name in KINDS for code, name in zip(lines[:end:2], lines[1:end:2], strict=False))
    return sum(line in KINDS and before not in NAMING for before, line in pairwise(lines[:end])) > begun


def length(path: Path) -> float | None:
    """How much ezdxf draws, in drawing units, blocks unfolded; None where it gives up even on what is drawn alone."""
    found = drawn_length(path)
    if found is None:
        alone = path.with_name("drawn.dxf")
        alone.write_bytes(without_unused_blocks(path.read_bytes()))
        found = drawn_length(alone)
    return found


def without_unused_blocks(data: bytes) -> bytes:
    """The file without the blocks that nothing in model space inserts: their damage is none of the drawing's."""
    lines = data.splitlines()
    starts = [k for k in range(0, len(lines) - 1, 2) if lines[k].strip() == b"0"]
    if not starts:
        return data
    records = [(lines[a + 1].strip(), lines[a:b]) for a, b in zip(starts, [*starts[1:], len(lines)], strict=True)]
    inside = b""
    uses: dict[bytes, set[bytes]] = {b"": set()}
    homes = []
    for kind, record in records:
        name = next((record[k + 1].strip() for k in range(2, len(record) - 1, 2) if record[k].strip() == b"2"), b"")
        inside = name if kind == b"BLOCK" else inside
        homes.append(inside)
        if kind == b"INSERT":
            uses.setdefault(inside, set()).add(name)
        inside = b"" if kind == b"ENDBLK" else inside
    used, new = {b""}, {b""}
    while new:
        new = set().union(*(uses.get(name, set()) for name in new)) - used
        used |= new
    kept = lines[: starts[0]]
    for home, (_, record) in zip(homes, records, strict=True):
        kept = [*kept, *record] if home in used else kept
    return b"\n".join(kept)


def drawn_length(path: Path) -> float | None:
    from ezdxf import disassemble, recover

    try:
        space = recover.readfile(path)[0].modelspace()
        pieces = disassemble.to_primitives(disassemble.recursive_decompose(space))
        drawn = (piece.path for piece in pieces if piece.path is not None and piece.entity.dxftype() != "POINT")
        chains = ([*one.flattening(distance=1e-3)] for one in drawn)
        return sum(p.distance(q) for chain in chains for p, q in pairwise(chain))
    except Exception:
        return None


def mutate(rng: random.Random, data: bytes) -> bytes:
    """The file after one to three accidents."""
    return after_accidents(rng, data, ACCIDENTS)


def line_replaced(rng: random.Random, data: bytes) -> bytes:
    lines = data.split(b"\n")
    k = rng.randrange(len(lines))
    lines[k] = rng.choice(NUMBERS + CODES + WORDS if lines[k - 1].strip() == b"0" else NUMBERS + CODES)
    return b"\n".join(lines)


def code_changed(rng: random.Random, data: bytes) -> bytes:
    """Every other line is a group code."""
    lines = data.split(b"\n")
    lines[2 * rng.randrange(len(lines) // 2 + 1) % len(lines)] = rng.choice(CODES)
    return b"\n".join(lines)


def number_changed(rng: random.Random, data: bytes) -> bytes:
    lines = data.split(b"\n")
    values = [k for k, line in enumerate(lines) if k % 2 and line.strip(b"+-. 0123456789eE\r") == b"" and line.strip()]
    if values:
        lines[rng.choice(values)] = rng.choice(
            (*NUMBERS, repr(rng.uniform(-1e3, 1e3)).encode(), str(rng.randrange(-5, 5000)).encode())
        )
    return b"\n".join(lines)


def nesting_changed(rng: random.Random, data: bytes) -> bytes:
    """An INSERT refers to another block, perhaps the one it stands in."""
    lines = data.split(b"\n")
    names = [lines[k + 1] for k in range(len(lines) - 1) if lines[k].strip() == b"2" and k % 2 == 0]
    uses = [k + 1 for k in range(len(lines) - 1) if lines[k].strip() == b"2" and k % 2 == 0]
    if uses:
        lines[rng.choice(uses)] = rng.choice(names)
    return b"\n".join(lines)


def lines_doubled(rng: random.Random, data: bytes) -> bytes:
    return accidents.lines_doubled(rng, data, most=30)


ACCIDENTS: tuple[Accident, ...] = (
    *(bytes_overwritten, cut_off, line_lost, line_replaced, lines_swapped, lines_doubled, code_changed, number_changed),
    nesting_changed,
)
