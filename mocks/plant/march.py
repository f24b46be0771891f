"""Carries a stand through time: fourth-order Runge-Kutta in small fixed steps, contacts located within a step,
bristles of dry friction relaxed exactly in half-steps on both sides of it (Strang's splitting)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocks.plant.forces import (
    ACCELERATION,
    CONTACTS,
    E1,
    E2,
    FORCE,
    FRICTION,
    Q1,
    Q2,
    REPORTS,
    SIZE,
    T1,
    T2,
    S,
    U,
    V,
    W,
    gap,
    rates,
    relax,
)
from mocks.plant.kept import kernel
from mocks.plant.physics import Physics

#: columns of what `march` writes at each grid point
COLUMNS = ("x", "drive_speed", "u", "v", "s", "w", "F", "T1", "T2", "friction", "acceleration")
CHATTER = 30  # contacts closed within a grid interval, beyond which each takes some time
LOCATING = 4  # secant steps that place a contact within a step


@kernel
def drive_at(drive, i, share, dt, out):  # type: ignore[no-untyped-def]
    """x, x', x'' at a share of grid interval i: cubic Hermite through positions and speeds."""
    x0, v0, x1, v1 = drive[i, 0], drive[i, 1] * dt, drive[i + 1, 0], drive[i + 1, 1] * dt
    c2, c3 = 3.0 * (x1 - x0) - 2.0 * v0 - v1, 2.0 * (x0 - x1) + v0 + v1
    out[0] = x0 + share * (v0 + share * (c2 + share * c3))
    out[1] = (v0 + share * (2.0 * c2 + 3.0 * share * c3)) / dt
    out[2] = (2.0 * c2 + 6.0 * share * c3) / (dt * dt)


@kernel
def relax_both(y, ahead, bristles, h, p):  # type: ignore[no-untyped-def]
    """Guide's and bearing's bristles after h; `ahead` times the last accelerations is added to their speeds."""
    v, w = y[V] + ahead * bristles[2], y[W] + ahead * bristles[3]
    bristles[0] = relax(bristles[0], v, p.friction_velocity, p.presliding, h)
    if p.bearing > 0.0:
        bristles[1] = relax(bristles[1], w, p.bearing_creep, p.bearing_presliding, h)


@kernel
def runge_kutta(y, t, h, drive, i, start, dt, z, contact, p, tables, size, work, report):  # type: ignore[no-untyped-def]
    """One step of h from a share `start` of grid interval i into work[0]; work: float64 [7, SIZE]."""
    stage, at = work[5], work[6]
    for k in range(4):
        part = 0.0 if k == 0 else (1.0 if k == 3 else 0.5)
        for j in range(size):
            stage[j] = y[j] + (part * h * work[k, j] if k > 0 else 0.0)
        for j in range(size, SIZE):
            stage[j] = y[j]
        drive_at(drive, i, start + part * h / dt, dt, at)
        rates(t + part * h, stage, at[0], at[1], at[2], z[0], z[1], contact, p, tables, size > 6, report, work[k + 1])
    for j in range(SIZE):
        work[0, j] = y[j]
    for j in range(size):
        work[0, j] += h / 6.0 * (work[1, j] + 2.0 * (work[2, j] + work[3, j]) + work[4, j])


@kernel
def step(y, t, h, drive, i, start, dt, z, half, contact, p, tables, size, work, report):  # type: ignore[no-untyped-def]
    """Friction's half-step, then Runge-Kutta into work[0]; y stays as it is, `half` holds the bristles."""
    half[:] = z
    relax_both(y, 0.5 * h, half, 0.5 * h, p)
    runge_kutta(y, t, h, drive, i, start, dt, half, contact, p, tables, size, work, report)


@kernel
def first_contact(y, end, x0, x1, contact, p):  # type: ignore[no-untyped-def]
    """The open contact that closes first between two states, and the share of the step at which; (-1, 1) if none."""
    which, share = -1, 1.0
    for k in range(CONTACTS):
        if contact[k]:
            continue
        after = gap(k, end, x1, p)
        if after > 0.0:
            before = min(gap(k, y, x0, p), 0.0)
            here = before / (before - after)
            if which < 0 or here < share:
                which, share = k, here
    return which, share


