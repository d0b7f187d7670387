#!/usr/bin/env bash
# Measures relocalisation and localisation in saved maps and prints one table.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/bench_common.sh"

# name, trajectory of the run that makes the map and its seconds: all of the route, trajectory of the
# other runs, worlds that queries come from which are not in the map
worlds=(
  "office walk 240 robot corridor,tunnel,campus,warehouse"
  "construction walk 240 walk corridor,tunnel,campus,warehouse"
  "warehouse robot 600 robot corridor,tunnel,campus,office"
)
mapped_seed=2  # of the worlds that the maps are of
other_seed=3   # of the same worlds with everything that stands around placed anew
offsets=(1 5 10 15)  # [m] and [deg] of the guesses, 100 trials each
part_seconds=90  # of a run that maps only a part of the world
run_seconds=300
fault_seconds=120
lidar_gap="lidar_gap:start=40,duration=10"
kidnap="kidnap:start=40,by=40"

usage() {
  cat <<USAGE
usage: bench_relocalization.sh [options]
  --data DIR       maps, scans and truth, generated where missing (default:
                   build/bench/relocalization_data). Recordings are removed once used: up to 4 GB
                   at a time
  --out DIR        results (default: build/bench/relocalization_results)
  --real NAME DIR  scans of a real sensor: DIR/map.pcd, DIR/clouds/*.pcd and DIR/poses.tum, a pose in
                   the map for each cloud; may be repeated
  --peer NAME DIR  results of another program on our trials: DIR/<world>_<offset>.csv with columns
                   error_m,error_deg,ms, a row a trial; may be repeated. Clouds, guesses and truth
                   are in <out>/<world>/ndt_<offset>.csv
  --only NAME      this world only; may be repeated
  --list           only the names
  --table-only     no runs: the table of the results that are there
  --markdown FILE  also write the table to FILE
The programs are those of scripts/setup.sh; with -DHV_BENCHMARKS=ON the NDT of PCL runs beside ours.
USAGE
}

data=$build/bench/relocalization_data
out=$build/bench/relocalization_results
real=()
values[--real]=2
own_option() {
  [ "$1" = --real ] || return 1
  real+=("$2 $3")
}
parse_options "$@"
list_if_asked "${worlds[@]}" "${real[@]}"
require hv_sim/hv_simulate hv_sim/hv_simulate_scans hv_replay/hv_slam hv_replay/hv_localize \
  hv_replay/hv_relocalize_eval
pcl=$programs/hv_relocalize_ndt/pcl_ndt_trials

# simulate FOLDER WORLD WORLD_SEED TRAJECTORY SEED SECONDS [OPTION...]
simulate() {
  say "generating $2, $4 for $6 s ${*:7}"
  rm -rf "$1"
  "$programs/hv_sim/hv_simulate" --world "$2" --world-seed "$3" --trajectory "$4" --seed "$5" \
    --duration "$6" --out "$1" "${@:7}" >/dev/null
}

# scans FOLDER WORLD WORLD_SEED SEED COUNT [OPTION...]
scans() {
  [ ! -f "$1/poses.tum" ] || return 0
  local part=$1.part.$$  # another benchmark may make the same
  "$programs/hv_sim/hv_simulate_scans" --world "$2" --world-seed "$3" \
    --seed "$4" --count "$5" --out "$part" "${@:6}" >/dev/null
  mv -T "$part" "$1" 2>/dev/null || rm -rf "$part"
}

# make_map FOLDER WORLD TRAJECTORY SECONDS
make_map() {
  local folder=$1
  [ -f "$folder/map/manifest.yaml" ] && return
  simulate "$folder/recording" "$2" "$mapped_seed" "$3" 2 "$4"
  say "$2: map"
  "$programs/hv_replay/hv_slam" --config "$root/config/hilti_2022.yaml" \
    --bag "$folder/recording/recording.bag" --out "$folder/run" --no-pictures >/dev/null 2>&1 ||
    fail "hv_slam failed on $folder/recording"
  cp "$folder/recording/truth.tum" "$folder/truth.tum"
  mv "$folder/run/map" "$folder/map"
  rm -rf "$folder/recording" "$folder/run"
}

# trials NAME MAP CLOUDS RESULT [OPTION...]
trials() {
  "$programs/hv_replay/hv_relocalize_eval" --map "$2" --clouds "$3" --out "$out/$1/$4.csv" \
    --json "${@:5}" >"$out/$1/$4.json" || fail "hv_relocalize_eval failed for $1, $4"
}

# guesses NAME MAP CLOUDS [OPTION...]: the trials of the paper's Table 6
guesses() {
  local offset
  for offset in "${offsets[@]}"; do
    say "$1: guesses off by $offset m and deg"
    local near=(--count 100 --perturb "$offset" "$offset" "${@:4}")
    trials "$1" "$2" "$3" "search_$offset" "${near[@]}" \
      --guess-window "$(awk "BEGIN { print 1.2 * $offset + 0.5 }")" \
      "$(awk "BEGIN { print 1.2 * $offset + 1 }")"
    trials "$1" "$2" "$3" "ndt_$offset" "${near[@]}" --ndt-alone
    trials "$1" "$2" "$3" "single3_$offset" "${near[@]}" --ndt-alone --resolutions 3
    trials "$1" "$2" "$3" "without10_$offset" "${near[@]}" --ndt-alone --resolutions 5 3 1
    trials "$1" "$2" "$3" "without1_$offset" "${near[@]}" --ndt-alone --resolutions 10 5 3
    [ -x "$pcl" ] || continue
    local cloud=$2
    [ -d "$2" ] && cloud=$2/cloud.pcd
    "$pcl" "$cloud" "$3" "$out/$1/ndt_$offset.csv" "$out/$1/pcl_$offset.csv"
  done
}

# localize WORLD WORLD_SEED TRAJECTORY VARIANT SECONDS [OPTION...]
localize() {
  local folder=$out/$1/$4
  simulate "$folder/recording" "$1" "$2" "$3" 7 "$5" "${@:6}"
  say "$1: localisation, $4"
  "$programs/hv_replay/hv_localize" --map "$data/$1/map" --config "$root/config/hilti_2022.yaml" \
    --bag "$folder/recording/recording.bag" --out "$folder" >/dev/null 2>"$folder/log.txt" ||
    fail "hv_localize failed: $(tail -n 1 "$folder/log.txt")"
  rm "$folder/recording/recording.bag"
}

mkdir -p "$data" "$out"
found=
for world in "${worlds[@]}"; do
  read -r name mapping map_seconds driving others <<<"$world"
  wanted "$name" || continue
  found=yes
  table+=(--world "$name")
  [ -n "$run" ] || continue
  mkdir -p "$out/$name"
  folder=$data/$name
  make_map "$folder" "$name" "$mapping" "$map_seconds"
  make_map "$folder/part" "$name" "$mapping" "$part_seconds"
  scans "$folder/scans" "$name" "$mapped_seed" 11 50 --away-from "$folder/truth.tum"
  known=(--poses "$folder/scans/poses.tum" --map-truth "$folder/truth.tum")
  guesses "$name" "$folder/map" "$folder/scans" "${known[@]}"
  say "$name: a map that has changed, and no guess"
  trials "$name" "$folder/map" "$folder/scans" changed "${known[@]}" --count 100 --perturb 1 1 \
    --guess-window 1.7 2.2 --changed-share 0.2
  trials "$name" "$folder/map" "$folder/scans" anywhere "${known[@]}"
  trials "$name" "$folder/part/map" "$folder/scans" part --poses "$folder/scans/poses.tum" \
    --map-truth "$folder/part/truth.tum"
  for other in ${others//,/ }; do
    scans "$data/elsewhere_$other" "$other" 5 3 25 --distance 0
    trials "$name" "$folder/map" "$data/elsewhere_$other" "elsewhere_$other"
  done
  localize "$name" "$mapped_seed" "$driving" drive "$run_seconds"
  localize "$name" "$mapped_seed" "$driving" blackout "$fault_seconds" --fault "$lidar_gap"
  localize "$name" "$mapped_seed" "$driving" kidnapped "$fault_seconds" --fault "$kidnap"
  localize "$name" "$other_seed" "$driving" refurnished "$fault_seconds"
done
for entry in "${real[@]}"; do
  read -r name folder <<<"$entry"
  table+=(--real "$name")
  found=yes
  [ -n "$run" ] || continue
  mkdir -p "$out/$name"
  guesses "$name" "$folder/map.pcd" "$folder/clouds" --poses "$folder/poses.tum"
  trials "$name" "$folder/map.pcd" "$folder/clouds" anywhere --poses "$folder/poses.tum"
done
[ -n "$found" ] || fail "no world is named ${only[*]}"

print_table relocalization_table.py
