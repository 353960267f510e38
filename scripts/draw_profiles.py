"""The drawings of the profiles that are made by a program: DXF, lines, arcs and circles on named layers, in millimetres.

    python scripts/draw_profiles.py swiss_lever|coaxial|bench_lever|balance [folder]

The scenes (profiles/NAME/scene.toml) are written by hand; tests/reference/measure_lever.py measures what was drawn.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from watchsim.construction.coaxial import Coaxial
from watchsim.construction.coaxial import sheets as coaxial_sheets
from watchsim.construction.outline import angle_of, arc_between, circle, polar, turned
from watchsim.construction.swiss_lever import sheets
from watchsim.construction.swiss_lever_outlines import Swiss
from watchsim.drawing.write import Sheet, add_circle, add_edge, add_loop, add_polygon, new_sheet, write
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line, Point

ROOT = Path(__file__).resolve().parents[1]


def swiss_lever(folder: Path) -> None:
    _sheets(folder, sheets(Swiss()))


def coaxial(folder: Path) -> None:
    _sheets(folder, coaxial_sheets(Coaxial()))


def _sheets(folder: Path, made: Mapping[str, Sheet]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, sheet in made.items():
        (folder / f"{name}.dxf").write_bytes(sheet.dxf())


TEETH = (
    ((2.5, 0.0), (1.826397222, 0.523710976), (1.881509331, 0.264428892)),
    ((2.283863644, 1.016841608), (1.455484442, 1.221296458), (1.611291383, 1.006846602)),
    ((1.672826516, 1.857862064), (0.832905179, 1.707708688), (1.062466517, 1.575171388)),
    ((0.772542486, 2.377641291), (0.066309044, 1.898842571), (0.329931538, 1.871134731)),
    ((-0.261321158, 2.486304738), (-0.711752527, 1.761649324), (-0.459651602, 1.84356188)),
    ((-1.25, 2.165063509), (-1.366745621, 1.319850904), (-1.169756803, 1.497220432)),
    ((-2.022542486, 1.469463131), (-1.785415979, 0.649838272), (-1.677600426, 0.891995969)),
    ((-2.445369002, 0.519779227), (-1.895371695, -0.1325373), (-1.895371695, 0.1325373)),
    ((-2.445369002, -0.519779227), (-1.677600426, -0.891995969), (-1.785415979, -0.649838272)),
    ((-2.022542486, -1.469463131), (-1.169756803, -1.497220432), (-1.366745621, -1.319850904)),
    ((-1.25, -2.165063509), (-0.459651602, -1.84356188), (-0.711752527, -1.761649324)),
    ((-0.261321158, -2.486304738), (0.329931538, -1.871134731), (0.066309044, -1.898842571)),
    ((0.772542486, -2.377641291), (1.062466517, -1.575171388), (0.832905179, -1.707708688)),
    ((1.672826516, -1.857862064), (1.611291383, -1.006846602), (1.455484442, -1.221296458)),
    ((2.283863644, -1.016841608), (1.881509331, -0.264428892), (1.826397222, -0.523710976)),
)
PALLETS = (
    ((-1.291726486, -0.644031069), (-0.804948697, -0.609996918), (-1.015049524, 0.26513601), (-1.501827314, 0.23110186)),
    ((1.291726486, -0.644031069), (1.516169995, -1.107999433), (2.088640394, -0.413537308), (1.864196885, 0.050431056)),
)
FORK = (((-0.38, 3.4), (-0.13, 3.4), (-0.13, 3.77), (-0.38, 3.74)), ((0.13, 3.4), (0.38, 3.4), (0.38, 3.74), (0.13, 3.77)))
ARM = ((-0.15, 1.2), (0.15, 1.2), (0.15, 3.2), (-0.15, 3.2))
PIN_CENTRE, BENCH_PIN_RADIUS = (0.0, -0.85), 0.12
BANKING_CENTRES, BANKING_RADIUS = ((-0.540080174, 4.843997729), (0.540080174, 4.843997729)), 0.2


def bench_lever(folder: Path) -> None:
    """Write the four drawings into `folder`."""
    wheel = new_sheet(("TEETH",))
    for tooth in TEETH:
        add_polygon(wheel, "TEETH", list(tooth))
    write(wheel, folder / "wheel.dxf")
    lever = new_sheet(("PALLETS", "FORK", "ARM"))
    for layer, shapes in (("PALLETS", PALLETS), ("FORK", FORK), ("ARM", (ARM,))):
        for shape in shapes:
            add_polygon(lever, layer, list(shape))
    write(lever, folder / "lever.dxf")
    balance = new_sheet(("PIN",))
    add_circle(balance, "PIN", PIN_CENTRE, BENCH_PIN_RADIUS)
    write(balance, folder / "balance.dxf")
    banking = new_sheet(("PINS",))
    for centre in BANKING_CENTRES:
        add_circle(banking, "PINS", centre, BANKING_RADIUS)
    write(banking, folder / "banking.dxf")


GLUCYDUR, STEEL, GOLD, RUBY, NIVAROX = 8.25, 7.85, 15.5, 3.98, 8.1  # g/cm³ = mg/mm³
RIM_OUTER, RIM_INNER, RIM_HEIGHT = 4.80, 4.25, 0.55
ARM_WIDTH, ARM_HEIGHT = 0.70, 0.20
BORE = 0.30  # radius of the staff where arms and rollers sit
SCREWS, SCREW_ANGLE, SCREW_RADIUS, SCREW_LENGTH = 8, 22.5, 0.25, 0.40  # heads, on the rim, pointing outward
ROLLER_RADIUS, ROLLER_HEIGHT = 1.15, 0.20
PIN_RADIUS, PIN_PLACE, PIN_HEIGHT = 0.14, 0.90, 0.55
SAFETY_RADIUS, SAFETY_HEIGHT = 0.62, 0.25
CRESCENT_RADIUS, CRESCENT_PLACE = 0.20, 0.66
SPRING_INNER, SPRING_OUTER, SPRING_TURNS, SPRING_WIDTH, SPRING_HEIGHT = 0.60, 2.60, 13, 0.030, 0.110
STAFF = (  # length, radius at its lower and upper end: cylinders and cones from the lower pivot up
    *((0.30, 0.045, 0.045), (0.35, 0.045, 0.30), (1.20, 0.30, 0.30), (0.25, 0.70, 0.70)),
    *((1.00, 0.30, 0.30), (0.35, 0.30, 0.045), (0.30, 0.045, 0.045)),
)
STAFF_PLACE = (8.0, -2.0)  # where its section is drawn, beside the plan


class Hand(NamedTuple):
    """Mass in mg, inertia about the staff in mg·mm², the formula, and whether it is exact for the part as drawn."""

    mass: float
    inertia: float
    formula: str
    exact: bool = True


def by_hand() -> dict[str, Hand]:
    """Layer -> what a handbook says."""
    return {
        "RIM": _ring(RIM_OUTER, RIM_INNER, RIM_HEIGHT * GLUCYDUR, "ring: m (R² + r²) / 2"),
        "ARMS": _arms(),
        "SCREWS": _screws(),
        "STAFF": _staff(),
        "ROLLER": _roller(),
        "PIN": _pin(),
        "SAFETY": _safety(),
        "HAIRSPRING": _hairspring(),
    }


def _ring(outer: float, inner: float, surface: float, formula: str) -> Hand:
    mass = surface * math.pi * (outer**2 - inner**2)
    return Hand(mass, 0.5 * mass * (outer**2 + inner**2), formula)


def _arms() -> Hand:
    surface, length = ARM_HEIGHT * GLUCYDUR, 2.0 * RIM_INNER
    bar, bore = surface * length * ARM_WIDTH, surface * math.pi * BORE**2
    inertia = bar * (length**2 + ARM_WIDTH**2) / 12.0 - bore * BORE**2 / 2.0
    return Hand(bar - bore, inertia, "bar less bore: m (L² + b²) / 12 − m r² / 2; its ends taken as straight", exact=False)


def _screws() -> Hand:
    mass = GOLD * math.pi * SCREW_RADIUS**2 * SCREW_LENGTH
    place = RIM_OUTER + SCREW_LENGTH / 2.0
    own = mass * (3.0 * SCREW_RADIUS**2 + SCREW_LENGTH**2) / 12.0
    return Hand(SCREWS * mass, SCREWS * (own + mass * place**2), "8 cylinders on their side: 8 [m (3 r² + l²) / 12 + m d²]")


def _staff() -> Hand:
    mass = inertia = 0.0
    for length, a, b in STAFF:
        mass += STEEL * math.pi * length * (a * a + a * b + b * b) / 3.0
        inertia += STEEL * math.pi * length * (a**4 + a**3 * b + a * a * b * b + a * b**3 + b**4) / 10.0
    return Hand(mass, inertia, "cylinders and cones: Σ π ρ l (a⁴ + a³b + a²b² + ab³ + b⁴) / 10")


def _roller() -> Hand:
    surface = ROLLER_HEIGHT * STEEL
    ring, hole = _ring(ROLLER_RADIUS, BORE, surface, ""), surface * math.pi * PIN_RADIUS**2
    inertia = ring.inertia - hole * (PIN_RADIUS**2 / 2.0 + PIN_PLACE**2)
    return Hand(ring.mass - hole, inertia, "ring less the pin's hole: m (R² + r²) / 2 − m (p² / 2 + d²)")


def _pin() -> Hand:
    mass = PIN_HEIGHT * RUBY * math.pi * PIN_RADIUS**2
    return Hand(mass, mass * (PIN_RADIUS**2 / 2.0 + PIN_PLACE**2), "disc beside the axis: m (p² / 2 + d²)")


def _safety() -> Hand:
    """The crescent is the lens common to two circles; its mass is taken to sit half-way across."""
    surface, a, d, r = SAFETY_HEIGHT * STEEL, CRESCENT_RADIUS, CRESCENT_PLACE, SAFETY_RADIUS
    ring = _ring(r, BORE, surface, "")
    first, second = math.acos((d * d + a * a - r * r) / (2 * d * a)), math.acos((d * d + r * r - a * a) / (2 * d * r))
    lens = surface * (a * a * first + r * r * second - d * r * math.sin(second))
    inertia = ring.inertia - lens * (0.5 * (d - a + r)) ** 2
    return Hand(
        ring.mass - lens, inertia, "ring less crescent: m (R² + r²) / 2 − m d²; the crescent taken as a point", exact=False
    )


def _hairspring() -> Hand:
    length = math.pi * SPRING_TURNS * (SPRING_INNER + SPRING_OUTER)
    mass = NIVAROX * SPRING_WIDTH * SPRING_HEIGHT * length / 3.0
    inertia = 0.5 * mass * (SPRING_INNER**2 + SPRING_OUTER**2)
    return Hand(mass, inertia, "one third of m (R² + r²) / 2, m = ρ b h L, L = π n (R + r)", exact=False)


LAYERS = ("RIM", "ARMS", "SCREWS", "SCREW_AXIS", "STAFF", "STAFF_AXIS", "ROLLER", "PIN", "SAFETY")
ORIGIN = (0.0, 0.0)


def arms() -> Loop:
    """A bar that ends on the inner circle of the rim."""
    half = 0.5 * ARM_WIDTH
    x = math.sqrt(RIM_INNER**2 - half**2)
    right = arc_between((x, -half), (x, half), ORIGIN, left=True)
    left = arc_between((-x, half), (-x, -half), ORIGIN, left=True)
    return Loop((right, Line(x, half, -x, half), left, Line(-x, -half, x, -half)), "ARMS")


def safety() -> Loop:
    """A disc with a crescent opposite to the impulse pin's side of the staff, towards -y, where the pin is."""
    d, a, r = CRESCENT_PLACE, CRESCENT_RADIUS, SAFETY_RADIUS
    opening = math.degrees(math.acos((d * d + r * r - a * a) / (2 * d * r)))
    centre, first, second = (0.0, -d), polar(r, -90.0 - opening), polar(r, -90.0 + opening)
    rim = Arc(0.0, 0.0, r, math.radians(angle_of(second)), math.radians(360.0 - 2.0 * opening))
    return Loop((rim, arc_between(first, second, centre, left=False)), "SAFETY")


