#!/usr/bin/env bash
# Follows the Dockerfile without a container engine, in bare roots of Debian 12 that
# debootstrap makes; installs the Debian package that comes out in another one; and
# reconstructs something small in both.
#
#   container_test.sh SOURCE_DIR BUILD_DIR SCRATCH
#
# The first root and what apt downloads are kept in SCRATCH, and ccache's folder is
# lent to the roots, so that this is faster the next time.
set -euo pipefail

source_dir=$1 scratch=$3

skip() {
  echo "SKIPPED: $*"
  exit 77
}

fail() {
  echo "FAIL: $*" >&2
  exit 1
}

# The archive that this machine has Debian 12 from.
archive() {
  apt-get indextargets --format "\$(REPO_URI) \$(CODENAME)" \
    'Created-By: Packages' 'Component: main' |
    awk '$2 == "bookworm" && !found++ { print $1 }'
}

make_base() {
  local uri
  [[ ! -e $scratch/base.done ]] || return 0
  uri=$(archive)
  [[ -n $uri ]] || skip "this machine has no archive of Debian 12"
  echo "Making a bare root ..."
  rm -rf "$scratch/base"
  debootstrap --variant=minbase bookworm "$scratch/base" "$uri" \
    >"$scratch/debootstrap.log" 2>&1 ||
    skip "debootstrap failed: $(tail -n 1 "$scratch/debootstrap.log")"
  touch "$scratch/base.done"
}

# Makes the bare root $1, and instructions about it.
begin_root() {
  root=$scratch/$1 workdir=/ environment=()
  rm -rf "$root"
  cp -a --reflink=auto "$scratch/base" "$root"
}

# Runs a command in the root. What is mounted for it vanishes with it.
inside() {
  local name lent=("$ccache:/var/cache/ccache" "$scratch/archives:/var/cache/apt/archives")
  local variables=(PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp
    CCACHE_DIR=/var/cache/ccache "${environment[@]}")
  for name in http_proxy https_proxy no_proxy; do
    [[ -z ${!name:-} ]] || variables+=("$name=${!name}")
  done
  # shellcheck disable=SC2016
  unshare --mount bash -euc '
    root=$1 lent=$2
    shift 2
    mount -t proc proc "$root/proc"
    for pair in $lent; do
      mkdir -p "$root${pair#*:}"
      mount --bind "${pair%%:*}" "$root${pair#*:}"
    done
    exec chroot "$root" "$@"' \
    - "$root" "${lent[*]}" env -i -C "$workdir" "${variables[@]}" "$@"
}

# As COPY [--from=STAGE] SOURCE DESTINATION does: folders of this repository to where
# they are, or files of a stage.
copy() {
  local target=$root$workdir
  if [[ $1 == --from=* ]]; then
    mkdir -p "$target/$3"
    # shellcheck disable=SC2086
    cp "$scratch/${1#--from=}"$2 "$target/$3" # The name may be a pattern.
  elif [[ $1 == "$2" ]]; then
    mkdir -p "$target"
    tar -C "$source_dir" --exclude-from=<(sed 's|^|./|' "$source_dir/.dockerignore") \
      -cf - "./$1" | tar -C "$target" --no-same-owner -xf -
  else
    fail "this test cannot follow COPY $*"
  fi
}

follow() {
  local word rest arguments
  while read -r word rest; do
    echo "$word $rest"
    read -r -a arguments <<<"$rest"
    case $word in
      FROM) begin_root "${arguments[2]:-final}" ;;
      WORKDIR)
        workdir=$rest
        mkdir -p "$root$workdir"
        ;;
      ENV) environment+=("$rest") ;;
      COPY) copy "${arguments[@]}" ;;
      RUN) inside sh -c "$rest" </dev/null || fail "RUN $rest" ;;
      CMD) inside test -x "${rest//[][\"]/}" || fail "CMD $rest" ;;
      *) fail "this test does not know $word" ;;
    esac
  done
}

# Reconstructs a workspace in the root with the installed program.
reconstruct() {
  rm -rf "$root/tmp/workspace"
  PYTHONPATH=$source_dir/tests/end_to_end python3 -B -c \
    "import sys, tiny_workspace; tiny_workspace.make_workspace(sys.argv[1])" \
    "$root/tmp/workspace"
  # Not into grep -q, which would go before the program has said all.
  [[ $(inside colmap patch_match_stereo -h) == *PatchMatchStereo.num_threads* ]] ||
    fail "there is no help"
  inside colmap patch_match_stereo --workspace_path /tmp/workspace ||
    fail "no stereo"
  inside colmap stereo_fusion --workspace_path /tmp/workspace \
    --output_path /tmp/workspace/fused.ply || fail "no fusion"
  [[ -s $root/tmp/workspace/fused.ply ]] || fail "no points"
  inside colmap gui --help >/dev/null || fail "the graphical interface does not start"
}

[[ $(id -u) -eq 0 ]] || skip "only root can make a root"
for tool in apt-get debootstrap unshare; do
  command -v "$tool" >/dev/null || skip "there is no $tool"
done
unshare --mount true 2>/dev/null || skip "this machine allows no mounts"
ccache=$(ccache -k cache_dir 2>/dev/null || echo "$scratch/ccache")
mkdir -p "$scratch/archives/partial" "$ccache"
make_base

# Instructions, without comments, each on one line.
follow < <(sed -e '/^ *#/d; /^ *$/d' -e ':a; /\\$/ { N; s/\\\n */ /; ta }' \
  "$source_dir/Dockerfile")
reconstruct
inside scripts/evaluate examples/room --out /tmp/out --image_size 64 --every 4 \
  --methods tapa --seeds 0 || fail "no evaluation"
package=("$scratch"/build/opt/tapa-mvs/build/colmap-tapa_*.deb)

begin_root bare
cp "${package[0]}" "$root/tmp/"
inside apt-get update -qq
inside env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y \
  --no-install-recommends "/tmp/$(basename "${package[0]}")" ||
  fail "the package cannot be installed"
reconstruct
# It gives way to nothing, and goes without a trace.
inside dpkg --purge colmap-tapa
[[ ! -e $root/usr/bin/colmap ]] || fail "the program is still there"
echo "PASS: Dockerfile and Debian package"
