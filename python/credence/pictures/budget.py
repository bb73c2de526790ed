"""The picture of a budget: what each source contributes to the error, alone and with all others."""

from __future__ import annotations

from typing import Any

import matplotlib
import numpy as np

from . import style
from .style import Picture


def picture(budget: Any) -> Picture:
    """Bars of the contributions of a Budget, with the whole error and what P says of it as lines."""
    with matplotlib.rc_context(style.PRINT):
        return _drawn(budget)


def _drawn(budget: Any) -> Picture:
    part = budget[budget.of]
    rows = part.contributions
    drawn, axes = style.one_panel(style.COLUMN, 30 + 9 * len(rows))
    places = np.arange(len(rows))
    alone = np.array([one.alone for one in rows])
    low, high = np.array([one.alone_ci for one in rows]).T
    shown = np.nan_to_num(alone)
    axes.barh(places - 0.2, shown, 0.38, color=style.BLUE, label="alone, with 95 %")
    axes.hlines(places - 0.2, low, high, color="black", linewidth=0.8)
    axes.barh(places + 0.2, [one.with_others for one in rows], 0.38, color=style.SKY, label="with others")
    if budget.counted_trials:
        counts = [one.p_counts for one in rows]
        axes.vlines(counts, places - 0.4, places + 0.4, color=style.VERMILION, linewidth=1.5, label="P counts")
    axes.axvline(part.rmse, color=style.GREY, linewidth=0.8, label="RMSE")
    if part.p_says == part.p_says:
        axes.axvline(part.p_says, color=style.VERMILION, linestyle="--", linewidth=0.8, label="P says")
    axes.set_yticks(places, [one.source for one in rows])
    axes.invert_yaxis()
    unit = f" [{part.unit}]" if part.unit not in ("", "1") else ""
    axes.set_xlabel(f"contribution to the error{unit}")
    axes.legend(loc="lower left", bbox_to_anchor=(-0.01, 1.0), borderaxespad=0.2, ncols=2)
    when = "at the last step" if budget.at == "last" else "on average over the steps"
    largest = rows[0]
    drawn.title(f"{largest.source} carries {100 * largest.share:.0f} % of the squared error of {budget.of} {when}",
                f"{budget.trials} trials of {2 * len(rows) + 2} runs, seed {budget.seed}")
    drawn.fit_labels()
    return drawn
