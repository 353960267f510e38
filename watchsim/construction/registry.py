"""Which designs are there? Every module of this package that defines DESIGN, and those that other packages name as entry points
of the group "watchsim.designs" (name -> module:DESIGN). Each is loaded when it is requested."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path

from watchsim import construction
from watchsim.construction.design import Design

GROUP = "watchsim.designs"
FIRST = "swiss_lever"  # listed first, as the one that examples use; all others by the alphabet


@cache
def own() -> tuple[str, ...]:
    """Names of the modules of this package whose source has a line that begins with DESIGN: none is imported for that."""
    found = []
    for one in pkgutil.iter_modules(construction.__path__):
        source = Path(construction.__path__[0], f"{one.name}.py").read_text(encoding="utf-8")
        if "\nDESIGN = " in source:
            found.append(one.name)
    return tuple(sorted(found, key=lambda name: (name != FIRST, name)))


def _others() -> dict[str, EntryPoint]:
    """Those of installed packages; a name of ours stays ours."""
    return {one.name: one for one in entry_points(group=GROUP) if one.name not in own()}


class BrokenDesign(ImportError):
    """An entry point that gives no design."""

    def __init__(self, name: str, point: EntryPoint, words: str) -> None:
        super().__init__(f'the design "{name}" of another package ({point.value}, entry point in {GROUP}) {words}')


def names() -> tuple[str, ...]:
    """Ours first, then those of other packages by the alphabet."""
    return (*own(), *sorted(_others()))


def design(name: str) -> Design:
    """The design of that name; KeyError if there is none, BrokenDesign if that of another package does not load."""
    if name in own():
        ours: Design = importlib.import_module(f"{construction.__name__}.{name}").DESIGN
        return ours
    point = _others()[name]
    try:
        found = point.load()
    except Exception as error:  # whatever the other package does wrong
        raise BrokenDesign(name, point, f"cannot be loaded: {type(error).__name__}: {error}") from error
    if not isinstance(found, Design) or found.name != name:
        raise BrokenDesign(name, point, f'must be a Design of the name "{name}"')
    return found
