#!/bin/sh
# run_fuzz.sh PROGRAM SEEDS WORK: fuzzes for $GYRE_FUZZ_SECONDS. New inputs stay in WORK and serve the next run as seeds; an
# input that breaks something is kept as WORK-crash-*, and its path is printed by libFuzzer. Words of the format that are
# worth trying stand in SEEDS.dict. One that takes a minute counts as hanging: a busy machine under sanitizers is slow.
set -eu
program=$1
seeds=$2
work=$3
mkdir -p "$work"
if [ -d "$seeds" ]; then set -- "$work" "$seeds"; else set -- "$work"; fi
if [ -e "$seeds.dict" ]; then set -- -dict="$seeds.dict" "$@"; fi
exec "$program" -max_total_time="${GYRE_FUZZ_SECONDS:-3}" -timeout=60 -rss_limit_mb=2048 -verbosity=0 -print_final_stats=1 \
  -artifact_prefix="$work-" "$@"
