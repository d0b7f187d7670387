#!/usr/bin/env bash
# Makes pages of the interfaces of all libraries with Doxygen. A reference that leads nowhere is an
# error. Prints the path of the first page.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

case ${1:-} in
  -h | --help)
    echo "usage: api_docs.sh [FOLDER]   pages in FOLDER/html, build/api/html otherwise"
    exit 0
    ;;
esac
for program in doxygen dot; do
  command -v "$program" >/dev/null || {
    echo "api_docs: $program is missing: install the Debian packages doxygen and graphviz" >&2
    exit 1
  }
done
out=$(realpath -m "${1:-$root/build/api}")
mkdir -p "$out"
cd "$root"
{ cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = $out"; } | doxygen -
echo "$out/html/index.html"
