"""What does the event loop make of a touch that was found far too late? Run without the compiler: prints a row as JSON.

A block slides on the ground with friction, so that the motion is coupled, and a disc falls beside it. The search for the first
closing is made to say that the disc closes at LATE, long after it did.
"""

import json

from moving_scenes import box, circle, ground

from watchsim.scene.forces import Contact, Side
from watchsim.scene.scene import Body, Scene
from watchsim.simulation import event_loop as advance
from watchsim.simulation.simulate import simulate

FALL, FRICTION, SPEED, HEIGHT, LATE = 9.81, 0.3, 0.5, 1e-9, 0.01  # m/s², 1, m/s, m, s


def scene() -> Scene:
    block = Body("block", "free", (0.0, 0.005), velocity=(SPEED, 0.0, 0.0), mass=0.1, inertia=2e-6, loops=(box(0.02, 0.01),))
    disc = Body("disc", "slide", (0.3, 0.05 + HEIGHT), axis=(0.0, 1.0), mass=0.1, loops=(circle(0.05),))
    contacts = tuple(Contact((Side("ground"), Side(name)), FRICTION, 0.0) for name in ("block", "disc"))
    return Scene("late", (ground(1.0), block, disc), contacts=contacts, gravity=(0.0, -FALL), duration=2000.0 * LATE)


def row() -> dict[str, list[float]]:
    """Coordinates and velocities at LATE."""
    of_disc = [k for k, pair in enumerate(simulate(scene(), 1e-9).pairs) if "disc" in str(pair)]
    advance.first_touch = lambda *_: (True, LATE, of_disc[0])
    run = simulate(scene(), LATE)
    return {"t": run.t.tolist(), "q": run.q.tolist(), "u": run.u.tolist()}


if __name__ == "__main__":
    print(json.dumps(row()))
