#!/usr/bin/env bash
# Whether memory stays constant: the whole robot in simulation explores a building and drives around
# in it for hours while it maps, then with the saved map. Prints one table.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/bench_common.sh"

world=$root/test/small_building.yaml
hours=2
share=0.25
rate=1
seed=1
people=

usage() {
  cat <<USAGE
usage: soak.sh [options]
  --out DIR            results (default: build/bench/soak_results), which are made anew
  --world WORLD        as world:= of hv_liom.launch (default: test/small_building.yaml)
  --hours H            simulated, of each of the two phases (default: $hours)
  --people             people walk around
  --point-share S      share of LiDAR columns fired (default: $share)
  --rate R             simulated seconds per second (default: $rate)
  --seed N             (default: $seed)
  --table-only         no run: the table of the results that are there
  --markdown FILE      also write the table to FILE
memory.csv and memory.png show the memory of each node over time.
USAGE
}

out=$build/bench/soak_results
values+=([--people]=0)
own_option() {
  case $1 in
    --world) world=$2 ;;
    --hours) hours=$2 ;;
    --people) people=--people ;;
    --point-share) share=$2 ;;
    --rate) rate=$2 ;;
    --seed) seed=$2 ;;
    *) return 1 ;;
  esac
}
parse_options "$@"
require hv_replay/hv_plot_curves hv_sim/hv_sim_node hv_lio/hv_lio_node \
  hv_loop_btc/hv_loop_btc_node hv_relocalize_ndt/hv_relocalize_ndt_node \
  hv_navigation/hv_navigation_node hv_explore_sac/hv_explore_sac_node

if [ -n "$run" ]; then
  rm -rf "$out"
  mkdir -p "$out"
  set +u
  # shellcheck disable=SC1091
  source "$build/devel/setup.bash"
  set -u
  say "two phases of $hours h, simulated"
  /usr/bin/python3 -B "$root/scripts/robot_soak.py" --world "$world" --seed "$seed" \
    --point-share "$share" --rate "$rate" --hours "$hours" ${people:+"$people"} --out "$out" \
    >"$out/log.txt" 2>&1 || fail "robot_soak.py failed: $(tail -n 1 "$out/log.txt")"
fi
print_table soak_table.py --plot "$programs/hv_replay/hv_plot_curves"
