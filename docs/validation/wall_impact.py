"""Means of the pressures of runs of wall-impact.toml: python3 wall_impact.py OUT ..."""

import csv
import math
import sys

DEPTH, GRAVITY, DENSITY = 0.3, 9.81, 1000.0
UNIT = math.sqrt(DEPTH / GRAVITY)

for folder in sys.argv[1:]:
    for gauge in ("s1", "s2", "s3", "s4"):
        with open(f"{folder}/probes/{gauge}.csv") as file:
            rows = [[float(x) for x in row] for row in list(csv.reader(file))[1:]]
        rows = [(t / UNIT, p / (DENSITY * GRAVITY * DEPTH)) for t, p in rows]
        mean = lambda a, b: sum(p for t, p in rows if a <= t < b) / sum(1 for t, _ in rows if a <= t < b)
        arrival = next(t for t, p in rows if p > 0.1)
        window = 0.02 / UNIT
        peak = max(mean(t, t + window) for t, _ in rows if t < rows[-1][0] - window)
        means = [mean(a, b) for a, b in ((3.5, 4.5), (4.5, 5.5), (5.5, 6.8))]
        print(folder, gauge, f"arrival {arrival:.2f}, 20 ms {peak:.2f}, means", " ".join(f"{m:.2f}" for m in means))
