"""`rps` and `python -m rpscli`."""

from __future__ import annotations

import gc
import os
import warnings

from rpscli.cli import program

OBJECTS_BETWEEN_COLLECTIONS = 100_000
"""What is imported makes many objects that all stay: looking through them
for garbage as often as Python does by default takes a tenth of a command's time."""


def main() -> None:
    """Run the command line."""
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)
    # Matrices of a hundred storeys are small: threads of the linear algebra would only
    # wait for work, which costs as much as work, and studies use all cores by threads of
    # their own.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Which line of the program warns is nothing to its users.
    warnings.formatwarning = lambda text, *_, **__: f"warning: {text}\n"
    try:
        program(prog_name="rps")
    finally:
        # Nor is anything to be looked for at the end, which frees all at once.
        gc.freeze()


if __name__ == "__main__":
    main()
