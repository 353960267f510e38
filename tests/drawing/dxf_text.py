"""How is a small DXF file written by hand, tag by tag, good or broken?"""

from collections.abc import Sequence

Tag = tuple[int, object]


def record(kind: str, *tags: Tag, layer: str = "0") -> str:
    """One record of the ENTITIES section."""
    return "".join(f"{code}\n{value}\n" for code, value in ((0, kind), (8, layer), *tags))


def line(a: Sequence[float], b: Sequence[float], layer: str = "0", handle: str = "") -> str:
    tags: list[Tag] = [(5, handle)] if handle else []
    return record("LINE", *tags, *point(10, a), *point(11, b), layer=layer)


def arc(x: float, y: float, radius: float, start: float, end: float, *more: Tag, layer: str = "0") -> str:
    return record("ARC", *point(10, (x, y)), (40, repr(radius)), (50, repr(start)), (51, repr(end)), *more, layer=layer)


def circle(x: float, y: float, radius: float, *more: Tag, layer: str = "0") -> str:
    return record("CIRCLE", *point(10, (x, y)), (40, repr(radius)), *more, layer=layer)


def lwpolyline(corners: Sequence[Sequence[float]], closed: bool, layer: str = "0") -> str:
    """Corners are (x, y) or (x, y, bulge)."""
    tags: list[Tag] = [(90, len(corners)), (70, int(closed))]
    for corner in corners:
        tags += [(10, repr(float(corner[0]))), (20, repr(float(corner[1])))]
        tags += [(42, repr(float(corner[2])))] if len(corner) > 2 else []
    return record("LWPOLYLINE", *tags, layer=layer)


def point(code: int, p: Sequence[float]) -> list[Tag]:
    z = p[2] if len(p) > 2 else 0.0
    return [(code, repr(float(p[0]))), (code + 10, repr(float(p[1]))), (code + 20, repr(float(z)))]


def polygon(corners: Sequence[Sequence[float]], layer: str = "0") -> str:
    """Single lines around the corners."""
    return "".join(line(a, b, layer) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True))


def header(units: int | None) -> str:
    return "" if units is None else f"0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n{units}\n0\nENDSEC\n"


def layers(*rows: tuple[str, int, int]) -> str:
    """Each row: name, colour (negative: off), flags (1: frozen)."""
    entries = "".join(f"0\nLAYER\n2\n{name}\n70\n{flags}\n62\n{colour}\n" for name, colour, flags in rows)
    return f"0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n{entries}0\nENDTAB\n0\nENDSEC\n"


def block(name: str, content: str, base: Sequence[float] = (0.0, 0.0)) -> str:
    head = record("BLOCK", (2, name), (70, 0), *point(10, base))
    return f"{head}{content}0\nENDBLK\n8\n0\n"


def insert(name: str, at: Sequence[float], *tags: Tag, layer: str = "0") -> str:
    return record("INSERT", (2, name), *point(10, at), *tags, layer=layer)


def dxf(entities: str, units: int | None = 4, tables: str = "", blocks: str = "") -> bytes:
    """A whole file."""
    inside = f"0\nSECTION\n2\nBLOCKS\n{blocks}0\nENDSEC\n" if blocks else ""
    return f"{header(units)}{tables}{inside}0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n".encode()
