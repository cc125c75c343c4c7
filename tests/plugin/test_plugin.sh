#!/usr/bin/env bash
# test_plugin.sh REPOSITORY BUILD INSTALLED OPTION...: builds the example by the commands of
# docs/plugins.md, with these options of cmake more, runs those that use it, and looks at
# what they write; then what must be found or refused.
set -euo pipefail
repository=$1 build=$2 installed=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/build"
ln -s "$build" "$work/build/release"
ln -s "$installed" "$work/build/tress"
ln -s "$repository/tests" "$work/tests"
# shellcheck source=tests/support/expect.sh
. "$repository/tests/support/expect.sh"
cd "$work"

# --- the page's own commands, as they stand ------------------------------------------------
mapfile -t commands < <(python3 "$repository/tests/commands/page_commands.py" "$repository" \
  docs/plugins.md '^(build/|cmake -S|cmake --build)')
((${#commands[@]} >= 8)) || { echo "docs/plugins.md has lost its commands"; exit 1; }
for command in "${commands[@]}"; do
  more=()
  [[ $command != "cmake -S"* ]] || more=("$@")
  expect 0 . bash -c "$command \"\$@\"" - "${more[@]}"
  case $command in
    *--list) cp out list ;;
    *--print-schema) cp out schema ;;
  esac
done
library=build/plugin/libexample.so

for id in simo_reissner sdirk2; do
  grep -qE "^  $id .*\(" list || { echo "--list lacks $id"; exit 1; }
done
# The tip at rest in the field, 0.849 mm, within 1 %: 10 elements err by 0.3 %, and the
# square of the slope is 6e-4.
tail -n 1 results/scenes/magnet.csv | awk -F, '{ exit !($4 > 8.41e-4 && $4 < 8.57e-4) }' ||
  { echo "the magnetic rod has another deflection:"; tail -n 1 results/scenes/magnet.csv; exit 1; }
grep -q 'effects.rotating_frame' schema || { echo "the schema lacks the effect"; exit 1; }
while read -r name; do
  [[ $name == simulate ]] || # has other options
    expect 0 '^  simo_reissner ' "build/release/experiments/$name" --plugin "$library" --list
done <build/release/experiments/list.txt
for row in 'stability_limit:,simo_reissner,.*,ok,' 'hard_cases:,simo_reissner,.*,sdirk2,' \
  'hard_cases:,corde,.*,sdirk2,.*,true,' \
  'work_precision.turntable:,simo_reissner,.*,sdirk2,.*,ok,'; do
  grep -qE "${row#*:}" "results/${row%%:*}.csv" ||
    { echo "no row '${row#*:}':"; cat "results/${row%%:*}.csv"; exit 1; }
done

grep -q '"file": "build/plugin/libexample.so"' results/stability_limit.meta.json ||
  { echo "the manifest does not name the plug-in"; exit 1; }
node "$repository/experiments/report/dist/report.mjs" results --out results/report.html
grep -q simo_reissner results/report.html || { echo "the page lacks the model"; exit 1; }

# --- a batch of its model, by its method, and by mpirun --------------------------------------
cat >batch.toml <<'TOML'
title = "a groom of the plug-in's rod"
duration_s = 0.02
frames_per_s = 100
[model]
id = "simo_reissner"
[integrator]
id = "sdirk2"
dt_s = 0.002
[material]
[groom]
count = 6
elements = 4
length_m = 0.05
[root]
motion = "shake"
[effects.gravity]
[effects.linear_drag]
TOML
# run_as KIND OUT [COMMAND...]
run_as() {
  expect 0 . "${@:3}" build/release/experiments/simulate batch.toml --plugin "$library" \
    --as "$1" --progress none --out "$2"
}
hash_of() { sed -n 's/.*"state_hash": *"\([0-9a-f]*\)".*/\1/p' "$1/batch.meta.json"; }
run_as batch batch
run_as strands strands
[[ $(wc -l <batch/batch.csv) == 4 ]] || { echo "not three frames:"; cat batch/batch.csv; exit 1; }
python3 - <<'PYTHON'
import csv
def last(folder):
    return list(csv.DictReader(open(f"{folder}/batch.csv")))[-1]
batch, strands = last("batch"), last("strands")
both = [name for name in strands if name.endswith("_j") and name in batch]
assert len(both) > 3, both
scale = max(abs(float(strands[name])) for name in both)
assert scale > 0
for name in both:  # replicated systems take the steps of a single strand
    assert abs(float(batch[name]) - float(strands[name])) <= 1e-9 * scale, name
PYTHON
if command -v mpirun >/dev/null; then
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
    OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none \
    OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_btl=self,vader
  run_as batch ranks mpirun -n 2
  [[ -n $(hash_of batch) && $(hash_of ranks) == "$(hash_of batch)" ]] ||
    { echo "two ranks end in another state"; exit 1; }
fi

# --- the contract suites -------------------------------------------------------------------
mapfile -t checks <build/release/tests/checks.txt
for check in "${checks[@]}"; do
  expect 0 '^PASS ' "build/release/tests/$check" --plugin="$library"
  cat out >>checked
done
for contract in SystemContract.TangentIsTheDerivativeOfTheResidual \
  SystemContract.TangentTestSeesAMissingTerm SystemContract.ResidualIsPure \
  SystemContract.EnergyChangesByThePowerOfTheRemainingForces \
  Allocation.ModelCallsAllocateNothingAfterTheFirst EffectCost.OnlyWhatIsAskedForIsComputed \
  EffectContract.DerivativesByPlaceAreDifferencesOfTheLoad \
  EffectsOnModels.TheTangentIsExactForEveryEffect FixedStepOrder.ErrorFallsAtTheNominalOrder \
  FixedStepOnStrands.ErrorFallsAtTheNominalOrder Gaps.EveryFormulationThatTheMethodLacks; do
  grep -qE "^PASS $contract.*: [1-9][0-9]* passed" checked ||
    { echo "$contract was not checked:"; cat checked; exit 1; }
done
spoilt=build/plugin/libspoilt.so
expect 3 '^FAIL SystemContract.TangentIsTheDerivativeOfTheResidual' \
  build/release/tests/test_contracts --plugin="$spoilt"
grep -q '^PASS SystemContract.ResidualIsPure' out

# --- what is refused, in one line ----------------------------------------------------------
refused() {
  local pattern=$1
  shift
  expect 2 "error: .*$pattern" "$@"
  [[ $(wc -l <out) == 1 ]] || { echo "not one line:"; cat out; exit 1; }
}
spoil() { sed "s/$1/$2/" "$library" >spoilt.so; }
program=build/release/experiments/stability_limit
refused 'none.so' "$program" --plugin none.so --list
refused 'no plug-in of tress' "$program" --plugin "$repository/README.md" --list
refused 'no plug-in of tress' "$program" --plugin "$(command -v node)" --list
spoil '|version=[0-9.]*|' '|version=0.0.1|'
refused 'built for tress 0\.0\.1, this is' "$program" --plugin spoilt.so --list
refused 'built for tress 0\.0\.1, this is' build/release/experiments/simulate \
  --plugin spoilt.so --print-schema
refused 'built for tress 0\.0\.1, this is' build/release/tests/test_contracts \
  --plugin=spoilt.so
spoil '|headers=.' '|headers=x'
refused 'other headers' "$program" --plugin spoilt.so --list
spoil '|compiler=[A-Za-z]*' '|compiler=abc'
refused 'other compiler' "$program" --plugin spoilt.so --list
spoil '|sizes=.' '|sizes=9'
refused 'other sizes' "$program" --plugin spoilt.so --list
head -c 20000 "$library" >spoilt.so
grep -qa '|sizes=' spoilt.so && refused 'cannot be loaded' "$program" --plugin spoilt.so --list
refused "a model 'simo_reissner' already" "$program" --plugin "$library" --plugin "$spoilt" --list

# --- tables of other plug-ins do not mix ---------------------------------------------------
rows=(--models der --elements 1 --set scene=release --set damping=none
  --integrators linearly_implicit_euler --quick --out one.csv)
expect 0 . "$program" --plugin "$library" "${rows[@]}"
refused 'other settings' "$program" "${rows[@]}" --resume
refused 'other settings' "$program" --plugin "$spoilt" "${rows[@]}" --resume
expect 0 . "$program" --plugin "$library" "${rows[@]}" --resume
printf 'plugin = ["%s"]\nmodels = "simo_reissner"\n' "$library" >options.toml
expect 0 simo_reissner "$program" --options options.toml --quick --dry-run
