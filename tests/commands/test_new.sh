#!/usr/bin/env bash
# test_new.sh REPOSITORY COMPILER: what ./tress new writes for each kind, in a copy of the files
# that it reads: sources that compile and are formatted, a line in each list, nothing on refusal.
set -euo pipefail
repository=$1 compiler=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
house=$work/house
lists=(models/catalogue.cpp models/CMakeLists.txt models/effects/catalogue.cpp
  integrators/catalogue.cpp integrators/CMakeLists.txt experiments/CMakeLists.txt)
mkdir -p "$house"/{models/{elements,effects},integrators,experiments,tests,cmake,python}
for file in tress .clang-format tests/CMakeLists.txt "${lists[@]}"; do
  cp "$repository/$file" "$house/$file"
done
cp -r "$repository/cmake/new" "$house/cmake/new"
cp -r "$repository/python/tress_command" "$house/python/tress_command"

# shellcheck source=tests/support/expect.sh
. "$repository/tests/support/expect.sh"
fail() { echo "FAILED: $*"; exit 1; }
files() { find "$house" -type f -not -path '*/__pycache__/*' -exec md5sum {} + | sort -k2; }

# source_of KIND NAME
source_of() {
  case $1 in
    model) echo "models/elements/$2.cpp" ;;
    effect) echo "models/effects/$2.cpp" ;;
    integrator) echo "integrators/$2.cpp" ;;
    study) echo "experiments/$2/main.cpp" ;;
  esac
}
# lines_of KIND NAME: file and line, of all that is to be in the lists.
lines_of() {
  case $1 in
    model)
      echo "models/catalogue.cpp ModelEntry $2_entry();"
      echo "models/catalogue.cpp       $2_entry(),"
      echo "models/CMakeLists.txt   elements/$2.cpp" ;;
    effect)
      echo "models/effects/catalogue.cpp EffectEntry $2_entry();"
      echo "models/effects/catalogue.cpp       $2_entry(),"
      echo "models/CMakeLists.txt   effects/$2.cpp" ;;
    integrator)
      echo "integrators/catalogue.cpp   METHOD($2)"
      echo "integrators/CMakeLists.txt   $2.cpp" ;;
    study) echo "experiments/CMakeLists.txt tress_study($2)" ;;
  esac
}

# Twice, so that the second line of a list has its place too; and by a name that is longer
# than all others, beyond which a list is aligned anew.
for kind in model effect integrator study; do
  for name in "my_$kind" "longest_name_of_all_${kind:0:5}s_here"; do
    expect 0 "wrote $(source_of "$kind" "$name")" "$house/tress" new "$kind" "$name"
    (($(grep -c '^  ' "$work/out") == 2)) || fail "not two commands: $(<"$work/out")"
    source=$house/$(source_of "$kind" "$name")
    ! grep -q skeleton_name "$source" || fail "$source has the skeleton's name"
    grep -q 'fill_in(' "$source" || fail "$source leaves nothing to fill in"
    while read -r list line; do
      # shellcheck disable=SC2001  # read has taken the spaces before the line
      grep -qE "^ *$(sed 's/[][().*+]/\\&/g' <<<"$line")( *\\\\)?$" "$house/$list" ||
        fail "$list lacks '$line'"
    done < <(lines_of "$kind" "$name")
    [[ $name != my_$kind ]] || "$compiler" -std=c++20 -fsyntax-only -I"$repository" -Wall -Wextra -Wpedantic \
      -Wconversion -Wshadow -Wno-psabi -Werror "$source" || fail "$source does not compile"
    before=$(files)
    expect 2 "the name '$name' is taken|exists already" "$house/tress" new "$kind" "$name"
    [[ $(wc -l <"$work/out") == 1 && $(files) == "$before" ]] || fail "refused, yet written"
  done
done
if command -v clang-format >/dev/null; then
  find "$house" -name '*.cpp' -exec clang-format --dry-run -Werror {} +
fi

# The force of docs/start/own_force.md.
# shellcheck disable=SC2016  # the expression has backquotes, not commands
sed -n '/^```cpp/,/^```/{/^```/!p}' "$repository/docs/start/own_force.md" >"$work/trap.cpp"
"$compiler" -std=c++20 -fsyntax-only -I"$repository" -Wall -Wextra -Wpedantic -Wno-psabi -Werror "$work/trap.cpp" ||
  fail "the force of docs/start/own_force.md does not compile"

before=$(files)
refused() { # PATTERN ARGUMENT...
  expect 2 "$1" "$house/tress" new "${@:2}"
  [[ $(wc -l <"$work/out") == 1 ]] || fail "not one line: $(<"$work/out")"
  [[ $(files) == "$before" ]] || fail "refused, yet written: ${*:2}"
}
refused 'give a kind and a name' model
refused 'give a kind and a name' model a b
refused "unknown kind 'curl'.*model\|effect\|integrator\|study" curl name
for name in '' A 1a a-b ../a 'a b' a__b _a a_ $'a\nb' ä a123456789012345678901234567890123; do
  refused 'is no name' model "$name"
done
for name in class double test skeleton_name; do
  refused 'is a word of C\+\+ or of the build' study "$name"
done
refused "'der' is taken \(models/catalogue.cpp\)" model der
refused "'super_helix' is taken" effect super_helix
refused "'rk4' is taken \(integrators/catalogue.cpp\)" model rk4
refused "'gravity' is taken" integrator gravity
refused "'damping' is taken" study damping
refused "'numerics' is taken" study numerics
mkdir "$house/experiments/report"
before=$(files)
refused 'exists already \(experiments/report\)' study report

# A place that cannot be written: what was written before it is taken back.
mkdir "$house/models/.CMakeLists.txt.new"
refused 'cannot be written, and nothing was \(models/CMakeLists.txt\)' model other
rmdir "$house/models/.CMakeLists.txt.new"
[[ -z $(find "$house" -type f -name '*.new') ]] || fail "files of its own are left"
sed -i '/^  ALONE/d' "$house/integrators/CMakeLists.txt"
before=$(files)
refused 'no place for a new line \(integrators/CMakeLists.txt\)' integrator other
rm "$house/models/effects/catalogue.cpp"
before=$(files)
refused 'cannot be read \(models/effects/catalogue.cpp\)' effect other
