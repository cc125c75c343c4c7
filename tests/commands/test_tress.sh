#!/usr/bin/env bash
# test_tress.sh usage | list REPOSITORY: what ./tress promises on the command line. Programs
# that would change the machine are replaced by stand-ins first on the PATH.
set -euo pipefail
what=$1 repository=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" "$work/a b"

# program_at FILE, stand_in NAME: read the program's body from standard input.
program_at() {
  { echo '#!/usr/bin/env bash'; cat; } >"$1"
  chmod +x "$1"
}
stand_in() { program_at "$work/bin/$1"; }
stand_in apt-get <<<"touch '$work/apt_was_called'; exit 1"
stand_in sudo <<<'exit 1'
# shellcheck disable=SC2016  # the stand-in expands it
everything_installed() { stand_in dpkg-query <<<'printf "installed %s\n" "${@:3}"'; }
nothing_installed() { stand_in dpkg-query <<<'exit 1'; }

# shellcheck source=tests/support/expect.sh
. "$repository/tests/support/expect.sh"
expect_in=(env -C "$work/a b" "PATH=$work/bin:$PATH")
expect_one_line() {
  [[ $(wc -l <"$work/out") == 1 ]] || { echo "not one line:"; cat "$work/out"; exit 1; }
}

usage() {
  everything_installed
  expect 2 "unknown command 'frobnicate'.*tress help" "$repository/tress" frobnicate
  expect_one_line
  expect 2 "unknown option '--fast'" "$repository/tress" run --fast
  expect_one_line
  expect 2 "unknown option '--fast'" "$repository/tress" test --fast
  expect 2 "unknown option '--fast'" "$repository/tress" python --fast
  expect_one_line
  expect 2 "no interpreter '/none'" "$repository/tress" python --interpreter /none
  expect_one_line
  expect 2 "unknown option '--fast'" "$repository/tress" docs --fast
  expect_one_line
  expect 0 './tress setup' "$repository/tress" help
  expect 0 './tress setup' "$repository/tress"

  ln -s "$repository/tress" "$work/a b/linked"
  expect 0 './tress setup' "$work/a b/linked" help

  # Neither root nor sudo: the command to type, and nothing is touched.
  nothing_installed
  stand_in id <<<'echo 1000'
  expect 2 'run: sudo apt-get update && sudo apt-get install .*ninja-build' \
    env TRESS_CACHE="$work/cache" "$repository/tress" setup
  expect_one_line
  expect 2 'sudo apt-get install .*libode-dev' \
    env TRESS_CACHE="$work/cache" "$repository/tress" peers
  expect_one_line
  expect 2 'sudo apt-get install .*furo' \
    env TRESS_CACHE="$work/cache" "$repository/tress" docs
  expect_one_line
  stand_in id <<<'echo 0'
  expect 2 'tress: --no-install: [0-9]+ packages are missing: .*ninja-build' \
    env TRESS_CACHE="$work/cache" "$repository/tress" --no-install build
  expect_one_line
  [[ ! -e $work/apt_was_called ]] || { echo "apt-get was called without rights"; exit 1; }

  # As root, a failing apt-get ends setup with its log's path.
  stand_in id <<<'echo 0'
  expect 1 "apt-get failed; log: $work/cache/packages.log" \
    env TRESS_CACHE="$work/cache" "$repository/tress" setup

  sources
  clusters
  left_out
  refusals
  asks
}

# Schedulers read paths in ways of their own: one that they could take for something else is
# refused, and no folder is left.
clusters() {
  local folder
  mkdir "$work/programs"
  echo heads >"$work/programs/list.txt"
  # shellcheck disable=SC2016  # names, not commands
  for folder in 'a b' '$(touch x)' 'a%b' 'a{b}' $'a\nb'; do
    expect 2 "in its path, which Slurm and Snakemake may take for something else" \
      env "TRESS_PROGRAMS=$work/programs" node "$repository/experiments/cluster/cluster.mjs" \
      slurm --folder "$work/sweeps/$folder" heads
  done
  [[ ! -e $work/sweeps ]] || { echo "a refused sweep left its folder"; exit 1; }
}

