"""Modes of the fixed base and of the linearised uplifted structure."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rpscli.analyses.result_quantities import (
    FIXED_BASE_MODES,
    LINEAR,
    UPLIFTED,
    VERTICAL_MODES,
    values_of,
)
from rpscli.analyses.settings import require_structure
from rpscli.model.bearing import UpliftedState, uplifted_state
from rpscli.model.podium import PodiumStructure
from rpscli.model.superstructure import Superstructure
from rpscli.physics.laws import geometry
from rpscli.shown import Shown, frozen

Array = NDArray[np.float64]
Complex: TypeAlias = NDArray[np.complex128]


@dataclass(frozen=True, eq=False, repr=False)
class FixedBaseModes(Shown):
    """Modes of the building in full contact, ascending in frequency."""

    frequencies: Array  # (n,) [rad/s]
    damping: Array  # (n,) critical damping ratios
    shapes: Array  # (n, n), one a column, scaled to 1 at the largest component

    @property
    def periods(self) -> Array:
        """(n,) [s]."""
        return frozen(2.0 * math.pi / self.frequencies)

    def profiles(self) -> dict[str, Array]:
        """Shapes, one a row, from the cap beam up (n, n + 1)."""
        return {"shapes": _from_cap_beam(self.shapes)}


@dataclass(frozen=True, eq=False, repr=False)
class UpliftedModes(Shown):
    """Modes after uplift, linearised where the state begins; ascending in frequency."""

    linearised_at: float  # |theta| where that is [rad]: 0, or beta rocking on curved ends

    eigenvalues: Complex
    """(2 n + 2,) the podium's own pair first, then the pairs of the vibration modes
    [1/s]; (4 n + 2,) with vertical springs, whose modes are the last."""
    frequencies: Array  # (n,) omega_u = |lambda| of the vibration modes [rad/s]
    damping: Array  # (n,) xi_u = -Re(lambda)/|lambda|
    frequency_ratio: Array  # (n,) omega_u/omega_0, mode by mode
    damping_ratio: Array  # (n,) xi_u/xi_0; not a number where the building is undamped
    frequency_parameter: float
    """p_ext of the podium's own mode [rad/s]; growth rate if
    the stiffness is negative."""
    frequency_parameter_rigid: float
    """That of the rigid frame [rad/s]; to first order p_hat sqrt|kappa|."""
    shapes: Array
    """(n + 1, n + 1): podium's own mode first, then the vibration modes, one
    a column; u_b first, then the floors, relative to the ground, scaled to 1
    at the largest component."""
    vertical_frequencies: Array
    """(n,) |lambda| of the modes that strain the vertical springs
    most [rad/s]; (0,) without."""
    vertical_damping: Array
    first_order: UpliftedModes | None = None
    """The paper's: to first order in alpha, rocking continued to
    theta = 0. None of those."""

    @property
    def own_period(self) -> float | None:
        """T with which the podium itself swings [s]; None if it does not."""
        rate = abs(float(self.eigenvalues[0].imag))
        return 2.0 * math.pi / rate if rate > 0.0 else None

    @property
    def own_damping(self) -> float | None:
        """-Re(lambda)/|lambda| of the podium itself while it swings; None if it does
        not.
        """
        value = complex(self.eigenvalues[0])
        return None if self.own_period is None else -value.real / abs(value)

    @property
    def own_growth_time(self) -> float | None:
        """Time in which a tilt that falls away grows e-fold [s];
        None if it does not grow.
        """
        rate = float(self.eigenvalues[0].real)
        return 1.0 / rate if self.own_period is None and rate > 0.0 else None

    @property
    def own_motion(self) -> str:
        """Motion in the podium's own mode, in words."""
        if self.own_period is not None:
            return f"swings with T = {self.own_period:.4g} s"
        if self.own_growth_time is not None:
            return f"diverges, e-fold in {self.own_growth_time:.4g} s"
        return (
            "creeps back" if self.eigenvalues[0] != 0.0 else "is in neutral equilibrium"
        )

    @property
    def elastic_shapes(self) -> Array:
        """(n, n + 1): floors relative to the cap beam, u_t - 1 u_b."""
        return frozen(np.asarray(self.shapes[1:] - self.shapes[0]))

    def profiles(self) -> dict[str, Array]:
        """Shapes and elastic shapes, one a row, from the cap beam up (n + 1, n + 1)."""
        return {
            "shapes": self.shapes.T,
            "elastic_shapes": _from_cap_beam(self.elastic_shapes),
        }


