#!/usr/bin/env bash
# test_one_definition.sh REPOSITORY LIBRARY...: nothing is defined twice in namespace tress.
# The linker keeps one of two classes, inline functions or templates of one name without a
# word; of two functions it does when both lie in libraries. Headers are compared by the
# compiler (headers_together); here what it cannot see: sources and libraries.
set -euo pipefail
repository=$1
shift
found=0

# What a source file keeps to itself lies in an anonymous namespace, a test's in one of the
# name of its file, for tests are compiled several at a time; a nested class belongs to the
# header that declares it. clang-format puts what is at namespace scope in column 1.
# shellcheck disable=SC2016  # awk expands it
outside=$(cd "$repository" && find math contract linear models integrators simulation experiments tests -name node_modules \
  -prune -o -name '*.cpp' -print0 | xargs -0 awk '
    FNR == 1 || /^}  \/\/ namespace$/ { anonymous = 0 }
    /^namespace \{/ { anonymous = 1 }
    /^namespace tress::test_/ && FILENAME ~ ("/" substr($2, 8) "[.]cpp$") { anonymous = 1 }
    anonymous { next }
    /^(template <.*> )?(class|struct|union|enum( class)?) [A-Za-z0-9_]+( final)?( :.*)?( \{|$)/ ||
    /^inline [^(]* [A-Za-z0-9_]+\(/ { print FILENAME ":" FNR ": " $0 }')
if [[ $outside ]]; then
  echo "in a source file, but not in an anonymous namespace:"
  echo "$outside"
  found=1
fi

twice=$(nm -A -g --defined-only "$@" 2>/dev/null |
  awk 'NF >= 3 && $(NF - 1) ~ /^[TDBR]$/ { print $NF }' | sort | uniq -d | c++filt)
if [[ $twice ]]; then
  echo "defined in two objects of the libraries:"
  echo "$twice"
  found=1
fi
exit "$found"
