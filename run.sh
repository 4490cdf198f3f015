#!/bin/bash
# Installs what is missing, builds talus and runs the main example: a block strikes a bar.
# Usage: ./run.sh [--maps|--verify|--python [VENV]|--install PREFIX]
#   --maps    also what reading DXF and GIS maps needs (155 MB), and that example instead
#   --verify  the verification cases instead: builds them and runs talus verify
#   --python [VENV]    the Python package instead, and makes it known to that virtual environment
#   --install PREFIX   program, library, pages and verification cases, put under PREFIX instead
set -eu
cd "$(dirname "$0")"
. tools/setup.sh
case "${1:-}" in
  "" | --verify) ;;
  --install) [ $# = 2 ] || { echo "./run.sh --install wants a folder, for example /usr/local or \$HOME/.local"; exit 2; } ;;
  --maps) add_maps ;;
  --python) add_python_package; [ -z "${2:-}" ] || talus_packages="$talus_packages python3-venv" ;;
  *) sed -n '2,7s/^# //p' "$0"; exit 2 ;;
esac
[ "${1:-}" = --python ] || add_report
install_missing_packages
case "${1:-}" in
  --maps)
    build release program
    build/release/app/talus cut examples/outcrop/outcrop.toml -o out/outcrop --force
    ;;
  --verify)
    build release program verification
    build/release/app/talus verify
    ;;
  --python)
    build release talus_python talus_app
    if [ -n "${2:-}" ]; then
      tools/python_venv.sh build/release "$2"
    else
      echo "the Python package is in $PWD/build/release/python; to import it:"
      echo "  export PYTHONPATH=$PWD/build/release/python"
      echo "  /usr/bin/python3 -c 'import talus; print(talus.__version__)'"
    fi
    ;;
  --install)
    build release installation
    cmake --install build/release --prefix "$2" >/dev/null ||
      { echo "nothing, or not all, was installed: may you write to $2? (sudo cmake --install build/release --prefix $2)"; exit 4; }
    echo "installed: $2/bin/talus, the library for find_package(talus) and pkg-config (docs/library.md)"
    ;;
  *)
    build release program
    examples/impact_bar/run.sh build/release out/impact_bar
    ;;
esac
