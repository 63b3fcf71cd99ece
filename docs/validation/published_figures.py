"""Figures of docs/published-figures.md that are computed from data which other programs publish.

    python3 published_figures.py REPOSITORY

REPOSITORY is a checkout of Splashdown. Its record of the collapsing column is read, with the measurements of Martin and
Moyce. All other input is in this file, copied from public repositories; the origin is beside each list. Python 3.8
or newer, no packages.
"""

import json
import math
import sys
from pathlib import Path

G = 9.81


def at(series, t):
    """Linear interpolation in a list of (t, value)."""
    for (t0, v0), (t1, v1) in zip(series, series[1:]):
        if t0 <= t <= t1:
            return v0 + (v1 - v0) * (t - t0) / (t1 - t0)
    return None


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def slope(points):
    n = len(points)
    x = sum(p[0] for p in points) / n
    y = sum(p[1] for p in points) / n
    return sum((p[0] - x) * (p[1] - y) for p in points) / sum((p[0] - x) ** 2 for p in points)


def front_figures(simulated, measured, largest_shift, after):
    """As crates/splashdown/tests/physics/dam_break.rs: relative rms at the best shift, the shift, the ratio of speeds;
    then the same without a shift."""

    def errors(shift):
        pairs = [(at(simulated, t + shift), z) for t, z in measured]
        return [s / z - 1.0 for s, z in pairs if s is not None]

    shifts = [largest_shift * k / 20.0 for k in range(-20, 21)]
    best = min(shifts, key=lambda s: rms(errors(s)))
    inside = [(t, at(simulated, t + best)) for t, z in measured if t > after and at(simulated, t + best) is not None]
    times = [t for t, _ in inside]
    ratio = slope(inside) / slope([(t, z) for t, z in measured if t in times])
    mean = sum(abs(e) for e in errors(0.0)) / len(errors(0.0))
    return rms(errors(best)), best, ratio, rms(errors(0.0)), mean, len(errors(best))


