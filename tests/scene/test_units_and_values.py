"""Is every unit worth what it is worth, and accepted for what it measures and for nothing else?

Factors to SI stand here as decimals, from tables of units; the program has fractions, prefixes and powers.
"""

import copy
import math
from typing import Any

import pytest

from watchsim import units
from watchsim.scene.assign import assign, with_unit
from watchsim.scene.errors import Faults
from watchsim.scene.keys import BODY, key_at, nearest, siblings
from watchsim.scene.keys import TORQUE as TORQUE_of_lengths_of_lists
from watchsim.scene.read_bodies import read_prescribed
from watchsim.scene.read_contacts import repeated, rows_of
from watchsim.scene.toml import parsed
from watchsim.scene.values import Table, shown
from watchsim.units import (
    ANGLE,
    DIMENSIONS,
    NUMBER,
    RATE,
    TIME,
    TORQUE,
    Dimension,
    UnitError,
    known_unit,
    metric,
    parse,
    show,
    split,
    to,
)

DEGREE = 0.017453292519943295
WORTH: dict[Dimension, dict[str, float | None]] = {
    units.NUMBER: {"": 1.0, "%": 0.01, "ppm": 1e-6, "rad/rad": 1.0},
    units.RATE: {"s/s": 1.0, "ppm": 1e-6, "s/d": 1.1574074074074073e-05, "ms/h": 2.7777777777777776e-07, "%": 0.01},
    units.ANGLE: {
        **{"rad": 1.0, "mrad": 1e-3, "°": DEGREE, "rev": 6.283185307179586, "turn": 6.283185307179586, "degrees": DEGREE},
    },
    units.SPIN: {"rad/s": 1.0, "°/s": DEGREE, "rpm": 0.10471975511965977, "rev/min": 0.10471975511965977, "rev·Hz": math.tau},
    units.LENGTH: {
        **{"m": 1.0, "mm": 1e-3, "cm": 1e-2, "dm": 0.1, "km": 1e3, "µm": 1e-6, "nm": 1e-9, "inch": 0.0254, "in": 0.0254},
    },
    units.MASS: {"kg": 1.0, "g": 1e-3, "mg": 1e-6, "µg": 1e-9, "N/(m/s²)": 1.0, "Mg": 1e3},
    units.TIME: {
        **{"s": 1.0, "ms": 1e-3, "µs": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0, "d": 86400.0, "day": 86400.0, "sec": 1.0},
    },
    units.SPEED: {"m/s": 1.0, "mm/s": 1e-3, "km/h": 0.2777777777777778, "inch/min": 0.00042333333333333333},
    units.ACCELERATION: {"m/s²": 1.0, "mm/s²": 1e-3, "N/kg": 1.0, "cm/s^2": 0.01},
    units.PRESSURE: {"Pa": 1.0, "MPa": 1e6, "GPa": 1e9, "kPa": 1e3, "N/mm²": 1e6, "N/m²": 1.0},
    units.DENSITY: {"kg/m³": 1.0, "g/cm³": 1e3, "mg/mm³": 1e3},
    units.INERTIA: {"kg·m²": 1.0, "g·cm²": 1e-7, "mg·cm²": 1e-10, "mg·mm²": 1e-12},
    units.TORQUE: {
        **{"N·m": 1.0, "mN·m": 1e-3, "µN·m": 1e-6, "nN·m": 1e-9, "gf·cm": 9.80665e-05, "J": 1.0, "µJ": 1e-6, "uN m": 1e-6},
        "µNm": 1e-6,
    },
    units.FORCE: {"N": 1.0, "mN": 1e-3, "kN": 1e3, "gf": 0.00980665, "mgf": None, "g·m/s²": 1e-3},
    units.FREQUENCY: {
        **{"Hz": 1.0, "kHz": 1e3, "MHz": 1e6, "vph": 0.0001388888888888889, "bph": 0.0001388888888888889},
        **{"A/h": 0.0001388888888888889, "1/s": None},
    },
    units.ROTARY_STIFFNESS: {"N·m/rad": 1.0, "mN·m/rad": 1e-3, "µN·m/rad": 1e-6, "µN·m/°": 5.729577951308232e-05},
    units.LINEAR_STIFFNESS: {"N/m": 1.0, "N/mm": 1e3, "mN/mm": 1.0},
    units.ROTARY_VISCOUS: {"N·m·s/rad": 1.0, "µN·m·s/rad": 1e-6, "nN·m·s/rad": 1e-9, "N·m·s": 1.0, "kg·m²/s": 1.0},
    units.LINEAR_VISCOUS: {"N·s/m": 1.0, "mN·s/m": 1e-3, "kg/s": 1.0},
    units.ROTARY_QUADRATIC: {"N·m·s²/rad²": 1.0, "µN·m·s²/rad²": 1e-6, "nN·m·s²/rad²": 1e-9, "N·m·s²/rad^2": 1.0},
    units.LINEAR_QUADRATIC: {"N·s²/m²": 1.0, "mN·s²/m²": 1e-3, "kg/m": 1.0},
    units.TRAVEL_PER_TURN: {"m/rad": 1.0, "mm/rev": 1.5915494309189535e-04, "mm/rad": 1e-3, "mm": 1e-3},
    units.ROTARY_CUBIC: {"N·m/rad³": 1.0, "mN·m/rad³": 1e-3, "µN·m/rad^3": 1e-6},
    units.LINEAR_CUBIC: {"N/m³": 1.0, "N/mm³": 1e9, "N/m^3": 1.0},
    units.TEMPERATURE: {"°C": 1.0, "K": 1.0},
    units.PER_KELVIN: {"/K": 1.0, "%/K": 0.01, "ppm/K": 1e-6, "ppm/°C": 1e-6},
    units.PER_LENGTH: {"rad/m": 1.0, "rev/mm": 6283.185307179586, "rad/mm": 1e3},
    units.SPIN_UP: {"rad/s²": 1.0, "°/s²": math.pi / 180.0, "rad/s^2": 1.0},
    units.PER_SPEED: {"s/m": 1.0, "s/mm": 1e3, "ms/mm": 1.0},
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
    assert set(DIMENSIONS) == set(WORTH) and len(DIMENSIONS) == 29
    assert len({kind.name for kind in DIMENSIONS}) == 29


ALIKE = {frozenset((NUMBER, RATE)), frozenset((units.LENGTH, units.TRAVEL_PER_TURN))}  # the mm of a travel per angle


@pytest.mark.parametrize("kind", DIMENSIONS, ids=lambda kind: kind.name)
def test_what_measures_something_else_is_refused(kind: Dimension) -> None:
    for other in DIMENSIONS:
        alike = kind is other or (frozenset((kind, other)) in ALIKE and kind is not units.TRAVEL_PER_TURN)
        for unit in set() if alike else {kind.si, *kind.usual}:
            with pytest.raises(UnitError):
                parse(f"1 {unit}", other)


PREFIXES = {"n": -9, "µ": -6, "u": -6, "m": -3, "c": -2, "d": -1, "k": 3, "M": 6, "G": 9}


@pytest.mark.parametrize("base", ["m", "g", "s", "N", "Nm", "J", "Pa", "Hz", "rad"])
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
        assert unit.powers == (exponent, 0, 0, 0, 0) and unit.factor == pytest.approx(1e-3**exponent, rel=1e-14, abs=0.0)
        turned = known_unit(f"kg·(°·s){text}")
        assert turned.powers == (0, 1, exponent, exponent, 0)
        assert turned.factor == pytest.approx(DEGREE**exponent, rel=1e-14, abs=0.0)


PRODUCTS = {
    **{"m/s/s": (1, 0, -2, 0), "m/(s·s)": (1, 0, -2, 0), "m/s·s": (1, 0, 0, 0), "m s kg": (1, 1, 1, 0), "/s": (0, 0, -1, 0)},
    **{"kg/(m/(s/rad))": (-1, 1, 1, -1), "(m·kg)²/s": (2, 2, -1, 0), "m / s": (1, 0, -1, 0), "m*s": (1, 0, 1, 0)},
    **dict.fromkeys(("m.s", "m⋅s", "m\u00a0s", "m\u202fs", "(m)(s)", "m (s)"), (1, 0, 1, 0)),
}


def test_products_and_quotients() -> None:
    assert {text: known_unit(text).powers[:4] for text in PRODUCTS} == PRODUCTS


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


TRAIN = [{"ratio": 7}, {"ratio": 8, "inertia": "9 g·cm²"}]
MAPPING: dict[str, Any] = {
    "scene": {"title": "old"},
    "bodies": {
        "wheel": {
            "solids": [{"layer": "A"}, {"layer": "B", "turned": [["1 mm", "2 mm"], ["3 mm", "4 mm"]]}],
            "adjust": {"STONES": {"turn": "1°"}, "PINS": [{"turn": "2°"}, {"turn": "3°", "shift": ["5 µm", "6 µm"]}]},
            "polygon": [["1 mm", "2 mm"], ["3 mm", "4 mm"], ["5 mm", "7 mm"]],
        },
        "rack": {"motion": "slide", "axis": [1, 0]},
        "cam": {"motion": "driven", "axis": [1, 0], "swing": {"amplitude": "1 mm"}},
        "arm": {"motion": "driven", "swing": {"amplitude": "1°"}},
        "stone": {"motion": "free"},
    },
    "springs": [
        {"body": "wheel", "frequency": "3 Hz", "rest": "2°"},
        {"body": "rack", "stiffness": "3 N/m", "draw": 5},
        {"body": "wheel", "leaf": {"arm": "2 mm"}},
    ],
    "torques": [
        {"body": "wheel", "over": "barrel", "table": [1], "ratio": 8, "train": TRAIN},
        {"body": "rack", "value": "1 N"},
    ],
    "damping": [{"body": "wheel", "q_factor": 200}],
    "line_springs": [{"between": ["wheel"]}],
    "expect": {"rate": {"value": 5}},
    "lock": {"versions": "1"},
}


def set_to(key: str, value: object) -> tuple[dict[str, Any], list[str]]:
    mapping, faults = copy.deepcopy(MAPPING), Faults()
    assign(mapping, key, value, faults)
    assert {fault.key for fault in faults.found} <= {key}
    assert mapping == MAPPING or not faults.found or "setdefault" in key or "adjust" in key
    return mapping, [fault.message for fault in faults.found]


def at(mapping: Any, path: str) -> Any:
    for step in path.split("."):
        mapping = mapping[int(step) if isinstance(mapping, list) else step]
    return mapping


SET = [  # path, value, what stands there then
    ("scene.title", "new", "new"),
    ("scene.nu", 0.25, 0.25),
    ("scene.gravity.1", -9.5, "-9.5 m/s²"),
    ("run.duration", 3, "3.0 s"),
    ("timegrapher.lift_angle", 0.75, "0.75 rad"),
    ("bodies.wheel.angle", 0.25, "0.25 rad"),
    ("bodies.wheel.velocity", 0.25, "0.25 rad/s"),
    ("bodies.rack.velocity", 0.25, "0.25 m/s"),
    ("bodies.stone.velocity.1", 0.25, "0.25 m/s"),
    ("bodies.cam.swing.amplitude", 0.25, "0.25 m"),
    ("bodies.arm.swing.amplitude", 0.25, "0.25 rad"),
    ("bodies.cam.velocity", 0.25, "0.25 m/s"),
    ("bodies.arm.velocity", 0.25, "0.25 rad/s"),
    ("bodies.wheel.solids.1.density", 8000, "8000.0 kg/m³"),
    ("bodies.wheel.solids.0.layer", "C", "C"),
    ("bodies.wheel.solids.1.turned.1.0", 0.25, "0.25 m"),
    ("bodies.wheel.solids", [3], [3]),
    ("bodies.wheel.solids.1", 3, 3),
    ("bodies.wheel.polygon.2.1", 0.25, "0.25 m"),
    ("bodies.wheel.adjust.STONES.turn", 0.25, "0.25 rad"),
    ("bodies.wheel.adjust.STONES.shift.1", 0.25, "0.25 m"),
    ("bodies.wheel.adjust.NEW.turn", 0.25, "0.25 rad"),
    ("bodies.wheel.adjust.PINS.1.turn", 0.25, "0.25 rad"),
    ("bodies.wheel.adjust.PINS.1.shift.0", 0.25, "0.25 m"),
    ("bodies.wheel.adjust.PINS", [3], [3]),
    ("bodies.rack.adjust.LAYER.along", 0.25, "0.25 m"),
    ("springs.0.rest", 0.25, "0.25 rad"),
    ("springs.1.rest", 0.25, "0.25 m"),
    ("springs.1.stiffness", 2, "2.0 N/m"),
    ("springs.0.stiffness", 2, "2.0 N·m/rad"),
    ("springs.2.leaf.arm", 0.25, "0.25 m"),
    ("springs.2.draw.turns", 7, 7),
    ("line_springs.0.leaf.width", 0.25, "0.25 m"),
    ("line_springs.0.stiffness", 2, "2.0 N/m"),
    ("line_springs.0.between", ["rack", "wheel"], ["rack", "wheel"]),
    ("torques.0.ratio", 9, 9),
    ("torques.0.train.1.inertia", 0.25, "0.25 kg·m²"),
    ("torques.0.train.0.ratio", 0.25, 0.25),
    ("torques.1.value", 0.25, "0.25 N"),
    ("torques.0.value", 0.25, "0.25 N·m"),
    ("damping.0.viscous", 0.25, "0.25 N·m·s/rad"),
    ("expect.rate.tolerance", 3, 3),
    ("bodies.wheel.mass", "5 g", "5 g"),
    ("bodies.wheel.mass", True, True),
]


@pytest.mark.parametrize(("key", "value", "expected"), SET)
def test_the_value_of_that_path_and_no_other_is_changed(key: str, value: object, expected: object) -> None:
    mapping, said = set_to(key, value)
    assert said == [] and at(mapping, key) == expected and type(at(mapping, key)) is type(expected)
    section = key.split(".", maxsplit=1)[0]
    assert {name: one for name, one in mapping.items() if name != section} == {
        name: one for name, one in MAPPING.items() if name != section
    }


def test_a_pair_begins_as_zeros() -> None:
    assert set_to("bodies.rack.position.1", 0.25)[0]["bodies"]["rack"]["position"] == ["0.0 m", "0.25 m"]
    assert set_to("bodies.wheel.axis.0", 0.25)[0]["bodies"]["wheel"]["axis"] == [0.25, 0.0]


@pytest.mark.parametrize(
    ("key", "entry"),
    [
        ("springs.0.stiffness", {"body": "wheel", "rest": "2°", "stiffness": "3"}),
        ("springs.0.preload", {"body": "wheel", "frequency": "3 Hz", "preload": "3"}),
        ("springs.1.rest", {"body": "rack", "stiffness": "3 N/m", "draw": 5, "rest": "3"}),
        ("springs.1.leaf", {"body": "rack", "draw": 5, "leaf": "3"}),
        ("springs.2.frequency", {"body": "wheel", "frequency": "3"}),
        ("torques.0.value", {"body": "wheel", "value": "3"}),
        ("damping.0.viscous", {"body": "wheel", "viscous": "3"}),
    ],
)
def test_what_says_the_same_goes(key: str, entry: dict[str, Any]) -> None:
    section, number, _ = key.split(".")
    assert set_to(key, "3")[0][section][int(number)] == entry


def test_elsewhere_nothing_goes() -> None:
    """An expectation's value has no table."""
    mapping = {"expect": {"a": {"table": 1, "value": 2}}}
    assign(mapping, "expect.a.value", 3, Faults())
    assert mapping == {"expect": {"a": {"table": 1, "value": 3}}}


REFUSED = [
    ("springs.3.rest", "springs has no entry 3: there are 3, counted from 0"),
    ("springs.x.rest", "springs has no entry x: there are 3"),
    ("gears.0.ratio", "gears has no entry 0: there are 0"),
    ("bodies.wheel.solids.2", "bodies.wheel.solids has no entry 2: there are 2"),
    ("bodies.wheel.solids.2.layer", "bodies.wheel.solids has no entry 2: there are 2"),
    ("torques.0.train.2.ratio", "the train has no wheel 2: there are 2, counted from 0"),
    ("torques.1.train.0.ratio", "the train has no wheel 0: there are 0"),
    ("torques.0.train.x.ratio", "the train has no wheel x"),
    ("bodies.wheel.adjust.PINS.2.turn", "no such table under adjust: it has 2 entries, counted from 0"),
    ("bodies.wheel.adjust.PINS.turn", "no such table under adjust: it has 2 entries"),
    ("bodies.wheel.polygon.3.1", "there is no element 3.1 in it"),
    ("bodies.wheel.polygon.2.x", "there is no element 2.x in it"),
    ("bodies.wheel.polygon.2.2", "there is no element 2.2 in it"),
    ("bodies.wheel.polygon.x.1", "there is no element x.1 in it"),
    ("bodies.lever.angle", 'there is no "lever" in bodies. Known here: wheel, rack, cam, arm, stone.'),
    ("bodies.whel.angle", 'Did you mean "wheel"?'),
    ("expect.beats.value", 'there is no "beats" in expect. Known here: rate.'),
    ("duration", 'Did you mean "run.duration"?'),
    ("sprongs.0.rest", 'Did you mean "springs"?'),
    ("springs.0.rost", 'Did you mean "rest"?'),
    ("bodies.cam.swing.amplitud", 'Did you mean "amplitude"?'),
    ("bodies.cam.swing.amplitude.1", "there is no element 1 in it"),
    ("springs.0.draw.turn", 'Did you mean "turns"?'),
    ("springs.2.leaf.wodth", 'Did you mean "width"?'),
    ("line_springs.0.leaf.wodth", 'Did you mean "width"?'),
    ("bodies.wheel.solids.0.densty", 'Did you mean "density"?'),
    ("bodies.wheel.adjust.STONES.trun", 'Did you mean "turn"?'),
    ("bodies.wheel.adjust.PINS.0.trun", 'Did you mean "turn"?'),
    ("bodies.wheel.matreial", 'Did you mean "material"?'),
    ("bodies.wheel.matreial.0.1", 'Did you mean "material"?'),
    ("springs.0.rost.1.2", 'Did you mean "rest"?'),
    ("run.duraton", 'Did you mean "duration"?'),
    ("scene", "Known here: title, schema, gravity, tangential_law, nu."),
    ("springs.0", "Write springs.NUMBER.KEY, the number counted from 0."),
    ("springs", "Write springs.NUMBER.KEY"),
    ("bodies.wheel", "Write bodies.NAME.KEY, with the name of a body."),
    ("bodies", "Write bodies.NAME.KEY"),
    ("expect", "Write expect.amplitude.value and expect.amplitude.tolerance, one by one."),
    ("expect.rate", "Write expect.rate.value and expect.rate.tolerance, one by one."),
    ("lock.versions", "watchsim writes this table; it cannot be changed."),
    ("design.lock", "This scene has no [design]"),
]


@pytest.mark.parametrize(("key", "words"), REFUSED)
def test_a_path_to_nothing_is_refused_with_what_is_near(key: str, words: str) -> None:
    (message,) = set_to(key, 0.25)[1]
    assert words in message


@pytest.mark.parametrize(
    ("value", "dimension", "expected"),
    [
        (3, ANGLE, "3.0 rad"),
        (-0.125, TORQUE, "-0.125 N·m"),
        (3, NUMBER, 3),
        (0.5, None, 0.5),
        (True, ANGLE, True),
        ("3 mm", ANGLE, "3 mm"),
        ([1, (0.5, "x")], ANGLE, ["1.0 rad", ["0.5 rad", "x"]]),
        (None, NUMBER, None),
    ],
)
def test_numbers_get_the_unit_of_their_key(value: object, dimension: Any, expected: object) -> None:
    found = with_unit(value, dimension)
    assert found == expected and type(found) is type(expected)


def test_siblings_are_the_keys_of_the_table_that_was_entered() -> None:
    """Whatever stands beside a known key is a key itself."""
    bodies, springs = ["x", "solids.0.x", "adjust.L.x", "swing.x"], ["x", "draw.x", "leaf.x"]
    paths = [f"bodies.a.{one}" for one in bodies] + [f"springs.0.{one}" for one in springs]
    for text in (*paths, "scene.x", "run.x", "expect.a.x", "gears.0.x", "line_springs.0.leaf.x"):
        path = tuple(text.split("."))
        names = siblings(path)
        assert key_at(path) is None and len(names) > 1 and all(key_at((*path[:-1], name)) for name in names), path
    assert siblings(("bodies", "a", "solids", "0")) == siblings(("bodies", "a", "x"))
    assert siblings(("bodies", "a", "adjust", "L")) == siblings(("bodies", "a", "x"))
    assert siblings(("springs", "0", "draw")) == siblings(("springs", "0", "x"))
    assert "bodies" in siblings(()) and siblings(("nothing",)) == siblings(())


def table(mapping: dict[str, Any], keys: Any = BODY) -> Table:
    return Table(mapping, "here", keys, Faults())


@pytest.mark.parametrize("opening", ["[]", "{}"])
def test_twenty_tables_within_each_other_are_the_most(opening: str) -> None:
    """The whole file is the first, the value within all the last."""
    name, end = ("", "") if opening == "[]" else ("a = ", "")

    def nested(depth: int) -> str:
        return "x = " + (opening[0] + name) * depth + "1" + (opening[1] + end) * depth

    found: Any = parsed(nested(19))["x"]
    for _ in range(19):
        found = found[0] if isinstance(found, list) else found["a"]
    assert found == 1
    with pytest.raises(ValueError, match="more than 20 deep"):
        parsed(nested(20))


@pytest.mark.parametrize(("length", "cut"), [(57, False), (58, False), (59, True), (70, True)])
def test_of_a_long_value_the_beginning_is_shown(length: int, cut: bool) -> None:
    """With the quotes sixty characters at most, three of them points where some are left out."""
    text = "".join(chr(97 + k % 26) for k in range(length))
    whole = f' = "{text}"'
    assert shown(text) == (f"{whole[:60]}..." if cut else whole)
    assert len(shown(text)) <= len(" = ") + 60


def test_what_toml_cannot_hold_is_shown_as_python_does() -> None:
    assert shown({"a": None}) == " = {'a': None}"


@pytest.mark.parametrize(("points", "taken"), [(0, False), (1, True), (2000, True), (2001, False)])
def test_a_path_has_one_to_two_thousand_points(points: int, taken: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    given: list[Any] = []
    monkeypatch.setattr("watchsim.scene.read_bodies.path", given.append)
    one = table({"motion": "driven", "path": [[f"{k + 1} s", f"{3 * k + 2} rad"] for k in range(points)]})
    read_prescribed(one, 0.25)
    assert [fault.key for fault in one.faults.found] == ([] if taken else ["here.path"])
    assert given == ([[(0.0, 0.0), *((k + 1.0, 3.0 * k + 2.0) for k in range(points))]] if taken else [])


@pytest.mark.parametrize(
    ("points", "faults"),
    [
        ([["0 s", "1 rad"]], ["path.0.0"]),
        ([["1 s", "1 rad"], ["1 s", "2 rad"]], ["path.1.0"]),
        ([["2 s", "1 rad"], ["1 s", "2 rad"], ["1.5 s", "3 rad"]], ["path.1.0", "path.2.0"]),
        ([["1 s", "1 rad", "2 rad"]], ["path.0"]),
        ([["1 s"]], ["path.0"]),
        ([["1 s", "2 mm"], ["2 s", "1 rad"]], ["path.0.1"]),
        ("1 s", ["path"]),
    ],
)
def test_times_of_a_path_ascend_from_the_start(points: Any, faults: list[str]) -> None:
    """After a fault nothing moves."""
    one = table({"motion": "driven", "path": points})
    found = read_prescribed(one, 0.25)
    assert [fault.key for fault in one.faults.found] == [f"here.{key}" for key in faults]
    assert found is not None and found.law.table == () and found.velocity == 0.0


LAWS: dict[str, Any] = {
    "velocity": "3 rad/s",
    "swing": {"amplitude": "0.5 rad", "frequency": "2 Hz"},
    "path": [["1 s", "2 rad"]],
}


@pytest.mark.parametrize(
    ("laws", "key"),
    [
        ((), "here"),
        (("velocity", "swing"), "here.swing"),
        (("path", "velocity"), "here.path"),
        (("swing", "path"), "here.path"),
        (("velocity", "swing", "path"), "here.swing"),
    ],
)
def test_a_driven_body_has_one_law(laws: tuple[str, ...], key: str) -> None:
    one = table({"motion": "driven", **{law: LAWS[law] for law in laws}})
    read_prescribed(one, 0.25)
    assert [fault.key for fault in one.faults.found] == [key]
    for law, value in LAWS.items():
        alone = table({"motion": "driven", law: value})
        found = read_prescribed(alone, 0.25)
        assert not alone.faults.found and found is not None
        assert found.velocity == pytest.approx({"velocity": 3.0, "swing": 2.0 * math.pi, "path": 0.0}[law])
        idle = table({law: value})
        idle.note_motion("pivot")
        assert read_prescribed(idle, 0.25) is None and len(idle.faults.found) == (law != "velocity")


@pytest.mark.parametrize(
    ("inner", "faults"),
    [
        ({"amplitude": "0.5 rad"}, ["swing"]),
        ({"frequency": "2 Hz"}, ["swing"]),
        ({}, ["swing"]),
        (3, ["swing"]),
        ({"amplitude": "0.5 rad", "frequency": "0 Hz"}, ["swing.frequency"]),
        ({"amplitude": "0.5 mm", "frequency": "2 Hz"}, ["swing.amplitude"]),
        ({"amplitude": "0.5 rad", "frequency": "2 Hz", "phase": "1 s"}, ["swing.phase"]),
    ],
)
def test_a_swing_says_how_far_and_how_often(inner: Any, faults: list[str]) -> None:
    """After a fault it stands."""
    one = table({"motion": "driven", "swing": inner})
    found = read_prescribed(one, 0.25)
    assert [fault.key for fault in one.faults.found] == [f"here.{key}" for key in faults]
    assert found is not None and (found.law.square, found.velocity) == (0.0, 0.0)


@pytest.mark.parametrize(("phase", "middle", "speed"), [("0 rad", 0.25, 2.0 * math.pi), ("30°", 0.0, math.sqrt(3.0) * math.pi)])
def test_a_swing_begins_where_the_body_stands(phase: str, middle: float, speed: float) -> None:
    one = table({"motion": "driven", "swing": {"amplitude": "0.5 rad", "frequency": "2 Hz", "phase": phase}})
    found = read_prescribed(one, 0.25)
    assert found is not None and found.law.middle == pytest.approx(middle, abs=1e-15)
    assert (found.law.square, found.velocity) == pytest.approx((16.0 * math.pi**2, speed))


@pytest.mark.parametrize(
    ("rows", "faults"),
    [
        ([["1 s", "3 N·m"], ["4 s", "5 N·m"], ["6 s", "-2 N·m"]], []),
        ([["1 s", "3 N·m"]], ["table"]),
        ([["1 s", "3 N·m"], ["4 s", "5 N·m"], ["4 s", "6 N·m"]], ["table.2"]),
        ([["4 s", "3 N·m"], ["1 s", "5 N·m"], ["2 s", "6 N·m"]], ["table.1"]),
        ([["1 s", "3 N·m"], ["4 s", "5 N·m", "6 N·m"]], ["table.1"]),
        ([["1 s", "3 N·m"], ["4 s", "5 mm"]], ["table.1.1"]),
        ([["1 s", "3 N·m"], ["4 N·m", "5 N·m"]], ["table.1.0"]),
        ("1 s", ["table"]),
    ],
)
def test_rows_of_a_table_ascend(rows: Any, faults: list[str]) -> None:
    one = table({"table": rows}, TORQUE_of_lengths_of_lists)
    found = rows_of(one, TIME)
    assert [fault.key for fault in one.faults.found] == [f"here.{key}" for key in faults]
    if not faults:
        assert found == ((1.0, 3.0), (4.0, 5.0), (6.0, -2.0))


@pytest.mark.parametrize(("period", "taken"), [("5.01 s", True), ("5 s", False), ("4.99 s", False)])
def test_a_table_repeats_after_more_than_its_length(period: str, taken: bool) -> None:
    one = table({"period": period}, TORQUE_of_lengths_of_lists)
    rows, seconds = repeated(one, ((2.0, 11.0), (3.0, 13.0), (7.0, 17.0)))
    assert bool(one.faults.found) is not taken
    assert rows == ((2.0, 11.0), (3.0, 13.0), (7.0, 17.0), (2.0 + seconds, 11.0)) and f"{seconds:g} s" == period
    assert repeated(one, ())[0] == ()


@pytest.mark.parametrize(
    ("word", "known", "said"),
    [
        ("abcdefg", ["abcdexy", "xyz"], 'Did you mean "abcdexy"?'),  # 10 of 14 letters: 0.71
        ("abcdefg", ["abcxyzw", "xyz"], "Known here: abcxyzw, xyz."),  # 6 of 14
        ("abcdefghi", ["abcdefxyz"], "Known here: abcdefxyz."),  # 12 of 18: 0.67
        ("LEVER", ["levee", "lever"], 'Did you mean "lever"?'),
        ("leveR", ["levex", "lever"], 'Did you mean "lever"?'),
        ("any", [], ""),
    ],
)
def test_the_nearest_word_shares_seven_letters_in_ten(word: str, known: list[str], said: str) -> None:
    assert nearest(word, known) == said
