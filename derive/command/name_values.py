"""Reads options of the form NAME=TEXT, which describe parameters."""

from collections.abc import Iterable

from derive.command.errors import BadOption


def said(option: str, given: Iterable[str]) -> dict[str, str]:
    """The text that an option NAME=TEXT gives for each parameter.

    Raises BadOption.

    >>> said("--unit", ["R=m", "phi = rad"])
    {'R': 'm', 'phi': 'rad'}
    """
    texts: dict[str, str] = {}
    for each in given:
        name, equals, text = (part.strip() for part in each.partition("="))
        if not (name and equals and text):
            raise BadOption(option, each, "is not of the form NAME=TEXT")
        if name in texts:
            raise BadOption(option, each, f"{name} is given a second time")
        texts[name] = text
    return texts
