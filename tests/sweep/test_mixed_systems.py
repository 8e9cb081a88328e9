"""A frame without storeys beside a podium with a building, in one study."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rpscli import load_study
from rpscli.case.conditions import Condition
from rpscli.errors import CaseError
from rpscli.report.study.registry import not_judged
from sweep.small_studies import BASE

FRAME_AND_BUILDING: dict[str, Any] = {
    "rps": 1,
    "base": "base.yaml",
    "vary": [{"superstructure.storeys": [0, 3]}],
    "records": ["pulse:half_sine?amplitude=0.3g&period=0.6"],
    "scale": [1.0, 10.0],  # the second one overturns both
    "limits": {"rotation_ratio": 0.5, "drift_ratio": 0.004},
    "reports": [{"fragility": {"limits": {"rotation_ratio": 0.2}}}],
}


@pytest.fixture
def mixed(workplace: Path) -> dict[str, Any]:
    base = BASE.replace("superstructure_mass_ratio: 3", "cap_beam_mass: 200 t")
    (workplace / "base.yaml").write_text(base, encoding="utf-8")
    return FRAME_AND_BUILDING


def test_what_a_system_does_not_have_is_empty_and_not_judged(mixed: dict[str, Any]) -> None:
    study = load_study(mixed)
    result = study.run()
    storeys = result["superstructure.storeys"]
    assert np.isnan(result["drift_ratio"][storeys == 0]).all()
    assert (result["rotation_ratio"] > 0.0).all()
    rows = result.statistics
    frame = rows["superstructure.storeys"] == 0
    for name in ("drift_ratio", "max_floor_acceleration", "fixed_base_ratio"):
        # Not even infinite, though the stronger motion overturns the frame.
        assert np.isnan(rows[f"{name}_largest"][frame]).all(), name
        assert not np.isnan(rows[f"{name}_largest"][~frame]).any(), name
    judged = zip(result.verdicts["superstructure.storeys"], result.verdicts["limit"], strict=True)
    assert sorted(set(judged)) == [(0, "rotation_ratio"), (3, "drift_ratio"), (3, "rotation_ratio")]
    (told,) = [note for note in result.notes if "not judged" in note]
    assert "1 of 2 systems are not judged by it" in told
    assert "drift_ratio needs superstructure.storey_height" in told
    assert (
        len(list(result.report("fragility").tables[""][0].values)) == 4
    )  # two systems, two limits
    assert [*not_judged(study.layout, [Condition("max_base_shear", 1.0, "")])] == [
        told.removeprefix("statistics: ")
    ]


def test_limits_of_the_base_are_for_systems_with_its_building(
    mixed: dict[str, Any], workplace: Path
) -> None:
    base = (workplace / "base.yaml").read_text(encoding="utf-8")
    limited = f"{base}limits: {{rotation_ratio: 0.5, drift_ratio: 0.004}}\n"
    (workplace / "base.yaml").write_text(limited, encoding="utf-8")
    result = load_study({key: mixed[key] for key in mixed if key != "limits"}).run()
    judged = zip(result.verdicts["superstructure.storeys"], result.verdicts["limit"], strict=True)
    assert sorted(set(judged)) == [(0, "rotation_ratio"), (3, "drift_ratio"), (3, "rotation_ratio")]
    assert any("1 of 2 systems are not judged by it" in note for note in result.notes)


def test_what_no_system_has_is_refused(mixed: dict[str, Any]) -> None:
    mixed = {**mixed, "vary": [{"superstructure.storeys": [0]}]}
    with pytest.raises(CaseError, match=r"drift_ratio needs .*, which no system of the study has"):
        load_study(mixed)
    reports = [{"fragility": {"limits": {"drift_ratio": 1}}}]
    with pytest.raises(CaseError, match=r"fragility: drift_ratio needs .*, which not every system"):
        load_study({**FRAME_AND_BUILDING, "reports": reports})
    with pytest.raises(CaseError, match="floor_spectra: a system has no superstructure"):
        load_study({**FRAME_AND_BUILDING, "reports": ["floor_spectra"]})
