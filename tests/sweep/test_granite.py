"""The shaking-table tests of granite specimens, if the folder RPS_GRANITE has them."""

import importlib.util
import math
import os
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from shown_commands import of_blocks, run_all, run_in_shell, table

from rpscli.records.formats.at2 import at2_text
from rpscli.records.ground_motion import GroundMotion
from sweep.small_studies import ROOT, csv_rows

CASES = ROOT / "cases" / "granite"


@pytest.fixture(scope="module")
def granite():
    """The folder with half of the tests: `motions_even.npz`, `outcomes_even.csv` and `raw`."""
    folder = Path(os.environ.get("RPS_GRANITE", "nowhere"))
    if not (folder / "motions_even.npz").is_file():
        pytest.skip("RPS_GRANITE does not name the folder of the granite tests")
    return folder


def script(name):
    specification = importlib.util.spec_from_file_location(name, CASES / f"{name}.py")
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def convert():
    return script("convert")


def test_a_threshold_counts_best_among_those_that_agree_as_well():
    threshold, random = script("judged").threshold, np.random.default_rng(5)
    assert round(threshold(np.array([1.0, 2, 4, 8]), np.array([0, 0, 1, 1])), 3) == 2.828
    for _ in range(50):
        im, over = random.lognormal(size=30), random.random(30) < 0.5
        cuts = {
            cut: (int(((im >= cut) == over).sum()), int((im >= cut).sum()))
            for cut in (0.0, *im, 1e9)
        }
        most = max(agreed for agreed, _ in cuts.values())
        share = most / 30
        least = most - 30 * math.sqrt(share * (1.0 - share) / 30)
        off = min(abs(n - over.sum()) for agreed, n in cuts.values() if agreed >= least)
        chosen = im >= threshold(im, over)
        assert (chosen == over).sum() >= least
        assert abs(chosen.sum() - over.sum()) == off


def motions_of(granite):
    with np.load(granite / "motions_even.npz") as file:
        return dict(file)


def observed_rows(granite):
    return csv_rows("outcomes_even.csv", granite)


@pytest.mark.evidence("free-standing blocks", "measured")
def test_the_model_tells_more_outcomes_than_thresholds(granite, sweep_json, workplace):
    """With the slendernesses of the cases and single runs, over all tests of the folder."""
    motions, judged = motions_of(granite), script("judged")
    (workplace / "motions").mkdir()
    lines = ["record,title,overturned"]
    for row in observed_rows(granite):
        key = f"{int(row['test']):03d}"
        values = motions[f"t{key}"] * float(motions[f"s{key}"])
        motion = GroundMotion(values, 0.005, key, key, "table motion")
        (workplace / "motions" / f"Test{key}.at2").write_text(
            at2_text(motion), encoding="utf-8"
        )
        lines += [
            f"Test{key},specimen {n},{row[f'specimen_{n}_overturned']}" for n in (1, 2)
        ]
    (workplace / "observed.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    for n in (1, 2):
        name = f"specimen_{n}.yaml"
        text = (CASES / name).read_text(encoding="utf-8")
        (workplace / name).write_text(text, encoding="utf-8")
        study = f"""\
rps: 1
base: {name}
vary:
  - title: [specimen {n}]
records: [motions/*.at2]
observed: observed.csv
reports: [comparison]
"""
        sweep_json("study.yaml", "-o", f"out_{n}", study=study)
        counts, pairs, points = (
            csv_rows(f"{name}.csv", f"out_{n}")
            for name in ("comparison", "comparison_pairs", "points")
        )
        (counted,) = counts
        observed = np.array([float(row["observed [SI]"]) == 1.0 for row in pairs])
        shares = []
        for name in ("pga [m/s2]", "pgv [m/s]"):
            at = np.array(
                [float(points[int(row["point [-]"]) - 1][name]) for row in pairs]
            )
            shares.append(np.mean((at >= judged.threshold(at, observed)) == observed))
        # Published first results with this model are 0.89 and 0.92; thresholds are fitted here.
        assert float(counted["agreed_share [-]"]) > max(shares)
        computed = int(counted["overturned_computed [-]"])
        # A standard deviation of the count over different halves of the tests is 10 to 19 %.
        assert computed == pytest.approx(int(counted["overturned_observed [-]"]), rel=0.2)


@pytest.mark.long
def test_the_readme_shows_what_its_commands_give(granite, convert, tmp_path, monkeypatch):
    """The public folder is not here: its converter runs on two text files of it, and writes the
    motions of the others from the half that is at hand.
    """
    pytest.importorskip("openpyxl")
    shutil.copytree(CASES, tmp_path / "cases/granite")
    monkeypatch.chdir(tmp_path)
    _, converter, sweep, published = of_blocks(CASES / "README.md")
    run_in_shell(converter.replace(".../data/Shake_Table_Response", str(granite / "raw")))
    assert len(list(Path("cases/granite/motions").iterdir())) == 2
    stored = motions_of(granite)
    numbers = [int(row["test"]) for row in observed_rows(granite)]
    tests = {
        k: GroundMotion(
            stored[f"t{k:03d}"] * float(stored[f"s{k:03d}"]), 0.005, f"{k}", "", ""
        )
        for k in numbers
    }
    convert.write(
        tests, convert.outcomes(granite / "raw" / convert.WORKBOOK), Path("cases/granite")
    )
    run_all([sweep])
    printed = run_in_shell(published)
    readme = CASES / "README.md"
    assert f"the {len(numbers)} even-numbered tests" in readme.read_text(encoding="utf-8")
    lines = re.findall(
        r"^(.*), (fitted|held out): (\d+) of (\d+) .*?(\d+) over", printed, re.MULTILINE
    )
    outcomes = {(name, part): tuple(map(int, counts)) for name, part, *counts in lines}
    held = {
        name: counts for (name, part), counts in outcomes.items() if part == "held out"
    }
    found = {
        told: [counts for name, counts in held.items() if by in name]
        for told, by in {
            "model, nine runs within 3 % of each motion": ", model with",
            "threshold of PGV": ", threshold of PGV",
            "threshold of PGA": ", threshold of PGA",
        }.items()
    }
    best = [
        max((n for n, part in outcomes if part == "fitted" and n.startswith(f"Specimen {k}")),
            key=lambda name: outcomes[name, "fitted"][0])
        for k in (1, 2)
    ]  # fmt: skip
    found["published discrete elements"] = [held[name] for name in best]
    shown = {name: rest for name, *rest in table(readme, "split by seed 1")[1:]}
    for told, parts in found.items():
        agreed, counted, _ = map(sum, zip(*parts, strict=True))
        shares = [*(a / of for a, of, _ in parts), agreed / counted]
        digits = 1 if told.startswith("model") else 0
        fallen = " + ".join(f"{fell / (of / 126):.{digits}f}" for _, of, fell in parts)
        row = [*(f"{100 * share:.1f} %" for share in shares), fallen]
        # The filter of the records rounds differently on other processors, and the fit is a tie.
        assert row in [shown[told], *([shown["the same on another processor"]] * digits)]
