#!/usr/bin/env bash
# test_readme.sh REPOSITORY BUILD: runs what the README tells its reader to type, as it is
# written: every line of its code blocks that begins with build/ or ./tress. Left out are
# the commands of ./tress that build, which their own tests look at. It runs in a copy of
# the repository, which it may change; build/release there is BUILD.
set -euo pipefail
repository=$1 build=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tar -C "$repository" --exclude=./build --exclude=./.git --exclude=./results/scenes \
  --exclude=node_modules -c . | tar -C "$work" -x
mkdir "$work/build"
ln -s "$build" "$work/build/release"

commands=$(awk '/^```/ { inside = !inside; next }
                inside && /^(build\/|\.\/tress)/ { print }' "$work/README.md" |
  grep -vE '^\./tress (run|test|bench|peers|python|setup)\b')
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
