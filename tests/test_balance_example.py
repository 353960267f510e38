"""Are the numbers of docs/guide/mass-and-inertia.md those of the package, and those of the handbook?"""

import sys
from pathlib import Path

import pytest

import watchsim as ws
from watchsim.mechanism.check import check_report, check_text

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "scripts" / "reports")]

import mass_and_inertia  # noqa: E402
from draw_profiles import Hand, by_hand  # noqa: E402

SCENE = ROOT / "profiles" / "balance" / "scene.toml"
HAND = by_hand()


@pytest.fixture(scope="module")
def balance():
    return ws.load(SCENE).body("balance")


@pytest.mark.parametrize("name", HAND)
def test_every_part_is_as_heavy_as_the_handbook_says(balance, name: str) -> None:
    hand: Hand = HAND[name]
    (weight,) = (solid.weight for solid in balance.solids if (solid.layer or "HAIRSPRING") == name)
    tolerance = 1e-12 if hand.exact else 5e-3
    assert weight.mass == pytest.approx(hand.mass * 1e-6, rel=tolerance, abs=0.0)
    assert weight.about((0.0, 0.0)) == pytest.approx(hand.inertia * 1e-12, rel=tolerance, abs=0.0)


def test_the_document_holds_the_tables_as_they_are_now() -> None:
    text = mass_and_inertia.DOCUMENT.read_text(encoding="utf-8")
    assert mass_and_inertia.filled(text, ("balance", "outlines")) == text
    assert text.count("| yes |") == 7 and "| no:" not in text


def test_the_mesh_of_the_wheel_converges_as_the_document_says() -> None:
    rows = [row.split("|")[3:5] for row in mass_and_inertia.meshes().splitlines()[2:]]
    orders = [float(order) for _, order in rows[1:]]
    assert orders == pytest.approx([1.0] * len(orders), abs=0.06) and float(rows[-1][0]) < 1e-4


def test_the_balance_is_hardly_out_of_poise(balance) -> None:
    scene = ws.load(SCENE).set("scene.gravity", ["0 m/s²", "-9.81 m/s²"])
    text = check_text(check_report(scene, ()), scene)
    assert "111.6 nm beside the pivot: gravity turns it with up to 117.8" in text


def test_it_swings_as_its_inertia_demands() -> None:
    """The scene's own promises, computed from the inertia by hand."""
    from watchsim.analysis.summary import summary

    checked = summary(ws.simulate(ws.load(SCENE)))["expect"]
    assert len(checked) == 2 and all(entry["ok"] for entry in checked), checked
