"""The ring's clock: every poll brackets a sample's time from both sides.

A poll that was asked at q and answered by p and found h samples written was read at some time r in [q, p]; sample
h - 1 was taken before r and sample h after it: t(h - 1) <= p and t(h) >= q. With t(k) = offset + k period every poll is
two half-planes; the line farthest from all of them starts the fit. Then r is taken as the bracket's middle, give or
take a logistic error whose scale grows with the bracket, and a share of what the trip took longer than the quickest,
which the polls themselves tell (a busy host reads its answers late, not its questions). The polls that fall near a
sample's edge then weigh in together, as in an ordered logit regression, whose likelihood is concave in offset, period
and share (Pratt 1981).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stand.clock.lines import Line, line_between
from stand.clock.model import Clock

Float = NDArray[np.float64]

#: of the quickest polls the likelihood uses as many as will do, within these shares: what took longer tells little of
#: the clock and much of the host; and the least scale of its error, s
ENOUGH, QUICK = 300, (0.3, 0.6)
FLOOR = 2e-6
#: how far from the middle of what a trip took too long the read may well be, as a share of it: 1/2 is its end
SIDED = 0.25
#: stretches of a run whose lines are compared
STRETCHES = 6
#: periods without a new sample after which the ring is taken to stand
STILL = 2.5


def fit_ring(
    heads: NDArray[np.int64],
    request: Float,
    response: Float,
    period: float,
    latency: float,
    latency_sigma: float,
    *,
    judged: bool = False,
) -> Clock:
    """The clock from polls: heads [k] samples written, request and response times s [k].

    judged: its sigma also covers how unsteady the legs were, which takes some milliseconds to find.
    """
    alive = moving(heads, request, period)
    heads, request, response = heads[alive], request[alive], response[alive]
    h = heads.astype(np.float64)
    start = line_between(h, request, h - 1, response, period)
    line, fit_sigma, brackets = refine(start, h, request, response)
    if judged:
        fit_sigma = float(np.hypot(fit_sigma, brackets.unsteadiness()))
    residual = float(np.median(response - line.at(h - 1)))
    sigma = float(np.hypot(fit_sigma, latency_sigma))
    drift = period / line.slope - 1
    return Clock(line.intercept - latency, line.slope, drift, residual, fit_sigma, sigma, latency, "ring")


def moving(heads: NDArray[np.int64], request: Float, period: float) -> NDArray[np.bool_]:
    """Which polls met a ring that was being written; one that stands (not yet or no longer fed) has no clock."""
    stands = (np.diff(heads) == 0) & (np.diff(request) > STILL * period)
    alive = ~(np.append(stands, False) | np.append(False, stands))
    return alive if np.count_nonzero(alive) >= 10 else np.ones(len(heads), dtype=np.bool_)


def refine(start: Line, h: Float, request: Float, response: Float) -> tuple[Line, float, _Brackets]:
    """The likeliest line, by Newton's method from `start`, one sigma of its values at the ends s, and its polls."""
    trip = response - request
    quick = trip <= np.quantile(trip, float(np.clip(ENOUGH / len(trip), *QUICK)))
    h, middle, trip = h[quick], (request + response)[quick] / 2, trip[quick]
    excess = trip - trip.min()
    scale = FLOOR + 0.25 * excess
    centre, reach = float(h.mean()), max(float(np.ptp(h)) / 2, 1.0)
    z = (h - centre) / reach
    base = start.at(h) - middle
    brackets = _Brackets(base - start.slope, base, z - 1 / reach, z, excess, scale)
    shift, hessian = _likeliest(brackets, 2 * float(np.median(scale)))
    slope = start.slope + float(shift[1]) / reach
    intercept = start.intercept + float(shift[0]) - float(shift[1]) * centre / reach
    covariance = np.linalg.inv(-hessian)
    sigma = float(np.sqrt(covariance[0, 0] + covariance[1, 1]))
    return Line(intercept, slope, start.margin), sigma, brackets.moved(shift)


