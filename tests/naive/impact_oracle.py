"""What do two contacts do in an impact? The published complementarity problems, whose bases are tried one by one.

The matrices are those of docs/theory/method.md 2.6, put down block by block.
"""

import numpy as np
from naive.lcp_oracle import solutions

from watchsim.model import PG1996, SHIFTED, Records


def blocks(G: np.ndarray) -> tuple[np.ndarray, ...]:
    """G_NN, G_NT, G_TN, G_TT."""
    return G[::2, ::2], G[::2, 1::2], G[1::2, ::2], G[1::2, 1::2]


def interval_problem(G: np.ndarray, low: np.ndarray, span: np.ndarray, right: np.ndarray) -> np.ndarray:
    """(normal unknowns, distances from the lower ends); there must be one solution alone."""
    NN, NT, TN, TT = blocks(G)
    m = len(low)
    zero, one, L = np.zeros((m, m)), np.eye(m), np.diag(low)
    A = np.block([[NN - NT @ L, NT, zero], [TN - TT @ L, TT, one], [np.diag(span), -one, zero]])
    found = solutions(A, right, 1e-10)
    assert found and all(np.allclose(found[0], other, atol=1e-8) for other in found)
    return found[0][: 2 * m].reshape(2, m)


def compressed(G: np.ndarray, rates: np.ndarray, mu: np.ndarray) -> np.ndarray:
    """Impulses N, T, N, T, ... of the compression."""
    normal, above = interval_problem(G, mu, 2.0 * mu, np.concatenate([rates[::2], rates[1::2], 0.0 * mu]))
    return np.ravel([normal, above - mu * normal], order="F")


def expanded(G: np.ndarray, rates: np.ndarray, first: np.ndarray, eps: np.ndarray, laws: Records) -> np.ndarray:
    """Impulses of the expansion: `rates` are those before the impact, `first` the impulses of the compression."""
    mu, kind = laws.friction, laws.kind[0]
    N_C, T_C, back = first[::2], first[1::2], eps * first[::2]
    NN, NT, TN, TT = blocks(G)
    offset = 0.0 * mu
    if kind == PG1996:
        forward = 0.5 * (1.0 + np.sign(T_C))
        least = eps * laws.tangential * np.abs(T_C)
        low, span, rest = (1.0 - forward) * mu, mu, mu * back - least
        shift = forward * least - (1.0 - forward) * mu * back
        shift = np.where(T_C == 0.0, -0.5 * mu * back, shift)
        offset = laws.nu * eps * laws.tangential * T_C
    else:
        share = np.minimum(laws.tangential, eps) if kind == SHIFTED else 0.0 * mu
        low, span, rest = mu, 2.0 * mu, 2.0 * mu * (eps - share) * N_C
        shift = share * T_C - mu * (eps - share) * N_C
    after = rates + G @ first
    normal = after[::2] + NN @ back + NT @ shift
    tangential = after[1::2] + TN @ back + TT @ shift - TT @ offset
    extra, above = interval_problem(G, low, span, np.concatenate([normal, tangential, rest]))
    return np.ravel([back + extra, above + shift - low * extra], order="F")
