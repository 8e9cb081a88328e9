"""`import rpscli` as a library."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import rpscli


@pytest.mark.parametrize("name", rpscli.__all__)
def test_every_public_name_exists(name: str) -> None:
    assert getattr(rpscli, name) is not None
    assert name in dir(rpscli)


def test_samples_as_a_table(monkeypatch: pytest.MonkeyPatch) -> None:
    case = rpscli.load_case(Path(__file__).parents[2] / "cases" / "six_storey.yaml")
    motion = rpscli.load_record("pulse:sine?amplitude=0.3g&period=0.5")
    result = rpscli.time_history(case.structure, motion, case.analysis)
    table = result.to_dataframe()
    assert table["rotation"].tolist() == result.trace.rotation.tolist()
    assert table["storey_6_shear"].tolist() == result.trace.storey_shears[:, 5].tolist()
    assert table.attrs["units"]["storey_6_shear"] == "N"
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match="needs pandas: pip install pandas"):
        result.to_dataframe()


def test_other_names_do_not() -> None:
    with pytest.raises(AttributeError, match="no attribute 'pushower'"):
        rpscli.pushower  # noqa: B018
