"""What a shell may complete: files, keys of the case, names of results."""

from __future__ import annotations

import click
from click.shell_completion import CompletionItem

FILE = click.Path(allow_dash=True, readable=False)
"""A file, of which the command itself says what is wrong with it."""


def case_keys(
    ctx: click.Context, option: click.Parameter, incomplete: str
) -> list[CompletionItem | str]:
    """Keys of a case that hold a value, after `--set`; what they mean beside them."""
    del ctx, option
    # pydantic is slow.
    from rpscli.case.schema.case_file import CaseFile
    from rpscli.case.schema.keys import field_at, known_paths, section_of

    found: list[CompletionItem | str] = []
    for path in known_paths(CaseFile):
        key, field = ".".join(map(str, path)), field_at(CaseFile, path)
        if field and section_of(field.annotation) is None and key.startswith(incomplete):
            found.append(CompletionItem(key, help=field.description))
    return found


def condition_names(
    ctx: click.Context, option: click.Parameter, incomplete: str
) -> list[CompletionItem | str]:
    """Events and results after `--fail-on`, these with the unit of their limit."""
    del ctx, option
    from rpscli.case.conditions import EVENTS, LIMITS

    labels = {name: f"records that {verb}" for name, verb in EVENTS.items()}
    labels |= {name: f"{quantity.label} [{quantity.unit}]" for name, quantity in LIMITS.items()}
    return [
        CompletionItem(name, help=label)
        for name, label in labels.items()
        if name.startswith(incomplete)
    ]
