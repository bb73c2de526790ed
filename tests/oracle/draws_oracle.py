"""The draws of docs/model.md, Draws, in a second program, written from that page and from the definition of
Philox4x32-10 [Salmon, Moraes, Dror, Shaw 2011], in integers:

    python3 draws_oracle.py CREDENCE docs/model.md

The values that the page shows are those of this program; and the robot and features of replayed trials are where these
draws place them, truncated and stretched to Student's t where the scenario says so.
"""

import math
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

# In the order of the page's table, which gives their numbers.
SOURCES = ["heading", "position", "walk", "deformation", "measurement", "edge", "detection", "landmark", "control",
           "placement", "bias", "outlier"]
WORD = 2**32
POSES, FEATURES, NU, LIMIT = 12, 3, 4, 1.2  # two fifths of all pairs are drawn again
DETECTION, OUTLIERS, OUTLIER_SCALE = 0.7, 0.4, 5
STUDIES = {
    "outliers": ["noise.measurement_tails=contaminated", f"noise.outlier_share={OUTLIERS}",
                 f"noise.outlier_scale={OUTLIER_SCALE}", f"sensor.detection={DETECTION}",
                 "truth.edge_noise=independent"],
    "truncated": [f"noise.truncate={LIMIT}", "noise.measurement_tails=student", f"noise.degrees_of_freedom={NU}"],
}
SIGMA = {"heading": 0.3, "position": 0.02, "bias": 0.5, "deformation": 0.2, "walk": 0.3, "measurement": 0.05}


def philox(counter, key):
    """Ten rounds on four words, with the key's two words raised after each."""
    (a, b, c, d), (low, high) = counter, key
    for _ in range(10):
        first, second = 0xD2511F53 * a, 0xCD9E8D57 * c
        a, b, c, d = second // WORD ^ b ^ low, second % WORD, first // WORD ^ d ^ high, first % WORD
        low, high = (low + 0x9E3779B9) % WORD, (high + 0xBB67AE85) % WORD
    return a, b, c, d


