"""What a wrong size of P does to those who use it: prints the table of docs/objections.md.

A gate lets 95 % of the errors through if P is right. Two estimates, of equal error and independent, are fused with
the weights that their P give, one of which is wrong: the variance of the result over that of the best weights, and over
what is then believed.
"""

from math import erf, exp, gamma, sqrt


def chi_square(x: float, n: int) -> float:
    """Its distribution function, by the recurrence over n [Abramowitz and Stegun 26.4.8]; SciPy may not be there."""
    below = erf(sqrt(x / 2)) if n % 2 else 1 - exp(-x / 2)
    return below - sum((x / 2) ** (m / 2) * exp(-x / 2) / gamma(m / 2 + 1) for m in range(2 - n % 2, n, 2))


def quantile(p: float, n: int) -> float:
    low, high = 0.0, 100.0
    while (middle := (low + high) / 2) not in (low, high):
        low, high = (middle, high) if chi_square(middle, n) < p else (low, middle)
    return low


DIMENSIONS = 1, 2, 3, 6
print("| NEES/dim | " + " | ".join(f"gate, n = {n}" for n in DIMENSIONS) + " | fused / best | fused / believed |")
print("|---" * (len(DIMENSIONS) + 3) + "|")
for c in 0.5, 0.85, 0.95, 1.0, 1.05, 1.15, 2.0:
    gates = [f"{100 * chi_square(quantile(0.95, n) / c, n):.1f} %" for n in DIMENSIONS]
    weight = c / (1 + c)  # of the estimate that believes its variance to be 1/c
    fused = weight**2 + (1 - weight) ** 2
    print("| " + " | ".join([f"{c:g}", *gates, f"{fused / 0.5:.4f}", f"{fused * (1 + c):.3f}"]) + " |")
