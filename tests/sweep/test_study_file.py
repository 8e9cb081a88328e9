"""A study is read from its file; one too large for any machine is refused before it begins."""

import pytest
from paper_structures import building, podium, stillness

from rpscli import load_study
from rpscli.analyses.kernels.history import MOST_STEPS
from rpscli.analyses.kernels.systems import most_steps
from rpscli.analyses.settings import TimeHistorySettings
from rpscli.analyses.timehistory import time_history
from rpscli.case.study.schema import MeasureScale
from rpscli.case.study.study import MOST_POINTS, MOST_SYSTEMS, parse_study
from rpscli.errors import CaseError
from rpscli.model.superstructure import RayleighDamping
from rpscli.report.study.registry import REPORTS
from rpscli.sweep.points import lay_out
from sweep.small_studies import STUDY, study_file


def refusal(make, *changes, overrides=()):
    """Why a study is refused, whether alone or once its systems are made."""
    with pytest.raises(CaseError) as refused:
        lay_out(make(STUDY, *changes, overrides=overrides))
    return str(refused.value)


def test_all_faults_of_keys_are_told_together_then_those_between_keys(study_of):
    unequal, twice = ("[0.20, 0.30]", "[0.2]"), ("scale:", "hazzard: 1\nscale:")
    text = refusal(study_of, ("title:", "titel:"), unequal, ("[0.5, 1.0]", "[]"), twice)
    assert len(text.splitlines()) == 3
    text = refusal(study_of, unequal, ("curvature_ratio:", "curvature_ration:"))
    assert len(text.splitlines()) == 2


def test_sa_at_t1_needs_storeys(study_of):
    frame = (
        "base: {rps: 1, superstructure: {storeys: 0}, podium: {bearing: {semi_diagonal: 1.5,"
        " slenderness: 0.15, wedge_slenderness: 0.3, curvature_ratio: 0.5}, cap_beam_mass: 1000,"
        " cap_beam_mass_ratio: 10}}"
    )
    scale = ("scale: [0.5, 1.0]", "scale: {measure: Sa, values: [1.0]}")
    text = refusal(study_of, ("base: base.yaml", frame), scale)
    assert "scale.period is missing" in text


def test_values_of_an_unknown_measure_are_not_judged(study_of):
    for values in ("[40 cm/s]", "{low: 20 cm/s, high: 40 cm/s, count: 3}"):
        scale = f"scale: {{measure: Pgv, values: {values}}}"
        text = refusal(study_of, ("scale: [0.5, 1.0]", scale))
        assert "did you mean PGV?" in text
        assert "\n" not in text


def test_overrides_reach_the_study_and_its_case(study_of):
    study = study_of(
        overrides=("scale=[2]", "podium.cap_beam_mass_ratio=7", "analysis.accuracy=2")
    )
    assert study.file.scale == (2.0,)
    assert study.base.content["podium"]["cap_beam_mass_ratio"] == 7
    assert study.base.content["analysis"]["accuracy"] == 2
    measured = study_of(overrides=("scale={measure: PGV, values: [0.5]}",))
    assert isinstance(measured.file.scale, MeasureScale)


def test_what_is_asked_for_and_cannot_be_is_told(study_of):
    text = refusal(study_of, overrides=("podium.bearing.slenderness=0.2",))
    assert "varies in the study" in text
    with pytest.raises(CaseError, match=r"did you mean study\.yaml"):
        study_file("stduy.yaml")


ALPHA = "podium.bearing.slenderness"
T1 = "superstructure.period"


PRODUCT = """
records:
- source: pulse:sine
  amplitude: {low: 1, high: 2, count: 100000}
  period: {low: 1, high: 2, count: 100000}
"""


def a_range(key, count):
    return f"- {{{key}: {{low: 0.1, high: 0.2, count: {count}}}}}"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            f"sample: {{size: 1000000000, ranges: {{{ALPHA}: [0.1, 0.2]}}}}",
            f"1000000000 systems .* more than {MOST_SYSTEMS}; use fewer",
        ),
        ("perturb: {members: 1000000000}", f"1000000000 points .* {MOST_POINTS};"),
        (f"perturb: {{members: {9**300}}}", r"over 10{18} points \(over 10{18}\)"),
        (
            f"vary:\n{a_range(ALPHA, 1000)}\n{a_range(T1, 1001)}",
            r"1001000 systems \(1000 x 1001\)",
        ),
        (PRODUCT, "stands for 10000000000 ground motions"),
        (
            f"vary:\n{a_range(ALPHA, 3000)}\nscale: {{low: 1, high: 2, count: 2000}}",
            "6000000",
        ),
    ],
)
def test_a_study_that_is_too_large_is_refused(text, told):
    study = f"rps: 1\nbase: cases/six_storey.yaml\n{text}\n"
    with pytest.raises(CaseError, match=told):
        parse_study(study, name="s.yaml", kinds=REPORTS)


