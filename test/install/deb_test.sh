#!/usr/bin/env bash
# Installs the Debian packages into this system and uses them as users would. It is run by hand, as root, in a bare
# Debian 12 or 13 (trixie) without other ROS programs. It changes the system. From the repository's folder:
#   debootstrap --variant=minbase bookworm /tmp/bare http://deb.debian.org/debian
#   mount -t proc proc /tmp/bare/proc
#   mount --rbind /dev /tmp/bare/dev
#   cp -r build/debs test/install /tmp/bare/root/
#   chroot /tmp/bare /root/install/deb_test.sh /root/debs
#   umount -l /tmp/bare/dev /tmp/bare/proc
set -euo pipefail

if [ $# != 1 ] || [ ! -d "$1" ]; then
  echo "Usage: deb_test.sh FOLDER_OF_DEBS" >&2
  exit 2
fi
debs=$(realpath "$1")
here=$(dirname "$(readlink -f "$0")")
work=$(mktemp -d)
export DEBIAN_FRONTEND=noninteractive ROS_HOSTNAME=localhost ROS_HOME=$work/ros HOME=$work

say() { printf '\n==> %s\n' "$*"; }
install() { apt-get install --yes --no-install-recommends "$@" >"$work/apt.log" || { cat "$work/apt.log"; exit 1; }; }

# expect WORDS COMMAND...: runs the command and requires that its output contains the words.
expect() {
  local words=$1 output
  shift
  output=$("$@" 2>&1) || { printf '%s\n' "$output"; exit 1; }
  [[ $output == *"$words"* ]] || { printf 'no "%s" in the output of %s:\n%s\n' "$words" "$*" "$output"; exit 1; }
  echo "$*: $words"
}

say "The runtime package alone"
apt-get update >/dev/null
install "$debs"/ros-organ-collision_*.deb
expect organ_collision rospack list
expect "float64 depth" rosmsg show organ_collision/Contact
expect --motions rosrun organ_collision query_offline --help
expect "launch/organ_collision.launch" roslaunch --files organ_collision organ_collision.launch
cat >"$work/sheet.obj" <<END
v -0.05 -0.05 0.1
v 0.05 -0.05 0.1
v 0.05 0.05 0.1
f 1 2 3
END
cat >"$work/motions.csv" <<END
query,mode,trocar_x,trocar_y,trocar_z,previous_x,previous_y,previous_z,tip_x,tip_y,tip_z,radius
0,static,0.01,-0.01,0,0,0,0,0.01,-0.01,0.15,0.005
END
expect "0,0,0," rosrun organ_collision query_offline --mesh "$work/sheet.obj" --motions "$work/motions.csv"
expect "answers/s" timeout --signal=INT 60 roslaunch organ_collision demo.launch seconds:=3

say "rostest of a user's package, with the node and with the nodelet"
install python3-rostest
export ROS_PACKAGE_PATH=$here/user_package:/usr/share
for launch in organ_collision.launch nodelet.launch; do
  expect "RESULT: SUCCESS" rostest --text user_package touch.test launch:=$launch
done

say "The links of a URDF, which a separate program reads"
roslaunch organ_collision grasper.launch >"$work/grasper.log" 2>&1 &
until rostopic list >/dev/null 2>&1; do sleep 1; done
expect grasper_left_jaw timeout 60 rostopic echo -n 1 --filter "m.contacts" /organ_collision/contacts
kill $!
wait $! || true

say "The development package: with catkin, and without ROS"
install "$debs"/liborgan-collision-dev_*.deb build-essential cmake
cmake -S "$here/user_package" -B "$work/user_package" >"$work/cmake.log" || { cat "$work/cmake.log"; exit 1; }
cmake --build "$work/user_package" >/dev/null
expect "face: 0" "$work/user_package/devel/lib/user_package/touched_faces"
cmake -S "$here/consumer" -B "$work/consumer" >"$work/cmake.log" || { cat "$work/cmake.log"; exit 1; }
cmake --build "$work/consumer" >/dev/null
expect $'0\n1' "$work/consumer/consumer"

rm -r "$work"
say "All of it works"
