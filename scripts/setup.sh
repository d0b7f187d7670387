#!/usr/bin/env bash
# Installs the Debian packages HV-LIOM needs (without recommends) and builds it into build/.
# Safe to repeat: packages that are there are left alone, the build is incremental.
# Arguments go to cmake; HV_BUILD_DIR names another build folder. Files of a target are compiled
# together, which shortens the first build; -DCMAKE_UNITY_BUILD=OFF compiles them one by one.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${HV_BUILD_DIR:-$root/build}")

packages=(
  ca-certificates catkin ccache cmake g++ make ninja-build pkg-config pluginlib-dev
  libactionlib-dev libbenchmark-dev libceres-dev libcli11-dev libdiagnostic-updater-dev libeigen3-dev libembree-dev libgtest-dev
  liblzf-dev libmove-base-msgs-dev libnav-msgs-dev libnodelet-dev libnodeletlib-dev libnodeletlib-tools liboctomap-dev libompl-dev libopencv-dev libopenmpi-dev openmpi-bin libpcl-dev librosbag-dev
  libroscpp-dev librostest-dev libsensor-msgs-dev libssl-dev libstd-srvs-dev libtbb-dev libtf2-eigen-dev
  libtf2-geometry-msgs-dev libtf2-ros-dev libvisualization-msgs-dev libyaml-cpp-dev
  python3-actionlib python3-actionlib-msgs python3-diagnostic-msgs python3-geometry-msgs python3-move-base-msgs python3-nav-msgs python3-numpy python3-rosbag
  python3-roslaunch python3-rosmsg python3-rosnode python3-rosservice python3-rostest
  python3-rostopic python3-sensor-msgs python3-std-srvs python3-tf2-msgs python3-visualization-msgs python3-yaml
  ros-actionlib-msgs ros-geometry-msgs ros-message-generation ros-message-runtime ros-move-base-msgs ros-nav-msgs ros-sensor-msgs
  robin-map-dev ros-robot-state-publisher ros-std-msgs rosbash)

fail() {
  echo "setup: $*" >&2
  exit 1
}

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' ||
    missing+=("$package")
done
if ((${#missing[@]} > 0)); then
  command -v apt-get >/dev/null || fail "these Debian packages are missing: ${missing[*]}"
  as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || fail "run as root, or install sudo: packages are missing"
    as_root=(sudo)
  fi
  echo "setup: installing ${#missing[@]} Debian packages and what they need (2 GB, minutes)"
  "${as_root[@]}" apt-get -o DPkg::Lock::Timeout=300 update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 \
    install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi
getent hosts localhost >/dev/null ||
  echo "setup: 'localhost' does not resolve, ROS nodes will not find each other: see /etc/hosts" >&2

# A python3 of pyenv or conda first on PATH lacks catkin's modules.
export PATH="/usr/bin:$PATH"
mkdir -p "$build"
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 \
  -DCMAKE_UNITY_BUILD=ON \
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache "$@" >"$build/setup.log" 2>&1 ||
  { tail -n 30 "$build/setup.log" >&2; fail "cmake failed, see $build/setup.log"; }
echo "setup: building (half an hour on two cores the first time)"
cmake --build "$build"
echo "setup: done; programs are in $build/devel/lib, 'source $build/devel/setup.bash' for ROS"
