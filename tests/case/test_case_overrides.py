"""Values put over a case: from the command line as text, from a study as Python values."""

import copy

import numpy as np
import pytest
from paper_structures import known

from rpscli.case.case import case_from_mapping
from rpscli.case.overrides import apply_overrides
from rpscli.case.text.document import Document
from rpscli.case.text.yaml_text import read_yaml
from rpscli.errors import CaseError

from .conftest import BUILDING, FRAME, case_of, refusal


def override_refusal(overrides, label="--set", text=BUILDING):
    with pytest.raises(CaseError) as error:
        apply_overrides(read_yaml(text, "c.yaml"), overrides, label=label)
    return str(error.value)


def test_values_are_yaml():
    document = read_yaml(BUILDING, "c.yaml")
    before = copy.deepcopy(document.content)
    changed = apply_overrides(
        document,
        [
            "podium.bearing.slenderness=0.2",
            "superstructure.storey_mass=[1 t, 2 t, 3 t]",
            "superstructure.storey_mass.0=4 t",
            "podium.impact={law: value, restitution: 0.9}",
            "record.source=pulse:sine?amplitude=0.4g&period=1.2",
            "limits.drift_ratio=5e-3",
            "title=no",
        ],
    )
    assert changed.at(("podium", "bearing", "slenderness")) == 0.2
    assert changed.at(("superstructure", "storey_mass")) == ["4 t", "2 t", "3 t"]
    assert changed.at(("podium", "impact")) == {"law": "value", "restitution": 0.9}
    assert changed.at(("record", "source")) == "pulse:sine?amplitude=0.4g&period=1.2"
    assert changed.at(("limits",)) == {"rotation_ratio": 0.5, "drift_ratio": 5e-3}
    assert changed.at(("title",)) == "no"
    assert document.content == before
    assert (
        str(document.value_place(("podium", "bearing", "slenderness"))) == "c.yaml:12:18"
    )


def test_sections_that_are_not_written_come_into_being():
    record = known(case_of("record.source=a.at2", "record.scale=2", text=FRAME).record)
    assert (record.source, record.scale) == ("a.at2", 2.0)


def test_null_takes_a_key_out():
    without = case_of(
        "podium.superstructure_mass_ratio=null", "podium.cap_beam_mass=150 t"
    )
    assert without.structure.eta == pytest.approx(4.0, rel=1e-15)
    assert case_of("record=null", "record.vertical=null").record is None


def test_python_values_of_a_study():
    document = read_yaml(BUILDING, "c.yaml")
    point = {
        "superstructure.storeys": np.int64(2),
        "podium.bearing.slenderness": np.float64(0.1),
        "podium.bearing.curvature_ratio": "critical",
        "superstructure.damping.modes": (1, 2),
        "superstructure.storey_mass": np.array([1000.0, 2000.0]),
        "podium.impact": {"law": "flexible"},
    }
    case = case_from_mapping(document, "c.yaml", None, point, label="vary")
    structure = case.structure
    assert structure.storeys == 2
    assert structure.superstructure_mass == 3000.0
    assert structure.bearing.curvature_ratio == pytest.approx(1.0 / 3.0, rel=1e-15)
    assert structure.impact_law.kind == "flexible"


def test_a_fault_of_a_value_is_placed_at_its_override():
    case = read_yaml(BUILDING, "c.yaml")
    with pytest.raises(CaseError) as error:
        case_from_mapping(
            case, "c.yaml", None, {"podium.bearing.slenderness": -0.5}, label="vary"
        )
    start = "vary podium.bearing.slenderness=-0.5: podium.bearing.slenderness = -0.5 must be >= 0"
    assert str(error.value).startswith(start)
    message = refusal(BUILDING, overrides=["podium.cap_beam_mass=1"])
    assert message.startswith("--set podium.cap_beam_mass=1: podium.cap_beam_mass and")
    assert "both fix" in message
    assert "(line 16)" in message


@pytest.mark.parametrize(
    ("override", "parts"),
    [
        (
            "podium.bering.slenderness=1",
            ["podium.bering is not a key", "mean podium.bearing?"],
        ),
        ("podium.bearing.slendernes=1", ["did you mean podium.bearing.slenderness?"]),
        ("slenderness=1", ["slenderness belongs under podium.bearing"]),
        ("xyz=1", ["xyz is not a key", "known here: rps, title"]),
        ("xyz=null", ["xyz is not a key"]),
        ("podium.columns.x=1", ["podium.columns can be set as a whole only"]),
        ("superstructure.storey_mass.0=1", ["'200 t' is a single value"]),
        ("superstructure.damping.modes.2=1", ["modes has 2 values", "there is no 2"]),
        ("superstructure.damping.modes.0=null", ["cannot be taken out"]),
        ("superstructure.damping.modes.0.1=3", ["= 1 is a single value"]),
        (
            "podium.devices[0].force=1",
            ["devices[0] is not a key", "mean podium.devices.0?"],
        ),
        ("podium.0=1", ["podium is not a list"]),
        ("0=1", ["an index alone"]),
        ("podium..columns=1", ["is not a key"]),
        ("podium.columns", ["write --set dotted.key=value"]),
        ("=3", ["write --set dotted.key=value"]),
        ("podium.columns=", ["no value", "null"]),
        ("podium.columns=[1", ["bracket"]),
        ("podium.impact={law: rigid, law: rigid}", ["law is written twice"]),
        ('title="\\ud800"', ["\": '\\ud800' holds half a letter"]),
    ],
)
def test_refusals(override, parts):
    message = override_refusal([override])
    assert message.startswith(f"--set {override}:")
    for part in parts:
        assert part in message


def test_a_key_below_a_list():
    text = BUILDING.replace("{source: motion.at2}", "[a]")
    message = override_refusal(["record.source=b"], text=text)
    assert message == "--set record.source=b: record is a list, without a key source"


def test_keys_of_a_study_are_checked_together():
    lines = override_refusal(
        {"podium.foo": 1, "record.bar": 2}, label="vary"
    ).splitlines()
    assert [line.split(":")[0] for line in lines] == [
        "vary podium.foo=1",
        "vary record.bar=2",
    ]


def test_a_document_without_positions():
    document = Document("base", {"podium": {"columns": 2}})
    assert apply_overrides(document, ["podium.columns=3"]).content == {
        "podium": {"columns": 3}
    }
