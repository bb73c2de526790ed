# What the functions of analysis/r say of each arm, for analysis_test.py to compare: Rscript functions.R STUDY.h5
if (!requireNamespace("ncdf4", quietly = TRUE)) quit(status = 0)
source("analysis/r/credence.R")
file <- ncdf4::nc_open(commandArgs(trailingOnly = TRUE)[1])
for (arm in credence_arms(file)) {
  values <- credence_column(file, arm, "trace_P")
  poses <- credence_column(file, arm, "status_pose")
  nees <- credence_per_step(file, arm, "nees")
  row <- nees[10, ]
  cat(sprintf("/%s/\t%s\t%.17g\t%d\t%d\t%.17g\t%.17g\t%.17g\n", arm, attr(values, "units"), mean(values),
              sum(is.na(poses)), as.integer(row$step), row$mean, row$low, row$high), sep = "")
}
refused <- try(credence_column(file, arm, "nothing"), silent = TRUE)
stopifnot(inherits(refused, "try-error"), grepl("--keep trials", refused))
