"""How is a study shown on a terminal?"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from watchsim.results.tables import cell
from watchsim.studies.axes import Axis, slug
from watchsim.studies.point import OUTPUTS, Output, Row
from watchsim.units import rounded, signed, to

if TYPE_CHECKING:  # each study loads what it needs, and a quarter of a second of scipy is for tolerances alone
    from watchsim.studies.positions import Positions
    from watchsim.studies.sensitivity import Effect, Sensitivity
    from watchsim.studies.sweep import Sweep
    from watchsim.studies.tolerance_result import ToleranceStudy

Table = dict[str, list[Any]]  # column -> values


def sweep_table(sweep: Sweep) -> Table:
    """The rows as columns; the names of keys carry their SI units."""
    names = {axis.key: axis.column for axis in sweep.axes}
    columns = list(sweep.rows[0]) if sweep.rows else list(names)
    return {names.get(name, name): [row[name] for row in sweep.rows] for name in columns}


def csv_text(table: Table) -> str:
    """Numbers with all their digits; an empty field where there is none."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(map(cell, table))
    for row in zip(*table.values(), strict=True):
        writer.writerow(map(_field, row))
    return out.getvalue()


def _field(value: Any) -> Any:
    if isinstance(value, str):
        return cell(value)
    return "" if value is None else repr(float(value)) if isinstance(value, float) else value


def parquet_writer(table: Table) -> Callable[[Path], None] | None:
    """What writes the table as parquet; None where pyarrow is not installed."""
    try:
        import pyarrow as arrow
        from pyarrow import parquet
    except ImportError:
        return None

    def write(path: Path) -> None:
        parquet.write_table(arrow.table({name: _typed(arrow, values) for name, values in table.items()}), path)

    return write


def _typed(arrow: Any, values: Sequence[Any]) -> Any:
    """A column of numbers stays one where some or all of them are missing."""
    text = any(isinstance(value, str) for value in values)
    return arrow.array(values, type=arrow.string() if text else arrow.float64())


def sensitivity_table(found: Sensitivity) -> Table:
    """One line per quantity, the greatest effect first."""
    rows = found.rows()
    return {name: [row[name] for row in rows] for name in (rows[0] if rows else ("key",))}


LONGEST = 60  # rows that are printed whole
ENDS = 10  # of a longer table: rows at each end
MOST_TOLD, LEAST_TOLD = 6, 0.005  # contributions in one line: how many, and the least of them
WHETHER = {"ticks": "whether it ticks", "good": "whether it is good"}
DECIMALS = {"amplitude_deg": 3, "rate_s_per_d": 3, "beat_error_ms": 4, "period_s": 9, "multiplier": 6}


def sweep_text(sweep: Sweep) -> str:
    """The table for people: keys in usual units, outputs without their errors, verdicts."""
    head = [_head(axis) for axis in sweep.axes] + [_title(one) for one in sweep.outputs] + ["verdict"]
    body = [_line(sweep, row) for row in sweep.rows]
    lines = [sweep.title, *aligned(head, body)]
    reasons: dict[str, list[Row]] = {}
    for row in sweep.rows:
        if row["message"]:
            reasons.setdefault(row["message"], []).append(row)
    return "\n".join([*lines, *(f"  {_points(sweep, rows)}: {reason}" for reason, rows in list(reasons.items())[:ENDS])])


def _points(sweep: Sweep, rows: list[Row]) -> str:
    """The first of these points, and how many more there are."""
    first = ", ".join(f"{axis.key} {_key(axis, rows[0][axis.key])} {axis.usual}".rstrip() for axis in sweep.axes)
    return f"{first} and {len(rows) - 1} more" if len(rows) > 1 else first


def sensitivity_text(found: Sensitivity) -> str:
    """The table for people: what 1 %, 10 µm or 0.1° do, the greatest effect first."""
    head = ["by", "value", "change", *(_title(one) for one in found.outputs), ""]
    body = []
    for effect, row in zip(found.effects, found.rows(), strict=True):
        effects = [_effect(effect, one.column) for one in found.outputs]
        unit = f" {row['unit']}" if row["unit"] not in ("", "°", "%") else row["unit"]
        body.append([row["key"], f"{row['value']:.5g}{unit}", row["change"], *effects, row["message"]])
    level = f"{found.cycle.amplitude_deg:.3f}°, {found.cycle.rate_s_per_d:.3f} s/d, {found.cycle.beat_error_ms:.4f} ms"
    return "\n".join([f"{found.title}: {level}".replace(" -", " −"), *aligned(head, body)])


