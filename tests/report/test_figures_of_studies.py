"""Figures of studies, against the CSV files of the same studies; others from numbers by hand."""

from types import SimpleNamespace

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import StepPatch
from paper_structures import needs_compiled_kernels
from reproduction.conftest import rows_of
from sweep.small_studies import BASE, STUDY

from report.small_results import curve, drawn, legend
from rpscli.analyses.floor_spectra import PERIODS
from rpscli.case.conditions import Condition
from rpscli.cli import program
from rpscli.records.ground_motion import GroundMotion
from rpscli.records.target import TargetSpectrum
from rpscli.report.study.heights import Floors, floor_spectra_figure
from rpscli.tools.design.keys import Term
from rpscli.tools.design.report import region_figure, requirements_figure
from rpscli.tools.design.search import Answer, Requirement
from rpscli.tools.selection.candidates import Candidate
from rpscli.tools.selection.figure import selection_figure
from rpscli.tools.selection.requirements import RULES
from rpscli.tools.selection.selection import Selection

RHO, ALPHA = "podium.bearing.curvature_ratio", "podium.bearing.slenderness"
NAMES = {"critical": "critical ρ", "0.5": "ρ = 0.5", "0": "flat ends"}
SCALES = (0.5, 1.0, 2.0, 4.0)

HISTORIES = (
    STUDY.replace("scale: [0.5, 1.0]", f"scale: {list(SCALES)}")
    + f"""\
reports:
  - overturning: {{title: overturning}}
  - rotation: {{title: rotation, panels: [{ALPHA}]}}
  - demand: {{title: demand, panels: [{ALPHA}], series: [{RHO}]}}
  - storey_shear: {{title: storey_shear, panels: [{ALPHA}, {RHO}]}}
  - ida: {{title: ida}}
  - fragility: {{title: fragility, measure: PGA, series: [{RHO}], limits: {{rotation_ratio: 0.25}}}}
"""
)
PULSES = f"""\
rps: 1
base: base.yaml
vary:
  - {RHO}: [0.5, 0]
records:
  - {{source: "pulse:sine?amplitude=1g", period: [0.6, 1.0, 2.0]}}
scale: [0.1, 0.3, 0.6, 1.0, 2.0]
reports:
  - overturning_spectrum: {{title: overturning_spectrum}}
"""
MODES = f"""\
rps: 1
base: base.yaml
analysis: modal
vary:
  - {RHO}: [critical, 0.5]
  - superstructure.storeys: [1, 2, 3]
    superstructure.period: [0.1, 0.2, 0.3]
    podium.superstructure_mass_ratio: [1, 2, 3]
reports:
  - lines:
      title: lines
      x: superstructure.storeys
      y: rolling.frequency_ratio.0
      dashed: rocking.frequency_ratio.0
      panels: [{RHO}]
"""
CURVES = f"""\
rps: 1
base: base.yaml
analysis: pushover
vary:
  - {RHO}: [critical, 0.5, 0]
reports:
  - lines: {{title: lines, x: curve.displacement, y: curve.force_over_weight}}
"""


def opened(text, folder, *, tables=True):
    """Run a study; figures are kept as objects, by their titles."""
    (folder / "base.yaml").write_text(BASE, encoding="utf-8")
    (folder / "study.yaml").write_text(text, encoding="utf-8")
    kept = {}

    def keep(figure, *_, **__):
        kept[figure.get_suptitle().splitlines()[0].split("   |   ")[0]] = figure

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "savefig", keep)
        command = [
            "sweep",
            str(folder / "study.yaml"),
            "-o",
            str(folder / "made"),
            "--quiet",
        ]
        made = CliRunner().invoke(program, command)
    assert made.exit_code == 0, made.stderr

    def open_(name):
        if not tables:
            return kept[name]
        return kept.get(name, Figure()), rows_of(folder / "made" / f"{name}.csv")

    return open_


@pytest.fixture(scope="module")
def histories(tmp_path_factory):
    return opened(HISTORIES, tmp_path_factory.mktemp("histories"))


