#!/usr/bin/env bash
# Makes the copy of COLMAP 3.8 that is built: pristine source plus our patches.
#
#   scripts/prepare_colmap.sh DEST
#
# The source is COLMAP_SOURCE_DIR, if set, else what fetch_colmap.sh gets. Does
# nothing when DEST is up to date; otherwise only the files that differ are
# written, so that little has to be built again after a patch was changed.
# PATCHES_DIR overrides the folder with the series.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)

fail() {
  echo "ERROR: $*" >&2
  exit 1
}

[[ $# -eq 1 ]] || fail "usage: $(basename "$0") DEST"
mkdir -p "$1"
dest=$(cd "$1" && pwd)
patches=${PATCHES_DIR:-$here/../patches/colmap-3.8}
# What of COLMAP is needed to build and install it.
parts=(CMakeLists.txt COPYING.txt cmake doc/COLMAP.desktop lib src)

[[ -f $patches/series ]] || fail "There is no patch series in $patches."
mapfile -t series < <(grep -v -e '^ *#' -e '^ *$' "$patches/series")
for name in "${series[@]}"; do
  [[ -f $patches/$name ]] || fail "$patches/series names $name, which is missing."
done

source=
if [[ -n ${COLMAP_SOURCE_DIR:-} ]]; then
  source=$COLMAP_SOURCE_DIR
  [[ -d $source ]] || fail "COLMAP_SOURCE_DIR: there is no folder $source."
  grep -qs 'set(COLMAP_VERSION "3.8")' "$source/CMakeLists.txt" ||
    fail "COLMAP_SOURCE_DIR: $source is not the source of COLMAP 3.8."
fi

# A name for everything that DEST is made from.
stamp=$({
  cat "$0" "$here/fetch_colmap.sh"
  for name in "${series[@]}"; do
    echo "$name"
    cat "$patches/$name"
  done
  if [[ -n $source ]]; then
    cd "$source" && find "${parts[@]}" -type f -not -name version.h \
      -exec sha256sum {} + | sort
  fi
} | sha256sum | cut -d ' ' -f 1)
[[ $(cat "$dest/.stamp" 2>/dev/null) != "$stamp" ]] || exit 0

tmp=$(mktemp -d "$dest.XXXXXX")
trap 'rm -rf "$tmp"' EXIT
mkdir "$tmp/pristine" "$tmp/new"
if [[ -z $source ]]; then
  source=$tmp/pristine
  "$here/fetch_colmap.sh" "$source"
fi
tar -C "$source" --exclude=src/util/version.h -cf - "${parts[@]}" |
  tar -C "$tmp/new" -xf -

# Git must not take the copy for a part of the repository around it.
export GIT_CEILING_DIRECTORIES=$tmp
for name in "${series[@]}"; do
  (cd "$tmp/new" &&
    git apply --unidiff-zero --whitespace=nowarn "$patches/$name" \
      2>"$tmp/log") ||
    fail "$patches/$name does not apply to $source: $(head -n 1 "$tmp/log")"
done

# Until the copy is whole again it has no stamp. version.h is written by
# COLMAP's own CMake.
rm -f "$dest/.stamp"
(cd "$tmp/new" && find . -type f) | while read -r file; do
  if ! cmp -s "$tmp/new/$file" "$dest/$file"; then
    mkdir -p "$(dirname "$dest/$file")"
    cp "$tmp/new/$file" "$dest/$file"
  fi
done
(cd "$dest" && find . -type f -not -path ./src/util/version.h) |
  while read -r file; do
    [[ -e $tmp/new/$file ]] || rm "$dest/$file"
  done
echo "$stamp" >"$dest/.stamp"
