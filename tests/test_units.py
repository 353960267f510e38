"""Do quantities mean what people write, and is everything ambiguous refused?"""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from watchsim import units
from watchsim.units import UnitError, metric, parse, show, to

USUAL = [
    ("12 mg·cm²", units.INERTIA, 1.2e-9),
    ("12 mg*cm^2", units.INERTIA, 1.2e-9),
    ("12 mg.cm2", units.INERTIA, 1.2e-9),
    ("12mg cm**2", units.INERTIA, 1.2e-9),
    ("28800 vph", units.FREQUENCY, 4.0),
    ("21600 vph", units.FREQUENCY, 3.0),
    ("4 Hz", units.FREQUENCY, 4.0),
    ("0.758 µN·m/rad", units.ROTARY_STIFFNESS, 7.58e-7),
    ("0.758 \u03bcN⋅m/rad", units.ROTARY_STIFFNESS, 7.58e-7),
    ("0.758 uN.m/rad", units.ROTARY_STIFFNESS, 7.58e-7),
    ("9.81 m/s²", units.ACCELERATION, 9.81),
    ("9.81 m·s⁻²", units.ACCELERATION, 9.81),
    ("9.81 m/s/s", units.ACCELERATION, 9.81),
    ("-270°", units.ANGLE, -1.5 * math.pi),
    ("−270 deg", units.ANGLE, -1.5 * math.pi),
    ("1 rev", units.ANGLE, 2.0 * math.pi),
    ("4.7 rad", units.ANGLE, 4.7),
    ("300 rpm", units.SPIN, 10.0 * math.pi),
    ("0 °/s", units.SPIN, 0.0),
    ("5 s", units.TIME, 5.0),
    ("2 min", units.TIME, 120.0),
    ("0.12 mm", units.LENGTH, 0.00012),
    ("25 µm", units.LENGTH, 25e-6),
    ("1 inch", units.LENGTH, 0.0254),
    ("7.85 g/cm³", units.DENSITY, 7850.0),
    ("1.0 µN·m·s/rad", units.ROTARY_VISCOUS, 1e-6),
    ("1.0 µN·m·s", units.ROTARY_VISCOUS, 1e-6),
    ("1.0 µN·m/(rad/s)", units.ROTARY_VISCOUS, 1e-6),
    ("2 nN·m·s²/rad²", units.ROTARY_QUADRATIC, 2e-9),
    ("-1.0 µN·m", units.TORQUE, -1e-6),
    ("3 mN", units.FORCE, 3e-3),
    ("2 N/mm", units.LINEAR_STIFFNESS, 2000.0),
    ("86.4 s/d", units.RATE, 0.001),
    ("12 ppm", units.RATE, 12e-6),
    ("12 %", units.NUMBER, 0.12),
    ("0.12", units.NUMBER, 0.12),
    (0.12, units.NUMBER, 0.12),
]


@pytest.mark.parametrize(("text", "dimension", "expected"), USUAL)
def test_usual_spellings(text, dimension, expected):
    assert parse(text, dimension) == pytest.approx(expected, rel=4e-16, abs=0.0)


def test_results_are_rounded_once():
    assert parse("0.12 mm", units.LENGTH) == 0.00012
    assert parse("12 mg·cm²", units.INERTIA) == 1.2e-9
    assert parse("28800 vph", units.FREQUENCY) == 4.0
    assert parse("0.01599787 mm", units.LENGTH) == 0.00001599787


REFUSED = [
    (
        28800,
        units.FREQUENCY,
        'a bare number needs a unit here: 28800 Hz and 28800 vph differ by a factor of 7200. Write "28800 vph"',
    ),
    (4, units.FREQUENCY, 'Write "4 Hz"'),
    ("0.3", units.LENGTH, 'Write "0.3 mm"'),
    (-270, units.ANGLE, "-270 rad and -270° differ by a factor of 57.3"),
    (0, units.TORQUE, "needs a unit"),
    (5, units.RATE, 'Write "5 s/d"'),
    ("12 mm", units.INERTIA, '"12 mm" is a length; here an inertia is needed'),
    ("1 N·m", units.ROTARY_STIFFNESS, "is a torque; here a rotary stiffness is needed"),
    ("4 Hz", units.SPIN, "is a frequency; here an angular velocity is needed"),
    ("1 rad/s", units.FREQUENCY, "is an angular velocity; here a frequency is needed"),
    ("0.1 mm", units.NUMBER, "is a length; here a plain number is needed"),
    ("12 mgcm2", units.INERTIA, '"mgcm2" is not a unit known here. Write e.g. "1 mg·cm²"'),
    ("5 m/", units.LENGTH, "not a unit"),
    ("5 (m", units.LENGTH, "not a unit"),
    ("5 m)", units.LENGTH, "not a unit"),
    ("5 m··s", units.LENGTH, "not a unit"),
    ("5 kg/s/s/s", units.LENGTH, "has a unit that does not fit"),
    ("28,800 vph", units.FREQUENCY, "with a decimal point and without separators"),
    ("28'800 vph", units.FREQUENCY, "with a decimal point and without separators"),
    ("nan s", units.TIME, "does not begin with a number"),
    ("fast", units.TIME, "does not begin with a number"),
    ("", units.TIME, "does not begin with a number"),
    ("1e400 s", units.TIME, "not a finite number"),
    ("1e305 km", units.LENGTH, "not a finite number"),
    ("1e308 km", units.LENGTH, "not a finite number"),
    (math.inf, units.NUMBER, "not a finite number"),
    (math.nan, units.NUMBER, "not a finite number"),
    (True, units.NUMBER, "not true or false"),
    (["1 mm"], units.LENGTH, "not a list"),
    (None, units.LENGTH, "a number with its unit is needed"),
]