def numbers(of, name):
    """A column; empty cells are no numbers."""
    return np.array([float(row[name]) if row[name] else np.nan for row in of])


def chosen(of, rho, alpha=None):
    """Rows of one curvature ratio, and of one slenderness."""
    return [
        row for row in of if row[RHO] == rho and (alpha is None or row[ALPHA] == alpha)
    ]


def panels(figure):
    """By their titles in one line."""
    return {
        axes.get_title().replace("\n", " "): axes for axes in figure.axes if axes.axison
    }


def same(found, wanted):
    """Require equal numbers, to the ten digits of a CSV file."""
    mine, other = (np.asarray(of, float) for of in (found, wanted))
    np.testing.assert_allclose(mine, other, rtol=1e-9, atol=1e-12)


def labelled(figure, x_label, y_label):
    """Require one label for all ordinates, and the other below the last panels alone."""
    shown = [axes.get_xlabel().replace("\n", " ") for axes in panels(figure).values()]
    assert {*shown} - {""} == {x_label}
    assert shown[-1] == x_label
    assert (
        figure.get_supylabel() or figure.axes[0].get_ylabel().replace("\n", " ")
    ) == y_label


def markers(axes, *, hollow):
    for line in axes.lines:
        filled = line.get_markerfacecolor() != "none"
        # Some lines have their markers in the legend only.
        if (
            line.get_marker() not in {"None", ""}
            and line.get_markevery() != []
            and filled != hollow
        ):
            yield line


@needs_compiled_kernels
def test_the_table_of_overturning(histories):
    figure, table = histories("overturning")
    (axes,) = figure.axes
    heads = [name for name in table[0] if "=" in name and ";" not in name]
    shares = np.array([[float(row[name]) for name in heads] for row in table])
    assert len(np.unique(shares)) > 2
    (cells,) = axes.collections
    same(cells.get_array(), shares)
    written, wanted = [text.get_text().replace("\n", " ") for text in axes.texts], []
    for (y, x), part in np.ndenumerate(shares):
        of = [
            table[y][f"{heads[x]};{name}"]
            for name in ("number", "counted", "low", "high")
        ]
        low, high = float(of[2]), float(of[3])
        ends = f"{low:.2g} to {high:.2g}"
        if part in {0.0, 1.0}:
            ends = f"above {low:.2g}" if part else f"below {high:.2g}"
        wanted += [f"{part:.2f}", f"{of[0]} of {of[1]}, {ends}"]
    assert written == wanted
    across = [text.get_text() for text in axes.get_xticklabels()]
    assert across == [NAMES[name.partition("=")[2]] for name in heads]
    scales = [f"scale = {row['scale']}" for row in table]
    named = [
        f"tan α = {row[ALPHA]}, " * (place % 4 == 0) + scale
        for place, (row, scale) in enumerate(zip(table, scales, strict=True))
    ]
    names = [text.get_text().replace("\n", " ") for text in axes.get_yticklabels()]
    assert names == named  # what they have in common stands once


@needs_compiled_kernels
def test_rotations_against_the_reference(histories):
    figure, table = histories("rotation")
    ratio = r"$|\theta_{max}|/\alpha$ [-]"
    labelled(figure, f"{ratio}, flat ends", f"{ratio}, the others")
    mine, reference = "rotation_over_alpha", "reference_rotation_over_alpha"
    x_top, y_top = (1.08 * np.nanmax(numbers(table, name)) for name in (reference, mine))
    for slenderness in ("0.1", "0.15"):
        axes = panels(figure)[f"tan α = {slenderness}"]
        same(axes.get_xlim(), (0.0, x_top))
        same(axes.get_ylim(), (0.0, y_top))
        for rho, hollow in zip(
            ("critical", "0.5"), markers(axes, hollow=True), strict=True
        ):
            pairs = chosen(table, rho, slenderness)
            x, y = numbers(pairs, reference), numbers(pairs, mine)
            stood = np.isfinite(x) & np.isfinite(y)
            same(curve(axes, NAMES[rho]), (x[stood], y[stood]))
            on_frame = np.where(np.isnan(x), x_top, x), np.where(np.isnan(y), y_top, y)
            same(hollow.get_data(), [values[~stood] for values in on_frame])
    assert np.isnan(numbers(table, reference)).any()
    assert legend(figure) == [NAMES["critical"], NAMES["0.5"]]
    assert "open markers: overturned" in figure.get_suptitle()


