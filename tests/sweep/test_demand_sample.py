"""Demands for loss assessment: the files against single histories, and read by pelicun itself.

pelicun wants older versions of scipy and pandas, so that the long test makes an environment for the
newest one; RPS_PELICUN may name the Python of one that is there.
"""

from __future__ import annotations

import csv
import json
import os
import subprocess
import venv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import Result
from paper_structures import needs_compiled_kernels

from rpscli.analyses.timehistory import time_history
from rpscli.case.case import load_case
from rpscli.records.loading import load_record
from sweep.small_studies import STUDY

VARY = STUDY[STUDY.index("vary:") : STUDY.index("records:")]
SAMPLE = STUDY.replace(VARY, "").replace("[0.5, 1.0]", "[0.5, 9.0]") + "reports: [demand_sample]\n"


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
    assert "run: python -m pelicun.tools.DL_calculation -c demand_sample_1.json" in " ".join(
        result.stdout.split()
    )
    given = json.loads((workplace / "made" / "demand_sample_2.json").read_text())["DL"]
    assert given["Damage"]["CollapseFragility"]["Theta_1"] == 0.0
    assert given["Options"]["CustomDemandTypes"]["Overturning"]["Acronym"] == "OVT"
    assert given["Demands"]["DemandFilePath"] == "demand_sample_2.csv"
    assert "OVT-0, PFA-0, RID-0, RID-1, RID-2, RID-3 are constant" in result.stderr
    return workplace / "made"


@pytest.mark.evidence("demands for loss assessment", "exact")
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


@pytest.fixture(scope="module")
def pelicun(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A Python that has pelicun."""
    if named := os.environ.get("RPS_PELICUN"):
        return named
    place = tmp_path_factory.mktemp("environment")
    venv.create(place, with_pip=True)
    python = place / ("Scripts" if os.name == "nt" else "bin") / "python"
    install = [str(python), "-m", "pip", "install", "-q", "pelicun"]
    done = subprocess.run(install, capture_output=True, text=True, check=False, env=bare())
    if done.returncode:
        pytest.skip(f"pelicun cannot be installed: {done.stderr[-300:]}")
    return str(python)


def bare() -> dict[str, str]:
    """Without the path of rps, whose environment may hold other versions."""
    return {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}


@pytest.mark.evidence("demands for loss assessment", "program")
@pytest.mark.long
@needs_compiled_kernels
def test_pelicun_runs_what_is_printed_and_tells_the_collapses(
    workplace: Path, sweep_json: Callable[..., Any], pelicun: str
) -> None:
    (workplace / "study.yaml").write_text(SAMPLE, encoding="utf-8")
    found = sweep_json("study.yaml", "-o", "made")
    first = found["findings"]["demand_sample"][0]["found"]
    python, *command = first.rpartition("run: ")[2].split()
    assert python == "python"
    made = workplace / "made"
    components = "ID,Units,Location,Direction,Theta_0,Blocks,Comment\nC.30.11.001a,ea,1,1,1,1,-\n"
    (made / "components.csv").write_text(components, encoding="utf-8")

    def run(number: int) -> tuple[dict[str, Any], list[dict[str, str]]]:
        asked = [word.replace("demand_sample_1", f"demand_sample_{number}") for word in command]
        done = subprocess.run(
            [pelicun, *asked], cwd=made, env=bare(), capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
        with (made / "losses" / "DL_summary.csv").open(encoding="utf-8") as text:
            summary = list(csv.DictReader(text))
        return json.loads((made / "losses" / "DEM_sample.json").read_text()), summary

    for number, overturned in ((1, 0), (2, 2)):
        read, summary = run(number)
        written = sample_of(made / f"demand_sample_{number}.csv")
        for name in list(written)[1:]:
            _, kind, level, direction = name.split("-")
            values = np.array(written[name], dtype=float)
            np.testing.assert_allclose(read[kind][level][direction], values, rtol=1e-9)
        collapsed = [float(row["collapse"]) for row in summary]
        assert collapsed == [float(value) for value in written["1-OVT-0-1"]]
        assert sum(collapsed) == overturned
    # The calibration that the warning gives, and the one that it warns of.
    (warning,) = [text for text in found["warnings"] if "Calibration" in text]
    assert '{"ALL": {"DistributionFamily": "empirical"}, "PID"' in warning  # one PGA for all
    file = made / "demand_sample_2.json"
    given = json.loads(file.read_text())
    given["DL"]["Demands"] |= {
        "CoupledDemands": False,
        "Calibration": json.loads(warning.partition("Calibration: ")[2]),
        "SampleSize": 50,
    }
    file.write_text(json.dumps(given), encoding="utf-8")
    assert len(run(2)[1]) == 50
    given["DL"]["Demands"]["Calibration"] = {"ALL": {"DistributionFamily": "lognormal"}}
    file.write_text(json.dumps(given), encoding="utf-8")
    with pytest.raises(AssertionError, match="standard normal space"):
        run(2)


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
