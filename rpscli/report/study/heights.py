"""Storeys and floors of a study: shears over the height (paper,
Figure 9), floor spectra.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, Literal, NamedTuple

import numpy as np
from pydantic import Field

from rpscli.analyses.floor_spectra import DAMPING, PERIODS
from rpscli.analyses.result_quantities import STOREY_SHEARS
from rpscli.case.schema.fields import DampingRatio
from rpscli.case.study.reports import ReportOptions, VariedKeys
from rpscli.report.figures import style
from rpscli.report.study import panels
from rpscli.report.study.report import Found, Report, keyed, reached, without_uplift
from rpscli.report.table import Column
from rpscli.sweep.points import StudyPoints
from rpscli.sweep.statistics.fractiles import THREE
from rpscli.sweep.statistics.grouping import Histories, grouping, own_keys
from rpscli.sweep.table import Array, StoredPoints, groups


class StoreyShearOptions(ReportOptions):
    """Mean and largest storey shears against those on a fixed base."""

    panels: VariedKeys | None = Field(
        None, description="varied keys, one panel for each value"
    )
    unit: Literal["V_st", "kN"] = "V_st"
    """of the figure: the base shear at uplift, or kN to compare systems"""


class FloorSpectraOptions(ReportOptions):
    """Spectra of equipment on the floors: fractiles, isolated beside fixed base."""

    damping: DampingRatio = Field(DAMPING, description="of the equipment")


SHEARS = (
    ("mean", "mean of survivors", style.BLACK, "-"),
    ("largest", "largest of survivors", style.RED, "-"),
    ("fixed_mean", "mean, fixed base", style.BLACK, "--"),
    ("fixed_largest", "largest, fixed base", style.RED, "--"),
)


class Profile(NamedTuple):
    """Storey shears of the survivors of a group of systems, on the fixed base too."""

    values: tuple[object, ...]
    histories: Histories
    shears: tuple[Array, ...]  # over V_st, in the order of `SHEARS`, each (n,)
    static: float  # V_st [N]; NaN if the systems of the group differ in it


def storey_shear(study: StoredPoints, options: StoreyShearOptions) -> Found:
    """Profiles of each system at each intensity, or of the
    groups that the study names.
    """
    found = grouping(study.table, options.panels)
    profiles = [
        profile for group in found.groups if (profile := profile_of(study, group))
    ]
    notes = list(found.notes)
    histories = [profile.histories for profile in profiles]
    if fallen := sum(group.overturned.number for group in histories):
        notes.append(
            f"means and largest shears are those of survivors: {fallen} of"
            f" {sum(map(len, histories))} histories overturned and are left out, on the"
            " fixed base too"
        )
    in_kn = options.unit == "kN"
    in_kn_label = STOREY_SHEARS.in_unit("kN", STOREY_SHEARS.symbol)
    figure = panels.in_panels(
        found.keys,
        profiles,
        partial(_draw_profile, in_kn=in_kn),
        x_label=in_kn_label if in_kn else "$V_i/V_{st}$ [-]",
        y_label="level (0 = cap beam)",
        share="x",
        limits=lambda axes: axes.set_xlim(left=0.0),
        note=panels.noted(found, failed=sum(group.failed for group in histories)),
    )
    return Found({"": _shear_columns(found.keys, profiles)}, figure, notes)


def _shear_columns(keys: Sequence[str], profiles: Sequence[Profile]) -> list[Column]:
    """One row a storey of a profile, the first storey first."""
    rows = [
        (one.values, storey, *ratios, *(ratio * one.static for ratio in ratios), *counts)
        for one in profiles
        for of in [one.histories]
        for counts in [(len(of.survivors), of.overturned.number, of.failed)]
        for storey, ratios in enumerate(np.transpose(one.shears).tolist(), start=1)
    ]
    heads = [f"{name}_shear_ratio" for name, *_ in SHEARS]
    heads += [f"{name}_shear [N]" for name, *_ in SHEARS]
    return keyed(keys, f"storey, {', '.join(heads)}, counted, overturned, failed", rows)


def _draw_profile(axes: style.Axes, profile: Profile, *, in_kn: bool) -> None:
    """Shears over the height: the same all the way up a storey."""
    edges = np.arange(len(profile.shears[0]) + 1)
    if in_kn:
        axes.locator_params(axis="x", nbins=3)  # long numbers
    for (_, name, colour, line), shear in zip(SHEARS, profile.shears, strict=True):
        values = shear * profile.static * 1e-3 if in_kn else shear
        look: dict[str, Any] = {"color": colour, "ls": line, "lw": 1.3, "label": name}
        axes.stairs(values, edges, orientation="horizontal", **look)
    axes.set_ylim(0.0, len(edges) - 1)
    axes.locator_params(axis="y", integer=True)
    survivors = len(profile.histories.survivors)
    every = len(profile.histories)
    text = f"{survivors} survivors{panels.break_if_narrow(axes)}of {every}"
    panels.corner(axes, "right", "top", text)


def profile_of(study: StoredPoints, group: Histories) -> Profile | None:
    """The profile of a group; None without storeys."""
    table = study.table
    layout = study.table.layout
    systems = np.unique(group.every // layout.points_of_system)
    n = layout.properties[systems[0]].storeys
    if n == 0:
        return None
    statics = np.array([properties.static_base_shear for properties in layout.properties])
    kept = group.survivors
    static = statics[kept // layout.points_of_system, None]
    fixed = np.empty((len(kept), n))
    for row, number in enumerate(kept.tolist()):
        point = layout[number]
        assert point.record is not None, "points of histories have a record"
        fixed[row] = (
            abs(table.scale[number]) * study.fixed_base[point.system, point.record]
        )
    unique = np.unique(statics[systems])
    shears = tuple(
        statistic(values, axis=0) if len(kept) else np.full(n, np.nan)
        for values in (table.storey_shears[kept, :n] / static, fixed / static)
        for statistic in (np.mean, np.max)
    )
    return Profile(
        group.values, group, shears, float(unique[0]) if len(unique) == 1 else np.nan
    )


def unlike_buildings(layout: StudyPoints, options: StoreyShearOptions) -> Iterator[str]:
    """Panels whose systems differ in what their common profile would need."""
    yield from without_uplift(layout, options)
    keys = own_keys(layout) if options.panels is None else options.panels
    for group in groups(layout, keys):
        systems = [
            layout.properties[i]
            for i in np.unique(group.points // layout.points_of_system)
        ]
        named = ", ".join(
            f"{key} = {value}" for key, value in zip(keys, group.values, strict=True)
        )
        of = f"the panel of {named}" if named else "its one panel"
        storeys = sorted({system.storeys for system in systems})
        if len(storeys) > 1:
            yield (
                f"{of} holds buildings of {storeys} storeys; let `panels` name the key in"
                " which they differ"
            )
        elif (
            options.unit == "kN"
            and len({system.static_base_shear for system in systems}) > 1
        ):
            yield f"{of} holds systems of different V_st, so that `unit` must be V_st"


class Floors(NamedTuple):
    """Fractiles of the spectra of a group, infinite if overturned."""

    values: tuple[object, ...]
    fractiles: Array  # (3, 2, 2, n, p): by `STATES`, `SPECTRA`, floors and periods


STATES = {
    "isolated": ("on bearings", style.BLUE),
    "fixed_base": ("fixed base", style.BLACK),
}
SPECTRA = {"pseudo_acceleration": "m/s2", "displacement": "m"}


def floor_spectra(study: StoredPoints, options: FloorSpectraOptions) -> Found:
    """Run the histories once more for their samples, which are not stored."""
    found = grouping(study.table)
    floors = []
    for group in found.computed:
        spectra = np.array(
            [study.floor_spectra(n, options.damping) for n in group.points.tolist()]
        )
        # An overturned history is larger than any demand; its building on a fixed base is
        # not.
        spectra[group.fallen, 0] = np.inf
        spread = np.quantile(spectra, THREE, axis=0, method="inverted_cdf")
        floors.append(Floors(group.values, spread))
    heads = [
        f"{state}_{name}_{100 * share:.0f} [{unit}]"
        for state in STATES
        for name, unit in SPECTRA.items()
        for share in THREE
    ]
    rows = [
        (one.values, floor, float(period), *map(reached, cells.ravel().tolist()))
        for one in floors
        # by floors and periods, then states, kinds of spectrum and fractiles
        for floor, of_floor in enumerate(one.fractiles.transpose(3, 4, 1, 2, 0), start=1)
        for period, cells in zip(PERIODS, of_floor, strict=True)
    ]
    note = panels.noted(found, NOT_DRAWN if found.overturned else "")
    return Found(
        {"": keyed(found.keys, f"floor, period [s], {', '.join(heads)}", rows)},
        floor_spectra_figure(found.keys, floors, note) if floors else None,
        found.notes,
    )


def floor_spectra_figure(
    keys: Sequence[str], floors: Sequence[Floors], note: str
) -> Callable[[str], style.Draw]:
    """Median and 84 % fractile of the pseudo-acceleration, on the
    lowest floor and the roof.
    """
    shown = [
        Floors((*one.values, number), one.fractiles[:, :, 0, number - 1])
        for one in floors
        for number in dict.fromkeys((1, one.fractiles.shape[3]))
    ]

    def draw(axes: style.Axes, panel: Floors) -> None:
        for state, (name, colour) in enumerate(STATES.values()):
            for row, dashes, words in ((1, "-", "median"), (2, "--", "84 % fractile")):
                values = panel.fractiles[row, state]
                axes.plot(
                    PERIODS, np.where(np.isfinite(values), values, np.nan), ls=dashes,
                    color=colour, lw=1.3, label=f"{name}, {words}",
                )  # fmt: skip

    def limits(axes: style.Axes) -> None:
        # At the end: panels are given ticks for equal steps before they are drawn.
        axes.set_xscale("log")
        axes.set(xlim=(PERIODS[0], PERIODS[-1]), ylim=(0.0, None))
        for each in axes.figure.axes:
            each.xaxis.set_major_formatter("{x:g}")

    labels = {"x_label": "period [s]", "y_label": "pseudo-acceleration [m/s²]"}
    return panels.in_panels(
        (*keys, "floor"), shown, draw, limits=limits, note=note, **labels
    )


def without_floors(layout: StudyPoints, _options: ReportOptions) -> Iterator[str]:
    """Systems without a building, or with different ones in a sample."""
    storeys = np.array([properties.storeys for properties in layout.properties])
    by_sample = storeys.reshape(layout.shape[:-3])
    if not storeys.all():
        yield "a system has no superstructure, and so no floors; leave out storeys: 0"
    elif (np.ptp(by_sample, axis=-1) > 0).any():
        yield "the sample varies the number of storeys; vary it in an axis instead"


NOT_DRAWN = "fractiles at which the structure overturned are not drawn"

STOREY_SHEAR = Report(StoreyShearOptions, storey_shear, requires=unlike_buildings)
FLOOR_SPECTRA = Report(FloorSpectraOptions, floor_spectra, requires=without_floors)
