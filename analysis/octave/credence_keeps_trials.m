function keeps = credence_keeps_trials(file)
% KEEPS = CREDENCE_KEEPS_TRIALS(FILE): whether a results file has a number for each trial; that of a study run with
% --keep aggregates has totals in their place.
  attributes = ncinfo(file).Attributes;
  keeps = isempty(attributes) || ~any(strcmp({attributes.Name}, 'keep'));
end
