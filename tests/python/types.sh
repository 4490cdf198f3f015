#!/bin/sh
# The types of the Python package hold, and the stub of its extension says what there is. Usage: types.sh BUILD_DIR
set -eu
cd "$(dirname "$0")/../../python"
export PYTHONPATH="$1/python" MYPYPATH="$1/python" PYTHONDONTWRITEBYTECODE=1
cache=$(mktemp -d)
trap 'rm -rf "$cache"' EXIT
export MYPY_CACHE_DIR="$cache"
mypy --config-file mypy.ini -p talus
stubtest talus._talus --mypy-config-file mypy.ini --allowlist stubtest_allowed.txt
