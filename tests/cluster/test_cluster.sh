#!/usr/bin/env bash
# test_cluster.sh REPOSITORY: sweeps by ./tress cluster on a Slurm that this test starts and
# ends, and by Snakemake, each merged and compared with the table of one process.
set -euo pipefail
repository=$1
# shellcheck source=tests/cluster/slurm.sh
. "$repository/tests/cluster/slurm.sh"
# shellcheck source=tests/support/expect.sh
. "$repository/tests/support/expect.sh"
work=$(mktemp -d /tmp/tress-cluster-XXXXXX)
trap 'stop_slurm; [[ ${KEEP:-} ]] || rm -rf "$work"' EXIT
cd "$repository"

commands_of_page() { node tests/commands/page_commands.mjs . docs/cluster.md "$1"; }
cluster() { node experiments/cluster/cluster.mjs "$@"; }
fail() { echo "FAILED: $*"; exit 1; }

# until_true SECONDS COMMAND...
until_true() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    ((SECONDS < end)) || fail "waited in vain for: $*"
    sleep 0.2
  done
}
# shellcheck disable=SC2317  # called by until_true
idle() { [[ -z $(squeue -h 2>/dev/null) ]]; }

alone() {
  local out=$1 rc=0
  shift
  "build/release/experiments/$1" "${@:2}" --jobs 1 --progress none --out "$out" \
    2>"$work/alone.log" || rc=$?
  ((rc == 0 || rc == 3)) || { cat "$work/alone.log"; fail "$* ended with $rc"; }
}

limits=(stability_limit --quick --models 'mass_spring,der' --integrators semi_implicit_euler)
family=(family --quick --set study=twist --set hairs=8)
alone "$work/limits.csv" "${limits[@]}"
alone "$work/family.csv" "${family[@]}"
same() { node tests/cluster/same_rows.mjs "$1" "$2" || fail "$2 is not $1"; }

echo "== bad input"
expect 2 "no experiment 'nope'; there are .*stability_limit" cluster slurm nope
expect 2 "unknown option '--fast'" cluster slurm --fast family
expect 2 '--shard: the sweep gives this itself' cluster slurm family --shard 1/2
expect 2 'no sweep there' cluster status "$work"
printf 'partition = "short"\nacount = "hair"\n' >"$work/profile"
expect 2 "profile:2: no key 'acount'; there are partition, account" \
  cluster slurm --folder "$work/none" --profile "$work/profile" family
expect 2 "unknown model 'nope'" cluster slurm --folder "$work/none" family --models nope
[[ ! -e $work/none ]] || fail "a refused sweep left its folder"

echo "== an array of four"
if ! start_slurm "$work/slurm" >"$work/out"; then
  echo "left out: Slurm's daemons do not start on this machine:"
  cat "$work/out"
  exit 0
fi
printf '# of the test\npartition = "short"\nsetup = "export TRESS_TEST=1"\n' >"$work/profile"
expect 0 'submitted job [0-9]+ \(4 parts\)' \
  cluster slurm --folder "$work/l" --parts 4 --profile "$work/profile" "${limits[@]}"
expect 0 'parts: [0-4] of 4' cluster status "$work/l"
until_true 120 idle
expect 0 'parts: 4 of 4 complete' cluster status "$work/l"
same "$work/limits.csv" "$work/l/stability_limit.csv"

echo "== one task killed, and resumed"
cat >"$work/killer" <<END
if [[ \${1:-} == 2 && ! -e $work/killed ]]; then
  touch $work/killed
  (
    until [[ -s $work/f/family.2-of-4.csv.journal ]]; do sleep 0.02; done
    pkill -9 -f -- "--shard 2/4 --out $work/f/family.csv"
  ) &
fi
END
echo "setup = \". $work/killer\"" >"$work/profile"
expect 0 'submitted job' \
  cluster slurm --folder "$work/f" --parts 4 --profile "$work/profile" "${family[@]}"
expect 2 'is still at work' cluster resume "$work/f"
until_true 180 idle
expect 0 'parts: 3 of 4 complete' cluster status "$work/f"
expect 0 'next: ./tress cluster resume' cluster status "$work/f"
expect 2 'parts 2 of 4 are missing' cluster merge "$work/f"
expect 2 'holds another sweep' cluster slurm --folder "$work/f" "${limits[@]/stability_limit/family}"
expect 0 'submitted job [0-9]+ \(1 parts\)' cluster resume "$work/f"
until_true 180 idle
same "$work/family.csv" "$work/f/family.csv"

