"""Does the woodpecker toy move as others have published it?

Two runs of the same toy from the same start, by Moreau's time stepping: the reference of Siconos, whose state at the end is
known; and the animation of M. Baumann, G. Nützi, Simulating the Woodpecker Toy, 2017 (github.com/gabyx/Woodpecker,
WoodpeckerAnimation2.svg), which shows positions and contact forces in 644 frames of 0.43 s and thereby every change of mode:
where a force begins or ends, where it leaves the cone of friction's edge and the sleeve stops, or begins to slide again.
"""

from __future__ import annotations

from watchsim.verification.compared import Row, compared
from watchsim.verification.woodpecker.exact_motion import moments
from watchsim.verification.woodpecker.toy import BEAK, LOWER, UPPER, Toy, modal, start
from watchsim.verification.woodpecker.woodpecker_cycle import Cycle

NAME = "woodpecker toy"
# One peck, with the last frame before each event. The sleeve slides on its lower edge and sticks; breaks loose, slides and lets
# go; its upper edge meets the pole; the beak pecks; the upper edge slides up the pole; the lower edge comes back twice.
FRAMES = (
    ("reverse", LOWER, 32),
    ("slip", LOWER, 91),
    ("open", LOWER, 100),
    ("impact", UPPER, 116),
    ("impact", BEAK, 121),
    ("impact", UPPER, 122),
    ("open", UPPER, 124),
    ("impact", LOWER, 177),
    ("impact", LOWER, 182),
)
FRAME, FRAMES_STEP = 0.43 / 643, 1e-4  # s
FRAMES_SOURCE = "Baumann, Nützi 2017, github.com/gabyx/Woodpecker, WoodpeckerAnimation2.svg, steps of 1e-4 s"
END, END_STEP = 0.29998, 2e-5  # s
AT_END = {"height of the sleeve [m]": -0.04134818676833654, "tilt of the bird [rad]": -0.3409339755504301}
END_SOURCE = "siconos-tutorials, examples/mechanics/Woodpecker/Woodpecker.ref, steps of 2e-5 s"
FASTEST = 250.0  # rad/s: what a step too early or late at each of the impacts does to the tilt of the bird after a peck


def published_rows(toy: Toy, cycle: Cycle) -> list[Row]:
    """The order of events, their times, and the state at the end of a run.

    Times may lie outside their frames by as many steps as there were impacts: each may shift by up to one. So do the steps of
    the other run at each of its nine changes of mode.
    """
    model = modal(toy)
    seen = list(moments(model, *start(toy, model), END))
    first = [(one.cause, one.contact, one.t) for one in seen[1 : len(FRAMES) + 1]]
    order = [frame[:2] for frame in FRAMES]
    wrong = sum(one[:2] != wanted for one, wanted in zip(first, order, strict=True))
    # The cycle begins where the sleeve breaks loose.
    again = [(event.cause, event.contact) for event in cycle.events[1:]]
    wrong += sum(one != wanted for one, wanted in zip(again, [*order[2:], *order[:2]], strict=True))
    outside = max(max(k * FRAME - t, t - (k + 1) * FRAME, 0.0) for (_, _, t), (_, _, k) in zip(first, FRAMES, strict=True))
    impacts = sum(cause == "impact" for cause, _ in order)
    got = {"height of the sleeve [m]": seen[-1].q[0], "tilt of the bird [rad]": seen[-1].q[2]}
    return [
        compared(NAME, "events of the first peck and of the cycle out of order", 0.0, float(wrong), 0.0, FRAMES_SOURCE),
        compared(NAME, "events outside their frames by [s]", 0.0, outside, impacts * FRAMES_STEP, FRAMES_SOURCE),
        *(
            compared(NAME, f"{word} at {END:g} s", value, float(got[word]), FASTEST * END_STEP, END_SOURCE)
            for word, value in AT_END.items()
        ),
    ]
