#!/usr/bin/env bash
# Installs the Debian packages HV-LIOM needs (without recommends) and builds it into build/.
# Safe to repeat: packages that are there are left alone, the build is incremental.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${HV_BUILD_DIR:-$root/build}

packages=(
  ca-certificates catkin ccache cmake g++ make ninja-build
  libbenchmark-dev libcli11-dev libdiagnostic-updater-dev libeigen3-dev libembree-dev libgtest-dev
  libnav-msgs-dev libnodelet-dev libnodeletlib-tools libopencv-dev librosbag-dev libroscpp-dev
  librostest-dev libsensor-msgs-dev libstd-srvs-dev libtbb-dev libtf2-eigen-dev
  libtf2-geometry-msgs-dev libtf2-ros-dev libvisualization-msgs-dev libyaml-cpp-dev
  python3-diagnostic-msgs python3-geometry-msgs python3-nav-msgs python3-numpy python3-rosbag
  python3-roslaunch python3-rosmsg python3-rosnode python3-rosservice python3-rostest
  python3-rostopic python3-sensor-msgs python3-std-srvs python3-tf2-msgs python3-visualization-msgs
  ros-geometry-msgs ros-message-generation ros-message-runtime ros-nav-msgs ros-sensor-msgs
  ros-std-msgs rosbash)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' ||
    missing+=("$package")
done
if ((${#missing[@]} > 0)); then
  echo "setup: installing ${#missing[@]} Debian packages"
  as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
    --no-install-recommends "${missing[@]}" >/dev/null
fi

# A python3 of pyenv or conda first on PATH lacks catkin's modules.
export PATH="/usr/bin:$PATH"
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 \
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache "$@" >"$build.log" 2>&1 ||
  { tail -n 30 "$build.log" >&2; echo "setup: cmake failed, see $build.log" >&2; exit 1; }
echo "setup: building"
cmake --build "$build"
echo "setup: done; programs are in $build/devel/lib, 'source $build/devel/setup.bash' for ROS"
