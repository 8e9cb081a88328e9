"""The plan of the columns: equilibrium, the largest force, and the drawing."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from paper_structures import needs_compiled_kernels

from report.small_results import drawn
from rpscli.analyses.timehistory import time_history
from rpscli.case.case import load_case
from rpscli.records.ground_motion import MotionComponents
from rpscli.records.loading import load_record
from rpscli.report.case_page import plan_picture
from rpscli.report.figures import style
from rpscli.report.figures.look import USUAL
from rpscli.report.figures.plan import ColumnPlan, draw_plan

DESIGNED = Path(__file__).parents[2] / "cases" / "designed_columns.yaml"
LIMITS = "limits=null"


def result_of(plan, *, both=False, **changed):
    case = load_case(DESIGNED, [f"podium.plan={plan}", LIMITS])
    push = load_record(str(DESIGNED.parent / "records" / "synthetic_far_field.at2"))
    motion = MotionComponents(push, y=push.scaled(0.6)) if both else push
    settings = replace(case.analysis, free_vibration=0.0)
    return time_history(replace(case.structure, **changed), motion, settings)


@needs_compiled_kernels
@pytest.mark.parametrize("both", [False, True])
def test_forces_of_all_columns_are_in_equilibrium(both):
    """Their sum is the weight, their moment that of the podium; the largest is the result."""
    rows = "[0 m, 4 m, 6 m, 18 m]"
    y = f", y: {{rows: {rows}}}" * both
    result = result_of(f"{{rows: {rows}{y}}}", both=both)
    plan = result.axial.plan
    structure = result.structure
    each = np.broadcast_to(plan.forces, (4, 4))
    assert each.max() == pytest.approx(result.max_column_force, rel=1e-12)
    assert each.max() == pytest.approx(result.axial.largest[plan.end], rel=1e-12)
    at = int(np.argmax(result.axial.heaviest[plan.end]))
    x = np.array(structure.rows) - np.mean(structure.rows)
    moments = [float(moment[at]) for moment, _ in result.axial.moments]
    assert (each.sum(axis=1) @ x) == pytest.approx(moments[0], rel=1e-9)
    if both:
        assert (each.sum(axis=0) @ x) == pytest.approx(moments[1], rel=1e-9)
    # Their sum is the normal force of the podium; the trace of results is coarser than
    # that of columns, hence 2 %.
    trace = result.trace
    normal = getattr(trace, f"normal_{plan.end}")
    nearest = int(np.argmin(np.abs(trace.time - plan.time)))
    beside = normal[max(0, nearest - 3) : nearest + 4]
    assert beside.min() <= each.sum() * 1.02
    assert each.sum() <= beside.max() * 1.02


@needs_compiled_kernels
def test_the_drawing_marks_the_most_loaded_columns():
    result = result_of("{length: 12 m}", columns=6)
    plan = ColumnPlan(result.structure, result.axial.plan)
    figure = drawn(style.single(draw_plan, plan, ("title",), 4.0))
    (axes,) = figure.axes
    red = [
        patch
        for patch in axes.patches
        if patch.get_facecolor()[:3] == (213 / 255, 94 / 255, 0)
    ]
    assert len(axes.patches) == 6
    assert len(red) == 3  # a row, whose columns carry alike
    texts = [text.get_text() for text in axes.texts]
    assert texts.count(f"{1e-3 * result.max_column_force:.4g}") == 3
    assert "carry alike" in plan_picture(result, "a record", USUAL).caption


@needs_compiled_kernels
def test_without_rows_there_is_no_plan():
    assert plan_picture(result_of("null"), "a record", USUAL) is None