# ---------------------------------------------------------------------------------------------------------------------
# TrixiParticles.jl, validation/dam_break_2d: largest x of a fluid particle in m, every 0.02 s from t = 0, until the water
# reaches the far wall. Column 1.2 m wide and 0.6 m high. Files and commits:
TRIXI = {
    # validation_reference_wcsph_0015.json, commit 0428af1a7bdce4c0874b48e85f95e629e651fdcf
    "wcsph, H/40": [
        1.1925, 1.1974255668985976, 1.211186960952904, 1.2337394820482446, 1.2645622243345942, 1.3028426282680983,
        1.3476879647897049, 1.3979316295290753, 1.4525993411830331, 1.5111724511234108, 1.5732643611396324,
        1.638454486911552, 1.7063600647423314, 1.7767013172523465, 1.8492761750942543, 1.923924524565773,
        2.0004931732049465, 2.078832571882563, 2.158801540777191, 2.2402751021840337, 2.3231359927147417,
        2.407285699734371, 2.492640938003688, 2.579132664346739, 2.6666988492495793, 2.7552839586473428,
        2.84483876233654, 2.9352640099288765, 3.0263663871650337, 3.1181669055856753, 3.2055490866952914,
    ],
    # validation_reference_wcsph_00075.json, commit 02f80a5d9c9d7b92e066b7ea7d9f4bc1492c278d
    "wcsph, H/80": [
        1.19625, 1.2019083771632808, 1.2177086251987401, 1.2431644933930905, 1.2769973546553661, 1.3178431850988706,
        1.36434820307712, 1.4156458188804748, 1.471109649449572, 1.5302098698219946, 1.5925885519062326,
        1.6579692727904511, 1.7261216625092772, 1.7968538881363496, 1.8699939422609009, 1.945370103038666,
        2.0228167935161805, 2.10217980439416, 2.1833183701912393, 2.266108997416118, 2.3504047633733536,
        2.436064085420658, 2.5230059723575553, 2.610968996652342, 2.6998376794947556, 2.789440506351254,
        2.87962015228104, 2.970746739927777, 3.0628427303527768, 3.155517031597097,
    ],
    # validation_reference_wcsph_0001875.json, commit 2423b9963ba5200e6e02a42bf36726ee19a3ae53
    "wcsph, H/320": [
        1.1990625, 1.2064102146617777, 1.2254009627014801, 1.2537394887084652, 1.289171429989208, 1.330380271518788,
        1.3768027656501556, 1.4280073282370445, 1.4835530513093824, 1.5429735627311474, 1.6058773120707277,
        1.6719894993960402, 1.7408921450125494, 1.8125074269467178, 1.8867359014681078, 1.9634986816652091,
        2.0421765312790074, 2.1224868534502623, 2.204587608652142, 2.288085724213179, 2.3730182387405145,
        2.4593885072504227, 2.5470904037048427, 2.6360266963165633, 2.7258827246125352, 2.8166381512492324,
        2.9083511503217867, 3.000992584762129, 3.094674023144942, 3.189785167910574,
    ],
    # validation_reference_edac_0015.json, commit 205ac2aa9903c1109ffa12b9353db9106d65eb9c
    "edac, H/40": [
        1.1925, 1.1974498153413242, 1.2113247489860772, 1.2339512368534549, 1.2647614388456057, 1.3030530778577876,
        1.3479315075505776, 1.3982153687268417, 1.4528587307443863, 1.5111852009342817, 1.5728525712233459,
        1.6376062119280237, 1.7051647111153123, 1.775284954365397, 1.8477632240609996, 1.9224118702662027,
        1.9990558397506764, 2.077528796301557, 2.157676054336742, 2.239359496921488, 2.3224528107795885,
        2.406841499975494, 2.492421325429409, 2.579100576983397, 2.666799458804105, 2.7554470324889353,
        2.844978365764719, 2.935329256936317, 3.026438222151472, 3.1182387596527597, 3.2054748297166107,
    ],
    # validation_reference_edac_00075.json, commit 205ac2aa9903c1109ffa12b9353db9106d65eb9c
    "edac, H/80": [
        1.19625, 1.2019503990789229, 1.2177946418796155, 1.243172362194385, 1.2769238044945657, 1.3176649093695214,
        1.3639904371124498, 1.4148974109037789, 1.4699264722691974, 1.5287343079091749, 1.5910344363115523,
        1.6565479682550603, 1.7249797477359536, 1.796055415772886, 1.8695328059621625, 1.9452041023518056,
        2.0228924034620235, 2.10244194960979, 2.18371311778759, 2.2665779760315194, 2.350916120875793,
        2.4366131284440757, 2.5235559415440485, 2.61165120256634, 2.7007662389015015, 2.7908001416316086,
        2.8816834764215113, 2.9731549093521026, 3.065215933489084, 3.1577843583492196,
    ],
}
# Martin and Moyce (1952), n^2 = 1 (square column), T = t sqrt(g / a), Z = x / a, until Z = 4.11.
MM_N1 = [
    (0.43, 1.11), (0.62, 1.22), (0.80, 1.44), (0.97, 1.67), (1.14, 1.89), (1.29, 2.11), (1.45, 2.33), (1.62, 2.56),
    (1.76, 2.78), (1.93, 3.00), (2.07, 3.22), (2.24, 3.44), (2.40, 3.67), (2.54, 3.89), (2.71, 4.11),
]
# Koshizuka and Oka (1996), time in s, x in m, column 1 m wide and 2 m high:
# DualSPHysics/DualSPHysics, examples/main/01_DamBreak/EXP_X-DamTipPosition_Koshizula&Oka1996.txt.
KO = [
    (0.092031603, 1.128), (0.190699774, 1.244), (0.266343115, 1.464), (0.32214447, 1.695), (0.368058691, 1.903),
    (0.413950339, 2.123), (0.446591422, 2.365), (0.495801354, 2.584), (0.521851016, 2.804), (0.56462754, 3.034),
    (0.594018059, 3.219), (0.636591422, 3.462), (0.669255079, 3.704), (0.70214447, 3.9), (0.751331828, 4.132),
]


