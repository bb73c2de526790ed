"""What docs/polygon.md says of the table of polygon.sh, sentence by sentence, for experiments/claims.py."""

TABLES = {"study": ("setting | arm", 2, "trace mean_trace unseen position rotation features nees pose_nees "
                    "features_nees clearance rolled verdict")}
study = {}  # experiments/claims.py fills it

PUBLISHED, MENDED = "constant; published", "constant; mended"


def helix(setting):
    """NEES/n on the helix"""
    return study[setting, "fixed"].nees


def less(quantity, setting, arm, other):
    """By how many % an arm is below another"""
    return round(100 * (1 - getattr(study[setting, arm], quantity) / getattr(study[setting, other], quantity)))


CLAIMS = {
    "As published, NEES/n is 4.2 on the helix and 5.5 with the planner; mended, 1.00 on both. The planner's trace is "
    "0.030 in either case.":
        lambda: round(helix(PUBLISHED), 1) == 4.2 and round(study[PUBLISHED, "greedy"].nees, 1) == 5.5 and
        all(round(study[MENDED, arm].nees, 2) == 1 for arm in ("fixed", "greedy")) and
        all(round(study[setting, "greedy"].trace, 3) == 0.03 for setting in (PUBLISHED, MENDED)),
    "The edges' noise, drawn once, makes the helix optimistic, truncated tails pessimistic: without the one NEES/n is "
    "0.78, without the other 5.5, without the wrong Jacobian 3.6.":
        lambda: round(helix("constant; edges mended"), 2) == 0.78 and
        round(helix("constant; tails mended"), 1) == 5.5 and round(helix("constant; jacobian mended"), 1) == 3.6,
    "`return` does not plan, and ends below the planner's trace: 6 % as published, 5 % mended. Mended, the planner's "
    "position is 7 % better than on that path, its rotation 17 %.":
        lambda: [less("trace", setting, "return", "greedy") for setting in (PUBLISHED, MENDED)] == [6, 5] and
        less("position", MENDED, "greedy", "return") == 7 and less("rotation", MENDED, "greedy", "return") == 17,
    "its features are 0.095 cm off, and 0.081 cm on the helix.":
        lambda: round(study[PUBLISHED, "greedy"].features, 3) == 0.095 and
        round(study[PUBLISHED, "fixed"].features, 3) == 0.081,
    "**Goals do not help**: `global` and `combined` end above `greedy` in trace(P) in all four settings.":
        lambda: all(study[setting, arm].trace - study[setting, arm].trace.half > study[setting, "greedy"].trace
                    for setting in (PUBLISHED, MENDED, "ranged; published", "ranged; mended")
                    for arm in ("global", "combined")),
    "As published `combined` maps better, all the same: its features are 0.073 cm off.":
        lambda: round(study[PUBLISHED, "combined"].features, 3) == 0.073 and
        study[PUBLISHED, "combined"].features < study[PUBLISHED, "greedy"].features,
}
