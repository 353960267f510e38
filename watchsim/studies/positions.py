"""What does a timing machine show of the watch in all positions, wound and a day later, cold and warm?

Each reading is the limit cycle of the scene in that state ([watch]). What follows from all of them is worked out as watchmakers
do: mean and differences, the poise error of the balance, and the criteria of ISO 3159 as far as a model without chance can
answer them.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from watchsim.analysis.timing import DAY
from watchsim.displays import notebook_html
from watchsim.scene.errors import Fault, SceneError
from watchsim.scene.forces import G
from watchsim.scene.keys import AT_HOME
from watchsim.scene.read_watch import LYING, up_of
from watchsim.scene.roles import loads, oscillators
from watchsim.scene.scene import Scene
from watchsim.studies.axes import axes_from_values
from watchsim.studies.point import Question, Row, outputs_named
from watchsim.studies.sweep import Progress, swept
from watchsim.studies.workers import Executor, chosen
from watchsim.units import ANGLE, parse

USUAL = (*LYING, "3H", "6H", "9H", "12H")
COLD_TO_WARM = (8.0, AT_HOME, 38.0)  # °C, of ISO 3159
DAYS = (0.0, 24.0)  # h since winding
READINGS = ("amplitude_deg", "rate_s_per_d", "beat_error_ms")
STATE = ("temperature_c", "wound_h")

# ISO 3159:2009, table of the minimum requirements: category 1 are movements of more than 20 mm (or 314 mm²), 2 smaller ones.
LIMITS = {
    "mean_daily_rate": ((-4.0, 6.0), (-5.0, 8.0)),
    "mean_variation": ((0.0, 2.0), (0.0, 3.4)),
    "greatest_variation": ((0.0, 5.0), (0.0, 7.0)),
    "vertical_less_horizontal": ((-6.0, 8.0), (-8.0, 10.0)),
    "greatest_deviation": ((0.0, 10.0), (0.0, 15.0)),
    "thermal_variation": ((-0.6, 0.6), (-0.7, 0.7)),
    "rate_resumption": ((-5.0, 5.0), (-6.0, 6.0)),
}
CHANCE = ("mean_variation", "greatest_variation", "rate_resumption")  # from day to day: a model repeats itself
TEN_DAYS = ("6H", "3H", "9H", "CB", "CH")  # two days in each
NEEDED = {
    "mean_daily_rate": f"needs {', '.join(TEN_DAYS)} at {AT_HOME:g} °C",
    "vertical_less_horizontal": "needs 6H and CH",
    "greatest_deviation": f"needs {', '.join(TEN_DAYS)} at {AT_HOME:g} °C",
    "thermal_variation": "needs CH at 8 °C and 38 °C, and watch.thermal",
}


@dataclass(frozen=True)
class Balance:
    """Of the scene at 23 °C: stiffness of its springs (N·m/rad), rest position (rad), first moment of its mass about the pivot
    (kg·m) and the direction of that (rad) in its own frame."""

    stiffness: float
    rest: float
    amount: float
    direction: float


@dataclass(frozen=True)
class Poise:
    """The poise error that the rates of upright positions show.

    amount     kg·m, mass times its distance from the axis; `error` by what rates and law leave over
    direction  rad, of the heavy side in the balance's own frame: there a poising tool removes
    left_over  s/d, the largest difference between a rate and the law
    """

    amount: float
    direction: float
    error: float
    left_over: float


@dataclass(frozen=True)
class Criterion:
    """`value` in s/d (s/d/K), None where it cannot be known, which `why` explains; `limit` and `ok` for one category."""

    value: float | None
    limit: tuple[float, float]
    why: str = ""

    @property
    def ok(self) -> bool | None:
        return None if self.value is None else self.limit[0] <= self.value <= self.limit[1]


@dataclass(frozen=True)
class Positions:
    """The readings, and what follows from them.

    rows      position, up_deg (direction of what is up, None where the watch lies), temperature_c, wound_h, amplitude_deg,
              rate_s_per_d, beat_error_ms with their errors, verdict, message
    balance   None where no spring swings; `thermal` whether the scene has temperature coefficients
    whole     False where rows are missing because it was interrupted
    """

    title: str
    rows: tuple[Row, ...]
    balance: Balance | None
    thermal: bool
    whole: bool
    wall_s: float

    def __repr__(self) -> str:
        states = len({tuple(row[name] for name in STATE) for row in self.rows})
        return f"<Positions of {self.title!r}: {len(self.rows)} readings in {states} states>"

    def _repr_html_(self) -> str:
        return notebook_html(self)

    @property
    def states(self) -> tuple[tuple[float, float], ...]:
        """(temperature_c, wound_h), in order."""
        return tuple(sorted({(row["temperature_c"], row["wound_h"]) for row in self.rows}))

    @property
    def home(self) -> tuple[float, float]:
        """The state nearest to 23 °C and just wound, in which a watch is regulated."""
        return min(self.states, key=lambda one: (abs(one[0] - AT_HOME), one[1]))

    def at(self, state: tuple[float, float]) -> dict[str, Row]:
        """The readings of one state by position."""
        return {row["position"]: row for row in self.rows if (row["temperature_c"], row["wound_h"]) == state}

    def summary(self, state: tuple[float, float]) -> dict[str, float | None]:
        """As timing machines show it (s/d): X mean of all rates, D largest less smallest, DVH mean of the upright ones less
        that of the lying ones, DVm largest less smallest of the upright ones, Di mean after that time less the mean just wound.

        None where a reading is missing that it needs.
        """
        rows = self.at(state)
        rates = {name: row["rate_s_per_d"] for name, row in rows.items()}
        upright = [rate for name, rate in rates.items() if rows[name]["up_deg"] is not None]
        lying = [rate for name, rate in rates.items() if rows[name]["up_deg"] is None]
        wound = [row["rate_s_per_d"] for row in self.at((state[0], 0.0)).values()] if state[1] else []
        return {
            "X": _mean(rates.values()),
            "D": _spread(rates.values()),
            "DVH": _less(_mean(upright), _mean(lying)),
            "DVm": _spread(upright),
            "Di": _less(_mean(rates.values()), _mean(wound)),
        }

    @property
    def poise(self) -> Poise | None:
        """Of the upright positions in the `home` state; None where fewer than three of them tick, or all in a line."""
        rows = [row for row in self.at(self.home).values() if row["up_deg"] is not None and row["rate_s_per_d"] is not None]
        return None if self.balance is None else poise_of(self.balance, rows)

    def iso3159(self, category: int = 1) -> dict[str, Criterion]:
        """The seven criteria of ISO 3159:2009 for movements of more than 20 mm (category 1) or less (2).

        A daily rate is the mean over the windings that were read. What asks how days differ is not judged.
        """
        day = {name: self._daily(name, AT_HOME) for name in TEN_DAYS}
        rates = [day[name] for name in TEN_DAYS]
        mean = _mean(rates)
        cold, warm = (self._daily("CH", at) for at in (COLD_TO_WARM[0], COLD_TO_WARM[-1]))
        by_kelvin = _less(warm, cold) if self.thermal else None
        away = [abs(rate - mean) for rate in rates if rate is not None and mean is not None]
        values = {
            "mean_daily_rate": mean,
            "vertical_less_horizontal": _less(day["6H"], day["CH"]),
            "greatest_deviation": max(away, default=None),
            "thermal_variation": None if by_kelvin is None else by_kelvin / (COLD_TO_WARM[-1] - COLD_TO_WARM[0]),
        }
        return {
            name: Criterion(
                values.get(name),
                both[category - 1],
                "a model repeats itself from day to day" if name in CHANCE else NEEDED[name],
            )
            for name, both in LIMITS.items()
        }

    def _daily(self, position: str, at: float) -> float | None:
        """Mean over the time since winding, linear between the readings."""
        rows = sorted(
            (row["wound_h"], row["rate_s_per_d"])
            for row in self.rows
            if row["position"] == position and row["temperature_c"] == at and row["rate_s_per_d"] is not None
        )
        if len(rows) != len({state[1] for state in self.states}) or not rows:
            return None
        hours, rates = np.array(rows).T
        pieces = 0.5 * np.diff(hours) * (rates[1:] + rates[:-1])
        return float(pieces.sum() / (hours[-1] - hours[0])) if len(rows) > 1 else float(rates[0])

    def numbers(self) -> dict[str, Any]:
        """What `positions --json` prints."""
        found, home = self.poise, self.summary(self.home)
        return {
            "title": self.title,
            "rows": [dict(row) for row in self.rows],
            "mean_rate_s_per_d": home["X"],
            "spread_s_per_d": home["D"],
            "dvh_s_per_d": home["DVH"],
            "summaries": [{**dict(zip(STATE, one, strict=True)), **self.summary(one)} for one in self.states],
            "poise": None
            if found is None
            else {
                "amount_kg_m": found.amount,
                "direction_deg": math.degrees(found.direction) % 360.0,
                "amount_kg_m_error": found.error,
                "left_over_s_per_d": found.left_over,
            },
            "iso3159": self._criteria(1),
            "iso3159_category_2": self._criteria(2),
            "balance": None if self.balance is None else asdict(self.balance),
            "thermal": self.thermal,
            "whole": self.whole,
            "wall_s": self.wall_s,
        }

    def _criteria(self, category: int) -> dict[str, Any]:
        return {
            name: {"value": one.value, "limit": list(one.limit), "ok": one.ok} for name, one in self.iso3159(category).items()
        }


def positions_of(numbers: Mapping[str, Any]) -> Positions:
    """Again from what `numbers` gave."""
    balance = None if numbers["balance"] is None else Balance(**numbers["balance"])
    whole, wall = bool(numbers["whole"]), float(numbers["wall_s"])
    return Positions(numbers["title"], tuple(numbers["rows"]), balance, bool(numbers["thermal"]), whole, wall)


def _mean(values: Any) -> float | None:
    rates = list(values)
    return None if not rates or None in rates else math.fsum(rates) / len(rates)


def _spread(values: Any) -> float | None:
    rates = list(values)
    return None if not rates or None in rates else max(rates) - min(rates)


def _less(one: float | None, other: float | None) -> float | None:
    return None if one is None or other is None else one - other


# A balance of stiffness k whose mass has the first moment s about the axis, pulled by g, swings at A as if its spring were
# stiffer by 2 (s·g) J1(A)/A, to first order in m g r / k: the mean of the torque's work against A sin φ, an integral of Bessel
# (DLMF 10.9.2). So its rate differs by 86400 (s·g) J1(A) / (k A) s/d, s as it lies when the balance is at rest; the sign
# changes at A = 219.5°. Half the differences of opposite positions are the least squares of that law.

LEAST_RATES = 3
SURE = 0.5  # of the amount, an error beyond which there is none to speak of
LAW = 2e-3  # of the amount, that the law leaves out: the escapement's own answer. Of Swiss levers 0.1 %


def poise_effect(amplitude: float, stiffness: float) -> float:
    """s/d for each kg·m of poise error that hangs below the axis of a balance at rest; amplitude in rad."""
    from scipy.special import j1

    return DAY * G * float(j1(amplitude)) / (stiffness * amplitude)


def poise_of(balance: Balance, rows: Sequence[Row]) -> Poise | None:
    """The first moment by which the rates of standing positions differ, by least squares."""
    if len(rows) < LEAST_RATES:
        return None
    down = np.array([math.radians(row["up_deg"]) + math.pi for row in rows])
    each = np.array([poise_effect(math.radians(row["amplitude_deg"]), balance.stiffness) for row in rows])
    rates = np.array([row["rate_s_per_d"] for row in rows])
    law = np.column_stack([np.cos(down) * each, np.sin(down) * each, np.ones(len(rows))])
    size = np.linalg.norm(law, axis=0)
    found, _, rank, _ = np.linalg.lstsq(law / size, rates, rcond=1e-6)
    if rank < LEAST_RATES:
        return None
    x, y, _ = found / size
    left = rates - law @ (found / size)
    spare = max(len(rows) - LEAST_RATES, 1)
    error = math.sqrt(float(left @ left) / spare) / float(np.abs(each).mean()) / math.sqrt(0.5 * len(rows))
    amount = math.hypot(x, y)
    return Poise(amount, math.atan2(y, x) - balance.rest, math.hypot(error, LAW * amount), float(np.abs(left).max()))


def balance_of(scene: Scene) -> Balance | None:
    """What swings on a spring, with its true poise error."""
    found = next((one for one in oscillators(scene) if one.spring > 0.0), None)
    number = next((i for i, body in enumerate(scene.bodies) if found is not None and body.name == found.body), None)
    if found is None or number is None or scene.bodies[number].motion != "pivot":
        return None
    x, y = loads(scene.bodies)[1][number].moment
    return Balance(found.spring, found.rest, math.hypot(x, y), math.atan2(y, x))


def positions(  # noqa: PLR0913 - options, by name
    scene: Scene | str | Path,
    positions: Sequence[str] = USUAL,
    *,
    temperatures: Sequence[float] | None = None,
    wound: Sequence[float] | None = None,
    tolerance: float | None = None,
    workers: int = 1,
    scheduler: str | None = None,
    folder: str | Path | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> Positions:
    """Amplitude, rate and beat error of the watch in every position, at every temperature, so long after winding.

    positions     of ISO 3158: CH, CB, 3H, 6H, 9H, 12H, and those between, such as "10H30"
    temperatures  °C; by default 8, 23 and 38 where the scene has `watch.thermal`, else 23
    wound         h since winding; by default 0 and 24 where the scene has a mainspring, else 0
    workers, scheduler, folder, resume, progress  as in `sweep`

    SceneError for a position that is none, and for a time since winding without a mainspring; a state in which the watch does
    not tick has its reason in `message`.
    """
    if not isinstance(scene, Scene):
        from watchsim.scene.load import load

        scene = load(scene)
    study = planned(scene, positions, temperatures, wound, tolerance)
    return study(chosen(workers, scheduler), folder, resume, progress)


Study = Callable[[Executor, "str | Path | None", bool, "Progress | None"], Positions]


def planned(
    scene: Scene,
    positions: Sequence[str],
    temperatures: Sequence[float] | None,
    wound: Sequence[float] | None,
    tolerance: float | None,
) -> Study:
    """The study, with everything checked, to be called with executor, folder, resume and progress."""
    watch = scene.source.get("watch", {})
    thermal = bool(watch.get("thermal"))
    temperatures = temperatures or (COLD_TO_WARM if thermal else (AT_HOME,))
    has_spring = any(one.mainspring is not None for one in scene.torques)
    names = tuple(dict.fromkeys(one.strip().upper() for one in positions))
    ups = _ups(names, scene)
    values: dict[str, Sequence[Any]] = {"watch.temperature": temperatures, "watch.position": names}
    if has_spring or wound is not None:
        values["watch.since_wound"] = [3600.0 * hours for hours in wound or DAYS]
    axes, outputs = axes_from_values(scene, values), outputs_named(("amplitude", "rate", "beat_error"))
    for axis in axes:
        for value in axis.values:
            scene.set(axis.key, value)
    base = scene.set("watch.temperature", AT_HOME).set("watch.position", LYING[0])

    def study(executor: Executor, folder: str | Path | None, resume: bool, progress: Progress | None) -> Positions:
        begun = time.perf_counter()
        question = Question(scene, tolerance=tolerance)
        done = swept(question, axes, outputs, executor, folder=folder, resume=resume, progress=progress)
        rows = tuple(_row(row, ups) for row in done.rows)
        return Positions(scene.title, rows, balance_of(base), thermal, done.whole, time.perf_counter() - begun)

    return study


def _ups(names: Sequence[str], scene: Scene) -> dict[str, float | None]:
    """Direction (°) of what is up by position."""
    watch = scene.source.get("watch", {})
    twelve = parse(watch["twelve"], ANGLE) if "twelve" in watch else 0.5 * math.pi
    found: dict[str, float | None] = {}
    faults = []
    for name in names:
        try:
            up = up_of(name, twelve, watch.get("seen_from") == "back")
            found[name] = None if up is None else math.degrees(up) % 360.0
        except ValueError as error:
            faults.append(Fault("positions", str(error), place="positions"))
    if faults:
        raise SceneError(faults)
    return found


def _row(row: Row, ups: Mapping[str, float | None]) -> Row:
    """One reading with its state in the units of a timing machine."""
    readings = {name: row[name] for one in READINGS for name in (one, f"{one}_error")}
    return {
        "position": row["watch.position"],
        "up_deg": ups[row["watch.position"]],
        "temperature_c": row["watch.temperature"],
        "wound_h": row.get("watch.since_wound", 0.0) / 3600.0,
        **readings,
        "verdict": row["verdict"],
        "message": row["message"],
    }
