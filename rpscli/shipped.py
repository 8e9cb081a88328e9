"""Cases and studies that come with rps: within it where it is installed, beside it in a clone."""

from __future__ import annotations

import re
from pathlib import Path

FOLDER = "cases"
_FILE_NAMES = re.compile(r"[\w./-]+\.(?:yaml|csv|at2|py)\b")


def shipped_cases() -> Path:
    """The folder of all of them."""
    inside = Path(__file__).resolve().with_name(FOLDER)
    return inside if inside.is_dir() else inside.parents[1] / FOLDER


def examples() -> dict[str, str]:
    """Their names, as in `studies/product`, and the first sentence of what stands above each."""
    place = shipped_cases()
    sentences = {}
    for file in sorted(place.rglob("*.yaml"), key=lambda file: (len(file.parts), file)):
        above = file.read_text("utf-8").partition("\nrps:")[0].replace("\n#", "").lstrip("# ")
        name = file.relative_to(place).with_suffix("").as_posix()
        sentences[name] = re.split(r"(?<=[.?])\s", above)[0]
    return sentences


def example_files(name: str) -> dict[str, bytes]:
    """An example, or all of a folder, and the files that they name, in comments too, by path."""
    place = shipped_cases()
    contents: dict[Path, bytes] = {}
    waiting = [place / f"{name}.yaml", *sorted((place / name).rglob("*.yaml"), reverse=True)]
    while waiting:
        file = waiting.pop()
        if file in contents or not file.is_file() or place not in file.parents:
            continue
        contents[file] = file.read_bytes()
        if file.suffix == ".yaml":
            # Beside the file, or as commands are typed, from above the folder.
            named = ["README.md", *_FILE_NAMES.findall(contents[file].decode("utf-8"))]
            waiting += [
                (up / each).resolve() for each in named for up in (file.parent, place.parent)
            ]
    return {file.relative_to(place).as_posix(): content for file, content in contents.items()}
