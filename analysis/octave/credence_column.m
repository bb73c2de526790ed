function [values, units] = credence_column(file, arm, name)
% [VALUES, UNITS] = CREDENCE_COLUMN(FILE, ARM, NAME): a number for each trial as double, NaN where the variable has its
% fill value (failed trials), and its units. ARM is a path of credence_arms, NAME such as 'trace_P' or 'unseen'.
  if ~credence_keeps_trials(file)
    error('credence:aggregates', '%s keeps aggregates: it has no %s of single trials; see column_total and --keep trials', file, name);
  end
  values = double(ncread(file, [arm name]));
  if any(strcmp(name, {'unseen', 'status_pose'}))
    values(values == -1) = NaN;
  end
  units = ncreadatt(file, [arm name], 'units');
end