@needs_compiled_kernels
def test_base_shear_against_rotation(histories):
    figure, fits = histories("demand")
    _, points = histories("points")
    labelled(figure, r"$|\theta_{max}|/\theta_{cr}$ [-]", "$V_b/V_{st}$ [-]")
    stood = [row for row in points if row["outcome"] == "survived"]
    for fit in fits:
        axes = panels(figure)[f"tan α = {fit[ALPHA]}"]
        for rho, name in NAMES.items():
            series = chosen(stood, rho, fit[ALPHA])
            wanted = [
                numbers(series, name) for name in ("rotation_ratio", "base_shear_ratio")
            ]
            same(curve(axes, name), wanted)
        x, y = (
            float(fit[f"saturation_{name}_ratio"]) for name in ("rotation", "base_shear")
        )
        # Nothing is drawn beyond the points that the curve goes through.
        panel = [
            row for row in stood if row[ALPHA] == fit[ALPHA] and row["uplifts"] != "0"
        ]
        turned = numbers(panel, "rotation_ratio")
        first, end = turned.min(), turned.max()
        start, slope = (
            float(fit[name]) for name in ("base_shear_ratio_at_uplift", "slope_before")
        )
        heights = (start + slope * first, y, y + float(fit["k_s"]) * (end - x))
        same(curve(axes, "bilinear fit"), ((first, x, end), heights))
        (text,) = axes.texts
        beyond = (turned > x * (1.0 + 1e-6)).sum()  # the break may be a point
        assert text.get_text().endswith(f"beyond,\nfrom {beyond} of {len(turned)}")
        assert text.get_text().startswith(f"saturation at {x:.3f}, {y:.2f}\n")
    assert legend(figure) == [*NAMES.values(), "bilinear fit"]


@needs_compiled_kernels
def test_storey_shears_over_the_height(histories):
    figure, table = histories("storey_shear")
    labelled(figure, "$V_i/V_{st}$ [-]", "level (0 = cap beam)")
    looks = {
        "mean of survivors": "mean_shear_ratio",
        "largest of survivors": "largest_shear_ratio",
        "mean, fixed base": "fixed_mean_shear_ratio",
        "largest, fixed base": "fixed_largest_shear_ratio",
    }
    assert legend(figure) == list(looks)
    assert len(panels(figure)) == 6
    for title, axes in panels(figure).items():
        slenderness, name = title.removeprefix("tan α = ").replace("\n", " ").split(", ")
        rho = next(value for value, known in NAMES.items() if known == name)
        profile = chosen(table, rho, slenderness)
        assert [row["storey"] for row in profile] == ["1", "2", "3"]
        for label, column in looks.items():
            (patch,) = [p for p in axes.patches if p.get_label() == label]
            assert isinstance(patch, StepPatch)
            values, edges, _ = patch.get_data()
            same(values, numbers(profile, column))
            same(edges, range(4))


