"""Band matrices, LU without pivoting (the mass keeps the diagonal heavy), for half band widths known when compiled.

a[i, k + j - i] holds the element (i, j), |i - j| <= k, for i < n; both the matrix and the right-hand side carry k
rows of padding behind the last unknown so that no loop has an edge.
"""

from __future__ import annotations

from twin.kernels.jit import part

_FAST = {"contract", "reassoc", "nsz", "arcp"}


def _factor(a, n, k):  # type: ignore[no-untyped-def]
    for i in range(n):
        pivot = 1.0 / a[i, k]
        a[i, k] = pivot
        for down in range(1, k + 1):
            scale = a[i + down, k - down] * pivot
            a[i + down, k - down] = scale
            for j in range(1, k + 1):
                a[i + down, k - down + j] -= scale * a[i, k + j]


def _solve(a, b, n, k):  # type: ignore[no-untyped-def]
    for i in range(n):
        value = b[i]
        for down in range(1, k + 1):
            b[i + down] -= a[i + down, k - down] * value
    for i in range(n - 1, -1, -1):
        total = b[i]
        for j in range(1, k + 1):
            total -= a[i, k + j] * b[i + j]
        b[i] = total * a[i, k]


_factor_any = part(_factor, fastmath=_FAST, inline="always")
_solve_any = part(_solve, fastmath=_FAST, inline="always")


@part(fastmath=_FAST)
def factor(a, n, k):  # type: ignore[no-untyped-def]
    """LU in place, the pivots inverted; the padding is overwritten. k: 3, 5 or 7."""
    for i in range(n, n + k):
        for j in range(2 * k + 1):
            a[i, j] = 0.0
    if k == 3:
        _factor_any(a, n, 3)
    elif k == 5:
        _factor_any(a, n, 5)
    else:
        _factor_any(a, n, 7)


@part(fastmath=_FAST)
def solve(a, b, n, k):  # type: ignore[no-untyped-def]
    """Solve with the factors of `factor`; b is overwritten by the solution, its padding by zeros."""
    for i in range(n, n + k):
        b[i] = 0.0
    if k == 3:
        _solve_any(a, b, n, 3)
    elif k == 5:
        _solve_any(a, b, n, 5)
    else:
        _solve_any(a, b, n, 7)
