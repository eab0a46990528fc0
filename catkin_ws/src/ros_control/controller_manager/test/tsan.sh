#!/usr/bin/env bash
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
#
# Builds the controller manager and its stress test with ThreadSanitizer and runs the test.
# Needs a sourced workspace that has controller_manager_msgs and hardware_interface.
# The exit status is 0 if no race was found and the test passed.
#
#   tsan.sh BUILD_DIRECTORY [OPERATIONS]     OPERATIONS: 10000 unless given
set -eu

if [ $# -lt 1 ]; then
  sed -n '5,9s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
package=$(dirname "$here")
mkdir -p "$1"
build=$(cd "$1" && pwd)
operations=${2:-10000}

if ! command -v setarch >/dev/null; then
  echo "tsan.sh: setarch is missing; it is in the Debian package util-linux" >&2
  exit 1
fi

# The headers of every workspace on the prefix path, and of the neighbors in the source tree.
includes="-I$package/include -I$package/../../../../tests/include"
for neighbor in boost_bind_compat hardware_interface controller_interface; do
  includes="$includes -I$package/../$neighbor/include"
done
prefixes=$(printf '%s' "${CMAKE_PREFIX_PATH:-}" | tr ':' ' ')
found=""
for prefix in $prefixes; do
  includes="$includes -I$prefix/include"
  if [ -e "$prefix/include/controller_manager_msgs/SwitchController.h" ]; then found=yes; fi
done
if [ -z "$found" ]; then
  echo "tsan.sh: controller_manager_msgs is not on CMAKE_PREFIX_PATH; source a workspace first" >&2
  exit 1
fi
for directory in pluginlib class_loader ament_index_cpp rcpputils rcutils; do
  includes="$includes -isystem /usr/include/$directory"
done
libraries="-lroscpp -lrosconsole -lroscpp_serialization -lrostime -lxmlrpcpp -lroslib -lclass_loader
  -lament_index_cpp -lrcpputils -lrcutils -lconsole_bridge -ltinyxml2 -lboost_thread -lgtest -lpthread"

launcher=""
if command -v ccache >/dev/null; then launcher=ccache; fi
rm -f "$build"/*.o "$build/stress_test"
objects=""
pending=0
for source in "$package"/src/*.cpp "$here/stress_test.cpp"; do
  object="$build/$(basename "$source" .cpp).o"
  objects="$objects $object"
  # shellcheck disable=SC2086  # a list of options
  $launcher g++ -std=c++17 -O1 -g -fsanitize=thread -fPIE $includes -c "$source" -o "$object" &
  pending=$((pending + 1))
  if [ $((pending % 2)) -eq 0 ]; then wait -n; fi
done
wait
# shellcheck disable=SC2086
g++ -fsanitize=thread -pie $objects $libraries -o "$build/stress_test"

# A master of its own on a free port of this machine.
export ROS_HOSTNAME=localhost
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("localhost", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI="http://localhost:$port"
/usr/bin/python3 "$(command -v rosmaster || echo /usr/bin/rosmaster)" --core -p "$port" \
  >"$build/rosmaster.log" 2>&1 &
master=$!
trap 'kill "$master" 2>/dev/null; wait "$master" 2>/dev/null || true' EXIT
for _ in $(seq 100); do
  if /usr/bin/python3 -c "import socket; socket.create_connection(('localhost', $port), 1)" \
    2>/dev/null; then
    break
  fi
  sleep 0.1
done

# Without address space randomization, which some kernels stretch beyond what the sanitizer knows.
TSAN_OPTIONS="suppressions=$here/tsan.supp halt_on_error=0 exitcode=66 second_deadlock_stack=1" \
  STRESS_OPERATIONS="$operations" setarch "$(uname -m)" -R "$build/stress_test" \
  >"$build/stress_test.log" 2>&1 && status=0 || status=$?
grep -E 'operations,|WARNING: ThreadSanitizer|SUMMARY|PASSED|FAILED' "$build/stress_test.log" || true
if [ "$status" -ne 0 ]; then
  echo "tsan.sh: failed with status $status; everything is in $build/stress_test.log" >&2
fi
exit "$status"
