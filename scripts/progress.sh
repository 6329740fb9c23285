#!/usr/bin/env bash
# Shows how far a command is, from what it prints: on a terminal a bar with the
# time to go, elsewhere a line a minute.
#
#   COMMAND | scripts/progress.sh WHAT LOG [TOTAL]
#
# All that the command prints goes into LOG. It tells how far it is as "[ 45%]",
# "[5/11]" or "[1/3, 2/3]"; or, if TOTAL is given, as "(5)", of so many.
set -euo pipefail

if [[ $# -lt 2 || $# -gt 3 || ! ${3:-1} =~ ^[1-9][0-9]*$ ]]; then
  echo "ERROR: usage: COMMAND | $(basename "$0") WHAT LOG [TOTAL]" >&2
  exit 1
fi
what=$1 log=$2 total=${3:-0}
# Ctrl-C ends the command; what it says in its last moments is still kept.
trap '' INT

clock() { printf '%d:%02d:%02d' $(($1 / 3600)) $(($1 / 60 % 60)) $(($1 % 60)); }

# Sets share, in thousandths, if the line $1 tells how far the command is.
read_share() {
  if [[ $1 =~ \[\ *([0-9]+)%\] ]]; then
    share=$((10 * BASH_REMATCH[1]))
  elif [[ $1 =~ \[([0-9]+)/([1-9][0-9]*),\ ([0-9]+)/([1-9][0-9]*)\] ]]; then
    share=$((1000 * ((BASH_REMATCH[1] - 1) * BASH_REMATCH[4] + BASH_REMATCH[3]) /
      (BASH_REMATCH[2] * BASH_REMATCH[4])))
  elif [[ $1 =~ \[([0-9]+)/([1-9][0-9]*)\] ]]; then
    share=$((1000 * BASH_REMATCH[1] / BASH_REMATCH[2]))
  elif [[ $total -gt 0 && $1 =~ \(([0-9]+)\)$ ]]; then
    share=$((1000 * BASH_REMATCH[1] / total))
  fi
}

show() {
  local bar text
  text=$(printf '%3d %%' $((share / 10)))
  ((share == 0)) ||
    text+="  $(clock $((SECONDS * (1000 - share) / share))) to go"
  if [[ -t 1 ]]; then
    bar=$(printf '%*s' $((share / 50)) '')
    printf '\r\033[K[%-20s] %s  %s' "${bar// /#}" "$text" "$what"
  else
    echo "$text  $what"
  fi
}

interval=60
[[ ! -t 1 ]] || interval=1
share=0 next=$interval
SECONDS=0
while IFS= read -r line; do
  printf '%s\n' "$line" >>"$log"
  read_share "$line"
  if ((SECONDS >= next)); then
    next=$((SECONDS + interval))
    show
  fi
done
[[ ! -t 1 ]] || printf '\r\033[K'
echo "$what: $(clock "$SECONDS")"
