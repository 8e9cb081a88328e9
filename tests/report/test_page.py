"""A page holds together: text stays text, names are used once, and nothing is fetched."""

import base64
import io
import re
from collections import Counter
from functools import partial
from html.parser import HTMLParser

import pytest
from PIL import Image

from report.small_results import KINDS, history, structure
from rpscli.report.bundles import timehistory_files
from rpscli.report.case_page import (
    derived_blocks,
    hidden_table,
    motion_pictures,
    structure_blocks,
)
from rpscli.report.figures.look import USUAL
from rpscli.report.files import Drawing, undrawn
from rpscli.report.page import (
    MOST_BYTES,
    Attachment,
    Listing,
    Notice,
    Picture,
    ReportSection,
    is_about,
    page,
    page_look,
    pictures,
    printable,
)
from rpscli.report.table import Table

HOSTILE = """<script>alert("x")</script> & 'quotes' "too" </style></title> \x00 $a_b$"""


class Parsed(HTMLParser):
    """Tags with their attributes, and the text between them."""

    def __init__(self, content):
        super().__init__()
        self.tags = []
        self.texts = []
        self.feed(content.decode())

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, {name: value or "" for name, value in attrs}))

    def handle_data(self, data):
        self.texts.append(data)

    def all(self, attribute):
        return (of[attribute] for _, of in self.tags if attribute in of)


@pytest.fixture(scope="module")
def figures_of_history():
    files = timehistory_files(KINDS["rolls"](), HOSTILE, page_look(USUAL))
    return [
        Picture(found, f"{stem} {HOSTILE}") for stem, found in pictures(files).items()
    ]


def picture(svg, caption, png=b""):
    """A figure of a page whose files are known."""
    files = {"svg": lambda: svg, "png": lambda: png}
    return Picture(
        {end: Drawing(f"x.{end}", draw) for end, draw in files.items()}, caption
    )


def test_a_figure_that_fails_is_told_in_its_place():
    def fails():
        raise RuntimeError("no <figure>")

    broken = Picture({"svg": Drawing("x.svg", fails)}, "a caption")
    content = page("a", "b", [ReportSection("c", [broken, "the results"])], "d").decode()
    assert "x.svg is not drawn: RuntimeError: no &lt;figure&gt;" in content
    assert "the results" in content
    assert len(undrawn(broken.files.values())) == 1


def test_text_is_never_taken_for_tags():
    blocks = [
        HOSTILE,
        Notice(HOSTILE),
        Listing(HOSTILE),
        Table.of_texts([HOSTILE], [[HOSTILE]]),
        *structure_blocks(structure(), HOSTILE, USUAL),
    ]
    parsed = Parsed(page(HOSTILE, HOSTILE, [ReportSection(HOSTILE, blocks)], HOSTILE))
    assert "script" not in {tag for tag, _ in parsed.tags}
    shown = [text for text in parsed.texts if "alert" in text]
    # Title, heading, subtitle, contents, section, four blocks (a table has two), and the
    # headings of two drawings: no letter is lost
    # but the control character, which no page may hold.
    assert len(shown) == 12
    for text in shown:
        assert HOSTILE.replace("\x00", "\ufffd") in text


def test_names_are_used_once_and_nothing_is_fetched(figures_of_history):
    # The same drawings twice: matplotlib gives them the same names.
    content = page(
        "a", "b", [ReportSection("c", [*figures_of_history, *figures_of_history])], "d"
    )
    parsed = Parsed(content)
    names = Counter(parsed.all("id"))
    assert len(names) > 50
    assert set(names.values()) == {1}
    of_attributes = " ".join(value for _, of in parsed.tags for value in of.values())
    used = set(re.findall(r"url\(#([^)]+)\)", of_attributes))
    used |= {link[1:] for link in parsed.all("href")}
    assert len(used) > 40
    assert used <= set(names)
    assert not re.search(rb"https?:|@import|url\((?!#)", content)
    assert not {"script", "link", "iframe", "object"} & {tag for tag, _ in parsed.tags}
    assert all(link.startswith("#") for link in parsed.all("href"))
    assert all(
        source.startswith("data:image/png;base64,") for source in parsed.all("src")
    )
    shown = [of for tag, of in parsed.tags if tag in {"svg", "img"}]
    assert len(shown) == 2 * len(figures_of_history) == 10
    assert all(of.get("aria-label") or of["alt"] for of in shown)
    drawn = [of for tag, of in parsed.tags if tag == "svg"]
    assert drawn
    assert all(of["role"] == "img" and of["viewbox"] for of in drawn)
    assert not any("width" in of or "height" in of for of in drawn)


