#!/usr/bin/env bash
# cmake/lint.sh format | shellcheck | tidy BUILD_TREE: status 0 when the sources are clean.
# cmake/lint.sh fix: formats them.
set -euo pipefail
cd -P "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

sources() {
  find math contract linear models integrators simulation experiments python tests cmake/new -name node_modules -prune -o \
    \( -name '*.h' -o -name '*.cpp' \) -print0
}

case ${1:-} in
  format) sources | xargs -0 clang-format --dry-run -Werror ;;
  fix) sources | xargs -0 clang-format -i ;;
  shellcheck)
    shellcheck -x tress .ci/run cmake/*.sh tests/{commands,plugin,simulation,support}/*.sh experiments/report/*.sh
    ;;
  tidy)
    # The options are GCC's: some it alone knows, and its -Wconversion leaves signs alone.
    run-clang-tidy -quiet -p "${2:?build tree}" \
      -extra-arg=-Wno-unknown-warning-option -extra-arg=-Wno-unused-command-line-argument \
      -extra-arg=-Wno-sign-conversion \
      "$PWD/(math|contract|linear|models|integrators|simulation|experiments|python|tests)/" ;;
  *) echo "usage: cmake/lint.sh format|fix|shellcheck|tidy BUILD_TREE" >&2; exit 2 ;;
esac