def tolerance_table(found: ToleranceStudy) -> Table:
    """One line for each sample: what it was made to (SI), what it gives, and what is wrong with it."""
    from watchsim.studies.sampling import plain_values
    from watchsim.studies.tolerance_result import failing

    numbers = list(found.numbers_of)
    values = [plain_values(one) for one in found.plan.changes(numbers)]
    rows = [found.rows[number] for number in numbers]
    units = {one.key: one.dimension.si for one in found.plan.scene.tolerances}
    table: Table = {"sample": numbers}
    for key in values[0] if values else ():
        unit = units.get(key, units.get(key.rpartition(".")[0], ""))
        table[f"{key}_{slug(unit)}" if unit else key] = [one[key] for one in values]
    table |= {column: [row.get(column) for row in rows] for column in found.outputs}
    return {**table, "verdict": [row["verdict"] for row in rows], "wrong": [failing(found.plan, row) for row in rows]}


def tolerance_text(found: ToleranceStudy) -> str:
    """For people: the yield, the spread of every output, what contributes, and what fails."""
    lines = [found.title, f"  {found.message}."]
    for name in ("controlled", "predicted", "weights"):
        if name in found.shares:
            share = found.shares[name]
            ends = "" if share.low == share.high else f" ({100 * share.low:.4g} to {100 * share.high:.4g} %)"
            lines.append(f"  by {share.by}: {100 * share.value:.4g} %{ends}")
    by_column = {one.column: one for one in OUTPUTS.values()}
    head = ["output", "mean", "sigma", "0.1 %", "99.9 %", "Cp", "Cpk", "linear sigma", "worst case", ""]
    body = []
    for column, one in found.outputs.items():
        low, high = _short(one.linear_low), _short(one.linear_high)
        ratios = [_short(ratio) for ratio in (one.cp, one.cpk)]
        spread = [_short(number) for number in (one.mean, one.sigma, *(one.quantiles[q] for q in ("0.00135", "0.99865")))]
        worst = f"{low} to {high}" if low else ""
        body.append([_title(by_column[column]), *spread, *ratios, _short(one.linear_sigma), worst, one.remark])
    lines += aligned(head, body)
    for name, each in found.contributions.items():
        known = f", {100.0 * found.explained[name]:.3g} % explained" if name in found.explained else ""
        known += " (rank correlations)" if found.why_ranks(name) else ""
        notable = [
            f"{one.key} {100.0 * one.total:.3g} %" if one.total is not None else f"{one.key} {signed(one.rank, 2)}"
            for one in each[:MOST_TOLD]
            if one.total is None or one.total >= LEAST_TOLD
        ]
        label = by_column[name].label if name in by_column else WHETHER[name]
        lines.append(f"  {label}{known}: {', '.join(notable) or 'nothing stands out'}")
    why = dict.fromkeys(found.why_ranks(name) for name in found.contributions)
    lines += [f"  rank correlations, not shares: {words}" for words in why if words]
    lines += [f"  {words}: {number}" for words, number in found.failures.items()]
    split = ", ".join(f"{name} {rounded(1e3 * value)} ms" for name, value in found.seconds.items())
    return "\n".join([*lines, f"  a sample takes {rounded(1e3 * sum(found.seconds.values()))} ms of one processor: {split}"])


def positions_table(found: Positions) -> Table:
    """One line for each reading."""
    return {name: [row[name] for row in found.rows] for name in (found.rows[0] if found.rows else ("position",))}


POSITION_HEAD = ("rate s/d", "amplitude °", "beat error ms")
SUMMARY = {
    "X": "mean of all",
    "D": "largest less smallest",
    "DVH": "upright less lying",
    "DVm": "largest less smallest upright",
    "Di": "mean less the mean just wound",
}


def positions_text(found: Positions) -> str:
    """As a timing machine prints it: a block for each temperature, its windings side by side; then poise error and ISO 3159."""
    lines = [found.title]
    for warmth in dict.fromkeys(state[0] for state in found.states):
        states = [state for state in found.states if state[0] == warmth]
        heads = [name for state in states for name in (f"{winding(state)}: {POSITION_HEAD[0]}", *POSITION_HEAD[1:])]
        body = positions_rows(found, states)
        lines += ["", *aligned([f"{warmth:g} °C", *heads, ""], [[*row, ""] for row in body])]
    lines += [
        "",
        f"  {poise_words(found)}",
        "",
        *aligned(("ISO 3159", "", "category 1", "", "category 2", ""), criteria_rows(found)),
    ]
    reasons = dict.fromkeys(f"{row['position']}: {row['message']}" for row in found.rows if row["message"])
    return "\n".join([*lines, *(f"  {reason}" for reason in list(reasons)[:ENDS])])


def winding(state: tuple[float, float]) -> str:
    """Of a state: "wound", "after 24 h"."""
    return "wound" if state[1] == 0.0 else f"after {state[1]:g} h"


def positions_rows(found: Positions, states: Sequence[tuple[float, float]]) -> list[list[str]]:
    """A row for each position, then one for each number that follows; three columns for each state."""
    rows = []
    for name in dict.fromkeys(row["position"] for row in found.rows):
        readings = [found.at(state).get(name, {}) for state in states]
        cells = [_number(one.get(column), places) for one in readings for column, places in READ_TO.items()]
        rows.append([name, *cells])
    summaries = [found.summary(state) for state in states]
    for name in SUMMARY:
        if any(one[name] is not None for one in summaries):
            rows.append([name, *(cell for one in summaries for cell in (_number(one[name], 2), "", ""))])
    return rows


