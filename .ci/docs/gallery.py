"""The gallery: commands of its page are run, and their pictures put where the page says."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from formulas import slug
from pages import ROOT

PICTURE = re.compile(r"^<!-- picture: (\S+) -->$", re.MULTILINE)
HEADING = re.compile(r"^## (.+)$", re.MULTILINE)


def run_commands(text: str, folder: Path) -> None:
    """Run the `rps` commands of a page in a folder, if their pictures are not there already."""
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copytree(ROOT / "cases", folder / "cases", dirs_exist_ok=True)
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg"}
    for _, body in _sections(text):
        if all((folder / picture).is_file() for picture in PICTURE.findall(body)):
            continue
        for line in re.findall(r"^rps .*$", body, re.MULTILINE):
            announced = re.search(r"# exit code (\d+)$", line)
            words = shlex.split(line, comments=True)[1:]
            print("rps", *words, flush=True)
            done = subprocess.run(
                [sys.executable, "-m", "rpscli", *words, "--quiet"],
                cwd=folder, env=environment, check=False,
            )  # fmt: skip
            if done.returncode != int(announced[1] if announced else 0):
                raise SystemExit(f"{line}: exit code {done.returncode}")


def _sections(text: str) -> Iterator[tuple[str, str]]:
    """Headings, and what stands below each."""
    _, *parts = HEADING.split(text)
    yield from zip(parts[::2], parts[1::2], strict=True)


def illustrated(text: str, results: Path, pictures: Path) -> str:
    """The page with its pictures, and a card for each of them at its top."""
    pictures.mkdir(parents=True, exist_ok=True)
    cards = []
    for title, body in _sections(text):
        for number, path in enumerate(PICTURE.findall(body)):
            name = f"{slug(title)}-{number}{Path(path).suffix}"
            shutil.copyfile(results / path, pictures / name)
            text = text.replace(
                f"<!-- picture: {path} -->", f"![{title}](/pictures/gallery/{name})"
            )
            if not number:
                cards.append(
                    f":::{{grid-item-card}} {title}\n:img-top: /pictures/gallery/{name}\n"
                    f':img-alt: {title}\n:link: "#{slug(title)}"\n:link-type: url\n:::\n'
                )
    first = HEADING.search(text)
    assert first is not None, "a gallery has sections"
    grid = "::::{grid} 1 2 2 3\n:gutter: 3\n\n" + "\n".join(cards) + "::::\n\n"
    return text[: first.start()] + grid + text[first.start() :]
