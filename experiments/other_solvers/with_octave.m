% One run of Octave: with_octave.m FOLDER PROBLEM METHOD FORMULATION ORDER TOLERANCE, problem and formulation
% as numbers of definitions.py. The folder holds gateway.mex.
words = argv();
addpath(words{1});
tolerance = str2double(words{6});
all = gateway(str2double(words{2}), str2double(words{4}), 0, 0);
n = all(1);
t_end = all(2);
parts = reshape(all(3:end), [], 3);
% The own first step of ode15s is too long for tight tolerances: the first error test fails.
options = odeset("InitialStep", 1e-6 * t_end, "RelTol", tolerance, "AbsTol", tolerance * parts(:, 3));
if (! isempty(words{5}) && ! strcmp(words{5}, "0"))
  options = odeset(options, "MaxOrder", str2double(words{5}));
end
tic();
failure = "";
try
  if (strcmp(words{3}, "ode15s"))
    [t, y] = ode15s(@(t, y) gateway(t, y), [0, t_end], parts(:, 1), options);
  else
    [t, y] = ode15i(@(t, y, yp) gateway(t, y, yp), [0, t_end], parts(:, 1), parts(:, 2), options);
  end
  if (t(end) < t_end * (1 - 1e-9))
    failure = sprintf("stopped at t = %.3g s", t(end));
  end
catch problem
  failure = strrep(problem.message, "\n", " ");
end
printf("wall_s %.6g\n", toc());
printf("version %s\n", version());
printf("evaluations %d\n", gateway());
if (isempty(failure))
  printf("steps %d\n", numel(t) - 1);
  printf("end %s\n", sprintf("%.17g ", y(end, 1:n)));
else
  printf("failure %s\n", failure);
end
