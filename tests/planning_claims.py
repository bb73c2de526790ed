"""Checks docs/theory/planning.md against tests/oracle/criteria_oracle.py, a second program with draws of its own:

    python3 planning_claims.py docs/theory/planning.md

Every mean of the cells below lies where the page has it, up to 4.5 standard errors of the difference; and three claims
that the page makes of them hold by as much.
"""

import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "oracle"))
from criteria_oracle import means  # noqa: E402

WIDE = 4.5  # standard errors: 27 comparisons fail by chance once in 5,000 runs
COLUMNS = {"trace_P": 2, "unseen": 3, "pose_error": 4, "log_score": 6, "path_length": 7}
CELLS = {"0.01:trace": 200, "0.01:pose_trace": 200, "0.01:log_det": 200, "0.1:trace": 800, "0.1:follow": 800}


def page_cell(page, cell):
    """Mean and standard error by column of the page's row."""
    sigma, controller = cell.split(":")
    name = controller if controller == "follow" else f"greedy, {controller}"
    line = next(line for line in page.splitlines() if line.startswith(f"| σ_head {sigma} | {name} |"))
    fields = [field.strip() for field in line.strip("|").split("|")]
    numbers = {column: fields[at].split(" ± ") for column, at in COLUMNS.items()}
    return {column: (float(mean), float(half) / 1.96) for column, (mean, half) in numbers.items()}


def main(path):
    page = Path(path).read_text()
    found = {cell: means(cell, trials) for cell, trials in CELLS.items()}
    wrong = []

    def require(holds, what):
        print(("ok: " if holds else "FAILED: ") + what)
        if not holds:
            wrong.append(what)

    for cell in CELLS:
        shown = page_cell(page, cell)
        for column in COLUMNS:
            (a, se_a), (b, se_b) = found[cell][column], shown[column]
            require(abs(a - b) <= WIDE * math.hypot(se_a, se_b), f"{cell} {column}: {a:.5g} here, {b:.5g} on the page")

    def less(a, b, column, factor, what):
        """mean of a < factor * mean of b"""
        (low, se_low), (high, se_high) = found[a][column], found[b][column]
        require(low + WIDE * math.hypot(se_low, factor * se_high) < factor * high, what)

    rows = sum(line.count("|") == 10 and " ± " in line for line in page.partition("\n\nThe next table")[0].splitlines())
    said = f"finds the same means in {len(CELLS)} of these {rows} rows"
    require(said in page, f"the page says: {said}")
    less("0.1:follow", "0.1:trace", "trace_P", 1, "following is better than planning by the trace at 0.1")
    less("0.01:pose_trace", "0.01:trace", "pose_error", 0.4, "planning for the pose lowers its error by more than 60 %")
    less("0.01:trace", "0.01:log_det", "trace_P", 1, "the determinant's planner ends with a larger trace")
    return len(wrong)


if __name__ == "__main__":
    sys.exit(min(1, main(sys.argv[1])))
