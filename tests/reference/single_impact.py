"""What do Poisson's law and friction make of one contact? In closed form (method paper 2.10, cases 1 to 3).

The tangential laws differ only in the interval of the expansion's friction impulse, which cannot make the
bodies approach again.

Works in any number type: floats, or mpmath numbers where all digits matter.
"""

from typing import Any, NamedTuple


class Impact(NamedTuple):
    """Total impulses, rates after the impact, and what happened in the compression: "stick" or "slip"."""

    normal: Any
    tangential: Any
    v_n: Any
    v_t: Any
    regime: str


def single_impact(
    G: tuple[Any, Any, Any], v: tuple[Any, Any], mu: Any, eps: Any, law: str = "coulomb", eps_t: Any = 0, nu: Any = 0
) -> Impact:
    """G = (G_n, G_c, G_t), v = (normal, tangential) rates before, v[0] < 0. Needs mu |G_c| < G_n.

    Compression ends with the normal rate zero; the expansion returns eps times its normal impulse. In both phases
    friction brings the tangential rate to zero if mu times the normal impulse of the phase allows it.
    """
    G_n, G_c, G_t = G
    Lam_N, Lam_T, regime = _compression(G, v, mu)
    v_t = v[1] + G_c * Lam_N + G_t * Lam_T
    more_N = eps * Lam_N
    low, high = _interval(law, mu * more_N, eps, eps_t, Lam_T)
    offset = nu * G_t * eps * eps_t * Lam_T if law == "pg1996" else 0
    more_T = min(max(-(v_t + G_c * more_N - offset) / G_t, low), high)
    normal, tangential = Lam_N + more_N, Lam_T + more_T
    v_n = v[0] + G_n * normal + G_c * tangential
    return Impact(normal, tangential, v_n, v[1] + G_c * normal + G_t * tangential, regime)


def _interval(law: str, cone: Any, eps: Any, eps_t: Any, Lam_T: Any) -> tuple[Any, Any]:
    """Bounds of the friction impulse in the expansion, whose friction cone is `cone`."""
    if law == "pg1996":
        least = eps * eps_t * abs(Lam_T)
        if Lam_T == 0:
            return -cone / 2, cone / 2
        return (least, cone) if Lam_T > 0 else (-cone, -least)
    if law == "shifted":
        radius = cone * (1 - eps_t / eps) if eps else 0
        return eps_t * Lam_T - radius, eps_t * Lam_T + radius
    return -cone, cone


def _compression(G: tuple[Any, Any, Any], v: tuple[Any, Any], mu: Any) -> tuple[Any, Any, str]:
    G_n, G_c, G_t = G
    v_n, v_t = v
    det = G_n * G_t - G_c * G_c
    if det > 0:
        Lam_N = (G_c * v_t - G_t * v_n) / det
        Lam_T = (G_c * v_n - G_n * v_t) / det
        if abs(Lam_T) <= mu * Lam_N:
            return Lam_N, Lam_T, "stick"
    for s in (1, -1):
        Lam_N = -v_n / (G_n - s * mu * G_c)
        Lam_T = -s * mu * Lam_N
        if s * (v_t + G_c * Lam_N + G_t * Lam_T) >= 0:
            return Lam_N, Lam_T, "slip"
    raise ValueError("no consistent compression: mu |G_c| is not below G_n")
