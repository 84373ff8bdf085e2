#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Scores estimators on recordings of tests/independent and prints one table.
set -euo pipefail

usage() {
  cat <<EOF
usage: bench/independent.sh [OPTION VALUE]...
  --bin FOLDER         of aims and independent_recordings (build/release)
  --out FOLDER         of recordings, made when absent, and results (out/independent)
  --cells A,B          (doors_30,recess5_30,plain_30,plain_open_30,garage_30)
  --rates A,B          of the IMU in Hz (50,200)
  --seeds A,B          (1)
  --estimators A,B     as for aims estimate (aims_d,tfs_plus,lio,leg)
  --set KEY=VALUE      as for aims estimate; repeatable
  --calibration FILE   as for aims estimate
  --length METRES      of the route, one way (that of the cell)
  --rings NAME         uneven, uniform or 32 (uneven)
  --legs-scale FACTOR  reported over true leg velocity (1.045)
  --relief METRES      deviation of the walls from planes (0)
  --jobs N             recordings at a time (2)
  --keep yes|no        recordings made by this call; a full one takes 1.2 GB (yes)
EOF
}

bin=build/release out=out/independent cells=doors_30,recess5_30,plain_30,plain_open_30,garage_30
rates=50,200 seeds=1 estimators=aims_d,tfs_plus,lio,leg length=0 rings=uneven legs_scale=1.045 relief=0 jobs=2 keep=yes
settings=()
while [ $# -gt 0 ]; do
  case $1 in
    --help|-h) usage; exit 0 ;;
    --bin|--out|--cells|--rates|--seeds|--estimators|--length|--rings|--legs-scale|--relief|--jobs|--keep|--set|--calibration) ;;
    *) echo "independent.sh: unknown option '$1'" >&2; usage >&2; exit 2 ;;
  esac
  [ $# -ge 2 ] || { echo "independent.sh: $1 needs a value" >&2; exit 2; }
  case $1 in
    --set|--calibration) settings+=("$1" "$2") ;;
    --legs-scale) legs_scale=$2 ;;
    *) declare "${1#--}=$2" ;;
  esac
  shift 2
done

# Makes the recording CELL RATE SEED unless it is there, and scores the estimators on it.
# shellcheck disable=SC2317  # called by xargs
score() {
  local name=$1-$2-$3 bag made=no code=0
  [ "$length" = 0 ] || name+=-${length}m
  [ "$rings" = uneven ] || name+=-$rings
  [ "$legs_scale" = 1.045 ] || name+=-legs_$legs_scale
  [ "$relief" = 0 ] || name+=-relief_$relief
  bag=$out/recordings/$name.bag
  if [ ! -e "$bag" ]; then
    "$bin/independent_recordings" "$1" --imu-rate "$2" --seed "$3" --length "$length" \
      --rings "$rings" --legs-scale "$legs_scale" --relief "$relief" --lz4 -o "$bag" || return 1
    made=yes
  fi
  mkdir -p "$out/results"
  "$bin/aims" estimate "$bag" --estimators "$estimators" "${@:4}" -j 1 --no-pictures --no-page -q \
    --overwrite -o "$out/results/$name" >"$out/results/$name.log" 2>&1 || code=$?
  [ "$made $keep" != "yes no" ] || rm "$bag"
  # Exit code 4: an estimate was invalid at some time, which the table shows.
  [ "$code" -eq 0 ] || [ "$code" -eq 4 ] || { cat "$out/results/$name.log" >&2; return 1; }
  echo "$name" >&3
}
export -f score
export bin out length rings legs_scale relief estimators keep

# Rows of one recording: its name and its scores.csv.
rows() {
  awk -F, -v name="$1" '
    NR > 1 { if (!($2 in seen)) { seen[$2] = 1; order[++n] = $2 } value[$2, $3] = $4 }
    function shown(estimator, key, digits) {
      return value[estimator, key] == "" ? "-" : sprintf("%.*f", digits, value[estimator, key])
    }
    END {
      for (i = 1; i <= n; ++i) {
        e = order[i]
        printf "%-26s %-20s %8s %8s %8s %8s %8s %9s\n", name, e,
          shown(e, "m_list_percent.start-far", 2), shown(e, "m_list_percent.far-end", 2),
          shown(e, "m_end_m", 3), shown(e, "ate_m", 3), shown(e, "max_error_z_m", 3),
          value[e, "success"] == 1 ? "yes" : "diverged"
      }
    }' "$out/results/$1/scores.csv"
}

mkdir -p "$out/recordings"
done_list=$(mktemp)
trap 'rm -f "$done_list"' EXIT
status=0
# shellcheck disable=SC2016  # expands in the shell that xargs starts
for cell in ${cells//,/ }; do
  for rate in ${rates//,/ }; do
    for seed in ${seeds//,/ }; do
      printf '%s\0' "$cell $rate $seed"
    done
  done
done | xargs -0 -P "$jobs" -I{} bash -c 'set -- $0 "$@"; score "$@"' {} "${settings[@]}" \
  3>>"$done_list" || status=1

printf '%-26s %-20s %8s %8s %8s %8s %8s %9s\n' recording estimator 'out %' 'back %' 'M_end m' \
  'ATE m' 'max|z| m' success
for cell in ${cells//,/ }; do
  for rate in ${rates//,/ }; do
    for seed in ${seeds//,/ }; do
      { grep -E "^$cell-$rate-$seed(-|$)" "$done_list" || true; } | while read -r name; do
        rows "$name"
      done
    done
  done
done
exit "$status"
