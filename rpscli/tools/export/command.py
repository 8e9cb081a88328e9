"""`rps export`: a case under its record as files that another program runs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import click

from rpscli.commands import inputs
from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import Terminal, announce_compilation
from rpscli.errors import AnalysisError, UsageError, visible

if TYPE_CHECKING:
    from rpscli.analyses.results import TimeHistoryResult
    from rpscli.records.ground_motion import MotionComponents

RERUN = "rerun.py"
PROGRAMS = {"mujoco": "model.xml", "opensees": "model.py"}


@click.command("export")
@options.case_options
@click.argument("program", metavar="|".join(PROGRAMS), type=click.Choice([*PROGRAMS]))
@options.records_option
@options.written_options
def command(
    request: options.CaseRequest,
    program: str,
    records: tuple[str, ...],
    out: options.Output,
) -> None:
    """Write CASE and its record as a model for another program.

    mujoco: rigid bodies in contact, which know no impact law. opensees: floors on a
    spring that uplifts, impacts as a damper. Further files are timehistory.csv, the
    record with the history that rps computes, and rerun.py, which runs the model and
    draws both; it needs openseespy or mujoco, and matplotlib, but not rps.
    """
    from rpscli.analyses.result_quantities import plain
    from rpscli.analyses.timehistory import time_history

    given = inputs.read_case(request, out.terminal)
    motion = _motion(given, records, out.terminal)
    _require_exportable(given, motion.ground, program)
    own = replace(
        out, place=out.place or inputs.RESULTS / given.case.name / "export" / program
    )
    folder = inputs.case_folder(given, own, "export", motion=motion, program=program)
    announce_compilation(out.terminal)
    result = time_history(given.case.structure, motion.ground, given.case.analysis)
    if result.failure:
        raise AnalysisError(result.failure)

    until = _comparable(result)
    text, limits = _model(program, result, visible(given.case.title), until)
    folder.add(PROGRAMS[program], text)
    folder.add("timehistory.csv", _history(result, motion.ground))
    folder.add(RERUN, _script(result, until))
    document = {"program": program, "limits": limits, "comparable_until": plain(until)}
    lines = [limits, f"next: python {folder.folder / RERUN}"]
    inputs.conclude(given, folder, document, lines, out.terminal)


def _motion(
    given: inputs.CaseInput, records: tuple[str, ...], terminal: Terminal
) -> inputs.CaseMotion:
    """The one motion of the model."""
    motions = list(inputs.single_motions(records, inputs.MotionRequest(), terminal.warn))
    if len(motions) > 1:
        raise UsageError(
            f"--record: a model has one motion, not {len(motions)}; name one of them"
        )
    return inputs.CaseMotion(motions[0], inputs.load_motion(given.case, motions[0]))


def _require_exportable(
    given: inputs.CaseInput, ground: MotionComponents, program: str
) -> None:
    """Refuse what the other program would leave out."""
    structure = given.case.structure
    vertical = ground.vertical if program == "opensees" else None
    left = {"podium.devices": structure.devices, "record.vertical": vertical,
            "podium.contact": structure.bed, "podium.impact": structure.impact_law.own,
            "superstructure.vertical_period": structure.upwards,
            "superstructure.yield": structure.yields and program == "mujoco"}  # fmt: skip
    why = [
        f"{key} is not exported; remove it by --set {key}=null"
        for key in left
        if left[key]
    ]
    if ground.y is not None:
        why.append("a model has one plane; name one of both components by --record")
    if why:
        text = f"{given.case.source}: {why[0]}, so that both programs compute the same"
        raise UsageError(text)


def _history(result: TimeHistoryResult, ground: MotionComponents) -> Iterator[str]:
    """The history of rps as CSV, beside the record with its vertical component."""
    from rpscli.analyses.trace import prolonged
    from rpscli.report.bundles import history_columns
    from rpscli.report.table import Column, csv_lines

    columns = history_columns(result)
    if ground.vertical is not None:
        up = prolonged(ground.vertical.acceleration, len([*columns[0].values]))
        columns.append(Column("ground_acceleration_up", "m/s2", up))
    return csv_lines(columns)


def _model(
    program: str, result: TimeHistoryResult, title: str, until: float
) -> tuple[str, str]:
    """The text of the model, and its limits in words."""
    from rpscli.tools.export import multibody, opensees

    note = (
        "Under 0.9999 and 1.0001 times the motion, displacements of rps stay within 1 %"
        " of the\n"
    )
    parts = f"up to {until:.4g} s; further on, programs that agree part as well"
    note += f"largest {parts if until < math.inf else 'to the end'}."
    if result.overturned:
        note += (
            f"\nIn rps it overturns at {result.duration:.4g} s, where history and record"
            " end."
        )
    if program == "opensees":
        return opensees.model_text(result, title, note)
    return multibody.model_text(result.structure, title, note)


def _script(result: TimeHistoryResult, until: float) -> str:
    """The script that runs the model, with what it has to know of the history."""
    from importlib import resources

    import numpy as np

    structure = result.structure
    rotation = result.settings.overturning_limit * structure.critical_rotation
    farthest = float(structure.path(np.array([rotation]))[1][0])
    text = resources.files("rpscli.tools.export").joinpath(RERUN).read_text("utf-8")
    for name, value in (("COMPARABLE", until), ("OVERTURNED", farthest)):
        text = text.replace(f"{name} = inf", f"{name} = {value!r}")
    return text


def _comparable(result: TimeHistoryResult) -> float:
    """Time from which slight changes of the motion move the cap beam
    [s]; infinite if none does.
    """
    import numpy as np

    from rpscli.analyses.timehistory import time_history

    own = result.trace.cap_beam_displacement
    first = math.inf
    for factor in (0.9999, 1.0001):
        motion = result.motion.scaled(factor)
        beside = time_history(
            result.structure, motion, result.settings, with_fixed_base=False
        )
        both = min(len(own), len(beside.trace.time))
        away = np.abs(beside.trace.cap_beam_displacement[:both] - own[:both])
        apart = np.flatnonzero(away > 0.01 * np.abs(own).max())
        first = min([first, *beside.trace.time[apart[:1]].tolist()])
    return first
