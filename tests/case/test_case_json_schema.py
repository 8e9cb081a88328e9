"""The JSON schema says what each number is and how it is bounded."""

import pytest
from paper_structures import known

from rpscli.analyses.result_quantities import LIMITED
from rpscli.case.schema.case_file import CaseFile
from rpscli.case.schema.keys import field_at, json_schema_of, known_paths, section_of
from rpscli.case.text.document import path_of
from rpscli.units import KINDS

SCHEMA = json_schema_of(CaseFile)
UNITS = {
    "superstructure.storey_mass": "kg", "superstructure.stiffness": "N/m",
    "superstructure.period": "s", "superstructure.damping.ratio": "1",
    "podium.bearing.dimensions.radius": "m", "podium.bearing.curvature_ratio": "1",
    "analysis.gravity": "m/s2", "analysis.free_vibration": "s",
}  # fmt: skip


def resolved(schema):
    """A schema with its reference followed."""
    reference = schema.get("$ref")
    if reference is None:
        return schema
    return {**SCHEMA["$defs"][reference.rsplit("/", 1)[1]], **schema}


def mapping(schema):
    """The form of a value that is a mapping, or a list of them, where it may be a plain number."""
    schema = resolved(schema).get("items", schema)
    forms = [resolved(form) for form in resolved(schema).get("oneOf", (schema,))]
    return next(form for form in forms if "properties" in form)


def key(path):
    schema = SCHEMA
    for part in path:
        schema = mapping(schema)["properties"][part]
    return resolved(schema)


def walk(value):
    yield value
    items = (
        value.values()
        if isinstance(value, dict)
        else value
        if isinstance(value, list)
        else ()
    )
    for item in items:
        yield from walk(item)


def test_numbers_have_units():
    assert {name: key(path_of(name))["unit"] for name in UNITS} == UNITS


@pytest.mark.parametrize("path", known_paths(CaseFile))
def test_every_key_is_described(path):
    found = key(path)
    assert found["description"]
    field = known(field_at(CaseFile, path))
    bounded = {"type", "anyOf", "oneOf", "enum", "const"} & found.keys()
    assert bounded or section_of(field.annotation)


def test_bounds_words_lists_and_defaults():
    rho = key(("podium", "bearing", "curvature_ratio"))
    assert rho["anyOf"] == [{"type": "number", "minimum": 0}, {"enum": ["critical"]}]
    assert rho["symbol"] == "rho = r/2H"
    mass = key(("superstructure", "storey_mass"))["anyOf"]
    assert [option["type"] for option in mass] == ["number", "string", "array"]
    assert mass[0]["exclusiveMinimum"] == 0
    assert key(("superstructure", "damping", "modes"))["minItems"] == 2
    assert key(("analysis", "recontact_tolerance"))["default"] == 1e-6
    assert key(("rps",))["maximum"] == 1


def test_closed_and_without_null():
    sections = [
        at for at in walk(SCHEMA) if isinstance(at, dict) and at.get("type") == "object"
    ]
    # A limit may be a mapping, which is described once for all of a unit and a bound.
    rules = {
        (q.unit in KINDS and q.unit, q.whole or q.from_below, q.from_below)
        for q in LIMITED
    }
    assert len(sections) == 23 + len(rules)
    assert all(section["additionalProperties"] is False for section in sections)
    assert None not in [
        item for item in walk(SCHEMA) if not isinstance(item, dict | list)
    ]
    assert "null" not in list(walk(SCHEMA))
    assert set(SCHEMA["required"]) == {"rps", "superstructure", "podium"}
