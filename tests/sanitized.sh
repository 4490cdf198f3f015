#!/bin/bash
# Under the sanitizers what ./test.sh leaves out there: the verification cases, the Python package and the suites "optimised" (main.cpp).
# Part `sanitized` of ./test.sh long, from the root of the checkout.
set -eu
build=$PWD/build/long/sanitize
cmake --preset sanitize -B "$build" -DTALUS_VERIFICATION=ON -DTALUS_PYTHON=ON
cmake --build "$build"
export ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS="suppressions=$PWD/tests/lsan.supp:print_suppressions=0"
for program in unit command; do "$build/tests/$program" -ts=optimised; done
ctest --test-dir "$build" -R '^verification: |^Python: ' -j 2 --output-on-failure --no-tests=error
