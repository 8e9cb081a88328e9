"""Fractiles of floor spectra in a study, against single histories."""

from __future__ import annotations

import numpy as np
from paper_structures import needs_compiled_kernels

from rpscli.analyses.floor_spectra import PERIODS, fixed_base_floor_spectra, isolated_floor_spectra
from rpscli.analyses.timehistory import time_history
from rpscli.case.case import load_case
from rpscli.records.loading import load_record
from sweep.small_studies import STUDY, Sweep, csv_rows

VARY = STUDY[STUDY.index("vary:") : STUDY.index("records:")]
FLOORS = STUDY.replace(VARY, "").replace("[0.5, 1.0]", "[0.5, 9.0]")


@needs_compiled_kernels
def test_fractiles_of_three_histories(sweep: Sweep) -> None:
    made = sweep("study.yaml", study=f"{FLOORS}reports: [floor_spectra]\n")
    assert made.exit_code == 0, made.stderr
    case = load_case("base.yaml")
    found = {}
    for scale in (0.5, 9.0):
        results = [
            time_history(
                case.structure,
                load_record(f"synthetic:?pga=0.5g&duration=4&dt=0.02&seed={seed}").scaled(scale),
                case.analysis,
            )
            for seed in (1, 2, 3)
        ]
        fallen = np.array([r.outcome.startswith("overturned") for r in results])
        isolated = np.array([isolated_floor_spectra(r).pseudo_acceleration for r in results])
        isolated[fallen] = np.inf
        fixed = [fixed_base_floor_spectra(r) for r in results]
        displacement = np.array([f.displacement for f in fixed if f is not None])
        # Of three values the median is the second, the 84 % fractile the largest.
        found[scale] = np.sort(isolated, axis=0), np.sort(displacement, axis=0), fallen
    assert not found[0.5][2].any()
    assert found[9.0][2].sum() == 2
    rows = csv_rows("floor_spectra.csv")
    assert len(rows) == 2 * 3 * len(PERIODS)
    for scale, (isolated, displacement, _) in found.items():
        of_scale = [row for row in rows if float(row["scale [-]"]) == scale]
        for name, values in (
            ("isolated_pseudo_acceleration_50 [m/s2]", isolated[1]),
            ("isolated_pseudo_acceleration_84 [m/s2]", isolated[2]),
            ("fixed_base_displacement_16 [m]", displacement[0]),
        ):
            cells = [float(row[name]) for row in of_scale]
            np.testing.assert_allclose(cells, values.ravel(), rtol=1e-9)
