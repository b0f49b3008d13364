"""The templates of documents: each package has its own, and all pages extend one base.html."""

from typing import Any

import jinja2
from markupsafe import Markup

from derive.sheet.prose import prose


def templates(package: str, command: str, **options: Any) -> jinja2.Environment:
    """The templates of a package, such as derive.edge; pages name the command that writes them."""
    loaders = [jinja2.PackageLoader(package), jinja2.PackageLoader("derive.sheet")]
    made = jinja2.Environment(
        loader=jinja2.ChoiceLoader(loaders),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        **options,
    )
    made.globals["command"] = command
    made.filters["prose"] = lambda text: Markup(prose(text))
    return made
