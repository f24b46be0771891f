"""Band matrices with one bordering row and column, LU without pivoting (the mass keeps the diagonal heavy)."""

from __future__ import annotations

from twin.kernels.jit import compiler

compiled = compiler("fibre")


@compiled("void(float64[:,::1], int64, int64)")
def factor(a, n, k):  # type: ignore[no-untyped-def]
    """LU in place; a[i, k + j - i] holds the element (i, j) for |i - j| <= k."""
    for i in range(n):
        pivot = 1.0 / a[i, k]
        for row in range(i + 1, min(i + k + 1, n)):
            first = k + i - row
            scale = a[row, first] * pivot
            a[row, first] = scale
            if scale != 0.0:
                for j in range(1, k + 1):
                    a[row, first + j] -= scale * a[i, k + j]


@compiled("void(float64[:,::1], float64[::1], int64, int64)")
def solve(a, b, n, k):  # type: ignore[no-untyped-def]
    """Solve with the factors of `factor`; b is overwritten by the solution."""
    for i in range(1, n):
        total = b[i]
        for j in range(max(0, i - k), i):
            total -= a[i, k + j - i] * b[j]
        b[i] = total
    for i in range(n - 1, -1, -1):
        total = b[i]
        for j in range(i + 1, min(i + k + 1, n)):
            total -= a[i, k + j - i] * b[j]
        b[i] = total / a[i, k]
