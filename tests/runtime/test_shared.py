"""Formulas that kernels call as they stand."""

import inspect
from typing import Any

import numpy as np

from generated.runtime.elementary import where
from generated.runtime.kernels import kernel, real
from generated.runtime.shared import by_position, shared


@shared
def _root_sum(a: Any, c: Any) -> Any:
    return np.sqrt(a + c) + where(a > c, a, c)


def _keyword(a: Any, *, R: Any) -> Any:
    return a / R


_by_position = by_position(_keyword)


@kernel(real(real, real))
def _both(a: Any, c: Any) -> Any:
    return _root_sum(a, c) + _by_position(a, c)


def test_a_kernel_calls_what_is_shared() -> None:
    assert _both(3.0, 1.0) == 2.0 + 3.0 + 3.0


def test_python_calls_it_too_with_arrays() -> None:
    np.testing.assert_array_equal(_root_sum(np.array([3.0, 1.0]), np.array([1.0, 3.0])), [5, 5])


def test_by_position_takes_keywords_in_their_order() -> None:
    assert [*inspect.signature(_by_position).parameters] == ["a", "R"]
    assert _by_position(3.0, 2.0) == 1.5
    assert _keyword(3.0, R=2.0) == 1.5
