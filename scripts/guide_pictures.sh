#!/bin/sh
# Makes the pictures of docs/guide/study.md again, in all their colours: the marks, red and blue, are a few pixels each, and a
# palette made for the greys loses them.
#   scripts/guide_pictures.sh [BUILD]     BUILD is build/release unless named; it has flow and the tests
set -eu
cd "$(dirname "$0")/.."
build=${1:-build/release}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$build/bin/flow" study make "$folder/s" --seed 7 --quiet
"$build/bin/flow" study sheet "$folder/s" --out docs/guide/study_sheet.png --force --quiet
PALPATE_WRITE_PAGES=1 xvfb-run -a ctest --test-dir "$build" -R e2e/study_window_test --output-on-failure
