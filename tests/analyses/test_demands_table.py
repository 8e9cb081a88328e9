"""Demands of many histories as columns, and as a table of pandas."""

import sys
from types import SimpleNamespace

import numpy as np
import pytest
from paper_structures import needs_compiled_kernels, podium

import rpscli
from rpscli.errors import UsageError
from rpscli.records.loading import load_record
from rpscli.shown import data_frame

PULSE = "pulse:sine?amplitude=0.4g&period=0.8"


@pytest.fixture
def frames(monkeypatch):
    """A stand-in for pandas, whose frames are the columns that it was given."""

    def made(columns):
        return SimpleNamespace(columns=dict(columns), attrs={})

    monkeypatch.setitem(sys.modules, "pandas", SimpleNamespace(DataFrame=made))


@needs_compiled_kernels
def test_a_row_is_a_history(frames):
    """Numbers are those of the demands, NaN where one is None; units are of the table."""
    motion = load_record(PULSE)
    pair = rpscli.MotionComponents(motion, y=motion.scaled(0.5))
    structure = podium(0)
    found = [
        *rpscli.demand(structure, [motion, motion.scaled(0.01)]),
        rpscli.demand(structure, pair),
    ]
    table = rpscli.table(iter(found))
    for name, column in table.items():
        assert len(column) == 3
        for value, each in zip(column.tolist(), found, strict=True):
            own = each.scalars().get(name)
            assert value == own or (own is None and np.isnan(value)), name
    assert np.isnan(table["max_rotation_azimuth"]).tolist() == [True, True, False]
    assert table["max_rotation"].dtype == float
    assert table.units["max_rotation"] == "rad"
    frame = table.to_dataframe()
    assert frame.attrs["units"] == table.units
    assert list(frame.columns) == list(table)
    assert list(rpscli.table(found[0])["outcome"]) == [found[0].outcome]


def test_what_is_no_demand_is_refused():
    with pytest.raises(UsageError, match=r"demands\[0\] was given as int"):
        rpscli.table([5])
    assert rpscli.table([]) == {}


def test_numbers_that_are_not_there_are_nan(frames):
    """Only beside numbers: texts, flags and what is whole stay."""
    columns = {
        "friction": np.array([None, 0.5], dtype=object),
        "law": np.array([None, "rigid"], dtype=object),
        "flag": np.array([None, True], dtype=object),
        "whole": np.array([1, 2]),
        "none": np.array([None, None], dtype=object),
    }
    made = data_frame(columns).columns
    assert np.isnan(made["friction"][0])
    assert made["friction"][1] == 0.5
    for name in ("law", "flag", "whole", "none"):
        assert made[name] is columns[name]


def test_pandas_itself_takes_them():
    pandas = pytest.importorskip("pandas")
    made = data_frame({"friction": np.array([None, 0.5], dtype=object)})
    assert isinstance(made, pandas.DataFrame)
    assert made["friction"].dtype == float
    assert made["friction"].isna().tolist() == [True, False]
