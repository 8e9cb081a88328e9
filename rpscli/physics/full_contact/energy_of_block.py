"""What flows in a block of exact steps in full contact (Theory, section 8)."""

from __future__ import annotations

from rpscli.physics.compile import compiled
from rpscli.physics.formulae.oscillator import decay
from rpscli.physics.formulae.quadrature import NODES, WEIGHTS
from rpscli.physics.state import INSTANTS, Record

GROWTH = 1.5
"""Ratio of the ends of the parts over which a strongly damped velocity is integrated: four nodes in
each leave 1e-8 of what decays."""


@compiled
def fill_work(block: Record, system: Record, which: int, h: float) -> None:
    """Integrals over a step of every mode's velocity v, as forms of how the step begins.

    Left to itself under a load p + p' t it is v = q0' C + q0'' S + p' P, with C = c + xi w s, S = s
    and P = (1 - C)/w^2 of `formulae.oscillator`. The integrals of v^2 (six coefficients) and of v t
    (three) are taken by Gauss's rule: over the whole step, or over parts that grow with the time
    where the velocity decays within the step. They know nothing of where the step ends, nor of
    energy, so that the audit can show something.

    Parameters
    ----------
    block
        Its `work` of a WHOLE_STEP or a SHORT_STEP is written.
    which
        The step.
    h
        Its length [s].
    """
    for r in range(system.n):
        work, rate = block.work[which, r], 2.0 * system.two_xi_omega[r]
        for j in range(len(work)):
            work[j] = 0.0
        start, end = 0.0, (h if rate * h <= 1.0 else 1.0 / rate)
        while start < h:
            for i in range(len(NODES)):
                t, weight = start + (end - start) * NODES[i], (end - start) * WEIGHTS[i]
                c, S = decay(system.omega[r], system.xi[r], t)
                C = c + system.xi[r] * system.omega[r] * S
                P = (1.0 - C) / system.omega2[r]
                work[0] += weight * C * C
                work[1] += weight * S * S
                work[2] += weight * P * P
                work[3] += 2.0 * weight * C * S
                work[4] += 2.0 * weight * C * P
                work[5] += 2.0 * weight * S * P
                work[6] += weight * t * C
                work[7] += weight * t * S
                work[8] += weight * t * P
            start, end = end, min(GROWTH * end, h)


@compiled
def book_energy_of_block(block: Record, system: Record, which: int) -> None:
    """Energy put in by the ground, -int a_g 1^T M u' dt, and damped during each step [J].

    Parameters
    ----------
    block, system
        Steps in full contact: `input` and `damped` are written. The structure.
    which
        The step, see `fill_work`.
    """
    for k in range(INSTANTS):
        block.input[k], block.damped[k] = 0.0, 0.0
    for r in range(block.n):
        Gamma, omega2, two_xi_omega = system.Gamma[r], system.omega2[r], system.two_xi_omega[r]
        work = block.work[which, r]
        for k in range(INSTANTS - 1):
            a_g, slope = block.a_g[k], block.a_g_slope[k]
            q, v, moved = block.qs[r, k], block.dqs[r, k], block.qs[r, k + 1] - block.qs[r, k]
            g, j = -Gamma * a_g - two_xi_omega * v - omega2 * q, -Gamma * slope
            later = work[6] * v + work[7] * g + work[8] * j
            squares = work[0] * (v * v) + work[1] * (g * g) + work[2] * (j * j)
            mixed = work[3] * (v * g) + work[4] * (v * j) + work[5] * (g * j)
            block.input[k] -= Gamma * (a_g * moved + slope * later)
            block.damped[k] += two_xi_omega * (squares + mixed)
