"""`import rpscli` as a library."""

from __future__ import annotations

import pytest

import rpscli


@pytest.mark.parametrize("name", rpscli.__all__)
def test_every_public_name_exists(name: str) -> None:
    assert getattr(rpscli, name) is not None
    assert name in dir(rpscli)


def test_other_names_do_not() -> None:
    with pytest.raises(AttributeError, match="no attribute 'pushower'"):
        rpscli.pushower  # noqa: B018
