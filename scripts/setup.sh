# shellcheck shell=bash
# What run_demo and run_tests share: system packages, the build, the ROS environment. Sourced by both.

repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$repository/build
devel=$repository/devel # rosrun finds nothing below build/

say() { printf '\n==> %s\n' "$*"; }

# fail [-c EXIT_CODE] MESSAGE: one line on stderr, and the end.
fail() {
  local code=1
  if [ "$1" = -c ]; then
    code=$2
    shift 2
  fi
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit "$code"
}

on_noetic() { [ -f /opt/ros/noetic/setup.bash ] || grep -qs '^VERSION_CODENAME=focal' /etc/os-release; }

# packages_for PURPOSE...: their names on this system, from packages.txt.
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

# install_packages PURPOSE...: those of packages.txt that are missing.
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

# continue_as_owner ARGUMENTS...: under sudo, what follows is done by the user who typed it, if the
# repository is theirs: else root's files in build/ and devel/ would stand in their way later.
continue_as_owner() {
  if [ "$(id -u)" = 0 ] && [ -n "${SUDO_USER:-}" ] && [ "$SUDO_USER" != root ] &&
    [ "$(stat -c %U "$repository")" = "$SUDO_USER" ]; then
    exec sudo -H -u "$SUDO_USER" -- "$repository/$(basename "$0")" "$@"
  fi
}

# One job for each core, but no more than the memory holds.
build_jobs() {
  local cores room
  cores=$(nproc)
  room=$(awk '/^MemAvailable:/ {print int($2 / 1500000)}' /proc/meminfo)
  if [ "$room" -lt "$cores" ]; then cores=$room; fi
  if [ "$cores" -lt 1 ]; then cores=1; fi
  echo "$cores"
}

# build_package CMAKE_OPTIONS...: in Release, into build/ and devel/.
build_package() {
  local folder stranger
  for folder in "$build" "$devel"; do
    [ -d "$folder" ] || continue
    stranger=$(find "$folder" -maxdepth 2 ! -writable -print -quit)
    [ -z "$stranger" ] || fail "cannot write $stranger, made by $(stat -c %U "$stranger"); remove build/ and devel/ first: sudo rm -r $build $devel"
  done
  use_ros
  say "Building in $build"
  cmake -S "$repository" -B "$build" -DCATKIN_DEVEL_PREFIX="$devel" -DCMAKE_BUILD_TYPE=Release "$@"
  cmake --build "$build" --parallel "$(build_jobs)"
}

# ROS from /opt/ros where it is there; Debian's own needs nothing.
use_ros() {
  if [ -f /opt/ros/noetic/setup.bash ]; then
    set +u
    # shellcheck disable=SC1091
    . /opt/ros/noetic/setup.bash
    set -u
  fi
}

# ROS asks by name even for this host. (The package netbase writes /etc/hosts where there is none.)
check_localhost() {
  getent hosts localhost >/dev/null ||
    fail "the name 'localhost' does not resolve; add the line '127.0.0.1 localhost' to /etc/hosts"
}

# The ROS programs and packages as built.
use_built_package() {
  set +u
  # shellcheck disable=SC1091
  . "$devel/setup.bash"
  set -u
  check_localhost
  # ROS nodes find each other by the host's name, which not every host can resolve.
  if [ -z "${ROS_HOSTNAME:-}${ROS_IP:-}" ] && ! getent hosts "$(uname -n)" >/dev/null; then
    export ROS_HOSTNAME=localhost
  fi
}
