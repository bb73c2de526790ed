# Reads with R's ncdf4: Rscript readers.R STUDY.h5 TRACE.h5 EXPECTED.tsv (see expected.py). R has dimensions in reverse.
if (!requireNamespace("ncdf4", quietly = TRUE)) {
  cat("SKIPPED: r-cran-ncdf4 is not installed\n")
  quit(status = 0)
}
library(ncdf4)
given <- commandArgs(trailingOnly = TRUE)
files <- list(study = nc_open(given[1]), trace = nc_open(given[2]))
facts <- read.delim(given[3], header = FALSE, quote = "", colClasses = "character",
                    col.names = c("file", "path", "quantity", "value"))

group <- function(path) sub("/[^/]*$", "", path)

quietly <- function(value) {  # ncdf4 prints a warning for each 64-bit integer
  invisible(capture.output(found <- value))
  found
}

# ncdf4 names variables and groups without the leading slash; coordinate variables it keeps with their dimensions.
values <- function(file, path) ncvar_get(file, sub("^/", "", path))
attribute <- function(file, path, name) quietly(ncatt_get(file, sub("^/", "", path), name)$value)

quantity <- function(file, path, name) {
  if (startsWith(name, "attribute:")) return(attribute(file, path, sub("attribute:", "", name)))
  if (name == "dimensions") {
    dimensions <- sapply(file$var[[sub("^/", "", path)]]$dim, function(d) sub(".*/", "", d$name))
    return(paste(rev(dimensions), collapse = " "))
  }
  found <- values(file, path)
  counted <- function() sum(values(file, paste0(group(path), "/status")) < 2)
  components <- function() length(values(file, paste0(group(path), "/component")))
  step <- suppressWarnings(as.integer(sub(".*_", "", name)))
  switch(sub("_[0-9]+$", "", name),
    mean = mean(found, na.rm = TRUE),
    median = median(found, na.rm = TRUE),
    missing = sum(is.na(found)),
    zeros = sum(found == 0, na.rm = TRUE),
    failed = sum(found >= 2),
    last = found[length(found)],
    ratio_at = found[1, step] / counted() / components(),
    share_at = found[3, step] / counted(),
    per_row = sum(found, na.rm = TRUE) / sum(values(file, paste0(group(path), "/rows")), na.rm = TRUE),
    squared_error = {
      robot <- seq_len(2 + nrow(found) %% 2)
      sum((found - values(file, paste0(group(path), "/truth")))[robot, ]^2)
    })
}

same <- function(found, value) {
  number <- suppressWarnings(as.numeric(value))
  if (is.na(number) || is.character(found)) return(identical(found, value))
  is.finite(found) && abs(found - number) <= 1e-12 * max(abs(found), abs(number))
}

wrong <- 0
for (i in seq_len(nrow(facts))) {
  fact <- facts[i, ]
  found <- quantity(files[[fact$file]], fact$path, fact$quantity)
  if (!same(found, fact$value)) {
    cat("ncdf4:", fact$path, fact$quantity, "is", format(found, digits = 17), "not", fact$value, "\n")
    wrong <- wrong + 1
  }
}
cat("R ncdf4:", nrow(facts) - wrong, "of", nrow(facts), "as in the JSON\n")
quit(status = if (wrong > 0 || nrow(facts) == 0) 1 else 0)
