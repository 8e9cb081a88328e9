"""Motions and factors that fit a spectrum."""

OFFERS = {
    "record_commands": {"select": "rpscli.tools.selection.command:command"},
}
