#!/usr/bin/env bash
# test_bad_plugins.sh REPOSITORY PROGRAM COMPILER: libraries with the program's own stamp that
# throw, exit or crash when they are loaded: each is refused in one line that names it.
set -euo pipefail
repository=$1 program=$2 compiler=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# shellcheck source=tests/support/expect.sh
. "$repository/tests/support/expect.sh"
cd "$work"

stamp=$(grep -ao 'tress plug-in|version=[^|]*|headers=[^|]*|[ -~]*|' "$program" | head -n1)
[[ $stamp =~ \|compiler=[A-Za-z]+\ [0-9]+\| && $stamp =~ \|sizes=[0-9]+, ]] ||
  { echo "the stamp is '$stamp'"; exit 1; }

# bad NAME PATTERN: a plug-in whose code is read from standard input.
bad() {
  local name=$1 pattern=$2
  {
    echo '#include <cstdlib>'
    echo '#include <stdexcept>'
    echo 'struct Plugin;'
    echo "extern \"C\" { __attribute__((used)) extern const char stamp[] = \"$stamp\"; }"
    cat
  } >"$name.cpp"
  "$compiler" -std=c++20 -shared -fPIC -w -o "$name.so" "$name.cpp"
  expect 2 "^[a-z_]+: error: .*$pattern.*\\($name.so\\): " "$program" --plugin "$name.so" --list
  [[ $(wc -l <"$work/out") == 1 ]] || { echo "$name: not one line:"; cat "$work/out"; exit 1; }
}

bad throws 'did not start: boom' \
  <<<'extern "C" void tress_plugin(Plugin&) { throw std::runtime_error("boom\nbang"); }'
bad throws_number 'did not start: it threw what is no std::exception' \
  <<<'extern "C" void tress_plugin(Plugin&) { throw 42; }'
bad crashes 'ends the program that loads it \(signal 11' \
  <<<'extern "C" void tress_plugin(Plugin&) { *(volatile int*)8 = 1; }'
bad constructor_throws 'ends the program that loads it \(signal 6' <<'END'
struct X { X() { throw std::runtime_error("boom"); } } x;
extern "C" void tress_plugin(Plugin&) {}
END
bad constructor_exits 'ends the program that loads it \(exit code 0' <<'END'
struct X { X() { exit(0); } } x;
extern "C" void tress_plugin(Plugin&) {}
END
bad number 'has no function tress_plugin' <<<'extern "C" { int tress_plugin = 5; }'
bad nothing 'has no function tress_plugin' <<<''
bad garbage 'ends the program that loads it \(signal 11' <<'END'
extern "C" void tress_plugin(Plugin& plugin) {
  ((long*)&plugin)[0] = 0x1234;
  ((long*)&plugin)[1] = 0x9999999;
}
END
bad undefined 'cannot be loaded' <<'END'
extern void nowhere();
extern "C" void tress_plugin(Plugin&) { nowhere(); }
END
bad empty 'brings nothing' <<<'extern "C" void tress_plugin(Plugin&) {}'
