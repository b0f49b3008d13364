"""How a formula written for one block of float64 serves every input.

A formula's temporaries are as large as its argument.  Evaluated over blocks that fit the
processor's cache they cost little; over a whole large array they cost more than the arithmetic.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import wraps
from inspect import Parameter, signature
from itertools import chain, product
from typing import Any, TypeVar

import numpy as np

from ._chunks import any_lazy, demand_array, is_lazy, known_shape, over_chunks
from ._logarithm import log1p
from ._plain import (
    REFUSALS,
    in_plain_numbers,
    plain_fmax,
    plain_kink_logarithm,
    plain_maximum,
    plain_minimum,
)
from ._types import Contact

Array = Any
Function = TypeVar("Function", bound=Callable[..., Any])
Shape = tuple[int, ...]

BLOCK = 23_000
"""Elements evaluated at once, of arrays that are cut: enough to make the overhead of a call small,
few enough that four such arrays are less than a tenth of a result of a million, and lie in caches
close to the core.
"""

SHARE = 10
"""Blocks are longer where they hold no more than this part of the results, and of RESIDENT for
each of these.
"""

FEW = 20
"""Of more arrays than these a core's cache has no room for blocks: they hold half of RESIDENT, as
arrays are counted.
"""

TINY = 1e-150
"""What stands for a distance of zero where a quotient must stay finite."""

LEAST, MOST = 1e-75, 1e75
"""The shortest and the longest length, in metres, whose products stay well inside float64."""

PIECE = 26_000
"""Elements of a cycle computed at once: enough to make the overhead of a call small."""

_FLOAT64 = np.dtype(np.float64)
_NAN = np.float64(np.nan)
_NUMBERS = (np.float64, float)
_MANY = 3_000
"""Elements from where an array full of one number is made up for."""

_HEAP = 14 << 20
"""Bytes of the largest array that lies in the process's heap."""

RESIDENT = 2 * _HEAP // 8
"""Numbers that the heap keeps.  A call that holds no more is not cut: it asks the system for no
pages, and the processor's last cache holds most of its arrays.  Several results are not counted,
since they are copied from the blocks; the rest of these, and more than FEW arrays, as far as the
arguments vary.  Nothing is cut where there is no rest.
"""