@dataclass(frozen=True, eq=False, repr=False)
class ModalResult(Shown):
    """Modes of the structure in each state. Flat ends never roll: `rolling` is None then.

    Parameters
    ----------
    structure
        Podium, bearings and building.
    fixed_base
        None without a building.
    rolling, rocking
        After uplift, on the arcs and on the edges of the columns; of compliant ends as
        if they were rigid, at 0+.
    full_contact
        Of compliant ends: n + 1 modes, shapes from the cap beam up; None on rigid ends,
        where it is `fixed_base`.
    vertical
        Of the floors on vertical springs in full contact; None without.
    """

    structure: PodiumStructure
    fixed_base: FixedBaseModes | None
    rolling: UpliftedModes | None
    rocking: UpliftedModes
    full_contact: FixedBaseModes | None = None
    vertical: FixedBaseModes | None = None

    @property
    def left_out(self) -> tuple[str, ...]:
        """Devices that are not in the modes, as they are not linear."""
        state = uplifted_state(self.structure.bearing, rolling=False)
        laws = (device.linear(self.structure, state) for device in self.structure.devices)
        return tuple(dict.fromkeys(law.left_out for law in laws if law.left_out))

    @property
    def uplifted(self) -> dict[str, UpliftedModes]:
        """The uplifted states that exist, by name."""
        states = {"rolling": self.rolling, "rocking": self.rocking}
        return {name: modes for name, modes in states.items() if modes is not None}

    @property
    def fixed_base_state(self) -> str:
        """Name of the state of the building on its fixed base:
        full contact of rigid ends.
        """
        return "fixed_base" if self.full_contact else "full_contact"

    @property
    def first_yield(self) -> dict[str, dict[str, float]]:
        """By state the storey that its first mode brings to yield first,
        and the base shear then.

        Storeys count from 1, shears are in N. Empty of elastic buildings.
        """
        building = self.structure.superstructure
        fixed = self.fixed_base
        if building is None or building.strengths is None or fixed is None:
            return {}
        found = {}
        shapes = {
            name: modes.elastic_shapes[:, 1] for name, modes in self.uplifted.items()
        }
        for name, shape in {self.fixed_base_state: fixed.shapes[:, 0], **shapes}.items():
            shears = np.abs(building.stiffnesses * np.diff(shape, prepend=0.0))
            base_shears = shears[0] * building.strengths / shears
            storey = int(np.argmin(base_shears))
            found[name] = {"storey": storey + 1, "base_shear": float(base_shears[storey])}
        return found

    @property
    def both_orders(self) -> dict[str, tuple[UpliftedModes, UpliftedModes]]:
        """The uplifted states, exact and to first order."""
        orders = {
            name: (modes, modes.first_order) for name, modes in self.uplifted.items()
        }
        return {name: (exact, paper) for name, (exact, paper) in orders.items() if paper}

    def vibrations(self) -> Iterator[tuple[str, Array]]:
        """Modes of each uplifted state, one a row, and of its vertical springs.

        Frequency and damping, both over those in full contact,
        both to first order (n, 6).
        """
        for name, (exact, first) in self.both_orders.items():
            ratios = exact.frequency_ratio, exact.damping_ratio
            orders = (
                exact.frequencies,
                exact.damping,
                *ratios,
                first.frequencies,
                first.damping,
            )
            yield name, np.transpose(orders)
            if (upright := self.vertical) is not None:
                w = exact.vertical_frequencies
                xi = exact.vertical_damping
                ratios = w / upright.frequencies, _over(xi, upright.damping)
                paper = first.vertical_frequencies, first.vertical_damping
                yield f"{name}_vertical", np.transpose((w, xi, *ratios, *paper))

    def facts(self) -> dict[str, Any]:
        """Periods on a fixed base, and what the podium itself does in each state."""
        fixed = self.fixed_base
        return {
            "fixed-base periods [s]": None if fixed is None else fixed.periods[:3],
            **{
                f"podium, {name}": modes.own_motion
                for name, modes in self.uplifted.items()
            },
        }

    def results(self) -> dict[str, Any]:
        """Lists by mode and the parameters of each state; None for
        one that does not exist.
        """
        fixed = self.fixed_base
        full = self.full_contact
        vertical = VERTICAL_MODES if self.structure.upwards else ()
        states = {
            name: values_of(exact, (*UPLIFTED, *vertical))
            | {"first_order": values_of(paper, (*LINEAR, *vertical))}
            for name, (exact, paper) in self.both_orders.items()
        }
        return {
            "fixed_base": None if fixed is None else values_of(fixed, FIXED_BASE_MODES),
            **({"full_contact": values_of(full, FIXED_BASE_MODES)} if full else {}),
            **(
                {"vertical": values_of(self.vertical, FIXED_BASE_MODES)}
                if vertical
                else {}
            ),
            "rolling": None,
            **states,
            "left_out": list(self.left_out),
            **({"first_yield": self.first_yield} if self.structure.yields else {}),
        }


