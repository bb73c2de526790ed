% Writes the errors and covariances of your filter as a record that `credence judge` reads. GNU Octave, with its netcdf
% package (a netCDF-4 file is an HDF5 file):
%
%   octave write_record.m example.h5 && credence judge example.h5
%
% Octave and MATLAB store the first dimension fastest, files the last: an array [n, step, trial] here is [trial, step, n]
% in the file, which is what judge reads. In MATLAB (not run) the same is
%   h5create(path, '/error', size(e)); h5write(path, '/error', e); h5writeatt(path, '/', 'groups', groups);

function write_record(path, e, P, names, groups)
  % e [n, step, trial] = estimate - truth, wrapped where it is an angle; P [n, n, step, trial]; both NaN: no such
  % step. A run that ends early counts as failed, unless a dataset "steps" [trial] declares how many steps it has.
  % names of the components such as "x, vx, y, vy", groups of them, counted from 0, such as "position 0 2, velocity 1 3".
  [n, steps, trials] = size(e);
  nccreate(path, "error", "Dimensions", {"n", n, "step", steps, "trial", trials}, "Format", "netcdf4");
  ncwrite(path, "error", e);
  nccreate(path, "covariance", "Dimensions", {"n", n, "n2", n, "step", steps, "trial", trials});
  ncwrite(path, "covariance", P);
  ncwriteatt(path, "/", "record_version", int32(2));
  ncwriteatt(path, "/", "component_names", names);
  ncwriteatt(path, "/", "groups", groups);
end

if numel(argv()) != 1
  fputs(stderr, "usage: octave write_record.m RECORD.h5\n");
  exit(2);
end
pkg load netcdf
randn("seed", 1);
trials = 2000; steps = 10; L = [1 0 0; 0.5 2 0; 0.3 0.1 0.7];   % an example: errors drawn from N(0, L L')
e = reshape(L * randn(3, steps * trials), [3, steps, trials]);
P = repmat(L * L', [1, 1, steps, trials]);
write_record(argv(){1}, e, P, "a, b, c", "outer 0 2, middle 1");
