# What scripts/demo and scripts/test share; sourced by them.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# Another python3 may come first on PATH and lack catkin_pkg and rospy, which are packages of the system's own.
python=/usr/bin/python3
export PATH=/usr/bin:$PATH

# source_setup FILE: a ROS setup file, which reads variables that are not set.
source_setup() {
  set +u
  # shellcheck disable=SC1090
  source "$1"
  set -u
}

# Shows the compiler's progress as one line that counts, or as a few lines where no terminal is.
show_progress() {
  local line percent last=-25
  while IFS= read -r line; do
    [[ $line =~ ^\[\ *([0-9]+)%\] ]] || continue
    percent=${BASH_REMATCH[1]}
    if [ -t 1 ]; then
      printf '\r  %3d %%\033[K' "$percent"
    elif ((percent >= last + 25)); then
      last=$((percent - percent % 25))
      printf '  %d %%\n' "$last"
    fi
  done
  if [ -t 1 ]; then
    printf '\r\033[K'
  fi
}

# lock DIRECTORY: keeps other runs of these scripts out of a build directory until unlock, or the end of the program.
lock() {
  mkdir -p "$1"
  exec 9>"$1/lock"
  if ! flock -n 9; then
    echo "Waiting for another run in ${1#"$root"/} to end ..."
    flock 9
  fi
}

unlock() {
  exec 9>&-
}

# build DIRECTORY TARGETS [CMAKE ARGUMENTS...]: configures (once) and builds, with the whole output in DIRECTORY/build.log.
build() {
  local directory=$1 targets
  read -ra targets <<<"$2"
  shift 2
  local arguments=("-DPYTHON_EXECUTABLE=$python" "-DCATKIN_DEVEL_PREFIX=$directory/devel" "$@")
  local log=$directory/build.log
  if [ -f /opt/ros/noetic/setup.bash ]; then
    source_setup /opt/ros/noetic/setup.bash
  fi
  if [ ! -f "$directory/Makefile" ] || [ "$(cat "$directory/arguments" 2>/dev/null)" != "${arguments[*]}" ]; then
    echo "Configuring in ${directory#"$root"/} ..."
    rm -f "$directory/arguments"
    if ! cmake -S "$root" -B "$directory" -G "Unix Makefiles" "${arguments[@]}" >"$log" 2>&1; then
      tail -n 40 "$log" >&2
      echo "Configuring failed; all of it is in $log" >&2
      return 1
    fi
    printf '%s' "${arguments[*]}" >"$directory/arguments"
  fi
  echo "Building in ${directory#"$root"/} (a first build takes some minutes) ..."
  if ! cmake --build "$directory" -- -j"$(nproc)" "${targets[@]}" 2>&1 | tee "$log" | show_progress; then
    grep -nE -A6 'error|Error |\*\*\*' "$log" | head -n 60 >&2 || true
    echo "The build failed; all of it is in $log" >&2
    return 1
  fi
}