def collapsing_column(repository):
    print("Collapsing column, TrixiParticles.jl against Martin and Moyce, n^2 = 1")
    print("  Lengths beyond the gate are scaled by the height H; Z = 1 + (x - W) / H, T = t sqrt(g / H).")
    height, width = 0.6, 1.2
    for name, xs in TRIXI.items():
        # The list starts half a spacing inside the gate; the front is the outer side of the particle.
        half = width - xs[0]
        front = [(0.02 * k * math.sqrt(G / height), 1.0 + (x + half - width) / height) for k, x in enumerate(xs)]
        error, shift, ratio, raw, mean, n = front_figures(front, MM_N1, 0.1, 0.7)
        print(f"  {name:13s} rms {100 * error:.1f} % at shift {shift:+.2f} ({n} points), speed {ratio:.3f}; "
              f"without shift rms {100 * raw:.1f} %, mean {100 * mean:.1f} %")

    runs = json.loads((Path(repository) / "docs/validation/collapsing-column.json").read_text())
    print("Collapsing column, Splashdown at 20 spacings across")
    for run in runs:
        if run["spacings"] != 20 or not run["plots"]:
            continue
        front = next(plot for plot in run["plots"] if plot["axes"][1] == "front over width")
        name, table = run["variant"], [tuple(point) for point in front["measured"]]
        curve = [tuple(point) for point in front["simulated"]]
        error, shift, ratio, raw, mean, n = front_figures(curve, table, 0.2, 1.4)
        print(f"  {name:11s} Martin and Moyce n^2 = 2: rms {100 * error:.1f} % at shift {shift:+.2f}, speed {ratio:.3f}; "
              f"without shift rms {100 * raw:.1f} %, mean {100 * mean:.1f} %")
        # As vegetableno1/DualSPHysics-mcp: every 0.01 s, column of 1 m, tip at most at 3.98 m.
        scale = math.sqrt(2.0 * G)
        errors = []
        for k in range(10, 76):
            t = 0.01 * k
            z, x = at(curve, t * scale), at(KO, t)
            if z is not None and x is not None:
                errors.append(min(z, 3.98) - x)
        mae = sum(map(abs, errors)) / len(errors)
        print(f"  {'':11s} Koshizuka and Oka, column of 1 m: MAE {mae:.3f} m, RMSE {rms(errors):.3f} m ({len(errors)} times)")
        # As REEF3D: the error of the time of arrival at the measured Z.
        inverse = [(z, t) for t, z in curve]
        arrival = [(z, at(inverse, z) / t - 1.0) for t, z in table if at(inverse, z) is not None]
        worst = max(arrival, key=lambda p: abs(p[1]))
        after = [e for z, e in arrival]
        print(f"  {'':11s} arrival: mean {100 * sum(map(abs, after)) / len(after):.1f} %, "
              f"largest {100 * worst[1]:.1f} % at Z = {worst[0]}")


# ---------------------------------------------------------------------------------------------------------------------
# Xiangyu-Hu/SPHinXsys, tests/2d_examples/test_2d_taylor_green/regression_test_tool. Kinetic energy every 0.1 s or a little
# more: an interval ends with the first advection step after 0.1 s, and 49 intervals end before 5 s, so that an interval is
# 0.1 to 0.102 s on average. Box of 1 m with 100 spacings, periodic, Re = U L / nu = 100.
TGV = {
    # WaterBody_TotalMechanicalEnergy_Run_5_result.xml, commit bdadd437a87ae31402846ff9b81ce88edb288a91
    "Run 5 of bdadd43": [
        0.25079261070604242, 0.21432066384497295, 0.18358860938915161, 0.15726769202744945, 0.13452364209827014,
        0.11493030626471505, 0.098102548552209928, 0.083650107196895584, 0.071263360500988526, 0.060990247293745685,
        0.052174559432100399, 0.044603188588914086, 0.038103151477981184, 0.032535059103275796, 0.027769809265798917,
        0.023692334407928388, 0.020209673995345415, 0.017232306068124946, 0.014682984901758624, 0.012507252113422532,
        0.01065317571610529,
    ],
    # WaterBody_TotalMechanicalEnergy_Run_0_result.xml, commit 99fe19c0ac29d161a9de4274988b2fa7b75590f8
    "Run 0 of 99fe19c": [
        0.25015047844205585, 0.21367822991506624, 0.18283303685094549, 0.15673217737694034, 0.13412281322453323,
        0.11464188304859574, 0.097879217606072932, 0.083465326081311714, 0.071121154870351561, 0.060898876754271927,
        0.052108189078084691, 0.044549205745124984, 0.038066714262635151, 0.032522663539130664, 0.027775578955927471,
        0.023707638745030873, 0.020224042800433571, 0.017246905328580933, 0.014705818289950153, 0.012534706007663921,
        0.01067915561369122,
    ],
    # WaterBody_TotalKineticEnergy_Run_0_result.xml, commit 4c3c916dcffccb3eca2ad392e5790528c3380f19
    "Run 0 of 4c3c916": [
        0.25000000000000011, 0.20646315402108778, 0.10449404996918778, 0.081142893755385748, 0.067861129331645037,
        0.057992126064962263, 0.048367528954995874, 0.040946858622088328, 0.033502654924073783, 0.031761300086689342,
        0.023462042707700352, 0.01988262552412496, 0.016842503505099568, 0.014806198437336413, 0.012009049295678125,
        0.010300696317383951, 0.0088440791916448297, 0.0076676478094008672, 0.0066263837915139859, 0.005477552971382707,
        0.0046925078193072621,
    ],
}


