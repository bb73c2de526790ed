"""How often a mean error is told from too large a spread [docs/theory/statistics.md, Attribution]: prints the table
attribution.csv. Errors of n = 4 components over 50 steps, correlated by 0.8 from step to step, whose P varies among the
trials by a factor of 4. The kinds are those that Yan, Hsu and Sun (2025) tell apart, P that is too small or too large and
a bias, alone and together, and biases that change their sign.

    python3 experiments/verdict/attribution.py [STUDIES]      of each kind, 40 by default
"""

from __future__ import annotations

import sys

import numpy as np

import credence

N, STEPS, CORRELATION = 4, 50, 0.8
COUNTS = 20, 50, 200, 1000
CONSTANT = np.full((STEPS, N), 0.5)
SIGNS = 0.8 * np.sign(np.sin(2 * np.pi * (np.arange(STEPS) + 0.5) / STEPS))[:, None] * np.ones(N)
KINDS = [  # the factor on P, the mean of each step, beside a sigma of 0.7 to 1.4, what is right to say
    ("right", 1, 0 * CONSTANT, ""),
    ("P x 0.5", 0.5, 0 * CONSTANT, "spread"),
    ("P x 2", 2, 0 * CONSTANT, ""),
    ("bias of 0.5", 1, CONSTANT, "mean"),
    ("bias of 0.5, P x 0.5", 0.5, CONSTANT, "both"),
    ("bias of 1, P x 2", 2, 2 * CONSTANT, "mean beside too large P"),
    ("bias of 0.8 that changes its sign", 1, SIGNS, "mean"),
    ("bias that changes its sign, P x 0.5", 0.5, SIGNS, "both"),
    ("P x 0.8", 0.8, 0 * CONSTANT, "spread"),
]


def study(random: np.random.Generator, trials: int, factor: float, mean: np.ndarray) -> credence.Verdict:
    e = random.standard_normal((trials, STEPS, N))
    for k in range(1, STEPS):
        e[:, k] = CORRELATION * e[:, k - 1] + np.sqrt(1 - CORRELATION**2) * e[:, k]
    variance = np.exp(random.uniform(-np.log(2), np.log(2), (trials, 1, 1)))
    e = e * np.sqrt(variance) + mean
    mix = random.standard_normal((N, N)) + 2 * np.eye(N)
    P = factor * variance[..., None] * (mix @ mix.T) * np.ones((trials, STEPS, 1, 1))
    return credence.judge(error=e @ mix.T, covariance=P)


def main(studies: int = 40) -> None:
    print("| errors | trials | studies | something too large | the right line | cannot be told apart | a wrong line |")
    print("|---|---|---|---|---|---|---|")
    for name, factor, mean, right in KINDS:
        for trials in COUNTS:
            said = []
            for seed in range(studies):
                found = study(np.random.default_rng([seed, trials]), trials, factor, mean)
                said.append(found["attribution"]["carrier"] if found["attribution"] else "")
            large = [one for one in said if one]
            wrong = sum(one not in (right, "unknown") for one in large)
            cells = name, trials, studies, len(large), large.count(right), large.count("unknown"), wrong
            print("| " + " | ".join(map(str, cells)) + " |", flush=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
