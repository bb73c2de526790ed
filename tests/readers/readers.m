% Reads with Octave's netcdf package and with its own load: octave readers.m STUDY.h5 TRACE.h5 EXPECTED.tsv (see
% expected.py). Both have dimensions in reverse. load knows no attributes, fill values or names of dimensions.
1;

function values = netcdf_values(file, path)
  persistent known = struct();
  key = ['x' regexprep([file path], '[^A-Za-z0-9_]', '_')];
  if ~isfield(known, key)
    known.(key) = double(ncread(file, path));
  end
  values = known.(key);
end

function values = load_values(file, path)
  persistent loaded = struct();
  key = ['x' regexprep(file, '[^A-Za-z0-9_]', '_')];
  if ~isfield(loaded, key)
    loaded.(key) = load(file);
  end
  parts = regexprep(strsplit(path(2:end), '/'), '[^A-Za-z0-9_]', '_');
  values = double(loaded.(key).(parts{1}).(parts{2}).(parts{3}));
end

function names = dimensions(file, path)
  names = strjoin(fliplr(cellfun(@(d) regexprep(d, '.*/', ''), {ncinfo(file, path).Dimensions.Name}, ...
                                 'UniformOutput', false)), ' ');
end

% Whether integers that are missing are -1 (load), or NaN (netcdf).
function found = quantity(read, file, path, name)
  if strncmp(name, 'attribute:', 10)
    found = ncreadatt(file, path, name(11:end));
    return
  end
  if strcmp(name, 'dimensions')
    found = dimensions(file, path);
    return
  end
  values = read(file, path);
  group = regexprep(path, '/[^/]*$', '');
  there = values(~isnan(values));
  step = str2double(regexprep(name, '.*_', ''));
  switch regexprep(name, '_[0-9]+$', '')
    case 'mean', found = mean(there(:));
    case 'median', found = median(there(:));
    case 'missing', found = sum(isnan(values(:)) | strcmp(path(max(1, end - 10):end), 'status_pose') & values(:) == -1);
    case 'zeros', found = sum(values(:) == 0);
    case 'failed', found = sum(values(:) >= 2);
    case 'last', found = values(end);
    case 'ratio_at'
      found = values(1, step) / sum(read(file, [group '/status']) < 2) / numel(read(file, [group '/component']));
    case 'share_at', found = values(3, step) / sum(read(file, [group '/status']) < 2);
    case 'per_row'
      rows = read(file, [group '/rows']);
      found = sum(there) / sum(rows(rows >= 0));
    case 'squared_error'
      robot = 1:(2 + mod(size(values, 1), 2));
      difference = values - read(file, [group '/truth']);
      found = sum(sum(difference(robot, :) .^ 2));
  end
end

function answer = same(found, value)
  number = str2double(value);
  if isnan(number) || ischar(found)
    answer = strcmp(found, value);
  else
    found = double(found);
    answer = isscalar(found) && abs(found - number) <= 1e-12 * max(abs([found number]));
  end
end

function wrong = check(reader, read, facts, files)
  wrong = 0;
  for i = 1:numel(facts{1})
    found = quantity(read, files.(facts{1}{i}), facts{2}{i}, facts{3}{i});
    if ~same(found, facts{4}{i})
      wrong = wrong + 1;
      printf('%s: %s %s is %s, not %s\n', reader, facts{2}{i}, facts{3}{i}, num2str(found, 17), facts{4}{i});
    end
  end
  printf('%s: %d of %d as in the JSON\n', reader, numel(facts{1}) - wrong, numel(facts{1}));
  wrong += isempty(facts{1});
end

arguments = argv();
files = struct('study', arguments{1}, 'trace', arguments{2});
in = fopen(arguments{3});
facts = textscan(in, '%s %s %s %s', 'Delimiter', "\t");
fclose(in);
some = @(chosen) cellfun(@(column) column(chosen), facts, 'UniformOutput', false);
of_values = ~strncmp(facts{3}, 'attribute:', 10) & ~strcmp(facts{3}, 'dimensions');
wrong = check('Octave load', @load_values, some(of_values), files);
if isempty(pkg('list', 'netcdf'))
  printf('SKIPPED: octave-netcdf is not installed\n');
else
  pkg load netcdf
  % The package opens the file for every value, which takes 0.05 s: one arm of the study, and the trace.
  one_arm = strcmp(facts{1}, 'trace') | strncmp(facts{2}, '/ekf-circle-ranged/fixed.ekf', 28);
  wrong += check('Octave netcdf', @netcdf_values, some(one_arm), files);
end
exit(wrong > 0);
