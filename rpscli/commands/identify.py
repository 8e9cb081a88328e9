"""`rps identify`: what measurements on a standing building say about its case."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rpscli.commands.inputs import case_heading, read_case
from rpscli.commands.shell.options import FILE, CaseRequest, case_options, terminal_options
from rpscli.commands.shell.terminal import Terminal
from rpscli.commands.shell.waiting import announce_compilation, passing_time
from rpscli.errors import AnalysisError, RecordError, Refused, UsageError, listed
from rpscli.report.documents import heading
from rpscli.report.files import encoded, write_whole
from rpscli.report.table import Heading, Part, Table, columns_of, records, shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rpscli.analyses.identification.estimate import Estimate
    from rpscli.model.podium import PodiumStructure

    Columns = dict[str, NDArray[Any]]

TESTS = ("rocking", "ambient", "release", "earthquake")


@click.command("identify")
@case_options
@click.argument("data", metavar="DATA.csv", type=FILE)
@click.argument("test", metavar="|".join(TESTS), type=click.Choice(TESTS))
@click.option("--from", "first", type=float, metavar="S", help="Ignore samples before this time.")
@click.option("--to", "last", type=float, metavar="S", help="Ignore samples after this time.")
@click.option("-o", "--output", "place", type=click.Path(path_type=Path), metavar="FILE.yaml",
              help="A copy of CASE with the identified values; comments are kept.")  # fmt: skip
@click.option("--force", is_flag=True, help="Overwrite that file.")
@terminal_options
def command(
    request: CaseRequest,
    data: str,
    test: str,
    first: float | None,
    last: float | None,
    place: Path | None,
    terminal: Terminal,
    *,
    force: bool,
) -> None:
    """Identify properties of CASE from DATA.csv, measured on the structure, with 90 % intervals.

    Its header has names and units, as in `time [s],rotation [mrad]`. rocking: free rocking after a
    release from rest, `rotation` or `cap_beam_displacement`, gives the loss at impacts, and the
    lever of a rolling_resistance in the case. Before uplift the period and the damping follow from
    a `floor_acceleration`: ambient vibration, the release of a pull, or an earthquake with
    `ground_acceleration` as well.
    """
    if place is not None and place.exists() and not force:
        raise Refused(f"{place} exists; name another file with -o, or overwrite it with --force")
    given = read_case(request, terminal)
    structure = given.case.structure
    measured = _measured(data, test, first, last)
    announce_compilation(terminal)
    from rpscli.analyses.identification.estimate import LEVEL

    with passing_time("fitting", terminal):
        try:
            found = (_rocking if test == "rocking" else _vibration)(structure, measured, test)
        except AnalysisError as error:
            raise AnalysisError(f"{data}: {error}") from None
    estimates, document, parts, values = found
    rows = [(*each, *value) for each, value in estimates.items() if value is not None]
    columns = columns_of(dict.fromkeys(("name", "unit", "value", "low", "high"), "-"), rows)
    texts = [(name, *(shown(x, 5) for x in value), unit.strip("-")) for name, unit, *value in rows]
    table = Table.of_texts(("", "value", "from", "to", "unit"), texts)
    files = []
    if place is not None:
        if not values:
            raise UsageError(f"-o {place}: nothing was identified that has a key in a case")
        from rpscli.case.text.files import read_text
        from rpscli.case.text.yaml_text import edited

        changes = (f"{key}={value}" for key, value in values.items())
        read_case(CaseRequest(request.source, (*request.overrides, *changes)), terminal)
        text = edited(read_text(request.source), request.source, values)
        write_whole({place: encoded(text)})
        files.append(str(place))
        terminal.note(f"written to {place}")
    begin = {**heading("identify"), "case": case_heading(given), "test": test}
    begin |= {"level": LEVEL, "estimates": records(columns), **document}
    end = {"keys": values, "warnings": given.case.warnings, "files": files}
    terminal.result({**begin, **end}, [Heading(given.case.title), table, *parts])


WANTED = {
    "rocking": (("rotation", "rad"), ("cap_beam_displacement", "m")),
    "floor": (("floor_acceleration", "m/s2"),),
    "ground": (("ground_acceleration", "m/s2"),),
}
"""Columns of which one is needed, and their SI units."""


def _measured(source: str, test: str, first: float | None, last: float | None) -> Columns:
    """What a test needs, in SI units, in the time that is looked at."""
    import numpy as np

    from rpscli.case.text.files import read_text
    from rpscli.units import si_factor

    heads, *rows = [row for row in csv.reader(io.StringIO(read_text(source))) if row] or [[]]
    names = [head.strip().partition(" [")[0] for head in heads]
    kinds = ("rocking",) if test == "rocking" else ("floor", "ground")[: 1 + (test == "earthquake")]
    columns: Columns = {}
    for wanted in ((("time", "s"),), *(WANTED[kind] for kind in kinds)):
        column = next((each for each in wanted if each[0] in names), None)
        if column is None:
            missing = listed(f"`{name} [{unit}]`" for name, unit in wanted)
            raise RecordError(f"{source}:1: no column {missing}; {test} needs one: name it so")
        place, unit = names.index(column[0]), heads[names.index(column[0])].partition("[")[2]
        try:
            factor = si_factor(unit.strip(" ]") or column[1], column[1])
            values = np.array([float(row[place]) for row in rows])
        except (ValueError, IndexError) as error:
            rule = f"write numbers, in {column[1]} or another such unit"
            raise RecordError(f"{source}: column {column[0]}: {error}; {rule}") from None
        columns[column[0]] = values * factor
    time = columns["time"]
    steps = np.diff(time)
    if len(time) < 20 or not np.allclose(steps, steps.mean(), rtol=1e-2, atol=0.0):
        raise RecordError(f"{source}: at least 20 samples at even times are needed; resample it")
    ends = (time[0] if first is None else first), (time[-1] if last is None else last)
    kept = (time >= ends[0]) & (time <= ends[1])
    if kept.sum() < 20:
        raise UsageError(
            f"{source}: {kept.sum()} samples lie between --from and --to; 20 are needed"
        )
    return {name: values[kept] for name, values in columns.items()}


Found = tuple[
    "Mapping[tuple[str, str], Estimate | None]", dict[str, Any], list[Part], dict[str, str]
]


def _rocking(structure: PodiumStructure, columns: Columns, _: str) -> Found:
    import numpy as np

    from rpscli.analyses.identification.rocking import rocking
    from rpscli.model.devices import RollingResistance

    rotation = columns.get("rotation")
    if rotation is None:
        beam = columns["cap_beam_displacement"]
        x = np.linspace(0.0, structure.critical_rotation, 2001)
        rotation = np.sign(beam) * np.interp(np.abs(beam), structure.path(x)[1], x)
    found = rocking(structure, columns["time"], rotation)
    estimates = {("restitution", "-"): found.restitution, ("loss", "-"): found.loss,
                 ("lever", "m"): found.lever}  # fmt: skip
    keys = {}
    if found.loss is not None:
        keys["podium.impact.loss"] = f"{found.loss.value:.4g}"
    else:
        keys["podium.impact.restitution"] = f"{found.restitution.value:.5g}"
    if found.lever is not None:
        kinds = [isinstance(device, RollingResistance) for device in structure.devices]
        keys[f"podium.devices.{kinds.index(True)}.lever"] = f"{found.lever.value:.4g}"
    names = ("time", "amplitude", "time_error", "amplitude_error", "model_time", "model_amplitude")
    swings = [dict(zip(names, (*swing, *model), strict=True))
              for swing, model in zip(found.swings, found.model.tolist(), strict=True)]  # fmt: skip
    heads = ("swing at s", "of the model", "rotation mrad", "of the model", "over its error")
    texts = []
    for swing, (at, top) in zip(found.swings, found.model.tolist(), strict=True):
        numbers = (swing.time, at, 1e3 * swing.amplitude, 1e3 * top)
        off = (swing.amplitude - top) / swing.amplitude_error
        texts.append((*(shown(number, 5) for number in numbers), shown(off, 2)))
    table = Table.of_texts(heads, texts, words=0)
    told = f"residuals are {shown(found.misfit, 3)} times what noise alone would leave"
    if found.misfit > 2.0:
        told += ": the model lacks something, such as rolling resistance; intervals include that"
    if found.ensembles:
        told += "; neighbouring releases diverge, so means of ensembles were fitted"
    document = {"misfit": found.misfit, "ensembles": found.ensembles, "residuals": swings}
    return estimates, document, [table, told], keys


def _vibration(structure: PodiumStructure, columns: Columns, test: str) -> Found:
    from rpscli.analyses.identification.estimate import Estimate
    from rpscli.analyses.identification.vibration import vibration

    building = structure.superstructure
    if building is None:
        raise UsageError(f"{test}: without storeys there is no period before uplift; use rocking")
    time, fixed = columns["time"], float(building.periods[0])
    step = float(time[-1] - time[0]) / (len(time) - 1)
    ground = columns.get("ground_acceleration")
    found = vibration(fixed, step, columns["floor_acceleration"], ground, free=test == "release")
    ratio = Estimate(*(value / fixed for value in found.period))
    estimates: dict[tuple[str, str], Estimate | None] = {
        ("period", "s"): found.period,
        ("damping", "-"): found.damping,
        ("period_ratio", "-"): ratio,
    }
    told = f"period_ratio is over {shown(fixed)} s, the period of the case on a fixed base"
    keys: dict[str, str] = {}
    if ratio.low > 1.0:
        from rpscli.model.contact import Contact

        try:
            soft = [replace(structure, contact=Contact("plane", each)).bed for each in ratio]
            best, stiffest, softest = (bed for bed in soft if bed is not None)
        except ValueError as error:
            raise AnalysisError(f"period_ratio = {ratio.value:.4g}: {error}") from None
        both = (best.stiffness, softest.stiffness, stiffest.stiffness)
        estimates["stiffness", "N/m"] = Estimate(*both)
        if None not in (sunk := [bed.settlement for bed in (best, stiffest, softest)]):
            estimates["settlement", "m"] = Estimate(*(each for each in sunk if each is not None))
        keys["podium.contact.period_ratio"] = f"{ratio.value:.4g}"
        keys["podium.contact.kind"] = "plane"
        told += "; stiffness of the storey in full contact; a period does not show whether ends are"
        told += " `plane`, which the settlement is for, or `edges`: try both"
    else:
        told += "; 1, which is rigid contact, is not excluded"
    return estimates, {"misfit": found.misfit, "ensembles": False, "residuals": []}, [told], keys
