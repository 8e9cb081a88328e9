"""J. H. Verner's efficient pair of Runge-Kutta rules of orders 6 and 5, as numbers.

Numerical Algorithms 53 (2010) 383-396. Eight stages and the end, whose acceleration is
the next step's first: y_k = y_0 + h sum_j A[k, j] y'_j, A being `STAGES`. Of what has a
second derivative, positions follow by the squared tableau, y_k = y_0 + h C[k] y'_0 + h^2
sum_j (A A)[k, j] y''_j.
"""

from __future__ import annotations

import numpy as np

END = 8
"""The stage at the end of the step: its weights are those of order 6."""

_ROWS = (
    (),
    (0.06,),
    (0.019239962962962963, 0.07669337037037037),
    (0.035975, 0.0, 0.107925),
    (1.31868341523314826, 0.0, -5.04205806362856223, 4.22067464839541396),
    (-41.8725916643275146, 0.0, 159.432562163137492, -122.119213565010031, 5.53174306620005377),
    (
        -54.4301569353165043, 0.0, 207.067251365018464, -158.610813784589998,
        6.99181658595024232, -0.0185972310622032340,
    ),
    (
        -54.6637417872819768, 0.0, 207.952806255389373, -159.288957474499507,
        7.01874374079694443, -0.0183387859050457231, -0.000511948499788209908,
    ),
    (
        0.0343895786835703601, 0.0, 0.0, 0.258262455563350340, 0.420937118967353715,
        4.40539646966931017, -176.483119024298658, 172.364133401415073,
    ),
)  # fmt: skip

_FIFTH = (
    0.0490996764838248973, 0.0, 0.0, 0.225111222951652415, 0.469468225302956204,
    0.806579224998886771, 0.0, -0.607119489177795967, 0.0568611394404756802,
)  # fmt: skip
"""Weights of order 5 of the stages and the end."""

STAGES = np.zeros((END + 1, END + 1))
for _k, _row in enumerate(_ROWS):
    STAGES[_k, : len(_row)] = _row
SQUARED = STAGES @ STAGES
USED = np.abs(STAGES) + np.abs(SQUARED) > 1e-11
"""Where a stage asks for one before it."""

TIMES = STAGES.sum(axis=1)
ERROR = STAGES[END] - np.array(_FIFTH)
"""Weights of the difference of both rules, over h."""
