#!/usr/bin/env bash
# Feeds damaged and hostile bytes to everything that reads files or messages, with libFuzzer,
# AddressSanitizer and UndefinedBehaviorSanitizer. Ends with 'N readers, N findings'.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${HV_BUILD_DIR:-$root/build/fuzz}")
seconds=60

usage() {
  cat <<USAGE
usage: fuzz.sh [--seconds N] [READER...]
  --seconds N  for each reader (default: $seconds)
  READER       these only; all otherwise. Inputs that were worth keeping stay in
               build/fuzz/corpus/READER, findings in build/fuzz/findings/READER
Needs the Debian package clang beside those of scripts/setup.sh.
USAGE
}

readers=()
while [ $# -gt 0 ]; do
  case $1 in
    --seconds)
      seconds=${2:?--seconds needs a number}
      shift
      ;;
    --help)
      usage
      exit 0
      ;;
    -*)
      usage >&2
      exit 2
      ;;
    *) readers+=("$1") ;;
  esac
  shift
done
command -v clang++ >/dev/null || {
  echo "fuzz: clang++ is missing: install the Debian package clang" >&2
  exit 1
}

export PATH="/usr/bin:$PATH"
sanitizers="-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined"
[ -f "$build/build.ninja" ] || cmake -S "$root" -B "$build" -G Ninja -DHV_FUZZ=ON \
  -DCATKIN_ENABLE_TESTING=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_UNITY_BUILD=ON \
  -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 \
  -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ \
  -DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
  -DCMAKE_CXX_FLAGS="$sanitizers" >/dev/null
ninja -C "$build" hv_fuzz
program=$build/test/fuzz/hv_fuzz
[ ${#readers[@]} -gt 0 ] || mapfile -t readers < <("$program")

findings=0
for reader in "${readers[@]}"; do
  corpus=$build/corpus/$reader
  found=$build/findings/$reader
  mkdir -p "$corpus" "$found"
  if HV_FUZZ_READER=$reader HV_FUZZ_SEEDS=$corpus "$program" "$corpus" \
    -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -artifact_prefix="$found/" \
    -print_final_stats=1 >"$found/log.txt" 2>&1; then
    runs=$(sed -n 's/stat::number_of_executed_units: *//p' "$found/log.txt")
    printf '%-22s %12s runs\n' "$reader" "$runs"
  else
    findings=$((findings + 1))
    printf '%-22s FINDING: %s\n' "$reader" "$found/log.txt"
  fi
done
echo "${#readers[@]} readers, $findings findings"
[ "$findings" -eq 0 ]
