# Sourced by the studies of planning: builds the program, and makes tables with a row for each cell of a study.

source experiments/study.sh
build_program >&2

out=results/planning labels=() stems=()

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

# means FILE.csv ARM COLUMN...: a cell of each column's mean.
means() {
  local file=$1 arm=$2 column
  shift 2
  for column in "$@"; do printf '| %s ' "$(interval "$file" "$arm" "$column")"; done
}

# difference COMPARED.csv COLUMN: a cell of the mean difference that `credence compare` found, with its 95 % interval.
# It is bold if it is certain: beyond 3.7 standard errors, Bonferroni's bound for the 216 or 228 numbers of a table
# together (two-sided, 5 %), or beyond `certain` of them where a study has more.
difference() {
  awk -F, -v column="$2" -v certain="${certain:-3.7}" '
    $4 == column {
      half = 1.96 * $10
      digits = half > 0 ? 1 - int(log(half) / log(10) - (half < 1)) : 4
      if (digits < 0) digits = 0
      mark = $9 * $9 > certain * certain * $10 * $10 ? "**" : ""
      printf "| %s%.*f ± %.*f%s ", mark, digits, $9, digits, half, mark
      exit
    }' "$1"
}
