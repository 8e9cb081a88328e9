"""Mistakes in a study file: each is refused with its place and what to write instead."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpscli import load_study
from rpscli.errors import CaseError
from sweep.small_studies import STUDY, study_file

SCALE = "scale: [0.5, 1.0]"
SAMPLED = "sample: {size: 4, ranges: {podium.cap_beam_mass_ratio: [5, 10]}}"
SEEDS = "seed: [1, 2, 3]"
RECORD = "  - {source:"
BASE = "base: base.yaml"


def added(line: str) -> tuple[str, str]:
    """A line more in the study."""
    return SCALE, f"{line}\n{SCALE}"


def axis(line: str) -> tuple[str, str]:
    """One more, before the last."""
    return "  - podium.bearing.curv", f"  {line}\n  - podium.bearing.curv"


def sampled(distribution: str) -> tuple[str, str]:
    return added(SAMPLED.replace("[5, 10]", distribution))


@pytest.mark.parametrize(
    ("old", "new", "parts"),
    [
        ("[0.20, 0.30]", "[0.20]", ("study.yaml:6:5", "has 1 values", "line 5", "2")),
        ("critical, 0.5, 0]", "critical, null]", ("study.yaml:7:48", "no value")),
        ("[critical, 0.5, 0]", "0.5", ("study.yaml:7:37", "list of values")),
        ("[critical, 0.5, 0]", "{low: 0, hgh: 1, count: 2}", ("curvature_ratio.high?",)),
        ("curvature_ratio:", "curvature_ration:", ("study.yaml:7:5", "curvature_ratio?")),
        ("podium.bearing.curvature_ratio:", "analysis.recontact_rule:", ("study.yaml:7:5", "gone")),
        ("[critical, 0.5, 0]", "[0.5, -0.2]", ("study.yaml:7:43", "-0.2", ">= 0", "flat ends")),
        ("0.20, 0.30]", "0.20, 0.12]", ("study.yaml:6:", "0.12")),
        ("- podium.bearing.curv", "- podium.bearing.slen", ("not a key", "curvature_ratio")),
        ("base: base.yaml", "base: bsae.yaml", ("study.yaml:3:7", "base.yaml?")),
        ("base: base.yaml\n", "", ("base is missing",)),
        ("synthetic:", "synthtic:", ("study.yaml:9:5", "synthtic", "synthetic")),
        (SCALE, "scale: []", ("study.yaml:10:8", "empty")),
        (SCALE, "scale: {measure: PGX, values: [1]}", ("study.yaml:10:18", "PGV")),
        (SCALE, "scale: {measure: PGV, values: [0]}", ("> 0",)),
        (SCALE, "scale: {measure: PGA, values: [1], period: 1}", ("Sa",)),
        ("scale:", "scal:", ("did you mean scale?",)),
        (*added("perturb: {members: 1}"), ("study.yaml:10:20", ">= 2")),
        (*added("perturb: {restitution: 0.2}"), ("study.yaml:10:24", "above 1")),
        (*added("analysis: modal"), ("scale has no meaning", "records has no meaning")),
        (*added("analysis: dynamic"), ("timehistory, modal or pushover",)),
        (*added("reports: [demnd]"), ("study.yaml:10:11", "did you mean demand?")),
        (*added("reports: [demand: {panel: x}]"), ("did you mean", "panels")),
        (*added("reports: [demand: {panels: x}]"), ("does not vary", "slenderness")),
        (*added("reports: [rotation: {reference: 7}]"), ("7", "takes", "critical")),
        (*added("reports: [lines: {x: scale, y: max_rotatio}]"), ("max_rotation?",)),
        (*added("reports: [lines: {x: scale, y: zzz}]"), ("`rps timehistory CASE",)),
        (*added("limits: {zzz: 1}"), ("more (rps explain limits)",)),
        (SCALE, "reports: [ida]", ("several intensities",)),
        (
            "curvature_ratio: [critical, 0.5, 0]",
            "curvature_ratio: [0.5]\nreports: [rotation]",
            ("report rotation", "curvature_ratio has one value"),
        ),
        (*added(SAMPLED.replace("[5, 10]", "[10, 5]")), ("must be <",)),
        (*added(SAMPLED.replace("[5, 10]", "{mean: 5}")), ("mean and cov",)),
        (*added(SAMPLED.replace("size: 4, ", "")), ("sample.size is missing",)),
        (*added(SAMPLED.replace("cap_beam", "cab_beam")), ("cap_beam_mass_ratio?",)),
        (
            *added(SAMPLED.replace("podium.cap_beam_mass_ratio", "podium.bearing.slenderness")),
            ("varies already", "line 5"),
        ),
        (*added("vary: []"), ("vary is written twice",)),
        (STUDY[STUDY.index("records:") : STUDY.index("scale:")], "", ("no record",)),
        (
            *added("sample: {size: 4, ranges: text}"),
            ("sample.ranges = 'text'", "keys with their ranges"),
        ),
        (BASE, "base: study.yaml", ("study.yaml:3:7", "is a study, and a base is a case")),
        (BASE, "base: other.yaml", ("study.yaml:3:7", "has neither `rps` nor `superstructure`")),
        # vary
        ("vary:\n", "vary: 3\nscal_:\n", ("study.yaml:4:7", "vary = 3 must be a list of axes")),
        (*axis("- 3"), ("vary.1 = 3", "mapping")),
        ("[critical, 0.5, 0]", "[]", ("study.yaml:7:37", "must not be an empty list")),
        (
            "[critical, 0.5, 0]",
            "{low: 0, high: 1, count: 3, spacing: log}",
            ("equal ratios", "spacing: linear"),
        ),
        (
            *axis("- podium.bearing: [{}]"),
            ("podium.bearing varies as a whole", "must not vary too"),
        ),
        (
            *axis("- podium.bearing.slenderness: [0.1]"),
            ("varies already in another axis", "line 5", "remove one of them"),
        ),
        (
            *axis("- record.scale: [1, 2]"),
            ("record.scale must not vary beside", "remove one of them"),
        ),
        (
            SCALE,
            f"{SCALE}\nlinked: {{podium.friction: {{scale: 2}}}}",
            ("scale, which no axis of",),
        ),
        (
            SCALE,
            f"{SCALE}\nlinked: {{podium.friction: {{podium.bearing.curvature_ratio: 2}}}}",
            ("linked.podium.friction is a sum of numbers",),
        ),
        # results
        (
            *added("limits: {max_floor_velocity: 1}"),
            ("max_floor_velocity needs `whole_histories: true`", "study.yaml:10"),
        ),
        (
            *added("whole_histories: true\nlimits: {max_column_force: 1}"),
            ("in all systems podium.plan and superstructure.vertical_period", "leaves out"),
        ),
        (
            *added("whole_histories: true\nlimits: {contact_pressure_ratio: 1}"),
            ("in all systems curved ends, podium.column, podium.plan and",),
        ),
        # scale
        (
            SCALE,
            "scale: {measure: PGV, values: [one]}",
            ("study.yaml:10:32", "number in m/s", "one"),
        ),
        (SCALE, "scale: {low: 1, high: 2, cnt: 3}", ("study.yaml:10", "cnt")),
        (SCALE, "scale: {low: 0, high: 2, count: 3, spacing: log}", ("equal ratios",)),
        # reports
        (*added("reports: demand"), ("study.yaml:10:10", "must be a list")),
        (*added("reports: [3]"), ("reports.0 = 3", "must be a name")),
        *(
            (
                *added(f"reports: [{{fragility: {{name: {name}}}}}]"),
                ("study.yaml:10:30: reports.0.fragility.name", "must be the name of a file"),
            )
            for name in ("../up", "/top", "'a:b'", ".hidden", "x" * 101, '"two\\nlines"')
        ),
        (*added("reports: [xyzzy]"), ("'xyzzy' is not a report", "known are", "fragility")),
        *(
            (*added(f"reports: [{name}]"), (f"{name}' is gone: ", use))
            for name, use in {
                "demand_sample": "points.csv has",
                "directions": "?both act together",
                "contrast": "table: {rows: ..., columns: ..., statistic: median}",
                "efficiency": "`fragility: {measure: ...}` for each measure",
            }.items()
        ),
        (
            *added("reports: [comparison: {fit: {share: 0.5}}]"),
            ("reports.0.comparison.fit is gone: ", "choose one by them", "remove the key"),
        ),
        (*added(f"reports: [{'x' * 5000}]"), ("= 'xxx", "... is not a report; known are")),
        (*added("reports: [lines]"), ("reports.0.lines.x is missing", "lines.result is missing")),
        (*added("reports: [demand: 3]"), ("demand = 3", "mapping of options")),
        (
            *added("reports: [demand: {panels: }, ida: {panles: scale}, 3]"),
            (
                "study.yaml:10:20: reports.0.demand.panels has no value",
                "study.yaml:10:37: reports.1.ida.panles is not a key",
                "did you mean reports.1.ida.panels",
                "study.yaml:10:53: reports.2 = 3 must be a name",
            ),
        ),
        (*added("reports: [demand: {panels: [3]}]"), ("a key or a list of keys",)),
        # sample
        (*sampled("7"), ("cap_beam_mass_ratio = 7 must be [low, high]", "distribution")),
        (*sampled("[5]"), ("must be [low, high]",)),
        (*sampled("{low: 5, mean: 6, cov: 0.1}"), ("low and high alone",)),
        (*sampled("{distribution: lognormal, mean: -1, cov: 0.1}"), ("> 0 for a lognormal",)),
        (*sampled("{distribution: normal, mean: 0, cov: 0.1}"), ("mean = 0", "cov is relative")),
        (*added("sample: {size: 4, ranges: {}}"), ("sample.ranges = {}", "keys with their ranges")),
        # records
        ("records:\n", "records: 3\nrecord_:\n", ("study.yaml:8:10", "must be a list of sources")),
        (RECORD, "  - 3\n" + RECORD, ("study.yaml:9:5", "records.0 = 3", "must be a source")),
        (SEEDS, "seed: []", ("records.0.seed = []", "must not be an empty list")),
        (SEEDS, "seed: {low: 1, high: 3}", ("records.0.seed.count is missing",)),
        # base
        (BASE, "base: broken.yaml", ("broken.yaml:3:1", "line 2, column 16")),
    ],
)
def test_a_mistake_is_refused(workplace: Path, old: str, new: str, parts: tuple[str, ...]) -> None:
    (workplace / "broken.yaml").write_text("rps: 1\nsemi_diagonal: [1\n", encoding="utf-8")
    assert old in STUDY
    (workplace / "other.yaml").write_text("a_secret: 1\n", encoding="utf-8")
    (workplace / "study.yaml").write_text(STUDY.replace(old, new), encoding="utf-8")
    with pytest.raises(CaseError) as refused:
        study_file("study.yaml")
    text = str(refused.value)
    for part in parts:
        assert part in text, text
    assert len(lines := text.splitlines()) == len(set(lines))  # told once, not of each system


SPHERES = {
    "rps": 1,
    "superstructure": {"storeys": 2, "storey_mass": 2e5, "period": 0.3, "damping": {"ratio": 0}},
    "podium": {
        "bearing": {"dimensions": {"height": 3, "width": 0, "wedge_width": 0.9, "radius": 2}},
        "cap_beam_mass": "200 t", "cap_beam_mass_ratio": 10,
    },
}  # fmt: skip


@pytest.mark.parametrize(
    "report", ["storey_shear", "rotation", "overturning_spectrum", "fragility"]
)
def test_what_is_over_the_uplift_is_refused_without_a_flat_part(report: object) -> None:
    study = {
        "rps": 1, "base": SPHERES, "records": ["pulse:sine?amplitude=0.1g&period=0.8"],
        "scale": {"measure": "PGA", "values": [1.0, 2.0]}, "reports": [report],
        "vary": [{"podium.bearing.dimensions.radius": [2, 2.5]}],
    }  # fmt: skip
    if report == "fragility":
        load_study({**study, "reports": [{"fragility": {"limits": {"max_lift": 0.01}}}]})
        return
    with pytest.raises(CaseError, match="which is 0 without a flat part"):
        load_study(study)
