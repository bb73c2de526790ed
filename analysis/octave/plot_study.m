function plot_study(file, scenario, picture)
% PLOT_STUDY(FILE, SCENARIO, PICTURE): NEES per dimension at each step, with the 95 % band of a consistent filter, and
% the distribution of trace(P), for every arm of a scenario; PICTURE is an SVG file.
%
%   pkg load netcdf                                 % Octave only
%   graphics_toolkit('gnuplot')                     % Octave without a screen
%   plot_study('study.h5', 'kf-circle-constant', 'kf-circle-constant.svg')
  arms = credence_arms(file);
  arms = arms(strncmp(arms, ['/' scenario '/'], numel(scenario) + 2));
  if isempty(arms)
    error('credence:scenario', 'there is no scenario %s in %s', scenario, file);
  end
  if ~credence_has_run(file, arms{1})
    error('credence:scenario', '%s is not run yet: %s has no trial of it', scenario, file);
  end
  across = 4;  % names of arms in a row below the panels, each row half a centimetre high
  names = 0.5 * ceil(numel(arms) / across);
  height = 6 + names;
  drawing = figure('visible', 'off', 'paperunits', 'centimeters', 'papersize', [17.5 height], ...
                   'paperposition', [0 0 17.5 height]);
  left = axes('position', [0.09 (names + 1.2) / height 0.37 4.4 / height]);
  right = axes('position', [0.6 (names + 1.2) / height 0.33 4.4 / height]);
  for i = 1:numel(arms)
    look = arm_look(i);
    draw_nees(left, file, arms{i}, look);
    if credence_keeps_trials(file)
      draw_distribution(right, file, arms{i}, look);
    else
      set(right, 'visible', 'off');
      text(0, 0.5, 'distributions need the trials: --keep trials', 'parent', right);
    end
  end
  draw_names(axes('position', [0.03 0 0.95 names / height]), arms, scenario, across);
  print(drawing, picture, '-dsvg');
  close(drawing);
end

function run = credence_has_run(file, arm)
  % Whether the file has trials of an arm. All of them may have failed.
  run = ncreadatt(file, arm, 'counted_trials') > 0;
  if ~run && credence_keeps_trials(file)
    run = ncinfo(file, [arm 'trial']).Size > 0;
  elseif ~run
    run = sum(double(ncread(file, [arm 'status_count']))) > 0;
  end
end

function look = arm_look(i)
  % Twelve arms differ: the second six have the colours of the first, with other marks, hollow, and other lines.
  colours = [0 114 178; 213 94 0; 0 158 115; 204 121 167; 230 159 0; 86 180 233] / 255;  % [Okabe and Ito 2008]
  marks = 'os^dv+';
  again = mod(floor((i - 1) / 6), 2);
  look.colour = colours(mod(i - 1, 6) + 1, :);
  look.mark = marks(mod(i - 1 + 3 * again, 6) + 1);
  faces = {look.colour, 'none'};
  look.face = faces{1 + again};
  lines = {'-', '--'};
  look.line = lines{1 + again};
end

function draw_names(where, arms, scenario, across)
  rows = ceil(numel(arms) / across);
  hold(where, 'on');
  for i = 1:numel(arms)
    x = mod(i - 1, across);
    y = rows - floor((i - 1) / across) - 0.5;
    look = arm_look(i);
    plot(where, x + [0 0.07 0.14], [y y y], [look.line look.mark], 'color', look.colour, 'markersize', 3, ...
         'markerfacecolor', look.face);
    text(x + 0.2, y, arms{i}(numel(scenario) + 3:end - 1), 'parent', where, 'interpreter', 'none');
  end
  set(where, 'xlim', [0 across], 'ylim', [0 rows], 'visible', 'off');
end

function draw_nees(where, file, arm, look)
  dimension = double(ncreadatt(file, [arm 'nees_total'], 'dimension'));
  trials = double(ncreadatt(file, arm, 'counted_trials'));
  [step, average, low, high] = credence_per_step(file, arm, 'nees');
  band = 2 * gammaincinv([0.025 0.975], trials * dimension / 2) / (trials * dimension);
  hold(where, 'on');
  plot(where, step([1 end]), [band; band], 'color', [0.5 0.5 0.5]);
  plot(where, step, [low high] / dimension, ':', 'color', look.colour);
  plot(where, step, average / dimension, [look.line look.mark], 'color', look.colour, 'markersize', 3, ...
       'markerfacecolor', look.face);
  xlabel(where, 'step');
  ylabel(where, 'NEES / state dimension');
end

function draw_distribution(where, file, arm, look)
  [values, units] = credence_column(file, arm, 'trace_P');
  values = sort(values(~isnan(values)));
  hold(where, 'on');
  plot(where, values, 100 * (1:numel(values))' / numel(values), look.line, 'color', look.colour);
  set(where, 'xscale', 'log');
  xlabel(where, ['trace(P) at the last pose [' units ']']);
  ylabel(where, 'trials at or below [%]');
end
