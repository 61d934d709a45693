# SPDX-License-Identifier: MPL-2.0
# Sourced by the other scripts: install_missing <Debian package>...

build_packages=(g++ cmake ninja-build ccache python3 pkg-config
  libeigen3-dev catch2 libbenchmark-dev nlohmann-json3-dev zlib1g-dev libcli11-dev libtbb-dev libfmt-dev libboost1.81-dev libsqlite3-dev python3-matplotlib)

install_missing() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "This is not Debian: please install what these packages hold, if you have not: $*" >&2
    return 0
  fi
  local package missing=()
  for package in "$@"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "Please install as root: apt-get install ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing ${missing[*]}"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends --no-remove "${missing[@]}"
}

# configure <preset> <cmake arguments>...: ninja and ccache where there are any.
configure() {
  local preset=$1 arguments=()
  shift
  command -v ninja >/dev/null && [ ! -e "build/$preset/Makefile" ] && arguments+=(-G Ninja)
  command -v ccache >/dev/null && arguments+=(-D CMAKE_CXX_COMPILER_LAUNCHER=ccache)
  cmake --preset "$preset" "${arguments[@]}" "$@"
}