def modal(structure: PodiumStructure) -> ModalResult:
    """Modal analysis in full contact, rolling and rocking (Theory
    (6.1) to (6.7); paper, 3).

    Exact where a state begins; the paper's first-order values are in
    `first_order` of each state.

    Examples
    --------
    >>> from rpscli import Bearing, PodiumStructure
    >>> podium = PodiumStructure(Bearing(1.5, 0.15, 0.3, 0.5), 4e4, 4e5)
    >>> modal(podium).rolling.linearised_at
    0.0
    """
    require_structure(structure)
    building = structure.superstructure
    return ModalResult(
        structure=structure,
        fixed_base=_on_its_base(building),
        rolling=None
        if structure.bearing.is_flat
        else _both_orders(structure, rolling=True),
        rocking=_both_orders(structure, rolling=False),
        full_contact=_full_contact(structure),
        vertical=_on_its_base(building.upwards if building else None),
    )


def _on_its_base(building: Superstructure | None) -> FixedBaseModes | None:
    if building is None:
        return None
    shapes = _scaled(np.array(building.shapes))
    return FixedBaseModes(building.frequencies, building.damping_ratios, shapes)


def _full_contact(structure: PodiumStructure) -> FixedBaseModes | None:
    """Modes of compliant full contact, in [u_b, u_t] (Theory, section 12)."""
    if (bed := structure.bed) is None:
        return None
    C_u = bed.height
    diameter = 2.0 * structure.bearing.semi_diagonal
    kappa = bed.stiffness * C_u**2 * diameter / structure.weight
    state = UpliftedState(0.0, 0.0, C_u, kappa, C_u**2, (0.0, 0.0, 0.0))
    M, C, K = linearised_matrices(structure, state)
    C[0, 0] += 0.25 * structure.columns_mass * bed.damper
    values, vectors = _eigen(M, C, K, C_u)
    pairs, frequencies, damping = _vibrations(values)
    shapes = np.column_stack([_real_shape(vectors[:, i]) for *_, i in pairs])
    return FixedBaseModes(frequencies, damping, _scaled(shapes))


def _eigen(M: Array, C: Array, K: Array, height: float) -> tuple[Complex, Complex]:
    """Eigenvalues (2 n + 2,) and their vectors [u_b, u_t] (n + 1,
    2 n + 2); `height` is C.
    """
    size = len(M)  # dividing rows is exact where a solver would round
    mass = np.diag(M)[:, None]
    values, vectors = np.linalg.eig(
        np.block([[np.zeros((size, size)), np.eye(size)], [-K / mass, -C / mass]])
    )
    values = values.astype(complex)
    vectors = vectors[:size].astype(complex)
    # Rounding, as large as that of K/M, would be a damping of either sign.
    rounding = 4.0 * np.finfo(float).eps * np.abs(values).max() ** 2
    values.real[(values.imag != 0.0) & (np.abs(values.real) < rounding)] = 0.0
    vectors[0] *= height
    return values, vectors


def _both_orders(structure: PodiumStructure, *, rolling: bool) -> UpliftedModes:
    exact, paper = (
        _uplifted(
            structure, uplifted_state(structure.bearing, rolling=rolling, exact=order)
        )
        for order in (True, False)
    )
    return replace(exact, first_order=paper)