def screw() -> list[Point]:
    """Half of its head, seen from above."""
    outer = RIM_OUTER + SCREW_LENGTH
    corners = ((RIM_OUTER, 0.0), (outer, 0.0), (outer, SCREW_RADIUS), (RIM_OUTER, SCREW_RADIUS))
    return [turned(corner, SCREW_ANGLE) for corner in corners]


def staff() -> list[Point]:
    """Half of its section, the axis upright."""
    x, y = STAFF_PLACE
    corners = [(x, y)]
    for length, lower, upper in STAFF:
        for corner in ((x + lower, y), (x + upper, y + length)):
            if corner != corners[-1]:
                corners.append(corner)
        y += length
    return [*corners, (x, y)]


def balance(folder: Path) -> None:
    """Write the drawing into `folder`."""
    sheet = new_sheet(LAYERS)
    for layer, radius in (("RIM", RIM_OUTER), ("RIM", RIM_INNER), ("ARMS", BORE), ("ROLLER", ROLLER_RADIUS), ("ROLLER", BORE)):
        add_circle(sheet, layer, ORIGIN, radius)
    add_circle(sheet, "SAFETY", ORIGIN, BORE)
    add_loop(sheet, circle("ROLLER", (0.0, -PIN_PLACE), PIN_RADIUS))
    add_loop(sheet, circle("PIN", (0.0, -PIN_PLACE), PIN_RADIUS))
    add_loop(sheet, arms())
    add_loop(sheet, safety())
    add_polygon(sheet, "SCREWS", screw())
    ends = (RIM_OUTER - 0.3, RIM_OUTER + SCREW_LENGTH + 0.3)
    add_edge(sheet, "SCREW_AXIS", Line(*polar(ends[0], SCREW_ANGLE), *polar(ends[1], SCREW_ANGLE)))
    add_polygon(sheet, "STAFF", staff())
    x, y = STAFF_PLACE
    add_edge(sheet, "STAFF_AXIS", Line(x, y - 0.4, x, y + sum(length for length, _, _ in STAFF) + 0.4))
    write(sheet, folder / "balance.dxf")


DRAWN = {"swiss_lever": swiss_lever, "coaxial": coaxial, "bench_lever": bench_lever, "balance": balance}

if __name__ == "__main__":
    from usage import arguments

    asked = arguments(__doc__, profile=(..., ", ".join(DRAWN)), folder=("", "where the drawings go instead of profiles/NAME"))
    if asked.profile not in DRAWN:
        raise SystemExit(f"{asked.profile}: one of {', '.join(DRAWN)}")
    DRAWN[asked.profile](Path(asked.folder) if asked.folder else ROOT / "profiles" / asked.profile)
