"""`rps export`: a case under its record as files that another program runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rpscli.commands import inputs
from rpscli.commands.shell import options
from rpscli.commands.shell.terminal import Terminal
from rpscli.errors import AnalysisError, UsageError

if TYPE_CHECKING:
    from rpscli.analyses.results import TimeHistoryResult

RERUN = "rerun.py"
PROGRAMS = {"mujoco": "model.xml", "opensees": "model.py"}
BODIES = """\
Columns are rigid bodies in contact with ground and cap beam, which close within 0.1 ms and give
nothing back: impacts take what comes of that, as the law `flexible` with a loss of 1, whatever the
case says (e = {:.4g}). Columns do not slide. Arcs never end: tilts must stay below {:.4g} rad."""


@click.command("export")
@options.case_options
@click.argument("program", metavar="|".join(PROGRAMS), type=click.Choice([*PROGRAMS]))
@options.records_option
@options.output_options
@options.terminal_options
def command(
    request: options.CaseRequest,
    program: str,
    records: tuple[str, ...],
    output: options.OutputRequest,
    terminal: Terminal,
) -> None:
    """Write CASE and its record as a model for another program.

    mujoco: rigid bodies in contact, which know no impact law. opensees: floors on a spring that
    uplifts, impacts as a damper. Further files are timehistory.csv, the record with the history
    that rps computes, and rerun.py, which runs the model and draws both; it needs openseespy or
    mujoco, and matplotlib, but not rps.
    """
    from importlib import resources

    from rpscli.analyses.timehistory import time_history
    from rpscli.analyses.trace import prolonged
    from rpscli.commands.shell.waiting import announce_compilation
    from rpscli.report.bundles import history_columns
    from rpscli.report.table import Column, csv_lines

    given = inputs.read_case(request, terminal)
    motions = list(inputs.single_motions(records, inputs.MotionRequest(), terminal.warn))
    if len(motions) > 1:
        raise UsageError(f"--record: a model has one motion, not {len(motions)}; name one of them")
    ground = inputs.load_motion(given.case, motions[0])
    structure = given.case.structure
    vertical = ground.vertical if program == "opensees" else None
    left = {"podium.devices": structure.devices, "record.vertical": vertical,
            "podium.contact": structure.bed}  # fmt: skip
    why = [f"{key} is not exported; remove it by --set {key}=null" for key in left if left[key]]
    if ground.y is not None:
        why.append("a model has one plane; name one of both components by --record")
    if why:
        text = f"{given.case.source}: {why[0]}, so that both programs compute the same"
        raise UsageError(text)
    own = inputs.RESULTS / given.case.name / "export" / program
    place = options.OutputRequest(output.place or own, output.force)
    resolved = {"program": program, "record": inputs.motion_inputs(ground)}
    source = inputs.motion_source(given.case, motions[0])
    folder = inputs.case_folder(given, place, "export", record_source=source, **resolved)
    announce_compilation(terminal)
    result = time_history(structure, ground, given.case.analysis)
    if result.failure:
        raise AnalysisError(result.failure)
    text, limits = _model(program, result, given.case.title)
    folder.add(PROGRAMS[program], text)
    columns = history_columns(result)
    if ground.vertical is not None:
        up = prolonged(ground.vertical.acceleration, len([*columns[0].values]))
        columns.append(Column("ground_acceleration_up", "m/s2", up))
    folder.add("timehistory.csv", csv_lines(columns))
    folder.add(RERUN, resources.files("rpscli.report.export").joinpath(RERUN).read_text("utf-8"))
    document = {"program": program, "limits": limits}
    inputs.conclude(
        given, folder, document, [limits, f"next: python {folder.folder / RERUN}"], terminal
    )


def _model(program: str, result: TimeHistoryResult, title: str) -> tuple[str, str]:
    """The text of the model, and its limits in words."""
    structure = result.structure
    if program == "opensees":
        from rpscli.report.export.opensees import model_text

        return model_text(structure, title, result.max_cap_beam_displacement)
    from rpscli.report.export.multibody import bodies_of, description

    bearing = structure.bearing
    limits = BODIES.format(structure.restitution, bearing.beta or bearing.critical_rotation)
    remark = f"{title}\n\n{limits}".replace("--", "- -")
    columns = 2 if structure.cap_beam_mass else 1
    return f"<!-- {remark} -->{description(bodies_of(structure), columns)}\n", limits
