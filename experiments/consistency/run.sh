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

# figures LABEL FILE.csv [SCENARIO]: a row of a table.
figures() {
  local label=$1 csv=$2 scenario=${3:-} arm part
  arm=$(awk -F, 'NR == 2 { print $2 }' "$csv")
  printf '| %s ' "$label"
  for part in all pose heading position features; do
    printf '| %s ' "$(interval "$csv" "$arm" "nees_per_dimension:$part" "$scenario")"
  done
  printf '| %s | %s |\n' "$(interval "$csv" "$arm" nis_ratio "$scenario")" "$(verdict "$csv" "$arm" "$scenario")"
}

# row LABEL NAME SCENARIO.ini [section.key=value...]: a study and its row.
row() {
  local label=$1 name=$2 scenario=$3
  shift 3
  study "$out/$name" "$trials" "$here/$scenario" "$@"
  figures "$label" "$out/$name.csv"
}

# over_heading_noise NAME SCENARIO.ini VALUES: a study at these heading noises, and its rows.
over_heading_noise() {
  local scenario sigma
  study "$out/$1" "$trials" "$here/$2" "--sweep=noise.heading=$3"
  points "$out/$1.csv" | while read -r scenario sigma; do figures "$sigma" "$out/$1.csv" "$scenario"; done
}

heading() {
  printf '\n%s\n\n| %s | NEES/dim: all | pose | heading | position | features | NIS/m | verdict |\n' "$1" "$2"
  printf '|---|---|---|---|---|---|---|---|\n'
}

heading "Matched world ($trials trials each)" filter
row "linear (Kalman filter)" linear matched-linear.ini
row "linear, sighted within 0.1 to 2 only" linear-gated matched-linear.ini sensor.range_min=0.1 sensor.range_max=2
heading "Matched world, EKF: heading noise" "σ_head"
over_heading_noise ekf matched-ekf.ini 0.001,0.002,0.005,0.01,0.02,0.03,0.05,0.07,0.1
heading "Misinformed filters, linear matched world" "what the filter is given"
row "0.8 of σ_feat" told-sigma-0.8 matched-linear.ini filter.measurement=0.8
row "√0.7 of every process σ" told-process-0.7 matched-linear.ini filter.odometry=0.83666002653407556 \
  filter.features=0.83666002653407556
row "1.25 of σ_feat" told-sigma-1.25 matched-linear.ini filter.measurement=1.25
row "reports 1.1 P" reports-1.1 matched-linear.ini filter.covariance=1.1
row "reports 0.98 P" reports-0.98 matched-linear.ini filter.covariance=0.98
heading "The document's world, straight path, constant noise: heading noise" "σ_head"
over_heading_noise document document.ini 0.001,0.01,0.02,0.042,0.1
