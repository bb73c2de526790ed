"""simdkalman: many series at once, with the model of the example in its documentation and its default prior.

The state is (level, trend). The filter is vectorised over series, so that a batch of runs is one call.
"""

import numpy as np
import simdkalman

import credence

TRANSITION, PROCESS, NOISE = np.array([[1, 1], [0, 1]]), np.diag([0.1, 0.01]), 1.0
STEPS, PRIOR = 50, 25.0  # PRIOR: the variance of each component at the start where no other is given


def run(rngs, result="filtered", start="drawn", process=PROCESS):
    draws = np.array([rng.standard_normal((STEPS + 1, 3)) for rng in rngs])
    truth = np.empty((len(rngs), STEPS, 2))
    state = PRIOR**0.5 * draws[:, 0, :2] if start == "drawn" else 0 * draws[:, 0, :2]
    for k in range(STEPS):
        truth[:, k] = state
        state = state @ TRANSITION.T + draws[:, k + 1, :2] * np.sqrt(np.diag(PROCESS))
    observed = truth[..., 0] + NOISE**0.5 * draws[:, :STEPS, 2]
    kf = simdkalman.KalmanFilter(TRANSITION, np.asarray(process), np.array([[1, 0]]), NOISE)
    states = getattr(kf.compute(observed, 0, smoothed=True, filtered=True), result).states
    return credence.Run(states.mean - truth, states.cov, component_names=["level", "trend"])


if __name__ == "__main__":
    print(credence.simulate(run, trials=1000, batch=True))
