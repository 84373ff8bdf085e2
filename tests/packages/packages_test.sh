#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# packages_test.sh BUILD SOURCE WORK: makes the Debian packages of what BUILD has built, looks into
# them, and installs them into a root of their own.
set -euo pipefail
build=$1 source=$2 work=$3

fail() {
  echo "FAILED: $*" >&2
  exit 1
}
for tool in cpack dpkg-deb dpkg-shlibdeps file; do
  command -v "$tool" >/dev/null || { echo "SKIPPED: no $tool here"; exit 0; }
done

rm -rf "$work"
mkdir -p "$work"
(cd "$build" && cpack -G DEB -B "$work") >"$work/cpack.log" 2>&1 || { cat "$work/cpack.log"; fail "cpack"; }
program=$(echo "$work"/aims_*.deb)
libraries=$(echo "$work"/libaims-dev_*.deb)
node=()  # only where ROS is installed
if [ -e "$build/live/aims_node" ]; then node=("$work"/aims-node_*.deb); fi
live=()  # only where CycloneDDS is installed
if [ -e "$build/aims_live" ] && [ -e "$build/aims_play" ]; then live=("$work"/aims-live_*.deb); fi
python=()  # only where Python's headers are
if [ -e "$build/python/aims/py.typed" ]; then python=("$work"/python3-aims_*.deb); fi
simulation=()
if [ ${#python[@]} -gt 0 ]; then simulation=("$work"/python3-aims-sim_*.deb); fi
all=("$program" "$libraries" "${live[@]}" "${node[@]}" "${python[@]}" "${simulation[@]}")

# contents PACKAGE FILE...: the package holds each file.
contents() {
  local package=$1 file
  shift
  dpkg-deb -c "$package" >"$work/contents"
  for file in "$@"; do
    grep -q " \./usr/$file$" "$work/contents" || fail "$package holds no /usr/$file"
  done
}
contents "$program" bin/aims share/aims/scenarios/paper/corridor.yaml \
  share/aims/scenarios/stress/ramp_06.yaml share/aims/slurm/submit.sh share/doc/aims/copyright
grep -qE '\.hpp$|\.a$|\.cmake$' "$work/contents" && fail "what others build with is in $program"
contents "$libraries" include/aims/core/lie.hpp include/aims/estimator/registry.hpp \
  include/aims/bench/metrics/scores.hpp include/aims/recordings/stream/recording_reader.hpp \
  lib/libaims_core.a lib/libaims_files.a lib/libaims_estimator.a lib/libaims_metrics.a \
  lib/libaims_recordings.a \
  lib/cmake/aims/aimsConfig.cmake lib/cmake/aims/aimsConfigVersion.cmake \
  lib/cmake/aims/aimsTargets.cmake share/doc/libaims-dev/copyright
if [ ${#node[@]} -gt 0 ]; then
  contents "${node[0]}" bin/aims_node share/doc/aims-node/copyright
  grep -qE '\.hpp$|\.a$|\.yaml$' "$work/contents" && fail "what a robot does not need is in ${node[0]}"
fi
if [ ${#live[@]} -gt 0 ]; then
  contents "${live[0]}" bin/aims_live bin/aims_play bin/aims_watch share/doc/aims-live/copyright \
    share/doc/aims-live/aims-live.service share/aims-live/robots/go2.yaml
  grep -qE '\.hpp$|\.a$|scenarios' "$work/contents" && fail "what a robot does not need is in ${live[0]}"
fi
if [ ${#python[@]} -gt 0 ]; then
  modules=lib/python3/dist-packages/aims
  contents "${python[0]}" $modules/__init__.py $modules/py.typed share/doc/python3-aims/copyright \
    "$modules/_core\..*\.so"
  grep -qE '\.hpp$|\.a$|\.yaml$|__pycache__|_sim\..*so' "$work/contents" &&
    fail "what a program does not import is in ${python[0]}"
  contents "${simulation[0]}" "$modules/_sim\..*\.so" share/doc/python3-aims-sim/copyright
fi
for package in "${all[@]}"; do
  dpkg-deb -c "$package" | awk '$2 != "root/root" || $6 !~ "^./(usr/.*)?$"' | grep . &&
    fail "$package: the files above are not root's, or not under /usr"
done

# depends PACKAGE: one name a line.
depends() { dpkg-deb -f "$1" Depends | tr ',' '\n' | sed 's/^ *//; s/ .*//'; }
for name in libc6 libstdc++6 libcairo2 libfmt9 libyaml-cpp0.7 libsqlite3-0 fonts-dejavu-core; do
  depends "$program" | grep -xF "$name" >"$work/found" || fail "$program does not depend on $name"
done
for name in libeigen3-dev libfmt-dev libexpected-dev libyaml-cpp-dev libboost-dev liblz4-dev \
  libbz2-dev zlib1g-dev; do
  depends "$libraries" | grep -xF "$name" >"$work/found" || fail "$libraries does not depend on $name"
done
for package in "$libraries" "${live[@]}" "${node[@]}" "${python[@]}"; do
  depends "$package" | grep -iE 'mujoco|embree|pagmo|sqlite|cairo|osmesa' &&
    fail "$package depends on what only the simulation and the bench need"
done
if [ ${#python[@]} -gt 0 ]; then
  for name in libc6 libfmt9 libyaml-cpp0.7 python3 python3-numpy; do
    depends "${python[0]}" | grep -xF "$name" >"$work/found" ||
      fail "${python[0]} does not depend on $name"
  done
fi
if [ ${#live[@]} -gt 0 ]; then
  depends "${live[0]}" | grep -xF libddsc0debian >"$work/found" || fail "${live[0]} does not depend on CycloneDDS"
fi
if [ ${#node[@]} -gt 0 ]; then
  for name in libc6 libfmt9 libyaml-cpp0.7; do
    depends "${node[0]}" | grep -xF "$name" >"$work/found" || fail "${node[0]} does not depend on $name"
  done
  depends "${node[0]}" | grep -q '^libroscpp' || fail "${node[0]} does not depend on roscpp"
fi
if [ ${#simulation[@]} -gt 0 ]; then
  for name in python3-aims aims libmujoco2.2.2; do
    depends "${simulation[0]}" | grep -xF "$name" >"$work/found" ||
      fail "${simulation[0]} does not depend on $name"
  done
fi
if command -v apt-cache >/dev/null; then
  names=$(for package in "${all[@]}"; do depends "$package"; done | sort -u)
  # shellcheck disable=SC2086
  apt-cache show --no-all-versions $names >"$work/known" 2>/dev/null || true
  for name in $names; do
    case $name in aims | python3-aims) continue ;; esac  # made here
    grep -qxF "Package: $name" "$work/known" || fail "no Debian package $name"
  done
else
  echo "no apt-cache here: names of the dependencies are not looked up"
fi

# Installed elsewhere; the dependencies are not, so that they are forced.
root=$work/root
if [ "$(id -u)" -eq 0 ]; then
  mkdir -p "$root/var/lib/dpkg/"{info,updates}
  touch "$root/var/lib/dpkg/"{status,available}
  dpkg --root="$root" --force-depends --force-script-chrootless -i "${all[@]}" \
    >"$work/dpkg.log" 2>&1 || { cat "$work/dpkg.log"; fail "dpkg -i"; }
  [ "$(dpkg-query --admindir="$root/var/lib/dpkg" -W -f '${Status}' libaims-dev)" = \
    "install ok installed" ] || fail "libaims-dev is not installed"
else
  for package in "${all[@]}"; do dpkg-deb -x "$package" "$root"; done
fi
cd /
if [ ${#python[@]} -gt 0 ]; then
  # Estimates over recordings where nothing is installed but the package and its dependencies.
  printf 'scene: {corridor: {length: 10}}\nlidar: {columns: 450}\nroute: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 1, y: 0}]}\n' >"$work/walk.yaml"
  for kind in bag mcap; do
    "$root/usr/bin/aims" simulate "$work/walk.yaml" --quiet -o "$work/walk.$kind" >"$work/simulate.log"
  done
  cat >"$work/estimate.py" <<'END'
import os, sys
import aims
os.chdir(sys.path[0])
scores = [aims.estimate(f"walk.{kind}", {"aims_d": "aims_d", "mine": "python:own_estimators.Legs"}).scores
          for kind in ("mcap", "bag")]
assert scores[0]["aims_d"]["ate_m"] < 0.2, scores
assert scores[0]["mine"]["ate_m"] < 0.5, scores
assert [each["aims_d"]["ate_m"] for each in scores] == [scores[0]["aims_d"]["ate_m"]] * 2, scores
END
  files=("$work"/walk.{bag,mcap} "$work/estimate.py" "$source/tests/python/own_estimators.py")
  as_root=()
  if [ "$(id -u)" -ne 0 ]; then as_root=(unshare -r); fi
  clean=$work/clean
  if "${as_root[@]}" /usr/sbin/chroot / /bin/true 2>"$work/chroot.log"; then
    "${as_root[@]}" /usr/bin/python3 "$source/tests/packages/clean_root.py" "$clean" "${python[0]}" >"$work/clean.log"
  else
    echo "no clean root: chroot is not allowed here" >"$work/clean.log"
  fi
  cat "$work/clean.log"
  if grep -q '^no clean root' "$work/clean.log"; then
    echo "estimates run among the packages of this machine"
    mkdir "$work/here"
    cp "${files[@]}" "$work/here"
    env -i PATH=/usr/bin:/bin PYTHONPATH="$root/usr/lib/python3/dist-packages" PYTHONDONTWRITEBYTECODE=1 \
      /usr/bin/python3 "$work/here/estimate.py" || fail "the installed Python package does not estimate"
  else
    find "$clean" -iname '*mujoco*' -o -iname '*embree*' | grep . && fail "the clean root has a simulator"
    cp "${files[@]}" "$clean/tmp"
    env -i PATH=/usr/bin:/bin PYTHONDONTWRITEBYTECODE=1 "${as_root[@]}" /usr/sbin/chroot "$clean" \
      /usr/bin/python3 /tmp/estimate.py || fail "python3-aims with its dependencies alone does not estimate"
  fi
fi
version=$("$root/usr/bin/aims" --version)
[ "$version" = "aims $(dpkg-deb -f "$program" Version)" ] || fail "it says '$version'"
"$root/usr/bin/aims" list >"$work/list"
grep -qF "$root/usr/share/aims/scenarios" "$work/list" ||
  fail "the installed program does not find its scenarios"
grep -rIlF -e "$source" -e "$build" "$root/usr" && fail "the files above name a folder of this machine"
echo "packages are sound: $(find "$work" -maxdepth 1 -name '*.deb' -printf '%f %k kB  ')"