def taylor_green():
    print("Taylor-Green vortex, SPHinXsys, decay rate over 16 pi^2 nu / L^2 = 1.5791 1/s, minus one")
    exact = 16.0 * math.pi**2 / 100.0
    for name, energy in TGV.items():
        for k in (5, 10, 20):
            rates = [-math.log(energy[k] / energy[0]) / (k * dt) / exact - 1.0 for dt in (0.1, 0.102)]
            print(f"  {name}: over the first {0.1 * k:.1f} s {100 * rates[1]:+.1f} to {100 * rates[0]:+.1f} % "
                  f"(intervals of 0.102 and 0.1 s)")
    energy = TGV["Run 0 of 4c3c916"]
    print(f"  Run 0 of 4c3c916: at 0.2 s {energy[2] / energy[0]:.3f} of the energy is left, exact "
          f"{math.exp(-exact * 0.2):.3f} (0.204 s: {math.exp(-exact * 0.204):.3f})")
    for a, b in ((3, 13), (3, 20)):
        rates = [-math.log(energy[b] / energy[a]) / ((b - a) * dt) / exact - 1.0 for dt in (0.1, 0.102)]
        print(f"  Run 0 of 4c3c916: from {0.1 * a:.1f} to {0.1 * b:.1f} s {100 * rates[0]:+.1f} to {100 * rates[1]:+.1f} %")


# ---------------------------------------------------------------------------------------------------------------------
# Xiangyu-Hu/SPHinXsys, tests/2d_examples/test_2d_standing_wave/regression_test_tool. Mechanical energy in J per metre every
# 200 advection steps, from 0 to at most 10 s. Tank 2 m long, water 1 m deep, 50 spacings, amplitude 0.1 m.
WAVE = {
    # WaterBody_TotalMechanicalEnergy_Run_0_result.xml, commit 0e813b9ade9a395cf05d0fb9bdefa9b069c4c4a9
    "Run 0 of 0e813b9": [
        9860.5411200000017, 9857.1264665204617, 9856.8125684651277, 9855.4623485744305, 9852.9655195609685,
        9849.4955907666699, 9853.8411204341264, 9855.7431020424792, 9852.9746676542054, 9853.4009947911891,
        9850.8162046334837, 9856.9975647327083, 9856.6046253345157, 9857.8305470366249, 9854.9356665233336,
        9854.3432701607271, 9860.6476647857926, 9857.2613597105355, 9852.9807910159652, 9854.0174051638569,
        9851.8292282505354, 9854.5013153905566, 9854.2773188962383, 9854.2022273652183, 9851.6090954312931,
        9855.6928351333136, 9853.7697748243609, 9851.6177418389088, 9851.891761122075, 9851.940056744912,
        9854.9965113590806, 9849.525792112574, 9850.8175189713402, 9852.90049511303, 9852.9008647718019,
        9850.9836085919924, 9849.6807739136257, 9850.0824269606128, 9849.0678257533036, 9851.4934136719494,
        9852.1311958282458,
    ],
    # WaterBody_TotalMechanicalEnergy_Run_20_result.xml, commit a23afa48e5acbd5fdb842fe6cb91add9d826bc21
    "Run 20 of a23afa4": [
        9860.5411200000017, 9855.8676345065087, 9856.6202705453506, 9858.1073561348385, 9855.3390915459677,
        9851.5285508560773, 9854.8208538782492, 9856.7981358541874, 9856.7583687901351, 9856.9701099847589,
        9853.978250194561, 9858.8458758877878, 9858.4083665414801, 9857.9735717833792, 9856.2155243681682,
        9856.0594760058993, 9856.4699444065482, 9856.8320069409729, 9854.7608005181337, 9854.9406876129724,
        9853.4392287632636, 9855.7559532613959, 9856.5269212062376, 9853.511723803862, 9852.3920213545352,
        9854.9889378377575, 9856.4823128515272, 9855.3160461738134, 9853.264630038826, 9851.4681043864148,
        9857.8516816501215, 9852.4751478016151, 9853.1299825431124, 9847.432334248806, 9851.4261325471962,
        9853.1663163223511, 9853.7653709772858, 9851.7481090619713, 9848.7497187065401, 9852.7599232368011,
        9852.4060555952819,
    ],
}
# WaveProbe_FreeSurfaceHeight_Run_0_result.xml, commit 05f0ba698e883b8c1ecb11730243f81efba9e86c: m, at an antinode.
GAUGE = [
    0.89, 0.98514414841385178, 1.1106007917062328, 1.0473411509634076, 0.93802385241318198, 0.92691220084730119,
    1.0138857138252928, 1.0995497214444057, 1.0226016560746831, 0.91794223192625823, 0.93741105487213905,
    1.0789649418272236, 1.1080649893982346, 0.95708717725324044, 0.91822539701897232, 0.99382989547237954,
    1.0770850542417929, 1.0553994721442888, 0.94253964659752376, 0.92462918011015849, 1.024648532139643,
    1.117189931964824, 1.0058038430819392, 0.915356680676084, 0.96242073644991999, 1.0752174699698516,
    1.0652551074654049, 0.96515620910110123, 0.92808366330667114, 0.98648049954247607, 1.0934283600406645,
    1.0551577974280106, 0.92980709296518393, 0.93595551377577801, 1.0463804618411563, 1.0911088786713807,
    0.98651542599606412, 0.92766030374990105, 0.97442533103593298, 1.0601528502116317, 1.072050770841311,
]


