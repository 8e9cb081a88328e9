"""Label and ticks of an axis are of one unit, in each report whose axes may be forces."""

import pytest
from sweep.small_studies import BASE

from report.test_figures_of_studies import opened
from rpscli.report.study.panels import scale_of
from rpscli.report.table import LARGE_UNITS

FORCE = "podium.devices.0.force"
MASS = "superstructure.storey_mass"
STUDY = f"""\
rps: 1
base: base.yaml
vary:
  - {FORCE}: [200 kN, 400 kN]
  - {MASS}: [150 t, 200 t]
records:
  - {{source: "pulse:sine?amplitude=0.4g", period: [0.8, 1.2]}}
scale: [1, 2]
reports:
  - lines: {{title: one, x: {FORCE}, result: max_base_shear}}
  - lines: {{title: two, x: {MASS}, result: [max_base_shear, rotation_ratio]}}
  - scatter: {{title: keys, x: {FORCE}, y: {MASS}}}
  - scatter: {{title: result, x: {FORCE}, y: max_base_shear}}
  - ida: {{title: ida, result: max_base_shear}}
"""
DAMPER = "  devices: [{kind: friction, force: 300 kN}]\n"

FIGURES = {
    "one": ("force [kN]", "$V_b$ [kN], mean of survivors"),
    "two": ("storey_mass [t]", None),
    "keys": ("force [kN]", "storey_mass [t]"),
    "result": ("force [kN]", "$V_b$ [kN]"),
    "ida": ("$V_b$ [kN]", "scale [-]"),
}


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        base = BASE.replace("analysis:", f"{DAMPER}analysis:")
        patch.setattr("report.test_figures_of_studies.BASE", base)
        return opened(STUDY, tmp_path_factory.mktemp("axes"), tables=False)


def unit_shown(label):
    return label[label.index("[") + 1 : label.index("]")]


def factor_at_ticks(axis):
    """Of the largest tick its number, with what stands at the end of the axis, over its place."""
    places = axis.get_majorticklocs()
    formatter = axis.get_major_formatter()
    number = formatter.format_ticks(places)[-1].replace("\N{MINUS SIGN}", "-")
    return float(number) * float(formatter.get_offset() or 1.0) / places[-1]


@pytest.mark.parametrize("name", FIGURES)
def test_ticks_are_in_the_unit_of_their_label(drawn, name):
    figure = drawn(name)
    axes = [each for each in figure.axes if each.axison][-1]
    x = axes.get_xlabel()
    y = figure.get_supylabel() or figure.axes[0].get_ylabel().replace("\n", " ")
    wanted = FIGURES[name]
    assert x == wanted[0]
    assert wanted[1] in (None, y)
    for axis, label in ((axes.xaxis, x), (axes.yaxis, y)):
        unit = unit_shown(label)
        wanted_factor = dict(LARGE_UNITS.values()).get(unit, 1.0)
        assert factor_at_ticks(axis) == pytest.approx(wanted_factor, rel=1e-3)


def test_results_of_two_units_on_one_axis_stay_in_si(drawn):
    figure = drawn("two")
    y = figure.get_supylabel() or figure.axes[0].get_ylabel().replace("\n", " ")
    assert y.startswith("$V_b$ [N], ")


@pytest.mark.parametrize("unit", LARGE_UNITS)
def test_one_function_makes_label_and_ticks(unit):
    name, factor = LARGE_UNITS[unit]
    assert scale_of("words", unit) == (f"words [{name}]", factor)