@kernel
def locate(which, share, y, t, h, drive, i, start, dt, z, half, contact, p, tables, size, work, report):  # type: ignore[no-untyped-def]
    """Steps to where contact `which` closes (result in work[0]); the share of h that it took. Regula falsi."""
    at = work[6]
    drive_at(drive, i, start, dt, at)
    low, high = 0.0, 1.0
    g_low, g_high = min(gap(which, y, at[0], p), 0.0), 0.0
    for _ in range(LOCATING):
        step(y, t, share * h, drive, i, start, dt, z, half, contact, p, tables, size, work, report)
        drive_at(drive, i, start + share * h / dt, dt, at)
        g = gap(which, work[0], at[0], p)
        if abs(g) < 1e-13 or g_low == 0.0:
            break
        if g > 0.0:
            high, g_high = share, g
        else:
            low, g_low = share, g
        share = low + (high - low) * g_low / (g_low - g_high) if g_high > 0.0 else 0.5 * (1.0 + share)
    return share


@kernel
def march(t, y, z, contact, drive, dt, p_record, tables, size, out):  # type: ignore[no-untyped-def]
    """Carries y, z and contacts [4] (all in place) over len(out) grid intervals of dt; out [n, 11].

    z: float64 [4], guide's and bearing's bristles, the last accelerations of weight and rim. drive: float64 [n + 1, 2],
    x and x' at the grid points. Returns the time at the end.
    """
    p = p_record[0]
    work, report, half = np.zeros((7, SIZE)), np.zeros(REPORTS), np.zeros(4)
    at, dy = np.zeros(3), np.zeros(SIZE)
    for i in range(len(out)):
        passed, closed = 0.0, 0
        while passed < dt * (1.0 - 1e-9):
            h, start = min(p.step, dt - passed), passed / dt
            step(y, t + passed, h, drive, i, start, dt, z, half, contact, p, tables, size, work, report)
            drive_at(drive, i, start, dt, at)
            x0 = at[0]
            drive_at(drive, i, (passed + h) / dt, dt, at)
            which, share = first_contact(y, work[0], x0, at[0], contact, p)
            if which >= 0:
                share = locate(
                    which, share, y, t + passed, h, drive, i, start, dt, z, half, contact, p, tables, size, work, report
                )
                closed += 1  # a contact that a sliding fibre opens and closes without end must not stop the clock
                h = max(share * h, 1e-12 if closed < CHATTER else 0.02 * p.step)
                contact[which] = True
            y[:] = work[0]
            z[:] = half
            relax_both(y, 0.0, z, 0.5 * h, p)
            z[2], z[3] = work[4, V], work[4, W]
            passed += h
            drive_at(drive, i, passed / dt, dt, at)
            for k in range(CONTACTS):
                if contact[k] and k != which and gap(k, y, at[0], p) <= 0.0:
                    contact[k] = False
        t += dt
        drive_at(drive, i, 1.0, dt, at)
        rates(t, y, at[0], at[1], at[2], z[0], z[1], contact, p, tables, size > 6, report, dy)
        row = out[i]
        row[0], row[1], row[2], row[3], row[4], row[5] = at[0], at[1], y[U], y[V], y[S], y[W]
        row[6], row[7], row[8], row[9], row[10] = (
            report[FORCE],
            report[T1],
            report[T2],
            report[FRICTION],
            report[ACCELERATION],
        )
    return t


@kernel
def servo(state, targets, dt, bandwidth, limit, out):  # type: ignore[no-untyped-def]
    """The drive's position loop: state [x, x'] towards each target (x, x', x'') in turn; out [n, 2].

    Critically damped about the target with feed-forward of speed and acceleration; |x''| <= limit.
    """
    x, v = state[0], state[1]
    k, d = bandwidth * bandwidth, 2.0 * bandwidth
    for i in range(len(out)):
        a = targets[i, 2] + k * (targets[i, 0] - x) + d * (targets[i, 1] - v)
        a = min(max(a, -limit), limit)
        x += dt * (v + 0.5 * dt * a)
        v += dt * a
        out[i, 0], out[i, 1] = x, v
    state[0], state[1] = x, v


def rest_state(physics: Physics) -> NDArray[np.float64]:
    """State of the stand hanging at rest with the drive at zero, float64 [SIZE]."""
    y = np.zeros(SIZE)
    p = physics
    y[Q1], y[E1] = p.rest_stretch / p.share1, p.creep * p.rest_tension / p.share1
    y[Q2], y[E2] = p.rest_stretch2 / p.share2, p.creep * p.rest_pull / p.share2
    return y