def standing_wave():
    k, depth = math.pi, 1.0
    period = 2.0 * math.pi / math.sqrt(G * k * math.tanh(k * depth))
    print(f"Standing wave, SPHinXsys: linear period {period:.4f} s")

    def residual(n):
        """Squared residual of a constant plus a wave of n snapshots per period, fitted to the gauge."""
        rows = [(1.0, math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n)) for i in range(1, len(GAUGE))]
        y = GAUGE[1:]
        m = [[sum(r[a] * r[b] for r in rows) for b in range(3)] for a in range(3)]
        v = [sum(r[a] * h for r, h in zip(rows, y)) for a in range(3)]
        for a in range(3):
            for b in range(a + 1, 3):
                f = m[b][a] / m[a][a]
                m[b] = [x - f * z for x, z in zip(m[b], m[a])]
                v[b] -= f * v[a]
        c = [0.0] * 3
        for a in (2, 1, 0):
            c[a] = (v[a] - sum(m[a][b] * c[b] for b in range(a + 1, 3))) / m[a][a]
        return sum((sum(x * z for x, z in zip(c, r)) - h) ** 2 for r, h in zip(rows, y)), math.hypot(c[1], c[2])

    snapshots = min((4.0 + 0.005 * i for i in range(300)), key=lambda n: residual(n)[0])
    periods = (len(GAUGE) - 1) / snapshots
    print(f"  gauge: {snapshots:.2f} snapshots per period, {periods:.1f} periods in all, "
          f"{periods * period:.1f} s by the linear period; amplitude of the fit {residual(snapshots)[1]:.3f} m")
    wave = WAVE["Run 0 of 0e813b9"][0] - 0.5 * 1000.0 * G * 2.0
    for name, energy in WAVE.items():
        fit = slope(list(enumerate(energy[1:], 1)))
        mean = sum(energy[1:]) / (len(energy) - 1)
        start = mean - fit * (len(energy) - 1) / 2.0
        loss = -fit * snapshots / wave
        end = sum(energy[-5:]) / 5.0
        whole = 1.0 - ((end - 9810.0) / wave) ** (0.5 / periods)
        print(f"  {name}: energy of the wave {wave:.1f} J; fit without the first snapshot loses {100 * loss:.2f} % of the energy, "
              f"{50 * loss:.2f} % of the height per period; from the start {100 * whole:.2f} % of the height per period")


