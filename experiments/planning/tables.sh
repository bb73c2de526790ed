# Sourced by the studies of planning, after experiments/study.sh: tables with a row for each cell of a study.

labels=() stems=()

# table TITLE HEAD FUNCTION A B: for each of the cells its label, and what FUNCTION prints of STEM.csv, A.ESTIMATOR and
# B.ESTIMATOR. HEAD and labels may have several columns.
table() {
  printf '\n%s\n\n| %s |\n|%s|\n' "$1" "$2" "$(sed 's/[^|]\+/---/g' <<<"$2")"
  local i estimator
  for i in "${!stems[@]}"; do
    estimator=$(awk -F, 'NR == 2 { sub(/.*\./, "", $2); print $2 }' "${stems[i]}.csv")
    printf '| %s %s|\n' "${labels[i]}" "$($3 "${stems[i]}.csv" "$4.$estimator" "$5.$estimator")"
  done
}

# credibility FILE.csv A B: NEES/dim of all and of the pose and RMSE/σ, of both arms, and their verdicts.
credibility() {
  local arm
  for arm in "$2" "$3"; do
    printf '| %s | %s | %s ' "$(interval "$1" "$arm" nees_per_dimension:all)" \
      "$(interval "$1" "$arm" nees_per_dimension:pose)" "$(interval "$1" "$arm" rmse_ratio:all)"
  done
  printf '| %s | %s ' "$(verdict "$1" "$2")" "$(verdict "$1" "$3")"
}

# check_claims TRIALS: prints the tables of the standard input, and checks what docs/planning.md and its page of
# docs/theory say of them, which is of a study of so many trials.
check_claims() {
  if [ "$trials" -eq "$1" ]; then "${PYTHON:-python3}" experiments/claims.py experiments/planning/claims.py -; else cat; fi
}
