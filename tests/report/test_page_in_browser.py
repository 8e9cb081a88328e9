"""Pages in a real browser: nothing wider than a telephone, nothing cut on paper."""

import html
import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from click.testing import CliRunner

from rpscli.cli import program

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
BROWSER = next((found for name in BROWSERS if (found := shutil.which(name))), None)
ROOT = Path(__file__).parents[2]

PAPER = 180  # mm between the margins of a page of A4
MM = 96.0 / 25.4
PAGE_HEIGHT = (297 - 16 - 18) * MM
TELEPHONE, SCREEN = 390, 1280

pytestmark = pytest.mark.skipif(
    BROWSER is None, reason="no Chromium or Chrome is installed"
)

STUDY = """\
rps: 1
title: A small study
base: CASE
vary:
  - podium.bearing.curvature_ratio: [0.5, 0]
records:
  - {source: "synthetic:?pga=0.5g&duration=4&dt=0.02", seed: [1, 2, 3]}
scale: [0.5, 1.0]
limits: {rotation_ratio: 0.5}
reports: [overturning, rotation]
"""

MEASURE = """
const seen = document.querySelector("iframe").contentDocument;
const size = e => { const r = e.getBoundingClientRect(); return [r.width, r.height]; };
const found = {
  page: seen.documentElement.scrollWidth,
  figures: [...seen.querySelectorAll("figure")].map(size),
  drawings: [...seen.querySelectorAll("figure svg, figure img")].map(size),
  letters: [...seen.querySelectorAll("p, td")].map(
    e => parseFloat(seen.defaultView.getComputedStyle(e).fontSize)),
  names: [...seen.querySelectorAll("[id]")].map(e => e.id),
  loaded: seen.defaultView.performance.getEntriesByType("resource").map(e => e.name),
};
document.title = JSON.stringify(found);
"""


def browse(profile, *options):
    assert BROWSER is not None
    quiet = [
        "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-sync",
        "--disable-background-networking", "--disable-component-update",
        f"--user-data-dir={profile}",
    ]  # fmt: skip
    done = subprocess.run(
        [BROWSER, *quiet, *options],
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    return done.stdout


@pytest.fixture(scope="module", params=["case", "study"])
def made(request, tmp_path_factory):
    """The page of a case, and that of a study."""
    place = tmp_path_factory.mktemp("pages")
    case = ROOT / "cases" / "measured_column.yaml"
    base = ROOT / "cases" / "rigid_frame.yaml"
    (place / "study.yaml").write_text(STUDY.replace("CASE", str(base)), encoding="utf-8")
    subject = str(case) if request.param == "case" else str(place / "study.yaml")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(place)
        result = CliRunner().invoke(program, ["report", subject, "-o", "page.html"])
    assert result.exit_code in {0, 10}, result.output
    return place / "page.html"


@pytest.fixture
def measured(made, tmp_path):
    """Sizes on a window of so many pixels; the page's own policy lets no script in, so it stands in
    a frame."""

    def measure(width):
        text = html.escape(made.read_text(encoding="utf-8"))
        frame = f'<iframe srcdoc="{text}" style="width:{width}px;height:900px;border:0"></iframe>'
        outside = tmp_path / "outside.html"
        script = f"<script>onload = () => {{{MEASURE}}}</script>"
        outside.write_text(f"<meta charset=utf-8>{frame}{script}", encoding="utf-8")
        dumped = browse(tmp_path / "profile", "--dump-dom", outside.as_uri())
        found = re.search(r"<title>(.*?)</title>", dumped, re.DOTALL)
        assert found, "the frame was measured"
        return dict(json.loads(html.unescape(found[1])))

    return measure


@pytest.mark.parametrize("width", [TELEPHONE, SCREEN])
def test_only_tables_and_figures_scroll_sideways(measured, width):
    found = measured(width)
    assert found["page"] <= width
    assert found["figures"]
    assert (
        min(found["letters"]) >= 12.0
    )  # pixels of a telephone, which are points on paper
    # Drawings keep letters of 9 points on 7 inches readable: no smaller than 6 points.
    assert min(size[0] for size in found["drawings"]) >= 7.0 * 96.0 * 6.0 / 9.0
    assert len(found["names"]) == len(set(found["names"])) > 50
    assert not [name for name in found["loaded"] if not name.startswith("data:")]


def test_paper_is_a4_and_takes_every_figure_whole(made, measured, tmp_path):
    # A figure that is lower than the page is never cut: the style sheet forbids it.
    assert "figure, pre, .notice { break-inside: avoid; }" in made.read_text(
        encoding="utf-8"
    )
    assert max(size[1] for size in measured(int(PAPER * MM))["figures"]) < PAGE_HEIGHT
    paper = tmp_path / "page.pdf"
    browse(tmp_path / "profile", f"--print-to-pdf={paper}", made.as_uri())
    sizes = re.findall(rb"/MediaBox\s*\[([^\]]*)\]", paper.read_bytes())
    assert len(sizes) >= 4
    for size in sizes:
        assert [float(edge) for edge in size.split()] == pytest.approx(
            [0, 0, 595.3, 841.9], abs=1
        )
