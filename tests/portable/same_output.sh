#!/bin/sh
# same_output.sh COMMAND... -- COMMAND...: runs both, and fails unless both succeed and print the same.
set -u
first=
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  first="$first $1"
  shift
done
shift
expected=$($first) || { echo "failed: $first"; echo "$expected"; exit 1; }
found=$("$@") || { echo "failed: $*"; echo "$found"; exit 1; }
if [ "$expected" != "$found" ]; then
  echo "$first printed:"
  echo "$expected"
  echo "$* printed:"
  echo "$found"
  exit 1
fi
echo "$found"
