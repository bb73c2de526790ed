function plot_study(file, scenario, picture)
% PLOT_STUDY(FILE, SCENARIO, PICTURE): NEES per dimension at each step, with the 95 % band of a consistent filter, and
% the distribution of trace(P), for every arm of a scenario; PICTURE is an SVG file.
%
%   pkg load netcdf                                 % Octave only
%   graphics_toolkit('gnuplot')                     % Octave without a screen
%   plot_study('study.h5', 'kf-circle-constant', 'kf-circle-constant.svg')
  colours = [0 114 178; 213 94 0; 0 158 115; 204 121 167; 230 159 0; 86 180 233] / 255;  % [Okabe and Ito 2008]
  arms = credence_arms(file);
  arms = arms(strncmp(arms, ['/' scenario '/'], numel(scenario) + 2));
  if isempty(arms)
    error('credence:scenario', 'there is no scenario %s in %s', scenario, file);
  end
  names = cellfun(@(arm) arm(numel(scenario) + 3:end - 1), arms, 'UniformOutput', false);
  drawing = figure('visible', 'off', 'paperunits', 'centimeters', 'papersize', [17.5 7], 'paperposition', [0 0 17.5 7]);
  left = axes('position', [0.09 0.2 0.37 0.6]);
  right = axes('position', [0.6 0.2 0.33 0.6]);
  lines = zeros(1, numel(arms));
  for i = 1:numel(arms)
    colour = colours(mod(i - 1, 6) + 1, :);
    lines(i) = draw_nees(left, file, arms{i}, colour);
    if credence_keeps_trials(file)
      draw_distribution(right, file, arms{i}, colour);
    else
      set(right, 'visible', 'off');
      text(0, 0.5, 'distributions need the trials: --keep trials', 'parent', right);
    end
  end
  legend(lines, names, 'location', 'northoutside', 'orientation', 'horizontal', 'interpreter', 'none');
  print(drawing, picture, '-dsvg');
  close(drawing);
end

function line = draw_nees(where, file, arm, colour)
  dimension = double(ncreadatt(file, [arm 'nees_total'], 'dimension'));
  trials = double(ncreadatt(file, arm, 'counted_trials'));
  [step, average, low, high] = credence_per_step(file, arm, 'nees');
  band = 2 * gammaincinv([0.025 0.975], trials * dimension / 2) / (trials * dimension);
  hold(where, 'on');
  plot(where, step([1 end]), [band; band], 'color', [0.5 0.5 0.5]);
  plot(where, step, [low high] / dimension, ':', 'color', colour);
  line = plot(where, step, average / dimension, '-o', 'color', colour, 'markersize', 3);
  xlabel(where, 'step');
  ylabel(where, 'NEES / state dimension');
end

function draw_distribution(where, file, arm, colour)
  [values, units] = credence_column(file, arm, 'trace_P');
  values = sort(values(~isnan(values)));
  hold(where, 'on');
  plot(where, values, 100 * (1:numel(values))' / numel(values), 'color', colour);
  set(where, 'xscale', 'log');
  xlabel(where, ['trace(P) at the last pose [' units ']']);
  ylabel(where, 'trials at or below [%]');
end
