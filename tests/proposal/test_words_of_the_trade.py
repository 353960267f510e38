"""Are surfaces that work together known by their German and French names?"""

import pytest

from watchsim.proposal.words import LEVER, OSCILLATOR, facing_by_name, part_of


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("STEIGRAD_ZÄHNE", "ANKER_HEBESTEINE"),
        ("Zähne", "Klauen"),
        ("Anker Messer", "Unruh Sicherheitsrolle"),
        ("ANCRE_DARD", "BALANCIER_PETIT_PLATEAU"),
        ("dents", "levées"),
        ("Gabel", "Hebelstein"),
    ],
)
def test_surfaces_that_face_each_other(first: str, second: str) -> None:
    assert facing_by_name(first, second) is not None
    assert facing_by_name(second, first) == facing_by_name(first, second)


@pytest.mark.parametrize(
    ("name", "part"),
    [("Hebesteine", LEVER), ("levées", LEVER), ("dard", LEVER), ("Rolle", OSCILLATOR), ("plateau", OSCILLATOR)],
)
def test_a_feature_hints_at_its_part(name: str, part: str) -> None:
    assert part_of(name) == part