echo "== a task without disk, and one that runs out of its time"
mkdir "$work/d"
touch "$work/d/pilot.csv.journal" # as an interrupted pilot leaves it
expect 0 'wrote' cluster slurm --folder "$work/d" --parts 2 --write-only "${limits[@]}"
(ulimit -f 0; "$work/d/part.sh" 1) >"$work/out" 2>&1 && fail "a full disk went unnoticed"
expect 0 'parts: 0 of 2 complete' cluster status "$work/d"
timeout -s TERM 0.2 "$work/d/part.sh" 1 >"$work/out" 2>&1 || true
expect 0 'submitted job [0-9]+ \([12] parts\)' cluster resume "$work/d"
until_true 120 idle
same "$work/limits.csv" "$work/d/stability_limit.csv"

if command -v snakemake >/dev/null; then
  echo "== Snakemake, here and by sbatch"
  expect 0 'the table' cluster snakemake --folder "$work/s" --parts 3 --cores 2 "${limits[@]}"
  same "$work/limits.csv" "$work/s/stability_limit.csv"
  expect 0 'the table' cluster snakemake --folder "$work/t" --parts 3 --sbatch "${limits[@]}"
  same "$work/limits.csv" "$work/t/stability_limit.csv"
else
  echo "== Snakemake is not installed: left out"
fi

echo "== a head by mpirun inside a job"
simulate=$repository/build/release/experiments/simulate
sed 's/^duration_s.*/duration_s = 0.1/; s/^count.*/count = 300/' scenes/full_head.toml >"$work/head.toml"
{
  echo '#!/bin/sh'
  echo 'export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1'
  echo 'export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none'
  # The line of docs/cluster.md, with a smaller scene.
  commands_of_page '^mpirun' |
    sed "s|scenes/full_head.toml|$work/head.toml|; s|\$| --progress none --out $work/mpi|"
} >"$work/mpi.sh"
"$simulate" "$work/head.toml" --as head --progress none --out "$work/whole" 2>"$work/out"
sbatch -W -n "$(nproc)" -o "$work/mpi.log" "$work/mpi.sh" >"$work/out" 2>&1 ||
  { cat "$work/out" "$work/mpi.log"; fail "mpirun inside a job"; }
cmp "$work/whole/head.csv" "$work/mpi/head.csv" || fail "another head inside a job"

echo "== the commands of docs/cluster.md"
rm -rf results/cluster/{springs,snake}
while IFS= read -r line; do
  case $line in
    *' snakemake '*) command -v snakemake >/dev/null || continue ;;
    # Not over the published table.
    *' estimate '*) line="${line/estimate/estimate --out $work/full_sweeps.csv}" ;;
  esac
  read -ra words <<<"$line"
  expect 0 '.' cluster "${words[@]:2}"
  until_true 120 idle
done < <(commands_of_page '^./tress cluster')
(($(grep -cE '^(damping|force_transport),' "$work/full_sweeps.csv") == 2)) ||
  fail "no estimates: $(cat "$work/full_sweeps.csv")"
expect 2 "no experiment 'nope'" cluster estimate nope
for folder in springs snake; do
  [[ $folder == snake ]] && ! command -v snakemake >/dev/null && continue
  [[ -s results/cluster/$folder/stability_limit.csv ]] || fail "no table in $folder"
  rm -r "results/cluster/$folder"
done
rmdir results/cluster 2>/dev/null || true

echo "== code that has changed"
sed -i 's/"version": "/&another /' "$work/l/sweep.json"
expect 2 'begun by .another stability_limit' cluster resume "$work/l"

echo "== the merge refuses what does not belong together"
cp "$work"/l/stability_limit.1-of-4.* "$work/"
sed -i 's/"commit": "/&other/' "$work/stability_limit.1-of-4.meta.json"
expect 2 'made by commit' build/release/experiments/stability_limit "${limits[@]:1}" \
  --out "$work/m.csv" --merge "$work/stability_limit.1-of-4.csv" \
  "$work"/l/stability_limit.{2,3,4}-of-4.csv

stop_slurm
pgrep -f "$work/slurm" >/dev/null && fail "daemons are left behind"
echo "all passed"