def linearised_matrices(
    structure: PodiumStructure, state: UpliftedState
) -> tuple[Array, Array, Array]:
    """M_L, C_L, K_L in [2 R theta, u_t], each (n + 1, n + 1), about a state at rest.

    With vertical springs in [2 R theta, u_t, y] of the floors' lifts y, each (2 n + 1,
    2 n + 1) (Theory (14.8)).
    """
    # Paper, Table 2, where the sign of the (2 rho - 1) term must be +: as printed, a
    # larger radius would soften the podium (Theory (6.3)). Dampers, elastic tendons:
    # Theory, section 11.
    vibrating = _vibrating(structure, state)
    riding = structure.superstructure_mass * state.arm**2
    size = 1 + structure.storeys * len(vibrating)
    M, C, K = (np.zeros((size, size)) for _ in range(3))
    M[0, 0] = _base_mass(structure, state) + (riding if len(vibrating) < 2 else 0.0)
    stiffness, C[0, 0] = _of_devices(structure, state)
    K[0, 0] = (
        structure.weight * state.kappa / (2.0 * structure.bearing.semi_diagonal)
        + stiffness
    )
    for rows, building, lever in vibrating:
        M[rows, rows] = building.mass_matrix
        for whole, part in ((C, building.damping_matrix), (K, building.stiffness_matrix)):
            whole[0, 0] += lever**2 * part.sum()
            whole[0, rows] = whole[rows, 0] = -lever * part.sum(axis=0)
            whole[rows, rows] = part
    return M, C, K


def _vibrating(
    structure: PodiumStructure, state: UpliftedState
) -> list[tuple[slice, Superstructure, float]]:
    """Floors on their columns and on vertical springs: rows, and how 2
    R theta moves their base.
    """
    if (building := structure.superstructure) is None:
        return []
    upwards = (
        building.upwards if structure.bed is None or state.arm else None
    )  # not on a bed
    n = structure.storeys
    across = (building, state.height)
    both = [across, (upwards, state.arm)] if upwards else [across]
    return [(slice(1 + i * n, 1 + i * n + n), *each) for i, each in enumerate(both)]


def _base_mass(structure: PodiumStructure, state: UpliftedState) -> float:
    """Inertia of columns and cap beam against 2 R theta [kg]."""
    columns = structure.bearing.inertia_ratio - 1.0
    beam = 1.0 + 4.0 * structure.gamma
    A = geometry.inertia(columns, beam, beam, state.squared_distance, 0.0)
    return 0.25 * structure.columns_mass * A


def _of_devices(structure: PodiumStructure, state: UpliftedState) -> tuple[float, float]:
    """Stiffness [N/m] and damping [N s/m] that devices add to 2 R theta."""
    laws = [device.linear(structure, state) for device in structure.devices]
    return sum(law.stiffness for law in laws), sum(law.damping for law in laws)


def _uplifted(structure: PodiumStructure, state: UpliftedState) -> UpliftedModes:
    M, C, K = linearised_matrices(structure, state)
    values, vectors = _eigen(M, C, K, state.height)
    diameter = 2.0 * structure.bearing.semi_diagonal
    stiffness, coefficient = _of_devices(structure, state)
    kappa = state.kappa + stiffness * diameter / structure.weight
    carried = structure.superstructure_mass * state.squared_distance
    rigid = _base_mass(structure, state) + carried
    parameter = math.sqrt(abs(kappa) * structure.weight / (diameter * rigid))
    own = _own_pair(values, kappa, coefficient / rigid, parameter)
    order = np.concatenate([own, np.setdiff1d(np.arange(len(values)), own)])
    values = values[order]
    vectors = vectors[:, order]
    if kappa == 0.0:
        # Zero, twice without dampers: rounding makes it a rate, and splits two into
        # +-sqrt(eps).
        values[:2] = 0.0, (values[0] + values[1]).real if coefficient else 0.0
        vectors[:, : 1 if coefficient else 2] = 1.0
    pairs, frequencies, damping = _vibrations(values[2:])
    indices = np.array([2 + index for *_, index in pairs], dtype=int)
    across, up = _across_and_up(structure, state, vectors[:, indices])
    building = structure.superstructure
    omega = building.frequencies if building else np.empty(0)
    xi = building.damping_ratios if building else np.empty(0)
    return UpliftedModes(
        linearised_at=state.rotation,
        eigenvalues=np.concatenate([values[:2], *(pairs[i][:2] for i in (*across, *up))]),
        frequencies=frequencies[across],
        damping=damping[across],
        vertical_frequencies=frequencies[up],
        vertical_damping=damping[up],
        frequency_ratio=frequencies[across] / omega,
        damping_ratio=_over(damping[across], xi),
        frequency_parameter=math.sqrt(abs(values[0] * values[1])),
        frequency_parameter_rigid=parameter,
        shapes=_scaled(
            np.column_stack(
                [
                    _real_shape(vectors[: 1 + structure.storeys, i])
                    for i in (0, *indices[across])
                ]
            )
        ),
    )


