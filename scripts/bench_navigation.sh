#!/usr/bin/env bash
# Measures navigation in the closed loop, without ROS, and prints one table.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/bench_common.sh"

# name, trajectory of the run that makes the map and its seconds
worlds=(
  "office walk 240"
  "warehouse robot 600"
)
plan_seconds=600  # of the mapping run in a floor plan
world_seed=2
seeds=(1 2 3 4)  # a start and goals each
goals=25         # for each seed
scenarios=("warehouse low_obstacles 20" "office blocked_corridor 10")
processes=2
share=0.25
config=$root/config/robot.yaml

usage() {
  cat <<USAGE
usage: bench_navigation.sh [options]
  --data DIR               maps and truth, generated where missing (default:
                           build/bench/navigation_data). Recordings are removed once used: up to
                           4 GB at a time
  --out DIR                results (default: build/bench/navigation_results). Those that are there
                           are kept when they are of the same arguments and programs
  --fresh                  drive everything anew
  --floor-plan NAME YAML   a floor plan (map_server) as a further world; may be repeated
  --only NAME              this world only; may be repeated
  --goals N                for each of ${#seeds[@]} starts in a world (default: $goals)
  --point-share S          share of LiDAR columns fired, for speed (default: $share)
  --processes N            drives at once, one thread each (default: $processes)
  --list                   only the names
  --table-only             no runs: the table of the results that are there
  --markdown FILE          also write the table to FILE
The programs are those of scripts/setup.sh.
USAGE
}

data=$build/bench/navigation_data
out=$build/bench/navigation_results
values+=([--fresh]=0 [--floor-plan]=2)
declare -A world_of  # of names of floor plans: their YAML
own_option() {
  case $1 in
    --fresh) fresh=yes ;;
    --floor-plan)
      [ -f "$3" ] || fail "$3 is missing"
      worlds+=("$2 robot $plan_seconds")
      world_of[$2]=$(realpath "$3")
      ;;
    --goals) goals=$2 ;;
    --point-share) share=$2 ;;
    --processes) processes=$2 ;;
    *) return 1 ;;
  esac
}
parse_options "$@"
list_if_asked "${worlds[@]}"
require hv_sim/hv_simulate hv_replay/hv_slam hv_replay/hv_navigate
table+=(--point-share "$share" --processes "$processes")

# make_map NAME TRAJECTORY SECONDS
make_map() {
  local folder=$data/$1
  [ -f "$folder/map/manifest.yaml" ] && return
  say "$1: recording for the map, $2 for $3 s"
  rm -rf "$folder/recording"
  "$programs/hv_sim/hv_simulate" --world "${world_of[$1]:-$1}" --world-seed "$world_seed" \
    --trajectory "$2" --format robot --seed 2 --duration "$3" --out "$folder/recording" >/dev/null
  say "$1: map"
  "$programs/hv_replay/hv_slam" --config "$config" --bag "$folder/recording/recording.bag" \
    --out "$folder/run" --no-pictures >/dev/null 2>&1 || fail "hv_slam failed on $folder/recording"
  cp "$folder/recording/truth.tum" "$folder/truth.tum"
  mv "$folder/run/map" "$folder/map"
  rm -rf "$folder/recording" "$folder/run"
}

# drive NAME RESULT SEED GOALS [OPTION...]
drive() {
  measure 1 "$out/$1/$2" hv_navigate --world "${world_of[$1]:-$1}" --world-seed "$world_seed" \
    --map "$data/$1/map" --map-truth "$data/$1/truth.tum" --config "$config" --seed "$3" \
    --goals "$4" --point-share "$share" --out "$out/$1/$2" "${@:5}"
}

mkdir -p "$data" "$out"
found=
for world in "${worlds[@]}"; do
  read -r name mapping map_seconds <<<"$world"
  wanted "$name" || continue
  found=yes
  table+=(--world "$name")
  [ -n "$run" ] || continue
  make_map "$name" "$mapping" "$map_seconds"
done
[ -n "$found" ] || fail "no world is named ${only[*]}"
for world in "${worlds[@]}"; do
  read -r name _ <<<"$world"
  wanted "$name" && [ -n "$run" ] || continue
  for seed in "${seeds[@]}"; do
    in_background drive "$name" "random_$seed" "$seed" "$goals"
  done
done
for entry in "${scenarios[@]}"; do
  read -r name scenario count <<<"$entry"
  wanted "$name" && [ -n "$run" ] || continue
  in_background drive "$name" "$scenario" 11 "$count" --scenario "$scenario"
done
finish_background

print_table navigation_table.py
