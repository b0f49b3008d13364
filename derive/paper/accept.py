"""Readings that a person accepts, written into the claims file: all of them, or nothing."""

import tomllib
from collections.abc import Sequence
from pathlib import Path

from derive.errors import BadClaimsFile
from derive.files import write_whole
from derive.paper.lines import with_lines
from derive.paper.userfile import Reading, source

_REMEDY = "write the lines understood = ... by hand"


def accept(path: Path, readings: Sequence[Reading]) -> None:
    """Write what was understood of claims into their file.

    Raises BadClaimsFile, and leaves the file as it was, where the result would not be the same
    file with these entries and no other change.
    """
    text, data = source(path)
    wanted = {reading.number: reading.understood for reading in readings}
    new = with_lines(text, len(data["claims"]), wanted)
    for number, understood in wanted.items():
        claim = data["claims"][number - 1]
        claim["understood"] = understood
        if "accepted" in claim:
            claim["accepted"] = True
    if new is None or not _is(new, data):
        why = "is written in a way that the readings cannot be put into it"
        raise BadClaimsFile(str(path), why, _REMEDY)
    _replace(path, new)


def _is(text: str, data: dict[str, object]) -> bool:
    try:
        return tomllib.loads(text) == data
    except tomllib.TOMLDecodeError:
        return False


def _replace(path: Path, text: str) -> None:
    """The file with a new text, or as it was."""
    target = path.resolve()
    try:
        write_whole(text.encode(), target, mode=target.stat().st_mode & 0o777)
    except OSError as error:
        why = f"cannot be written ({error.strerror})"
        raise BadClaimsFile(str(path), why, _REMEDY) from error
