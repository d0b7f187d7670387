#!/usr/bin/env bash
# Makes the tables of docs/benchmarks.md anew, with all benchmark scripts; alone, or as ranks of
# mpirun that share the work.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${HV_BUILD_DIR:-$root/build}
out=$build/bench/report
parts=(odometry loop relocalization navigation exploration robot)
only=()
declare -A options=()  # of the scripts
rank=${OMPI_COMM_WORLD_RANK:-0}
ranks=${OMPI_COMM_WORLD_SIZE:-1}

usage() {
  cat <<USAGE
usage: reproduce.sh [options]
  --out DIR            tables: DIR/<part>.md and all of them in DIR/benchmarks.md
                       (default: build/bench/report)
  --with PART OPTIONS  options of scripts/bench_PART.sh, as one argument; may be repeated
  --only PART          ${parts[*]} or recordings; may be repeated
Real recordings are measured where they are named: --with recordings '--hilti /data/hilti --nclt
/data/nclt'; dungeons and floor plans the same way: --with exploration '--dungeons complex FILE'.
Results that are there are kept where the scripts keep them. Under mpirun, with folders that all
machines share, each rank takes a part of the sequences and worlds:
  mpirun -n 4 scripts/reproduce.sh
USAGE
}

say() { echo "reproduce${OMPI_COMM_WORLD_RANK:+ (rank $rank)}: $*" >&2; }

fail() {
  say "$1"
  exit 1
}

while (($# > 0)); do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --out) out=${2:?--out needs a folder}; shift ;;
    --only) only+=("${2:?--only needs a part}"); shift ;;
    --with)
      (($# > 2)) || fail "--with needs a part and its options"
      options[$2]="${options[$2]:-} $3"
      shift 2
      ;;
    *) fail "unknown option $1 (--help lists the options)" ;;
  esac
  shift
done
[ -z "${options[recordings]:-}" ] || parts+=(recordings)
for part in "${only[@]}" "${!options[@]}"; do
  [[ " ${parts[*]} " == *" $part "* ]] || fail "no part is named $part: ${parts[*]}"
done
((${#only[@]} == 0)) || parts=("${only[@]}")

# bench PART [OPTION...]
bench() {
  local of_part
  read -ra of_part <<<"${options[$1]:-}"
  "$root/scripts/bench_$1.sh" "${of_part[@]}" "${@:2}"
}

marks=$out/marks/$(tr -c '[:alnum:]\n' _ <<<"${PMIX_NAMESPACE:-$$}")  # of this run
mkdir -p "$marks"
jobs=()  # part and name
for part in "${parts[@]}"; do
  names=$(bench "$part" --list) || exit 1
  for name in $names; do jobs+=("$part $name"); done
done

for ((job = rank; job < ${#jobs[@]}; job += ranks)); do
  read -r part name <<<"${jobs[job]}"
  say "$((job + 1)) of ${#jobs[@]}: $part, $name"
  state="done"
  bench "$part" --only "$name" >"$marks/$job.log" 2>&1 || state=failed
  mv "$marks/$job.log" "$marks/$job.$state"
done
((rank == 0)) || exit 0

failed=()
for job in "${!jobs[@]}"; do
  until [ -f "$marks/$job.done" ] || [ -f "$marks/$job.failed" ]; do sleep 1; done
  [ ! -f "$marks/$job.failed" ] || failed+=("${jobs[job]}: $(tail -n 1 "$marks/$job.failed")")
done
for part in "${parts[@]}"; do
  bench "$part" --table-only --markdown "$out/$part.md" >/dev/null ||
    failed+=("$part: no table")
done
for part in "${parts[@]}"; do
  [ ! -f "$out/$part.md" ] || printf '## %s\n\n%s\n\n' "${part^}" "$(cat "$out/$part.md")"
done >"$out/benchmarks.md"
say "tables in $out/benchmarks.md"
for failure in "${failed[@]}"; do say "failed: $failure"; done
((${#failed[@]} == 0))
