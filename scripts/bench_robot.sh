#!/usr/bin/env bash
# Measures the whole robot in simulation, with all nodes running: it explores a building, saves the
# map, wakes up elsewhere, finds its place and drives to a goal. Prints one table.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/bench_common.sh"

# name, world
buildings=(
  "small $root/test/small_building.yaml"
  "workshop $root/hv_sim/floor_plans/workshop.yaml"
  "office office"
)
stories=10  # in each building, a seed each
share=0.25
rate=1
people=

usage() {
  cat <<USAGE
usage: bench_robot.sh [options]
  --out DIR            results (default: build/bench/robot_results). Those that are there are kept
                       when they are of the same arguments and programs
  --fresh              tell every story anew
  --floor-plan NAME YAML  a floor plan (map_server) as a further building; may be repeated
  --only NAME          this building only; may be repeated
  --stories N          in each building (default: $stories)
  --people             people walk around
  --point-share S      share of LiDAR columns fired (default: $share)
  --rate R             simulated seconds per second (default: $rate)
  --list               only the names
  --table-only         no runs: the table of the results that are there
  --markdown FILE      also write the table to FILE
One robot at a time, in real time: times and loads need an otherwise idle machine. The programs are
those of scripts/setup.sh.
USAGE
}

out=$build/bench/robot_results
values+=([--fresh]=0 [--people]=0 [--floor-plan]=2)
own_option() {
  case $1 in
    --fresh) fresh=yes ;;
    --floor-plan)
      [ -f "$3" ] || fail "$3 is missing"
      buildings+=("$2 $(realpath "$3")")
      ;;
    --stories) stories=$2 ;;
    --people) people=--people ;;
    --point-share) share=$2 ;;
    --rate) rate=$2 ;;
    *) return 1 ;;
  esac
}
parse_options "$@"
list_if_asked "${buildings[@]}"
require hv_replay/hv_map hv_sim/hv_sim_node hv_lio/hv_lio_node hv_loop_btc/hv_loop_btc_node \
  hv_relocalize_ndt/hv_relocalize_ndt_node hv_navigation/hv_navigation_node \
  hv_explore_sac/hv_explore_sac_node
table+=(--point-share "$share" --rate "$rate")

# tell NAME WORLD SEED
tell() {
  local folder=$out/$1/$3
  local arguments=(--world "$2" --seed "$3" --point-share "$share" --rate "$rate")
  [ -z "$people" ] || arguments+=("$people")
  kept "$folder" "${arguments[*]}" && return
  say "$1, story $3 of $stories"
  rm -rf "$folder"
  mkdir -p "$folder"
  /usr/bin/python3 -B "$root/scripts/robot_story.py" "${arguments[@]}" \
    --hv-map "$programs/hv_replay/hv_map" --out "$folder" >"$folder/log.txt" 2>&1 ||
    fail "robot_story.py failed: $(tail -n 1 "$folder/log.txt")"
  keep "$folder" "${arguments[*]}"
}

mkdir -p "$out"
set +u
# shellcheck disable=SC1091
source "$build/devel/setup.bash"
set -u
found=
for building in "${buildings[@]}"; do
  read -r name world <<<"$building"
  wanted "$name" || continue
  found=yes
  table+=(--building "$name")
  [ -n "$run" ] || continue
  for ((seed = 1; seed <= stories; ++seed)); do tell "$name" "$world" "$seed"; done
done
[ -n "$found" ] || fail "no building is named ${only[*]}"

print_table robot_table.py
