"""Sphinx for the site; `build` stages the pages and calls it."""

import re

import formulas
import pages
from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

from rpscli import __version__

project = "rps"
author = "The rps developers"
release = version = __version__
html_title = f"rps {release}"
copyright = author

extensions = [
    "myst_parser", "sphinx.ext.autodoc", "numpydoc", "sphinx_copybutton", "sphinx_design",
]  # fmt: skip
myst_enable_extensions = ["colon_fence", "dollarmath", "amsmath"]
myst_heading_anchors = 4
myst_dmath_double_inline = True
highlight_language = "text"
smartquotes = False  # options have two dashes, derivatives have primes
toc_object_entries = False
nitpicky = True
nitpick_ignore_regex = [
    (
        "py:obj",
        r"(?s).*",
    ),  # single backticks of docstrings: a link if there is one, else code
    (
        "py:.*",
        r"rpscli\.(case|physics|report|sweep|studies\._\w+|records\.(quantities|ground_motion\.Recording)|model\.contact\.Bed)\b.*",
    ),
    (
        "py:.*",
        r"(Record|Way|FileName|Standing|Target|Measure|Of|ReportRequest|Bed|tuple\[.*)",
    ),  # names of types
    (
        "py:class",
        r"rpscli\.(analyses|model|records)\..*|[A-Z]\w+",
    ),  # types that have no page of their own
    (
        "py:.*",
        r"(numpy|np|collections|pathlib|typing|types|matplotlib|pandas|pydantic)\..*",
    ),
    (
        "py:.*",
        r"(NDArray|Array|(style\.)?(Axes|Figure)|Path|Any|Callable|Mapping|Sequence|Iterable|Iterator|optional)",
    ),
]
default_role = "py:obj"
autodoc_default_options = {
    "members": True,
    "member-order": "bysource",
    "inherited-members": False,
}
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 80
numpydoc_show_class_members = False

html_theme = "pydata_sphinx_theme"
html_context = {"default_mode": "auto"}  # of colours; without it browsers report an error
html_favicon = "static/icon.svg"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "logo": {"text": project},
    "header_links_before_dropdown": 5,
    "navbar_align": "left",
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": ["sphinx-version"],
}
html_sidebars = {
    name: []
    for name in (
        "index",
        "gallery",
        "guide",
        "theory",
        "verification",
        "conformance",
        "errata",
        "changelog",
    )
}
copybutton_selector = (
    "div.highlight-sh pre, div.highlight-yaml pre, div.highlight-python pre"
)
html_math_renderer = "mathml"


def _mathml(translator: HTML5Translator, node: nodes.math | nodes.math_block) -> None:
    """Formulas as MathML, which browsers draw without a script or a network."""
    block = isinstance(node, nodes.math_block)
    formula = re.sub(r"_\{([a-z]{2,})", r"_{\\mathrm{\1}", node.astext())
    text = convert(formula, display="block" if block else "inline")
    translator.body.append(f'<div class="math">{text}</div>' if block else text)
    raise nodes.SkipNode


def _theory(shown: str, anchor: str) -> str:
    """A link to the theory from a page of the Python reference."""
    return f"`{shown} <../../theory.html#{anchor}>`__"


def _escape(
    app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]
) -> None:
    """Bars and stars of formulas in docstrings are no markup; examples and code stay."""
    for i, line in enumerate(lines):
        if not line.lstrip().startswith((">>>", "...")):
            parts = re.split(r"(`+[^`]*`+)", line)
            parts[::2] = [re.sub(r"(?<!\\)([|*])", r"\\\1", part) for part in parts[::2]]
            lines[i] = formulas.cite("".join(parts), _theory, pages.THEORY)


def setup(app: Sphinx) -> None:
    """Own renderer of formulas; docstrings as plain text with sections."""
    app.connect("autodoc-process-docstring", _escape, priority=400)  # before numpydoc
    app.add_html_math_renderer("mathml", (_mathml, None), (_mathml, None))
