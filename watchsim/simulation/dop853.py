"""Where is everything at a time within the current step?

In a coupled step: the continuous extension, a polynomial of degree 7 in the share x of the step that has passed (Hairer,
Noersett & Wanner 1993, II.6). In a flight: the closed form.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from watchsim.jit import hot_kernel, kernel
from watchsim.simulation.free_motion import acceleration, flow
from watchsim.simulation.scratch import FLIGHT

# Which numbers define the method DOP853?
#
# Dormand & Prince's pair of orders 8(5,3) with a continuous extension of order 7, coefficients as published by Hairer,
# Noersett & Wanner, Solving Ordinary Differential Equations I, 2nd ed. (1993), II.5 and II.6. Stage 12 is the first stage of
# the next step; stages 13 to 15 serve the continuous extension alone.

STAGES = 12


def _matrix(shape: tuple[int, int], rows: dict[int, dict[int, float]]) -> NDArray[np.float64]:
    matrix = np.zeros(shape)
    for i, row in rows.items():
        for j, value in row.items():
            matrix[i, j] = value
    return matrix


C = np.array(
    [
        0.0,
        0.05260015195876773,
        0.0789002279381516,
        0.1183503419072274,
        0.2816496580927726,
        0.3333333333333333,
        0.25,
        0.3076923076923077,
        0.6512820512820513,
        0.6,
        0.8571428571428571,
        1.0,
        1.0,
        0.1,
        0.2,
        0.7777777777777778,
    ]
)
A = _matrix(
    (16, 16),
    {
        1: {0: 0.05260015195876773},
        2: {0: 0.0197250569845379, 1: 0.0591751709536137},
        3: {0: 0.02958758547680685, 2: 0.08876275643042054},
        4: {0: 0.2413651341592667, 2: -0.8845494793282861, 3: 0.924834003261792},
        5: {0: 0.037037037037037035, 3: 0.17082860872947386, 4: 0.12546768756682242},
        6: {0: 0.037109375, 3: 0.17025221101954405, 4: 0.06021653898045596, 5: -0.017578125},
        7: {
            0: 0.03709200011850479,
            3: 0.17038392571223998,
            4: 0.10726203044637328,
            5: -0.015319437748624402,
            6: 0.008273789163814023,
        },
        8: {
            0: 0.6241109587160757,
            3: -3.3608926294469414,
            4: -0.868219346841726,
            5: 27.59209969944671,
            6: 20.154067550477894,
            7: -43.48988418106996,
        },
        9: {
            0: 0.47766253643826434,
            3: -2.4881146199716677,
            4: -0.590290826836843,
            5: 21.230051448181193,
            6: 15.279233632882423,
            7: -33.28821096898486,
            8: -0.020331201708508627,
        },
        10: {
            0: -0.9371424300859873,
            3: 5.186372428844064,
            4: 1.0914373489967295,
            5: -8.149787010746927,
            6: -18.52006565999696,
            7: 22.739487099350505,
            8: 2.4936055526796523,
            9: -3.0467644718982196,
        },
        11: {
            0: 2.273310147516538,
            3: -10.53449546673725,
            4: -2.0008720582248625,
            5: -17.9589318631188,
            6: 27.94888452941996,
            7: -2.8589982771350235,
            8: -8.87285693353063,
            9: 12.360567175794303,
            10: 0.6433927460157636,
        },
        12: {
            0: 0.054293734116568765,
            5: 4.450312892752409,
            6: 1.8915178993145003,
            7: -5.801203960010585,
            8: 0.3111643669578199,
            9: -0.1521609496625161,
            10: 0.20136540080403034,
            11: 0.04471061572777259,
        },
        13: {
            0: 0.056167502283047954,
            6: 0.25350021021662483,
            7: -0.2462390374708025,
            8: -0.12419142326381637,
            9: 0.15329179827876568,
            10: 0.00820105229563469,
            11: 0.007567897660545699,
            12: -0.008298,
        },
        14: {
            0: 0.03183464816350214,
            5: 0.028300909672366776,
            6: 0.053541988307438566,
            7: -0.05492374857139099,
            10: -0.00010834732869724932,
            11: 0.0003825710908356584,
            12: -0.00034046500868740456,
            13: 0.1413124436746325,
        },
        15: {
            0: -0.42889630158379194,
            5: -4.697621415361164,
            6: 7.683421196062599,
            7: 4.06898981839711,
            8: 0.3567271874552811,
            12: -0.0013990241651590145,
            13: 2.9475147891527724,
            14: -9.15095847217987,
        },
    },
)
# Weights of the solution.
B = A[12, :12].copy()
# Error estimates of order 3 and 5, combined as in the book.
E3 = np.array(
    [
        -0.18980075407240762,
        0.0,
        0.0,
        0.0,
        0.0,
        4.450312892752409,
        1.8915178993145003,
        -5.801203960010585,
        -0.4226823213237919,
        -0.1521609496625161,
        0.20136540080403034,
        0.02265179219836082,
        0.0,
    ]
)
E5 = np.array(
    [
        0.01312004499419488,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.2251564463762044,
        -0.4957589496572502,
        1.6643771824549864,
        -0.35032884874997366,
        0.3341791187130175,
        0.08192320648511571,
        -0.022355307863886294,
        0.0,
    ]
)
# Rows 3 to 6 of the continuous extension.
D = _matrix(
    (4, 16),
    {
        0: {
            0: -8.428938276109013,
            5: 0.5667149535193777,
            6: -3.0689499459498917,
            7: 2.38466765651207,
            8: 2.117034582445028,
            9: -0.871391583777973,
            10: 2.2404374302607883,
            11: 0.6315787787694688,
            12: -0.08899033645133331,
            13: 18.148505520854727,
            14: -9.194632392478356,
            15: -4.436036387594894,
        },
        1: {
            0: 10.427508642579134,
            5: 242.28349177525817,
            6: 165.20045171727028,
            7: -374.5467547226902,
            8: -22.113666853125306,
            9: 7.733432668472264,
            10: -30.674084731089398,
            11: -9.332130526430229,
            12: 15.697238121770845,
            13: -31.139403219565178,
            14: -9.35292435884448,
            15: 35.81684148639408,
        },
        2: {
            0: 19.985053242002433,
            5: -387.0373087493518,
            6: -189.17813819516758,
            7: 527.8081592054236,
            8: -11.57390253995963,
            9: 6.8812326946963,
            10: -1.0006050966910838,
            11: 0.7777137798053443,
            12: -2.778205752353508,
            13: -60.19669523126412,
            14: 84.32040550667716,
            15: 11.99229113618279,
        },
        3: {
            0: -25.69393346270375,
            5: -154.18974869023643,
            6: -231.5293791760455,
            7: 357.6391179106141,
            8: 93.40532418362432,
            9: -37.45832313645163,
            10: 104.0996495089623,
            11: 29.8402934266605,
            12: -43.53345659001114,
            13: 96.32455395918828,
            14: -39.17726167561544,
            15: -149.72683625798564,
        },
    },
)


@kernel
def dense(step, i, tau):
    """Component i of y, and its time derivative, at time tau after the start of a coupled step."""
    h, d = step.span.length, step.dense
    x = tau / h
    w = 1.0 - x
    value, slope = d[5, i] + x * d[6, i], d[6, i]
    value, slope = d[4, i] + w * value, w * slope - value
    value, slope = d[3, i] + x * value, x * slope + value
    value, slope = d[2, i] + w * value, w * slope - value
    value, slope = d[1, i] + x * value, x * slope + value
    value, slope = d[0, i] + w * value, w * slope - value
    return step.y0[i] + x * value, (x * slope + value) / h


@kernel
def dense_bend(step, i, tau):
    """Second time derivative of component i of y at time tau after the start of a coupled step."""
    h, d = step.span.length, step.dense
    x = tau / h
    w = 1.0 - x
    value, slope, bend = d[5, i] + x * d[6, i], d[6, i], 0.0
    for term in range(4, -1, -1):  # what is nested in `dense`, times w and x in turn
        share, way = (w, -1.0) if term % 2 == 0 else (x, 1.0)
        value, slope, bend = d[term, i] + share * value, share * slope + way * value, share * bend + 2.0 * way * slope
    return (x * bend + 2.0 * slope) / (h * h)


@kernel
def dense_value(step, i, tau):
    """Component i of y alone."""
    return dense(step, i, tau)[0]


@hot_kernel
def coordinate_within(model, step, i, tau):
    """Coordinate i and its velocity at time tau after the start of the step."""
    if step.span.kind == FLIGHT:
        if step.awake[i] == 0:
            return step.q[i], 0.0
        return flow(model.coordinates[i], step.grip[i], step.q[i], step.u[i], tau)
    n = len(model.coordinates)
    return dense_value(step, i, tau), dense_value(step, n + i, tau)


@kernel
def flight_acceleration(model, step, i, q, u):
    """q'' of coordinate i during a flight."""
    return acceleration(model.coordinates[i], step.grip[i], q, u) if step.awake[i] else 0.0
