"""Are surfaces that work together known by their German and French names?"""

from pathlib import Path

import ezdxf
import pytest
from proposal.assemblies import assembly, scene_of

from watchsim.proposal.propose import propose
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


def test_a_duplex_in_german_meets_its_impulse_pallet(tmp_path: Path) -> None:
    """The layer of the impulse teeth is named after their wheel."""
    path = assembly(scene_of("duplex"), tmp_path / "duplex.dxf", "body")
    document = ezdxf.readfile(path)
    for entity in document.modelspace():
        entity.dxf.layer = entity.dxf.layer.replace("wheel", "GANGRAD").replace("balance", "UNRUH")
    document.saveas(path)
    assert ("GANGRAD_IMPULSE", "UNRUH_PALLET") in [
        tuple(side.partition(".")[2] for side in pair) for pair in propose([path]).contacts
    ]


def test_an_arbor_beside_pallets_drawn_without_their_arms_is_their_pivot(tmp_path: Path) -> None:
    path = assembly(scene_of("graham"), tmp_path / "graham.dxf", "body", marks=False, without=("ANCHOR", "ROD", "BOB"))
    document = ezdxf.readfile(path)
    for name, body in (("wheel_WELLE", "wheel"), ("pendulum_WELLE", "pendulum")):
        at = [1e3 * value for value in scene_of("graham").body(body).position]
        document.modelspace().add_circle(at, 0.8, dxfattribs={"layer": name})
    document.saveas(path)
    found = propose([path])
    assert not any("nothing shows about which point" in words for words in found.doubts)
