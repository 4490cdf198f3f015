#!/bin/bash
# Installs what is missing, builds talus and runs the main example: a block strikes a bar.
# Usage: ./run.sh [--maps]      (--maps: also what reading DXF and GIS maps needs, 155 MB, and that example)
set -eu
cd "$(dirname "$0")"
. tools/setup.sh
case "${1:-}" in
  "") ;;
  --maps) add_maps ;;
  *) sed -n '2,3s/^# //p' "$0"; exit 2 ;;
esac
add_report
install_missing_packages
build release
if [ "${1:-}" = --maps ]; then
  build/release/app/talus cut examples/outcrop/outcrop.toml -o out/outcrop --force
else
  examples/impact_bar/run.sh build/release out/impact_bar
fi