_ZEROS = np.zeros(RESIDENT // 2)  # the system lends one page for all of it
_ZEROS.flags.writeable = False

# glibc gives free memory above 128 KiB back to the system, and asks for each page anew in the next
# call, which takes longer than the arithmetic: until the process has once let go of a larger piece,
# and then above twice its size.  This piece is never touched.
np.empty(_HEAP, np.uint8)


def elementwise(*, arrays: int, bare: tuple[str, ...] = ()) -> Callable[[Function], Function]:
    """Let a formula take anything that broadcasts, and compute large arrays in blocks.

    arrays: how many it holds at once, if its constants are numbers.
    bare: arguments each of which, where it alone is an array of float64 and the contact exists,
        makes it hold nothing but its results: blocks would save nothing then, and be copied.

    Numbers and arrays of any real type become float64; Dask arrays stay lazy, and are computed
    chunk by chunk; arrays of other libraries that follow NumPy's protocols are computed by these.
    Keyword-only arguments are material and geometry: NaN unless positive and finite.  No
    floating-point warning leaves the call: what does not exist is NaN.  Results of several fields
    that are computed in blocks share one piece of memory.

    The function raises TypeError for what is no real number, ValueError for shapes that do not
    broadcast.
    """

    def decorated(function: Function) -> Function:
        return _elementwise(function, arrays, frozenset(bare))

    return decorated


def _elementwise(function: Function, arrays: int, bare: frozenset[str]) -> Function:
    called = signature(function)
    parameters, count = called.parameters, len(called.parameters)
    results = len(getattr(called.return_annotation, "_fields", ("",)))
    whole_of = _computed(function) if "scaled_at_last" in function.__code__.co_names else function
    weighed = arrays if results == 1 else max(1, arrays - results)
    few = arrays <= FEW
    constants = {n for n, p in parameters.items() if p.kind is Parameter.KEYWORD_ONLY}
    names = tuple(n for n in parameters if n not in constants)
    own_names = tuple(n for n in parameters if n in constants)
    defaults = {n: p.default for n, p in parameters.items() if p.default is not Parameter.empty}
    Float, INFINITE, numbers = np.float64, math.inf, frozenset(_NUMBERS)
    quiet = np.errstate(all="ignore")(whole_of)
    at_numbers = in_plain_numbers(function)
    quiet_blocks = np.errstate(all="ignore")(_in_blocks)

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        kinds = {*map(type, args), *map(type, kwargs.values())}
        if kinds <= numbers and len(args) + len(kwargs) == count:
            if Float in kinds:
                args, kwargs = (*map(float, args),), {n: float(v) for n, v in kwargs.items()}
            for name in own_names:
                if not 0 < kwargs.get(name, 1.0) < INFINITE:
                    kwargs[name] = math.nan
            if at_numbers:
                try:
                    found = at_numbers(*args, **kwargs)
                    return Float(found) if results == 1 else found._make(map(Float, found))
                except REFUSALS:
                    pass  # NumPy has an answer
            return quiet(*map(Float, args), **{n: Float(v) for n, v in kwargs.items()})
        given = (dict(zip(names, args, strict=False)) | kwargs) if args else kwargs
        if len(given) < len(args) + len(kwargs):
            return function(*args, **kwargs)  # too many, or one twice: Python's own message
        if len(given) < count:
            given = defaults | given
        shape: Shape = ()
        alike, foreign, unread, size, varying, own, last = True, False, False, 1, 0, 0, ""
        for name, value in given.items():
            kind = type(value)
            if kind is float or kind is Float:
                if name in constants and not 0 < value < INFINITE:
                    given[name] = _NAN
                elif kind is float:
                    given[name] = Float(value)
                continue
            if kind is not np.ndarray or value.dtype is not _FLOAT64 or not value.ndim:
                if name not in constants and _is_of_reals(value):
                    unread = True
                else:
                    value = given[name] = _float64(value, name)
            if name in constants:
                value = given[name] = _positive(value)
            if type(value) is np.ndarray:
                alike, shape = alike and shape in ((), value.shape), value.shape
                size, varying, own = max(size, value.size), varying + 1, own + (name in constants)
                last = name
            elif type(value) is not Float:
                foreign = True
        held = weighed + own if few and results == 1 else weighed * varying / len(names)
        spares = unread or varying > 1 or last not in bare
        whole = foreign or (alike and not (spares and size * held > RESIDENT))
        if unread and whole:
            given = {name: _float64(value, name) for name, value in given.items()}
        if foreign and any_lazy(given.values()):
            _broadcast(given)
            return over_chunks(call, given)
        if whole:
            return quiet(**given)
        if not alike:
            shape = _broadcast(given)
        if 0 in shape:
            return quiet(**{n: np.broadcast_to(_float64(v, n), shape) for n, v in given.items()})
        spared = results * min(RESIDENT, math.prod(shape)) // SHARE if few else RESIDENT // 2
        return quiet_blocks(function, given, shape, max(BLOCK, spared // arrays))

    return call  # type: ignore[return-value]


def chunkwise(function: Function, in_time: bool = False) -> Function:
    """Let a function of contacts and arrays take Dask arrays, too, and compute chunk by chunk.

    Large NumPy arrays are computed piece by piece, so that what it holds besides its result stays
    small.

    Options, annotated as whole numbers or truth values, are handed on as they are.
    in_time: whether the last axis is time, and must lie in one chunk.
    """
    called = signature(function)
    parameters = called.parameters
    contacts = {name for name, p in parameters.items() if p.annotation is Contact}
    literal = {name for name, p in parameters.items() if p.annotation in (int, bool)}

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        lazy = any_lazy(_numbers(args, kwargs.values()))
        if not lazy and (in_time or not _is_large(_numbers(args, kwargs.values()))):
            return function(*args, **kwargs)
        try:
            bound = called.bind(*args, **kwargs).arguments
        except TypeError:
            return function(*args, **kwargs)  # Python's own message
        given: dict[str, Any] = {}
        for name, value in bound.items():
            given |= contact_edges(value, name) if name in contacts else {name: value}
        numbers = {name: _float64(v, name) for name, v in given.items() if name not in literal}
        shape = _broadcast(numbers)
        if lazy:
            return over_chunks(call, given | numbers, in_time)
        if any(map(_is_foreign, numbers.values())):
            return function(*args, **kwargs)  # it says which arrays it takes
        options = {name: given[name] for name in literal & given.keys()}

        def piece(**part: Any) -> Any:
            held = {name: v for name, v in part.items() if "." not in name}
            for name in contacts & bound.keys():
                edges = part[f"{name}.a"], part[f"{name}.c"]
                held[name] = Contact(*edges, np.float64(np.nan))
            return function(**held, **options)

        return _in_blocks(piece, numbers, shape, PIECE)

    return call  # type: ignore[return-value]


def _is_large(values: Iterable[Any]) -> bool:
    """Whether one of them is a NumPy array of more than a piece."""
    return any(type(v) is np.ndarray and v.size > PIECE for v in values)


def chunkwise_in_time(function: Function) -> Function:
    """The same, where the last axis is time and must lie in one chunk."""
    return chunkwise(function, in_time=True)


def only_where(exists: Any, *values: Any) -> Any:
    """The values where `exists`, NaN elsewhere, all of one shape."""
    one = type(exists) is np.bool_
    everywhere = bool(exists) if one else _all_of(exists)
    if type(values[0]) is _Unscaled:
        if everywhere and (one or values[0].held.shape == exists.shape):
            return values[0]
        values = (values[0].into(values[0].held),)
    if one:
        found = [_number(v) if everywhere else v * _NAN for v in values]
    elif everywhere:
        found = [v if v.shape == exists.shape else np.where(exists, v, _NAN) for v in values]
    else:
        found = [np.where(exists, v, _NAN) for v in values]
    return found if len(found) > 1 else found[0]


def _all_of(flags: Any) -> bool:
    """Whether they are a NumPy array of nothing but True, quicker than np.all."""
    return type(flags) is np.ndarray and flags.size > 0 and flags.item(flags.argmin())


class _Unscaled:
    """An array times a number, computed where it is to lie; the array is used up.

    So a block of a result is written once, not computed beside it and copied.
    """

    __slots__ = ("factor", "held")

    def __init__(self, held: Any, factor: Any) -> None:
        self.held, self.factor = held, factor

    @property
    def dtype(self) -> Any:
        """As of an array."""
        return self.held.dtype

    def into(self, out: Any) -> Any:
        """Computed in an array that it fits or broadcasts to."""
        return np.multiply(self.held, self.factor, out=out)


def _computed(function: Function) -> Function:
    """The same function, what it leaves to be scaled computed in its own memory."""

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        found = function(*args, **kwargs)
        return found.into(found.held) if type(found) is _Unscaled else found

    return call  # type: ignore[return-value]


def _number(value: Any) -> Any:
    """Python's number as NumPy's, anything else as it is."""
    return np.float64(value) if type(value) is float else value


def some(flags: Any) -> Any:
    """np.any, many times faster for one."""
    return flags if type(flags) is np.bool_ else np.any(flags)


def select(condition: Any, first: Any, second: Any) -> Any:
    """`first` where `condition`, else `second`, without a branch for each element.

    np.where is several times slower where the condition changes at random along an array.
    """
    if not {type(v) for v in (condition, first, second)} <= {np.ndarray, np.float64}:
        return np.where(condition, first, second)[()]
    mask = -condition.astype(np.int64)
    one, other = first.view(np.int64), second.view(np.int64)
    return (other ^ ((one ^ other) & mask)).view(np.float64)


def maximum(first: Any, second: Any) -> Any:
    """np.maximum, several times faster between an array and a number, and between two numbers.

    NumPy compares two arrays many elements at once, but an array and a number one by one.
    """
    if type(first) is np.float64 and type(second) in _NUMBERS:
        return np.float64(plain_maximum(first, second))
    return np.maximum(*_alike(first, second))


def minimum(first: Any, second: Any) -> Any:
    """np.minimum, several times faster between an array and a number, and between two numbers."""
    if type(first) is np.float64 and type(second) in _NUMBERS:
        return np.float64(plain_minimum(first, second))
    return np.minimum(*_alike(first, second))


def fmax(first: Any, second: Any) -> Any:
    """np.fmax, the other one where one is not a number; as fast as `maximum`."""
    if type(first) is np.float64 and type(second) in _NUMBERS:
        return np.float64(plain_fmax(first, second))
    return np.fmax(*_alike(first, second))


def scaled(held: Any, factor: Any) -> Any:
    """held times factor, in the memory of `held`, which is used up, where that can be."""
    if type(held) is np.ndarray and type(factor) is np.float64:
        return np.multiply(held, factor, out=held)
    return held * factor


def scaled_at_last(held: Any, factor: Any) -> Any:
    """held times factor, the one result of a formula; the array `held` is used up.

    Computed at last, in the memory of the whole result or in that of `held`, where that can be.
    """
    if type(held) is np.ndarray and type(factor) is np.float64:
        return _Unscaled(held, factor)
    return held * factor


def kink_logarithm(left: Any, right: Any, offset: Any, least: float = 0.0) -> Any:
    """log(1 + (sqrt(left right) + min(left, right))/d); zero where one of both is negative.

    d is the distance |offset| from the kink, `least` at least.  Also where the quotient leaves
    float64 and its logarithm does not.  The arrays `left` and `right` are used up.
    """
    if type(left) in _NUMBERS and type(right) in _NUMBERS and type(offset) in _NUMBERS:
        try:
            return np.float64(plain_kink_logarithm(left, right, offset, least))
        except REFUSALS:  # NumPy has an answer
            with np.errstate(all="ignore"):
                return _kink_logarithm(left, right, offset, least)
    return _kink_logarithm(left, right, offset, least)


def _kink_logarithm(left: Any, right: Any, offset: Any, least: float) -> Any:
    if least:
        offset = maximum(np.abs(offset), least)
    held = _between_edges(left, right)
    own = type(held) is type(left) is np.ndarray and type(offset) in (np.ndarray, np.float64)
    out = left if own and held.shape == left.shape and offset.shape in ((), held.shape) else None
    try:
        found = _finite_quotient(held, offset, out)
    except FloatingPointError:
        offset = np.abs(offset)
        found = log1p(held / offset)
        return np.where(np.isinf(found), np.log(held) - np.log(offset), found)[()]
    if out is None:
        return log1p(np.abs(found))
    free = right if right.shape == held.shape else None
    return log1p(np.abs(found, out=found), held, free)


@np.errstate(over="raise")
def _finite_quotient(over: Any, under: Any, out: Any) -> Any:
    """The quotient, in the memory of `out` if that is given.

    Raises FloatingPointError where it leaves float64.
    """
    return over / under if out is None else np.divide(over, under, out=out)


def _between_edges(left: Any, right: Any) -> Any:
    """sqrt(left right) + min(left, right); zero where one of both is negative.

    If they are arrays of one shape, the memory of `left` is free for other use afterwards.
    """
    if not (type(left) is type(right) is np.ndarray and left.shape == right.shape):
        return fmax(np.sqrt(left * right) + minimum(left, right), 0.0)
    held = left * right
    np.sqrt(held, out=held)
    held += np.minimum(left, right, out=left)
    if held.size and not held.item(held.argmin()) >= 0:  # or no number
        np.fmax(held, _zeros(held.shape), out=held)
    return held


def _alike(first: Any, second: Any) -> tuple[Any, Any]:
    """Two arrays in place of an array and a number, where that is worth the trouble."""
    if type(first) is np.ndarray and type(second) in _NUMBERS and first.size > _MANY:
        return first, _filled(first.shape, second)
    if type(second) is np.ndarray and type(first) in _NUMBERS and second.size > _MANY:
        return _filled(second.shape, first), second
    return first, second


def _zeros(shape: Shape) -> Any:
    """Nothing but zeros, to be read; as many as are evaluated at once need not be made."""
    size = math.prod(shape)
    if size > _ZEROS.size:
        return np.zeros(shape)
    return _ZEROS[:size] if len(shape) == 1 else _ZEROS[:size].reshape(shape)


def _filled(shape: Shape, number: Any) -> Any:
    if number == 0:
        return _zeros(shape)
    filled = np.empty(shape)
    filled.fill(number)
    return filled


def weighted(weight: Array, value: Array, before: Array = 0.0) -> Array:
    """Sums down the columns, one after the other, added to `before`.

    The same bits however many columns there are, and however many rows at a time.
    """
    terms = weight[:, None] * value
    terms[0] += before
    return np.add.accumulate(terms, axis=0)[-1]


class Flat:
    """Arguments along one dimension, and the way back.

    values     those that are given, by name, then the positive ones: float64, all of one length
    constants  positive numbers; of that length if any varies, else as they are

    Raises TypeError for what is no real number, ValueError for shapes that do not broadcast.
    """

    def __init__(
        self,
        given: Mapping[str, Any],
        constants: Mapping[str, Any],
        positive: Mapping[str, Any] | None = None,
    ) -> None:
        held = {name: _numpy(_float64(value, name)) for name, value in given.items()}
        for name, value in {**(positive or {}), **constants}.items():
            held[name] = np.asarray(_positive(_numpy(_float64(value, name))))
        _broadcast(held)  # what does not is told by its name
        values = [held[name] for name in (*given, *(positive or {}))]
        own = {name: held[name][()] for name in constants}
        self.values, self.constants, self.shape = flattened(values, own)

    def shaped(self, value: Any) -> Any:
        """A result in the shape of the arguments."""
        return value.reshape(self.shape)[()]


def flattened(
    values: Sequence[Any], constants: Mapping[str, Any]
) -> tuple[list[Any], dict[str, Any], Shape]:
    """Arrays along one dimension, constants too if they vary, and the shape they had together."""
    varying = {name: _numpy(v) for name, v in constants.items() if np.ndim(v)}
    values = [_numpy(v) for v in values]
    shape = np.broadcast_shapes(*map(np.shape, (*values, *varying.values())))
    flat = [np.broadcast_to(v, shape).ravel() for v in (*values, *varying.values())]
    own = dict(zip(varying, flat[len(values) :], strict=True))
    return flat[: len(values)], {**constants, **own}, shape


def _numpy(value: Any) -> Any:
    """A number or an array, as a NumPy array.

    Raises TypeError for an array of another library, where elements are solved for one by one.
    """
    if _is_foreign(value):
        raise TypeError(
            "what is solved or integrated takes NumPy and Dask arrays alone, explicit formulas "
            f"others, too; got {type(value).__module__}.{type(value).__name__}"
        )
    return np.asarray(value)


def contact_edges(contact: Any, label: str) -> dict[str, Any]:
    """The edges of a Contact by their names in messages.

    Raises TypeError for what is no Contact.
    """
    try:
        return {f"{label}.a": contact.a, f"{label}.c": contact.c}
    except AttributeError:
        raise TypeError(
            f"{label} must be a Contact, as contact(...) gives it; got {contact!r:.60}"
        ) from None


def at_rows(rows: Any, constants: Mapping[str, Any]) -> dict[str, Any]:
    """The constants of some elements."""
    return {name: v[rows] if np.ndim(v) else v for name, v in constants.items()}


def _numbers(*given: Iterable[Any]) -> Iterator[Any]:
    """What is given, of contacts the edges."""
    for value in chain(*given):
        yield from (value.a, value.c) if hasattr(value, "a") else (value,)


def _is_foreign(value: Any) -> bool:
    """Whether it is an array of another library that follows NumPy's protocols."""
    own = type(value) is np.ndarray or not hasattr(value, "__array_function__")
    return not own and not isinstance(value, np.ndarray | np.generic)


def _positive(value: Any) -> Any:
    """A constant of the material or the geometry, NaN unless it is positive and finite."""
    if type(value) is np.float64:
        return value if 0 < value < np.inf else _NAN
    if type(value) is not np.ndarray and is_lazy(value):
        return value  # each chunk is tested when it is there
    return only_where((value > 0) & (value < np.inf), value)


def _is_of_reals(value: Any) -> bool:
    """Whether it is a NumPy array that holds real numbers of any type."""
    return type(value) is np.ndarray and value.ndim > 0 and value.dtype.kind in "iuf"


def _float64(value: Any, label: str) -> Any:
    """A real number as np.float64, anything else as an array; masked elements are NaN.

    A Dask array is left as it is: each chunk becomes float64 when it is there.
    """
    if type(value) is np.ndarray and value.dtype is _FLOAT64 and value.ndim:
        return value
    if type(value) in _NUMBERS or (type(value) is int and abs(value) < MOST):
        return np.float64(value)
    demand_array(value, label)
    foreign = _is_foreign(value)
    try:
        array = value if foreign else np.asanyarray(value)
        if array.dtype.kind not in "iuf":
            raise TypeError
        if is_lazy(array):
            return array
        with np.errstate(all="ignore"):
            numbers = array.astype(np.float64)
    except (AttributeError, TypeError, ValueError):
        found = f"{type(value).__name__} {value!r:.60}"
        raise TypeError(f"{label} must be a real number or an array of such; got {found}") from None
    return numbers if foreign else np.asarray(np.ma.filled(numbers, np.nan))[()]


def _broadcast(given: Mapping[str, Any]) -> Shape:
    try:
        return np.broadcast_shapes(*map(known_shape, given.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {v.shape}" for name, v in given.items() if v.ndim)
        raise ValueError(
            f"the arguments must broadcast to one shape; their shapes are {shapes}"
        ) from None


def _in_blocks(
    function: Callable[..., Any], given: Mapping[str, Any], shape: Shape, most: int
) -> Any:
    """The result of `function` over the whole of `shape`, block by block."""
    fixed = {name: v for name, v in given.items() if not v.ndim}
    varying = {
        name: v.reshape((1,) * (len(shape) - v.ndim) + v.shape)
        for name, v in given.items()
        if v.ndim
    }
    axes = _axes_in_memory(varying.values(), shape)
    varying = {name: v.transpose(axes) for name, v in varying.items()}
    shape = tuple(shape[axis] for axis in axes)
    kind: Any = None
    out: list[Any] = []
    whole_axes = all(v.shape == shape for v in varying.values())
    for index in _blocks(shape, most):
        parts = {
            name: _float64(v[index] if whole_axes else _part(v, index), name)
            for name, v in varying.items()
        }
        result = function(**fixed, **parts)
        found = result if isinstance(result, tuple) else (result,)
        if not out:
            kind = type(result)
            out = _made_for(found, shape)
        for whole, part in zip(out, found, strict=True):
            if type(part) is _Unscaled:
                part.into(whole[index])
            else:
                whole[index] = part
        del result, found, part  # not to be held while the next are computed
    out = [whole.transpose(np.argsort(axes)) for whole in out]
    return kind(*out) if issubclass(kind, tuple) else out[0]


def _axes_in_memory(varying: Iterable[Any], shape: Shape) -> tuple[int, ...]:
    """Axes of the first array that has them all, from the longest stride to the shortest."""
    strides = next((v.strides for v in varying if v.shape == shape), ())
    return tuple(sorted(range(len(shape)), key=lambda i: -abs(strides[i]) if strides else i))


def _made_for(found: Sequence[Any], shape: Shape) -> list[Any]:
    """Arrays for results of these types; of float64 in one piece of memory, which is cheaper."""
    if all(part.dtype is _FLOAT64 for part in found):
        return [*np.empty((len(found), *shape))]
    return [np.empty(shape, part.dtype) for part in found]


def _part(value: Any, index: tuple[slice, ...]) -> Any:
    """The block of one argument; along an axis of length one it is the same everywhere."""
    whole = slice(None)
    return value[tuple(i if n > 1 else whole for i, n in zip(index, value.shape, strict=True))]


def _blocks(shape: Shape, most: int) -> Iterator[tuple[slice, ...]]:
    """Index tuples that cut `shape` into blocks: whole inner axes, a slice of one, single rows."""
    axis, inner = len(shape) - 1, 1
    while axis > 0 and inner * shape[axis] <= most:
        inner *= shape[axis]
        axis -= 1
    rows = max(1, most // max(1, inner))
    count = max(1, -(-shape[axis] // rows))
    step = max(1, -(-shape[axis] // count))  # as many blocks, none of them short
    rest = (slice(None),) * (len(shape) - 1 - axis)
    outer = [[slice(i, i + 1) for i in range(n)] for n in shape[:axis]]
    for front in product(*outer):
        for start in range(0, max(1, shape[axis]), step):
            yield (*front, slice(start, start + step), *rest)
