#!/usr/bin/env bash
# Makes a COLMAP workspace for dense stereo from a folder with images/ and
# sparse/ (undistorted photographs and their model), such as examples/room.
#
#   scripts/make_workspace.sh DATA WORKSPACE [SOURCES] [EVERY]
#
# SOURCES is the number of source views per photograph (10). With EVERY n > 1,
# only every n-th photograph takes part, and its sources, named one by one, are
# its neighbours among those in the order of names. DATA is not changed; its
# photographs are linked; those that the model does not have are left out.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)

fail() {
  echo "ERROR: $*" >&2
  exit 1
}

[[ $# -ge 2 && $# -le 4 ]] ||
  fail "usage: $(basename "$0") DATA WORKSPACE [SOURCES] [EVERY]"
data=$1
workspace=$2
sources=${3:-10}
every=${4:-1}
[[ $sources =~ ^[1-9][0-9]*$ ]] || fail "SOURCES is $sources, but must be a positive number"
[[ $every =~ ^[1-9][0-9]*$ ]] || fail "EVERY is $every, but must be a positive number"
for part in images sparse; do
  [[ -d $data/$part ]] || fail "$data has no folder $part"
done
data=$(cd "$data" && pwd)

mkdir -p "$workspace"/stereo/{depth_maps,normal_maps,consistency_graphs}
for part in images sparse; do
  [[ ! -e $workspace/$part || -L $workspace/$part ]] ||
    fail "$workspace has a folder $part of its own; name another workspace"
  ln -sfn "$data/$part" "$workspace/$part"
done
list=$(PYTHONPATH=$root /usr/bin/python3 -B -m evaluation.model_names "$data")
mapfile -t names < <(awk "NF && NR % $every == 1 % $every" <<<"$list")
[[ ${#names[@]} -ge 2 ]] || fail "$data/images has fewer than two photographs of the model to use"

config=$workspace/stereo/patch-match.cfg
: >"$config.tmp"
for name in "${names[@]}"; do
  if [[ $every -eq 1 ]]; then
    line="__auto__, $sources"
  else
    # The nearest ones in the sequence.
    line=$(printf '%s\n' "${names[@]}" | awk -v name="$name" -v count="$sources" '
      { all[NR] = $0; if ($0 == name) at = NR }
      END {
        for (d = 1; d < NR && n < count; ++d)
          for (s = -1; s <= 1 && n < count; s += 2)
            if (at + s * d >= 1 && at + s * d <= NR)
              line = line (n++ ? ", " : "") all[at + s * d]
        print line
      }')
  fi
  printf '%s\n%s\n' "$name" "$line" >>"$config.tmp"
done
mv "$config.tmp" "$config"
printf '%s\n' "${names[@]}" >"$workspace/stereo/fusion.cfg"
echo "$workspace: ${#names[@]} photographs"