@needs_compiled_kernels
def test_incremental_dynamic_analysis(histories):
    figure, table = histories("ida")
    _, points = histories("points")
    labelled(figure, r"$|\theta_{max}|/\theta_{cr}$ [-]", "scale [-]")
    stood = [row for row in points if not row["outcome"].startswith("overturned")]
    edge = 1.15 * numbers(stood, "rotation_ratio").max()
    cut = False
    for title, axes in panels(figure).items():
        slenderness, name = title.removeprefix("tan α = ").split(", ")
        rho = next(value for value, known in NAMES.items() if known == name)
        levels = chosen(table, rho, slenderness)
        system = chosen(points, rho, slenderness)
        records = list(dict.fromkeys(row["record"] for row in system))
        single = [
            [row for row in system if row["record"] == record] for record in records
        ]
        wanted = [
            [row["rotation_ratio"] if row in stood else "" for row in one]
            for one in single
        ]
        wanted += [
            [row[f"rotation_ratio_{share}"] for row in levels] for share in (16, 50, 84)
        ]
        for line, cells in zip(axes.lines, wanted, strict=True):
            up = cells.index("") if "" in cells else len(cells)
            x, y = [0.0, *map(float, cells[:up])], [0.0, *SCALES[:up]]
            if up < len(cells):
                x, y, cut = [*x, edge], [*y, y[-1]], True
            same(line.get_data(), (x, y))
        labels = [str(line.get_label()) for line in axes.lines[-4:]]
        names = ["single curves", "16 % fractile", "median", "84 % fractile"]
        assert labels == legend(figure) == names
    assert cut, "no curve that runs out of the frame was looked at"


@needs_compiled_kernels
def test_fragilities(histories):
    figure, fits = histories("fragility")
    _, table = histories("fragility_curves")
    _, points = histories("points")
    labelled(figure, "PGA [m/s²]", "probability of exceedance")
    assert list(panels(figure)) == ["rotation ratio > 0.25", "overturning"]
    fitted = {(row[RHO], row["limit"]) for row in fits if row["method"] != "none"}
    assert legend(figure) == [name for rho, name in NAMES.items() if rho in dict(fitted)]
    assert {row["method"] for row in fits} >= {"maximum likelihood", "none"}
    assert {(row[RHO], row["limit"]) for row in table} == fitted
    for words, axes in panels(figure).items():
        title = words.replace("rotation ratio", "rotation_ratio")
        bands = [c for c in axes.collections if isinstance(c, PolyCollection)]
        drawn = [(rho, name) for rho, name in NAMES.items() if (rho, title) in fitted]
        assert len(bands) == len(drawn) == len(list(markers(axes, hollow=False)))
        for place, (rho, name) in enumerate(drawn):
            fragility = [row for row in chosen(table, rho) if row["limit"] == title]
            same(
                curve(axes, name), [numbers(fragility, c) for c in ("PGA", "probability")]
            )
            (line,) = [line for line in axes.lines if line.get_label() == name]
            (fit,) = [row for row in chosen(fits, rho) if row["limit"] == title]
            assert line.get_linestyle() == ("--" if fit["method"] == "penalised" else "-")
            paths = [np.asarray(path.vertices) for path in bands[place].get_paths()]
            known = fragility[0]["low"] != ""
            assert known == (fit["beta_low"] != "") == bool(paths)
            for column in ("low", "high") if known else ():
                edge = np.column_stack([numbers(fragility, c) for c in ("PGA", column)])
                apart = np.abs(np.vstack(paths)[:, None] - edge).sum(axis=2).min(axis=0)
                assert apart.max() < 1e-8
            system = chosen(points, rho)
            beyond = np.array([row["outcome"].startswith("overturned") for row in system])
            if title != "overturning":
                beyond |= numbers(system, "rotation_ratio") > 0.25
            pga = numbers(system, "pga")
            levels = np.unique(pga)
            observed = list(markers(axes, hollow=False))[place]
            same(
                observed.get_data(),
                (levels, [beyond[pga == each].mean() for each in levels]),
            )
            data = chosen(histories("fragility_observed")[1], rho)
            data = [row for row in data if row["limit"] == title]
            same(
                numbers(data, "exceeded"), [beyond[pga == each].sum() for each in levels]
            )
            same(numbers(data, "exceeded_share"), observed.get_ydata())
            assert all(
                float(row["exceeded_low"]) <= float(row["exceeded_high"]) for row in data
            )
    assert "overturning exceeds every limit" in figure.get_suptitle().replace("\n", " ")


