#!/bin/bash
# A study of 40 runs by a Slurm of two nodes on this machine, one of which is killed on the way: the table is that of a study
# made here. Each slurmd has its own host name and network. Needs root and the packages slurmctld, slurmd, slurm-client,
# munge; where it cannot start it says why and passes. Usage: tests/slurm/two_nodes.sh build/release
set -u
talus=$(realpath "$1")/app/talus fixtures=$(realpath "$(dirname "$0")/../fixtures")
skip() { echo "slurm: skipped, $1"; exit 0; }
[ "$(id -u)" = 0 ] || skip "not root"
for program in slurmctld slurmd sbatch squeue munged ip unshare; do command -v $program >/dev/null || skip "$program is not installed"; done

root=$(mktemp -d /tmp/talus_slurm.XXXXXX)
declare -a started=()
cleanup() {
  for process in "${started[@]}"; do kill -9 "$process" 2>/dev/null; done
  pkill -9 -f "$root/slurm.conf" 2>/dev/null
  for n in 1 2; do ip netns pids talus_n$n 2>/dev/null | xargs -r kill -9 2>/dev/null; ip netns del talus_n$n 2>/dev/null; done
  ip link del talus_bridge 2>/dev/null
  rm -rf "$root"
}
trap cleanup EXIT

# the network: a bridge, a node at each end
ip link add talus_bridge type bridge 2>"$root/log" || skip "no network bridge: $(cat "$root/log")"
ip addr add 10.177.0.1/24 dev talus_bridge && ip link set talus_bridge up
for n in 1 2; do
  ip netns add talus_n$n 2>"$root/log" || skip "no network namespaces: $(cat "$root/log")"
  ip link add talus_v$n type veth peer name eth0 netns talus_n$n || skip "no veth"
  ip link set talus_v$n master talus_bridge up
  ip netns exec talus_n$n sh -c "ip link set lo up; ip addr add 10.177.0.1$n/24 dev eth0; ip link set eth0 up"
done

dd if=/dev/urandom of="$root/munge.key" bs=1 count=1024 2>/dev/null
chmod 400 "$root/munge.key"
mkdir -p "$root/munge" "$root/state" "$root/spool/n1" "$root/spool/n2"
chmod 755 "$root" "$root/munge"
munged --force --key-file="$root/munge.key" --socket="$root/munge/socket" --pid-file="$root/munge/pid" --log-file="$root/munge/log" \
  --seed-file="$root/munge/seed" 2>"$root/log" || skip "munged does not start: $(cat "$root/log")"
started+=("$(cat "$root/munge/pid")")

cat >"$root/slurm.conf" <<CONF
ClusterName=talus
SlurmctldHost=$(hostname -s)(10.177.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$root/munge/socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
SlurmctldPidFile=$root/slurmctld.pid
SlurmdPidFile=$root/slurmd_%n.pid
SlurmctldPort=26817
SlurmdPort=26818
StateSaveLocation=$root/state
SlurmdSpoolDir=$root/spool/%n
SlurmctldLogFile=$root/slurmctld.log
SlurmdLogFile=$root/slurmd_%n.log
SlurmdTimeout=10
ReturnToService=2
MaxArraySize=11
SlurmdParameters=config_overrides
NodeName=n1 NodeAddr=10.177.0.11 NodeHostname=n1 CPUs=2 State=UNKNOWN
NodeName=n2 NodeAddr=10.177.0.12 NodeHostname=n2 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
CONF
# slurmd wants to know of control groups, and uses none here
printf 'CgroupPlugin=cgroup/v1\nCgroupMountpoint=%s/cgroup\nConstrainCores=no\nConstrainRAMSpace=no\n' "$root" >"$root/cgroup.conf"
mkdir -p "$root/cgroup"
export SLURM_CONF=$root/slurm.conf
slurmctld -D -f "$root/slurm.conf" >"$root/ctld.out" 2>&1 & started+=($!)
for n in 1 2; do
  ip netns exec talus_n$n unshare --uts sh -c "hostname n$n; exec slurmd -D -N n$n -f $root/slurm.conf" >"$root/n$n.out" 2>&1 & started+=($!)
done
up=""
for _ in $(seq 30); do
  up=$(sinfo -h -N -o '%N %t' 2>/dev/null | grep -c idle)
  [ "$up" = 2 ] && break
  sleep 1
done
[ "$up" -ge 1 ] || { cat "$root"/ctld.out "$root"/n*.out "$root"/slurm*.log | tail -20; skip "no node comes up"; }
echo "slurm: $up nodes up"

# 40 small runs, each of about a second
mkdir "$root/study" && cd "$root/study"
cp "$fixtures/sliding_stone.toml" model.toml
cat >study.toml <<'STUDY'
talus_study = 1
model = "model.toml"
set = ["stage.go.time_step=0.01 ms", "output.history_interval=0.1 s", "output.steps_interval=0.1 s"]
keep = "answers"
[answers]
way = "stone.displacement_x.greatest"
[[vary]]
key = "variables.phi"
range = { from = "10 deg", to = "40 deg", count = 10 }
[[vary]]
key = "variables.push"
values = [2, 4, 8, 16]
STUDY
numbers() { sed '1d' "$1/results.csv" | cut -d, -f1-5; }  # without time, host and message
"$talus" study study.toml -q -o here || exit 1
"$talus" study study.toml -o cluster --on slurm || exit 1
killed=no
for _ in $(seq 600); do
  left=$(squeue -h | wc -l)
  done_runs=$(find cluster/runs -name run.json | wc -l)
  if [ $killed = no ] && [ "$up" = 2 ] && [ "$done_runs" -ge 6 ]; then
    echo "slurm: node n2 dies with $done_runs runs done, at work: $(ls cluster/work | grep -c '\.n2\.')"
    ip netns pids talus_n2 | xargs -r kill -9
    killed=yes
  fi
  [ "$left" = 0 ] && break
  sleep 1
done
scontrol show node n2 | grep -o 'State=[A-Z+*_]*'
"$talus" study gather cluster || exit 1
if numbers here | cmp - <(numbers cluster); then
  echo "slurm: 40 of 40 runs as those made here; hosts: $(sed 1d cluster/results.csv | awk -F, '{ print $(NF-1) }' | sort | uniq -c | xargs)"
else
  echo "slurm: the tables differ"; tail -30 "$root/slurmctld.log"; exit 1
fi
[ $killed = yes ] || echo "slurm: no node was killed (only $up came up)"
