"""Swiss lever on the carriage of a tourbillon: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import Design, dim, sheets_of
from watchsim.construction.outline import circle
from watchsim.construction.parts import Arms
from watchsim.construction.swiss_lever import ESTIMATE, SwissLever, conflicts, parts, rest, swiss
from watchsim.construction.swiss_lever import draw as draw_lever
from watchsim.drawing.write import Sheet


@dataclass(frozen=True)
class Tourbillon(SwissLever):
    """Those of the Swiss lever, of its carriage, and of what gravity acts on."""

    ratio: int = dim(16, "", 4, 60, "teeth of the fixed fourth wheel by those of the escape pinion", "a turn in a minute")
    carriage_inertia: float = dim(20.0, "mg·cm²", 0.1, 1e5, "carriage without what it carries", ESTIMATE)
    carriage_mass: float = dim(150.0, "mg", 10.0, 1e5, "carriage without what it carries", ESTIMATE)
    wheel_mass: float = dim(4.0, "mg", 0.1, 1e4, "escape wheel with its pinion", ESTIMATE)
    lever_mass: float = dim(3.0, "mg", 0.1, 1e4, "lever", ESTIMATE)
    balance_mass: float = dim(50.0, "mg", 1.0, 1e5, "balance with roller and hairspring", ESTIMATE)
    poise_error: float = dim(
        5.0, "µm", 0.0, 1000.0, "of the balance's centre of mass, from its axis", "33 s/d between positions"
    )
    gravity: float = dim(9.81, "m/s²", 0.0, 20.0, "in the plane: the watch stands upright; 0: it lies flat", "mean on earth")


WORDS = """\
A tourbillon: a Swiss lever on a carriage, the balance on its axis. The escape pinion rolls round the fixed fourth wheel, of
{ratio} times its teeth, and the train drives the carriage. The watch stands upright, and the balance is out of
poise: what this gains in one position it loses in the opposite one. Drawn to these dimensions:"""


def scene_text(values: Tourbillon) -> str:
    """The text of scene.toml: as the lever by itself begins, the wheel below the balance."""
    design = swiss(values)
    wheel_y, lever_y = -design.balance_pivot[1], design.lever_pivot[1] - design.balance_pivot[1]
    poised = -(values.wheel_mass * wheel_y + values.lever_mass * lever_y) / values.carriage_mass
    turn = values.ratio * values.teeth * 7200.0 / values.frequency
    carried: dict[str, Any] = {"on": "carriage"}
    more: dict[str, dict[str, Any]] = {
        "wheel": {**carried, "mass": f"{values.wheel_mass:.15g} mg"},
        "lever": {**carried, "mass": f"{values.lever_mass:.15g} mg"},
        "balance": {
            **carried,
            "mass": f"{values.balance_mass:.15g} mg",
            "centre_of_mass": (f"{values.poise_error:.15g} µm", "0 mm"),
        },
        "banking": carried,
    }
    return toml.scene(
        toml.head(
            *(values, WORDS.format(ratio=values.ratio)),
            f"Tourbillon, {values.frequency:.0f} vph, a turn in {turn:.15g} s",
            gravity=values.gravity,
        ),
        toml.body(
            *("carriage", "carriage", "CAGE", "only drawn: nothing is declared to touch it"),
            pivot=toml.ORIGIN,
            width=14,
            mass=f"{values.carriage_mass:.15g} mg",
            inertia=f"{values.carriage_inertia:.15g} mg·cm²",
            centre_of_mass=toml.Noted(toml.at(0, poised), "poised with wheel and lever", 3),
        ),
        parts(values, design.balance_pivot[1], more),
        toml.table(
            "[[gears]]", "the wheel against the carriage: both clockwise", between=("carriage", "wheel"), ratio=values.ratio
        ),
        toml.torque(
            "carriage",
            f"{-values.ratio * values.torque:.15g} µN·m",
            "the train turns the carriage, nothing else drives the wheel",
        ),
        rest(values, tolerance="1e-11"),
    )


# Shares of the distance from wheel to balance: a ring that holds wheel, lever and balance, three arms, the bearing of the
# balance; width of an arm, and corners of the openings.
RING, INNER, ARMS, HUB, WIDTH, CORNER = 1.52, 1.43, 3, 0.13, 0.09, 0.06


def draw(values: Tourbillon) -> dict[str, Sheet]:
    """The sheets of the lever, and the carriage about the balance's axis: its upper half, with one arm away from the wheel."""
    scale = swiss(values).balance_pivot[1]
    openings = Arms(ARMS, WIDTH * scale, HUB * scale, INNER * scale, CORNER * scale).windows("CAGE")
    cage = [circle("CAGE", (0.0, 0.0), RING * scale), *(loop.moved(math.pi / 2.0, (0.0, 0.0)) for loop in openings)]
    return draw_lever(values) | sheets_of(carriage=cage)


DESIGN = Design("tourbillon", "Swiss lever on the carriage of a tourbillon", Tourbillon, draw, scene_text, conflicts)
