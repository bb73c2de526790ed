% What the functions of analysis/octave say of each arm, for readers_test.py to compare, and a picture:
% octave functions.m STUDY.h5 SCENARIO PICTURE.svg
pkg load netcdf
graphics_toolkit('gnuplot');
warning('off', 'all');
addpath('analysis/octave');
arguments = argv();
arms = credence_arms(arguments{1});
for i = 1:numel(arms)
  [values, units] = credence_column(arguments{1}, arms{i}, 'trace_P');
  poses = credence_column(arguments{1}, arms{i}, 'status_pose');
  [step, average, low, high] = credence_per_step(arguments{1}, arms{i}, 'nees');
  printf('%s\t%s\t%.17g\t%d\t%d\t%.17g\t%.17g\t%.17g\n', arms{i}, units, mean(values), sum(isnan(poses)), step(10), ...
         average(10), low(10), high(10));
end
plot_study(arguments{1}, arguments{2}, arguments{3});
