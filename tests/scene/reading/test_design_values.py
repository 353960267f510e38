"""Which number of a design's dimension does a text with a unit mean?"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import pytest

from watchsim import units
from watchsim.construction.design import Conflict, Design, dim
from watchsim.scene.designed import chosen, kind_of, number_of, with_si
from watchsim.scene.errors import Faults, SceneError


@dataclass(frozen=True)
class Values:
    """Of a design that is never drawn."""

    lock: float = dim(1.5, "°", 0.5, 4.0, "depth", "chosen")
    length: float = dim(200.0, "mm", 10.0, 2000.0, "way", "chosen")
    teeth: int = dim(15, "", 8, 30, "number", "chosen")
    beat: float = dim(28800.0, "vph", 3600.0, 72000.0, "pace", "chosen")


def conflicts(values: Values) -> Any:
    if values.length > 1000.0 and values.teeth < 10:
        yield Conflict("teeth", "too few for so long a way")
    if values.beat > 50000.0:
        yield Conflict("", "too fast altogether")


DESIGN = Design("made", "Made", Values, lambda _: {}, lambda _: "", conflicts)


@pytest.mark.parametrize(
    ("name", "text", "number"),
    [
        ("lock", "1.7°", 1.7),
        ("lock", "0.02 rad", math.degrees(0.02)),
        ("length", "123.456 mm", 123.456),
        ("length", "0.3 m", 300.0),
        ("length", "3 inch", 76.2),
        ("length", "12345.678 µm", 12.345678),
        ("teeth", 17, 17.0),
        ("teeth", "17", 17.0),
        ("beat", "21600 vph", 21600.0),
        ("beat", "3 Hz", 21600.0),
    ],
)
def test_a_text_in_any_unit_is_a_number_in_the_dimension_s_own(name: str, text: object, number: float) -> None:
    """To the last of fifteen digits."""
    assert number_of(DESIGN.dimension(name), text) == float(f"{number:.15g}")
    values = chosen(DESIGN, {name: text})
    assert getattr(values, name) == pytest.approx(number, rel=1e-14, abs=0.0)
    assert [getattr(values, one) == getattr(Values(), one) for one in ("lock", "length", "teeth", "beat") if one != name] == [
        True
    ] * 3


@pytest.mark.parametrize(
    ("name", "kind", "si"),
    [
        ("lock", units.ANGLE, "0.25 rad"),
        ("length", units.LENGTH, "0.25 m"),
        ("teeth", units.NUMBER, 0.25),
        ("beat", units.FREQUENCY, "0.25 Hz"),
    ],
)
def test_numbers_from_python_are_in_si(name: str, kind: units.Dimension, si: object) -> None:
    assert kind_of(DESIGN.dimension(name)) is kind
    assert with_si(DESIGN, name, 0.25) == si
    assert with_si(DESIGN, name, True) is True and with_si(DESIGN, name, "3 mm") == "3 mm"
    assert with_si(DESIGN, "none", 0.25) == 0.25


@pytest.mark.parametrize(
    ("given", "faults"),
    [
        ({"lock": "1 mm"}, [("design.lock", ' = "1 mm"')]),
        ({"lock": 2}, [("design.lock", " = 2")]),
        ({"lok": "2°"}, [("design.lok", "")]),
        ({"lock": "0.4°", "length": "3 m"}, [("design.lock", ' = "0.4°"'), ("design.length", ' = "3 m"')]),
        ({"length": "1.5 m", "teeth": 9}, [("design.teeth", " = 9")]),
        ({"length": "1.5 m", "teeth": 10}, []),
        ({"beat": "60000 vph"}, [("design", "")]),
    ],
)
def test_what_does_not_fit_is_said_with_the_value(given: dict[str, object], faults: list[tuple[str, str]]) -> None:
    noted = Faults()
    noted.add("before", "another fault")
    values = chosen(DESIGN, given, noted)
    assert (values is None) is bool(faults)
    assert [(fault.key, fault.shown) for fault in noted.found[1:]] == faults
    if faults:
        with pytest.raises(SceneError) as caught:
            chosen(DESIGN, given)
        assert len(caught.value.faults) == len(faults)


def test_a_default_that_stands_in_the_way_is_shown() -> None:
    short = Design("made", "Made", Values, lambda _: {}, lambda _: "", lambda _: (Conflict("length", "does not fit"),))
    noted = Faults()
    assert chosen(short, {"teeth": 9}, noted) is None
    assert noted.found[0].shown == " = 200 mm (default)"
