"""Pages of the site: the Markdown files as they stand, with links that lead within it."""

from __future__ import annotations

import ast
import os
import re
import shutil
from collections.abc import Mapping
from pathlib import Path

import formulas

ROOT = Path(__file__).parents[2]
PAGES = {
    "README.md": "index",
    "cases/README.md": "gallery",
    "rpscli/GUIDE.md": "guide",
    "rpscli/tutorials/figure.md": "tutorials/figure",
    "rpscli/tutorials/verdict.md": "tutorials/verdict",
    "rpscli/THEORY.md": "theory",
    "rpscli/VERIFICATION.md": "verification",
    "rpscli/CONFORMANCE.md": "conformance",
    "rpscli/ERRATA.md": "errata",
    "rpscli/GLOSSARY.md": "reference/glossary",
    "CHANGELOG.md": "changelog",
    "cases/compdyn2021/README.md": "cases/compdyn2021",
    "cases/granite/README.md": "cases/granite",
    "cases/pull_back/README.md": "cases/pull_back",
    "cases/studies/contact/README.md": "cases/contact",
    "cases/studies/impact_law/README.md": "cases/impact_law",
    **{
        path.relative_to(
            ROOT
        ).as_posix(): f"certified/{path.stem.replace('README', 'index')}"
        for path in sorted((ROOT / "rpscli/analyses/certified").glob("*.md"))
    },
}
"""Files that are pages, and their names on the site."""

SET = {
    "theory",
    "verification",
    "conformance",
    "errata",
    "reference/glossary",
    *filter(re.compile("cases/|certified/").match, PAGES.values()),
}
"""Pages whose code is mostly formulas."""

THEORY = formulas.anchors_of((ROOT / "rpscli/THEORY.md").read_text(encoding="utf-8"))
"""The anchors of its sections and formulas by their numbers."""

PICTURES = {".png", ".svg", ".gif"}
LANGUAGES = {
    ".py": "python",
    ".yaml": "yaml",
    ".yml": "yaml",
    ".cff": "yaml",
    ".toml": "toml",
}
FENCES = re.compile(r"^(```+|~~~+).*?^\1$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((?![a-z]+:)([^)#\s]+)(#[^)\s]*)?\)")
WORD = re.compile(r"^#.*$|\[[^\]]*\]\([^)]*\)|`([^`\n]+)`", re.MULTILINE)


class Stage:
    """A folder of sources for Sphinx: pages, and of what they link to pictures and files."""

    def __init__(self, folder: Path, names: Mapping[str, str] | None = None) -> None:
        """`names` are words of code, as keys and commands, and links to what explains them."""
        self.folder, self.names = folder, names or {}
        self.missing: list[str] = []
        self.files: set[str] = set()

    def write(self, name: str, text: str) -> None:
        """A page of this name."""
        path = self.folder / f"{name}.md"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def add_all(self) -> None:
        """Every page."""
        for source, name in PAGES.items():
            if (ROOT / source).is_file():
                self.write(name, self.page(source))

    def page(self, source: str) -> str:
        """The text of a file, with links and words of code that lead to pages of the site."""
        text = (ROOT / source).read_text(encoding="utf-8")
        parts, last = [], 0
        for fence in FENCES.finditer(text):
            parts += [self._linked(text[last : fence.start()], source), fence[0]]
            last = fence.end()
        return "".join([*parts, self._linked(text[last:], source)])

    def _linked(self, text: str, source: str) -> str:
        name = PAGES[source]
        theory = "../" * name.count("/") + "theory.html"
        if name in SET:
            text = formulas.set_formulas(text)
        if name == "theory":
            text = formulas.cite_here(text, THEORY)
        else:
            text = formulas.cite(
                text, lambda said, at: f'<a href="{theory}#{at}">{said}</a>', THEORY
            )
        text = WORD.sub(self._named, text)
        return LINK.sub(
            lambda link: f"]({self._target(link[1], source)}{link[2] or ''})", text
        )

    def _named(self, word: re.Match[str]) -> str:
        return self.names.get(word[1] or "", word[0])

    def _target(self, link: str, source: str) -> str:
        if link.startswith("/"):
            return link
        path = os.path.normpath(Path(source).parent / link).replace(os.sep, "/")
        for known in (path, f"{path}/README.md"):
            if known in PAGES:
                return f"/{PAGES[known]}.md"
        if not (ROOT / path).exists():
            self.missing.append(f"{source}: {link}")
            return link
        if Path(path).suffix in PICTURES:
            copy = self.folder / "pictures" / path
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / path, copy)
            return f"/pictures/{path}"
        return self.file(path)

    def file(self, path: str) -> str:
        """The page that shows a file of the repository, or what is in a folder of it."""
        whole = ROOT / path
        name = f"files/{path}/index" if whole.is_dir() else f"files/{path}"
        if path not in self.files:
            self.files.add(path)
            hidden = "" if path.startswith("cases") else "nosearch: true\n"
            body = self._folder(whole) if whole.is_dir() else _shown(whole)
            self.write(name, f"---\norphan: true\n{hidden}---\n\n# `{path}`\n\n{body}")
        return f"/{name}.md"

    def _folder(self, folder: Path) -> str:
        lines = []
        for path in sorted(folder.iterdir()):
            name = path.relative_to(ROOT).as_posix()
            if path.name.startswith((".", "__pycache__", "results")):
                continue
            said = _first_line(path)
            if name.startswith("cases") and (path.is_dir() or path.suffix in LANGUAGES):
                target = self._target(
                    path.name, f"{folder.relative_to(ROOT).as_posix()}/x"
                )
                lines.append(f"- [`{path.name}`]({target}){said}")
            elif path.is_dir() or said:
                lines.append(f"- `{path.name}`{said}")
        return "\n".join(lines) + "\n"


def _shown(path: Path) -> str:
    text = path.read_text(encoding="utf-8")
    return f"`````{LANGUAGES.get(path.suffix, 'text')}\n{text}\n`````\n"


def _first_line(path: Path) -> str:
    """What a file says of itself: its docstring, title or first comment."""
    path = path / "__init__.py" if path.is_dir() else path
    if not path.is_file() or path.suffix not in LANGUAGES:
        return ""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        said = (ast.get_docstring(ast.parse(text)) or "").split("\n")[0]
    else:
        title = re.search(r"^title: (.+)$", text, re.MULTILINE)
        said = title[1] if title else ""
    return f": {said}" if said else ""
