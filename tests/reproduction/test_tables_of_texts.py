"""Tables that texts show are what the commands beside them give today.

Single histories near overturning may end otherwise on another processor: few counts, by one.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pytest
from paper_structures import Array, RecordLoader, needs_compiled_kernels
from scipy.stats import beta
from shown_commands import ROOT, run_all, table

from reproduction.conftest import CASES, Reproduce, Row, rows_of
from reproduction.test_histories import PRINTED, arranged, column, overturned
from rpscli import load_study
from rpscli.constants import STANDARD_GRAVITY

pytestmark = [pytest.mark.long, needs_compiled_kernels]

README = CASES / "README.md"
COUNTS = table(README, "The counts themselves")
CHOICES = table(README, "## Table 3 under other choices")
FLEXIBLE = "podium.impact.law=flexible"
FEW = 3
"""Of 36 counts of a hundred: histories that may end otherwise."""


@pytest.mark.parametrize(
    ("name", "choice", "overrides"),
    [
        ("as recorded", "as in `table_3.yaml`", ()),
        ("normalised", "normalised records", ('records=["fema_p695:*?normalised"]',)),
        ("uniform", "uniform stiffness profile", ("superstructure.profile=uniform",)),
        ("linear", "linear stiffness profile", ("superstructure.profile=linear",)),
        ("flexible", "flexible impact law", (FLEXIBLE,)),
        ("theta_cr", "overturned at theta_cr", ("analysis.overturning_limit=1",)),
        ("4 theta_cr", "overturned at 4 theta_cr", ("analysis.overturning_limit=4",)),
    ],
)
def test_counts_of_table_3(
    name: str,
    choice: str,
    overrides: Sequence[str],
    reproduce: Reproduce,
    fema_record: RecordLoader,
) -> None:
    head, *rows = COUNTS
    told = np.array([int(row[head.index(name)]) for row in rows])
    assert [int(row[head.index("printed")]) for row in rows] == PRINTED.ravel().tolist()
    counts = overturned(reproduce("table_3", "points", *overrides)).sum(axis=3)
    assert np.abs(counts.ravel() - told).sum() <= FEW
    (option, *numbers) = next(row[1:] for row in CHOICES if row[0] == choice)
    assert option.strip("`") == (f"--set {quoted(overrides[0])}" if overrides else "")
    off = (told - PRINTED.ravel()) / 100
    means = [f"{mean:.3f}" for mean in told.reshape(9, 4).mean(axis=0) / 100]
    rest = [f"{np.abs(off).mean():.3f}", f"{off.mean():+.3f}", f"{np.abs(off).max():.2f}"]
    assert numbers == means + rest


def quoted(option: str) -> str:
    """As a shell wants it."""
    return f"'{option}'" if '"' in option else option


def energy_rows(points: Sequence[Row]) -> Iterator[list[str]]:
    """Cells of the table of energy at impacts."""
    whole = [
        arranged(column(list(points), name))
        for name in ("impacts", "creating_impacts", "energy_created", "energy_impact")
    ]
    parts: list[tuple[str, tuple[int | slice, ...]]] = [("all", ())]
    parts += [(f"n = {n}", (slice(None), i)) for i, n in enumerate((3, 6, 9))]
    ends = ("rho_cr", "rho = 0.5", "rho = 1.5", "flat ends")
    parts += [(name, (slice(None), slice(None), i)) for i, name in enumerate(ends)]
    parts += [(f"tan(alpha) = {t:.2f}", (i,)) for i, t in enumerate((0.10, 0.15, 0.20))]
    for name, part in parts:
        impacts, creating, created, net = (np.asarray(values[part]).ravel() for values in whole)
        some = impacts > 0
        lost = created + net
        yield [
            name, f"{some.sum()}", f"{(creating > 0).sum()}", f"{impacts.sum() / 1e3:.0f}",
            f"{creating.sum() / impacts.sum():.3f}", f"{created.sum() / lost.sum():.3f}",
            f"{np.median(created[some] / lost[some]):.3f}", f"{(net < 0.0).sum()}",
        ]  # fmt: skip


def test_energy_at_impacts(reproduce: Reproduce, fema_record: RecordLoader) -> None:
    assert [*energy_rows(reproduce("table_3", "points"))] == table(README, "## Energy at impacts")[
        1:
    ]


def test_what_the_flexible_law_changes(reproduce: Reproduce, fema_record: RecordLoader) -> None:
    """Figures 8 and 9, rigid / flexible."""
    laws = ((), (FLEXIBLE,))
    both = [reproduce("figure_8", "figure_8", *law) for law in laws]
    names = ("base_shear_ratio_at_uplift", "saturation_rotation_ratio",
             "saturation_base_shear_ratio", "k_s")  # fmt: skip
    for place, (n, rho, *told) in enumerate(table(README, "Figure 8, bilinear summary")[1:]):
        found = [
            " / ".join(f"{float(rows[place][name]):.{digits}f}" for rows in both)
            for name, digits in zip(names, (2, 3, 2, 2), strict=True)
        ]
        assert (n, rho, *told) == (n, rho, *found)
    both = [reproduce("figure_9", "figure_9", *law) for law in laws]
    assert [*profile_rows(both)] == table(README, "Figure 9, tan(alpha) = 0.15")[1:]
    text = " ".join(README.read_text("utf-8").split())
    points = [reproduce("figure_9", "points", *law) for law in laws]
    impacts = [f"{column(rows, 'impacts').sum() / 1e3:.0f} thousand" for rows in points]
    fell = [sum(row["outcome"].startswith("overturned") for row in rows) for rows in points]
    assert f"fewer impacts, {impacts[1]} in place of {impacts[0]}," in text
    assert f"{fell[1]} of 900 in place of {fell[0]}" in text
    flexible = reproduce("figure_8", "points", FLEXIBLE)
    assert f"(0 of {column(flexible, 'impacts').sum() / 1e3:.0f} thousand impacts)" in text
    assert column(flexible, "creating_impacts").sum() == 0


def profile_rows(both: Sequence[Sequence[Row]]) -> Iterator[list[str]]:
    """Cells of the table of storey shears, rigid / flexible."""
    for n in (3, 6, 9):
        for rho, name in (("critical", "rho_cr"), ("0.5", "0.5"), ("1.5", "1.5")):
            cells = []
            for kind in ("mean_shear_ratio", "largest_shear_ratio"):
                shears = [
                    column([r for r in rows if (r["superstructure.storeys"],
                                                r["podium.bearing.curvature_ratio"])
                            == (str(n), rho)], kind)
                    for rows in both
                ]  # fmt: skip
                cells += [
                    " / ".join(f"{np.max(s):.2f}" for s in shears),
                    " / ".join(f"{np.argmax(s) + 1}" for s in shears),
                    " / ".join(f"{s[-1]:.2f}" for s in shears),
                ]
            yield [str(n), name, *cells]


def groups_of(study: str, tmp_path: Path) -> dict[tuple[str, ...], list[Row]]:
    """Rows of a study of contacts by scale, kind of end, and force of friction."""
    run_all([f"rps sweep {ROOT / study} --figures none -o {tmp_path / 'run'}"])
    groups: dict[tuple[str, ...], list[Row]] = {}
    for row in rows_of(tmp_path / "run" / "points.csv"):
        key = [f"{float(row['scale']):g}", json.loads(row["podium.contact"])["kind"]]
        if "podium.devices" in row:
            devices = json.loads(row["podium.devices"])
            key.append(devices[0]["force"] if devices else "none")
        groups.setdefault(tuple(key), []).append(row)
    return groups


def cells_of(rows: Sequence[Row], scales: dict[str, float], rank: int = 6) -> list[str]:
    """Medians with values of a rank from below and above, the share that overturned."""
    fell = np.array([row["outcome"].startswith("overturned") for row in rows])
    cells, of = [], len(rows)
    for name, scale in scales.items():
        values: Array = np.sort(np.where(fell, np.inf, column(list(rows), name) / scale))
        median, low, high = np.median(values), values[rank - 1], values[of - rank]
        cells.append(f"{median:.3g} ({low:.3g} to {high:.3g})")
    k = int(fell.sum())
    low = beta.ppf(0.025, k, of - k + 1) if k else 0.0
    return [*cells, f"{k} ({100 * low:.0f} to {100 * beta.ppf(0.975, k + 1, of - k):.0f} %)"]


FORCES = {"base_shear_ratio": 1.0, "max_floor_acceleration": STANDARD_GRAVITY}


def test_what_the_ends_bear_on(tmp_path: Path, fema_record: RecordLoader) -> None:
    told = table(ROOT / "cases/studies/contact/README.md", "rps sweep")[1:]
    for key, rows in groups_of("cases/studies/contact/contact.yaml", tmp_path).items():
        strongest = np.nanmax(np.append(column(rows, "max_impact_number"), 0.0))
        cells = cells_of(rows, {"max_rotation": math.atan(0.15), **FORCES})
        assert [*key, *cells, f"{strongest:.2g}"] in told


def test_both_components_on_joints(tmp_path: Path, fema_record: RecordLoader) -> None:
    told = table(ROOT / "cases/studies/joints_both/README.md", "rps sweep")[1:]
    groups = groups_of("cases/studies/joints_both/joints_both.yaml", tmp_path)
    assert len(groups) == len(told)
    for key, rows in groups.items():
        end = np.median(column(rows, "residual_rotation"))
        cells = cells_of(rows, {"rotation_ratio": 1.0, **FORCES})
        assert [*key, *cells, f"{end:.1g}"] in told


BUILDING = (
    "superstructure.storeys",
    "superstructure.period",
    "podium.superstructure_mass_ratio",
    "podium.bearing.slenderness",
    "podium.bearing.curvature_ratio",
)


def test_numbers_of_the_study_of_impact_laws(tmp_path: Path) -> None:
    """Rotations and shears are of motions under which both stand and uplift."""
    folder = ROOT / "cases/studies/impact_law"
    text = " ".join((folder / "README.md").read_text("utf-8").split())
    found = load_study(folder / "impact_law.yaml").run(tmp_path / "run").columns
    names = [found[name].astype(str) for name in ("record", *BUILDING, "podium.impact.law")]
    order = np.lexsort(names).reshape(2, 576, 44)  # flexible, then rigid
    fell = np.char.startswith(found["outcome"][order], "overturned")
    stood = (~fell & (found["uplifts"][order] > 0)).all(axis=0)

    def ratios(name: str) -> Array:
        """Of rigid over flexible, (576, 44); NaN where one of them overturns or does not uplift."""
        flexible, rigid = np.where(stood, found[name][order], np.nan)
        return np.asarray(rigid / flexible)

    of_all, differ = 100 * fell.mean(axis=(1, 2)), np.abs(np.diff(fell.sum(axis=2), axis=0))
    assert "{:.2f} % with `flexible` and {:.2f} % with `rigid`".format(*of_all) in text
    assert f"in {(differ <= 1).sum()} of 576 buildings the counts differ" in text
    assert differ.max() == 5
    rotation = ratios("max_rotation")
    off = np.abs(np.nanmedian(rotation, axis=1) - 1)
    assert f"within 2 % in {100 * (off <= 0.02).mean():.0f} % of" in text
    assert f"within {100 * off.max():.1f} % in all" in text
    low, high = np.nanquantile(rotation, [0.05, 0.95])
    assert f"is below {low:.2f} or above {high:.2f} times its other value" in text
    shear = ratios("max_base_shear")
    period, eta, slope = (found[name][order[0, :, 0]].astype(float) for name in BUILDING[1:4])
    stout = eta * slope**2 > 0.12 - 1e-9
    stiff = shear[stout & (period == 0.15)]
    lowest = np.nanmedian(stiff, axis=1).min()
    words = f"{100 * (1 - np.nanmedian(stiff)):.0f} % lower in the median, up to"
    assert f"{words} {100 * (1 - lowest):.0f} % in a building" in text
    assert np.nanquantile(stiff, 0.05) < 0.5
    less = 100 * (1 - np.nanquantile(shear[stout & (period == 0.3)], [0.5, 0.05]))
    assert "{:.0f} % lower in the median, {:.0f} % in one motion of twenty".format(*less) in text
    ends = 100 * (np.nanquantile(shear[period >= 0.6], [0.05, 0.95]) - 1)
    assert "nine of ten motions are within {:.0f} and {:+.0f} %".format(*ends) in text
