"""Sphinx settings for the website that `make docs` builds; pages.py prepares its input.

Nothing is downloaded when the website is built or read: formulas are MathML, which browsers render
without a script.
"""

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx

project = "contact-derive"
author = "The contact-derive contributors"
copyright = f"{author}, MIT licence"
extensions = ["myst_nb", "sphinx.ext.autodoc"]
exclude_patterns = ["docs/site"]

html_theme = "furo"
html_title = project
html_static_path = ["docs/site/style"]
html_css_files = ["site.css"]
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
autodoc_typehints_format = "short"
suppress_warnings = [
    "mystnb.mime_priority",  # a slider has no static image, so its code is shown
    "misc.highlighting_failure",  # the output of a terminal is not Python
]


def _inline(self: object, node: nodes.math) -> None:
    self.body.append(f'<span class="math">{convert(node.astext())}</span>')  # type: ignore[attr-defined]
    raise nodes.SkipNode


def _block(self: object, node: nodes.math_block) -> None:
    ids = "".join(f'<span id="{name}"></span>' for name in node["ids"])
    number = f'<span class="eqno">({node["number"]})</span>' if node.get("number") else ""
    formula = convert(node.astext(), display="block")
    self.body.append(f'<div class="math">{ids}{formula}{number}</div>')  # type: ignore[attr-defined]
    raise nodes.SkipNode


def _as_written(
    app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]
) -> None:
    """Show a docstring as literal text: its formulas are Python, not reStructuredText."""
    lines[:] = [".. code-block:: text", "", *(f"   {line}" for line in lines), ""]


def setup(app: Sphinx) -> None:
    """Render formulas as MathML, and show docstrings as literal text."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    app.connect("autodoc-process-docstring", _as_written)
