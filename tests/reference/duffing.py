"""How does a body on a spring swing whose torque is k θ + c θ³? Exact, by elliptic functions (mpmath).

Released at rest at A: θ = A cn(Ω t, m), Ω² = (k + c A²) / J, m = c A² / (2 (k + c A²)), period 4 K(m) / Ω (Nayfeh and Mook,
*Nonlinear Oscillations*, 1979, section 4.1). A spring that softens has m < 0.
"""

from mpmath import ellipfun, ellipk, mp, mpf, sqrt


def swing(t: float, amplitude: float, inertia: float, stiffness: float, cubic: float) -> tuple[float, float]:
    """Angle (rad) and rate after `t`."""
    with mp.workdps(40):
        rate, m = _constants(amplitude, inertia, stiffness, cubic)
        cn, sn, dn = (ellipfun(name, rate * mpf(t), m=m) for name in ("cn", "sn", "dn"))
        return float((amplitude * cn).real), float((-amplitude * rate * sn * dn).real)


def period(amplitude: float, inertia: float, stiffness: float, cubic: float) -> float:
    with mp.workdps(40):
        rate, m = _constants(amplitude, inertia, stiffness, cubic)
        return float(4 * ellipk(m) / rate)


def _constants(amplitude: float, inertia: float, stiffness: float, cubic: float) -> tuple[mpf, mpf]:
    at_turn = mpf(stiffness) + mpf(cubic) * mpf(amplitude) ** 2
    return sqrt(at_turn / mpf(inertia)), mpf(cubic) * mpf(amplitude) ** 2 / (2 * at_turn)
