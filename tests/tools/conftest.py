"""Commands of tools are called as others are."""

from commands.conftest import (  # noqa: F401 -- fixtures
    _figures_cost_nothing,
    figures,
    rps,
    rps_json,
    shell,
    workplace,
)
