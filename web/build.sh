#!/bin/bash
# Bundles the page of `talus report`: web/build.sh FOLDER PAGE, where FOLDER is for npm's packages. Without npm's
# registry there is no page, and the rest of talus is built all the same.
set -eu
web=$(cd "$(dirname "$0")" && pwd) folder=$1 page=$2
mkdir -p "$folder" "$(dirname "$page")"
cp "$web/package.json" "$web/package-lock.json" "$web/.npmrc" "$folder"
if [ ! -e "$folder/node_modules/uplot" ] || [ "$web/package-lock.json" -nt "$folder/packages.stamp" ]; then
  (cd "$folder" && npm ci --ignore-scripts --loglevel=error) || {
    echo "talus report: no page, its npm packages could not be fetched; build again with a network"
    exit 0
  }
  touch "$folder/packages.stamp"
fi
export NODE_PATH=$folder/node_modules
bundle=("$folder/node_modules/.bin/esbuild" --bundle --minify --target=es2022 --log-level=warning)
cd "$web"
"${bundle[@]}" --format=iife src/main.js --outfile="$folder/page.js"
"${bundle[@]}" src/page.css --outfile="$folder/page.css"
node inline.mjs page.html "$folder/page.js" "$folder/page.css" "$folder/node_modules/uplot" >"$page.part"
mv "$page.part" "$page"