READ_TO = {"rate_s_per_d": 2, "amplitude_deg": 2, "beat_error_ms": 4}  # decimals


LEAST_POISE = 1e-14  # kg·m, a thousandth of what is taken off a balance; below stands the rounding of rates


def poise_words(found: Positions) -> str:
    """The poise error by the rates, and the true one."""
    from watchsim.studies.positions import SURE

    poise, balance = found.poise, found.balance
    if poise is None or balance is None:
        return "poise error: not known without three upright positions in which a sprung balance ticks"
    true = f"{1e11 * balance.amount:.4g} µg·cm at {math.degrees(balance.direction) % 360.0:.4g}°"
    if max(poise.amount, poise.error) < LEAST_POISE:
        return (
            f"poise error: none (below {1e11 * LEAST_POISE:g} µg·cm); the scene's own is {true if balance.amount else 'none'}"
        )
    if poise.error > SURE * poise.amount:
        seen = f"below {1e11 * poise.error:.2g} µg·cm, which these rates cannot show"
        return f"poise error: {seen}; the scene's own is {true if balance.amount else 'none'}"
    place = f"{math.degrees(poise.direction) % 360.0:.4g}° in the balance's drawing"
    amount = f"{1e11 * poise.amount:.4g} µg·cm ± {1e11 * poise.error:.1g} µg·cm"
    return f"poise error: {amount}, to be removed at {place}; the scene's own is {true}"


CRITERIA = {
    "mean_daily_rate": "mean daily rate",
    "mean_variation": "mean variation of rates",
    "greatest_variation": "greatest variation of rates",
    "vertical_less_horizontal": "6H less CH",
    "greatest_deviation": "greatest deviation from the mean",
    "thermal_variation": "variation with temperature, by K",
    "rate_resumption": "resumption of the rate",
}


def criteria_rows(found: Positions) -> list[list[str]]:
    """Criterion, value, and limits with the verdict for each category."""
    both = [found.iso3159(category) for category in (1, 2)]
    rows = []
    for name, label in CRITERIA.items():
        value = both[0][name].value
        cells = [cell for one in both for cell in (_limits(one[name].limit), VERDICTS[one[name].ok])]
        rows.append(
            [label, _number(value, 2), *cells[:-1], cells[-1] if value is not None else f"{cells[-1]}: {both[0][name].why}"]
        )
    return rows


VERDICTS = {True: "fine", False: "missed", None: "not judged"}


def _limits(limit: tuple[float, float]) -> str:
    return (f"{limit[0]:+g} to {limit[1]:+g}" if limit[0] else f"at most {limit[1]:g}").replace("-", "−")


def _short(value: float | None) -> str:
    return "" if value is None else f"{value:.5g}".replace("-", "−")


def _head(axis: Axis) -> str:
    return f"{axis.key} ({axis.usual})" if axis.usual else axis.key


def _title(one: Output) -> str:
    return f"{one.label} ({one.unit})" if one.unit else one.label


def _line(sweep: Sweep, row: dict[str, Any]) -> list[str]:
    keys = [_key(axis, row[axis.key]) for axis in sweep.axes]
    return [*keys, *(_number(row[one.column], DECIMALS[one.column]) for one in sweep.outputs), row["verdict"] or "none"]


def _key(axis: Axis, value: Any) -> str:
    if isinstance(value, str):
        return value
    return f"{to(value, axis.usual) if axis.usual else value:.6g}".replace("-", "−")


def _number(value: float | None, decimals: int) -> str:
    return "" if value is None else signed(value, decimals)


def _effect(effect: Effect, column: str) -> str:
    """The effect of the usual change; "0" below rounding, with a question mark where two step sizes disagree."""
    value, derivative = effect.of(column, effect.quantity.change), effect.by[column]
    if value is None:
        return ""
    if abs(value) <= derivative.rounding * abs(effect.quantity.change):
        return "0"
    return f"{value:+.3g}".replace("-", "−") + ("" if derivative.agrees else " ?")


def aligned(head: Sequence[str], body: list[list[str]]) -> list[str]:
    """Columns as wide as their widest entry; the middle of a long table is left out."""
    shown = body if len(body) <= LONGEST else [*body[:ENDS], ["…"] + [""] * (len(head) - 1), *body[-ENDS:]]
    widths = [max(len(line[i]) for line in (list(head), *shown)) for i in range(len(head))]
    return ["  " + "  ".join(_padded(line, widths)).rstrip() for line in (list(head), *shown)]


def _padded(line: Sequence[str], widths: Sequence[int]) -> list[str]:
    """The first and the last column to the left, numbers to the right."""
    last = len(line) - 1
    return [f"{text:<{w}}" if i in (0, last) else f"{text:>{w}}" for i, (text, w) in enumerate(zip(line, widths, strict=True))]
