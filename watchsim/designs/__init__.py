"""Which mechanisms can be drawn from dimensions, and what is one drawn to mine?

    import watchsim as ws
    mine = ws.designs.swiss_lever(lock="2°", teeth=20)
    mine.write("my_lever")          # drawings (DXF) and scene.toml
    run = ws.simulate(mine.scene())

`ws.designs.names()` lists them; `help(ws.designs.swiss_lever)` lists the dimensions of one. In: dimensions. Out: drawings and a
scene. Imports `construction`, `scene` and below.
"""

from __future__ import annotations

from watchsim.construction import known
from watchsim.designs.maker import Maker


def names() -> tuple[str, ...]:
    """The names of all designs."""
    return known.NAMES


def __getattr__(name: str) -> Maker:
    if name not in known.NAMES:
        raise AttributeError(f"there is no design {name!r}; known are {', '.join(known.NAMES)}")
    return Maker(known.design(name))


def __dir__() -> list[str]:
    return sorted(["names", *known.NAMES])