def test_the_largest_study_is_none_too_many():
    text = f"sample: {{size: {MOST_SYSTEMS}, ranges: {{{ALPHA}: [0.1, 0.2]}}}}"
    parse_study(
        f"rps: 1\nbase: cases/six_storey.yaml\n{text}\n", name="s.yaml", kinds=REPORTS
    )


def test_a_history_of_endless_steps_is_refused():
    stiff = building(60, 1e-3, RayleighDamping(1.5, (1, 1)))
    structure = podium(60, superstructure=stiff)
    settings, record = TimeHistorySettings(), stillness(0.02)
    assert most_steps(structure, settings, record.duration) > MOST_STEPS
    with pytest.raises(
        CaseError, match=r"steps, .* more than 1e\+10: .*; give a shorter"
    ):
        time_history(structure, record, settings)
    short = TimeHistorySettings(free_vibration=0.0)
    assert most_steps(structure, short, record.duration) < MOST_STEPS


SCALE = "scale: [0.5, 1.0]"
RHOS, RHO = "[critical, 0.5, 0]", "podium.bearing.curvature_ratio"
BEAM = "podium.cap_beam_mass_ratio"
SAMPLED = f"sample: {{size: 4, ranges: {{{BEAM}: [5, 10]}}}}"
SEEDS = "seed: [1, 2, 3]"
RECORD = "  - {source:"
BASE = "base: base.yaml"
REMOVE = "remove one of them"
WHOLE = "whole_histories: true\n"


def added(line):
    """A line more in the study."""
    return SCALE, f"{line}\n{SCALE}"


def axis(line):
    """One more, before the last."""
    return "  - podium.bearing.curv", f"  {line}\n  - podium.bearing.curv"


def sampled(distribution):
    return added(SAMPLED.replace("[5, 10]", distribution))


