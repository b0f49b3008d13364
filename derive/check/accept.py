"""Write what a user accepts into the claims file: either all of it or nothing.

In:   the path of a claims file, the accepted readings, and the symbols with accepted proposals.
Out:  the file with these entries, or an error and the file as it was.
"""

import tomllib
from collections.abc import Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.items import Comment, Table, Whitespace

from derive.check.userfile import source
from derive.command import files
from derive.command.errors import BadClaimsFile

_REMEDY = "add the lines `understood = ...` and `is = ...` by hand"
_refused = partial(
    files.refused_as, partial(BadClaimsFile, remedy=_REMEDY), what="the file cannot be written"
)


def demand_writable(path: Path) -> None:
    """Raise BadClaimsFile if the file cannot be replaced; call this before asking the user."""
    with _refused(path):
        files.demand_writable(path.resolve())


def accept(path: Path, readings: Mapping[str, str], symbols: Iterable[str] = ()) -> None:
    """Write the accepted readings of claims, and the accepted proposals for symbols, into the file.

    Raises BadClaimsFile and leaves the file unchanged if the new file would differ from the old
    one by more than these entries.

    readings: by the labels of the claims
    """
    text, data = source(path)
    document = tomlkit.parse(text)
    is_kept = tomlkit.dumps(document) == text  # tomlkit may move claims after another table
    for file in (data, document):
        for claim in file["claims"]:
            if claim["label"] in readings:
                _accept(claim, readings[claim["label"]])
        for name in symbols:
            file["symbols"][name]["is"] = file["symbols"][name].pop("proposal")
    new = tomlkit.dumps(document)
    if not is_kept or tomllib.loads(new) != data:
        why = "the layout of this file does not allow the accepted entries to be inserted"
        raise BadClaimsFile(str(path), why, _REMEDY)
    with _refused(path):
        target = path.resolve()
        files.write_whole(new.encode(), target, mode=target.stat().st_mode & 0o777)


def _accept(claim: dict[str, Any], understood: str) -> None:
    """Set the entries of a claim; a new entry stands before the comments at the claim's end."""
    body = claim.value.body if isinstance(claim, Table) else []
    end = len(body)
    while end and isinstance(body[end - 1][1], Comment | Whitespace) and "understood" not in claim:
        end -= 1
    rest, body[end:] = body[end:], []
    claim["understood"] = understood
    if "accepted" in claim:
        claim["accepted"] = True
    body += rest