# An experiment that cannot run does not keep one from running whose name ends its own.
left_out() {
  local house="$work/house" studies="$work/house/build/release/experiments"
  everything_installed
  stand_in cmake <<<'exit 0'
  stand_in node <<<'exit 0'
  mkdir -p "$house/cmake" "$studies" "$house/experiments/report/dist"
  cp "$repository/tress" "$house"
  cp "$repository"/cmake/*.txt "$house/cmake"
  touch "$house/experiments/report/dist/report.mjs"
  echo 'echo /usr' | program_at "$house/cmake/sundials.sh"
  echo 'echo heads ran' | program_at "$studies/heads"
  echo heads >"$studies/list.txt"
  echo 'divided_heads: no MPI' >"$studies/left_out.txt"
  expect 0 'heads ran' "$house/tress" run
  expect 0 'heads ran' "$house/tress" run heads
  expect 2 'divided_heads cannot run here' "$house/tress" run divided_heads
  expect 2 "no experiment '.*_heads'" "$house/tress" run '.*_heads'
}

# study NAME BODY: an experiment of the house that left_out made.
study() { echo "$2" | program_at "$work/house/build/release/experiments/$1"; }

# What can refuse does so before anything runs; what is not done is said at the end.
refusals() {
  local house="$work/house"
  printf 'heads\nfull\nrubs\n' >"$house/build/release/experiments/list.txt"
  # shellcheck disable=SC2016  # the study expands it
  study heads '[[ " $* " == *" --check "* ]] || echo heads ran'
  # shellcheck disable=SC2016
  study full '[[ " $* " == *" --check "* ]] || { echo no space; exit 2; }'
  study rubs 'echo an earlier run did not finish; exit 2'
  expect 2 'nothing was run.*--resume heads full rubs' "$house/tress" run
  grep -q 'did not finish' "$work/out" || { cat "$work/out"; exit 1; }
  ! grep -q 'heads ran' "$work/out" || { echo "one ran before another refused"; exit 1; }
  # shellcheck disable=SC2016
  study rubs '[[ " $* " == *" --check "* ]] || exit 3'
  expect 2 'NOT DONE, its table is that of an earlier run: full \(exit code 2\)' \
    "$house/tress" run
  expect 2 'to go on: ./tress run --resume --full full$' "$house/tress" run --full
  grep -q 'heads ran' "$work/out" || { echo "heads did not run"; exit 1; }
  tail -n6 "$work/out" | grep -q 'left out.*divided_heads: no MPI' ||
    { echo "what is left out is not said at the end"; exit 1; }
  # shellcheck disable=SC2016
  study full '[[ " $* " == *" --check "* ]] || exit 130'
  expect 130 'interrupted in full; not finished: full rubs; to go on: ./tress run --resume' \
    "$house/tress" run
}

# Each scene has a folder of its own, whatever it is called, and none is another's.
asks() {
  local house="$work/house" name
  printf 'x\n' >"$house/results/hard_cases.csv"
  for name in stability_limit hard_cases effect_audit cost_of_accuracy; do
    # shellcheck disable=SC2016
    study "$name" 'while [[ $1 != --out ]]; do [[ $1 != references=* ]] || mkdir -p "${1#*=}"
      shift; done; echo table >"$2"'
  done
  mkdir -p "$work/own/a" "$work/own/b"
  # shellcheck disable=SC2016  # a name, not a command
  for name in ...toml .toml a/s.toml b/s.toml 'a/$(touch x).toml' 'a/x y.toml'; do
    touch "$work/own/$name"
    expect 0 'the answers: ' "$house/tress" ask "$work/own/$name"
  done
  [[ $(ls "$house/results") == $'ask\nhard_cases.csv' && $(<"$house/results/hard_cases.csv") == x ]] ||
    { echo "ask wrote into results/:"; ls "$house/results"; exit 1; }
  [[ $(find "$house/results/ask" -name hard_cases.csv | wc -l) == 6 ]] ||
    { echo "scenes share a folder:"; ls "$house/results/ask"; exit 1; }
  [[ $(find "$house/results/ask" -type d -name reference | wc -l) == 6 ]] ||
    { echo "scenes share references:"; find "$house/results/ask"; exit 1; }
  touch "$work/own/a,b.toml"
  expect 2 'simulate: give one scene file' "$house/tress" simulate
  expect 2 'simulate: give one scene file' "$house/tress" simulate --help
  expect 2 "simulate: no file 'none.toml'" "$house/tress" simulate none.toml
  expect 2 "is a folder" "$house/tress" simulate "$work/own/a"
  expect 2 "give one scene" "$house/tress" simulate "$work/own/a/s.toml" "$work/own/b/s.toml"
  expect 2 "simulate: --out is results/simulate/s-" \
    "$house/tress" simulate "$work/own/a/s.toml" --out here
  expect 2 'no-install: give a command' "$house/tress" --no-install
  # shellcheck disable=SC2016
  study simulate 'echo "ran $*"'
  expect 0 'build: [0-9]+ s' "$house/tress" simulate "$work/own/a/s.toml" --error-bars
  grep -q "ran $work/own/a/s.toml --out results/simulate/s-[0-9]*/scenes --error-bars" "$work/out" ||
    { cat "$work/out"; exit 1; }
  expect 0 'open in a browser: .*/results/simulate/s-[0-9]+/report.html#tab-scenes' \
    "$house/tress" simulate "$work/own/b/s.toml"
  expect 2 'has a comma' "$house/tress" ask "$work/own/a,b.toml"
}

# Source-package entries come from the distribution's own suites only.
sources() {
  cat >"$work/machine.sources" <<'END'
# a comment
Types: deb
URIs: mirror://one
Suites: bookworm bookworm-updates
 bookworm-backports
Components: main
Signed-By: /usr/share/keyrings/a.gpg

Types: deb
URIs: mirror://other
Suites: nodistro
Components: main

Enabled: no
Types: deb
URIs: mirror://off
Suites: bookworm
Components: main
END
  expect 0 'URIs: mirror://one' \
    awk -v codename=bookworm -f "$repository/cmake/deb_src.awk" RS= "$work/machine.sources"
  diff - "$work/out" <<'END'
Types: deb-src
URIs: mirror://one
Suites: bookworm bookworm-updates
Components: main
Signed-By: /usr/share/keyrings/a.gpg

END
}

list() {
  everything_installed
  expect 0 '^experiments:' "$repository/tress" list
}

"$what"
