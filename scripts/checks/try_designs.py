"""Do random designs start without overlap, and do they tick?

    python scripts/checks/try_designs.py [designs] [simulated] [seed] [design] [seconds]

Draws dimensions at random until so many designs (default 200) are accepted; refusals say why, and their reasons are counted.
Each accepted design is drawn, read back from its drawings and looked at for overlap at the start; the first few (default 40)
are simulated for so many seconds (default 2), one line each. Exits with 1 where a drawing is not sound or bodies overlap.
"""

import math
import random
import re
import sys
import time
from collections import Counter
from pathlib import Path

from watchsim.analysis.summary import summary
from watchsim.construction import registry as known
from watchsim.construction.design import Design, Dimension
from watchsim.designs import Drawn
from watchsim.mechanism.overlap import overlap_faults
from watchsim.scene.errors import SceneError
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop

SPREAD = 0.3  # of most dimensions, on both sides of the default


def numbers(design: Design, chance: random.Random) -> dict[str, float]:
    """Dimensions at random: near the default, now and then anywhere within the limits."""
    found: dict[str, float] = {}
    for one in design.dimensions:
        if chance.random() < 0.04:
            found[one.name] = _anywhere(one, chance)
        elif chance.random() < 0.7:
            near = one.default * (1.0 + SPREAD * chance.uniform(-1.0, 1.0))
            found[one.name] = _fitting(one, min(max(near, one.low), one.high))
    if design.name == "swiss_lever":
        _choose_counts(found, chance)
    return found


def _anywhere(one: Dimension, chance: random.Random) -> float:
    if one.low > 0.0 and one.high > 30.0 * one.low:
        return _fitting(one, math.exp(chance.uniform(math.log(one.low), math.log(one.high))))
    return _fitting(one, chance.uniform(one.low, one.high))


def _fitting(one: Dimension, value: float) -> float:
    return float(round(value)) if one.count else float(f"{value:.5g}")


def _choose_counts(found: dict[str, float], chance: random.Random) -> None:
    """Teeth, the spaces that the pallets embrace and the breadth of a tooth belong together."""
    teeth = chance.randint(11, 24)
    pitch = 360.0 / teeth
    spans = [k + 0.5 for k in range(1, 8) if 17.0 < (k + 0.5) * pitch / 2.0 < 42.0]
    found |= {"teeth": float(teeth), "embraced": chance.choice(spans)}
    found["tooth_width"] = float(f"{min(8.0, pitch * chance.uniform(0.14, 0.22)):.4g}")


def judged(design: Drawn, seconds: float) -> str:
    """What a short run says of it."""
    scene = design.scene()
    run = simulate(scene, duration=seconds)
    told = summary(run)
    if run.stop is not Stop.DURATION:
        return f"{run.stop.name.lower()}: {run.stop_message}"
    if told["amplitude_deg"] is None:
        return f"does not tick: {told['verdict_message'] or told['timing_message']}"
    missed = f", {told['missed_beats']} beats missed" if told["missed_beats"] else ""
    return f"ticks: amplitude {told['amplitude_deg']:5.1f}°, rate {told['rate_s_per_d']:+8.1f} s/d{missed}"


def main(count: int, simulated: int, seed: int, name: str, seconds: float) -> int:
    """The exit status."""
    design, chance = known.design(name), random.Random(seed)
    reasons: Counter[str] = Counter()
    accepted: list[Drawn] = []
    tries, faults, spent = 0, 0, 0.0
    while len(accepted) < count:
        tries += 1
        chosen = numbers(design, chance)
        start = time.process_time()
        refusals = design.refusals(chosen)
        if refusals:
            reasons.update({one.dimension or re.sub(r"[-\d.]+", "#", one.message) for one in refusals})
            continue
        drawn = Drawn(design, design.chosen(chosen))
        try:
            scene = drawn.scene()
            found = [str(fault) for fault in overlap_faults(scene)]
        except SceneError as error:
            found = [str(error)]
        spent += time.process_time() - start
        accepted.append(drawn)
        if found:
            faults += 1
            print(f"try {tries}: {chosen}\n" + "\n".join(found))
    print(f"{tries} tries, {len(accepted)} accepted, {faults} of them not sound; {1e3 * spent / len(accepted):.0f} ms each")
    for reason, times in reasons.most_common():
        print(f"  refused {times:4d} times for {reason}")
    for number, drawn in enumerate(accepted[:simulated]):
        teeth = f"{drawn.values.teeth:3d} teeth  " if hasattr(drawn.values, "teeth") else ""
        print(f"{number:3d} {teeth}{judged(drawn, seconds)}", flush=True)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    asked = arguments(
        __doc__,
        designs=(200, "accepted designs"),
        simulated=(40, "of them simulated"),
        seed=(1, "of the random numbers"),
        design=("swiss_lever", "name of the design"),
        seconds=(2.0, "simulated time"),
    )
    sys.exit(main(asked.designs, asked.simulated, asked.seed, asked.design, asked.seconds))
