#!/usr/bin/env bash
# SUNDIALS in Release, from Debian's own source package: Debian's binary is compiled at -O0,
# 3 to 7 times slower, which would turn the results of a work-precision study around.
#
#   cmake/sundials.sh root    prints the prefix to build against; an empty line means Debian's
#                             binary (the source build failed before); status 1: nothing yet
#   cmake/sundials.sh build   builds into the cache; status 1 and a note in the cache on failure
#
# TRESS_SUNDIALS_ROOT, when set, names a copy of your own and is used as it is.
set -euo pipefail

cache="${TRESS_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/tress}"
flags=(
  -DCMAKE_BUILD_TYPE=Release -DCMAKE_POSITION_INDEPENDENT_CODE=ON
  -DCMAKE_INSTALL_LIBDIR=lib
  -DBUILD_STATIC_LIBS=ON -DBUILD_SHARED_LIBS=OFF
  -DEXAMPLES_ENABLE_C=OFF -DEXAMPLES_ENABLE_CXX=OFF -DEXAMPLES_INSTALL=OFF
  -DENABLE_KLU=ON -DKLU_INCLUDE_DIR=/usr/include/suitesparse
  "-DKLU_LIBRARY_DIR=/usr/lib/$(gcc -print-multiarch 2>/dev/null || true)"
  -DSUNDIALS_INDEX_SIZE=64
)

# What a finished build depends on; a new compiler or KLU means a new folder.
key() {
  { printf '%s\n' "${flags[@]}"
    gcc -dumpfullversion 2>/dev/null || true
    # shellcheck disable=SC2016  # the field name is dpkg's
    dpkg-query -W -f='${Version}' libsuitesparse-dev 2>/dev/null || true
  } | sha256sum | cut -c1-8
}

# Turns the machine's own package sources (both formats of apt) into source-package entries:
# the distribution's suites only, third parties left out.
source_entries() {
  local out=$1 files codename
  # shellcheck source=/dev/null
  codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-stable}")
  shopt -s nullglob
  files=(/etc/apt/sources.list.d/*.sources)
  if ((${#files[@]})); then
    awk -v codename="$codename" -f "${0%/*}/deb_src.awk" RS= "${files[@]}" >"$out/tress.sources"
  fi
  files=(/etc/apt/sources.list /etc/apt/sources.list.d/*.list)
  sed -n 's/^[[:space:]]*deb[[:space:]]/deb-src /p' "${files[@]}" 2>/dev/null |
    grep -E " ($codename|stable|testing|sid)(-updates|-security)?/? (.* )?(main|universe)( |$)" |
    grep -v 'cdrom:' >"$out/tress.list" || true
  [[ -s $out/tress.sources || -s $out/tress.list ]] || {
    echo "no package source of the distribution found in /etc/apt" >&2
    return 1
  }
}

# The source package, checked against the archive's signature by apt, unpacked into $1/src.
fetch() {
  local work=$1 apt
  mkdir -p "$work"/{sources,lists/partial,archives/partial}
  source_entries "$work/sources"
  apt=(apt-get -q -o "Dir::Etc::sourcelist=/dev/null" -o "Dir::Etc::sourceparts=$work/sources"
       -o "Dir::State::Lists=$work/lists" -o "Dir::Cache=$work" -o APT::Sandbox::User=root)
  # One unreachable source must not stop the others: `source` fails when none has it.
  "${apt[@]}" update || true
  (cd "$work" && "${apt[@]}" source --download-only sundials && dpkg-source -x ./*.dsc src)
}

build() {
  local version prefix
  mkdir -p "$cache"
  rm -rf "$cache"/building.*  # of a killed build; ./tress setup holds a lock
  work=$(mktemp -d "$cache/building.XXXXXX")
  trap 'rm -rf "$work"' EXIT
  fetch "$work"
  version=$(sed -n 's/^Version: //p' "$work"/*.dsc | head -n1)
  prefix="$cache/sundials-${version%%[+-]*}-$(key)"
  cmake -S "$work/src" -B "$work/build" -G Ninja "${flags[@]}" "-DCMAKE_INSTALL_PREFIX=$prefix"
  DESTDIR="$work/stage" cmake --build "$work/build" --target install
  rm -rf "$prefix"
  mv "$work/stage$prefix" "$prefix"  # same file system: whole or not at all
  rm -f "$cache/sundials-failed-$(key)"
}

root() {
  if [[ -n ${TRESS_SUNDIALS_ROOT:-} ]]; then
    echo "$TRESS_SUNDIALS_ROOT"
    return
  fi
  local prefix
  prefix=$(printf '%s\n' "$cache"/sundials-[0-9]*-"$(key)" | sort -V | tail -n1)
  if [[ -d $prefix ]]; then
    echo "$prefix"
  elif [[ -e $cache/sundials-failed-$(key) ]]; then
    echo
  else
    return 1
  fi
}

case ${1:-} in
  root) root ;;
  build)
    # A subshell of its own keeps `set -e` at work and lets the failure be noted.
    rc=0; "$0" build_now || rc=$?
    ((rc == 0 || rc >= 128)) || touch "$cache/sundials-failed-$(key)"
    exit "$rc" ;;
  build_now) build ;;
  *) echo "usage: cmake/sundials.sh root|build" >&2; exit 2 ;;
esac