@needs_compiled_kernels
def test_the_spectrum_of_pulses(tmp_path):
    figure, table = opened(PULSES, tmp_path)("overturning_spectrum")
    labelled(figure, r"$\omega/p$ [-]", r"$a_p/(g\,\tan\alpha)$ [-]")
    words = {"at rest": "at_rest", "survived": "survived", "overturned": "overturned"}
    assert legend(figure) == [*words, "least that overturns"]
    frequency, amplitude = "frequency_over_p", "amplitude_over_g_tan_alpha"
    for rho in ("0.5", "0"):
        axes = panels(figure)[NAMES[rho]]
        panel = chosen(table, rho)
        for label, word in words.items():
            some = [row for row in panel if row["outcome"].startswith(word)]
            assert some
            same(
                curve(axes, label),
                [numbers(some, column) for column in (frequency, amplitude)],
            )
        ratios = np.unique(numbers(panel, frequency))
        fell = [row for row in panel if row["outcome"].startswith("overturned")]
        least = [
            min(
                (float(row[amplitude]) for row in fell if float(row[frequency]) == r),
                default=np.nan,
            )
            for r in ratios
        ]
        same(curve(axes, "least that overturns"), (ratios, least))


def test_modes_against_a_varied_key(tmp_path):
    figure, table = opened(MODES, tmp_path)("lines")
    labelled(figure, "n [-]", r"$\omega_u/\omega_0$ [-]")
    assert legend(figure) == ["rolling", "rocking"]
    for rho in ("critical", "0.5"):
        axes = panels(figure)[NAMES[rho]]
        for name, dashes in (("rolling", "-"), ("rocking", "--")):
            line = [
                r
                for r in chosen(table, rho)
                if r["result"] == f"{name}.frequency_ratio.0"
            ]
            assert len(line) == 3
            wanted = [numbers(line, c) for c in ("superstructure.storeys", "value")]
            same(curve(axes, name), wanted)
            (drawn,) = [line for line in axes.lines if line.get_label() == name]
            assert drawn.get_linestyle() == dashes


def test_curves_of_lists(tmp_path):
    study = opened(CURVES, tmp_path)
    figure, table = study("lines")
    labelled(figure, "$u_b$ [m]", "$F/W$ [-]")
    (axes,) = figure.axes
    assert legend(figure) == list(NAMES.values())
    for rho, label in NAMES.items():
        points = chosen(table, rho)
        assert len(points) > 100
        drawn = [numbers(points, name) for name in ("curve.displacement", "value")]
        same(curve(axes, label), drawn)


INF, NAN = np.inf, np.nan
NO_SAMPLES = (np.empty(0), np.empty(0))
SIZE = "podium.bearing.semi_diagonal"


def has_edges(axes, place, x, *edges):
    """Require that a filled band runs through the points of its edges."""
    bands = [found for found in axes.collections if isinstance(found, PolyCollection)]
    (path,) = bands[place].get_paths()
    corners = np.asarray(path.vertices)
    for edge in edges:
        points = np.column_stack([np.asarray(x, float), np.asarray(edge, float)])
        assert np.abs(corners[:, None] - points).sum(axis=2).min(axis=0).max() < 1e-9


def a_selection():
    """Two motions for a target, the second at the bound of its factor."""
    periods, wanted = np.array([0.1, 0.5, 2.0]), np.array([3.0, 6.0, 1.5]) / 1.01
    target = TargetSpectrum("EN 1998", "", lambda _: wanted, 0.5, 0.2, span=(0.1, 2.0))
    first, second = (GroundMotion(np.ones(2), 0.1, name) for name in ("first", "second"))
    chosen = (
        Candidate((first,), "one", 1.0, 0.2, 0.03, np.array([1.0, 2.0, 0.5]), 2.0),
        Candidate(
            (second,), "two", 1.0, 1.2, 0.5, np.array([8.0, 16.0, 4.0]), 0.5, clamped=True
        ),
    )
    return Selection(
        target, "component", periods, chosen, 9, 1, requirements=RULES["en1998"]
    )


