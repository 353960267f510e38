"""Is every unit worth what it is worth, and accepted for what it measures and for nothing else?

Factors to SI stand here as decimals, from tables of units; the program has fractions, prefixes and powers.
"""

from __future__ import annotations

import math

import pytest

from watchsim import units
from watchsim.units import DIMENSIONS, NUMBER, RATE, Dimension, UnitError, known_unit, metric, parse, show, split, to

DEGREE = 0.017453292519943295
WORTH: dict[Dimension, dict[str, float | None]] = {
    units.NUMBER: {"": 1.0, "%": 0.01, "ppm": 1e-6, "rad/rad": 1.0},
    units.RATE: {"s/s": 1.0, "ppm": 1e-6, "s/d": 1.1574074074074073e-05, "ms/h": 2.7777777777777776e-07, "%": 0.01},
    units.ANGLE: {
        "rad": 1.0,
        "mrad": 1e-3,
        "°": DEGREE,
        "rev": 6.283185307179586,
        "turn": 6.283185307179586,
        "degrees": DEGREE,
    },
    units.SPIN: {"rad/s": 1.0, "°/s": DEGREE, "rpm": 0.10471975511965977, "rev/min": 0.10471975511965977, "rev·Hz": math.tau},
    units.LENGTH: {
        "m": 1.0,
        "mm": 1e-3,
        "cm": 1e-2,
        "dm": 0.1,
        "km": 1e3,
        "µm": 1e-6,
        "nm": 1e-9,
        "inch": 0.0254,
        "in": 0.0254,
    },
    units.MASS: {"kg": 1.0, "g": 1e-3, "mg": 1e-6, "µg": 1e-9, "N/(m/s²)": 1.0, "Mg": 1e3},
    units.TIME: {
        "s": 1.0,
        "ms": 1e-3,
        "µs": 1e-6,
        "ns": 1e-9,
        "min": 60.0,
        "h": 3600.0,
        "d": 86400.0,
        "day": 86400.0,
        "sec": 1.0,
    },
    units.SPEED: {"m/s": 1.0, "mm/s": 1e-3, "km/h": 0.2777777777777778, "inch/min": 0.00042333333333333333},
    units.ACCELERATION: {"m/s²": 1.0, "mm/s²": 1e-3, "N/kg": 1.0, "cm/s^2": 0.01},
    units.PRESSURE: {"Pa": 1.0, "MPa": 1e6, "GPa": 1e9, "kPa": 1e3, "N/mm²": 1e6, "N/m²": 1.0},
    units.DENSITY: {"kg/m³": 1.0, "g/cm³": 1e3, "mg/mm³": 1e3},
    units.INERTIA: {"kg·m²": 1.0, "g·cm²": 1e-7, "mg·cm²": 1e-10, "mg·mm²": 1e-12},
    units.TORQUE: {
        "N·m": 1.0,
        "mN·m": 1e-3,
        "µN·m": 1e-6,
        "nN·m": 1e-9,
        "gf·cm": 9.80665e-05,
        "J": 1.0,
        "µJ": 1e-6,
        "uN m": 1e-6,
    },
    units.FORCE: {"N": 1.0, "mN": 1e-3, "kN": 1e3, "gf": 0.00980665, "mgf": None, "g·m/s²": 1e-3},
    units.FREQUENCY: {
        "Hz": 1.0,
        "kHz": 1e3,
        "MHz": 1e6,
        "vph": 0.0001388888888888889,
        "bph": 0.0001388888888888889,
        "1/s": None,
    },
    units.ROTARY_STIFFNESS: {"N·m/rad": 1.0, "mN·m/rad": 1e-3, "µN·m/rad": 1e-6, "µN·m/°": 5.729577951308232e-05},
    units.LINEAR_STIFFNESS: {"N/m": 1.0, "N/mm": 1e3, "mN/mm": 1.0},
    units.ROTARY_VISCOUS: {"N·m·s/rad": 1.0, "µN·m·s/rad": 1e-6, "nN·m·s/rad": 1e-9, "N·m·s": 1.0, "kg·m²/s": 1.0},
    units.LINEAR_VISCOUS: {"N·s/m": 1.0, "mN·s/m": 1e-3, "kg/s": 1.0},
    units.ROTARY_QUADRATIC: {"N·m·s²/rad²": 1.0, "µN·m·s²/rad²": 1e-6, "nN·m·s²/rad²": 1e-9, "N·m·s²/rad^2": 1.0},
    units.LINEAR_QUADRATIC: {"N·s²/m²": 1.0, "mN·s²/m²": 1e-3, "kg/m": 1.0},
    units.TRAVEL_PER_TURN: {"m/rad": 1.0, "mm/rev": 1.5915494309189535e-04, "mm/rad": 1e-3, "mm": 1e-3},
    units.PER_LENGTH: {"rad/m": 1.0, "rev/mm": 6283.185307179586, "rad/mm": 1e3},
}


