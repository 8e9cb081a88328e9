"""Effect of a plane bed on the arms of contact, for floats and arrays (Theory (12.6)).

Beyond x = phi_u the arm of the weight is B - sink w and that of the lift B - root w, with

    w(x) = x^(-1/2) (1 - (x - phi_u)/(x_full - phi_u))^4

The second factor is that of curved ends, up to x_full; of flat ones it is 1, its `fade`
1/(x_full - phi_u) zero.
"""

from __future__ import annotations

import numpy as np

from rpscli.physics.laws.geometry import Value


def patch(x: Value, uplift: float, fade: float) -> tuple[Value, Value]:
    """w and dw/dx [x, uplift rad; fade 1/rad]."""
    root = 1.0 / np.sqrt(x)
    shape = 1.0 - fade * (x - uplift)
    cube = shape * shape * shape
    w = root * cube * shape
    return w, -(0.5 * w / x + 4.0 * fade * cube * root)


def patch_integral(x: Value, uplift: float, fade: float) -> Value:
    """The integral of w over x from 0, by the powers of x in w."""
    a = 1.0 + fade * uplift
    root = np.sqrt(x)
    z = fade * x
    a2 = a * a
    series = a2 * a2 / 0.5 - 4.0 * a2 * a * z / 1.5 + 6.0 * a2 * z * z / 2.5
    area: Value = root * (series - 4.0 * a * z * z * z / 3.5 + z * z * z * z / 4.5)
    return area
