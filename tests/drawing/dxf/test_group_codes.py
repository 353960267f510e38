"""Are the group codes of each entity those of Autodesk's DXF reference, no more and no less?"""

from __future__ import annotations

import pytest

from watchsim.drawing.dxf_records import COMMON, Record, strange_codes

# As the reference tabulates them (DXF reference, section Entities), without those that all entities may have.
REFERENCE = {
    "LINE": "10 20 30 11 21 31",
    "POINT": "10 20 30 50",
    "CIRCLE": "10 20 30 40",
    "ARC": "10 20 30 40 50 51",
    "ELLIPSE": "10 20 30 11 21 31 40 41 42",
    "LWPOLYLINE": "90 70 43 10 20 40 41 42 91 30",  # 30 is in no reference, but some programs write it
    "POLYLINE": "10 20 30 70 40 41 71 72 73 74 75",
    "VERTEX": "10 20 30 40 41 42 91 70 50 71 72 73 74",
    "INSERT": "2 10 20 30 41 42 43 50 70 71 44 45",
    "SPLINE": "70 71 72 73 74 42 43 44 12 22 32 13 23 33 40 41 10 20 30 11 21 31",
}
EVERY = "5 6 8 39 48 60 62 66 67 92 100 102 160 210 220 230 284 310 330 347 348 360 370 380 390 420 430 440"


@pytest.mark.parametrize("kind", REFERENCE)
def test_every_code_of_the_reference_is_known_and_no_other(kind: str) -> None:
    own, common = (set(map(int, text.split())) for text in (REFERENCE[kind], EVERY))
    assert strange_codes(Record(kind, sorted(own | common), [0] * len(own | common), "line 1")) == []
    for other in range(1000):
        if other not in own | COMMON:
            assert strange_codes(Record(kind, [other], [0], "line 1")) == [other]
