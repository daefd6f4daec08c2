#!/bin/sh
# scripts/extremes_page.sh [BUILD]: writes docs/extremes.md, the catalogue of stiff and extreme cases, with the program
# extremes_page of the build folder (build/release).
set -eu
cd "$(dirname "$0")/.."
build=${1:-build/release}
cmake --build "$build" --target extremes_page
"$build/lab/extremes_page" >docs/extremes.md
