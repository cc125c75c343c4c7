# shellcheck shell=bash
# A Slurm of this machine's own in a folder, for tests: munged, slurmctld and one slurmd,
# as root and without systemd. To be sourced; start_slurm FOLDER, stop_slurm.

slurm_pids=()

start_slurm() {
  local folder=$1 cpus memory port name
  # A socket's path may have 107 bytes only.
  mkdir -p "$folder"/{state,spool,munge}
  chmod 755 "$folder" "$folder/munge"
  cpus=$(nproc)
  memory=$(($(awk '/^MemTotal/ { print $2 }' /proc/meminfo) / 1024 - 512))
  port=$((20000 + $$ % 20000))
  name=$(hostname -s)
  head -c 1024 /dev/urandom >"$folder/munge/key"
  chmod 400 "$folder/munge/key"
  cat >"$folder/slurm.conf" <<END
ClusterName=tress
SlurmctldHost=$name(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
SlurmctldPort=$port
SlurmdPort=$((port + 1))
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerParameters=sched_min_interval=200000,bf_interval=1
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
KillWait=5
MinJobAge=300
NodeName=$name NodeAddr=127.0.0.1 CPUs=$cpus RealMemory=$memory State=UNKNOWN
PartitionName=short Nodes=$name Default=YES MaxTime=60 State=UP
END
  export SLURM_CONF="$folder/slurm.conf"
  munged --foreground --force --socket="$folder/munge/socket" --key-file="$folder/munge/key" \
    --pid-file="$folder/munge/pid" --log-file="$folder/munge/log" \
    --seed-file="$folder/munge/seed" >"$folder/munge/out" 2>&1 &
  slurm_pids+=($!)
  for _ in {1..50}; do [[ -S $folder/munge/socket ]] && break; sleep 0.1; done
  slurmctld -D -i >"$folder/slurmctld.out" 2>&1 &
  slurm_pids+=($!)
  slurmd -D -N "$name" >"$folder/slurmd.out" 2>&1 &
  slurm_pids+=($!)
  for _ in {1..100}; do
    [[ $(sinfo -h -o %t 2>/dev/null) == idle ]] && return
    sleep 0.2
  done
  echo "Slurm did not start:" && tail -n5 "$folder"/*.log "$folder"/*.out
  return 1
}

stop_slurm() {
  scancel --user="$(id -un)" 2>/dev/null || true
  # The last one first: slurmd, which ends its tasks.
  local i
  for ((i = ${#slurm_pids[@]} - 1; i >= 0; --i)); do
    kill "${slurm_pids[i]}" 2>/dev/null || true
    wait "${slurm_pids[i]}" 2>/dev/null || true
  done
  slurm_pids=()
}
