# What the benchmark scripts share; they source it. Each defines usage, the folders data and out, and
# own_option where it has options of its own.
# shellcheck shell=bash disable=SC2034

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${HV_BUILD_DIR:-$root/build}
programs=$build/devel/lib
bench=$(basename "$0" .sh)

only=()   # names that are wanted; empty: all
run=yes   # empty: only the table
listing=  # not empty: only the names
fresh=    # not empty: measure keeps no results that are there
table=()  # arguments of the script that prints it
processes=1  # in the background at once
started=()   # their numbers
declare -A values=([--table-only]=0 [--list]=0 [--peer]=2)  # of options; others have one

say() { echo "$bench: $*" >&2; }

fail() {
  say "$1"
  exit 1
}

# own_option OPTION VALUE...: takes an option that only one script has; fails when it is unknown
own_option() { return 1; }

# parse_options ARGUMENT...
parse_options() {
  local needs
  while (($# > 0)); do
    case $1 in -h | --help) usage; exit 0 ;; esac
    needs=${values[$1]:-1}
    (($# > needs)) || fail "$1 needs $needs argument(s) (--help lists the options)"
    case $1 in
      --data) [ -v data ] || fail "there is nothing to generate, so no --data"; data=$2 ;;
      --out) out=$2 ;;
      --only) only+=("$2") ;;
      --peer) table+=(--peer "$2" "$3") ;;
      --table-only) run= ;;
      --list) listing=yes ;;
      --markdown) table+=(--markdown "$2") ;;
      *) own_option "$@" || fail "unknown option $1 (--help lists the options)" ;;
    esac
    shift $((needs + 1))
  done
}

# list_if_asked ENTRY...: prints the names, the first word of each, and ends
list_if_asked() {
  [ -z "$listing" ] && return
  printf '%s\n' "${@%% *}"
  exit 0
}

# require PROGRAM...: paths below the folder of the programs
require() {
  local program
  for program in "$@"; do
    [ -x "$programs/$program" ] || fail "$programs/$program is missing: run scripts/setup.sh first"
  done
}

# wanted NAME
wanted() {
  ((${#only[@]} == 0)) && return 0
  local name
  for name in "${only[@]}"; do [ "$name" = "$1" ] && return 0; done
  return 1
}

# in_background COMMAND...: as soon as there is room for it. In a process group of its own, so that
# it can be stopped, with all that it has started, when this script ends by Ctrl-C
in_background() {
  while (($(jobs -rp | wc -l) >= processes)); do wait -n || true; done
  set -m
  "$@" &
  set +m
  started+=("$!")
}

stop_background() {
  local group
  for group in $(jobs -rp); do kill -- "-$group" 2>/dev/null || true; done
}
trap stop_background EXIT

# finish_background: waits for all; fails when one has failed
finish_background() {
  local number failed=
  for number in "${started[@]}"; do wait "$number" || failed=yes; done
  [ -z "$failed" ] || fail "see the messages above"
}

# of_programs ARGUMENTS: with what tells these programs from others
of_programs() { echo "$1 by $(cat "$build"/devel/lib/libhv_*.so | sha256sum)"; }

# kept FOLDER ARGUMENTS: whether FOLDER holds the results of these arguments and programs
kept() { [ -z "$fresh" ] && [ "$(cat "$1/arguments.txt" 2>/dev/null)" = "$(of_programs "$2")" ]; }

# keep FOLDER ARGUMENTS: once the results are complete
keep() { of_programs "$2" >"$1/arguments.txt"; }

# measure THREADS FOLDER PROGRAM [ARGUMENT...]: unless FOLDER holds the results already
measure() {
  local threads=$1 folder=$2 program=$3 arguments="${*:3}"
  [[ $arguments != *--weights* ]] || arguments+=" of $(sha256sum <"${weights:?}")"
  ! kept "$folder" "$arguments" || return 0
  say "${folder#"$out/"}"
  rm -rf "$folder"
  mkdir -p "$folder"
  "$programs/hv_replay/$program" "${@:4}" --threads "$threads" --json >"$folder/run.json" \
    2>"$folder/log.txt" || fail "$program failed: $(tail -n 1 "$folder/log.txt")"
  keep "$folder" "$arguments"
}

# print_table SCRIPT [ARGUMENT...]: with what has been gathered in `table`
print_table() {
  exec /usr/bin/python3 -B "$root/scripts/$1" --results "$out" ${data:+--data "$data"} "${@:2}" \
    "${table[@]}"
}
