"""The cases that come with the program: valid, and the same again from their resolved form."""

import json
from pathlib import Path

import pytest
from paper_structures import known

from rpscli.analyses.kernels.systems import stacked_systems
from rpscli.case.case import load_case, parse_case
from rpscli.case.text.files import starter_text

FOLDER = Path(__file__).parents[2] / "cases"
NAMES = [
    "acceptance", "both_components", "designed_columns", "engineers_building", "floors_on_springs",
    "free_standing_block", "friction_dampers", "measured_column", "measured_period", "rigid_frame",
    "six_storey", "yielding_storeys",
]  # fmt: skip


def case(name):
    if name == "starter":
        return parse_case(starter_text(), name="starter.yaml")
    return load_case(FOLDER / f"{name}.yaml")


@pytest.mark.parametrize("name", [*NAMES, "starter"])
def test_it_loads_and_comes_back(name):
    first = case(name)
    text = json.dumps(first.document, allow_nan=False)
    second = parse_case(text, name=f"{name}.json", folder=first.folder)
    # Columns in rows of both directions: that the slab may turn is said of any such case.
    told = ["podium.plan"] if first.structure.rows_y else []
    assert [warning.partition(":")[0] for warning in first.warnings] == told
    assert first.title != first.name
    source = known(first.record).source
    assert ":" in source or (FOLDER / source).is_file()
    assert second.document == first.document
    assert second.limits == first.limits
    assert second.analysis == first.analysis
    of_kernels = [
        stacked_systems([(each.structure, each.analysis)]) for each in (first, second)
    ]
    assert of_kernels[0].tobytes() == of_kernels[1].tobytes()


def test_every_case_of_the_folder_is_tested():
    folder = {
        path.stem for path in FOLDER.glob("*.yaml") if "\nbase:" not in path.read_text()
    }
    assert folder == set(NAMES)


def test_the_measured_column_in_ratios():
    structure = case("measured_column").structure
    assert structure.bearing.slenderness == pytest.approx(0.1498, abs=5e-5)  # 445/2970
    assert structure.bearing.curvature_ratio == pytest.approx(0.5, rel=1e-15)
    assert structure.columns_mass == 6 * 4300.0


def test_the_block_is_the_one_of_its_comment():
    bearing = case("free_standing_block").structure.bearing
    assert (bearing.half_width, bearing.half_height) == pytest.approx(
        (0.5, 1.5), rel=1e-15
    )
    assert case("free_standing_block").structure.gamma == 0.0


def test_what_the_starter_offers_as_alternatives_is_valid():
    """Its commented lines, put in the place of those that they replace."""
    text = (
        starter_text()
        .replace("  # stiffness", "  stiffness")
        .replace("  period: ", "  # ")
    )
    text = text.replace("  profile: ", "  # ").replace(
        "    # dimensions", "    dimensions"
    )
    for name in ("semi_diagonal", "slenderness", "wedge_slenderness", "curvature_ratio"):
        text = text.replace(f"    {name}:", f"    # {name}:")
    structure = parse_case(text, name="starter.yaml").structure
    assert structure.bearing.semi_diagonal == pytest.approx(
        1.5, abs=2e-3
    )  # sizes in whole mm
    assert structure.bearing.wedge_slenderness == pytest.approx(0.30, abs=5e-4)
