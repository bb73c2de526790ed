function paths = credence_arms(file)
% PATHS = CREDENCE_ARMS(FILE): the groups of a results file or trajectory file, such as
% '/ekf-circle-ranged/greedy.ekf/', as a cell array in the order of the study. In Octave first: pkg load netcdf
  paths = {};
  scenarios = ncinfo(file).Groups;
  for i = 1:numel(scenarios)
    if strcmp(scenarios(i).Name, 'run')
      continue
    end
    arms = scenarios(i).Groups;
    for j = 1:numel(arms)
      paths{end + 1} = ['/' scenarios(i).Name '/' arms(j).Name '/'];
    end
  end
end
