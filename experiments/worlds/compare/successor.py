"""Whether the study of polygon.sh has the figures of an independent program within both errors:

    python3 successor.py polygon.csv SUCCESSOR.md

The figures are the table of SUCCESSOR.md. Prints, of each, by how many standard errors it differs; exit code 1 where
one of the 72 differs by more than 4, which chance makes once in 200 times."""

import csv
import math
import re
import sys
from pathlib import Path

COLUMNS = ["trace(P)", "its mean", "unseen", "position (cm)", "rotation (rad)", "features (cm)", "NEES/n",
           "NEES/n of the pose", "NEES/n of the features"]


def with_error(text):
    """0.145(11) and 6.6(1.0): the value and its standard error"""
    value, error = re.fullmatch(r"([\d.]+)\(([\d.]+)\)", text).groups()
    digits = len(value.partition(".")[2])
    return float(value), float(error) if "." in error else float(error) * 10**-digits


def main(table, page):
    with open(table, newline="") as file:
        rows = {(row["setting"], row["arm"]): row for row in csv.DictReader(file)}
    worst = compared = 0
    for line in Path(page).read_text().splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) != 11 or not re.match(r"(constant|ranged), ", cells[0]):
            continue
        noise, variant, arm = cells[0].split(", ")
        apart = []
        for name, cell in zip(COLUMNS, cells[2:], strict=True):
            mean, half = map(float, rows[f"{noise}; {variant}", arm][name].split(" ± "))
            value, error = with_error(cell)
            apart.append((mean - value) / math.hypot(error, half / 1.96))
        print(cells[0], *(f"{distance:+.1f}" for distance in apart))
        worst, compared = max(worst, *map(abs, apart)), compared + len(apart)
    return compared == 72 and worst < 4


if __name__ == "__main__":
    sys.exit(not main(*sys.argv[1:]))
