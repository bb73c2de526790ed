#!/usr/bin/env bash
# When can the filter's covariance be believed? The matched filter, heading noise from 0.001 to 0.1, and misinformed
# filters; 300,000 trials each (some two minutes on 2 cores), or as many as the first argument says. Writes
# results/consistency/*.h5 and prints the tables of docs/consistency.md.
set -euo pipefail
cd "$(dirname "$0")/../.."
source experiments/study.sh
build_program >&2
trials=${1:-300000}
here=experiments/consistency out=results/consistency

# row LABEL NAME SCENARIO.ini [section.key=value...]: a study and its row.
row() {
  local label=$1 name=$2 scenario=$3 arm
  shift 3
  study "$out/$name" "$trials" "$here/$scenario" "$@"
  arm=$(awk -F, 'NR == 2 { print $2 }' "$out/$name.csv")
  printf '| %s ' "$label"
  local part
  for part in all pose heading position features; do
    printf '| %s ' "$(interval "$out/$name.csv" "$arm" "nees_per_dimension:$part")"
  done
  printf '| %s | %s |\n' "$(interval "$out/$name.csv" "$arm" nis_ratio)" "$(verdict "$out/$name.csv" "$arm")"
}

heading() {
  printf '\n%s\n\n| %s | NEES/dim: all | pose | heading | position | features | NIS/m | verdict |\n' "$1" "$2"
  printf '|---|---|---|---|---|---|---|---|\n'
}

heading "Matched world ($trials trials each)" filter
row "linear (Kalman filter)" linear matched-linear.ini
row "linear, sighted within 0.1 to 2 only" linear-gated matched-linear.ini sensor.range_min=0.1 sensor.range_max=2
heading "Matched world, EKF: heading noise" "σ_head"
for sigma in 0.001 0.002 0.005 0.01 0.02 0.03 0.05 0.07 0.1; do
  row "$sigma" "ekf-$sigma" matched-ekf.ini "noise.heading=$sigma"
done
heading "Misinformed filters, linear matched world" "what the filter is told"
row "0.8 of σ_feat" told-sigma-0.8 matched-linear.ini filter.measurement=0.8
row "√0.7 of every process σ" told-process-0.7 matched-linear.ini filter.odometry=0.83666002653407556 \
  filter.features=0.83666002653407556
row "1.25 of σ_feat" told-sigma-1.25 matched-linear.ini filter.measurement=1.25
row "reports 1.1 P" reports-1.1 matched-linear.ini filter.covariance=1.1
row "reports 0.98 P" reports-0.98 matched-linear.ini filter.covariance=0.98
heading "The document's world, straight path, constant noise: heading noise" "σ_head"
for sigma in 0.001 0.01 0.02 0.042 0.1; do
  row "$sigma" "document-$sigma" document.ini "noise.heading=$sigma"
done
