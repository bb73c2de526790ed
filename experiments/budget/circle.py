"""The error of the document's circle by its sources: python3 experiments/budget/circle.py [trials] prints the table of
docs/budget.md, of the position at the last step at two heading noises, on the fixed and on the planned path."""

import math
import sys
from pathlib import Path

import credence

SCENARIO = Path(__file__).parents[1] / "seed" / "ekf-circle-ranged.ini"


def shown(one):
    half = (one.alone_ci[1] - one.alone_ci[0]) / 2
    alone = "-" if math.isnan(one.alone) else f"{one.alone:.4f}±{half:.4f}"
    ratio = "-" if math.isnan(one.ratio) else f"{100 * one.ratio:.0f} %"
    return f"{alone} | {one.p_counts:.4f} | {ratio}"


def main(trials):
    numbers = "alone | P counts | error²/P's"
    print(f"| noise.heading | source | fixed: {numbers} | planned: {numbers} |")
    print("|" + "---|" * 8)
    for heading in (0.001, 0.1):
        both = credence.budget(SCENARIO, trials, of="position", set={"noise.heading": heading}, progress=False)
        fixed, planned = (both.arm(f"{path}.ekf")["position"] for path in ("fixed", "greedy"))
        of_planned = {one.source: one for one in planned.contributions}
        for one in fixed.contributions:
            print(f"| {heading} | {one.source} | {shown(one)} | {shown(of_planned[one.source])} |")
        whole = " | ".join(f"{part.rss:.4f}; {part.rmse:.4f} | {part.p_says:.4f} | {100 * part.ratio:.0f} %"
                           for part in (fixed, planned))  # fmt: skip
        print(f"| {heading} | together; RMSE | {whole} |")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000)
