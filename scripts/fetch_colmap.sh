#!/usr/bin/env bash
# Unpacks the source of COLMAP 3.8, as Debian 12 publishes it, into a folder.
#
#   scripts/fetch_colmap.sh DEST
#
# The archives come through apt from the machine's own package archive, without
# touching its configuration, and have to match the SHA-256 sums below. They
# are kept in TAPA_CACHE_DIR (default: tapa-mvs in the user's cache folder), so
# that this works offline from the second time on.
set -euo pipefail

readonly package=colmap version=3.8-1
readonly archives=(
  colmap_3.8.orig.tar.gz
  colmap_3.8-1.debian.tar.xz
  colmap_3.8-1.dsc
)
readonly sums=(
  02288f8f61692fe38049d65608ed832b31246e7792692376afb712fa4cef8775
  809fd155053689e9a8666691b874ae1f218abccb5f8f627358d26ed78926a87f
  32926ef8744be13374e1b8a57fba658a424f3e6fd8e1737c3ca4c6df94b31a46
)

fail() {
  echo "ERROR: $*" >&2
  exit 1
}

sum_of() { sha256sum "$1" | cut -d ' ' -f 1; }

# The archives of the machine whose package lists know our package, as
# one-line deb-src entries.
source_entries() {
  local uri release file
  apt-get indextargets \
    --format '$(REPO_URI) $(RELEASE) $(FILENAME)' \
    'Created-By: Packages' 'Component: main' |
    while read -r uri release file; do
      if /usr/lib/apt/apt-helper cat-file "$file" 2>/dev/null |
        grep -x "Package: $package" >/dev/null; then
        echo "$uri $release main"
      fi
    done | sort -u
}

# Downloads the archives into the folder $1 from the entries $2. $3: options of
# the entries.
download() {
  local dir=$1 tmp=$1/apt
  local apt=(apt-get -qq
    -o Dir::Etc::sourcelist="$tmp/sources.list" -o Dir::Etc::sourceparts=-
    -o Dir::State::Lists="$tmp/lists" -o Dir::Cache="$tmp/cache"
    -o APT::Sandbox::User=)
  mkdir -p "$tmp/lists/partial" "$tmp/cache/archives/partial"
  sed "s/^/deb-src $3 /" <<<"$2" >"$tmp/sources.list"
  "${apt[@]}" update &&
    (cd "$dir" && "${apt[@]}" --download-only source "$package=$version")
}

[[ $# -eq 1 ]] || fail "usage: $(basename "$0") DEST"
dest=$1
cache=${TAPA_CACHE_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/tapa-mvs}
mkdir -p "$cache" "$(dirname "$dest")"

# What stands in the cache is trusted no more than what comes by wire.
missing=0
for i in "${!archives[@]}"; do
  path=$cache/${archives[i]}
  if [[ ! -e $path ]]; then
    missing=1
  elif [[ $(sum_of "$path") != "${sums[i]}" ]]; then
    fail "$path does not have the expected SHA-256 sum ${sums[i]}: remove it" \
      "to download it again."
  fi
done

if [[ $missing == 1 ]]; then
  [[ -z ${TAPA_OFFLINE:-} ]] ||
    fail "${archives[0]} is not in $cache and TAPA_OFFLINE forbids to" \
      "download it."
  command -v apt-get >/dev/null ||
    fail "There is no apt-get here to get COLMAP 3.8 with: set" \
      "COLMAP_SOURCE_DIR to an unpacked copy."
  tmp=$(mktemp -d)
  trap 'rm -rf "$tmp"' EXIT
  entries=$(source_entries)
  [[ -n $entries ]] ||
    fail "No package list of this machine has $package: run 'apt-get update'" \
      "on Debian 12, or set COLMAP_SOURCE_DIR to an unpacked COLMAP 3.8."
  # Where apt lacks the archive's key, the sums below still hold.
  download "$tmp" "$entries" "" >"$tmp/log" 2>&1 ||
    download "$tmp" "$entries" "[trusted=yes]" >"$tmp/log" 2>&1 ||
    fail "$package $version could not be downloaded: check the network, or" \
      "set COLMAP_SOURCE_DIR to an unpacked COLMAP 3.8" \
      "($(grep -m 1 '^E:' "$tmp/log"))."
  for i in "${!archives[@]}"; do
    path=$tmp/${archives[i]}
    [[ -e $path ]] || fail "apt did not deliver ${archives[i]}."
    [[ $(sum_of "$path") == "${sums[i]}" ]] ||
      fail "The downloaded ${archives[i]} does not have the expected SHA-256" \
        "sum ${sums[i]}."
  done
  # Rename at the end, so that a name in the cache means a whole file.
  for name in "${archives[@]}"; do
    cp "$tmp/$name" "$cache/.$name.$$"
    mv "$cache/.$name.$$" "$cache/$name"
  done
fi

# Debian's patches of this version are all switched off: its series file has
# only comments. So the original archive is the source.
mkdir -p "$dest"
tar -xzf "$cache/${archives[0]}" -C "$dest" --strip-components=1
