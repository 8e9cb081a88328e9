"""What the end of a step demands of floors and contacts, in all lanes together.

A storey shear is a sum over modes, sum_r s_ir q_r, so that all of them cost n^2 products a sample,
more than the motion itself. By Cauchy and Schwarz's inequality

    (sum_r s_ir q_r)^2 <= (sum_r s_ir^2/g_r) (sum_r g_r q_r^2)

whatever the weights g_r > 0: while the last sum, which costs n, stays below the least

    (largest shear so far of storey i)^2/(sum_r s_ir^2/g_r),

no storey's shear is raised. The same holds for floor accelerations, sums over the modal forces.
`rpscli.analyses.kernels.systems` says which weights.
"""

from __future__ import annotations

import math

from rpscli.physics.core.compile import compiled
from rpscli.physics.core.records import Record
from rpscli.physics.planar.equation_of_motion import cap_beam_acceleration, contact_measures

SURELY = 1.0 - 1e-9
"""Room for the rounding of either side."""


@compiled
def written(x: float) -> float:
    """The same number, to be written wherever it came from (but -0 becomes 0).

    What is either new or what stood there before invites the compiler to write only the new ones,
    lane by lane; processors take ten times as long for that as for writing all.
    """
    return x + 0.0


@compiled
def observe_ends(s: Record) -> None:
    """Raise the demands of contacts and the largest tilt by those at the ends of accepted steps.

    Says in `demands_rise` where those of the floors may be raised too.
    """
    lanes = s.lanes
    for l in range(lanes):
        s.shear_bound[l], s.acceleration_bound[l] = 0.0, 0.0
    for r in range(s.n):
        for l in range(lanes):
            q, force = s.next_q[r, l], s.modal_force[r, l]
            s.shear_bound[l] += s.shear_weight[r, l] * (q * q)
            s.acceleration_bound[l] += s.acceleration_weight[r, l] * (force * force)
    for l in range(lanes):
        sheared = s.shear_bound[l] > s.shear_below_all_maxima[l]
        accelerated = s.acceleration_bound[l] > s.acceleration_below_all_maxima[l]
        s.demands_rise[l] = s.at_sample[l] if sheared | accelerated else 0.0
    for l in range(lanes):
        across, upwards = cap_beam_acceleration(
            s.side[l],
            s.diameter[l],
            s.phase_c[l],
            s.next_B[l],
            s.next_C[l],
            s.next_theta_dot[l],
            s.next_theta_ddot[l],
        )
        raise_contacts(s, l, s.at_sample[l], across, upwards, s.next_V[l] + s.next_push[l])
    for l in range(lanes):
        theta = s.next_theta[l]
        higher = (s.accepted[l] > s.peak_inside[l]) & (theta > s.max_theta[l])
        time = s.interval_start[l] + (s.time[l] + s.step[l])
        s.max_theta[l] = written(theta if higher else s.max_theta[l])
        s.max_theta_time[l] = written(time if higher else s.max_theta_time[l])


@compiled
def raise_contacts(s: Record, l: int, look: float, across: float, upwards: float, V: float) -> None:
    """Raise friction demands and lower least normal forces of a lane, where look > 0."""
    top, bottom, light_top, light_bottom = contact_measures(
        s.cap_beam_mass[l],
        s.floors_mass[l],
        s.columns_mass[l],
        across,
        upwards,
        V,
        s.next_a_g[l],
        s.next_g_up[l],
        s.gravity[l],
        s.next_pull[l],
    )
    # What is not looked at counts as nothing; without branches, so that lanes go together.
    seen = look > 0.0
    s.friction_top[l] = written(max(s.friction_top[l], top if seen else 0.0))
    s.friction_bottom[l] = written(max(s.friction_bottom[l], bottom if seen else 0.0))
    s.normal_top[l] = written(min(s.normal_top[l], light_top if seen else math.inf))
    s.normal_bottom[l] = written(min(s.normal_bottom[l], light_bottom if seen else math.inf))


@compiled
def raise_floors(s: Record, l: int, system: Record) -> None:
    """Raise the demands of a lane's storeys and floors by those at the end of its step."""
    for i in range(s.n):
        shear, acceleration = 0.0, 0.0
        for r in range(s.n):
            shear += system.storey_shear_of[r, i] * s.next_q[r, l]
            acceleration += system.phi[r, i] * s.modal_force[r, l]
        s.storey_shear[l, i] = max(s.storey_shear[l, i], abs(shear))
        s.floor_acceleration[l, i] = max(s.floor_acceleration[l, i], abs(acceleration))
    set_below_all_maxima(s, l, system)


@compiled
def set_below_all_maxima(s: Record, l: int, system: Record) -> None:
    """Note what raises no storey's shear and no floor's acceleration, see this module."""
    shear, acceleration = math.inf, math.inf
    for i in range(s.n):
        shear = min(shear, below_maximum(s.storey_shear[l, i], system.shear_bound_of[i]))
        largest = s.floor_acceleration[l, i]
        acceleration = min(acceleration, below_maximum(largest, system.acceleration_bound_of[i]))
    s.shear_below_all_maxima[l], s.acceleration_below_all_maxima[l] = shear, acceleration


@compiled
def below_maximum(largest: float, bound: float) -> float:
    """What the weighted squares of the modes may reach without raising the largest demand."""
    return SURELY * (largest * largest) * bound
