#!/bin/bash
# The verification cases under the sanitizers: part `sanitized` of ./test.sh long. From the root of the checkout.
set -eu
build=$PWD/build/long/sanitize
cmake --preset sanitize -B "$build" -DTALUS_VERIFICATION=ON
cmake --build "$build" --target verification
export ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS="suppressions=$PWD/tests/lsan.supp:print_suppressions=0"
ctest --test-dir "$build" -R '^verification: ' -j 2 --output-on-failure --no-tests=error
