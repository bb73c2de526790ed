# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # From nothing to a first verdict
#
# A filter says how wrong it may be: its covariance. This notebook asks whether that can be believed, of a Kalman filter
# of twenty lines, of the same filter with a mistake, and of EKF-SLAM in credence's own worlds. It needs the package
# with pictures (`pip install '.[study]'`) and takes half a minute.

# %%
import matplotlib.pyplot as plt
import numpy as np
from IPython.display import Image

import credence


# %% [markdown]
# ## A filter of your own
# `run` makes one run: it draws the truth and the measurements with the generator that it is given, filters them, and
# returns errors and covariances, step by step. Here a target in the plane accelerates at random, with a standard
# deviation of 0.1 m/s² in each axis, and its position is measured to 0.5 m every second. `believed` is the standard
# deviation of the acceleration that the filter assumes.

# %%
one, zero = np.eye(2), np.zeros((2, 2))
F, G, H = np.block([[one, one], [zero, one]]), np.vstack([0.5 * one, one]), np.hstack([one, zero])
R = 0.5**2 * one
parts = {"groups": {"position": [0, 1], "velocity": [2, 3]},
         "component_names": ["x", "y", "v_x", "v_y"], "component_units": ["m", "m", "m/s", "m/s"]}


def run(rng, believed=0.1):
    x, m, P = rng.standard_normal(4), np.zeros(4), np.eye(4)
    errors, covariances = [], []
    for _ in range(40):
        x = F @ x + G @ (0.1 * rng.standard_normal(2))
        z = H @ x + 0.5 * rng.standard_normal(2)
        m, P = F @ m, F @ P @ F.T + believed**2 * G @ G.T
        S = H @ P @ H.T + R
        K = P @ H.T @ np.linalg.inv(S)
        m, P = m + K @ (z - H @ m), P - K @ S @ K.T
        errors.append(m - x)
        covariances.append((P + P.T) / 2)
    return credence.Run(errors, covariances, **parts)


# %% [markdown]
# ## Its verdict, and that of a wrong one
# A thousand trials of each arm. Both arms of a trial see the same random numbers, so that they differ by the filter
# alone. `wrong` believes in half of the acceleration.

# %%
study = credence.simulate(run, trials=1000, arms={"right": {}, "wrong": {"believed": 0.05}})
print(study)

# %% [markdown]
# The first line of each arm is its verdict, with the mean NEES of the whole state over its dimension, which is 1 for a
# covariance that is right. `right` is *consistent*: NEES, every direction of the state and every bias are shown to lie
# within the margins. `wrong` is *optimistic*: its errors are larger than its covariance says, and the lines below the
# verdict say in which components, at which steps and by how much.
# [How a verdict is reached](../statistics.md#verdict) and [how to read it](../reading.md) have pages.

# %% [markdown]
# ## Its picture

# %%
figure, axes = plt.subplots(figsize=(7, 3), layout="constrained")
for name, style in {"right": "-", "wrong": "--"}.items():
    error, covariance = study.arm(name).read("error"), study.arm(name).read("covariance")
    nees = np.einsum("tki,tki->tk", error, np.linalg.solve(covariance, error[..., None])[..., 0]) / 4
    axes.plot(range(1, 41), nees.mean(axis=0), style, label=name)
axes.axhspan(0.95, 1.05, color="0.85", label="within 5 % of 1")
axes.set(title="A filter that believes in half of the noise claims too much", xlabel="step", ylabel="mean NEES/n")
axes.legend()
plt.show()

# %% [markdown]
# ## In your tests
# One line, which raises an AssertionError with the report when the filter is refuted:

# %%
record = study.arm("wrong").record()
try:
    credence.assert_consistent(**record)
except AssertionError as failure:
    print("AssertionError:", str(failure).splitlines()[0])

# %% [markdown]
# ## A study of credence's own worlds
# A scenario is a text of a few lines; every other value has a default. This one is EKF-SLAM on a circle, along a fixed
# and along a planned path.

# %%
slam = credence.run("""[scenario]
name = circle
[features]
path = circle
[arms]
controllers = fixed, greedy
""", trials=1000, seed=1)
slam

# %%
credence.plot(slam, "verdicts")

# %%
print(credence.compare(slam, arms=("greedy", "fixed")))

# %%
Image(credence.animate(slam, trial=17, path="trial.gif").read_bytes())
