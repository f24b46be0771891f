"""Equations of motion of the weight, the rim and the fibre's inner states, for the compiled stepper.

Own forms throughout: dry friction is a bristle that saturates and creeps, strands are unilateral with located
contacts (see `march`), inner states of the fibre ride in the same Runge-Kutta step.
"""

from __future__ import annotations

import math

import numpy as np

from mocks.plant.kept import kernel

# state
U, V, S, W, SLIP, MOUNT, Q1, Q2, Z1, Z2, E1, E2 = range(12)
SIZE = 12
# what `rates` reports besides the derivatives
T1, T2, FORCE, FRICTION, ACCELERATION, RIM_FORCE = range(6)
REPORTS = 6
# contacts
WEIGHT_STRAND, DRIVE_STRAND, HIGH_STOP, LOW_STOP = range(4)
CONTACTS = 4
GUIDE, PATCH, RIM, SPEED = range(4)


@kernel
def look(table, where, low, high):  # type: ignore[no-untyped-def]
    """`table` at `where`, linear between its points, its ends beyond them."""
    place = (where - low) / (high - low) * (table.size - 1)
    i = min(max(int(place), 0), table.size - 2)
    share = min(max(place - i, 0.0), 1.0)
    return table[i] + share * (table[i + 1] - table[i])


@kernel
def relax(bristle, velocity, creep, presliding, dt):  # type: ignore[no-untyped-def]
    """A bristle's deflection (as a share of saturation) after dt at a velocity; steady: tanh(velocity/creep).

    z' = (v - |v|/tanh(|v|/creep) z)/presliding, solved exactly for constant v; creep = 0 sticks for good (Dahl).
    """
    speed = abs(velocity)
    if creep > 0.0:
        share = math.tanh(speed / creep)
        rate = creep if speed < 1e-9 * creep else speed / share
    else:
        share, rate = 1.0, speed
    goal = math.copysign(share, velocity)
    return goal + (bristle - goal) * math.exp(-rate / presliding * dt)


@kernel
def elongations(y, x, p):  # type: ignore[no-untyped-def]
    """Elongation of the weight strand and the drive strand."""
    rim = y[S] + y[SLIP]
    d1, d2 = rim - y[U] + p.rest_stretch / p.share1, x - y[MOUNT] - rim + p.rest_stretch2 / p.share2
    if p.eccentricity != 0.0:
        d1 += p.eccentricity * (math.sin(y[S] / p.radius + p.eccentric_phase) - math.sin(p.eccentric_phase))
    return d1, d2


@kernel
def gap(contact, y, x, p):  # type: ignore[no-untyped-def]
    """How far a contact is closed: positive while its strand is stretched or its stop pressed."""
    if contact == WEIGHT_STRAND:
        return elongations(y, x, p)[0]
    if contact == DRIVE_STRAND:
        return elongations(y, x, p)[1]
    return y[U] - p.stop_high if contact == HIGH_STOP else p.stop_low - y[U]


@kernel
def pull(d, share, y, q, z, e, p):  # type: ignore[no-untyped-def]
    """Tension of a stretched strand without its damper; the strand is 1/share of the fibre."""
    stretch = (d - y[e]) * share  # as the whole fibre would stretch
    over = max(0.0, abs(y[V]) - p.c_threshold)
    tension = (p.c + p.c_slope * over) * stretch * (1.0 + p.hardening * stretch)
    tension += p.maxwell * share * (d - y[q])
    return tension + p.hysteresis * p.yield_elongation * y[z]


@kernel
def guide_force(t, y, tension, bristle, p, tables):  # type: ignore[no-untyped-def]
    """All that the guide does against the weight's motion, N."""
    u, v = y[U], y[V]
    dry = p.friction + 0.5 * p.asymmetry * math.copysign(1.0, bristle)
    if p.stribeck != 0.0:
        dry += p.stribeck * math.exp(-((v / p.stribeck_velocity) ** 2))
    if p.load_friction != 0.0:
        dry += p.load_friction * max(0.0, tension - p.rest_tension) ** 2
    force = 0.0
    if p.tables != 0.0:
        dry += look(tables[PATCH], u, -0.08, 0.28)
        force += look(tables[GUIDE], u, -0.08, 0.28) + look(tables[SPEED], v, -3.0, 3.0)
    if p.fade != 0.0:
        dry += p.fade * math.exp(-t / p.fade_time)
    if p.pulse != 0.0:
        dry *= 1.0 + p.pulse * math.sin(2.0 * math.pi * p.pulse_frequency * t + p.pulse_phase)
    return force + dry * bristle + (p.viscous + p.quadratic * abs(v)) * v + p.spring * u


@kernel
def stop_force(y, contact, p):  # type: ignore[no-untyped-def]
    """Force of the end stops on the weight, N, positive up-slope."""
    force = 0.0
    if contact[HIGH_STOP]:
        force -= max(0.0, p.stop_stiffness * (y[U] - p.stop_high) + p.stop_damping * y[V])
    if contact[LOW_STOP]:
        force += max(0.0, p.stop_stiffness * (p.stop_low - y[U]) - p.stop_damping * y[V])
    return force