def test_a_figure_of_many_points_is_an_image_and_the_page_stays_small():
    marks = b"".join(b'<circle r="1" cx="%d" cy="2"/>' % n for n in range(30_000))
    start = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">'
    with io.BytesIO() as file:
        Image.new("RGB", (1050, 700), "white").save(file, "png")
        png = file.getvalue()
    heavy = picture(start + marks + b"</svg>", "many points", png)
    light = picture(start + b"</svg>", "few points", png)
    content = page("a", "b", [ReportSection("c", [heavy] * 20 + [light])], "d")
    tags = Counter(tag for tag, _ in Parsed(content).tags)
    assert (tags["img"], tags["svg"]) == (20, 1)  # one heavy drawing is too much
    assert len(content) < MOST_BYTES


def test_coordinates_are_rounded_and_factors_are_not():
    drawing = (
        b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">'
        b'<path d="M 1.23456 -0.00049" transform="scale(0.015625)"/></svg>'
    )
    content = page("a", "b", [ReportSection("c", [picture(drawing, "x")])], "d")
    assert b'd="M 1.23 -0.00"' in content
    assert b"scale(0.015625)" in content


def test_a_page_knows_what_it_is_about():
    made = partial(page, "a title", "b", [ReportSection("c", ["d"])])
    assert is_about(made('six "storeys" & <more>'), 'six "storeys" & <more>')
    assert not is_about(made("six"), "six_storeys")
    assert not is_about(b"notes of mine about six", "six")


def test_empty_sections_are_left_out_and_the_others_numbered():
    parsed = Parsed(
        page("a", "b", [ReportSection("none", []), ReportSection("some", ["text"])], "c")
    )
    assert "none" not in parsed.texts
    assert "1  some" in parsed.texts


def test_what_the_model_leaves_out_is_read_from_the_theory():
    table, both = hidden_table(both=False), hidden_table(both=True)
    assert isinstance(table, Table)
    assert any(row[0] == "plane motion" for row in table.rows)
    assert not any(row[0] == "plane motion" for row in both.rows)
    assert any("bodies of revolution" in row[0] for row in both.rows)
    assert list(table.heads) == ["assumed", "what it hides", "size"]
    assert len(table.rows) >= 8
    assert all(len(row) == 3 and all(row) for row in table.rows)
    assert any("friction_demand" in row[1] for row in table.rows)


def test_every_derived_number_has_a_row():
    made = structure()
    podium = {"bearing": {"semi_diagonal": 1.5}, "cap_beam_mass": 2e5, "column_mass": 2e4}
    table = derived_blocks(made, podium)[-1]
    assert isinstance(table, Table)
    values = {row[0]: row[4] for row in table.rows}
    assert values["critical rotation"] == f"{made.critical_rotation:.6g}"
    assert values["first period on a fixed base"] == "0.2"


@pytest.mark.long
def test_a_long_record_leaves_the_page_small_enough_to_be_sent():
    record = "synthetic:?pga=0.5g&duration=300&dt=0.005&seed=3"
    result = history(structure(storeys=6), record)
    files = timehistory_files(result, "a long record", page_look(USUAL))
    blocks = [Picture(found, stem) for stem, found in pictures(files).items()]
    blocks.append(motion_pictures(result.record, USUAL))
    assert (
        len(page("a", "b", [ReportSection("c", blocks)], "d")) < 0.9 * MOST_BYTES
    )  # tables: a tenth


def test_spaces_of_drawings_are_no_control_characters():
    assert printable("0.1\u2009m\u00a0x\x07") == "0.1\u2009m\u00a0x\ufffd"


def test_a_file_in_a_page_is_saved_as_it_is_and_is_only_text():
    text = f"title: ü {HOSTILE}\n"
    made = Parsed(page("t", "s", [ReportSection("x", [Attachment(HOSTILE, text)])], "n"))
    ((kind, content),) = (
        of["href"].split(",", 1) for _, of in made.tags if "download" in of
    )
    assert kind == "data:text/plain;charset=utf-8;base64"
    assert base64.b64decode(content).decode() == text
    assert next(made.all("download")) == HOSTILE
    assert "script" not in [tag for tag, _ in made.tags]
    assert printable(text) in made.texts