# ---------------------------------------------------------------------------------------------------------------------
# Xiangyu-Hu/SPHinXsys, tests/2d_examples/test_2d_rotation_patch/regression_test_tool,
# WaterBody_TotalKineticEnergy_Run_3_result.xml, commit 0e813b9ade9a395cf05d0fb9bdefa9b069c4c4a9: every 100 advection steps
# from the first step, until omega t = 8. The run has 2,100 to 2,199 steps, so that snapshots are 0.364 to 0.381 apart.
PATCH = [
    0.083325001719342998, 0.083292840315775732, 0.083463929084656385, 0.083583207571208462, 0.083553750777368124,
    0.083411625996959962, 0.083254622587501409, 0.083082021192869143, 0.0829140307372115, 0.082758257457380469,
    0.082628482688009458, 0.082510815866111989, 0.082415760154971457, 0.082332701277684939, 0.082260430443939075,
    0.082197998368317232, 0.08214930445525595, 0.082109415295576374, 0.082078081800274899, 0.082054404693931354,
    0.082038967560419007, 0.082027364202790692,
]


def patch():
    print("Rotating square patch, SPHinXsys, 100 spacings per edge")
    for dt in (0.364, 0.381):
        curve = [(dt * i, e) for i, e in enumerate(PATCH)]
        print(f"  snapshots {dt} apart: loss of kinetic energy at omega t = 1 {100 * (1 - at(curve, 1.0) / PATCH[0]):+.2f} %")
    print(f"  at the last snapshot {100 * (1 - PATCH[-1] / PATCH[0]):+.2f} %, largest gain {100 * (max(PATCH) / PATCH[0] - 1):.2f} %")


# ---------------------------------------------------------------------------------------------------------------------
# Xiangyu-Hu/SPHinXsys: still water (test_2d_stlw, FreeSurfaceGauge_FreeSurfaceHeight_Run_0_result.xml, commit
# da2f9781312dd3fa666b4937bf5098228cf642c0; 2 m deep, 3 m wide, spacing 0.05 m; the highest particle, which starts half a
# spacing below the level) and a floating square (test_2d_stfb, commit f3153e64fe4e7b5e2c9eef28cd4edef42e31afea,
# Observer_Position_Run_4_result.xml and FreeSurfaceGauge_FreeSurfaceHeight_Run_12_result.xml; edge 1 m, density 700, spacing
# 0.05 m, equilibrium at -0.2 m).
STILL = [
    -0.025, -0.018592719534742126, -0.018532948211630609, -0.018341987231828359, -0.017505819424275225,
    -0.021651551508683278, -0.023662357128373009, -0.024851933540484657, -0.026677952064209441, -0.027939849038709788,
    -0.025466760575889688, -0.027839187681105323, -0.028531560764691495, -0.03069488208751887, -0.028983578579595458,
    -0.027450457424077066, -0.025021893816851555, -0.023169174790818769, -0.024947053916533322, -0.023719419738620792,
    -0.025356572996473453, -0.027696287141063054, -0.027801964163677518, -0.028721935795745335, -0.027608434480508304,
    -0.024133385329220686, -0.019804073605154484, -0.026926242132222084, -0.026063677228584069, -0.021344256940404212,
    -0.026176277280864316, -0.02633904326554511, -0.026129704792400989, -0.027164445061367264, -0.025871684180943658,
    -0.025103208963396746, -0.023684978127562862, -0.024250585931101645, -0.024031507391949362, -0.025324229947699735,
    -0.025664080079322561, -0.022991557194743668, -0.02366298979534507, -0.028616016423598217, -0.026401828900634295,
    -0.024020888750318357, -0.025924679789776334, -0.025115359312041192, -0.025615705219578622, -0.027091918595677084,
    -0.02775788866563926, -0.026996393272526235, -0.024613324212261489, -0.025963731088119401, -0.02391920003973242,
    -0.025305389789276912, -0.027333704837895715, -0.023811154463079961, -0.021158022749773422,
]
FLOAT_Y = [
    -0.2, -0.204539, -0.202303, -0.185617, -0.176126, -0.182743, -0.194176, -0.198657, -0.191713, -0.183894, -0.184428,
    -0.191571, -0.196421, -0.193656, -0.186636, -0.183872, -0.187624, -0.191709, -0.191202, -0.186337, -0.183163, -0.185593,
    -0.187843, -0.188284, -0.1897, -0.191198, -0.191816, -0.192522, -0.192875, -0.191585,
]
FLOAT_LEVEL = [
    -0.025, -0.017491698789761295, -0.022594225173608515, -0.03064756853915325, -0.03507585611801585, -0.030800940884191122,
    -0.020339281680699678, -0.019520968612755901, -0.016211953496848761, -0.027475154437446317, -0.026726752480470704,
    -0.025840763847314187, -0.020305300562546348, -0.024652631674366484, -0.025363252576591975, -0.024461465678701225,
    -0.026530374077153494, -0.013876092868113615, -0.020350058928490053, -0.023558162172718458, -0.027915415427295632,
    -0.026639634639354474, -0.015601279470983243, -0.017042990493124729, -0.018826084091238905, -0.023919949854806992,
    -0.024232213353016042, -0.020028694914096198, -0.022844554661100955, -0.021264927433890957,
]


