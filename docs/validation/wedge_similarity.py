"""Similarity solution of a wedge that enters water at a constant speed: k of F = k rho V^3 t (Dobrovol'skaya 1969).

    python3 wedge_similarity.py DEGREES[,DEGREES ...]

The arguments are deadrise angles. Needs numpy.

Wagner's function h = int sqrt(W'') dz turns the half domain into a polygon, so that on the upper half plane of s
    W''(z) z_s^2 = C s^(-3/2) / (s - 1):
free surface s < 0, jet tip 0, body 0..1, apex 1, plane of symmetry s > 1. The direction of the free surface, theta = pi + D1,
follows from the tangency of (velocity - position), dD1/dlnt = c t^(-1/2) / ((1 + t) r R), t = -s, R = arc length from the tip.
"""
import sys
import numpy as np

def solve(beta, h=0.05, x0=-36.0, x1=24.0, steps=1500):
    b = beta / np.pi
    x = np.arange(x0, x1 + h / 2, h)
    n = len(x)
    t = np.exp(x)
    u = x[None, :] - x[:, None]                      # y - x
    with np.errstate(divide="ignore", over="ignore"):
        K = np.where(u > 0, u + np.log1p(-np.exp(-np.abs(u))), np.log1p(-np.exp(-np.abs(u))))
    K[np.arange(n), np.arange(n)] = np.log(h / (2 * np.pi))
    # Body: s = 1 / (1 + e^-v), clustered at both ends; 1 - s = 1 / (1 + e^v).
    v = np.arange(x0, -x0 + h / 2, h)
    ls, l1 = -np.logaddexp(0, -v), -np.logaddexp(0, v)
    KB = np.logaddexp(0, x[None, :] - ls[:, None])
    g = np.exp(-((x + 0.5) / 2.0) ** 2)
    g *= 0.9 * (np.pi - beta) / (g.sum() * h)
    c = 1.0
    def evaluate(g):
        D = g.sum() * h
        delta = np.pi - beta - D
        lr = (-0.5 + b) * np.logaddexp(0, x) - b * x + (K @ g) * h / np.pi
        rt = np.exp(lr + x)
        R = rt[0] * np.pi / delta + np.concatenate([[0], np.cumsum(0.5 * h * (rt[1:] + rt[:-1]))])
        lrb = (-0.5 + b) * l1 - b * ls + (KB @ g) * h / np.pi
        ds = np.exp(ls + l1)                          # ds / dv
        length = np.exp(lrb) * ds
        lc = (length.sum() - 0.5 * length[0]) * h + length[0] * (np.pi / delta)      # tail towards the tip
        speed = np.exp(-1.5 * ls - l1 - lrb) * ds
        c = lc / (speed.sum() * h)
        new = c * np.exp(-0.5 * x - np.logaddexp(0, x) - lr) / R
        return new, delta, rt, R, length, speed, lc, c

    # Anderson mixing of ln g, which keeps g positive; the sum is limited so that the tip angle stays positive.
    w = np.sqrt(np.exp(-np.abs(x) / 4))
    def fit(q):
        g = np.exp(q)
        total = g.sum() * h
        limit = (np.pi - beta) * 0.9999
        return q if total < limit else q + np.log(limit / total)
    q = np.log(g)
    qs, fs = [], []
    for it in range(steps):
        q = fit(q)
        new = evaluate(np.exp(q))[0]
        f = np.log(new) - q
        change = np.abs((new - np.exp(q))).max() / np.exp(q).max()
        if change < 1e-11:
            break
        qs.append(q); fs.append(f)
        qs, fs = qs[-12:], fs[-12:]
        mix = 0.02 if it < 300 else 0.05
        if len(qs) > 2 and it > 150:
            dF = np.array([(fs[i + 1] - fs[i]) * w for i in range(len(fs) - 1)]).T
            dQ = np.array([qs[i + 1] - qs[i] for i in range(len(qs) - 1)]).T
            dFu = np.array([fs[i + 1] - fs[i] for i in range(len(fs) - 1)]).T
            gamma = np.linalg.lstsq(dF, f * w, rcond=1e-10)[0]
            step = mix * f - (dQ + mix * dFu) @ gamma
            big = np.abs(step).max()
            q = q + step * min(1.0, 0.3 / big)
        else:
            q = q + mix * f
    g = np.exp(q)
    new, delta, rt, R, length, speed, lc, c = evaluate(g)
    theta = np.pi - (np.cumsum(g[::-1])[::-1] * h - 0.5 * h * g)      # pi + D1, D1 = -int_x^inf g
    fall = (rt * np.sin(theta)).sum() * h - 0.5 * h * rt[0] * np.sin(theta[0]) + rt[0] * (np.pi / delta) * np.sin(beta + delta)
    scale = 1.0 / (lc * np.sin(beta) - fall)
    # Along the body from the tip (v = -inf) to the apex: distance from the apex and speed, both from lc to 0.
    l = (lc - (length[0] * np.pi / delta + np.cumsum(length) * h - 0.5 * h * (length + length[0]))) * scale
    vt = (lc - c * (np.cumsum(speed) * h - 0.5 * h * speed)) * scale
    dv = c * speed * scale * h
    k = 2.0 * np.cos(beta) * np.sum(l * (vt - l) * dv)
    p = np.sum((vt - l) * dv)
    # Check: the area raised above the undisturbed level is that of the wedge below it, half of cot(beta).
    yc = lc * scale * np.sin(beta) - 1.0
    xc = lc * scale * np.cos(beta)
    first = rt[0] * np.pi / delta * np.exp(1j * (beta + delta))
    step = rt * np.exp(1j * theta) * h
    zf = xc + 1j * yc - scale * (first + np.cumsum(step) - 0.5 * step - 0.5 * step[0])
    y, dx = zf.imag, np.diff(zf.real, prepend=xc)
    ym = 0.5 * (y + np.concatenate([[yc], y[:-1]]))
    far = ym * dx
    area = far.sum() + 0.5 * yc**2 / np.tan(beta)        # free surface from xc outwards; body from cot(beta) to xc
    solve.area = area / (0.5 / np.tan(beta)), y[-1], zf.real[-1]
    # Check: the work of the force is the kinetic energy, so that k is twice the energy of the similarity flow.
    dvf = 1j * g * R * scale * np.exp(1j * theta) * h
    vf = -(np.cumsum(dvf[::-1])[::-1] - 0.5 * dvf)
    phi = (zf * vf.conj()).real - 0.5 * np.abs(vf) ** 2
    vn = (vf * np.conj(-1j * np.exp(1j * theta))).real
    zc = xc + 1j * yc
    free = np.sum(phi * vn * rt * scale * h) - 0.5 * phi[0] * vn[0] * rt[0] * scale * h + 0.5 * (0.5 * abs(zc) ** 2 + phi[0]) * vn[0] * abs(first) * scale
    dl = length * h * scale
    tail = length[0] * np.pi / delta * scale
    from_tip = np.cumsum((vt - np.sin(beta)) * dl) - 0.5 * (vt - np.sin(beta)) * dl + (lc * scale - np.sin(beta)) * tail
    phib = 0.5 * abs(zc) ** 2 - from_tip
    bodyp = -np.cos(beta) * (np.sum(phib * dl) + (0.5 * abs(zc) ** 2 - 0.5 * (lc * scale - np.sin(beta)) * tail) * tail - 0.5 * phib[0] * dl[0])
    solve.energy = 2 * (free + bodyp), abs(vf[0] - zc), 0.5 - phib[-1]
    return k, np.degrees(delta), p, it, change, lc * scale * np.sin(beta) - 1.0

if __name__ == "__main__":
    for deg in map(float, sys.argv[1].split(',')):
        for h in (0.2, 0.1, 0.05):
            k, d, p, it, ch, y = solve(np.radians(deg), h)
            print(f"{deg:g} deg, h {h}: k {k:.4f}, tip angle {d:.2f} deg, p apex {p:.4f}, tip height {y:.4f}, {it} steps, {ch:.1e}; area over exact {solve.area[0]:.5f}, twice the energy {solve.energy[0]:.4f}, tip velocity error {solve.energy[1]:.1e}, p apex by Bernoulli {solve.energy[2]:.4f}; Wagner {np.pi**3/4/np.tan(np.radians(deg))**2:.3f}", flush=True)
