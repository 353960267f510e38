"""Which numbers of a point can be asked for?"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Output:
    """`name` is what is asked for, `column` the name with its unit, `label` and `unit` for people."""

    name: str
    column: str
    label: str
    unit: str
    has_error: bool = True


OUTPUTS = {
    one.name: one
    for one in (
        Output("amplitude", "amplitude_deg", "amplitude", "°"),
        Output("rate", "rate_s_per_d", "rate", "s/d"),
        Output("beat_error", "beat_error_ms", "beat error", "ms"),
        Output("period", "period_s", "period", "s"),
        Output("multiplier", "multiplier", "multiplier", "", has_error=False),
    )
}
USUAL = ("amplitude", "rate", "beat_error")


def outputs_named(names: Iterable[str]) -> tuple[Output, ...]:
    """The outputs of those names, each once; ValueError for one that there is not."""
    found = []
    for name in dict.fromkeys(names):
        if name not in OUTPUTS:
            near = difflib.get_close_matches(name, OUTPUTS, n=1)
            advice = f'Did you mean "{near[0]}"?' if near else f"There are {', '.join(OUTPUTS)}."
            raise ValueError(f'outputs: "{name}" is not an output. {advice}')
        found.append(OUTPUTS[name])
    if not found:
        raise ValueError(f"outputs: name at least one of {', '.join(OUTPUTS)}")
    return tuple(found)
