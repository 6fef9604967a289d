# shellcheck shell=bash disable=SC2154
# What scripts/samara and scripts/test share: packages, configuration, build. Sourced with `root`
# (the checkout) and `build` (its build folder) set; every message goes to stderr.

declare -a cmake_options # more of them for this build

say() { printf 'samara: %s\n' "$*" >&2; }
fail() {
  say "$@"
  exit 1
}

# One set-up at a time: who comes second waits, then finds it done.
lock_build() {
  { mkdir -p "$build" && touch "$build/samara.lock"; } 2>/dev/null || fail "cannot write to $build"
  exec 9>"$build/samara.lock"
  flock -n 9 && return
  say "waiting for another build in $build"
  flock 9
}
unlock_build() { exec 9>&-; }

# Those of all, and of the kinds (test, ci) that the caller has set.
declare -a package_kinds
list_packages() {
  local kind marks=()
  for kind in "${package_kinds[@]}"; do marks+=(-e "s/^$kind: //"); done
  sed -e 's/#.*//' "${marks[@]}" -e '/^[a-z]*: /d' "$root/scripts/packages.txt"
}

list_missing_packages() {
  local installed package
  installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' 2>/dev/null)
  for package in $(list_packages); do
    grep -qx -- "$package installed" <<<"$installed" || printf '%s\n' "$package"
  done
}

# Installs what is missing, as root or with a sudo that asks nothing.
install_packages() {
  command -v dpkg-query >/dev/null || return 0 # not Debian: CMake will say what it does not find
  local missing as_root=() log=$build/install.log
  missing=$(list_missing_packages | xargs)
  [[ -n $missing ]] || return 0
  local advice="install them and try again:
    apt-get install --no-install-recommends $missing"
  if ((EUID != 0)); then
    sudo -n true 2>/dev/null || fail "Debian packages are missing, and there is neither root nor" \
      "a sudo without password here; $advice"
    as_root=(sudo -n)
  fi
  say "installing $(wc -w <<<"$missing") packages with apt-get (log: $log)"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qy -o DPkg::Lock::Timeout=600)
  "${apt[@]}" update >"$log" 2>&1 9>&- </dev/null # may fail: the lists may already be there
  # shellcheck disable=SC2086
  "${apt[@]}" install --no-install-recommends $missing >>"$log" 2>&1 9>&- </dev/null
  missing=$(list_missing_packages | xargs)
  if [[ -n $missing ]]; then
    tail -n 15 "$log" >&2
    fail "apt-get could not install Debian packages (is there a network? log: $log); $advice"
  fi
  rm -f "$build/CMakeCache.txt" # what was not found before is there now
}

# Shows a log as one line that counts on a terminal, and keeps it all in a file.
follow_log() {
  local line
  while IFS= read -r line; do
    printf '%s\n' "$line"
    [[ -t 2 && $line =~ ^\[\ *([0-9]+(/[0-9]+|%))\] ]] &&
      printf '\rsamara: building %s ' "${BASH_REMATCH[1]}" >&2
  done >"$1"
  [[ -t 2 ]] && printf '\r\033[K' >&2
  return 0
}

run_logged() {
  local what=$1 log=$build/$2
  shift 2
  "$@" 2>&1 9>&- </dev/null | follow_log "$log"
  ((PIPESTATUS[0] == 0)) && return
  tail -n 60 "$log" >&2
  fail "$what failed (log: $log)"
}

get_cached() { sed -n "s/^$1:[^=]*=//p" "$build/CMakeCache.txt" 2>/dev/null; }

# A Release build of this checkout; the build itself notices changed CMake files.
configure() {
  local generator=() home
  home=$(get_cached CMAKE_HOME_DIRECTORY)
  if [[ $home != "$root" ]]; then # none yet, new packages, or the checkout was moved
    [[ -z $home ]] ||
      find "$build" -mindepth 1 -maxdepth 1 ! -name 'samara.*' ! -name install.log -exec rm -rf {} +
    generator=(-G Ninja)
  elif [[ $(get_cached CMAKE_BUILD_TYPE) == Release && (-e $build/build.ninja || -e $build/Makefile) ]]
  then
    return
  fi
  run_logged "the configuration" configure.log \
    cmake -S "$root" -B "$build" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release "${cmake_options[@]}"
}

# Builds what has changed of the given targets and marks the program as up to date. The mark has the
# time before the build: what changes meanwhile is built next time.
build_targets() {
  local mark=$build/samara.stamp
  install_packages
  say "building (log: $build/build.log)"
  rm -f "$mark"
  printf '%s\n' "$root" >"$mark.new" || fail "cannot write to $build"
  configure
  run_logged "the build" build.log cmake --build "$build" -j "${SAMARA_JOBS:-2}" --target "$@"
  mv "$mark.new" "$mark"
}