@kernel
def fibre_speed(a1, a2, b1, b2, vx, y, lever, p):  # type: ignore[no-untyped-def]
    """Speed of the fibre on the rim: the rim's own, or what keeps T_hi/T_lo at exp(friction wrap) while it slides.

    a1, a2: tensions without dampers, negative infinity where slack (Euler, Eytelwein).
    """
    w = y[W]
    if p.slip <= 0.0:
        return w
    limit = math.exp(p.slip * p.wrap)
    t1, t2 = max(0.0, a1 + b1 * (w * lever - y[V])), max(0.0, a2 + b2 * (vx - w))
    low1, low2 = a1 - b1 * (y[V] + w * (1.0 - lever)), a2 + b2 * vx  # T1 = low1 + b1 f, T2 = low2 - b2 f
    if t2 > limit * t1:
        f = (low2 - limit * low1) / (b2 + limit * b1) if low1 > -1e300 else low2 / b2
        return max(w, min(f, low2 / b2))
    if t1 > limit * t2:
        f = (limit * low2 - low1) / (b1 + limit * b2) if low2 > -1e300 else -low1 / b1
        return min(w, max(f, -low1 / b1))
    return w


@kernel
def inner_rates(y, contact, d1, d2, dd1, dd2, p, report, dy):  # type: ignore[no-untyped-def]
    """Derivatives of the fibre's inner states (Maxwell branch, Bouc-Wen, creep)."""
    for side in range(2):
        d, dd, share = (d1, dd1, p.share1) if side == 0 else (d2, dd2, p.share2)
        if not contact[side]:
            d, dd = 0.0, 0.0
        q, z, e = Q1 + side, Z1 + side, E1 + side
        dy[q] = (d - y[q]) / p.maxwell_time
        dz = dd * share / p.yield_elongation
        dy[z] = dz * (1.0 - abs(y[z]) * (0.5 + math.copysign(0.5, dz * y[z])))
        dy[e] = (p.creep / share * report[T1 + side] - y[e]) / p.creep_time


@kernel
def accelerate(t, y, ax, t1, t2, lever, fibre, bristle, bearing, contact, p, tables, report, dy):  # type: ignore[no-untyped-def]
    """Accelerations of weight and rim; the fibre's own mass couples them (consistent mass of a straight strand)."""
    friction = guide_force(t, y, t1, bristle, p, tables)
    on_weight = t1 - p.mass * p.gravity_along - friction + stop_force(y, contact, p)
    if p.shake != 0.0:
        on_weight -= p.mass * p.shake * math.sin(2.0 * math.pi * p.shake_frequency * t + p.shake_phase)
    rim = t2 - t1 * lever - p.bearing * (t1 + t2) * bearing - p.rim_drag * y[W]
    if p.tables != 0.0:
        rim -= look(tables[RIM], y[S], -0.08, 0.28)
    m11, m12 = p.mass + p.mass1 / 3.0, p.mass1 / 6.0
    m22 = p.rim_mass + p.mass1 / 3.0 + p.mass_arc + p.mass2 / 3.0
    if p.locked != 0.0:
        dy[V], dy[W] = on_weight / m11, 0.0
    else:
        rim -= p.mass2 / 6.0 * ax
        det = m11 * m22 - m12 * m12
        dy[V] = (m22 * on_weight - m12 * rim) / det
        dy[W] = (m11 * rim - m12 * on_weight) / det
    report[FORCE] = t1 if p.locked != 0.0 else t2 + p.mass2 * (ax / 3.0 + dy[W] / 6.0)
    report[FRICTION], report[ACCELERATION], report[RIM_FORCE] = friction, dy[V], rim


@kernel
def rates(t, y, x, vx, ax, bristle, bearing, contact, p, tables, inner, report, dy):  # type: ignore[no-untyped-def]
    """dy = y'(t) with the drive at x, x', x''; contacts and bristles are held. inner: the fibre has inner states."""
    d1, d2 = elongations(y, x, p)
    lever = 1.0
    if p.eccentricity != 0.0:
        lever += p.eccentricity / p.radius * math.cos(y[S] / p.radius + p.eccentric_phase)
    b = p.b + p.b_slope * max(0.0, abs(y[V]) - p.b_threshold)
    b1, b2 = b * p.share1, b * p.share2
    a1 = pull(d1, p.share1, y, Q1, Z1, E1, p) if contact[WEIGHT_STRAND] else -np.inf
    a2 = pull(d2, p.share2, y, Q2, Z2, E2, p) if contact[DRIVE_STRAND] else -np.inf
    f = fibre_speed(a1, a2, b1, b2, vx, y, lever, p)
    dd1, dd2 = f + y[W] * (lever - 1.0) - y[V], vx - f
    t1, t2 = max(0.0, a1 + b1 * dd1), max(0.0, a2 + b2 * dd2)
    if p.compliance > 0.0:
        strand, t2 = (
            (a2 + b2 * dd2 if contact[DRIVE_STRAND] else 0.0),
            max(0.0, p.rest_pull + y[MOUNT] / p.compliance),
        )
        dy[MOUNT] = max(0.0, strand / b2) if t2 == 0.0 else (strand - t2) / b2
        dd2 -= dy[MOUNT]
    report[T1], report[T2] = t1, t2
    dy[U], dy[S], dy[SLIP] = y[V], y[W], f - y[W]
    if inner:
        inner_rates(y, contact, d1, d2, dd1, dd2, p, report, dy)
    accelerate(t, y, ax, t1, t2, lever, f, bristle, bearing, contact, p, tables, report, dy)