@pytest.mark.parametrize("kind", WORTH, ids=lambda kind: kind.name)
def test_what_a_unit_is_worth(kind: Dimension) -> None:
    for unit, worth in WORTH[kind].items():
        if worth is None:
            with pytest.raises(UnitError, match="is not a unit known here"):
                parse(f"3 {unit}", kind)
            continue
        assert parse(f"3 {unit}", kind) == pytest.approx(3.0 * worth, rel=1e-15, abs=0.0)
        assert to(3.0 * worth, unit) == pytest.approx(3.0, rel=1e-15, abs=0.0)


def test_every_kind_of_quantity_is_listed() -> None:
    assert set(DIMENSIONS) == set(WORTH) and len(DIMENSIONS) == 23
    assert len({kind.name for kind in DIMENSIONS}) == 23


ALIKE = {frozenset((NUMBER, RATE)), frozenset((units.LENGTH, units.TRAVEL_PER_TURN))}  # the mm of a travel per angle


@pytest.mark.parametrize("kind", DIMENSIONS, ids=lambda kind: kind.name)
def test_what_measures_something_else_is_refused(kind: Dimension) -> None:
    for other in DIMENSIONS:
        alike = kind is other or (frozenset((kind, other)) in ALIKE and kind is not units.TRAVEL_PER_TURN)
        for unit in set() if alike else {kind.si, *kind.usual}:
            with pytest.raises(UnitError):
                parse(f"1 {unit}", other)


PREFIXES = {"n": -9, "µ": -6, "u": -6, "m": -3, "c": -2, "d": -1, "k": 3, "M": 6, "G": 9}


@pytest.mark.parametrize("base", ["m", "g", "s", "N", "J", "Pa", "Hz", "rad"])
def test_prefixes(base: str) -> None:
    whole = known_unit(base)
    for prefix, power in PREFIXES.items():
        part = known_unit(prefix + base)
        assert part.powers == whole.powers and part.factor / whole.factor == pytest.approx(10.0**power, rel=1e-15, abs=0.0)


@pytest.mark.parametrize("name", ["min", "h", "d", "vph", "rpm", "rev", "inch", "ppm", "gf", "°", "%"])
def test_others_take_none(name: str) -> None:
    with pytest.raises(UnitError):
        known_unit("m" + name)


EXPONENTS = {"2": 2, "²": 2, "^2": 2, "**2": 2, "3": 3, "³": 3, "^-1": -1, "-1": -1, "⁻¹": -1, "⁻²": -2, "−2": -2, "^0": 0}
EXPONENTS |= {"⁴": 4, "⁵": 5, "⁶": 6, "⁷": 7, "⁸": 8, "⁹": 9, "¹": 1, "⁰": 0}


def test_exponents() -> None:
    for text, exponent in EXPONENTS.items():
        unit = known_unit(f"mm{text}")
        assert unit.powers == (exponent, 0, 0, 0) and unit.factor == pytest.approx(1e-3**exponent, rel=1e-14, abs=0.0)
        turned = known_unit(f"kg·(°·s){text}")
        assert turned.powers == (0, 1, exponent, exponent)
        assert turned.factor == pytest.approx(DEGREE**exponent, rel=1e-14, abs=0.0)


PRODUCTS = {
    **{"m/s/s": (1, 0, -2, 0), "m/(s·s)": (1, 0, -2, 0), "m/s·s": (1, 0, 0, 0), "m s kg": (1, 1, 1, 0), "/s": (0, 0, -1, 0)},
    **{"kg/(m/(s/rad))": (-1, 1, 1, -1), "(m·kg)²/s": (2, 2, -1, 0), "m / s": (1, 0, -1, 0), "m*s": (1, 0, 1, 0)},
    **dict.fromkeys(("m.s", "m⋅s", "m\u00a0s", "m\u202fs", "(m)(s)", "m (s)"), (1, 0, 1, 0)),
}


def test_products_and_quotients() -> None:
    assert {text: known_unit(text).powers for text in PRODUCTS} == PRODUCTS


def test_what_is_no_unit() -> None:
    for text in ("m//s", "m·/s", "m·", "m/", "(m", "m)", "()m)", "m^", "x", "m^x", "·", "m/)", "1/s", "mm µ", "k", "1"):
        with pytest.raises(UnitError, match="is not a unit known here"):
            known_unit(text)


