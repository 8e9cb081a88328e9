"""Functions that stand in files, compiled and as Python."""

from __future__ import annotations

import importlib.util
import itertools
import math
import struct
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from rpscli.compiler.functions import Program
from rpscli.compiler.objects import Entry, kind_of_argument, machine_code
from rpscli.compiler.values import DOUBLE

_count = itertools.count()


def module_of(text: str, folder: Path) -> ModuleType:
    """A module with a text, whose source can be read."""
    name = f"written_{next(_count)}"
    path = folder / f"{name}.py"
    path.write_text("import math\nimport numpy as np\n" + text, encoding="utf-8")
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def compiled(
    function: Callable[..., Any], *given: Any, result: str | None = DOUBLE
) -> Entry:
    """A function for arguments like these; `result` is what it returns."""
    kinds = [kind_of_argument(each) for each in given]
    program = Program()
    program.add(function, kinds, "@f", result)
    return Entry(machine_code(program.text()), "f", kinds, result)


def bits(value: float) -> bytes | str:
    """What tells two numbers apart; all NaN are one."""
    return "nan" if math.isnan(value) else struct.pack("<d", float(value))
