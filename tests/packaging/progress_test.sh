#!/usr/bin/env bash
# What scripts/progress.sh shows of a command, and what it refuses.
#
#   progress_test.sh SOURCE_DIR BUILD_DIR SCRATCH
set -euo pipefail

script=$1/scripts/progress.sh scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"

# expect WHAT TEXT PART
expect() {
  [[ $2 == *"$3"* ]] || { echo "FAIL: $1: no '$3' in: $2" >&2; exit 1; }
  echo "PASS: $1"
}

# Says LINE while a terminal looks on, and once more when a second has passed.
on_terminal() {
  script -qec "(echo '$1'; sleep 1.1; echo '$1') | '$script' Trying '$scratch/log' $2" \
    /dev/null
}

expect percent "$(on_terminal '[ 45%] Building x' '')" \
  '[#########           ]  45 %  0:0'
expect share "$(on_terminal 'Processed file [1/2]' '')" '50 %  0:0'
expect blocks "$(on_terminal 'Matching block [2/2, 1/4]' '')" '62 %  0:0'
expect total "$(on_terminal 'Registering image #7 (3)' 4)" '75 %  0:0'
expect nothing "$(on_terminal 'Registering image #7 (3)' '')" '  0 %  Trying'
expect "end" "$(echo x | "$script" Trying "$scratch/log")" 'Trying: 0:00:0'
expect log "$(grep -c . "$scratch/log")" 11
for words in '' 'Trying' "Trying $scratch/log 0" "Trying $scratch/log many"; do
  # shellcheck disable=SC2086
  ! said=$("$script" $words 2>&1 </dev/null) || { echo "FAIL: $words" >&2; exit 1; }
  expect "bad words" "$said" 'ERROR: usage'
done
