"""A tight reference of the force model, written once more from the balances: DOP853 between located switches."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from scipy.integrate import solve_ivp

from stand.setup import Setup


def trapezoid(
    seconds: float, stroke: float, frequency: float, acceleration: float, *, phase: float = 0.5, ramp: float = 0.125
) -> np.ndarray:
    """x and x' of a trapezoidal motion at 2 kHz, [n, 2]: ramps of bounded acceleration between holds."""
    time = np.arange(round(seconds * 2000) + 1) / 2000.0
    half, table = 0.5 / frequency, np.zeros((len(time), 2))
    pulse = (ramp - math.sqrt(ramp**2 - 4.0 * stroke / acceleration)) / 2.0
    top = acceleration * pulse
    for i, t in enumerate(time - phase):
        if t < 0:
            continue
        n, r = divmod(t, half)
        s = stroke if r >= ramp else _ramp(r, pulse, ramp, acceleration)
        v = 0.0 if r >= ramp else min(acceleration * r, top, acceleration * (ramp - r))
        table[i] = (s, v) if n % 2 == 0 else (stroke - s, -v)
    return table


def _ramp(r: float, pulse: float, ramp: float, a: float) -> float:
    top, stroke = a * pulse, a * pulse * (ramp - pulse)
    if r < pulse:
        return 0.5 * a * r * r
    if r < ramp - pulse:
        return 0.5 * a * pulse**2 + top * (r - pulse)
    return stroke - 0.5 * a * (ramp - r) ** 2


def sinusoid(seconds: float, stroke: float, frequency: float) -> np.ndarray:
    """x and x' of (1 - cos) stroke/2 at 2 kHz, [n, 2]."""
    time = np.arange(round(seconds * 2000) + 1) / 2000.0
    w = 2.0 * math.pi * frequency
    return np.column_stack((0.5 * stroke * (1.0 - np.cos(w * time)), 0.5 * stroke * w * np.sin(w * time)))


class Reference:
    """Steps the balances sample by sample and switch by switch; constant c and b, or growing with speed."""

    def __init__(self, setup: Setup, *, threshold: float = math.inf, damping_slope: float = 0.0) -> None:
        self.s, self.threshold, self.slope = setup, threshold, damping_slope
        length = setup.free_length
        self.r1, self.r2 = length / setup.weight_strand_length, length / setup.drive_strand_length
        self.mu = setup.pulley_inertia / setup.pulley_radius**2
        self.rest = setup.mass * setup.gravity * math.sin(setup.incline_angle)

    def strands(self, y: np.ndarray, x: float, w: float) -> tuple[float, float, float, float]:
        """Stretches and tensions (unclipped) of both strands."""
        s = self.s
        b = s.fibre_damping + max(0.0, abs(y[1]) - self.threshold) * self.slope
        d1 = y[2] - y[0] + self.rest / (s.fibre_stiffness * self.r1)
        d2 = x - y[2] + self.rest / (s.fibre_stiffness * self.r2)
        t1 = self.r1 * (s.fibre_stiffness * d1 + b * (y[3] - y[1]))
        t2 = self.r2 * (s.fibre_stiffness * d2 + b * (w - y[3]))
        return d1, t1, d2, t2

    def run(self, table: np.ndarray, dt: float = 5e-4, rtol: float = 1e-12) -> np.ndarray:
        """u, u', F at samples 1..n."""
        y, taut, out = np.zeros(4), [True, True], []
        for i in range(len(table) - 1):
            y, taut = self._sample(y, taut, table[i], table[i + 1], dt, rtol)
            _, _, _, t2 = self.strands(y, table[i + 1, 0], table[i + 1, 1])
            out.append((y[0], y[1], max(0.0, t2) if taut[1] else 0.0))
        return np.array(out)

    def _sample(self, y, taut, a, b, dt, rtol):
        h = b[0] - a[0]
        c = (a[0], a[1] * dt, 3 * h - dt * (2 * a[1] + b[1]), dt * (a[1] + b[1]) - 2 * h)

        def drive(t: float) -> tuple[float, float]:
            p = t / dt
            return c[0] + p * (c[1] + p * (c[2] + p * c[3])), (c[1] + p * (2 * c[2] + 3 * p * c[3])) / dt

        at = 0.0
        while at < dt * (1 - 1e-15):
            t1, t2 = taut

            def rhs(t: float, y: np.ndarray, t1: bool = t1, t2: bool = t2) -> list[float]:
                _, p, _, q = self.strands(y, *drive(t))
                p, q = p if t1 else 0.0, q if t2 else 0.0
                s = self.s
                dry = s.guide_friction * math.tanh(y[1] / s.guide_friction_velocity)
                return [y[1], (p - self.rest - dry) / s.mass, y[3], (q - p) / self.mu]

            def margin(t: float, y: np.ndarray, which: int, taut: list[bool] = taut) -> float:
                d1, p, d2, q = self.strands(y, *drive(t))
                d, f = ((d1, p), (d2, q))[which]
                return f if taut[which] else -min(d, f * 1e-4)

            events = [partial(margin, which=0), partial(margin, which=1)]
            for event in events:  # scipy reads these attributes
                event.terminal, event.direction = True, -1
            done = solve_ivp(rhs, (at, dt), y, "DOP853", rtol=rtol, atol=1e-15, events=events)
            y, last = done.y[:, -1], at
            at = float(done.t[-1])
            if done.status == 1:
                which = 0 if len(done.t_events[0]) else 1
                taut = [taut[0] ^ (which == 0), taut[1] ^ (which == 1)]
                if at == last:
                    raise RuntimeError("the reference chatters")
        return y, taut
