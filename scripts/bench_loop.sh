#!/usr/bin/env bash
# Measures loop closing on generated sequences with revisits and prints one table.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/bench_common.sh"

# name, world, trajectory, seconds left out, seconds, distance of the places of a loop [m]; what is
# left out on the campus is a stretch that the route does not come back to
sequences=(
  "corridor_robot corridor robot 0 400 5"
  "office_walk office walk 0 300 5"
  "construction_walk construction walk 0 300 10"
  "campus_segway campus segway 45 325 10"
)
drift=(0.005 0.2)  # share of the distance, degrees of heading a metre

usage() {
  cat <<USAGE
usage: bench_loop.sh [options]
  --data DIR       recordings, generated where missing (default: build/bench/loop_data; 16 GB)
  --out DIR        results (default: build/bench/loop_results)
  --peer NAME DIR  places that another program found, DIR/<sequence>.csv; may be repeated. Columns:
                   query_stamp,match_stamp,score,accepted,x,y,z,qx,qy,qz,qw,extract_ms,query_ms
                   One row a submap (stamps [s] of its keyframe and of the match's) with the best
                   match, however bad: pose of the query in the frame of the match [m], accepted 1
                   where the program reports a loop by its defaults; empty where there is no match
  --only NAME      this sequence only; may be repeated
  --list           only the names
  --table-only     no runs: the table of the results that are there
  --markdown FILE  also write the table to FILE
The programs are those of scripts/setup.sh.
USAGE
}

data=$build/bench/loop_data
out=$build/bench/loop_results
parse_options "$@"
list_if_asked "${sequences[@]}"
require hv_sim/hv_simulate hv_replay/hv_slam hv_replay/hv_ape

# generate NAME WORLD TRAJECTORY SKIP SECONDS
generate() {
  [ -f "$data/$1/recording.bag" ] && [ -f "$data/$1/truth.tum" ] && return
  say "generating $1 ($5 s)"
  rm -rf "$data/$1.part"
  "$programs/hv_sim/hv_simulate" --world "$2" --trajectory "$3" --skip "$4" --duration "$5" --seed 2 \
    --out "$data/$1.part" >/dev/null
  rm -rf "${data:?}/$1"
  mv "$data/$1.part" "$data/$1"
}

# slam NAME VARIANT [OPTION...]
slam() {
  local result=$out/$1/$2 bag=$data/$1/recording.bag
  say "$1, $2"
  rm -rf "$result"
  mkdir -p "$result"
  shift 2
  "$programs/hv_replay/hv_slam" --config "$root/config/hilti_2022.yaml" --bag "$bag" \
    --out "$result" --no-pictures --json "$@" >"$result/run.json" 2>"$result/log.txt" ||
    fail "hv_slam failed on $bag: $(tail -n 1 "$result/log.txt")"
}

mkdir -p "$data" "$out"
found=
for sequence in "${sequences[@]}"; do
  read -r name world trajectory skip seconds distance <<<"$sequence"
  wanted "$name" || continue
  found=yes
  table+=(--sequence "$name" "$distance")
  [ -n "$run" ] || continue
  generate "$name" "$world" "$trajectory" "$skip" "$seconds"
  slam "$name" as_is
  slam "$name" drift --inject-drift "${drift[@]}"
done
[ -n "$found" ] || fail "no sequence is named ${only[*]}"

print_table loop_table.py --ape "$programs/hv_replay/hv_ape"
