#!/usr/bin/env bash
# picture.sh PAGE ADDRESS OUT.png [WIDTH,HEIGHT] [light|dark]: one picture of a scene by
# headless Chromium, e.g. picture.sh results/report.html 'scene=shake&frame=12' shake.png
set -euo pipefail
page=$(realpath "${1:?page}")
address=${2:?address, e.g. scene=shake&frame=12}
out=$(realpath "${3:?PNG to write}")
size=${4:-1200,900}
case ${5:-light} in
  light) scheme=1 ;;
  dark) scheme=0 ;;
  *) echo "picture.sh: '$5' is not light or dark" >&2; exit 2 ;;
esac
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT
# --screenshot succeeds without a file when the page cannot be read.
rm -f "$out"
"${CHROMIUM:-chromium}" --headless --no-sandbox --disable-gpu --disable-quic --no-first-run \
  --disable-background-networking --disable-component-update --disable-sync \
  --hide-scrollbars --blink-settings=preferredColorScheme="$scheme" \
  --user-data-dir="$profile" --window-size="$size" --virtual-time-budget=4000 \
  --screenshot="$out" "file://$page#$address&full=picture" 2>"$profile/log" ||
  { cat "$profile/log" >&2; exit 1; }
[[ -s $out ]] || { echo "picture.sh: $out was not written" >&2; exit 1; }
