"""The studies, and of each the filters that are judged, with the verdicts that they must get.

A filter that is wrong on purpose must be caught, and its report must say what `says` has.
"""

from __future__ import annotations

from common import Filter, Study, halved, in_world_frame, of_half_angles, without_correlations

INCREMENT = {"chart": "increment"}
SIMULATED = {"noise": "simulated"}
TOO_SMALL = "P is too small by a factor of about"
TOO_LARGE = "P is too large by a factor of about"
DIRECTIONS = "pessimistic (directions): all"
DROPPED = "that they are not correlated"
OTHER_CHART = "their directions are wrong: is the error in the chart and frame and of the step of P"


def radar(kind: str) -> Study:
    """A study of filterpy's radar, by the extended or the unscented filter."""
    drawn = {"kind": kind, **SIMULATED, "start": "drawn"}
    expected = "mixed" if kind == "ukf" else "optimistic"
    return Study("filterpy", f"radar, {kind.upper()}", "filterpy_radar", 1300, 300, (
        Filter("as documented", "failed", {"kind": kind}),
        Filter("Q and R of the simulated radar", expected, {"kind": kind, **SIMULATED}, expected_short="optimistic"),
        Filter("and the truth drawn from P0", "consistent", drawn, trials=2000),
        Filter("wrong: P halved", "optimistic", drawn, halved, TOO_SMALL, trials=2000,
               says_short="optimistic (NEES/dim): all 2"),
    ))


def tutorial(number: int, kind: str) -> Study:
    """A study of one of Stone Soup's tutorials."""
    known_short = "pessimistic" if kind == "kf" else "consistent"
    return Study("Stone Soup", f"tutorial {number}, {kind.upper()}", "stonesoup_tutorials", 1000, 200, (
        Filter("as documented, from a known state", "pessimistic", {"kind": kind}, expected_short=known_short),
        Filter("the truth drawn from the prior", "consistent", {"kind": kind, "start": "drawn"}),
        Filter("wrong: variances alone", "mixed", {"kind": kind, "start": "drawn"}, without_correlations, DROPPED,
               says_short=DIRECTIONS),
    ))


STUDIES = (
    Study("GTSAM", "planar SLAM", "gtsam_planar_slam", 4000, 2000, (
        Filter("as documented, joint marginals", "consistent"),
        Filter("wrong: marginals put together, without correlations", "mixed", {}, without_correlations, DROPPED),
    )),
    Study("GTSAM", "iSAM2 with a loop closure", "gtsam_isam2", 4000, 2000, (
        Filter("as documented, P of gtsam.Marginals", "consistent"),
        Filter("wrong: errors in the world's frame", "mixed", {}, in_world_frame, OTHER_CHART, says_short=DIRECTIONS),
        Filter("as documented, P of iSAM2 itself", "optimistic", {"marginals_of": "isam"}),
        Filter("only new factors, P of iSAM2", "undecided", {"marginals_of": "isam", "only_new_factors": True},
               expected_short="consistent"),
    )),
    Study("GTSAM", "IMU preintegration", "gtsam_imu", 1500, 400, (
        Filter("as documented, predict() against the truth", "failed"),
        Filter("preintegrated(), against its sums without noise", "failed", INCREMENT),
        Filter("the same for 11 s, less than a full turn", "consistent", {**INCREMENT, "seconds": 11}),
        Filter("wrong: sigma of a sample given as a density", "pessimistic", {**INCREMENT, "seconds": 11, "scale": 10},
               says=TOO_LARGE, says_short="pessimistic (NEES/dim): "),
    )),
    radar("ekf"),
    radar("ukf"),
    tutorial(1, "kf"),
    tutorial(2, "ekf"),
    tutorial(3, "ukf"),
    Study("ahrs", "attitude, EKF", "ahrs_attitude", 1000, 250, (
        Filter("as documented, its own variances", "pessimistic"),
        Filter("variances of the simulated sensors", "failed", {"variances": "simulated"}),
        Filter("and slower motion", "consistent", {"variances": "simulated", "span": 0.5}),
        Filter("wrong: P of half the angle", "optimistic", {"variances": "simulated", "span": 0.5}, of_half_angles,
               TOO_SMALL),
    )),
    Study("filterpy", "manoeuvring target, IMM", "filterpy_imm", 2000, 400, (
        Filter("as documented, the truth changes modes as it is told", "consistent"),
        Filter("wrong: P halved", "optimistic", {}, halved, TOO_SMALL, says_short="optimistic (NEES/dim): all 2"),
        Filter("the quiet mode alone, the truth as before", "failed", {"quiet": True}),
    )),
    Study("simdkalman", "level and trend", "simdkalman_series", 2000, 500, (
        Filter("as documented, filtered", "consistent"),
        Filter("wrong: P halved", "optimistic", {}, halved, TOO_SMALL, says_short="optimistic (NEES/dim): all 2"),
        Filter("as documented, smoothed", "consistent", {"result": "smoothed"}),
        Filter("filtered, from a known state", "pessimistic", {"start": "known"}, expected_short="consistent"),
    ), batch=True),
)
