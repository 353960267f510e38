"""Are the dimensions that random designs of the Swiss lever were drawn to those that are measured in their drawings?

    python scripts/checks/compare_designs.py [designs] [seed]

Draws dimensions at random (scripts/checks/try_designs.py) until so many designs (default 200) are accepted, measures each (what
`watchsim check` tells) and prints the largest difference of every dimension, with the design in which it occurs. Exits with 1
where one differs by more than 0.01°.
"""

from __future__ import annotations

import math
import random
import sys
from collections.abc import Iterator
from pathlib import Path

from try_designs import numbers

from watchsim.construction import registry as known
from watchsim.designs import Drawn
from watchsim.escapement.fork_and_pin import Quantity
from watchsim.escapement.measure import Function, measure

NAME = "swiss_lever"
CLOSE = 0.01  # degrees


def accepted(count: int, seed: int) -> Iterator[Drawn]:
    """Random designs without contradictions."""
    design, chance = known.design(NAME), random.Random(seed)
    while count > 0:
        chosen = numbers(design, chance)
        if not design.refusals(chosen):
            count -= 1
            yield Drawn(design, design.chosen(chosen))


def differences(design: Drawn, function: Function) -> Iterator[tuple[str, float]]:
    """Measured less chosen, degrees, by the name of the dimension."""
    chosen = design.values
    assert function.pallets is not None and function.fork is not None and function.safety is not None
    entry, exit_ = function.pallets

    def off(one: Quantity, value: float) -> float:
        return max((math.degrees(x) - value for x in (one.value, one.worst)), key=abs)

    for name, one in (("entry", entry), ("exit", exit_)):
        yield f"lock, {name}", off(one.lock, chosen.lock)
        yield f"run, {name}", off(one.run, chosen.run)
        yield f"draw, {name}", off(one.draw, chosen.draw)
        yield f"lift, {name}", off(one.lift, chosen.lift_on_stone + chosen.lift_on_tooth)
    yield "lift_on_stone", off(entry.lift_stone, chosen.lift_on_stone)
    yield "lift_on_tooth", off(entry.lift_tooth, chosen.lift_on_tooth)
    yield "drop_inside", off(entry.drop, chosen.drop_inside)
    yield "drop_outside", off(exit_.drop, chosen.drop_outside)
    for k, name in enumerate(("entry", "exit")):
        yield f"lift_angle, from {name}", off(function.fork.lift_angle[k], chosen.lift_angle)
        yield f"guard_freedom, {name}", off(function.safety[k].guard, chosen.guard_freedom)


def main(count: int, seed: int) -> int:
    """The exit status."""
    worst: dict[str, tuple[float, str]] = {}
    strange = heels = 0
    for i, design in enumerate(accepted(count, seed)):
        function = measure(design.scene())
        if function.missing:
            strange += 1
            print(f"design {i}: {function.missing}")
            continue
        for name, off in differences(design, function):
            if abs(off) > abs(worst.get(name, (0.0, ""))[0]):
                worst[name] = (off, f"design {i}")
        heel = [stretch for one in function.passages or () for stretch in one.driven if stretch.first.on_stone]
        if len(heel) > 2:
            heels += 1
    print(f"{count} designs, {strange} of them not measured whole; measured less chosen, the largest of each:")
    print(f"  in {heels} of them a heel slides on a stone's face before the stone's corner reaches the tooth's")
    for name, (off, where) in worst.items():
        print(f"  {name:24} {off:+.2e}°  ({where})")
    return 1 if strange or any(abs(off) > CLOSE for off, _ in worst.values()) else 0


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    given = arguments(__doc__, designs=(200, "how many designs"), seed=(1, "of the random numbers"))
    sys.exit(main(given.designs, given.seed))
