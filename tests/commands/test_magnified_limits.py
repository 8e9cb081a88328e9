"""Limits that demands keep times a factor (EN 1998-1, 10.3(2)P), as by hand."""

import csv
from pathlib import Path

import pytest

from rpscli.case.case import load_case
from rpscli.case.conditions import conditions_of
from rpscli.report.table import shown

from .conftest import write_case

PULSES = [f"pulse:sine?amplitude={size}g&period=1" for size in (0.2, 0.25, 0.3)]
RECORDS = [word for pulse in PULSES for word in ("--record", pulse)]


def limited(text):
    return ("--set", f"limits={{max_lift: {{{text}}}}}", "--figures", "none")


def verdict_of(document):
    (found,) = [v for v in document["verdicts"] if v["name"] == "max_lift"]
    return found


@pytest.mark.parametrize(("factor", "exceeded"), [(1, False), (1.2, False), (1.3, True)])
def test_a_demand_is_judged_times_the_factor(rps, rps_json, factor, exceeded):
    """A limit of 1.25 times the demand."""
    demand = rps_json("timehistory", "small.yaml", "--figures", "none")["max_lift"]
    rule = limited(f"at_most: {1.25 * demand!r}, factor: {factor}")
    code = 10 if exceeded else 0
    found = rps_json("timehistory", "small.yaml", *rule, "-o", "out", exit_code=code)
    verdict = verdict_of(found)
    assert verdict["exceeded"] == exceeded
    assert verdict["value"] == demand
    assert verdict["factor"] == factor
    assert verdict["limit"] * factor == pytest.approx(1.25 * demand, rel=1e-15)


def test_words_have_the_demand_the_factor_and_the_product(
    figures, monkeypatch, rps, rps_json
):
    monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: b"<svg />")
    demand = rps_json("timehistory", "small.yaml", "--figures", "none")["max_lift"]
    rule = limited("at_most: 1 mm, factor: 1.2")
    says = f"1.2 x {shown(1e3 * demand)} mm = {shown(1.2e3 * demand)} mm"
    told = rps("timehistory", "small.yaml", *rule, "-o", "out", exit_code=10)
    assert f"{says} exceeds 1 mm" in " ".join(told.stderr.split())
    rps("report", "small.yaml", *rule[:2], "-o", "out.html", exit_code=10)
    page = Path("out.html").read_text(encoding="utf-8")
    assert says in page
    assert "at most 1 mm with factor 1.2" in page


@pytest.mark.parametrize("how", ["of: mean", "share: 0.4", "fractile: 0.5", "share: 0"])
def test_records_are_judged_as_by_the_limit_over_the_factor(rps_json, how):
    """Whatever part of them must keep it; between demands, so that it matters."""
    given = ("timehistory", "small.yaml", *RECORDS)
    document = rps_json(*given, "--figures", "none", "-o", "out")
    values = sorted(each["max_lift"] for each in document["histories"])
    for bound in (0.9 * values[0], values[1] * 1.01, 1.1 * values[2]):
        found = {}
        for name, limit in (("times", f"{1.2 * bound!r}, factor: 1.2"), ("over", bound)):
            rule = limited(f"at_most: {limit}, {how}")
            made = rps_json(*given, *rule, "-o", name, exit_code=None)
            found[name] = verdict_of(made["sets"][0])
        unlike = {"limit": None, "factor": None}
        assert found["times"] | unlike == found["over"] | unlike
        assert found["times"]["limit"] == pytest.approx(bound, rel=1e-15)


def test_a_study_says_the_factor(rps):
    write_case("small.yaml", more="limits: {max_lift: {at_most: 1 mm, factor: 1.5}}\n")
    study = "rps: 1\ntitle: One\nbase: small.yaml\nrecords: ['%s']\nreports: []\n"
    Path("study.yaml").write_text(study % PULSES[2], encoding="utf-8")
    told = rps("sweep", "study.yaml", "-o", "out", exit_code=10).stdout
    assert "with factor 1.5" in " ".join(told.split())
    with Path("out/verdicts.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    (row,) = [row for row in rows if row["limit [-]"] == "max_lift"]
    assert float(row["factor [-]"]) == 1.5
    assert float(row["at_most [SI]"]) == pytest.approx(0.001 / 1.5, rel=1e-9)


@pytest.mark.parametrize(
    ("rule", "said"),
    [
        ("max_lift: {at_most: 0.1, factor: 0.9}", "must be >= 1 (gamma_x)"),
        ("min_column_force: {at_least: 1, factor: 1.2}", "factor is not a key"),
    ],
)
def test_what_magnifies_nothing_is_refused(rps, rule, said):
    rps("check", "small.yaml", "--set", f"limits={{{rule}}}", exit_code=3, says=said)


def test_limits_without_a_factor_are_as_they_are_written(workplace):
    write_case("small.yaml", more="limits: {max_lift: {at_most: 60 mm}}\n")
    (condition,) = conditions_of(load_case("small.yaml").limits, "")
    assert (condition.limit, condition.limit.text, condition.factor) == (0.06, "60 mm", 1)
