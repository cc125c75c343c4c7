#!/usr/bin/env bash
# picture.sh PAGE ADDRESS OUT.png [WIDTH,HEIGHT] [light|dark]: one picture of a scene by
# headless Chromium, e.g. picture.sh results/report.html 'scene=shake&frame=12' shake.png
set -euo pipefail
fail() { echo "picture.sh: $1" >&2; exit 2; }
(($# >= 3)) || fail "three arguments are needed: PAGE 'scene=NAME&frame=12' OUT.png"
# realpath -m: an absolute path, also of a name that starts with '-'.
page=$(realpath -m -- "$1")
[[ -f $page && -r $page ]] || fail "$1: no such page; write it with ./tress report"
address=$2
out=$(realpath -m -- "$3")
[[ -d ${out%/*} ]] || fail "$3: its folder does not exist"
size=${4:-1200,900}
[[ $size =~ ^[0-9]+,[0-9]+$ ]] || fail "'$size' is not WIDTH,HEIGHT in pixels"
case ${5:-light} in
  light) scheme=1 ;;
  dark) scheme=0 ;;
  *) fail "'$5' is not light or dark" ;;
esac

# $1 with everything percent-encoded but the characters that stand for themselves in a path.
encoded() {
  local LC_ALL=C text=$1 out='' i c
  for ((i = 0; i < ${#text}; ++i)); do
    c=${text:i:1}
    case $c in
      [A-Za-z0-9/._~-]) out+=$c ;;
      *) printf -v c '%d' "'$c"; printf -v c '%%%02X' $((c & 255)); out+=$c ;;
    esac
  done
  printf '%s' "$out"
}

sandbox=()
# Root has none of the namespaces that the sandbox is made of.
(($(id -u) != 0)) || sandbox=(--no-sandbox)
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT
# Chromium writes beside its profile: --screenshot takes no name with some characters, and
# succeeds without a file when the page cannot be read.
"${CHROMIUM:-chromium}" --headless "${sandbox[@]}" --disable-gpu \
  --enable-unsafe-swiftshader --disable-quic --no-first-run \
  --disable-background-networking --disable-component-update --disable-sync \
  --hide-scrollbars --blink-settings=preferredColorScheme="$scheme" \
  --user-data-dir="$profile" --window-size="$size" --virtual-time-budget=4000 \
  --screenshot="$profile/picture.png" \
  "file://$(encoded "$page")#${address//#/%23}&full=picture" 2>"$profile/log" ||
  { cat "$profile/log" >&2; exit 1; }
[[ -s $profile/picture.png ]] || { cat "$profile/log" >&2; fail "$3 was not written"; }
mv -- "$profile/picture.png" "$out"