@dataclass(frozen=True)
class _Brackets:
    """Polls [k]: from each middle to the samples below and above it s, their places -1..1, excess of the trip and the
    error's scale, s."""

    below: Float
    above: Float
    place_below: Float
    place_above: Float
    excess: Float
    scale: Float

    def judge(self, shift: Float) -> tuple[float, Float, Float]:
        """log P(t(h - 1) < r < t(h)), its gradient [3] and Hessian [3, 3] in the shift.

        shift: of the line's centre and end, s, and of the read within what a trip took longer than the quickest
        (0: in the middle, -1/2: the answer alone was late).
        """
        ones = np.ones(len(self.scale))
        low = np.stack((ones, self.place_below, -self.excess), axis=1) / self.scale[:, None]
        high = np.stack((ones, self.place_above, -self.excess), axis=1) / self.scale[:, None]
        a, b = self.below / self.scale + low @ shift, self.above / self.scale + high @ shift
        fa, fb = _logistic(a), _logistic(b)
        # log(F(b) - F(a)) = log F(b) + log(1 - F(a)) + log(1 - exp(a - b))
        gap = -np.expm1(np.minimum(a - b, -1e-9))
        value = float(np.sum(np.log(np.maximum(fb, 1e-300)) + np.log(np.maximum(1 - fa, 1e-300)) + np.log(gap)))
        gradient = high.T @ (1 - fb) - low.T @ fa
        hessian = -(high.T * (fb * (1 - fb))) @ high - (low.T * (fa * (1 - fa))) @ low
        weak = np.array([1e-6 / float(self.scale.min()) ** 2] * 2 + [1 / SIDED**2])
        value -= 0.5 * float(weak[2] * shift[2] ** 2)
        gradient[2] -= weak[2] * shift[2]
        return value, gradient, hessian - np.diag(weak)

    def moved(self, shift: Float) -> _Brackets:
        """The same seen from the line moved by `shift`."""
        late = shift[0] - self.excess * shift[2]
        below, above = self.below + late + self.place_below * shift[1], self.above + late + self.place_above * shift[1]
        return replace(self, below=below, above=above)

    def unsteadiness(self) -> float:
        """One sigma of what moves the line from stretch to stretch of the run beyond chance, s.

        Where one leg of the trips grows with the host's load for seconds, each stretch has a line of its own.
        """
        found = np.array([self._level(part) for part in np.array_split(np.argsort(self.place_above), STRETCHES)])
        excess = np.mean(found[:, 0] ** 2) * STRETCHES / (STRETCHES - 2) - np.mean(found[:, 1] ** 2)
        return float(np.sqrt(max(0.0, excess)))

    def _level(self, part: NDArray[np.int64]) -> tuple[float, float]:
        """Where these polls alone put the line against where it is, and one sigma of that, s."""
        scale = self.scale[part, None]
        shifts = np.linspace(-1.0, 1.0, 201) * 4.0 * float(np.median(scale))
        low, high = (self.below[part, None] + shifts) / scale, (self.above[part, None] + shifts) / scale
        likely = np.sum(np.log(np.maximum(_logistic(high) - _logistic(low), 1e-300)), axis=0)
        weight = np.exp(likely - likely.max())
        weight /= weight.sum()
        mean = float(weight @ shifts)
        return mean, float(np.sqrt(weight @ (shifts - mean) ** 2))


def _likeliest(brackets: _Brackets, longest: float) -> tuple[Float, Float]:
    """The shift of greatest likelihood and the Hessian there, by Newton steps of at most `longest` s."""
    shift = np.zeros(3)
    value, gradient, hessian = brackets.judge(shift)
    for _ in range(40):
        step = -np.linalg.solve(hessian, gradient)
        step *= min(1.0, longest / max(float(np.abs(step[:2]).max()), 1e-12))
        for _ in range(20):
            trial, g, hess = brackets.judge(shift + step)
            if trial >= value:
                break
            step = step / 2
        shift, value, gradient, hessian = shift + step, trial, g, hess
        if float(np.abs(step[:2]).max()) < 1e-9:
            break
    return shift, hessian


def _logistic(x: Float) -> Float:
    out: Float = 0.5 * (1 + np.tanh(0.5 * x))
    return out
