#!/bin/sh
# Runs a compiler and keeps what it says about the kernels' resources in a file:
#
#   save_report.sh FILE COMPILER [ARGUMENT]...
#
# Everything else that it says is passed on.
report=$1
shift
"$@" >"$report.new" 2>&1
status=$?
grep -v -E '^ptxas info|^ +[0-9]+ bytes stack frame' "$report.new" >&2
# What nvcc is asked for besides compiling has no report.
if grep -q '^ptxas info' "$report.new"; then
  mv "$report.new" "$report"
else
  rm -f "$report.new"
fi
exit $status