def test_a_selection_beside_its_target():
    selection = a_selection()
    periods, wanted, mean = selection.periods, selection.wanted, selection.mean
    scaled = [(2.0, 4.0, 1.0), (4.0, 8.0, 2.0)]
    figure = drawn(selection_figure, selection, "title")
    assert "2 of 9, single components; misfit of the mean 0.010" in figure.get_suptitle()
    assert "factors at a bound: 1" in figure.get_suptitle()
    assert {*legend(figure)} == {"first", "second", "mean", "EN 1998", "90 % of it"}
    left, right = figure.axes
    for line, values in zip(left.lines[:2], scaled, strict=True):
        same(line.get_data(), (periods, values))
    same(curve(left, "mean"), (periods, mean))
    same(curve(left, "EN 1998"), (periods, wanted))
    same(curve(left, "90 % of it"), (periods, 0.9 * wanted))
    looks = {(line.get_color(), line.get_linestyle()) for line in left.lines}
    assert len(looks) == len(left.lines) == 5  # all told apart
    assert left.get_xlabel() == "period [s]"
    assert left.get_ylabel() == "pseudo-acceleration, 5 % damping [m/s²]"
    same(curve(right, "motions"), ((0.4, 0.6), (0.06, 0.25)))
    same(curve(right, "mean"), ([0.5], [0.155]))
    same(curve(right, "target"), ((0.5, 0.5), (0.0, 1.0)))
    same(right.lines[-1].get_data(), ((0.0, 1.0), (0.2, 0.2)))
    assert (right.get_xlabel(), right.get_ylabel()) == ("PGV [m/s]", "PGD [m]")
    assert legend(right) == ["motions", "mean", "target"]


def answer_of(
    keys, values, passes, aim, *, requirements=(), demands=(), valid=True, linked=0
):
    """An answer of a search: designs by keys, whose last `linked` follow from the others.

    `passes` has a row for the records and one for each resample, `demands` such of requirements.
    """
    at, met = np.array(values), np.array(passes, dtype=bool)
    low, high = at.min(axis=0), at.max(axis=0)
    task = SimpleNamespace(
        keys=keys,
        unknowns=keys[: len(keys) - linked],
        file=SimpleNamespace(minimise={ALPHA: Term()}),
    )
    return Answer(
        task,
        tuple(requirements),
        places=(at - low) / (high - low),
        values=at,
        valid=np.broadcast_to(np.array(valid, dtype=bool), len(at)),
        results=np.array(demands, dtype=float),
        met=met[None],
        excess=np.zeros((1, len(at))),
        objectives=np.repeat(np.array(aim, dtype=float)[None], len(met), axis=0),
    )


def of_one_unknown():
    """Three designs; the one at 0.2 fails in one of two resamples."""
    uplift = Requirement(Condition("uplift", 0.0, "limits", share=0.5), 0)
    shear = Requirement(Condition("max_base_shear", 2e6, "limits"), 0, "PGA", 3.0)
    demands = [
        [[0.25, 1.0, 0.5], [0.0, 1.0, 0.5], [0.25, 1.0, 0.75]],
        [[1.5e6, INF, 1.8e6], [1.2e6, INF, 1.7e6], [1.6e6, 1e6, 1.9e6]],
    ]
    return answer_of(
        [ALPHA], [[0.3], [0.1], [0.2]], [[1, 0, 1], [1, 0, 0], [1, 0, 1]], [0.3, 0.1, 0.2],
        requirements=[uplift, shear], demands=demands,
    )  # fmt: skip


