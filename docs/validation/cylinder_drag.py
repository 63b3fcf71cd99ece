"""Drag of a circular cylinder that starts to move through a viscous fluid at rest, without bound.

    python3 docs/validation/cylinder_drag.py 100 [40 ...]      (needs numpy)

The reference of `tests/physics/drag.rs`. Units: diameter and speed are one. The speed grows as sin^2(pi t / 2) until t = 1
and is then constant. Vorticity w and stream function psi of the symmetric half, in polar coordinates with r = exp(xi) / 2:

    r^2 dw/dt + dpsi/dtheta dw/dxi - dpsi/dxi dw/dtheta = (1 / Re) (d2w/dxi2 + d2w/dtheta2)
    d2psi/dxi2 + d2psi/dtheta2 = -r^2 w

The stream function is a sine series in theta, with one tridiagonal system per mode and the exact condition of a potential
flow at the outer boundary. The vorticity at the wall follows from the stream function (Thom). Integrated in time by Heun's method.
Control: at Re = 40 the drag decreases to the steady 1.522 of Dennis and Chang (1970), for example 1.54 at t = 30.
"""

import sys

import numpy as np


def drag(reynolds, until, radial=160, angular=96, extent=3.2):
    """Times and drag coefficients, and the part of friction."""
    step = extent / radial
    xi = step * np.arange(radial + 1)
    r = 0.5 * np.exp(xi)[:, None]
    theta = np.pi * np.arange(angular + 1) / angular
    turn = np.pi / angular
    modes = np.arange(1, angular)
    sines = np.sin(np.outer(modes, theta[1:-1]))
    # Thomas algorithm for all modes at once: psi = 0 at the wall, psi' = -n psi of the perturbation outside.
    inner = np.full((radial, angular - 1), -2.0 / step**2) - modes**2
    # At the last row the value beyond follows from psi' = -n psi.
    inner[-1] = -2.0 / step**2 - modes**2 - 2.0 * modes / step
    lower = np.full(radial, 1.0 / step**2)
    lower[-1] = 2.0 / step**2
    upper = 1.0 / step**2
    pivots = np.empty_like(inner)
    pivots[0] = inner[0]
    for k in range(1, radial):
        pivots[k] = inner[k] - lower[k] * upper / pivots[k - 1]

    def stream(w, speed):
        right = -(2.0 / angular) * ((r * r * w)[1:, 1:-1] @ sines.T)
        # The uniform flow U r sin(theta) enters at the outer boundary: psi' = -n (psi - U r) + U r.
        right[-1, 0] -= 2.0 / step * (speed * r[-1, 0] + modes[0] * speed * r[-1, 0])
        for k in range(1, radial):
            right[k] -= lower[k] / pivots[k - 1] * right[k - 1]
        right[-1] /= pivots[-1]
        for k in range(radial - 2, -1, -1):
            right[k] = (right[k] - upper * right[k + 1]) / pivots[k]
        psi = np.zeros_like(w)
        psi[1:, 1:-1] = right @ sines
        return psi

    def rate(w, speed):
        psi = stream(w, speed)
        # No slip: psi = psi' = 0 at the wall.
        w[0] = -2.0 * psi[1] / (step * r[0, 0]) ** 2
        w[:, 0] = w[:, -1] = 0.0
        mid = (slice(1, -1), slice(1, -1))
        by_xi = lambda f: (f[2:, 1:-1] - f[:-2, 1:-1]) / (2.0 * step)
        by_theta = lambda f: (f[1:-1, 2:] - f[1:-1, :-2]) / (2.0 * turn)
        second = (w[2:, 1:-1] - 2.0 * w[mid] + w[:-2, 1:-1]) / step**2
        second += (w[1:-1, 2:] - 2.0 * w[mid] + w[1:-1, :-2]) / turn**2
        change = np.zeros_like(w)
        convection = by_theta(psi) * by_xi(w) - by_xi(psi) * by_theta(w)
        change[mid] = (second / reynolds - convection) / r[1:-1] ** 2
        return change

    speed = lambda t: np.sin(0.5 * np.pi * min(t, 1.0)) ** 2
    w = np.zeros((radial + 1, angular + 1))
    dt = min(0.2 * reynolds * 0.25 * step**2, 0.2 * 0.5 * min(step, turn))
    t, rows = 0.0, []
    while t < until:
        first = rate(w, speed(t))
        second = rate(w + dt * first, speed(t + dt))
        w = w + 0.5 * dt * (first + second)
        t += dt
        rate(w, speed(t))
        slope = (-3.0 * w[0] + 4.0 * w[1] - w[2]) / (2.0 * step)
        sine = np.sin(theta)
        # Twice the integral over half of the circle, over U^2 D / 2.
        friction = -4.0 / reynolds * np.sum(0.5 * w[0] * sine) * turn
        pressure = 4.0 / reynolds * np.sum(0.5 * slope * sine) * turn
        rows.append((t, friction + pressure, friction))
    return np.array(rows)


def main():
    for word in sys.argv[1:] or ["100"]:
        reynolds = float(word)
        until = 30.0 if reynolds <= 40.0 else 7.0
        rows = drag(reynolds, until, **({"radial": 320, "angular": 192} if reynolds > 500.0 else {}))
        for t in [1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 15.0, 30.0]:
            if t <= until:
                _, total, friction = rows[np.argmin(abs(rows[:, 0] - t))]
                print(f"Re {reynolds:g}  t {t:4.1f}  drag {total:.4f}  friction {friction:.4f}")
        late = rows[(rows[:, 0] > 3.5) & (rows[:, 0] < 6.5)]
        print(f"Re {reynolds:g}  mean from 3.5 to 6.5: drag {late[:, 1].mean():.4f}  friction {late[:, 2].mean():.4f}")


main()
