"""Tables with titles: separators, decimal commas, encodings, brackets, remarks."""

import codecs
from random import Random

import pytest

from rpscli.errors import CaseError, RecordError
from rpscli.records.target import load_target
from rpscli.sweep.statistics.hazard import read_hazard
from rpscli.titled_table import text_of, titled_table

PLAIN = "PGA [g],rate [1/year]\n0.05,2e-2\n0.1,6e-3\n1,2e-5\n"


@pytest.mark.parametrize(
    "text",
    [
        PLAIN,
        PLAIN.replace(",", ";"),
        PLAIN.replace(",", "\t"),
        "sep=;\n" + PLAIN.replace(",", ";").replace(".", ","),
        PLAIN.replace(",", ";").replace(".", ","),
        PLAIN.replace("[", "(").replace("]", ")"),
        PLAIN.replace("]\n", "],\n").replace("2e-2\n", "2e-2,\n"),  # as Excel ends lines
        "# of a site\n\n" + PLAIN.replace(",", " , "),
        '"PGA [g]","rate [1/year]"\n"0.05","2e-2"\n"0.1","6e-3"\n"1","2e-5"\n',
        PLAIN.replace("\n", "\r\n"),
        PLAIN.replace("rate [1/year]", "AFE [1/yr]"),
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_a_hazard_curve_in_any_of_these_spellings(text, encoding, tmp_path):
    file = tmp_path / "hazard.csv"
    file.write_bytes(text.encode(encoding))
    hazard = read_hazard(file, "PGA")
    assert hazard.intensity.tolist() == pytest.approx([0.4903325, 0.980665, 9.80665])
    assert hazard.rate.tolist() == [2e-2, 6e-3, 2e-5]


def test_curves_of_probabilities_are_told_how_to_become_rates(tmp_path):
    file = tmp_path / "openquake.csv"
    file.write_text('#,,"investigation_time=50.0"\nlon,lat,poe-0.05,poe-0.1\n1,2,.6,.3\n')
    with pytest.raises(CaseError, match=r"rates by -ln\(1 - poe\)/t"):
        read_hazard(file, "PGA")


@pytest.mark.parametrize(
    "name", ["sigma_ln [-]", "sigma", "sigma_lnSa", "beta_ln", "Beta"]
)
@pytest.mark.parametrize("before", ["", "note,"])
def test_a_scatter_by_any_name_and_place_is_taken(name, before, tmp_path):
    file = tmp_path / "target.csv"
    cell = "7," if before else ""
    rows = "".join(f"{t},0.5,{cell}{s}\n" for t, s in ((0.1, 0.3), (1, 0.4), (3, 0.5)))
    file.write_text(f"T [sec],Sa (g),{before}{name}\n{rows}")
    target = load_target(f"{file}")
    assert target.deviation is not None
    assert target.deviation(1.0) == pytest.approx(0.4)
    assert ("columns not used: note" in target.parameters) == bool(before)


def test_lines_are_those_of_the_file():
    table = titled_table("sep=;\n# remark\na [s];b\n1;2\n\n3;4\n", "x", RecordError)
    assert table.titles == (("a", "s"), ("b", ""))
    assert [row.line for row in table.rows] == [4, 6]
    assert table.line == 3
    with pytest.raises(RecordError, match=r"x:2: is not CSV"):
        titled_table('a,b\n"1,2\n', "x", RecordError)


def test_random_tables_are_read_as_they_were_written():
    """Any names and numbers, in any separator, encoding and kind of bracket."""
    dice = Random("tables")  # noqa: S311
    for _ in range(200):
        names = [f"c{k}" for k in range(dice.randint(1, 6))]
        units = [dice.choice(["s", "m/s2", "g", ""]) for _ in names]
        rows = [[f"{dice.uniform(-9, 9):.3g}" for _ in names] for _ in range(4)]
        left, right = dice.choice(["[]", "()"])
        heads = [
            f"{n} {left}{u}{right}" if u else n for n, u in zip(names, units, strict=True)
        ]
        comma = dice.choice(",;\t")
        lines = [comma.join(heads)] + [comma.join(row) for row in rows]
        text = "\n".join(lines)
        if comma != "," and dice.random() < 0.5:
            text = lines[0] + "\n" + "\n".join(lines[1:]).replace(".", ",")
        data = dice.choice(
            [text.encode(), codecs.BOM_UTF8 + text.encode(), text.encode("utf-16")]
        )
        table = titled_table(text_of(data), "x", CaseError)
        assert table.titles == tuple(zip(names, units, strict=True))
        assert [row.cells for row in table.rows] == rows
