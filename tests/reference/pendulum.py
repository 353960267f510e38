"""How does a pendulum swing, and how against a stop at its lowest point? Exact, by elliptic functions (mpmath).

With k = sin(amplitude / 2) and w = sqrt(m g l / J): sin(angle / 2) = k sn(w t + K, k), quarter period K(k) / w, rate 2 w k at
the bottom. An impact there with restitution e turns k into e k; each return to the stop then takes 2 K(k) / w.
"""

from mpmath import asin, ellipfun, ellipk, mp, mpf, sin


def swing(t: float, amplitude: float, w: float) -> tuple[float, float]:
    """Angle (rad) and rate of the free pendulum released at rest at `amplitude`."""
    with mp.workdps(40):
        k = sin(mpf(amplitude) / 2)
        phase = mpf(w) * mpf(t) + ellipk(k * k)
        return _from_bottom(k, phase, mpf(w))


def against_stop(t: float, amplitude: float, w: float, restitution: float) -> tuple[float, float]:
    """Angle (>= 0) and rate with a stop at angle 0, released at rest at `amplitude` > 0."""
    with mp.workdps(40):
        k, now = sin(mpf(amplitude) / 2), mpf(t)
        quarter = ellipk(k * k) / w
        if now < quarter:
            return swing(t, amplitude, w)
        now -= quarter
        k *= restitution
        while now >= 2 * ellipk(k * k) / w:
            now -= 2 * ellipk(k * k) / w
            k *= restitution
        return _from_bottom(k, mpf(w) * now, mpf(w))


def touches(number: int, amplitude: float, w: float, restitution: float) -> list[float]:
    """The first times at which the pendulum meets the stop."""
    with mp.workdps(40):
        k = sin(mpf(amplitude) / 2)
        times = [ellipk(k * k) / w]
        for _ in range(number - 1):
            k *= restitution
            times.append(times[-1] + 2 * ellipk(k * k) / w)
        return [float(t) for t in times]


def _from_bottom(k: mpf, phase: mpf, w: mpf) -> tuple[float, float]:
    """State `phase` after passing the bottom upwards: sin(angle/2) = k sn, rate = 2 w k cn."""
    square = k * k
    return float(2 * asin(k * ellipfun("sn", phase, m=square))), float(2 * w * k * ellipfun("cn", phase, m=square))
