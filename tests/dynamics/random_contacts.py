"""Which contacts can be made up at random, without any geometry?"""

from typing import Any

import numpy as np

from watchsim.verification.random_problems import BareContacts as Case


def random_case(rng: np.random.Generator, m: int, n: int, **chosen: Any) -> Case:
    """Directions and velocities of order one; masses over two decades; friction up to 0.6."""
    mass = 10.0 ** rng.uniform(-1.0, 1.0, n)
    mu = chosen.get("mu", rng.uniform(0.0, 0.6, m))
    eps = chosen.get("eps", np.full(m, rng.uniform(0.0, 1.0)))
    mu, eps = np.broadcast_to(mu, m).astype(float), np.broadcast_to(eps, m).astype(float)
    more = {key: value for key, value in chosen.items() if key not in ("mu", "eps")}
    return Case(mass, rng.normal(size=(2 * m, n)), mu, eps, **more)
