"""Designs are computed as studies are."""

from sweep.conftest import (  # noqa: F401 -- fixtures
    no_figures,
    study_of,
    sweep,
    sweep_json,
    workplace,
)
