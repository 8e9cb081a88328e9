"""Names of varied values: in titles, rows, legends, tables, files and data frames."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from rpscli.errors import CaseError
from rpscli.report.study.registry import REPORTS
from rpscli.report.study.statistics import summary_columns, summary_tables
from rpscli.studies import load_study
from rpscli.sweep.names import label_parts, labels, names_of_rows, with_names
from rpscli.sweep.points import lay_out
from rpscli.sweep.statistics.summary import summary
from rpscli.sweep.table import point_columns, points_csv
from sweep.small_studies import ALPHA, RHO, STUDY, fallen, made

NAMED = STUDY.replace(
    "curvature_ratio: [critical, 0.5, 0]",
    "curvature_ratio: [critical, 0.5, 0]\n    labels: [tall, medium, flat]",
)
YIELD = "superstructure.yield"
DEVICES = "podium.devices"


def answer(point):
    return fallen(False, max_rotation=0.01 * point["record"], rotation_ratio=0.1)


def axes_of(study_of, lines):
    text = STUDY[: STUDY.index("vary:")] + f"vary:\n{lines}\nrecords: [pulse:sine]\n"
    text = text.replace("pulse:sine", "'pulse:sine?amplitude=1&period=1'")
    return study_of(text).axes


def test_names_stand_in_place_of_values(study_of):
    axes = study_of(NAMED).axes
    keys = [with_names(axes, key) for key in (ALPHA, RHO)]
    assert labels(keys, [0.1, 0.5]) == "tan α = 0.1, medium"
    assert labels(keys, [0.1, 0]) == "tan α = 0.1, flat"
    assert keys == [ALPHA, RHO]  # in files and documents they stay what they are


def test_keys_that_have_one_value_twice_are_named_by_their_row(study_of):
    """Neither key alone tells the rows apart, and where one is asked for, its value
    stands."""
    axes = axes_of(
        study_of,
        f"  - {ALPHA}: [0.1, 0.1, 0.2]\n    {RHO}: [0.5, 0, 0]\n    labels: [a, b, c]",
    )
    keys = [with_names(axes, key) for key in (ALPHA, RHO)]
    assert label_parts(keys, [0.1, 0.5]) == ["a"]
    assert label_parts(keys, [0.2, 0]) == ["c"]
    assert label_parts(keys[:1], [0.1]) == ["tan α = 0.1"]
    assert label_parts(keys[:1], [0.2]) == ["c"]


def test_two_axes_may_have_the_same_names(study_of):
    axes = axes_of(
        study_of,
        f"  - {ALPHA}: [0.1, 0.2]\n    labels: [a, b]\n"
        f"  - {RHO}: [0.5, 0]\n    labels: [a, b]",
    )
    keys = [with_names(axes, key) for key in (ALPHA, RHO)]
    assert label_parts(keys, [0.1, 0.5]) == ["a", "a"]


def test_without_names_those_of_tables_serve_unless_two_are_alike(study_of):
    one = "{kind: friction, force: 1e4}"
    other = "{kind: stop, gap: 0.1, stiffness: 1e7}"
    third = "{kind: stop, gap: 0.1, stiffness: 2e7}"
    (axis,) = axes_of(study_of, f"  - {DEVICES}: [[], [{one}], [{other}], [{third}]]")
    none, friction, *stops = names_of_rows(axis)
    assert (none, friction) == ("no devices", "friction 10000 N")
    assert len({*stops}) == 2
    assert all("stiffness" in name for name in stops)


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("[tall, flat]", "labels has 2 values"),
        ("[tall, 3, flat]", "labels[1] = 3 must be a name"),
        ("[tall, '', flat]", "labels[1] = '' must be a name"),
        ("[tall, flat, flat]", "labels[2] = flat names another value already"),
    ],
)
def test_names_that_name_nothing_are_refused(study_of, line, told):
    with pytest.raises(CaseError) as error:
        study_of(NAMED, ("[tall, medium, flat]", line))
    assert told in str(error.value)


def test_names_without_a_key_are_refused(study_of):
    with pytest.raises(CaseError, match="give the axis a key"):
        study_of(STUDY, ("vary:\n", "vary:\n  - labels: [a, b]\n"))


def test_files_and_columns_have_the_systems(study_of):
    results = made(study_of, answer, text=NAMED)
    head, first, *_ = "".join(points_csv(results.table)).splitlines()
    assert head.split(",")[3:6] == ["system [-]", "record [-]", "scale [-]"]
    assert '"tan α = 0.1, tall"' in first
    systems = point_columns(results.table)["system"]
    assert len({*systems}) == 6
    assert systems[-1] == "tan α = 0.15, flat"
    found = summary(results.table, {})
    columns = {column.name: column.values for column in summary_columns(found)}
    assert [*dict.fromkeys(columns["system"])] == [*dict.fromkeys(systems)]
    heads = [table.heads for table in summary_tables(found) if not isinstance(table, str)]
    rows = next(iter(summary_tables(found))).rows
    assert heads[0][:3] == ["tan α", "ρ", "scale"]
    assert [row[1] for row in rows[:6:2]] == ["tall", "medium", "flat"]


def test_pandas_and_xarray_take_systems_that_differ_in_mappings(tmp_path):
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    from pathlib import Path

    base = Path(__file__).parents[2] / "cases" / "yielding_storeys.yaml"
    values = [None, {"ratio": 1.3, "hardening": 0.05}]
    study = load_study(
        {
            "rps": 1,
            "title": "x",
            "base": str(base),
            "analysis": "pushover",
            "vary": [{YIELD: values, "labels": ["elastic", "yields"]}],
        }
    )
    frame = study.run(jobs=1).to_dataframe()
    counts = frame.groupby("system").size()
    assert counts.to_dict() == {"elastic": 1, "yields": 1}
    assert frame[YIELD].tolist() == values
    array = frame.set_index("system").to_xarray()
    assert array["critical_rotation"].sizes == {"system": 2}


def texts_of(found):
    figure = Figure()
    found.figure("title")(figure)
    legends = [t.get_text() for each in figure.legends for t in each.get_texts()]
    ticks = [t.get_text() for a in figure.axes for t in a.get_xticklabels()]
    rows = [t.get_text() for a in figure.axes for t in a.get_yticklabels()]
    return [a.get_title() for a in figure.axes] + legends + ticks + rows


@pytest.mark.parametrize(
    ("kind", "options", "names"),
    [
        ("fragility", "{series: RHO, resamples: 0}", {"tall", "medium", "flat"}),
        ("ida", "{panels: RHO}", {"tall", "medium", "flat"}),
        ("lines", "{x: RHO, result: max_rotation}", {"tall", "medium", "flat"}),
        ("lines", "{x: scale, result: max_rotation, series: RHO}", {"tall", "flat"}),
        ("table", "{columns: RHO}", {"tall", "medium", "flat"}),
        ("table", "{rows: RHO, columns: scale}", {"tall", "medium", "flat"}),
        ("rotation", "{key: RHO}", {"tall", "medium"}),
        ("scatter", "{x: scale, y: rotation_ratio, series: RHO}", {"tall", "flat"}),
    ],
)
def test_figures_call_systems_by_their_names(study_of, kind, options, names):
    text = f"{NAMED}reports: [{kind}: {options.replace('RHO', RHO)}]\n"
    falls = kind == "fragility"

    def told(point):
        over = falls and point["record"] * point["scale"] > 1.0
        return fallen(over, max_rotation=0.01 * point["record"], rotation_ratio=0.1)

    results = made(study_of, told, text=text)
    (request,) = results.table.layout.study.reports
    found = REPORTS[kind].make(results, request.options)
    assert names <= {part for text in texts_of(found) for part in text.split("\n")}
    if kind == "fragility":
        (part, *_) = found.parts()
        assert [row[0] for row in part.rows] == ["tall", "medium", "flat"]
        assert np.any(found.tables[""][0].values)


def test_names_move_no_point(study_of):
    named, plain = (lay_out(study_of(text)) for text in (NAMED, STUDY))
    assert [p.values for p in named] == [p.values for p in plain]
    assert named.plan.keys == plain.plan.keys
