# SPDX-License-Identifier: BSD-3-Clause
# Steps shared by demo.sh and test.sh: `step NAME COMMAND...` runs a command and, when it fails,
# says which step failed; the functions below are those commands.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

step() {
  local name=$1
  shift
  local start=$SECONDS
  printf '==> %s\n' "$name"
  if ! "$@"; then
    printf 'FAILED in step: %s (%s)\n' "$name" "$*" >&2
    exit 1
  fi
  printf '    %s: %d s\n' "$name" $((SECONDS - start))
}

packages() { grep -v '^#' scripts/packages.txt; }

missing_packages() {
  local package
  # Debian's npm comes with Debian's node; where another node is in use, its npm is on the PATH.
  command -v npm >/dev/null || echo nodejs npm
  for package in $(packages); do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || echo "$package"
  done
}

# Installs what scripts/packages.txt lists and this machine lacks; nothing to do takes no root.
install_packages() {
  local missing
  missing=$(missing_packages)
  [ -z "$missing" ] && return 0
  local sudo=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "run as root, or install: $missing" >&2; return 1; }
    sudo=(sudo)
  fi
  "${sudo[@]}" apt-get update -q
  # shellcheck disable=SC2086
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends \
    $missing
}

# A new build folder compiles in batches, which suits a whole build; one that exists keeps its options.
configure() {
  local options=()
  [ -e build/release/CMakeCache.txt ] || options=(-DAIMS_UNITY=ON)
  cmake --preset release "${options[@]}" >build/configure.log 2>&1 || { cat build/configure.log; return 1; }
}
