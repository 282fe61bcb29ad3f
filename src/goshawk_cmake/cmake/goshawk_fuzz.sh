#!/bin/sh
# goshawk_fuzz.sh PROGRAM RUNS FOLDERS...: RUNS inputs, or as many as there is time for in
# GOSHAWK_FUZZ_S seconds. An input that takes a minute is a fault.
program=$1
runs=$2
shift 2
if [ -n "$GOSHAWK_FUZZ_S" ]; then
  limit="-max_total_time=$GOSHAWK_FUZZ_S -print_final_stats=1"
else
  limit="-runs=$runs -seed=1"
fi
# shellcheck disable=SC2086
exec "$program" $limit -max_len=512 -rss_limit_mb=0 -timeout=60 "$@"
