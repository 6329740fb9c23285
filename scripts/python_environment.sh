# Sourced by scripts that need packages of the Python package index: makes environments
# that are thrown away, and keeps what was downloaded.

# make_environment FOLDER LOG: with the first Python here that can.
make_environment() {
  local candidate
  for candidate in python3 /usr/bin/python3; do
    rm -rf "$1"
    if "$candidate" -m venv "$1" >"$2" 2>&1; then
      return 0
    fi
  done
  return 1
}

# download_packages ENVIRONMENT WHEELS LOG REQUIREMENT...: the newest packages if the index answers;
# otherwise those from last time have to do.
download_packages() {
  "$1/bin/pip" --disable-pip-version-check --retries 1 --timeout 20 download --dest "$2" \
    --only-binary :all: --find-links "$2" "${@:4}" >"$3" 2>&1 || true
}

# install_packages ENVIRONMENT WHEELS LOG REQUIREMENT...: from what was downloaded.
install_packages() {
  "$1/bin/pip" --disable-pip-version-check install --no-index --find-links "$2" \
    "${@:4}" >>"$3" 2>&1
}
