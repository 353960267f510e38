"""In which interval may the friction impulse of the expansion lie?

From c - L Lambda_NP to c - L Lambda_NP + l Lambda_NP + l_0, where Lambda_NP is what the normal impulse has beyond eps_N times
that of the compression: the laws `coulomb`, `pg1996` and `shifted` of docs/theory/laws.md.
"""

from __future__ import annotations

from watchsim.jit import kernel
from watchsim.model.records import PG1996, SHIFTED
from watchsim.tolerances import NO_TANGENTIAL


@kernel
def interval(law, restitution, normal, tangential):
    """(L, l, l_0, c, returned): `restitution` is eps_N as used, the impulses are those of the compression.

    `returned` is the tangential impulse eps_N eps_T Lambda_TC, whose slip pg1996 may offset by nu.
    """
    mu, back = law.friction, restitution * normal
    if law.kind == SHIFTED:
        # A smaller eps_N (after an energy gain, at an accumulation) takes eps_T with it.
        share = min(law.tangential, restitution)
        radius = mu * (restitution - share) * normal
        return mu, 2.0 * mu, 2.0 * radius, share * tangential - radius, 0.0
    if law.kind != PG1996:
        return mu, 2.0 * mu, 2.0 * mu * back, -mu * back, 0.0
    returned = restitution * law.tangential * tangential
    least = abs(returned)
    span = max(0.0, mu * back - least)
    if normal <= 0.0 or abs(tangential) <= NO_TANGENTIAL * mu * normal:
        return 0.5 * mu, mu, span, -0.5 * span, returned
    if tangential > 0.0:
        return 0.0, mu, span, least, returned
    return mu, mu, span, -mu * back, returned
