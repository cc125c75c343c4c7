#!/usr/bin/env bash
# test_ranks.sh SIMULATE SUPPORT: a head with a body and hairs that touch, by mpirun: the same
# results for any number of ranks and threads, also after a rank was killed, time ran out, or
# a disk was full, and other ranks went on; a rank has its share of the strands, and one that
# fails says so. Ends with 77, and says why, where there is no MPI.
set -euo pipefail
simulate=$1
# shellcheck source=tests/support/expect.sh
. "$2/expect.sh"
command -v mpirun >/dev/null || { echo "left out: no mpirun (cmake/mpi_packages.txt)"; exit 77; }
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# As many ranks as there are, on a machine that others use too.
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none \
  OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_btl=self,vader
work=$(mktemp -d /tmp/tress-ranks-XXXXXX)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "FAILED: $*"; exit 1; }
cat >head.toml <<'TOML'
title = "hairs that touch, on a turning head"
duration_s = 1
frames_per_s = 10
checkpoint_s = 0.1
[model]
id = "super_helix"
jacobian = "elastic"
[integrator]
id = "linearly_implicit_euler"
dt_s = 0.005
[material]
name = "hair.caucasian"
[groom]
count = 70
elements = 4
length_m = 0.1
[root]
motion = "rotate"
axis = [0, 0, 1]
angle_rad = 0.5
[effects.gravity]
[effects.linear_drag]
drag_kg_m_s = 1e-4
[effects.body]
shape = "ellipsoid"
half_axes_m = [0.11, 0.1, 0.13]
moves = "head"
[effects.strand_interaction]
outer_radius_m = 0.02
TOML

# head OUT RANKS [option...]
head() {
  local out=$1 ranks=$2 by=()
  ((ranks == 0)) || by=(mpirun -n "$ranks")
  "${by[@]}" "$simulate" head.toml --as batch --frames 64 --progress none --out "$out" "${@:3}"
}
state() { sed -n 's/.*"state_hash": *"\([0-9a-f]*\)".*/\1/p' "$1/head.meta.json"; }
# same OUT: its results are those of one process.
same() {
  [[ -n $(state one) && $(state "$1") == "$(state one)" ]] || fail "$1: other states"
  cmp one/head.csv "$1/head.csv" || fail "$1: another series"
  cmp one/head.json "$1/head.json" || fail "$1: other pictures"
}

head one 0 2>log || { cat log; fail "one process"; }
if ! head r1 1 2>log && grep -q 'built without MPI' log; then
  echo "left out: built without MPI (cmake/mpi_packages.txt)"
  exit 77
fi
same r1
for case in '2' '4' '2 --threads 2'; do
  read -ra words <<<"$case"
  rm -rf "r${words[0]}"
  head "r${words[0]}" "${words[@]}" 2>log || { cat log; fail "$case"; }
  same "r${words[0]}"
done
grep -q '"ranks": 2' r2/head.meta.json || fail "the outcome does not name the ranks"
# number OUT COLUMN: rounded.
number() { printf '%.0f' "$(sed -n "s/.*\"$2\": *\([0-9][0-9.e+-]*\).*/\1/p" "$1/head.meta.json")"; }
# Equal shares, unless they are divided anew by the time that they take.
mkdir shares
sed 's/^duration_s.*/duration_s = 0.1/; /^checkpoint_s/d' head.toml >shares/head.toml
for case in '2 35' '4 18'; do
  read -r ranks strands <<<"$case"
  mpirun -n "$ranks" "$simulate" shares/head.toml --as batch --progress none --out shares 2>log
  [[ $(number shares rank_strands) == "$strands" ]] ||
    fail "a rank of $ranks has $(number shares rank_strands) strands"
done
(($(number r4 ghosts_per_step) > 0)) || fail "no strand of another rank may touch"

# Longer, so that a rank can be killed under way; the same again by one process.
sed -i 's/^duration_s = 1/duration_s = 3/' head.toml
head one 0 2>log
mpirun -n 2 "$simulate" head.toml --as batch --frames 64 --progress none --out killed 2>log &
job=$!
for _ in {1..600}; do [[ -s killed/head.state ]] && break; sleep 0.02; done
mapfile -t ranks < <(pgrep -P "$job" -x simulate)
((${#ranks[@]} == 2)) || fail "${#ranks[@]} ranks run"
kill -9 "${ranks[1]}"
wait "$job" && fail "a killed rank went unnoticed"
lines=$(grep -c '^simulate: .*--resume continues from the last saved state' log || true)
((lines == 1)) || { cat log; fail "$lines lines say what to do"; }
[[ -s killed/head.state ]] || fail "nothing to go on from"
head killed 4 --resume 2>log || { cat log; fail "resumed by four"; }
same killed

# Time runs out: Slurm and others send SIGTERM some seconds before they kill.
mpirun -n 2 "$simulate" head.toml --as batch --frames 64 --progress none --out timed 2>log &
job=$!
for _ in {1..600}; do [[ -s timed/head.state ]] && break; sleep 0.02; done
kill -TERM "$job"
wait "$job" && fail "mpirun that was told to end came to its end"
grep -q '^simulate: interrupted' log || { cat log; fail "the end of its time went unnoticed"; }
head timed 2 --resume 2>log || { cat log; fail "resumed after its time was over"; }
same timed

# alone CODE REGEX RANK OUT BEFORE: BEFORE goes before the command of that rank of two; it
# alone fails, with one line, and ends both with this code.
alone() {
  local args="head.toml --as batch --frames 64 --progress none --out $4" rc=0 lines
  local with=(-n 1 bash -c "$5; exec '$simulate' $args") without=(-n 1 "$simulate")
  read -ra args <<<"$args"
  without+=("${args[@]}")
  if (($3 == 0)); then
    mpirun "${with[@]}" : "${without[@]}" 2>log || rc=$?
  else
    mpirun "${without[@]}" : "${with[@]}" 2>log || rc=$?
  fi
  lines=$(grep -c '^simulate: .*error' log || true)
  if ((rc != $1 || lines != 1)) || ! grep -qE "$2" log; then
    cat log
    fail "rank $3 alone ended with $rc and $lines lines"
  fi
  if grep -q '^simulate: interrupted' log; then
    cat log
    fail "rank $3 alone: a second line"
  fi
}
mkdir elsewhere
alone 2 "^simulate: rank 1 of 2, on $(hostname): error: cannot (open|read).*head.toml" 1 no 'cd elsewhere'
alone 2 '^simulate: error: cannot (open|read).*head.toml' 0 no 'cd elsewhere'
# A rank without room for its strands, beside MPI's own memory.
sed 's/^count = .*/count = 1000000/; /strand_interaction/,$d' head.toml >many.toml
mv head.toml kept.toml && mv many.toml head.toml
alone 2 "^simulate: rank 1 of 2, on $(hostname): error: a batch of 1000000 strands .*needs" 1 no 'ulimit -v 800000'
mv kept.toml head.toml

# A full disk: the first rank, which writes, says so; the run goes on where there is room.
# By TCP, for which MPI needs no files of its own.
OMPI_MCA_btl=self,tcp alone 2 '^simulate: error: cannot write' 0 full 'ulimit -f 100'
[[ -s full/head.state ]] || fail "a full disk left nothing to go on from"
head full 2 --resume 2>log || { cat log; fail "resumed where there is room"; }
same full

expect 2 'strands that run one by one are not shared by ranks' \
  mpirun -n 2 "$simulate" head.toml --as strands --out no
sed -i 's/^count = .*/count = 3/' head.toml
expect 2 '3 strands for 4 ranks' mpirun -n 4 "$simulate" head.toml --as batch --out no