def test_requirements_along_one_unknown():
    figure = drawn(requirements_figure, of_one_unknown(), "title")
    assert "2 of 3 designs pass" in figure.get_suptitle()
    order = (0.1, 0.2, 0.3)
    above, below = figure.axes
    same(curve(above, "designs"), (order, (1.0, 0.5, 0.25)))
    same(curve(below, "designs"), (order, (NAN, 1.8e6, 1.5e6)))
    same(curve(above, "best design"), ([0.3], [0.25]))
    same(curve(below, "best design"), ([0.3], [1.5e6]))
    for axes, bound in ((above, 0.5), (below, 2e6)):
        same(curve(axes, "admissible"), ((0.0, 1.0), (bound, bound)))
    has_edges(above, 0, order, (1.0, 0.5, 0.0), (1.0, 0.75, 0.25))
    has_edges(below, 0, order, (1e6, 1.7e6, 1.2e6), (1e9, 1.9e6, 1.6e6))
    for axes in (above, below):
        (span,) = axes.patches
        shaded = axes.transData.inverted().transform_bbox(span.get_window_extent())
        same(shaded.intervalx, (0.2, 0.3))
    assert (above.get_title(), below.get_title()) == (
        "uplift",
        "base shear at PGA = 3 m/s²",
    )
    assert (above.get_ylabel(), below.get_ylabel()) == ("share of records", "$V_b$ [kN]")
    assert (above.get_xlabel(), below.get_xlabel()) == ("", "tan α")
    same(curve(below, "off the scale, or overturned"), ([0.1], [1.05 * 4e6]))
    assert set(legend(figure)) == {
        "95 % of resamples", "designs", "admissible", "best design", "best of 95 % of resamples",
        "off the scale, or overturned",
    }  # fmt: skip


def of_two_unknowns():
    """Five designs, of which one is no valid case, and a third key that is linked."""
    corners = [
        (x, y, 2.0 * x)
        for x, y in ((0.1, 0.8), (0.1, 2), (0.3, 0.8), (0.3, 2), (0.2, 1.2))
    ]
    passes = [[0, 0, 1, 1, 0], [0, 0, 1, 1, 0], [0, 0, 1, 0, 0]]
    return answer_of(
        [ALPHA, SIZE, "podium.bearing.wedge_slenderness"], corners, passes, [1, 1, 3, 2, 1],
        valid=[True, False, True, True, True], linked=1,
    )  # fmt: skip


def test_the_region_that_passes():
    figure = drawn(region_figure, of_two_unknowns(), "title")
    assert "2 of 5 designs pass" in figure.get_suptitle()
    axes, scale = figure.axes
    same(curve(axes, "best design"), ([0.3], [0.8]))
    # Shares stand where designs were computed, and nowhere else.
    found = {each.get_label(): each for each in axes.collections}
    assert {name: each.get_offsets().tolist() for name, each in found.items()} == {
        "no valid case": [[0.1, 2.0]],
        "fails": [[0.1, 0.8], [0.2, 1.2]],
        "passes": [[0.3, 0.8], [0.3, 2.0]],
    }
    assert found["no valid case"].get_array() is None
    shares = [found[name].get_array().tolist() for name in ("fails", "passes")]
    assert shares == [[0.0, 0.0], [1.0, 0.5]]
    same(found["passes"].norm.boundaries, (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0))
    assert scale.get_ylabel() == "share of resamples of the records that pass"
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("tan α", "R [m]")
    assert legend(figure) == ["no valid case", "fails", "passes", "best design"]


def test_spectra_of_the_lowest_floor_and_the_roof():
    values = np.arange(1.0, 1.0 + 3 * 3 * len(PERIODS)).reshape(3, 3, -1)
    fallen = np.where(np.arange(3)[:, None, None] == 2, np.inf, values)
    states = np.array([fallen, values])
    both = np.stack([states, states], axis=1)  # pseudo-accelerations and displacements
    floors = [Floors((scale,), np.moveaxis(both, 2, 0)) for scale in (1.0, 2.0)]
    figure = drawn(floor_spectra_figure(("scale",), floors, "")("title"))
    shown = [axes for axes in figure.axes if axes.axison]
    assert [axes.get_title() for axes in shown] == [
        f"scale = {scale}, floor {floor}" for scale in (1, 2) for floor in (1, 3)
    ]
    for axes, floor in zip(shown, (0, 2, 0, 2), strict=True):
        lines = {line.get_label(): line.get_ydata() for line in axes.lines}
        np.testing.assert_array_equal(lines["on bearings, median"], values[1, floor])
        np.testing.assert_array_equal(
            lines["fixed base, 84 % fractile"], values[2, floor]
        )
        assert np.isnan(np.asarray(lines["on bearings, 84 % fractile"])).all()
