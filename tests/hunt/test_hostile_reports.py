"""Reports with options that make no sense, and pages of stored results that were damaged."""

from __future__ import annotations

import shutil
from pathlib import Path
from random import Random

import pytest

from hunt.mutation import mutated
from hunt.test_hostile_files import CASES, VALUES
from hunt.trials import PROMISED, hunt, judged, shares
from rpscli.case.schema.keys import key_references
from rpscli.report.study.registry import REPORTS

pytestmark = pytest.mark.posix  # trials are timed by its signals

STUDY = f"""rps: 1
base: {CASES}/six_storey.yaml
vary: [{{podium.bearing.slenderness: [0.12, 0.15]}}, {{podium.bearing.semi_diagonal: [0.5, 1.5]}}]
records: ["pulse:sine?amplitude=0.3g&period=0.8", "pulse:sine?amplitude=0.2g&period=1"]
scale: {{measure: PGA, values: [0.2 g, 0.6 g]}}
"""
OPTIONS = {
    kind: [key.key for key in key_references(report.options)]
    for kind, report in REPORTS.items()
    if kind != "floor_spectra"  # which takes seconds for each history
}
LIKELY = (
    "scale", "record", "podium.bearing.slenderness", "podium.bearing.semi_diagonal", "PGA", "PGV",
    "max_rotation", "rotation_ratio", "drift_ratio", "[max_rotation, drift_ratio]", "0.5", "median",
    "overturned", "{rotation_ratio: 0.5}", "[0.1, 0.2]",
)  # fmt: skip
EMPTY = b'<svg xmlns="http://www.w3.org/2000/svg" width="1pt" height="1pt"/>'


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study and a history that were computed."""
    folder = tmp_path_factory.mktemp("stored")
    (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
    none = ("--figures", "none", "-q")
    assert (
        judged("sweep", str(folder / "study.yaml"), "-o", str(folder / "sweep"), *none) == "exit 10"
    )
    source = "pulse:sine?amplitude=0.2g&period=0.8"
    command = ("timehistory", f"{CASES}/six_storey.yaml", "--record", source)
    assert judged(*command, "-o", str(folder / "history"), *none) == "done"
    return folder


@shares
def test_options_of_reports(stored: Path, long: bool) -> None:
    def trial(random: Random) -> str:
        kind = random.choice(list(OPTIONS))
        options = ", ".join(
            f"{key}: {random.choice([*LIKELY, *LIKELY, random.choice(VALUES)])}"
            for key in random.sample(OPTIONS[kind], min(random.randrange(4), len(OPTIONS[kind])))
            if "." not in key
        )
        place = ("-o", str(stored / "sweep"), "--figures", "none", "--report-only", "--json")
        change = f"reports=[{{{kind}: {{{options}}}}}]"
        return judged("sweep", str(stored / "study.yaml"), "--set", change, *place)

    hunt("options of reports", trial, 12, 1000 if long else None)


@shares
def test_pages_of_damaged_results(
    stored: Path, long: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rpscli.report.figures.style.picture", lambda *_: EMPTY)

    def trial(random: Random) -> str:
        folder = tmp_path / "copy"
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(stored / random.choice(["sweep", "history"]), folder)
        file = folder / random.choice(["run.json", "run.json", "summary.json"])
        before = file.read_text(encoding="utf-8") if file.is_file() else "{}"
        file.write_text(mutated(before, random), encoding="utf-8", errors="replace")
        return judged("report", str(folder), "-o", "page.html", "--force", codes=PROMISED | {2})

    hunt("pages of damaged results", trial, 3, 400 if long else None)