def _over(damping: Array, xi: Array) -> Array:
    """Damping ratios over others, not a number where those are none."""
    return np.divide(damping, xi, out=np.full_like(xi, np.nan), where=xi > 0.0)


def _across_and_up(
    structure: PodiumStructure, state: UpliftedState, vectors: Complex
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Vibration modes that strain columns most, and those that
    strain vertical springs.
    """
    n = structure.storeys
    strains = []
    for rows, part, lever in _vibrating(structure, state):
        drift = vectors[rows] - lever / state.height * vectors[0]
        strains.append(
            np.sum(drift.conj() * (part.stiffness_matrix @ drift), axis=0).real
        )
    if len(strains) < 2:
        return np.arange(n), np.arange(0)
    order = np.argsort(strains[1] / (strains[0] + strains[1]), kind="stable")
    return np.sort(order[:n]), np.sort(order[n:])


def _own_pair(
    values: Complex, kappa: float, decay: float, rate: float
) -> tuple[int, int]:
    """Indices of the podium's own eigenvalues, the growing or the slowest one first."""
    # With negative stiffness one root grows; its partner is the real one nearest to its
    # mirror image shifted by damping, as tall buildings have slower modes. Else it is the
    # slow pair, but dampers may make one of its roots fast. Where it swings, slower real
    # roots are of overdamped vibrations.
    slow = np.argsort(np.abs(values), kind="stable")
    if kappa > 0.0 and decay < 2.0 * rate and values.imag.any():
        slow = slow[values[slow].imag != 0.0]
    if kappa >= 0.0 and (decay == 0.0 or values[slow[0]].imag != 0.0):
        return int(slow[0]), int(slow[1])
    first = int(np.argmax(values.real)) if kappa < 0.0 else int(slow[0])
    real = [i for i, v in enumerate(values) if v.imag == 0.0 and i != first]
    return first, min(real, key=lambda i: abs(values[i] + values[first] + decay))


def _vibrations(
    values: Complex,
) -> tuple[list[tuple[complex, complex, int]], Array, Array]:
    """Pairs ascending in frequency, with the index of each first; their
    frequencies and damping.
    """
    # Real ones are of overdamped modes, higher ones with the larger fast and smaller slow
    # root: the outermost two belong together, and so inwards.
    oscillating = [i for i, v in enumerate(values) if v.imag > 0.0]
    pairs = [(values[i], values[i].conjugate(), i) for i in oscillating]
    real = sorted(
        (i for i, v in enumerate(values) if v.imag == 0.0), key=lambda i: abs(values[i])
    )
    half = len(real) // 2
    pairs += [(values[real[j]], values[real[-1 - j]], real[j]) for j in range(half)]
    pairs.sort(key=lambda pair: abs(pair[0] * pair[1]))
    frequencies = np.array([math.sqrt(abs(a * b)) for a, b, _ in pairs])
    damping = np.array([0.0 - (a + b).real for a, b, _ in pairs]) / (2.0 * frequencies)
    return pairs, frequencies, damping


def _real_shape(vector: Complex) -> Array:
    """The shape at the instant at which its largest component is at its peak."""
    largest = vector[np.argmax(np.abs(vector))]
    return np.asarray((vector / largest).real)


def _scaled(shapes: Array) -> Array:
    """Columns scaled to 1 at the largest component, the roof positive."""
    peak = np.max(np.abs(shapes), axis=0)
    return np.asarray(shapes / np.where(shapes[-1] < 0.0, -peak, peak))


def _from_cap_beam(shapes: Array) -> Array:
    """Shapes, one a row, with the 0 of a cap beam that they are relative to."""
    return np.pad(shapes.T, ((0, 0), (1, 0)))
