"""Motions that were chosen for a target, as documents, tables and files."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from rpscli.records.source import is_file
from rpscli.records.target import COMPONENTS, NOT_VERIFIED
from rpscli.report.figures.look import USUAL, Look
from rpscli.report.figures.style import figure_files
from rpscli.report.files import Files
from rpscli.report.table import (
    Column,
    Part,
    Table,
    csv_text,
    picked,
    records,
    shown,
)
from rpscli.tools.selection.figure import selection_figure
from rpscli.tools.selection.selection import Selection, misfit


def selection_document(selection: Selection) -> dict[str, Any]:
    """Motions that were chosen, beside the target; SI units."""
    names = ("source", "second", "factor", "clamped", "event", "pgv", "pgd", "misfit")
    columns = picked(selection_columns(selection), *names)
    target = selection.target
    asked = selection.requirements
    errors = selection.errors
    of_target = (
        "name", "parameters", "source", "edition", "checked", "level", "damping", "pgv", "pgv_by",
        "pgd",
    )  # fmt: skip
    numbers = (
        "candidates",
        "refused",
        "clamped",
        "misfit",
        "least_ratio",
        "mean_pgv",
        "mean_pgd",
    )
    rules = [{**rule._asdict(), "verdict": rule.word} for rule in selection.rules]
    return {
        "target": {name: getattr(target, name) for name in of_target}
        | {"component": target.of},
        "component": selection.of,
        "periods": [float(selection.periods[0]), float(selection.periods[-1])],
        "common_factor": selection.common,
        **{name: getattr(selection, name) for name in numbers},
        "largest_errors": errors
        and dict(zip(("mean", "deviation"), errors, strict=True)),
        "requirements": asked
        and {"clause": asked.clause, "checked": asked.checked, "rules": rules},
        "motions": records(columns),
    }


def selection_columns(selection: Selection) -> list[Column]:
    """`selection.csv`: one row a motion, its peaks scaled."""
    chosen = selection.chosen
    three = partial(shown, digits=3)
    misfits = [float(misfit(one.scaled[1:], selection.wanted)) for one in chosen]
    seconds = [one.motions[1].source if len(one.motions) > 1 else None for one in chosen]

    def column(name: str, *head: Any, unit: str = "-", scaled: bool = False) -> Column:
        values = [getattr(one, name) for one in chosen]
        if scaled:
            values = [
                one.factor * value for one, value in zip(chosen, values, strict=True)
            ]
        return Column(name, unit, values, *head)

    return [
        column("name", "motion"),
        Column("source", "-", [one.motions[0].source for one in chosen]),
        Column("second", "-", seconds),
        column("factor", "factor", "{:.4g}".format),
        column("clamped", "at a bound", lambda held: "yes" * held),
        Column("event", "-", [one.event or one.name for one in chosen], "event"),
        column("pga", unit="m/s2", scaled=True),
        column("pgv", "PGV [m/s]", three, unit="m/s", scaled=True),
        column("pgd", "PGD [m]", three, unit="m", scaled=True),
        Column("misfit", "-", misfits, "misfit", "{:.3f}".format),
    ]


USUAL_DAMPING = 0.05  # of the spectra that codes' rules are about

FAR = 2.0  # times the target's peaks, or as many parts of them, beyond which it is told

WHY_PGV = (
    "Sa(T1) is a poor measure for rocking: once lifted the structure has no period of"
    " its own, and overturning depends on the velocity of long pulses. Compare PGV and"
    " PGD with the target's; --scale-by PGV brings every motion to the target's PGV."
)


def selection_doubts(selection: Selection, fixed: float | None) -> Iterator[str]:
    """Doubts for a human; `fixed` is T1 of the structure on a fixed base [s]."""
    asked = selection.requirements
    target = selection.target
    chosen = selection.chosen
    first, last = selection.periods[[0, -1]]
    if fixed is not None and not first <= fixed <= last:
        yield (
            f"T1 = {fixed:.3g} s lies outside of the periods that are compared,"
            f" {first:.3g} to {last:.3g} s: there nothing is known of the target"
        )
    yield from (text for one in chosen for m in one.motions for text in m.warnings)
    usable = {one.name: one.motions[0].recording.usable_period for one in chosen}
    short = [
        f"{name} ({until:.3g} s)"
        for name, until in usable.items()
        if until and until < last
    ]
    if short:
        yield f"filtered before the end of the range, {last:.4g} s: {', '.join(short)}"
    if asked is not None and target.damping != USUAL_DAMPING:
        yield f"{asked.clause} is about spectra of 5 % damping"
    if selection.of == "srss" and (asked is None or asked.of != "srss"):
        yield (
            "the SRSS of a pair is some 1.4 times one component: pairs that meet a"
            " target of single components by it are too weak for both together (EN"
            f" 1998-2 asks for 1.3 times the target, {NOT_VERIFIED}: from memory); choose"
            " --component geomean or rotd50"
        )
    if selection.clamped:
        of = f"{selection.clamped} of {len(chosen)} factors"
        yield f"{of} are held at a bound: widen --factors, or give motions of another size"
    for name in ("pgv", "pgd"):
        wanted = getattr(target, name)
        mean = getattr(selection, f"mean_{name}")
        if wanted is not None and not wanted / FAR <= mean <= wanted * FAR:
            yield f"the mean {name.upper()} is {mean / wanted:.2g} times that of the target"
    remedy = "take that from the clause (--periods), and give the spectrum as a CSV file"
    of_rules = (
        f"{asked.clause}: {asked.checked}; where it matters {remedy}" if asked else ""
    )
    yield from (
        checked for checked in (target.checked, of_rules) if NOT_VERIFIED in checked
    )


def selection_tables(
    selection: Selection, why: str, left_out: Mapping[str, Mapping[str, int]]
) -> Iterator[Part]:
    """Tables of the chosen motions, how well they fit, and what the code asks."""
    names = ("name", "event", "factor", "pgv", "pgd", "misfit", "clamped")
    yield Table(picked(selection_columns(selection), *names), words=2)
    refused = f"; {selection.refused} beyond the factors" * bool(selection.refused)
    how = "by exchange from many first choices, not of all sets"
    rows = {
        **fit_rows(selection, why),
        "common factor, after their own": f"{selection.common:.4f}",
        "factors at a bound": f"{selection.clamped} of {len(selection.chosen)}",
        "chosen among": f"{selection.candidates}{refused}; "
        + ("all sets were examined" if selection.whole else how),
    }
    for text, counts in left_out.items():
        rows[f"left out by {text}"] = (
            f"{counts['outside']}; {counts['not_known']} not known"
        )
    yield Table.listing(rows.items())
    yield from rules_tables(selection)
    yield WHY_PGV


def fit_rows(selection: Selection, why: str) -> dict[str, str]:
    """The target and how well the set fits it, in words; `why` the periods are these."""
    target = selection.target
    low, high = selection.periods[[0, -1]]
    by = f" ({target.pgv_by})" if target.pgv else ""
    rows = {
        "target": ": ".join(filter(None, (target.name, target.parameters))),
        "edition": target.edition,
        "checked": target.checked,
        "spectra of": COMPONENTS[selection.of]
        + ("" if target.of else "; the target names no measure of pairs"),
        "periods": f"{low:.3g} to {high:.3g} s: {why}",
        "misfit of the mean, rms of ln(mean/target)": f"{selection.misfit:.4f}",
        "least mean/target": f"{selection.least_ratio:.3f}",
        "mean PGV, target's": f"{selection.mean_pgv:.3f}, {shown(target.pgv, 3)} m/s{by}",
        "mean PGD, target's": f"{selection.mean_pgd:.3f}, {shown(target.pgd, 3)} m",
    }
    if (errors := selection.errors) is not None:
        text = "largest errors of mean and deviation of ln Sa"
        rows[text] = f"{errors[0]:.3f}, {errors[1]:.3f}"
    return rows


def rules_tables(selection: Selection) -> Iterator[Part]:
    """Every requirement of the code beside what the set has."""
    if (asked := selection.requirements) is None:
        return
    yield f"{asked.clause}; {asked.checked}:"
    judged = [
        (rule.rule, rule.required, rule.found, rule.word) for rule in selection.rules
    ]
    yield Table.of_texts(["requirement", "required", "result", ""], judged, words=4)


def selection_files(selection: Selection, folder: Path, look: Look = USUAL) -> Files:
    """Files of a choice of motions; the list names them as seen from the folder."""
    yield "selection.txt", selection_list(selection, folder)
    yield "selection.csv", csv_text(selection_columns(selection))
    columns = [
        Column("period", "s", selection.periods),
        Column("target", "m/s2", selection.wanted),
        Column("mean", "m/s2", selection.mean),
    ]
    if (wanted := selection.target.deviation) and selection.deviation is not None:
        columns.append(Column("target_deviation", "-", wanted(selection.periods)))
        columns.append(Column("deviation", "-", selection.deviation))
    scaled = [
        Column(of.name, "m/s2", of.factor * of.acceleration) for of in selection.chosen
    ]
    yield "spectra.csv", csv_text([*columns, *scaled])
    draw = partial(selection_figure, selection, selection.target.name)
    yield from figure_files({"selection": draw}, look).items()


def selection_list(selection: Selection, folder: Path) -> str:
    """`selection.txt`: a source with its factor a line, files as seen from the folder."""
    what = (
        "motions"
        if selection.of == "component"
        else "pairs, both components under one factor"
    )
    heads = (
        f"# {len(selection.chosen)} {what}, for {selection.target.source}",
        (
            "# in a study: records: ['list:selection.txt'], with the path as seen from the"
            " study"
        ),
    )
    lines = []
    for one in selection.chosen:
        of = one.source
        place = one.source.place
        if is_file(place, None) and not Path(place).expanduser().is_absolute():
            of = of.at(Path(os.path.relpath(place, folder)).as_posix())
        lines.append(of.plus(factor=f"{of.factor * one.factor:g}"))
    return "\n".join((*heads, *lines)) + "\n"
