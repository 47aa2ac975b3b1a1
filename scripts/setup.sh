# shellcheck shell=bash
# Functions that the run_* commands and make_debs share: system packages, the build, the ROS
# environment.

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$repository/build
devel=$repository/devel # not inside build/: rosrun finds no programs there

say() { printf '\n==> %s\n' "$*"; }

# fail [-c EXIT_CODE] MESSAGE: prints one line on stderr and exits.
fail() {
  local code=1
  if [ "$1" = -c ]; then
    code=$2
    shift 2
  fi
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit "$code"
}

# from_package_xml ELEMENT: prints the text of an element of package.xml, such as version.
from_package_xml() { sed -nE "s|.*<$1[^>]*>(.*)</$1>.*|\1|p" "$repository/package.xml"; }

on_noetic() { [ -f /opt/ros/noetic/setup.bash ] || grep -qs '^VERSION_CODENAME=focal' /etc/os-release; }

# packages_for PURPOSE...: prints the names of the packages on this system, from packages.txt.
packages_for() {
  local column=2
  if on_noetic; then column=3; fi
  awk -v purposes=" $* " -v column="$column" \
    '!/^#/ && index(purposes, " " $1 " ") && $column != "-" {print $column}' \
    "$repository/scripts/packages.txt"
}

installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

apt_get() {
  local as_root=(env)
  if [ "$(id -u)" != 0 ]; then as_root=(sudo env); fi
  "${as_root[@]}" DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 "$@"
}

# install_packages PURPOSE...: installs the missing packages of packages.txt.
install_packages() {
  local package missing=()
  command -v dpkg-query >/dev/null || fail "this is no Debian or Ubuntu: there is no dpkg"
  for package in $(packages_for "$@"); do
    installed "$package" || missing+=("$package")
  done
  if [ ${#missing[@]} = 0 ]; then
    say "System packages: all are installed"
    return
  fi
  say "System packages: installing ${missing[*]}"
  if [ "$(id -u)" != 0 ] && ! command -v sudo >/dev/null; then
    fail "neither root nor sudo; as root, type: apt-get update && apt-get install ${missing[*]}"
  fi
  apt_get update
  apt_get install --yes --no-install-recommends "${missing[@]}"
}

# continue_as_owner ARGUMENTS...: if the script runs under sudo, restarts it as the user who called
# sudo, provided that the user owns the repository. Otherwise the user could not change root's files
# in build/ and devel/ later.
continue_as_owner() {
  if [ "$(id -u)" = 0 ] && [ -n "${SUDO_USER:-}" ] && [ "$SUDO_USER" != root ] &&
    [ "$(stat -c %U "$repository")" = "$SUDO_USER" ]; then
    exec sudo -H -u "$SUDO_USER" -- "$(readlink -f "$0")" "$@"
  fi
}

# Prints the number of parallel jobs: one for each core, but at most one for each
# 1.5 GB of available memory.
build_jobs() {
  local cores room
  cores=$(nproc)
  room=$(awk '/^MemAvailable:/ {print int($2 / 1500000)}' /proc/meminfo)
  if [ "$room" -lt "$cores" ]; then cores=$room; fi
  if [ "$cores" -lt 1 ]; then cores=1; fi
  echo "$cores"
}

# If ccache is installed, what was compiled in one clone is not compiled again in another one.
use_ccache() {
  command -v ccache >/dev/null || return 0
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$repository CCACHE_NOHASHDIR=true
  # Without this, the sources that CMake writes anew in each clone are not found again.
  export CCACHE_SLOPPINESS=include_file_mtime,include_file_ctime
}

# Configures and builds in Release, into build/ and devel/, several sources of a library as one, which takes half the
# time. targets: what to build; nothing: all.
targets=()
# build_package CMAKE_OPTIONS...
build_package() {
  local folder stranger
  for folder in "$build" "$devel"; do
    [ -d "$folder" ] || continue
    stranger=$(find "$folder" -maxdepth 2 ! -writable -print -quit)
    [ -z "$stranger" ] || fail "cannot write $stranger, made by $(stat -c %U "$stranger"); remove build/ and devel/ first: sudo rm -r $build $devel"
  done
  use_ros
  use_ccache
  # A library's sources need not wait until the libraries that it links are complete, as with make. A folder that make
  # has begun stays with make.
  export CMAKE_GENERATOR=Ninja
  say "Building in $build"
  cmake -S "$repository" -B "$build" -DCATKIN_DEVEL_PREFIX="$devel" -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
    -DORGAN_COLLISION_STRICT=OFF "$@"
  cmake --build "$build" --parallel "$(build_jobs)" ${targets:+--target "${targets[@]}"}
}

# Loads the ROS of /opt/ros if there is one. Debian's own ROS packages need no setup.
use_ros() {
  if [ -f /opt/ros/noetic/setup.bash ]; then
    set +u
    # shellcheck disable=SC1091
    . /opt/ros/noetic/setup.bash
    set -u
  fi
}

# ROS resolves this host by name. If /etc/hosts is missing, the package netbase writes it.
check_localhost() {
  getent hosts localhost >/dev/null ||
    fail "the name 'localhost' does not resolve; add the line '127.0.0.1 localhost' to /etc/hosts"
}

# Makes the programs and packages of this build available to ROS.
use_built_package() {
  set +u
  # shellcheck disable=SC1091
  . "$devel/setup.bash"
  set -u
  check_localhost
  # ROS nodes find each other by the name of the host, which not every host can resolve.
  if [ -z "${ROS_HOSTNAME:-}${ROS_IP:-}" ] && ! getent hosts "$(uname -n)" >/dev/null; then
    export ROS_HOSTNAME=localhost
  fi
}
