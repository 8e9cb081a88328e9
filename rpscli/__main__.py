"""`rps` and `python -m rpscli`."""

from __future__ import annotations

from rpscli.cli import program


def main() -> None:
    """Run the command line."""
    program(prog_name="rps")


if __name__ == "__main__":
    main()
