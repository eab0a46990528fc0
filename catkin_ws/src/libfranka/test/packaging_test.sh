#!/usr/bin/env bash
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
#
# find_package(Franka) works the same under catkin_make, catkin build and plain CMake, from the devel and
# from the install space. Each case builds libfranka and a small consumer in a temporary folder and runs
# the consumer. Usage: packaging_test.sh [catkin_make|catkin_build|plain|vendor]...   (default: all)
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
library=$(dirname "$here")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# Debian's python3 runs catkin, even if another is first in PATH; no other workspace may be found.
export PATH=/usr/bin:$PATH
unset CMAKE_PREFIX_PATH ROS_PACKAGE_PATH LD_LIBRARY_PATH PYTHONPATH

# Each case compiles the same sources: not optimized, and only once with a compiler cache.
options=(-DCMAKE_BUILD_TYPE=Debug)
if command -v ccache >/dev/null; then
  options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  export CCACHE_BASEDIR=$work CCACHE_NOHASHDIR=true
fi

fail() {
  echo "packaging_test: $*" >&2
  exit 1
}

# Runs a step silently; prints its output if it fails.
step() {
  local name=$1
  shift
  "$@" >"$work/log" 2>&1 || {
    cat "$work/log" >&2
    fail "$name failed: $*"
  }
}

# The three programs under a prefix must run.
run_consumers() {
  local where=$1 folder=$2 name
  for name in consumer_by_target consumer_by_variables consumer_of_core; do
    [ -x "$folder/$name" ] || fail "$where: $folder/$name was not built"
    step "$where: $name" "$folder/$name"
  done
  echo "packaging_test: $where works"
}

# The consumer as a plain CMake project against an installed libfranka.
use_installed() {
  local where=$1 prefix=$2 build=$work/use_${1// /_}
  step "$where" cmake -S "$here/consumer" -B "$build" "${options[@]}" -DCMAKE_PREFIX_PATH="$prefix"
  step "$where" cmake --build "$build" -j2
  run_consumers "$where" "$build"
}

make_workspace() {
  mkdir -p "$1/src"
  cp -r "$library" "$1/src/libfranka"
  cp -r "$here/consumer" "$1/src/franka_consumer"
}

# One CMake run configures both; the library is not built yet when the consumer finds it.
case_catkin_make() {
  local ws=$work/catkin_make
  make_workspace "$ws"
  step "catkin_make" catkin_make -C "$ws" -j2 "${options[@]}"
  run_consumers "catkin_make devel" "$ws/devel/lib/franka_consumer"
  step "catkin_make install" catkin_make -C "$ws" -j2 "${options[@]}" install
  LD_LIBRARY_PATH=$ws/install/lib \
    run_consumers "catkin_make install" "$ws/install/lib/franka_consumer"
  use_installed "plain project on catkin_make install" "$ws/install"
  use_installed "plain project on catkin_make devel" "$ws/devel"
}

# Each package is configured alone and finds the other's files.
case_catkin_build() {
  local ws=$work/catkin_build
  make_workspace "$ws"
  step "catkin build" catkin init --workspace "$ws"
  step "catkin build" catkin config --workspace "$ws" --cmake-args "${options[@]}"
  step "catkin build" catkin build --workspace "$ws" --no-status --no-notify -j2
  run_consumers "catkin build devel" "$ws/devel/lib/franka_consumer"
  step "catkin build" catkin clean --workspace "$ws" --yes
  step "catkin build" catkin config --workspace "$ws" --install
  step "catkin build install" catkin build --workspace "$ws" --no-status --no-notify -j2
  LD_LIBRARY_PATH=$ws/install/lib \
    run_consumers "catkin build install" "$ws/install/lib/franka_consumer"
}

case_plain() {
  step "plain" cmake -S "$library" -B "$work/plain" "${options[@]}" \
    -DCMAKE_INSTALL_PREFIX="$work/prefix"
  step "plain" cmake --build "$work/plain" -j2
  step "plain" cmake --install "$work/plain"
  [ ! -e "$work/prefix/setup.sh" ] || fail "a plain build installed catkin's files"
  use_installed "plain install" "$work/prefix"
  use_installed "plain build folder" "$work/plain"
}

# Another libfranka replaces ours: only our core is built, and both work together.
case_vendor() {
  local vendor=$work/vendor
  step "vendor stub" cmake -S "$here/vendor_stub" -B "$work/vendor_build" "${options[@]}" \
    -DCMAKE_INSTALL_PREFIX="$vendor" -DFRANKA_HEADERS="$library/include"
  step "vendor stub" cmake --build "$work/vendor_build" --target install
  step "core beside the vendor's" cmake -S "$library" -B "$work/core" "${options[@]}" \
    -DCMAKE_INSTALL_PREFIX="$work/core_prefix" -DFranka_DIR="$vendor/lib/cmake/Franka"
  step "core beside the vendor's" cmake --build "$work/core" -j2 --target install
  [ -z "$(find "$work/core_prefix" -name 'libfranka.so*')" ] || fail "our libfranka did not step aside"
  # franka_core is used together with the vendor's library: it must define nothing in namespace franka.
  local core
  core=$(find "$work/core_prefix" -name libfranka_core.so)
  if nm -DC --defined-only "$core" | grep -E ' (franka::|(vtable|typeinfo)( name)? for franka::)'; then
    fail "libfranka_core.so defines symbols of namespace franka"
  fi
  step "user of both" cmake -S "$here/vendor_stub/user" -B "$work/vendor_user" "${options[@]}" \
    -DFranka_DIR="$vendor/lib/cmake/Franka" -DCMAKE_PREFIX_PATH="$work/core_prefix"
  step "user of both" cmake --build "$work/vendor_user"
  step "user of both" "$work/vendor_user/vendor_user"
  echo "packaging_test: another libfranka in the place of ours works"
}

for name in "${@:-catkin_make catkin_build plain}"; do
  for one in $name; do
    "case_$one"
  done
done
