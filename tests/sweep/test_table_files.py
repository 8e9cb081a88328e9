"""Tables of reports as LaTeX and as workbooks."""

import io
import re

import numpy as np
import openpyxl
import pytest

from rpscli.errors import CaseError, RpsError
from rpscli.report import table_files
from rpscli.report.study.registry import REPORTS
from rpscli.report.table import Column, Table, csv_text
from rpscli.report.table_files import latex, latex_text, workbook
from rpscli.studies import load_study
from sweep.small_studies import ALPHA, RHO, STUDY, csv_rows, fallen, made


def answer(point):
    demand = point["scale"] * point["record"] / (40.0 * point[ALPHA] ** 2)
    falls = demand > 4.0 and point[RHO] != 0
    return fallen(falls, rotation_ratio=demand / 10, max_base_shear=1e3)


def files_of(study_of, report, text=STUDY):
    results = made(study_of, answer, text=f"{text}reports: [{report}]\n")
    (request,) = results.table.layout.study.reports
    found = REPORTS[request.kind].make(results, request.options)
    named = found.files("x", "A 50 % title", formats=request.options.formats)
    return found, {name: of for name, of in named if not name.endswith(".png")}


def rows_of(text):
    """Cells of a LaTeX table, heads first."""
    lines = [line for line in text.splitlines() if line.endswith(r" \\")]
    return [line.removesuffix(r" \\").split(" & ") for line in lines]


def test_a_report_has_a_table_for_latex(study_of):
    found, files = files_of(study_of, "fragility: {resamples: 0, formats: tex}")
    assert [name for name in files if name.endswith(".tex")] == ["x.tex"]
    (table, *_) = found.parts()
    heads, *rows = rows_of(files["x.tex"])
    assert heads[0] == r"tan $\alpha$"
    assert len(heads) == len(table.heads)
    assert [row[-1] for row in rows] == [row[-1] for row in table.rows]
    text = files["x.tex"]
    for rule in (r"\toprule", r"\midrule", r"\bottomrule", r"\end{tabular}"):
        assert text.count(rule) == 1
    (sides,) = re.findall(r"\\begin{tabular}{([lr]+)}", text)
    assert len(sides) == len(heads)


def test_a_table_of_systems_has_names_numbers_and_words_for_what_overturned(study_of):
    text = STUDY.replace("0.5, 0]", "0.5, 0]\n    labels: [A_1, B & C, flat]")
    report = "table: {rows: scale, statistic: largest, formats: [tex]}"
    _, files = files_of(study_of, report, text)
    heads, *rows = rows_of(files["x.tex"].replace(r"B \& C", "B+C"))
    of = ": rotation ratio, largest"
    named = [rf"A\_1{of}", f"B+C{of}", f"flat{of}"]
    assert heads == ["scale", *named, "histories", "failed"]
    assert rows[1][1:] == ["overturned", "overturned", "0.750", "18", "0"]
    assert "inf" in files["x.csv"]


def test_what_latex_takes_for_commands_is_printed():
    assert latex_text(r"a\b_c^d~{e} 5 % & # $ <>") == (
        r"a\textbackslash{}b\_c\textasciicircum{}d\textasciitilde{}\{e\}"
        r" 5 \% \& \# \$ $<$$>$"
    )
    table = Table.of_texts(["a_1", "m/s²"], [("x", "1")])
    text = latex(table, "two\nlines")
    assert text.splitlines()[0] == r"% two lines; needs \usepackage{booktabs}"
    assert r"a\_1 & m/s$^2$ \\" in text


def test_a_workbook_has_all_tables_with_their_numbers(study_of):
    found, files = files_of(study_of, "fragility: {resamples: 0, formats: [csv, xlsx]}")
    book = openpyxl.load_workbook(io.BytesIO(files["x.xlsx"]))
    assert book.sheetnames == ["x", "curves", "observed"]
    columns = found.tables[""]
    head, *rows = book["x"].iter_rows(values_only=True)
    assert list(head) == [column.title for column in columns]
    at = head.index("median [m/s]")
    known = [value for value in columns[at].values if np.isfinite(value)]
    assert [row[at] for row in rows if row[at] is not None] == pytest.approx(known)
    assert all(isinstance(row[head.index("counted [-]")], int) for row in rows)


def test_a_text_is_no_formula():
    book = openpyxl.load_workbook(
        io.BytesIO(workbook({"a[b]": [Column("record", "-", ["=1+1", "x"])]}))
    )
    (sheet,) = book.worksheets
    assert sheet.title == "a_b_"
    assert (sheet["A2"].value, sheet["A2"].data_type) == ("=1+1", "s")


def test_a_table_that_no_sheet_holds_is_refused(monkeypatch):
    monkeypatch.setattr(table_files, "MOST_ROWS", 2)
    with pytest.raises(RpsError, match=r"the table a has 3 rows, .* use its CSV file"):
        workbook({"a": [Column("n", "-", [1, 2, 3])]})


def test_without_the_library_a_study_is_refused_before_it_runs(workplace, monkeypatch):
    text = f"{STUDY}reports: [overturning: {{formats: [xlsx]}}]\n"
    (workplace / "study.yaml").write_text(text, encoding="utf-8")
    load_study("study.yaml")
    monkeypatch.setattr(table_files, "LIBRARY", "no_library_of_this_name")
    with pytest.raises(CaseError, match=r"xlsx needs openpyxl, .*`pip install openpyxl`"):
        load_study("study.yaml")
    monkeypatch.setitem(__import__("sys").modules, "openpyxl", None)
    with pytest.raises(RpsError, match="leave xlsx out of formats"):
        workbook({"a": [Column("n", "-", [1])]})


def test_a_format_that_is_none_is_refused(study_of):
    with pytest.raises(CaseError, match="formats"):
        study_of(f"{STUDY}reports: [overturning: {{formats: [doc]}}]\n")


def test_the_command_writes_them(sweep):
    text = f"{STUDY}reports: [overturning: {{formats: [tex, xlsx]}}]\n"
    done = sweep("study.yaml", study=text)
    assert done.exit_code == 0, done.stderr
    from sweep.small_studies import FOLDER

    (sheet,) = openpyxl.load_workbook(FOLDER / "overturning.xlsx").worksheets
    assert sheet.max_row == 1 + len(csv_rows("overturning.csv"))
    heads, *rows = rows_of((FOLDER / "overturning.tex").read_text(encoding="utf-8"))
    assert heads[-2:] == ["histories", "failed"]
    assert len(rows) == len(csv_rows("overturning.csv"))
    assert csv_text([Column("a", "-", [1])]) == "a [-]\n1\n"
