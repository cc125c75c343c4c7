# One run of deSolve: with_desolve.R LIBRARY PROBLEM METHOD FORMULATION ORDER TOLERANCE, problem and
# formulation as numbers of definitions.py.
suppressMessages(library(deSolve))
words <- commandArgs(trailingOnly = TRUE)
dyn.load(words[1])
method <- words[3]
form <- as.integer(words[4])
tolerance <- as.numeric(words[6])
invisible(.C("choose", as.integer(words[2]), form))
size <- .C("sizes", three = integer(3), t_end = double(1))
n <- size$three[1]
count <- size$three[3]
begin <- .C("start", y = double(count), yp = double(count), size = double(count))
times <- c(0, size$t_end)
model <- sub("[.]so$", "", basename(words[1]))
started <- proc.time()[["elapsed"]]
caught <- ""
text <- capture.output(out <- withCallingHandlers(tryCatch(
  if (method == "radau") {
    plain <- count <= 2 * n  # an ODE
    radau(begin$y, times, "derivs", parms = NULL, dllname = model, initfunc = NULL,
          rtol = tolerance, atol = tolerance * begin$size, maxsteps = 1e7, hini = 1e-6 * size$t_end,
          nind = if (plain) c(count, 0, 0) else c(n, n, count - 2 * n),
          mass = if (plain) NULL else diag(as.numeric(seq_len(count) <= 2 * n)))
  } else {
    daspk(begin$y, times, dy = begin$yp, res = "res", parms = NULL, dllname = model, initfunc = NULL,
          rtol = tolerance, atol = tolerance * begin$size, maxsteps = 1e7,
          maxord = if (words[5] == "") 5 else as.integer(words[5]))
  }, error = function(problem) { caught <<- conditionMessage(problem); NULL }),
  warning = function(problem) {
    if (caught == "") caught <<- conditionMessage(problem)
    invokeRestart("muffleWarning")
  }))
cat("wall_s", proc.time()[["elapsed"]] - started, "\n")
cat("version", as.character(packageVersion("deSolve")), "\n")
cat("evaluations", .C("counts", both = double(2))$both[1], "\n")
if (!is.null(out)) {
  state <- attributes(out)$istate
  cat("steps", state[2], "\n")
  cat("jacobians", state[if (method == "radau") 4 else 4], "\n")
}
if (is.null(out) || nrow(out) < 2 || attributes(out)$istate[1] < 0 || out[2, 1] < size$t_end * (1 - 1e-9)) {
  cat("failure", gsub("\n", " ", if (caught == "") paste(text, collapse = " ") else caught), "\n")
} else {
  cat("end", format(out[2, 2:(n + 1)], digits = 17), "\n")
}
