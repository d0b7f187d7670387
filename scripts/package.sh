#!/usr/bin/env bash
# Builds HV-LIOM without tests and packs its install space into a Debian package that puts
# everything into /opt/hv_liom. Prints the path of the package last. Arguments go to cmake.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${HV_BUILD_DIR:-$root/build/package}")

case ${1:-} in
  -h | --help)
    echo "usage: package.sh [CMAKE_ARGUMENT...]   makes build/package/hv-liom_VERSION_ARCHITECTURE.deb"
    exit 0
    ;;
esac

HV_BUILD_DIR=$build "$root/scripts/setup.sh" -DCATKIN_ENABLE_TESTING=OFF \
  -DCMAKE_INSTALL_PREFIX=/opt/hv_liom "$@"
command -v dpkg-shlibdeps >/dev/null || {
  echo "package: dpkg-shlibdeps is missing: install the Debian package dpkg-dev" >&2
  exit 1
}
rm -f "$build"/*.deb
# catkin asks its own python3 where modules go.
(cd "$build" && PATH="/usr/bin:$PATH" cpack >package.log 2>&1) ||
  { tail -n 30 "$build/package.log" >&2; echo "package: cpack failed, see $build/package.log" >&2; exit 1; }
ls "$build"/*.deb
