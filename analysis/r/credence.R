# Reads results files of credence with ncdf4: source("analysis/r/credence.R"); file <- ncdf4::nc_open("study.h5").
# R has dimensions in reverse: the part of a total comes first.

# SCENARIO/ARM of every arm, in the order of the study.
credence_arms <- function(file) unique(dirname(grep("/nees_total$", names(file$var), value = TRUE)))

# An attribute; ncdf4 prints a line for each 64-bit integer.
credence_attribute <- function(file, path, name) {
  invisible(capture.output(value <- ncdf4::ncatt_get(file, path, name)$value))
  value
}

# A column, one number a trial, NA for trials without a result; its unit is an attribute.
credence_column <- function(file, arm, name) {
  path <- paste0(arm, "/", name)
  if (!path %in% names(file$var))
    stop(path, " is not in the file, whose study may keep aggregates. Run it with --keep trials.")
  structure(as.vector(ncdf4::ncvar_get(file, path)), units = credence_attribute(file, path, "units"))
}

# The mean over the trials of a series at each step, with Student's 95 % interval.
credence_per_step <- function(file, arm, name) {
  n <- as.numeric(credence_attribute(file, arm, "counted_trials"))
  total <- function(ends) matrix(ncdf4::ncvar_get(file, paste0(arm, "/", name, ends), collapse_degen = FALSE)[1, ])[, 1]
  mean <- total("_total") / n
  half <- qt(0.975, n - 1) * sqrt(pmax(total("_square_total") / n - mean^2, 0) / (n - 1))
  data.frame(step = as.vector(ncdf4::ncvar_get(file, paste0(arm, "/step"))), mean, low = mean - half, high = mean + half)
}
