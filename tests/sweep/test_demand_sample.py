"""Demands for loss assessment: the files against single histories, and read by pelicun itself.

pelicun wants older versions of scipy and pandas. Where these cannot be had beside all the rest,
RPS_PELICUN names the Python of an environment that has pelicun.
"""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from paper_structures import needs_compiled_kernels

from rpscli.analyses.timehistory import time_history
from rpscli.case.case import load_case
from rpscli.records.source import load_record
from sweep.small_studies import STUDY

VARY = STUDY[STUDY.index("vary:") : STUDY.index("records:")]
SAMPLE = STUDY.replace(VARY, "").replace("[0.5, 1.0]", "[0.5, 9.0]") + "reports: [demand_sample]\n"

PELICUN = os.environ.get("RPS_PELICUN", sys.executable)

ASSESSMENT = """\
import json, sys
from pathlib import Path
from pelicun.assessment import DLCalculationAssessment

types = {"Overturning": {"Acronym": "OVT", "UnitType": "unitless"}}
made = DLCalculationAssessment(config_options={"Seed": 1, "CustomDemandTypes": types})
made.calculate_demand(
    demand_path=Path(sys.argv[1]).resolve(), collapse_limits=None, length_unit="m",
    demand_calibration=None, sample_size=int(sys.argv[2]), demand_cloning=None,
    residual_drift_inference=None, coupled_demands=True,
)
sample, units = made.demand.save_sample(save_units=True)
Path("components.csv").write_text(
    "ID,Units,Location,Direction,Theta_0,Blocks,Comment\\nC.30.11.001a,ea,1,1,1,1,-\\n"
)
made.calculate_asset(
    num_stories=3, component_assignment_file="components.csv", component_sample_file=None,
    collapse_fragility_demand_type="OVT", add_irreparable_damage_columns=True,
)
made.calculate_damage(
    length_unit="m", component_database="FEMA P-58",
    collapse_fragility={"DemandType": "OVT", "CapacityDistribution": "N/A", "CapacityMedian": 0.5,
                        "Theta_1": "N/A"},
    irreparable_damage={"DriftCapacityMedian": 0.01, "DriftCapacityLogStd": 0.3},
    damage_process_approach="FEMA P-58",
)
damage = made.damage.save_sample()
collapsed = [float(value) for value in damage["collapse", "0", "1", "0", "1"]]
flat = {"-".join(name): [float(v) for v in sample[name]] for name in sample.columns}
said = {"-".join(name): unit for name, unit in units.items()}
Path("out.json").write_text(json.dumps({"sample": flat, "units": said, "collapsed": collapsed}))
"""


def sample_of(file: Path) -> dict[str, list[str]]:
    with file.open(encoding="utf-8") as text:
        names, units, *rows = csv.reader(text)
    assert units[0] == "Units"
    return {name: [row[n] for row in rows] for n, name in enumerate(names)}


@pytest.fixture
def made(workplace: Path, sweep: Callable[..., Result]) -> Path:
    """A study at an intensity that all survive, and at one that two of three do not."""
    (workplace / "study.yaml").write_text(SAMPLE, encoding="utf-8")
    result = sweep("study.yaml", "-o", "made")
    assert result.exit_code == 0, result.stderr
    assert "CustomDemandTypes" in result.stderr
    return workplace / "made"


@needs_compiled_kernels
def test_the_files_hold_the_demands_of_single_histories(made: Path) -> None:
    case = load_case("base.yaml")
    building = case.structure.superstructure
    assert building is not None
    assert building.storey_heights is not None
    with (made / "demand_sample.csv").open(encoding="utf-8") as text:
        files = list(csv.DictReader(text))
    assert [float(row["scale [-]"]) for row in files] == [0.5, 9.0]
    assert [int(row["overturned [-]"]) for row in files] == [0, 2]
    for number, scale in ((1, 0.5), (2, 9.0)):
        found = sample_of(made / f"demand_sample_{number}.csv")
        for row in range(3):
            record = load_record(f"synthetic:?pga=0.5g&duration=4&dt=0.02&seed={row + 1}")
            result = time_history(case.structure, record.scaled(scale), case.analysis)
            floors = [record.pga * scale, *result.floor_accelerations]
            for level, value in enumerate(floors):
                assert float(found[f"1-PFA-{level}-1"][row]) == pytest.approx(value, rel=1e-9)
            drifts = result.max_drifts / building.storey_heights
            for storey, value in enumerate(drifts, start=1):
                assert float(found[f"1-PID-{storey}-1"][row]) == pytest.approx(value, rel=1e-9)
                assert float(found[f"1-RID-{storey}-1"][row]) == 0.0
            assert float(found["1-RID-0-1"][row]) == pytest.approx(
                abs(result.residual_rotation), rel=1e-9
            )
            assert float(found["1-BRD-0-1"][row]) == pytest.approx(
                result.max_cap_beam_displacement, rel=1e-9
            )
            overturned = result.outcome.startswith("overturned")
            assert float(found["1-OVT-0-1"][row]) == overturned


@needs_compiled_kernels
def test_pelicun_reads_them_and_tells_the_collapses(made: Path) -> None:
    asked = [PELICUN, "-c", "import pelicun"]
    if subprocess.run(asked, capture_output=True, check=False).returncode:
        pytest.skip("pelicun is not installed; RPS_PELICUN may name a Python that has it")
    file = made / "demand_sample_2.csv"
    # Without the path of rps, whose environment may hold other versions.
    done = subprocess.run(
        [PELICUN, "-c", ASSESSMENT, str(file), "3"],
        cwd=made,
        env={name: value for name, value in os.environ.items() if name != "PYTHONPATH"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    read = json.loads((made / "out.json").read_text(encoding="utf-8"))
    written = sample_of(file)
    assert read["units"]["PFA-0-1"] == "mps2"
    assert read["units"]["BRD-0-1"] == "m"
    for name in list(written)[1:]:
        values = np.array(written[name], dtype=float)
        np.testing.assert_allclose(read["sample"][name.removeprefix("1-")], values, rtol=1e-9)
    assert read["collapsed"] == [float(value) for value in written["1-OVT-0-1"]]
    assert sum(read["collapsed"]) == 2


def test_what_it_needs(workplace: Path, sweep: Callable[..., Result]) -> None:
    text = SAMPLE.replace("base: base.yaml", "base: base.yaml\nvary: [superstructure.storeys: [0]]")
    (workplace / "study.yaml").write_text(text, encoding="utf-8")
    assert sweep("study.yaml").exit_code == 3
    (workplace / "study.yaml").write_text(SAMPLE, encoding="utf-8")
    base = (workplace / "base.yaml").read_text(encoding="utf-8")
    (workplace / "base.yaml").write_text(base.replace("  storey_height: 3.0\n", ""))
    result = sweep("study.yaml")
    assert result.exit_code == 3
    assert "storey_height" in result.stderr
