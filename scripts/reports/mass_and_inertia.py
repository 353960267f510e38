"""Which numbers and which picture does docs/guide/mass-and-inertia.md show?

    python scripts/reports/mass_and_inertia.py

Writes the tables into the document, between the comments that name them.
"""

import math
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(SCRIPTS), str(SCRIPTS.parent / "tests")]

from draw_profiles import by_hand  # noqa: E402
from reference.measure_lever import moments  # noqa: E402

import watchsim as ws  # noqa: E402
from watchsim.geometry.loops import Loop  # noqa: E402
from watchsim.geometry.meshes import plate  # noqa: E402
from watchsim.geometry.primitives import TURN, Arc, Line  # noqa: E402
from watchsim.geometry.solids import section  # noqa: E402

ROOT = SCRIPTS.parent
DOCUMENT = ROOT / "docs" / "guide" / "mass-and-inertia.md"
SCENE = ROOT / "profiles" / "balance" / "scene.toml"
WHEEL = ROOT / "profiles" / "swiss_lever" / "escape_wheel.dxf"
EXACT = 1e-12
MG_CM2, MG, MM4 = 1e-10, 1e-6, 1e-12


def balance() -> str:
    """Every part of the balance, by hand and by the package."""
    hand = by_hand()
    rows = [
        "| part | formula of the handbook | mass by hand, mg | watchsim | inertia by hand, mg·cm² | watchsim | difference |",
        "|---|---|---|---|---|---|---|",
    ]
    solids = {solid.layer or "HAIRSPRING": solid.weight for solid in ws.load(SCENE).body("balance").solids}
    for name, part in hand.items():
        weight = solids[name]
        mass, inertia = weight.mass / MG, weight.about((0.0, 0.0)) / MG_CM2
        numbers = f"{part.mass:.6g} | {mass:.6g} | {part.inertia / 100:.6g} | {inertia:.6g}"
        rows.append(f"| {name} | {part.formula} | {numbers} | {_difference(inertia, part.inertia / 100)} |")
    total = ws.load(SCENE).body("balance")
    mass, inertia = sum(part.mass for part in hand.values()), sum(part.inertia for part in hand.values()) / 100
    numbers = f"{mass:.6g} | {total.mass / MG:.6g} | {inertia:.6g} | {total.inertia / MG_CM2:.6g}"
    rows.append(f"| **together** | | {numbers} | {_difference(total.inertia / MG_CM2, inertia)} |")
    return "\n".join(rows)


def _difference(value: float, hand: float) -> str:
    relative = value / hand - 1.0
    return "none" if abs(relative) < EXACT else f"{100 * relative:+.2g} %"


def outlines() -> str:
    """Polar moments of plain outlines and of real parts, by closed forms and by quadrature with 30 digits."""
    rows = ["| outline | polar moment about the origin, mm⁴ | compared with | agrees to 1e-12 |", "|---|---|---|---|"]
    for name, loops, formula, exact in shapes():
        found = section(loops).about((0.0, 0.0)).polar
        rows.append(f"| {name} | {found / MM4:.12g} | {formula} | {_agrees(found, exact)} |")
    for name, path in (("escape wheel, 15 club teeth, 4 arms", WHEEL), ("lever with stones", WHEEL.with_name("lever.dxf"))):
        drawn = ws.read(path).loops
        found, exact = section(drawn).about((0.0, 0.0)).polar, float(moments(drawn)[1])
        rows.append(f"| {name} | {found / MM4:.12g} | Green's theorem with 30 digits | {_agrees(found, exact)} |")
    return "\n".join(rows)


def shapes() -> list[tuple[str, list[Loop], str, float]]:
    """Name, outline, formula and its value (m⁴)."""
    r, s, a, side = 2e-3, 1.5e-3, 1.0, 2e-3
    disc, bore = Loop((Arc(0, 0, r, 0.3, TURN),)), Loop((Arc(0, 0, s, 0.1, -TURN),), hole=True)
    beside = disc.moved(0.0, (3e-3, 4e-3))
    sector = Loop((Line(0, 0, r, 0), Arc(0, 0, r, 0, a), Line(r * math.cos(a), r * math.sin(a), 0, 0)))
    corners = [(side * math.cos(TURN * k / 6), side * math.sin(TURN * k / 6)) for k in range(6)]
    hexagon = Loop(tuple(Line(*p, *q) for p, q in zip(corners, corners[1:] + corners[:1], strict=True)))
    return [
        ("disc, r = 2 mm", [disc], "π r⁴ / 2", math.pi * r**4 / 2),
        ("the same, 5 mm away", [beside], "π r⁴ / 2 + π r² d²", math.pi * r**4 / 2 + math.pi * r * r * 25e-6),
        ("ring, 2 mm and 1.5 mm", [disc, bore], "π (R⁴ − r⁴) / 2", math.pi * (r**4 - s**4) / 2),
        ("sector, r = 2 mm, 1 rad", [sector], "α r⁴ / 4", a * r**4 / 4),
        ("hexagon, a = 2 mm", [hexagon], "5 √3 a⁴ / 8", 5 * math.sqrt(3) / 8 * side**4),
    ]


def _agrees(found: float, exact: float) -> str:
    return "yes" if abs(found / exact - 1.0) <= EXACT else f"no: {found / exact - 1.0:.1e}"


def meshes() -> str:
    """How the mesh of the escape wheel comes closer to the closed form as its chords get shorter."""
    loops = ws.read(WHEEL).loops
    exact = section(loops)
    whole = exact.about(exact.centroid).polar * 0.12e-3
    rows = ["| chords within | triangles | inertia too large by | order |", "|---|---|---|---|"]
    before = math.nan
    for deviation in (4e-6, 1e-6, 0.25e-6, 0.0625e-6, 0.015625e-6):
        mesh = plate(loops, 0.0, 0.12e-3, deviation)
        assert mesh is not None
        error = mesh.moment_inertia[2, 2] * 1e-15 / whole - 1.0
        order = "" if math.isnan(before) else f"{math.log(before / error) / math.log(4.0):.2f}"
        rows.append(f"| {1e6 * deviation:g} µm | {len(mesh.faces)} | {error:.2e} | {order} |")
        before = error
    return "\n".join(rows)


TABLES: dict[str, Callable[[], str]] = {"balance": balance, "outlines": outlines, "meshes": meshes}


def filled(text: str, names: Iterable[str] = TABLES) -> str:
    """The document with those tables in their places."""
    for name in names:
        start, end = f"<!-- table {name} -->", f"<!-- end of {name} -->"
        if start not in text or end not in text:
            raise SystemExit(f"{DOCUMENT} has no place for the table {name}")
        block = f"{start}\n{TABLES[name]()}\n{end}"
        before, after = text.split(start, maxsplit=1)[0], text.split(end, 1)[1]
        text = before + block + after
    return text


if __name__ == "__main__":
    from usage import arguments

    arguments(__doc__)
    DOCUMENT.write_text(filled(DOCUMENT.read_text(encoding="utf-8")), encoding="utf-8")
