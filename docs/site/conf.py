"""Sphinx settings for the website that `make docs` builds; pages.py prepares its input.

Nothing is downloaded when the website is built or read: formulas are MathML, which browsers render
without a script.
"""

import re
import sys
from enum import EnumType
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

from derive.sheet.mathml import mathml

sys.path.insert(0, str(Path(__file__).parent))

from docstrings import restructured

NUMBER = re.compile(r"[~−-]?\d[\d.,e+×% −-]*(\w{1,2}|\([^()]{1,12}\))?")
"""A cell such as 7.7e-16 (2 of 9)."""

LONG = 50
"""Number of characters above which the LaTeX of a formula is too wide for a column on a phone."""

project = "contact-derive"
author = "The contact-derive contributors"
copyright = f"{author}, MIT licence"
extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["docs/site"]

html_theme = "furo"
html_title = project
html_static_path = ["docs/site/style"]
html_css_files = ["figures.css", "site.css"]
html_show_sphinx = False
html_show_sourcelink = False
html_copy_source = False
html_math_renderer = "mathml"

nb_render_markdown_format = "myst"  # Markdown that code prints contains formulas
nb_execution_mode = "off"  # the notebooks are stored with their outputs
nb_mime_priority_overrides = [
    ("html", "application/vnd.jupyter.widget-view+json", None),
    ("html", "image/svg+xml", 5),
]
myst_enable_extensions = ["dollarmath", "amsmath"]
myst_heading_anchors = 3
math_eqref_format = "({number})"
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings say what each argument is
napoleon_google_docstring = False
napoleon_use_param = False  # several arguments share one description
napoleon_use_rtype = False
napoleon_custom_sections = [("Attributes", "params_style")]  # a list, not one entry for each
suppress_warnings = [
    "mystnb.mime_priority",  # a slider has no static image, so its code is shown
    "misc.highlighting_failure",  # the output of a terminal is not Python
]


def _inline(self: object, node: nodes.math) -> None:
    self.body.append(f'<span class="math">{mathml(node.astext(), "inline")}</span>')  # type: ignore[attr-defined]
    raise nodes.SkipNode


def _block(self: object, node: nodes.math_block) -> None:
    ids = "".join(f'<span id="{name}"></span>' for name in node["ids"])
    number = f'<span class="eqno">({node["number"]})</span>' if node.get("number") else ""
    formula = mathml(node.astext())
    self.body.append(f'<div class="math">{ids}{formula}{number}</div>')  # type: ignore[attr-defined]
    raise nodes.SkipNode


def _tables(app: Sphinx, doctree: nodes.document) -> None:
    """Mark the cells that contain numbers, which must not break at a hyphen, and the tables of long
    formulas."""
    for table in doctree.findall(nodes.table):
        if any(len(formula.astext()) > LONG for formula in table.findall(nodes.math)):
            table["classes"].append("formulas")
    for cell in doctree.findall(nodes.entry):
        if NUMBER.fullmatch(cell.astext()):
            cell["classes"].append("number")


def _restructured(
    app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]
) -> None:
    """Rewrite a docstring, which is written for a terminal, before napoleon reads it."""
    lines[:] = restructured(lines)


def _called(
    app: Sphinx, what: str, name: str, obj: object, options: object, signature: str, returns: str
) -> tuple[str, str] | None:
    """Show no arguments for an enumeration: nobody calls it."""
    return ("", "") if isinstance(obj, EnumType) else None


def setup(app: Sphinx) -> None:
    """Render formulas as MathML, and docstrings with their sections."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    app.connect("doctree-read", _tables)
    app.connect("autodoc-process-docstring", _restructured, priority=100)
    app.connect("autodoc-process-signature", _called)
