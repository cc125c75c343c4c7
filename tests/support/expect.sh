# shellcheck shell=bash
# For tests that call commands; to be sourced. $work is the test's own folder.

expect_in=() # stands before every command, as in (env -C folder)

# expect CODE PATTERN COMMAND...: exit code and, in one line of its output, the pattern.
# The output is left in $work/out.
expect() {
  local code=$1 pattern=$2 rc=0
  shift 2
  # shellcheck disable=SC2154  # work is the caller's
  "${expect_in[@]}" "$@" >"$work/out" 2>&1 </dev/null || rc=$?
  if ((rc != code)) || ! grep -qE -- "$pattern" "$work/out"; then
    echo "FAILED: $* gave $rc, expected $code and '$pattern'; output:"
    cat "$work/out"
    exit 1
  fi
}