def still_and_floating():
    half = STILL[len(STILL) // 2:]
    mean = sum(half) / len(half)
    deviation = rms([h - mean for h in half])
    print(f"Still water, SPHinXsys: level {(mean + 0.025) / 0.05:+.3f} spacings, standard deviation {deviation / 0.05:.3f} spacings "
          f"(second half); largest rise {(max(STILL) + 0.025) / 0.05:.2f} spacings")
    y, level = FLOAT_Y[15:], FLOAT_LEVEL[15:]
    mean_y, mean_level = sum(y) / len(y), sum(level) / len(level) + 0.025
    print(f"Floating square, SPHinXsys, second half: centre {mean_y:.4f} m, level {mean_level:+.4f} m; "
          f"height error over the edge {100 * (mean_y + 0.2):.1f} %, {100 * (mean_y - mean_level + 0.2):.1f} % above the measured level")


# ---------------------------------------------------------------------------------------------------------------------
# trixi-framework/TrixiParticles.jl, validation/vortex_street_2d/resulting_force_dp20.json, commit
# 2e80b234fb465f93b87ddbc78281e91efa03c39b: drag coefficient of a cylinder, Re = 200, 20 spacings per diameter, 200 successive
# values every 0.02 s (a fifth of diameter over speed), rounded to 0.01, from about 5.7 s (57 diameters over speed).
DRAG = """
1.45 1.54 1.49 1.42 1.48 1.47 1.49 1.32 1.48 1.40 1.41 1.47 1.38 1.38 1.56 1.58 1.69 1.51 1.29 1.41 1.40 1.43 1.44 1.43 1.48
1.50 1.43 1.55 1.53 1.60 1.50 1.37 1.24 1.32 1.46 1.52 1.57 1.48 1.50 1.56 1.57 1.48 1.37 1.43 1.37 1.47 1.28 1.35 1.54 1.54
1.67 1.46 1.39 1.48 1.37 1.43 1.38 1.42 1.51 1.41 1.48 1.48 1.50 1.61 1.60 1.40 1.24 1.33 1.38 1.48 1.44 1.47 1.43 1.57 1.53
1.47 1.45 1.47 1.42 1.37 1.33 1.36 1.44 1.56 1.62 1.50 1.43 1.55 1.50 1.43 1.40 1.36 1.43 1.49 1.43 1.43 1.58 1.66 1.62 1.47
1.35 1.34 1.42 1.44 1.50 1.40 1.46 1.55 1.55 1.49 1.51 1.52 1.48 1.35 1.34 1.40 1.38 1.59 1.57 1.54 1.43 1.53 1.49 1.46 1.42
1.35 1.50 1.39 1.43 1.40 1.55 1.58 1.66 1.51 1.37 1.38 1.46 1.52 1.38 1.48 1.45 1.51 1.46 1.50 1.57 1.49 1.49 1.46 1.38 1.28
1.52 1.55 1.58 1.40 1.52 1.54 1.55 1.46 1.41 1.43 1.43 1.40 1.38 1.44 1.51 1.59 1.63 1.47 1.36 1.47 1.41 1.41 1.42 1.34 1.44
1.45 1.34 1.43 1.48 1.57 1.53 1.39 1.37 1.33 1.47 1.54 1.44 1.42 1.46 1.45 1.40 1.49 1.51 1.46 1.51 1.42 1.36 1.40 1.53 1.50
"""


def drag():
    values = [float(v) for v in DRAG.split()]
    mean = sum(values) / len(values)
    print(f"Cylinder at Re = 200, TrixiParticles.jl: mean C_D {mean:.3f}, standard deviation {rms([v - mean for v in values]):.3f} "
          f"({len(values)} samples, {0.02 * len(values):.1f} s)")


if __name__ == "__main__":
    collapsing_column(sys.argv[1])
    taylor_green()
    standing_wave()
    patch()
    still_and_floating()
    drag()
