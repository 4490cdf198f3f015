#!/bin/bash
# Installs what is missing, builds talus and runs the main example: a block strikes a bar.
# Usage: ./run.sh [--maps|--verify]
#   --maps    also what reading DXF and GIS maps needs (155 MB), and that example instead
#   --verify  the verification cases instead: builds them and runs talus verify
set -eu
cd "$(dirname "$0")"
. tools/setup.sh
case "${1:-}" in
  "" | --verify) ;;
  --maps) add_maps ;;
  *) sed -n '2,5s/^# //p' "$0"; exit 2 ;;
esac
add_report
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
  *)
    build release program
    examples/impact_bar/run.sh build/release out/impact_bar
    ;;
esac
