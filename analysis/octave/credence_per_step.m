function [step, average, low, high] = credence_per_step(file, arm, figure_name)
% [STEP, AVERAGE, LOW, HIGH] = CREDENCE_PER_STEP(FILE, ARM, NAME): the mean over the counted trials of a figure such as
% 'nees' at each step, with its two-sided 95 % interval (Student's). A total is exact in its parts: the first is all of
% it but what rounding left. Dimensions come in reverse order, the part first.
  trials = double(ncreadatt(file, arm, 'counted_trials'));
  step = double(ncread(file, [arm 'step']));
  totals = ncread(file, [arm figure_name '_total']);
  squares = ncread(file, [arm figure_name '_square_total']);
  average = totals(1, :)' / trials;
  standard_error = sqrt(max(squares(1, :)' / trials - average .^ 2, 0) / (trials - 1));
  half = t_quantile(0.975, trials - 1) * standard_error;
  low = average - half;
  high = average + half;
end

function t = t_quantile(p, degrees)
% Without the statistics package: Student's distribution by the incomplete beta function.
  t = sqrt(degrees * (1 / betaincinv(2 * (1 - p), degrees / 2, 1 / 2) - 1));
end
