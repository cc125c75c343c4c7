#!/usr/bin/env bash
# test_readme.sh REPOSITORY BUILD: runs what the README tells its reader to type, as it is
# written: every line of its code blocks that begins with build/ or ./tress. Left out are
# the commands of ./tress that build, which their own tests look at. It runs in a copy
# whose results/ is its own; build/release there is BUILD.
set -euo pipefail
repository=$1 build=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/build"
ln -s "$build" "$work/build/release"
cp -r "$repository/tress" "$repository/README.md" "$repository/results" "$work"
for folder in cmake experiments scenes; do ln -s "$repository/$folder" "$work/$folder"; done
rm -rf "$work/results/scenes"

commands=$(awk '/^```/ { inside = !inside; next }
                inside && /^(build\/|\.\/tress)/ { print }' "$work/README.md" |
  grep -vE '^\./tress (run|test|bench|peers|setup)\b')
[[ $(wc -l <<<"$commands") -ge 4 ]] || { echo "README.md has no commands"; exit 1; }

cd "$work"
while IFS= read -r command; do
  echo "+ $command"
  before=$SECONDS
  bash -c "$command" >"$work/log" 2>&1 </dev/null || {
    echo "FAILED with $?; output:"
    cat "$work/log"
    exit 1
  }
  echo "  $((SECONDS - before)) s"
done <<<"$commands"
