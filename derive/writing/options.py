"""What options of the form NAME=TEXT say of parameters."""

from collections.abc import Iterable

from derive.errors import BadOption


def said(option: str, given: Iterable[str]) -> dict[str, str]:
    """What an option NAME=TEXT says of each parameter.

    Raises BadOption.

    >>> said("--unit", ["R=m", "phi = rad"])
    {'R': 'm', 'phi': 'rad'}
    """
    found: dict[str, str] = {}
    for each in given:
        name, equals, text = (part.strip() for part in each.partition("="))
        if not (name and equals and text):
            raise BadOption(option, each, "is not of the form NAME=TEXT")
        if name in found:
            raise BadOption(option, each, f"says something of {name} a second time")
        found[name] = text
    return found
