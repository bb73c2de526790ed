#!/usr/bin/env bash
# Starts Slurm as a cluster of one node on this machine's loopback: no systemd, no cgroups, no accounting. As root, on a
# machine or container of its own: it writes /etc/slurm/slurm.conf and the key of munge. Stop it by the pids in
# /run/slurmctld.pid, /run/slurmd.pid and /run/munge/munged.pid.
set -euo pipefail
host=$(hostname -s)
for tool in munged slurmctld slurmd; do
  [ -x "/usr/sbin/$tool" ] || { echo "$tool is missing: apt-get install slurm-wlm munge" >&2; exit 1; }
done
mkdir -p /etc/slurm /var/spool/slurmctld /var/spool/slurmd /run/munge /var/log/munge /var/lib/munge
[ -s /etc/munge/munge.key ] || head -c 1024 /dev/urandom >/etc/munge/munge.key
chown munge: /run/munge /var/log/munge /var/lib/munge /etc/munge/munge.key
chmod 755 /run/munge
chmod 400 /etc/munge/munge.key
cat >/etc/slurm/slurm.conf <<CONF
ClusterName=local
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
StateSaveLocation=/var/spool/slurmctld
SlurmdSpoolDir=/var/spool/slurmd
SlurmctldPidFile=/run/slurmctld.pid
SlurmdPidFile=/run/slurmd.pid
SlurmctldLogFile=/var/log/slurmctld.log
SlurmdLogFile=/var/log/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
JobRequeue=1
SchedulerParameters=batch_sched_delay=1,sched_interval=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
runuser -u munge -- /usr/sbin/munged
slurmctld -c
slurmd
for _ in $(seq 100); do
  if [ "$(sinfo -h -o %T 2>/dev/null)" = idle ]; then sinfo; exit 0; fi
  sleep 0.2
done
echo "the node did not come up: see /var/log/slurmctld.log and /var/log/slurmd.log" >&2
exit 1
