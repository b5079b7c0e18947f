#!/usr/bin/env bash
# Writes capi/abi.txt anew from the headers, without a build: sizes and offsets by the C compiler, symbols by the generator. For changes of
# the binary interface that are meant (check_abi.py says which are harmless).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
python3 generate.py --header "$folder/gyre/c/gyre.h" --symbols "$folder/symbols" --abi-program "$folder/abi.c"
cc -std=c11 -I"$folder" "$folder/abi.c" -o "$folder/abi"
{
  "$folder/abi"
  sed -n 's/^    \(gyre_[a-z0-9_]*\);$/\1/p' "$folder/symbols" | LC_ALL=C sort
} >abi.txt
git diff --stat -- abi.txt
