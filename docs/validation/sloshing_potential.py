"""Nonlinear potential flow in a tank that is shaken sideways, for the case *sloshing, finite depth*.

    python3 docs/validation/sloshing_potential.py [AMPLITUDE ...]      (needs numpy)

The amplitudes are in m; 0.032 without an argument. The tank is 1.73 m long with 0.6 m of water, and is at A cos(2 pi t / 1.3 s)
after t = 0, where the water is at rest. Prints the crests 0.05 m from the wall.

Elevation and surface potential are cosine series in x. The vertical velocity at the surface is an expansion in the elevation
(B. West et al., J. Geophys. Res. 92 (1987) 11803-11824; D. Dommermuth and D. Yue, J. Fluid Mech. 184 (1987) 267-288). Integrated
in time by a Runge-Kutta method. The first two crests differ by 1 % between the orders 3, 4 and 5 and between 6 and 12 modes.
"""

import math
import sys

import numpy as np

LENGTH, DEPTH, PERIOD, GRAVITY, GAUGE = 1.73, 0.6, 1.3, 9.81, 0.05
ORDER, MODES, POINTS = 5, 12, 64

X = (np.arange(POINTS) + 0.5) * LENGTH / POINTS
K = np.arange(MODES) * math.pi / LENGTH
COS, SLOPES = np.cos(np.outer(X, K)), -np.sin(np.outer(X, K)) * K
# From values at the points to coefficients.
COEFFICIENTS = 2.0 / POINTS * COS.T
COEFFICIENTS[0] *= 0.5


def smooth(values):
    return COS @ (COEFFICIENTS @ values)


def along(values):
    return SLOPES @ (COEFFICIENTS @ values)


def vertical(coefficients, order):
    """The derivative of this order along y at the mean level."""
    return COS @ (coefficients * K**order * (np.tanh(K * DEPTH) if order % 2 else 1.0))


def vertical_velocity(elevation, potential):
    powers = [elevation**n / math.factorial(n) for n in range(ORDER + 1)]
    parts, total = [], 0.0
    for m in range(ORDER):
        if m == 0:
            rest = potential
        else:
            rest = -sum(powers[n] * vertical(parts[m - n], n) for n in range(1, m + 1))
        parts.append(COEFFICIENTS @ rest)
        total = total + sum(powers[n] * vertical(parts[m - n], n + 1) for n in range(m + 1))
    return total


def rate(state, push):
    elevation, potential = state
    w, slope, speed = vertical_velocity(elevation, potential), along(elevation), along(potential)
    return np.array(
        [
            smooth(-slope * speed + (1.0 + slope**2) * w),
            smooth(
                -GRAVITY * elevation
                - 0.5 * speed**2
                + 0.5 * (1.0 + slope**2) * w**2
                + push * (X - 0.5 * LENGTH)
            ),
        ]
    )


def shake(amplitude, until=9.9, dt=0.005):
    """Times, and elevations at the gauge."""
    omega = 2.0 * math.pi / PERIOD
    push = lambda t: amplitude * omega**2 * math.cos(omega * t)
    gauge = np.cos(K * GAUGE) @ COEFFICIENTS
    state, rows = np.zeros((2, POINTS)), []
    for step in range(round(until / dt)):
        t = step * dt
        a = rate(state, push(t))
        b = rate(state + 0.5 * dt * a, push(t + 0.5 * dt))
        c = rate(state + 0.5 * dt * b, push(t + 0.5 * dt))
        d = rate(state + dt * c, push(t + dt))
        state = state + dt / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        rows.append((t + dt, gauge @ state[0]))
    return np.array(rows)


def main():
    for amplitude in [float(word) for word in sys.argv[1:]] or [0.032]:
        rows = shake(amplitude)
        for low, high in [(0.6, 1.6), (2.2, 3.0), (3.5, 4.5), (7.3, 8.2), (8.8, 9.6)]:
            inside = rows[(rows[:, 0] > low) & (rows[:, 0] < high)]
            t, crest = inside[np.argmax(inside[:, 1])]
            print(f"amplitude {amplitude} m: crest of {crest:.4f} m at {t:.2f} s")


main()
