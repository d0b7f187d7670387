#!/usr/bin/env bash
# Sets up and builds HV-LIOM, simulates a minute on a construction site with a PandarXT-32 and an
# IMU, runs the odometry over the recording and compares it with the truth. Pictures, error table
# and recording (0.75 GB) stay in demo/, or in the folder given as argument or in HV_DEMO_DIR.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${HV_BUILD_DIR:-$root/build}")
demo=$(realpath -m "${1:-${HV_DEMO_DIR:-$root/demo}}")
config=$root/config/hilti_2022.yaml
bag=$demo/recording/recording.bag

HV_BUILD_DIR=$build "$root/scripts/setup.sh"
bin=$build/devel/lib
begin=$SECONDS

step() { printf '\ndemo: %s\n' "$*"; }

mkdir -p "$demo"
free_kb=$(df --output=avail -k "$demo" | tail -n 1)
if [ "$free_kb" -lt 1000000 ] && [ ! -e "$bag" ]; then
  echo "demo: $demo has $((free_kb / 1024)) MB left, 1 GB is needed" >&2
  exit 1
fi

step "simulating a minute of walking over a construction site"
"$bin/hv_sim/hv_simulate" --world construction --trajectory walk --format hilti --duration 60 \
  --seed 1 --out "$demo/recording"

step "checking the recording"
"$bin/hv_replay/hv_check_bag" --bag "$bag" --config "$config"

step "odometry, loop closing and map"
"$bin/hv_replay/hv_slam" --bag "$bag" --config "$config" --threads "$(nproc)" --out "$demo/run"

step "comparing with the truth"
"$bin/hv_replay/hv_ape" --reference "$demo/recording/truth.tum" --estimate "$demo/run/odometry.tum" \
  --plot "$demo/error.png" | tee "$demo/error.txt"
cp "$demo/run/map.png" "$demo/run/trajectory.png" "$demo/"

step "finished after $((SECONDS - begin)) s; in $demo:"
cat <<END
  map.png          the map from above, colour by height, and the path
  trajectory.png   the path and its height
  error.png        the path against the truth
  error.txt        the table above
  run/             odometry.tum, trajectory.tum after loop closing, loops.csv, map/, timing.csv,
                   covariance.csv, summary.json, config.yaml
  recording/       the bag ($(du -sh "$demo/recording" | cut -f1)) and truth.tum; delete it at will
END
