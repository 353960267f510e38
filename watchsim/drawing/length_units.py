"""How long is one unit of this drawing?

$INSUNITS says it by a code; the caller may say it by a name.
"""

from __future__ import annotations

from watchsim.units import LENGTH, UnitError, known_unit

FOOT, SURVEY_FOOT = 0.3048, 1200.0 / 3937.0
INSUNITS: dict[int, tuple[str, float]] = {
    1: ("inch", 0.0254),
    2: ("ft", FOOT),
    3: ("mile", 5280.0 * FOOT),
    4: ("mm", 1e-3),
    5: ("cm", 1e-2),
    6: ("m", 1.0),
    7: ("km", 1e3),
    8: ("microinch", 2.54e-8),
    9: ("mil", 2.54e-5),
    10: ("yard", 3.0 * FOOT),
    11: ("angstrom", 1e-10),
    12: ("nm", 1e-9),
    13: ("µm", 1e-6),
    14: ("dm", 1e-1),
    15: ("dam", 1e1),
    16: ("hm", 1e2),
    17: ("Gm", 1e9),
    18: ("au", 149597870700.0),
    19: ("light-year", 9460730472580800.0),
    20: ("parsec", 3.0856775814913673e16),
    21: ("US survey ft", SURVEY_FOOT),
    22: ("US survey inch", SURVEY_FOOT / 12.0),
    23: ("US survey yard", 3.0 * SURVEY_FOOT),
    24: ("US survey mile", 5280.0 * SURVEY_FOOT),
}


def named_length(name: str) -> tuple[str, float]:
    """The unit of that name as (usual spelling, metres); ValueError where it is not a unit of length."""
    for known, metres in INSUNITS.values():
        if name.strip() == known:
            return known, metres
    try:
        unit = known_unit(name.strip())
    except UnitError:
        raise ValueError(f'"{name}" is not a unit known here. Write "mm" or "inch"') from None
    if unit.powers not in LENGTH.powers:
        raise ValueError(f'"{name}" is not a unit of length. Write "mm" or "inch"')
    usual = {metres: known for known, metres in INSUNITS.values()}
    return usual.get(unit.factor, name.strip()), unit.factor
