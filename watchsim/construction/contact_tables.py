"""How are the contacts of a design written into its scene?"""

from __future__ import annotations

from typing import Protocol

NOTED = 37  # column at which remarks begin


class Law(Protocol):
    """Dimensions with the two coefficients that all contacts of a design share."""

    @property
    def friction(self) -> float: ...

    @property
    def restitution(self) -> float: ...


def contact_tables(law: Law, *pairs: tuple[str, str] | tuple[str, str, str]) -> str:
    """One [[contacts]] table for each pair of sides, "body.LAYER"; a third text is a remark behind the heading."""
    return "\n".join(_table(law, *pair) for pair in pairs)


def _table(law: Law, first: str, second: str, remark: str = "") -> str:
    heading = f"{'[[contacts]]':{NOTED}}# {remark}" if remark else "[[contacts]]"
    return f"""\
{heading}
between     = ["{first}", "{second}"]
friction    = {law.friction!r}
restitution = {law.restitution!r}
"""
