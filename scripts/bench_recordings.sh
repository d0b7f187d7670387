#!/usr/bin/env bash
# Measures odometry and loop closing on real recordings with truth, and prints one table.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/bench_common.sh"

recordings=()  # name, kind, bag or session, truth; parted by '|', since paths may hold spaces

usage() {
  cat <<USAGE
usage: bench_recordings.sh [options]
  --hilti DIR      of the Hilti challenge: DIR/*.bag, each with its truth of the IMU beside it, under
                   the same name with .tum or .txt; those without truth are left out; may be repeated
  --nclt DIR       sessions of NCLT: DIR/<date>/ with velodyne_hits.bin or velodyne_sync/, ms25.csv
                   and groundtruth_<date>.csv; may be repeated
  --out DIR        results (default: build/bench/recordings_results)
  --peer NAME DIR  results of another program, DIR/<recording>/trajectory.tum (IMU frame, TUM) and
                   timing.csv (a column total_ms); may be repeated
  --only NAME      this recording only; may be repeated
  --list           only the names
  --table-only     no runs: the table of the results that are there
  --markdown FILE  also write the table to FILE
The programs are those of scripts/setup.sh.
USAGE
}

out=$build/bench/recordings_results

add_hilti() {
  local bag truth
  for bag in "$1"/*.bag; do
    [ -f "$bag" ] || fail "$1 holds no bag"
    for truth in "${bag%.bag}.tum" "${bag%.bag}.txt"; do
      [ ! -f "$truth" ] || recordings+=("$(basename "$bag" .bag)|hilti_2022|$bag|$truth")
    done
  done
}

add_nclt() {
  local times
  for times in "$1"/*/ms25.csv; do
    [ -f "$times" ] || fail "$1 holds no session: no */ms25.csv"
    times=$(dirname "$times")
    recordings+=("nclt_$(basename "$times")|nclt|$times|$out/nclt_$(basename "$times")/recording.tum")
  done
}

own_option() {
  case $1 in
    --hilti) add_hilti "$(realpath "$2")" ;;
    --nclt) add_nclt "$(realpath "$2")" ;;
    *) return 1 ;;
  esac
}
parse_options "$@"
((${#recordings[@]} > 0)) || fail "no recording with truth: --hilti DIR, --nclt DIR"
list_if_asked "${recordings[@]//|/ }"
require hv_replay/hv_slam hv_replay/hv_ape hv_replay/hv_nclt_to_bag

# slam NAME KIND BAG
slam() {
  say "$1"
  "$programs/hv_replay/hv_slam" --config "$root/config/$2.yaml" --bag "$3" --out "$out/$1" \
    --threads 1 >"$out/$1/log.txt" 2>&1 ||
    fail "hv_slam failed on $3: $(tail -n 1 "$out/$1/log.txt")"
}

mkdir -p "$out"
found=
for recording in "${recordings[@]}"; do
  IFS='|' read -r name kind input truth <<<"$recording"
  wanted "$name" || continue
  found=yes
  table+=(--recording "$name" "$truth")
  [ -n "$run" ] || continue
  rm -rf "${out:?}/$name"
  mkdir -p "$out/$name"
  if [ "$kind" = nclt ]; then
    say "$name: converting"
    "$programs/hv_replay/hv_nclt_to_bag" --input "$input" --out "$out/$name/recording.bag" \
      >/dev/null || fail "hv_nclt_to_bag failed on $input"
    input=$out/$name/recording.bag
  fi
  slam "$name" "$kind" "$input"
  [ "$kind" != nclt ] || rm "$input"
done
[ -n "$found" ] || fail "no recording is named ${only[*]}"

print_table recordings_table.py --ape "$programs/hv_replay/hv_ape"