SHOWN = {
    **{3.71e-6: "3.71 µm", 999.4: "999.4 m", 1000.0: "1 km", 1.0: "1 m", 0.9994: "999.4 mm", 0.0: "0 m", -2.5e-9: "-2.5 nm"},
    **{4.5e-12: "4.5 pm", 4.5e-14: "0.045 pm", 2e6: "2 Mm", 3e9: "3 Gm", 5e12: "5000 Gm", 999.9996: "1 km", 1e-3: "1 mm"},
}


def test_prefixes_for_people() -> None:
    assert {value: metric(value, "m") for value in SHOWN} == SHOWN


def test_digits_for_people() -> None:
    assert [metric(1.23456e-3, "s", digits) for digits in (2, 3, 4)] == ["1.2 ms", "1.23 ms", "1.235 ms"]
    assert [show(1.23456e-3, "mm", digits) for digits in (2, 4)] == ["1.2 mm", "1.235 mm"]
    assert show(1.2345678, "m") == "1.23457 m" and metric(1.2345678, "m") == "1.23457 m"
    assert (show(0.5, ""), show(0.5, "%"), show(math.pi, "°"), show(1.0, "rev")) == ("0.5", "50%", "180°", "0.159155 rev")


@pytest.mark.parametrize(("number", "unit"), [("999", "Hz"), ("-999.5", "Hz"), ("1000", "vph"), ("-1001", "vph"), ("0", "Hz")])
def test_nobody_builds_a_watch_of_four_vibrations_an_hour(number: str, unit: str) -> None:
    with pytest.raises(UnitError, match=f'Write "{number} {unit}"'):
        parse(number, units.FREQUENCY)


def test_numbers_as_text() -> None:
    assert split(" -1.5e3mm ") == ("-1.5e3", "mm") and split(".5\u00a0s") == (".5", "s") and split("−2 s") == ("-2", "s")
    assert (
        split(3) == ("3", "") and split(2.5) == ("2.5", "") and split("-0.0 s") == ("0", "s") and split("0e5 s") == ("0", "s")
    )
    assert split("9" * 300 + " m")[0] == "9" * 300
    assert split("0." + "1" * 998 + " m")[0] == "0." + "1" * 998  # a thousand characters
    with pytest.raises(UnitError, match="a number of 1001 characters has more digits"):
        split("0." + "1" * 999 + " m")
    for text in ("1,5 mm", "1'500 mm", "1’500 mm", "1_500 mm"):
        with pytest.raises(UnitError, match="decimal point and without separators"):
            split(text)


@pytest.mark.parametrize(
    ("value", "what"), [(True, "true or false"), ([1], "a list"), ((1,), "a list"), ({}, "a table"), (None, "this")]
)
@pytest.mark.parametrize("kind", [NUMBER, units.LENGTH])
def test_what_is_no_number_at_all(value: object, what: str, kind: Dimension) -> None:
    with pytest.raises(UnitError, match=f"is needed here, not {what}"):
        parse(value, kind)


@pytest.mark.parametrize("text", ["9e299 m", "9e302 mm", "1e308 nm"])
def test_what_doubles_can_hold_is_read(text: str) -> None:
    """Up to ten to the 300th."""
    number, unit = text.split()
    assert parse(text, units.LENGTH) == pytest.approx(float(number) * {"m": 1.0, "mm": 1e-3, "nm": 1e-9}[unit], rel=1e-15)
    with pytest.raises(UnitError, match="is not a finite number in m"):
        parse("1.1e300 m", units.LENGTH)


@pytest.mark.parametrize(
    ("kind", "words"),
    [(units.ANGLE, "57.3"), (units.FREQUENCY, "7200"), (units.LENGTH, "25.4"), (units.PRESSURE, "1000"), (RATE, "11.57")],
)
def test_by_how_much_two_units_differ(kind: Dimension, words: str) -> None:
    """Whichever is the larger."""
    with pytest.raises(UnitError, match=f"differ by a factor of {words}. Write"):
        parse(5, kind)


@pytest.mark.parametrize(
    ("unit", "word"), [("N·m", "is a torque"), ("kg·m²", "is an inertia"), ("kg⁵", "has a unit that does not fit")]
)
def test_what_was_given_is_named(unit: str, word: str) -> None:
    with pytest.raises(UnitError, match=f'"2 {unit}" {word}; here a length is needed. Write e.g. "1 mm"'):
        parse(f"2 {unit}", units.LENGTH)
    with pytest.raises(UnitError, match=r"is a length; here a plain number is needed, without a unit$"):
        parse("1 mm", NUMBER)
