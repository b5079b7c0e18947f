#!/bin/sh
# update_golden.sh [BUILD]: writes golden.txt anew from the program `determinism` of a build folder (build/release by
# default), after the engine's numbers were changed on purpose. Prints what changed.
set -eu
folder=$(dirname "$0")
build=${1:-$folder/../../build/release}
"$build/bin/determinism" >"$folder/golden.txt.new"
diff "$folder/golden.txt" "$folder/golden.txt.new" || true
mv "$folder/golden.txt.new" "$folder/golden.txt"
