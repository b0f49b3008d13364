"""Write the readings that a user accepts into the claims file: either all of them or none.

In:   the path of a claims file, and the accepted readings.
Out:  the file with these readings, or an error and the file as it was.
"""

import tomllib
from collections.abc import Sequence
from pathlib import Path

from derive.check.lines import with_lines
from derive.check.printed import Reading
from derive.check.userfile import source
from derive.command import files
from derive.command.errors import BadClaimsFile

_REMEDY = "add the lines `understood = ...` by hand"


def demand_writable(path: Path) -> None:
    """Raise BadClaimsFile if the file cannot be replaced; call this before asking the user."""
    try:
        files.demand_writable(path.resolve())
    except OSError as error:
        raise _unwritable(path, error) from error


def accept(path: Path, readings: Sequence[Reading]) -> None:
    """Write the accepted readings of claims into their file.

    Raises BadClaimsFile and leaves the file unchanged if the new file would differ from the old
    one by more than these entries.
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
        why = "the layout of this file does not allow the readings to be inserted automatically"
        raise BadClaimsFile(str(path), why, _REMEDY)
    _replace(path, new)


def _is(text: str, data: dict[str, object]) -> bool:
    try:
        return tomllib.loads(text) == data
    except tomllib.TOMLDecodeError:
        return False


def _replace(path: Path, text: str) -> None:
    """Replace the text of the file, or leave the file unchanged if this fails."""
    target = path.resolve()
    try:
        files.write_whole(text.encode(), target, mode=target.stat().st_mode & 0o777)
    except OSError as error:
        raise _unwritable(path, error) from error


def _unwritable(path: Path, error: OSError) -> BadClaimsFile:
    return BadClaimsFile(str(path), f"the file cannot be written ({error.strerror})", _REMEDY)
