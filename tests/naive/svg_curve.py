"""Where are the points of an SVG path? By definition: polynomials summed up, arcs from their centre, matrices multiplied out.

Slow and plain, to check the reader with; shares no code with it.
"""

import cmath
import math
from collections.abc import Sequence

import numpy as np

Command = tuple  # letter in upper case, then absolute numbers


def points(commands: list[Command], count: int = 200) -> np.ndarray:
    """Points (n, 2) along all drawn pieces, `count` for each."""
    result: list[complex] = []
    here = start = mirror = 0j
    last: Command = ("M",)
    for command in commands:
        kind, a = command[0], command[1:]
        pairs = [complex(a[k], a[k + 1]) for k in range(0, len(a) - 1, 2)]
        if kind == "M":
            here = start = pairs[0]
        elif kind == "A":
            result += arc(here, a, count) if here != complex(a[5], a[6]) else []
            here = complex(a[5], a[6])
        else:
            if kind == "H":
                control = [here, complex(a[0], here.imag)]
            elif kind == "V":
                control = [here, complex(here.real, a[0])]
            elif kind == "Z":
                control = [here, start]
            elif kind in "ST":
                before = "CS" if kind == "S" else "QT"
                control = [here, 2 * here - mirror if last[0] in tuple(before) else here, *pairs]
            else:
                control = [here, *pairs]
            mirror = control[-2]
            n = len(control) - 1
            for t in np.linspace(0.0, 1.0, count):
                result.append(sum(math.comb(n, k) * t**k * (1 - t) ** (n - k) * p for k, p in enumerate(control)))
            here = control[-1]
        last = command
    return np.array([(p.real, p.imag) for p in result])


def arc(p: complex, numbers: Sequence[float], count: int) -> list[complex]:
    """From p on. Of the two ellipses through both points each gives two arcs; the flags choose one of the four."""
    rx, ry, degrees, large, sweep, x, y = numbers
    turn = cmath.exp(1j * math.radians(degrees))

    def to_circle(z: complex) -> complex:
        z /= turn
        return complex(z.real / rx, z.imag / ry)

    def back(z: complex, grow: float) -> complex:
        return complex(z.real * rx * grow, z.imag * ry * grow) * turn

    a, b = to_circle(p), to_circle(complex(x, y))
    grow = max(1.0, abs(b - a) / 2)
    a, b = a / grow, b / grow
    height = math.sqrt(max(0.0, 1.0 - abs(b - a) ** 2 / 4))
    for side in (1, -1):
        centre = (a + b) / 2 + side * height * 1j * (b - a) / abs(b - a)
        ccw = cmath.phase((b - centre) / (a - centre)) % (2 * math.pi)
        angle = ccw if sweep else ccw - 2 * math.pi
        if height < 1e-9 or (abs(angle) > math.pi) == bool(large):
            return [back(centre + (a - centre) * cmath.exp(1j * angle * t), grow) for t in np.linspace(0.0, 1.0, count)]
    raise AssertionError("no arc fits the flags")


def matrix(name: str, *a: float) -> np.ndarray:
    """The 3 × 3 matrix of one function of a transform attribute."""
    if name == "matrix":
        return np.array([[a[0], a[2], a[4]], [a[1], a[3], a[5]], [0, 0, 1]])
    if name == "translate":
        return np.array([[1, 0, a[0]], [0, 1, a[1]], [0, 0, 1]])
    if name == "scale":
        return np.diag([a[0], a[-1], 1])
    angle = math.radians(a[0])
    if name == "skewX":
        return np.array([[1, math.tan(angle), 0], [0, 1, 0], [0, 0, 1]])
    if name == "skewY":
        return np.array([[1, 0, 0], [math.tan(angle), 1, 0], [0, 0, 1]])
    turned = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
    if len(a) == 1:
        return turned
    return matrix("translate", a[1], a[2]) @ turned @ matrix("translate", -a[1], -a[2])


def mapped(by: np.ndarray, p: np.ndarray) -> np.ndarray:
    return p @ by[:2, :2].T + by[:2, 2]