def words(seed, trial, pose, source, index, attempt=0):
    last = attempt * 2**20 + source * 2**16 + index
    return philox((trial % WORD, trial // WORD, pose, last), (seed % WORD, seed // WORD))


def fractions(*key):
    a, b, c, d = words(*key)
    return (a + WORD * b) // 2**12 / 2**52, (c + WORD * d) // 2**12 / 2**52


def uniform(*key):
    return fractions(*key)[0]


def pair(*key):
    u, v = fractions(*key)
    return math.sqrt(-2 * math.log(1 - u)) * np.array([math.cos(2 * math.pi * v), math.sin(2 * math.pi * v)])


def truncated(limit, *key):
    draw = pair(*key)
    for attempt in range(1, 4096):
        draw = np.where(abs(draw) > limit, pair(*key, attempt), draw)
        if (abs(draw) <= limit).all():
            break
    return draw


def student(normal):
    length = math.hypot(*normal)
    return normal / length * math.sqrt(NU * math.expm1(length**2 / NU) * (NU - 2) / NU)


def check_page(page):
    """The rows `| seed, trial, pose, source, index | words | draw |` of the page."""
    rows = [[cell.strip(" `") for cell in line.strip("|").split("|")] for line in page.splitlines()
            if line.startswith("| (")]
    assert len(rows) == 3, "the page shows three worked values"
    for key, shown_words, kind, shown in rows:
        key = [int(part) for part in key.strip("()").split(",")]
        assert [int(word, 16) for word in shown_words.split()] == list(words(*key)), key
        values = uniform(*key) if kind == "uniform" else pair(*key) if kind == "pair" else truncated(1, *key)
        # 15 digits are shown; functions of other libraries differ in the last of 16.
        assert np.allclose(np.array(shown.split(), float), values, rtol=1e-14, atol=1e-14), (key, values)


def check_trial(path, seed, trial, name, sources):
    """That the trial's truth and measurements are made of these draws."""
    limit = LIMIT if name == "truncated" else math.inf

    def draw(source, pose, index=0):
        return truncated(limit, seed, trial, pose, sources[source], index)

    def number(source, pose, index):
        return uniform(seed, trial, pose, sources[source], index)

    def measurement(k, j):
        if name == "truncated":
            return student(draw("measurement", k, j))
        return draw("measurement", k, j) * (OUTLIER_SCALE if number("outlier", k, j) < OUTLIERS else 1)

    with h5py.File(path) as file:
        arm = file["draws/fixed.ekf"]
        truth, turn, move = arm["truth"][:], arm["control_turn"][:], arm["control_move"][:]
        measured, seen = arm["measurement"][:], arm["seen"][:]
        predicted, innovation = arm["predicted_mean"][:], arm["innovation"][:]
        edges = list(zip(arm["edge_from"][:], arm["edge_to"][:]))
    heading, robot, features = truth[:, 0], truth[:, 1:3], truth[:, 3:].reshape(POSES, FEATURES, 2)
    bias, centre = SIGMA["bias"] * draw("bias", 0), np.empty((FEATURES, 2))
    for j in range(FEATURES):
        centre[j] = 0.5 + 0.8 * np.array([number("placement", 0, 2 * j) - 0.5, number("placement", 0, 2 * j + 1) - 0.5])
    theta, place = SIGMA["heading"] * draw("heading", 0)[0], SIGMA["position"] * draw("position", 0)
    for k in range(POSES):
        if k:
            c, s = math.cos(theta), math.sin(theta)
            place = place + np.array([[c, -s], [s, c]]) @ (move[k] + bias) + SIGMA["position"] * draw("position", k)
            theta = theta + turn[k] + SIGMA["heading"] * draw("heading", k)[0]
            centre = centre + np.array([2, 0]) + [SIGMA["walk"] * draw("walk", k - 1, j) for j in range(FEATURES)]
        # Sums of a few numbers below 50: rounding is some 1e-14.
        assert np.allclose([theta, *place], [heading[k], *robot[k]], rtol=0, atol=1e-12), k
        for j in range(FEATURES):
            p = centre[j] + SIGMA["deformation"] * draw("deformation", k, j)
            assert np.allclose(p, features[k, j], rtol=0, atol=1e-12), (k, j)
            c, s = math.cos(theta), math.sin(theta)
            z = np.array([[c, s], [-s, c]]) @ (p - place) + SIGMA["measurement"] * measurement(k, j)
            visible = k > 0 and (name == "truncated" or number("detection", k, j) < DETECTION)
            assert k == 0 or seen[k, j] == visible, (k, j)
            assert not visible or np.allclose(z, measured[k, j], rtol=0, atol=1e-12), (k, j)
        for e, (a, b) in enumerate(edges if k and name == "outliers" else []):
            believed = predicted[k, 3:].reshape(FEATURES, 2)
            z = features[k, b] - features[k, a] + SIGMA["deformation"] * draw("edge", k, e)
            at = 2 * (FEATURES + e)
            assert np.allclose(z - believed[b] + believed[a], innovation[k, at : at + 2], rtol=0, atol=1e-12), (k, e)


def main(credence, page):
    text = Path(page).read_text()
    check_page(text)
    table = text.partition("| source | number |")[2].partition("\n\n")[0].splitlines()[2:]
    sources = dict(zip(SOURCES, [int(row.split("|")[2]) for row in table], strict=True))
    scenario = f"""[scenario]\nname = draws\nposes = {POSES}\n[features]\nplacement = box\ncount = {FEATURES}
positions = 0.5 0.5\nextent = 0.8\n[sensor]\nrange_max = inf\nrange_min = 0\n[arms]\ncontrollers = fixed\n[noise]
heading = {SIGMA['heading']}\ninitial_heading = {SIGMA['heading']}\ninitial_position = {SIGMA['position']}
odometry_bias = {SIGMA['bias']}\n"""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "draws.ini"
        file.write_text(scenario)
        for name, settings in STUDIES.items():
            for seed, trial in ((1, 0), (2**63 + 12345, 300)):
                study, path = Path(folder) / f"{name}-{seed}.h5", Path(folder) / f"{name}-{seed}-{trial}.h5"
                options = [word for setting in settings for word in ("--set", setting)]
                options += ["--seed", str(seed), "--trials", str(trial + 1), "--quiet"]
                which = ["--scenario", "draws", "--arm", "fixed.ekf", "--trial", str(trial)]
                for command in (["run", file, *options, "-o", study], ["replay", study, *which, "-o", path]):
                    subprocess.run([credence, *command], check=True, stdout=subprocess.DEVNULL)
                check_trial(path, seed, trial, name, sources)
    print("the draws are those of docs/model.md")


if __name__ == "__main__":
    main(*sys.argv[1:])
