"""How far off is each engine at each setting, and how long does it take for a simulated second?"""

from __future__ import annotations

import statistics
from collections.abc import Callable
from dataclasses import dataclass

from watchsim.bench.engines.world import is_installed, version_of
from watchsim.bench.outcomes import Outcome, cpu_seconds, outcome
from watchsim.bench.scenarios import ENGINES, REFERENCE_TOLERANCE, Scenario
from watchsim.simulation.methods import EVENT_DRIVEN, MOREAU
from watchsim.verification.closed_forms import incline_state

REPEATS = 5
ANOTHER_WAY = 30.0  # degrees of amplitude: not a matter of accuracy any more
LONG = 2.0  # s of processor time: what takes longer is timed over a part
LONGEST = 0.4  # s simulated, of that part


@dataclass(frozen=True, slots=True)
class Row:
    """One engine at one setting. Times in s of processor time per simulated second: median, smallest and largest of `repeats`.

    Errors are absolute: rate in s/d, amplitude in degrees, state (x of the free body) in m; None where there is none.
    """

    scene: str
    method: str
    version: str
    setting: float
    wall_s_per_simulated_s: float
    wall_least: float
    wall_largest: float
    repeats: int
    error_rate_s_per_d: float | None
    error_amplitude_deg: float | None
    error_state: float | None
    note: str = ""


@dataclass(frozen=True, slots=True)
class Reference:
    """What counts as true for a scenario, from where, and how far another method is from it."""

    scene: str
    truth: Outcome
    source: str
    confirmed_by: str
    amplitude_off_deg: float | None = None
    rate_off_s_per_d: float | None = None
    state_off_m: float | None = None


def missing_engines() -> list[str]:
    """Engines that are not installed."""
    return [engine for engine in ENGINES if not is_installed(engine)]


def compare(scenario: Scenario, repeats: int, tell: Callable[[str], None]) -> tuple[Reference, list[Row]]:
    """The reference of a scenario, and a row for each setting of each installed engine."""
    tell(f"{scenario.name}: reference")
    truth = reference(scenario)
    rows = []
    for method, settings in scenario.settings.items():
        if method in ENGINES and not is_installed(method):
            continue
        for setting in settings:
            tell(f"{scenario.name}: {method} {setting:g}")
            rows.append(_row(scenario, method, setting, truth.truth, repeats))
    return truth, rows


def reference(scenario: Scenario) -> Reference:
    """The closed form where there is one, else the tightest event-driven run; both confirmed by another method."""
    tight = outcome(scenario, EVENT_DRIVEN, REFERENCE_TOLERANCE)
    if scenario.closed_form is not None:
        exact = Outcome(x=incline_state(scenario.closed_form, scenario.duration).x)
        off = _apart(exact.x, tight.x)
        return Reference(scenario.name, exact, "closed form", f"event-driven, {REFERENCE_TOLERANCE:g}", state_off_m=off)
    coarse, fine = (outcome(scenario, MOREAU, step) for step in scenario.settings[MOREAU][-2:])
    ratio = scenario.settings[MOREAU][-2] / scenario.settings[MOREAU][-1]
    return Reference(
        scenario.name,
        tight,
        f"event-driven, {REFERENCE_TOLERANCE:g}",
        f"Moreau's time stepping, extrapolated from steps of {_steps(scenario)}",
        amplitude_off_deg=_apart(tight.amplitude, _extrapolated(coarse.amplitude, fine.amplitude, ratio)),
        rate_off_s_per_d=_apart(tight.rate, _extrapolated(coarse.rate, fine.rate, ratio)),
    )


def _steps(scenario: Scenario) -> str:
    return " and ".join(f"{1e6 * step:g} µs" for step in scenario.settings[MOREAU][-2:])


def _extrapolated(coarse: float | None, fine: float | None, ratio: float) -> float | None:
    """To step zero, where errors go with the step."""
    if coarse is None or fine is None:
        return None
    return fine + (fine - coarse) / (ratio - 1.0)


def _row(scenario: Scenario, method: str, setting: float, truth: Outcome, repeats: int) -> Row:
    got = outcome(scenario, method, setting)
    times = _times(scenario, method, setting, repeats)
    return Row(
        scene=scenario.name,
        method=method,
        version=version_of(method) if method in ENGINES else "",
        setting=setting,
        wall_s_per_simulated_s=statistics.median(times),
        wall_least=min(times),
        wall_largest=max(times),
        repeats=len(times),
        error_rate_s_per_d=_apart(got.rate, truth.rate),
        error_amplitude_deg=_apart(got.amplitude, truth.amplitude),
        error_state=_apart(got.x, truth.x),
        note=got.note or _astray(got, truth),
    )


def _astray(got: Outcome, truth: Outcome) -> str:
    off = _apart(got.amplitude, truth.amplitude)
    return "runs another way" if off is not None and off > ANOTHER_WAY else ""


def _times(scenario: Scenario, method: str, setting: float, repeats: int) -> list[float]:
    """Per simulated second; after a first one that nobody sees."""
    duration = scenario.duration
    first = cpu_seconds(scenario, method, setting, min(duration, LONGEST))
    if first / min(duration, LONGEST) * duration > LONG:
        duration = min(duration, LONGEST)
    return [cpu_seconds(scenario, method, setting, duration) / duration for _ in range(repeats)]


def _apart(one: float | None, two: float | None) -> float | None:
    return None if one is None or two is None else abs(one - two)
