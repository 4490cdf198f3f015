#!/bin/bash
# Installs a build into a folder of its own and uses it from outside: a project by find_package, the same by pkg-config, the
# program with its models, pages and completion. Usage: tests/outside/run.sh BUILD_DIR
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "$*" >&2; exit 1; }

cmake --install "$build" --prefix "$work/there" >install.log || { cat install.log; exit 1; }
export PATH=$work/there/bin:$PATH
library=$(find there -name "libtalus.so.*.*.*")
[ -n "$library" ] || fail "there is no libtalus.so"
readelf -d "$library" | grep -q 'SONAME.*libtalus\.so\.[0-9]*\.[0-9]*\]' || fail "libtalus.so has no SONAME of its series"
libs=$(dirname "$work/$library")

# the program, from where it was installed
talus new bar --from impact_bar >/dev/null || fail "talus new finds no models"
talus run bar.toml -o run --force -q
man -l there/share/man/man1/talus.1 >/dev/null 2>&1 || grep -q '^\.TH TALUS 1' there/share/man/man1/talus.1 || fail "no manual page"
grep -q complete there/share/bash-completion/completions/talus || fail "no completion"

# a project of others, both ways; docs/library.md shows it word by word
sed -n '/^```cpp/,/^```$/p' "$here/../../docs/library.md" | sed '1d;$d' | diff - "$here/fall.cpp" || fail "docs/library.md shows another fall.cpp"
cmake -G Ninja -S "$here" -B by_cmake -DCMAKE_PREFIX_PATH="$work/there" -DCMAKE_BUILD_TYPE=Release >cmake.log 2>&1 || { cat cmake.log; exit 1; }
cmake --build by_cmake >>cmake.log 2>&1 || { cat cmake.log; exit 1; }
export PKG_CONFIG_PATH=$libs/pkgconfig
flags=$(pkg-config --cflags --libs talus)
g++ -O1 "$here/fall.cpp" -o by_pkg_config $flags -Wl,-rpath,"$libs"
by_cmake=$(by_cmake/fall bar.toml)
by_pkg_config=$(./by_pkg_config bar.toml)
[ "$by_cmake" = "$by_pkg_config" ] || fail "find_package: $by_cmake, pkg-config: $by_pkg_config"
steps=$(sed -n 's/.*"contact_solves": \([0-9]*\).*/\1/p' run/summary.json)
echo "$by_cmake" | grep -q "^$steps steps" || fail "the library took $by_cmake, the program $steps steps"
# and what is wrong with a model comes as the program says it
sed 's/density = .*/density = "-1 kg\/m3"/' bar.toml >wrong.toml
by_cmake/fall wrong.toml 2>said.txt && fail "a wrong model was run"
grep -q "wrong.toml:[0-9]*:[0-9]*: error: .*density" said.txt || { cat said.txt; fail "the finding does not name file, line and key"; }
echo "installed, used from outside: $by_cmake"
