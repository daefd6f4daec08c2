#!/bin/sh
# Makes the pictures of docs/guide/study.md, the bundles of docs/guide/dtmri.md and the four panes of docs/guide/grid.md again, from a built flow and the tests.
#   scripts/guide_pictures.sh [BUILD]     build/release unless named
set -eu
cd "$(dirname "$0")/.."
build=${1:-build/release}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$build/bin/flow" study make "$folder/s" --seed 7 --quiet
"$build/bin/flow" study sheet "$folder/s" --out "$folder/sheet.png" --quiet
scripts/small_picture.py "$folder/sheet.png" docs/guide/study_sheet.png 2
PALPATE_WRITE_PAGES=1 xvfb-run -a ctest --test-dir "$build" -R 'e2e/(study_window|dtmri_bundles|grid_reading)_test' --output-on-failure
for name in advection2d advection3d tracing2d tracing3d screen1 screen5; do
  scripts/small_picture.py "docs/guide/study_$name.png" "docs/guide/study_$name.png"
done
