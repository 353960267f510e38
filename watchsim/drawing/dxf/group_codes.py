"""Which group codes may an entity have?

A code that does not belong there is the trace of a damaged file: a coordinate may have gone astray with it. Codes after
the DXF reference (Autodesk), those of old versions included.
"""

from __future__ import annotations

from watchsim.drawing.dxf_records import Record

EXTENDED = 1000  # from here on: data of applications, which may hold anything
COMMON = frozenset(
    (
        *(5, 6, 8, 38, 39, 48, 60, 62, 66, 67, 92, 100, 102, 160, 170, 210, 220, 230, 284, 310, 330, 340, 347, 348),
        *(350, 360, 370, 380, 390, 410, 420, 430, 440, 999),
    )
)
OWN = {
    "LINE": frozenset((10, 20, 30, 11, 21, 31)),
    "POINT": frozenset((10, 20, 30, 50)),
    "CIRCLE": frozenset((10, 20, 30, 40)),
    "ARC": frozenset((10, 20, 30, 40, 50, 51)),
    "ELLIPSE": frozenset((10, 20, 30, 11, 21, 31, 40, 41, 42)),
    "LWPOLYLINE": frozenset((10, 20, 30, 40, 41, 42, 43, 70, 90, 91)),
    "POLYLINE": frozenset((10, 20, 30, 40, 41, 70, 71, 72, 73, 74, 75)),
    "VERTEX": frozenset((10, 20, 30, 40, 41, 42, 50, 70, 71, 72, 73, 74, 91)),
    "SEQEND": frozenset((-2,)),
    "INSERT": frozenset((2, 10, 20, 30, 41, 42, 43, 44, 45, 50, 70, 71)),
    "SPLINE": frozenset((10, 20, 30, 11, 21, 31, 12, 22, 32, 13, 23, 33, 40, 41, 42, 43, 44, 70, 71, 72, 73, 74)),
}


def strange_codes(record: Record) -> list[int]:
    """The codes that do not belong to this type of entity, ascending."""
    own = OWN.get(record.kind)
    if own is None:
        return []
    return sorted(code for code in set(record.codes) - COMMON - own if code < EXTENDED)
