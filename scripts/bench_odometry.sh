#!/usr/bin/env bash
# Measures the odometry on generated sequences, beside other programs' results, and prints one table.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/bench_common.sh"

# name, world, trajectory, seconds
sequences=(
  "construction_walk construction walk 120"
  "corridor_robot corridor robot 180"
  "office_walk office walk 180"
  "office_aggressive office aggressive 90"
  "warehouse_robot warehouse robot 180"
  "campus_segway campus segway 240"
  "tunnel_robot tunnel robot 150"
  "tunnel_straight_robot tunnel_straight robot 120"
  "workshop_walk $root/hv_sim/floor_plans/workshop.yaml walk 75"
)
cells=("025 0.25" "050 0.50")
memory_sequence=tunnel_robot  # new ground all the way, scans of equal size

usage() {
  cat <<USAGE
usage: bench_odometry.sh [options]
  --data DIR       recordings, generated where missing (default: build/bench/data; about 20 GB)
  --out DIR        results (default: build/bench/results)
  --peer NAME DIR  results of another program, DIR/<sequence>/leaf025|leaf050/trajectory.tum
                   (IMU frame, TUM) and timing.csv (a column total_ms); may be repeated
  --kitti DIR      start of a KITTI odometry sequence: velodyne/, calib.txt, poses*.txt
  --threads N      threads of one scan's work (default: 1)
  --only NAME      this sequence only; may be repeated
  --list           only the names
  --table-only     no runs: the table of the results that are there
  --markdown FILE  also write the table to FILE
The programs are those of scripts/setup.sh.
USAGE
}

data=$build/bench/data
out=$build/bench/results
kitti=
threads=1
own_option() {
  case $1 in
    --kitti) kitti=$2 ;;
    --threads) threads=$2 ;;
    *) return 1 ;;
  esac
}
parse_options "$@"
list_if_asked "${sequences[@]}"
require hv_sim/hv_simulate hv_replay/hv_slam hv_replay/hv_ape hv_replay/hv_parameters \
  hv_replay/hv_kitti_to_bag

# generate NAME WORLD TRAJECTORY SECONDS
generate() {
  [ -f "$data/$1/recording.bag" ] && [ -f "$data/$1/truth.tum" ] && return
  say "generating $1 ($4 s)"
  rm -rf "$data/$1.part"
  "$programs/hv_sim/hv_simulate" --world "$2" --trajectory "$3" --duration "$4" --seed 1 \
    --out "$data/$1.part" >/dev/null
  rm -rf "${data:?}/$1"
  mv "$data/$1.part" "$data/$1"
}

# set_option FILE SECTION KEY VALUE: odometry.SECTION.KEY of a configuration file
set_option() {
  awk -v section="  $2:" -v key="    $3:" -v value="$4" -v known="$(grep -c "^  $2:" "$1" || true)" '
    /^[^ #]/ || /^  [^ #]/ { inside = 0 }
    inside && index($0, key) == 1 { next }
    { print }
    $0 == section && known { inside = 1; print key " " value }
    /^odometry:/ && !known { print section; print key " " value }' "$1" >"$1.new"
  mv "$1.new" "$1"
}

# slam CONFIG BAG OUT
slam() {
  "$programs/hv_replay/hv_slam" --config "$1" --bag "$2" --out "$3" --threads "$threads" \
    --no-loop --no-pictures >"$3/log.txt" 2>&1 ||
    fail "hv_slam failed on $2: $(tail -n 1 "$3/log.txt")"
  [ -f "$3/trajectory.tum" ] || cp "$3/odometry.tum" "$3/trajectory.tum"
}

# run_cell NAME LABEL CELL_SIZE
run_cell() {
  local result=$out/hv_lio/$1/leaf$2
  say "$1, cells of $3 m"
  rm -rf "$result"
  mkdir -p "$result"
  cp "$root/config/hilti_2022.yaml" "$result/input.yaml"
  set_option "$result/input.yaml" preprocess cell_size_m "$3"
  slam "$result/input.yaml" "$data/$1/recording.bag" "$result"
}

# The table holds what the map has gathered a little before a fifth of the run.
run_memory() {
  local timing=$out/hv_lio/$memory_sequence/leaf050/timing.csv result=$out/memory capacity
  capacity=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "voxels") column = i }
    NR > 1 { voxels[NR] = $column } END { printf "%d", 0.9 * voxels[int(NR / 5)] }' "$timing")
  say "$memory_sequence with a table of $capacity voxels"
  rm -rf "$result"
  mkdir -p "$result"
  cp "$root/config/hilti_2022.yaml" "$result/input.yaml"
  set_option "$result/input.yaml" map capacity "$capacity"
  set_option "$result/input.yaml" map max_subdivisions "$((capacity / 4))"
  slam "$result/input.yaml" "$data/$memory_sequence/recording.bag" "$result"
}

run_kitti() {
  local result=$out/kitti
  say "KITTI without IMU"
  rm -rf "$result"
  mkdir -p "$result"
  "$programs/hv_replay/hv_kitti_to_bag" --input "$kitti" --out "$result/recording.bag" >/dev/null
  slam "$root/config/kitti.yaml" "$result/recording.bag" "$result"
  rm "$result/recording.bag"
}

mkdir -p "$data" "$out"
found=
for sequence in "${sequences[@]}"; do
  read -r name world trajectory seconds <<<"$sequence"
  wanted "$name" || continue
  found=yes
  table+=(--sequence "$name")
  [ -n "$run" ] || continue
  generate "$name" "$world" "$trajectory" "$seconds"
  for cell in "${cells[@]}"; do
    read -r label size <<<"$cell"
    run_cell "$name" "$label" "$size"
  done
done
[ -n "$found" ] || fail "no sequence is named ${only[*]}"
if [ -n "$run" ]; then
  ! wanted "$memory_sequence" || run_memory
  [ -z "$kitti" ] || run_kitti
fi
[ -z "$kitti" ] || table+=(--kitti "$kitti")
! wanted "$memory_sequence" || table+=(--memory "$memory_sequence")

# shellcheck disable=SC2016
default_cell=$("$programs/hv_replay/hv_parameters" |
  sed -n 's/^| `odometry.preprocess.cell_size_m` | `\([^`]*\)`.*/\1/p')
print_table odometry_table.py --ape "$programs/hv_replay/hv_ape" --default-cell "$default_cell" \
  --threads "$threads"
