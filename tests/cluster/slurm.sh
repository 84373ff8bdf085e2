#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: slurm.sh AIMS WORK_FOLDER
# Runs a sweep as an array job with a dependent merge on a Slurm of one node that lives on the
# loopback, in the work folder, for as long as the test: munged, slurmctld, slurmd, no systemd.
set -euo pipefail
tests="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
export PATH=$PATH:/usr/sbin

skip() {
  echo "SKIPPED: $1"
  exit 0
}
for program in munged slurmctld slurmd sbatch; do
  command -v $program >/dev/null || skip "$program is not installed (munge, slurmctld, slurmd, slurm-client)"
done

export AIMS=$1
work=$2
rm -rf "$work"
mkdir -p "$work"/{state,spool,sweep}
chmod 755 "$work"

# Sockets need short paths.
sockets=$(mktemp -d /tmp/aims-slurm-XXXXXX)
chmod 755 "$sockets"
pids=()
stop() {
  local pid
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
  for pid in "${pids[@]}"; do wait "$pid" 2>/dev/null || true; done
  rm -rf "$sockets"
}
trap stop EXIT

# wait_for SECONDS COMMAND...: until the command succeeds.
wait_for() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    if [ $SECONDS -ge $end ]; then
      echo "FAILED: still not: $*" >&2
      tail -n 20 "$work"/*.log >&2
      return 1
    fi
    sleep 0.2
  done
}

free_port() {
  local port
  for port in $(shuf -i 20000-50000 -n 50); do
    (: >"/dev/tcp/127.0.0.1/$port") 2>/dev/null || { echo "$port"; return; }
  done
  return 1
}

head -c 1024 /dev/urandom >"$sockets/key"
chmod 400 "$sockets/key"
munged --foreground --force --socket="$sockets/munge.socket" --key-file="$sockets/key" \
  --pid-file="$sockets/munged.pid" --seed-file="$sockets/seed" --log-file="$work/munged.log" \
  2>"$work/munged.err" &
pids+=($!)
wait_for 20 test -S "$sockets/munge.socket"

me=$(id -un) node=$(hostname -s)
memory=$(awk '/MemTotal/ {print int($2 / 1024 * 0.9)}' /proc/meminfo)
cat >"$work/slurm.conf" <<CONF
ClusterName=aims
SlurmctldHost=$node(127.0.0.1)
SlurmUser=$me
SlurmdUser=$me
AuthType=auth/munge
AuthInfo=socket=$sockets/munge.socket
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=sched_min_interval=100000,batch_sched_delay=0
MpiDefault=none
MailProg=/bin/true
ReturnToService=2
NodeName=$node NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$memory State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$work/slurm.conf
slurmctld -D -c -f "$SLURM_CONF" >"$work/slurmctld.log" 2>&1 &
pids+=($!)
slurmd -D -c -f "$SLURM_CONF" >"$work/slurmd.log" 2>&1 &
pids+=($!)
idle() { [ "$(sinfo -h -o %T 2>/dev/null)" = idle ]; }
wait_for 60 idle

cd "$work/sweep"
cp "$tests"/{plan,sequence}.yaml .
SEQUENCES=2 "$tests/../../scripts/slurm/submit.sh" plan.yaml out 3 --mem=400 -- --cache "$work/sequences" --quiet
empty() { [ -z "$(squeue -h 2>/dev/null)" ] && [ -e out.log/merge.txt ]; }
wait_for 120 empty
tail -n +1 out.log/*.txt
grep -q '^6 of 6 jobs done' out.log/merge.txt
[ "$(ls out/jobs/*.json | wc -l)" -eq 6 ]
[ -s out/sweep.sqlite ]
