"""Checks a study of docs/theory/planning.md against tests/oracle/criteria_oracle.py, a program with draws of its own:

    python3 planning_claims.py docs/theory/planning.md experiments/planning/criteria.csv

Every mean of the cells below lies where the table has it, up to 4.5 standard errors of the difference; and three claims
that the page makes of them hold by as much.
"""

import csv
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "oracle"))
from criteria_oracle import means  # noqa: E402

WIDE = 4.5  # standard errors: 27 comparisons fail by chance once in 5,000 runs
COLUMNS = {"trace_P": "trace(P)", "unseen": "unseen", "pose_error": "pose error", "log_score": "log score",
           "path_length": "path (dm)"}
CELLS = {"0.01:trace": 200, "0.01:pose_trace": 200, "0.01:log_det": 200, "0.1:trace": 800, "0.1:follow": 800}


def table_cell(rows, cell):
    """Mean and standard error by column of the table's row."""
    sigma, controller = cell.split(":")
    name = controller if controller == "follow" else f"greedy, {controller}"
    row = next(row for row in rows if (row["world"], row["controller"]) == (f"σ_head {sigma}", name))
    numbers = {column: row[head].split(" ± ") for column, head in COLUMNS.items()}
    return {column: (float(mean), float(half) / 1.96) for column, (mean, half) in numbers.items()}


def main(page_file, table_file):
    page = Path(page_file).read_text()
    with open(table_file, newline="") as file:
        rows = list(csv.DictReader(file))
    found = {cell: means(cell, trials) for cell, trials in CELLS.items()}
    wrong = []

    def require(holds, what):
        print(("ok: " if holds else "FAILED: ") + what)
        if not holds:
            wrong.append(what)

    for cell in CELLS:
        shown = table_cell(rows, cell)
        for column in COLUMNS:
            (a, se_a), (b, se_b) = found[cell][column], shown[column]
            require(abs(a - b) <= WIDE * math.hypot(se_a, se_b), f"{cell} {column}: {a:.5g} here, {b:.5g} in the table")

    def less(a, b, column, factor, what):
        """mean of a < factor * mean of b"""
        (low, se_low), (high, se_high) = found[a][column], found[b][column]
        require(low + WIDE * math.hypot(se_low, factor * se_high) < factor * high, what)

    said = f"finds the same means in {len(CELLS)} of these {len(rows)} rows"
    require(said in page, f"the page says: {said}")
    less("0.1:follow", "0.1:trace", "trace_P", 1, "following is better than planning by the trace at 0.1")
    less("0.01:pose_trace", "0.01:trace", "pose_error", 0.4, "planning for the pose lowers its error by more than 60 %")
    less("0.01:trace", "0.01:log_det", "trace_P", 1, "the determinant's planner ends with a larger trace")
    return len(wrong)


if __name__ == "__main__":
    sys.exit(min(1, main(*sys.argv[1:])))
