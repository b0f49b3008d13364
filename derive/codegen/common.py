"""What the functions of a body share if they are sums over the parts of a contact.

In:  the texts of these functions.
Out: what all of them compute, and what several of them print, which then stands in one place: the
     text of `_parts`, and the docstring of the module.
"""

from collections import Counter
from collections.abc import Iterator, Sequence

from derive.codegen.function import FunctionText
from derive.codegen.program import Common


def common_of(texts: Sequence[FunctionText]) -> Common:
    """The steps and the conditions of all these functions, and the definitions of several."""
    if not texts:
        return Common()
    first, *others = texts
    steps = [s for s in first.program.steps if all(s in other.program.steps for other in others)]
    checks = [
        check for check in first.checks if steps and all(check in other.checks for other in others)
    ]
    count = Counter(symbol for text in texts for symbol in text.defined)
    defined = {k: v for text in texts for k, v in text.defined.items() if count[k] > 1}
    own = (q.name for q in first.sheet.geometry.parameters)
    return Common(("a", "c", *own), tuple(steps), tuple(checks), defined)


def common_text(text: FunctionText, common: Common) -> Iterator[str]:
    """The function that computes what all functions need; `text` is one of them."""
    given = ", ".join(f"{name}: Array" for name in common.arguments)
    yield "@shared"
    yield f"def _parts({given}) -> tuple[Array, ...]:"
    yield '    """Whether [-a, c] is a contact, its width and the angles of its parts."""'
    yield from text.step_lines(common.steps)
    yield f"    exists = {' & '.join(common.checks)}"
    yield f"    return {', '.join(common.names)}"