@pytest.mark.parametrize(("value", "dimension", "message"), REFUSED)
def test_refusals_say_what_to_write(value, dimension, message):
    with pytest.raises(UnitError) as caught:
        parse(value, dimension)
    assert message in str(caught.value)


def test_every_dimension_reads_its_own_units():
    for dimension in units.DIMENSIONS:
        for unit in (dimension.si, *dimension.usual):
            assert units.known_unit(unit).powers in dimension.powers, (dimension.name, unit)


@pytest.mark.parametrize("dimension", units.DIMENSIONS, ids=lambda dimension: dimension.name)
@given(st.floats(min_value=-1e12, max_value=1e12, allow_nan=False))
def test_si_spelling_is_exact(dimension, value):
    assert parse(f"{value!r} {dimension.si}", dimension) == value


@given(
    st.floats(min_value=1e-9, max_value=1e9),
    st.sampled_from([(dimension, unit) for dimension in units.DIMENSIONS for unit in dimension.usual]),
)
def test_shown_values_read_back(value, dimension_unit):
    dimension, unit = dimension_unit
    text = show(value, unit, digits=17)
    assert parse(text, dimension) == pytest.approx(value, rel=1e-14)
    assert to(value, unit) * units.known_unit(unit).factor == pytest.approx(value, rel=1e-14)


@given(st.text(max_size=12))
def test_any_text_is_read_or_refused(text):
    try:
        assert math.isfinite(parse(text, units.LENGTH))
    except UnitError as refusal:
        assert str(refusal)


def test_shown_for_people():
    assert show(0.00012, "mm") == "0.12 mm"
    assert show(-1.5 * math.pi, "°") == "-270°"
    assert show(4.0, "vph") == "28800 vph"


def test_a_number_that_is_rounded_up_to_a_thousand_takes_the_next_prefix() -> None:
    assert [metric(value, "m") for value in (0.9999999, -999.9999999, 0.99999)] == ["1 m", "-1 km", "999.99 mm"]


@pytest.mark.parametrize("power", range(-14, 14))
@pytest.mark.parametrize("digits", [1.0, -3.7, 9.96])
def test_the_prefix_leaves_one_to_three_digits_before_the_point(power: int, digits: float) -> None:
    """In every decade that has a prefix; beyond the last ones there are more, or none."""
    text, unit = metric(float(f"{digits}e{power}"), "m").split()
    prefix = unit.removesuffix("m")
    worth = {"p": -12, "n": -9, "µ": -6, "m": -3, "": 0, "k": 3, "M": 6, "G": 9}[prefix]
    assert float(text) * 10.0**worth == pytest.approx(digits * 10.0**power, rel=1e-5, abs=0.0)
    assert 1.0 <= abs(float(text)) < 1000.0 or power < -12 or power > 11


@pytest.mark.parametrize("value", [True, False, [3.5], {}, None])
def test_what_is_no_plain_number_is_called_so(value: object) -> None:
    with pytest.raises(UnitError, match="a plain number is needed here, not"):
        parse(value, units.NUMBER)


@pytest.mark.parametrize("text", ["-1e308 km", "1e308 km", "-1.1e300 m"])
def test_what_doubles_cannot_hold_is_refused_of_either_sign(text: str) -> None:
    with pytest.raises(UnitError, match="is not a finite number in m"):
        parse(text, units.LENGTH)


@given(st.floats(1e-14, 1e12), st.sampled_from(["N·m", "N", "N·m·s/rad", "J", "N·m/rad"]))
def test_what_is_written_is_read(value: float, unit: str) -> None:
    """120.64 pN·m·s/rad stood in a table of sensitivities, whose file could then not be written."""
    number, written = units.split(units.metric(value, unit))
    assert float(number) * units.known_unit(written).factor == pytest.approx(value, rel=1e-5)