@pytest.mark.parametrize(
    ("old", "new", "parts"),
    [
        ("[0.20, 0.30]", "[0.20]", ("study.yaml:6:5", "has 1 values", "line 5", "2")),
        (
            "critical, 0.5, 0]",
            "critical, null]",
            ("study.yaml:7:48", "curvature_ratio is missing"),
        ),
        (RHOS, "0.5", ("study.yaml:7:37", "list of values")),
        (RHOS, "{low: 0, hgh: 1, count: 2}", ("curvature_ratio.high?",)),
        ("curvature_ratio:", "curvature_ration:", ("study.yaml:7:5", "curvature_ratio?")),
        (
            "podium.bearing.curvature_ratio:",
            "analysis.recontact_rule:",
            ("study.yaml:7:5", "gone"),
        ),
        (RHOS, "[0.5, -0.2]", ("study.yaml:7:43", "-0.2", ">= 0", "flat ends")),
        ("0.20, 0.30]", "0.20, 0.12]", ("study.yaml:6:", "0.12")),
        (
            "- podium.bearing.curv",
            "- podium.bearing.slen",
            ("not a key", "curvature_ratio"),
        ),
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
        (*added("limits: {zzz: 1}"), ("near are", "`rps explain limits` lists all")),
        (SCALE, "reports: [ida]", ("several intensities",)),
        (
            RHOS,
            "[0.5]\nreports: [rotation]",
            ("report rotation", "curvature_ratio has one value"),
        ),
        (*added(SAMPLED.replace("[5, 10]", "[10, 5]")), ("must be <",)),
        (*added(SAMPLED.replace("[5, 10]", "{mean: 5}")), ("mean and cov",)),
        (*added(SAMPLED.replace("size: 4, ", "")), ("sample.size is missing",)),
        (*added(SAMPLED.replace("cap_beam", "cab_beam")), ("cap_beam_mass_ratio?",)),
        (*added(SAMPLED.replace(BEAM, ALPHA)), ("varies already", "line 5")),
        (*added("vary: []"), ("vary is written twice",)),
        (STUDY[STUDY.index("records:") : STUDY.index("scale:")], "", ("no record",)),
        (
            *added("sample: {ranges: text}"),
            ("sample.ranges = 'text'", "keys with their ranges"),
        ),
        (
            BASE,
            "base: study.yaml",
            ("study.yaml:3:7", "is a study, and a base is a case"),
        ),
        (
            BASE,
            "base: other.yaml",
            ("study.yaml:3:7", "has neither `rps` nor `superstructure`"),
        ),
        # vary
        (
            "vary:\n",
            "vary: 3\nscal_:\n",
            ("study.yaml:4:7", "vary = 3 must be a list of axes"),
        ),
        (*axis("- 3"), ("vary.1 = 3", "mapping")),
        (RHOS, "[]", ("study.yaml:7:37", "must not be an empty list")),
        (*axis("- podium.bearing: [{}]"), ("varies as a whole", "must not vary too")),
        (
            *axis(f"- {ALPHA}: [0.1]"),
            ("varies already in another axis", "line 5", REMOVE),
        ),
        (*axis("- record.scale: [1, 2]"), ("record.scale must not vary beside", REMOVE)),
        (*added("linked: {podium.friction: {scale: 2}}"), ("scale, which no axis of",)),
        (
            *added(f"linked: {{podium.friction: {{{RHO}: 2}}}}"),
            ("friction is a sum of numbers",),
        ),
        # results
        (
            *added("limits: {max_floor_velocity: 1}"),
            ("max_floor_velocity needs `whole_histories: true`", "study.yaml:10"),
        ),
        (
            *added(f"{WHOLE}limits: {{max_column_force: 1}}"),
            (
                "in all systems podium.columns, podium.plan and superstructure.vertical",
                "leaves out",
            ),
        ),
        (
            *added(f"{WHOLE}limits: {{contact_pressure_ratio: 1}}"),
            ("in all systems curved ends, podium.column, podium.plan and",),
        ),
        # scale
        (
            SCALE,
            "scale: {measure: PGV, values: [one]}",
            (":10:32", "number in m/s", "one"),
        ),
        (SCALE, "scale: {low: 0, high: 2, count: 3, spacing: log}", ("equal ratios",)),
        # reports
        (*added("reports: demand"), ("study.yaml:10:10", "must be a list")),
        *(
            (
                *added(f"reports: [{{fragility: {{name: {name}}}}}]"),
                (
                    "study.yaml:10:30: reports.0.fragility.name",
                    "must be the name of a file",
                ),
            )
            for name in ("../up", ".hidden", "x" * 101, '"two\\nlines"')
        ),
        (
            *added("reports: [xyzzy]"),
            ("'xyzzy' is not a report", "known are", "fragility"),
        ),
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
            (
                "reports.0.comparison.fit is gone: ",
                "choose one by them",
                "remove the key",
            ),
        ),
        (
            *added(f"reports: [{'x' * 5000}]"),
            ("= 'xxx", "... is not a report; known are"),
        ),
        (
            *added("reports: [lines]"),
            ("reports.0.lines.x is missing", "lines.result is missing"),
        ),
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
        (*sampled("{low: 5, mean: 6, cov: 0.1}"), ("low and high alone",)),
        (
            *sampled("{distribution: lognormal, mean: -1, cov: 0.1}"),
            ("> 0 for a lognormal",),
        ),
        (
            *sampled("{distribution: normal, mean: 0, cov: 0.1}"),
            ("mean = 0", "cov is relative"),
        ),
        (
            *added("sample: {size: 4, ranges: {}}"),
            ("sample.ranges = {}", "keys with their ranges"),
        ),
        # records
        (
            "records:\n",
            "records: 3\nrecord_:\n",
            ("study.yaml:8:10", "must be a list of sources"),
        ),
        (
            RECORD,
            "  - 3\n" + RECORD,
            ("study.yaml:9:5", "records.0 = 3", "must be a source"),
        ),
        (SEEDS, "seed: []", ("records.0.seed = []", "must not be an empty list")),
        (SEEDS, "seed: {low: 1, high: 3}", ("records.0.seed.count is missing",)),
        # base
        (BASE, "base: broken.yaml", ("broken.yaml:3:1", "line 2, column 16")),
    ],
)
def test_a_mistake_is_refused(workplace, old, new, parts):
    (workplace / "broken.yaml").write_text(
        "rps: 1\nsemi_diagonal: [1\n", encoding="utf-8"
    )
    assert old in STUDY
    (workplace / "other.yaml").write_text("a_secret: 1\n", encoding="utf-8")
    (workplace / "study.yaml").write_text(STUDY.replace(old, new), encoding="utf-8")
    with pytest.raises(CaseError) as refused:
        study_file("study.yaml")
    text = str(refused.value)
    for part in parts:
        assert part in text, text
    assert len(lines := text.splitlines()) == len(
        set(lines)
    )  # told once, not of each system


SPHERES = {
    "rps": 1,
    "superstructure": {"storeys": 2, "storey_mass": 2e5, "period": 0.3, "damping": {"ratio": 0}},
    "podium": {
        "bearing": {"dimensions": {"height": 3, "width": 0, "wedge_width": 0.9, "radius": 2}},
        "cap_beam_mass": "200 t", "cap_beam_mass_ratio": 10,
    },
}  # fmt: skip


@pytest.mark.parametrize(
    "kind", ["storey_shear", "rotation", "overturning_spectrum", "fragility"]
)
def test_what_is_over_the_uplift_is_refused_without_a_flat_part(kind):
    study = {
        "rps": 1, "base": SPHERES, "records": ["pulse:sine?amplitude=0.1g&period=0.8"],
        "scale": {"measure": "PGA", "values": [1.0, 2.0]}, "reports": [kind],
        "vary": [{"podium.bearing.dimensions.radius": [2, 2.5]}],
    }  # fmt: skip
    if kind == "fragility":
        load_study({**study, "reports": [{"fragility": {"limits": {"max_lift": 0.01}}}]})
        return
    with pytest.raises(CaseError, match="which is 0 without a flat part"):
        load_study(study)
