"""The ring's clock: every poll brackets a sample's time from both sides.

A poll that was asked at q and answered by p and found h samples written was read at some time r in [q, p]; sample
h - 1 was taken before r and sample h after it: t(h - 1) <= p and t(h) >= q. With t(k) = offset + k period every poll is
two half-planes; the line farthest from all of them starts the fit. Then r is taken as the bracket's middle, give or
take a logistic error whose scale grows with the bracket: the polls that fall near a sample's edge then weigh in
together, as in an ordered logit regression, whose likelihood is concave in offset and period (Pratt 1981).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stand.clock.lines import Line, line_between
from stand.clock.model import Clock

Float = NDArray[np.float64]

#: share of the quickest polls that the likelihood uses, and the least scale of its error, s
QUICK = 0.6
FLOOR = 2e-6
#: periods without a new sample after which the ring is taken to stand
STILL = 2.5


def fit_ring(
    heads: NDArray[np.int64], request: Float, response: Float, period: float, latency: float, latency_sigma: float
) -> Clock:
    """The clock from polls: heads [k] samples written, request and response times s [k]."""
    alive = moving(heads, request, period)
    heads, request, response = heads[alive], request[alive], response[alive]
    h = heads.astype(np.float64)
    start = line_between(h, request, h - 1, response, period)
    line, fit_sigma = refine(start, h, request, response)
    residual = float(np.median(response - line.at(h - 1)))
    sigma = float(np.hypot(fit_sigma, latency_sigma))
    drift = period / line.slope - 1
    return Clock(line.intercept - latency, line.slope, drift, residual, fit_sigma, sigma, latency, "ring")


def moving(heads: NDArray[np.int64], request: Float, period: float) -> NDArray[np.bool_]:
    """Which polls met a ring that was being written; one that stands (not yet or no longer fed) has no clock."""
    stands = (np.diff(heads) == 0) & (np.diff(request) > STILL * period)
    alive = ~(np.append(stands, False) | np.append(False, stands))
    return alive if np.count_nonzero(alive) >= 10 else np.ones(len(heads), dtype=np.bool_)


def refine(start: Line, h: Float, request: Float, response: Float) -> tuple[Line, float]:
    """The likeliest line, by Newton's method from `start`, and one sigma of its values at the ends, s."""
    trip = response - request
    quick = trip <= np.quantile(trip, QUICK)
    h, middle, trip = h[quick], (request + response)[quick] / 2, trip[quick]
    scale = FLOOR + 0.25 * (trip - trip.min())
    centre, reach = float(h.mean()), max(float(np.ptp(h)) / 2, 1.0)
    z = (h - centre) / reach
    base = start.at(h) - middle
    below = base - start.slope
    shift = np.zeros(2)
    value, gradient, hessian = _likelihood(shift, z, below, base, scale, reach)
    for _ in range(40):
        step = -np.linalg.solve(hessian, gradient)
        step *= min(1.0, float(np.median(scale)) * 2 / max(float(np.abs(step).max()), 1e-12))
        trial, g, hess = _likelihood(shift + step, z, below, base, scale, reach)
        for _ in range(20):
            if trial >= value:
                break
            step = step / 2
            trial, g, hess = _likelihood(shift + step, z, below, base, scale, reach)
        shift, value, gradient, hessian = shift + step, trial, g, hess
        if float(np.abs(step).max()) < 1e-9:
            break
    slope = start.slope + float(shift[1]) / reach
    intercept = start.intercept + float(shift[0]) - float(shift[1]) * centre / reach
    covariance = np.linalg.inv(-hessian)
    sigma = float(np.sqrt(covariance[0, 0] + covariance[1, 1]))
    return Line(intercept, slope, start.margin), sigma


def _likelihood(
    shift: Float, z: Float, below: Float, above: Float, scale: Float, reach: float
) -> tuple[float, Float, Float]:
    """log P(t(h - 1) < r < t(h)), its gradient [2] and Hessian [2, 2] in the shift of centre and end, s."""
    zl = z - 1 / reach
    a = (below + shift[0] + shift[1] * zl) / scale
    b = (above + shift[0] + shift[1] * z) / scale
    fa, fb = _logistic(a), _logistic(b)
    # log(F(b) - F(a)) = log F(b) + log(1 - F(a)) + log(1 - exp(a - b))
    gap = -np.expm1(np.minimum(a - b, -1e-9))
    value = float(np.sum(np.log(np.maximum(fb, 1e-300)) + np.log(np.maximum(1 - fa, 1e-300)) + np.log(gap)))
    da, db = -fa / scale, (1 - fb) / scale
    ha, hb = fa * (1 - fa) / scale**2, fb * (1 - fb) / scale**2
    gradient = np.array([np.sum(da + db), np.sum(da * zl + db * z)])
    cross = -np.sum(ha * zl + hb * z)
    hessian = np.array([[-np.sum(ha + hb), cross], [cross, -np.sum(ha * zl * zl + hb * z * z)]])
    return value, gradient, hessian - np.eye(2) * 1e-6 / float(scale.min()) ** 2


def _logistic(x: Float) -> Float:
    out: Float = 0.5 * (1 + np.tanh(0.5 * x))
    return out
