#!/usr/bin/env bash
# Measures exploration, in dungeon maps and in the closed loop without ROS, and prints one table.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/bench_common.sh"

worlds=(office warehouse tunnel)
world_seed=2
planners=(nearest utility tour)
dungeons=()  # name, how many maps from the end (0: all), tiles file
weights=
starts=2     # in each world
processes=2
share=0.25
seconds=3600
config=$root/config/robot.yaml

usage() {
  cat <<USAGE
usage: bench_exploration.sh [options]
  --out DIR                    results (default: build/bench/exploration_results). Those that are
                               there are kept when they are of the same arguments and programs
  --fresh                      run everything anew
  --dungeons NAME FILE         maps of the dungeon benchmark (tiles text file); may be repeated.
                               The oracle runs on the first that is wanted
  --held-out NAME FILE COUNT   the same with the last COUNT maps of FILE, which a training left out
  --weights FILE               of the planner \`sac\`; without it that is not measured
  --floor-plan NAME YAML       a floor plan (map_server) as a further world; may be repeated
  --only NAME                  these dungeons or this world only; may be repeated
  --starts N                   in each world (default: $starts)
  --time-limit S               simulated seconds of a run (default: $seconds)
  --point-share S              share of LiDAR columns fired, for speed (default: $share)
  --processes N                runs at once, one thread each (default: $processes)
  --list                       only the names
  --table-only                 no runs: the table of the results that are there
  --markdown FILE              also write the table to FILE
The programs are those of scripts/setup.sh.
USAGE
}

out=$build/bench/exploration_results
values+=([--fresh]=0 [--dungeons]=2 [--held-out]=3 [--floor-plan]=2)
declare -A world_of  # of names of floor plans: their YAML

need_file() { [ -f "$1" ] || fail "$1 is missing"; }

# add_dungeons NAME COUNT FILE
add_dungeons() {
  need_file "$3"
  [ "$1" != all ] || fail "'all' stands for all dungeons together"
  dungeons+=("$1 $2 $(realpath "$3")")
}

own_option() {
  case $1 in
    --fresh) fresh=yes ;;
    --dungeons) add_dungeons "$2" 0 "$3" ;;
    --held-out) add_dungeons "$2" "$4" "$3" ;;
    --weights) need_file "$2"; weights=$(realpath "$2") ;;
    --floor-plan)
      need_file "$3"
      worlds+=("$2")
      world_of[$2]=$(realpath "$3")
      ;;
    --starts) starts=$2 ;;
    --time-limit) seconds=$2 ;;
    --point-share) share=$2 ;;
    --processes) processes=$2 ;;
    *) return 1 ;;
  esac
}
parse_options "$@"
list_if_asked "${dungeons[@]}" "${worlds[@]}"
require hv_replay/hv_explore hv_replay/hv_explore_eval hv_replay/hv_plot_curves
[ -z "$weights" ] || planners+=(sac)
for planner in "${planners[@]}"; do table+=(--planner "$planner"); done
table+=(--starts "$starts" --time-limit "$seconds" --point-share "$share" --processes "$processes")

# weights_of PLANNER: the options that name its weights, in `of_planner`
weights_of() {
  of_planner=()
  [ "$1" != sac ] || of_planner=(--weights "$weights")
}

# explore_maps NAME COUNT FILE PLANNER RESULT [OPTION...]
explore_maps() {
  local folder=$out/dungeons/$1/$5 of_maps=(--maps "$3") of_planner
  (($2 == 0)) || of_maps+=(--last "$2")
  weights_of "$4"
  measure "$processes" "$folder" hv_explore_eval "${of_maps[@]}" --planner "$4" \
    "${of_planner[@]}" --out "$folder/runs.csv" "${@:6}"
}

# explore_world NAME PLANNER SEED
explore_world() {
  local folder=$out/worlds/$1/$2_$3 of_planner
  weights_of "$2"
  measure 1 "$folder" hv_explore --world "${world_of[$1]:-$1}" --world-seed "$world_seed" \
    --config "$config" --planner "$2" "${of_planner[@]}" --seed "$3" --point-share "$share" \
    --time-limit "$seconds" --out "$folder"
}

mkdir -p "$out"
found=
for entry in "${dungeons[@]}"; do
  read -r name count file <<<"$entry"
  wanted "$name" || continue
  table+=(--dungeons "$name")
  first=${first:-$name}
  found=yes
  [ -n "$run" ] || continue
  for planner in "${planners[@]}"; do
    explore_maps "$name" "$count" "$file" "$planner" "$planner"
  done
  [ -z "$weights" ] ||
    explore_maps "$name" "$count" "$file" sac sac_without_guard --no-loop-guard
  [ "$name" != "$first" ] || explore_maps "$name" "$count" "$file" oracle oracle
done
for name in "${worlds[@]}"; do
  wanted "$name" || continue
  table+=(--world "$name")
  found=yes
  [ -n "$run" ] || continue
  for planner in "${planners[@]}"; do
    for ((seed = 1; seed <= starts; ++seed)); do
      in_background explore_world "$name" "$planner" "$seed"
    done
  done
done
finish_background
[ -n "$found" ] || fail "nothing is named ${only[*]}"

print_table exploration_table.py --plot "$programs/hv_replay/hv_plot_curves"
