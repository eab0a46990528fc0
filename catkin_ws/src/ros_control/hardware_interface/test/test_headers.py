# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every header of the original's ros_control exists and compiles alone, with every class and signature.

Each header is compiled in its own file, which includes it twice; each file in `signatures/` uses what no
test of the package with the same name calls.
"""

import hashlib
import os
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ROS_CONTROL = HERE.parents[1]
TOP = ROS_CONTROL.parents[2]

INVENTORY = {
    "combined_robot_hw": ["combined_robot_hw"],
    "control_toolbox": ["dither", "filters", "pid", "pid_gains_setter", "sine_sweep", "sinusoid"],
    "controller_interface": [
        "controller",
        "controller_base",
        "internal/robothw_interfaces",
        "multi_interface_controller",
    ],
    "controller_manager": [
        "controller_loader",
        "controller_loader_interface",
        "controller_manager",
        "controller_spec",
    ],
    "hardware_interface": [
        "actuator_command_interface",
        "actuator_state_interface",
        "controller_info",
        "force_torque_sensor_interface",
        "hardware_interface",
        "imu_sensor_interface",
        "interface_resources",
        "internal/demangle_symbol",
        "internal/hardware_resource_manager",
        "internal/interface_manager",
        "internal/resource_manager",
        "joint_command_interface",
        "joint_mode_interface",
        "joint_state_interface",
        "position_velocity_torque_gains_command_interface",
        "posvel_command_interface",
        "posvelacc_command_interface",
        "robot_hw",
    ],
    "joint_limits_interface": [
        "joint_limits",
        "joint_limits_interface",
        "joint_limits_interface_exception",
        "joint_limits_rosparam",
        "joint_limits_urdf",
    ],
    # The others are prefixes of these.
    "joint_trajectory_controller": [
        "hold_trajectory_builder",
        "init_joint_trajectory",
        "joint_trajectory_controller",
        "tolerances",
    ],
    "realtime_tools": [
        "realtime_box",
        "realtime_buffer",
        "realtime_clock",
        "realtime_publisher",
        "realtime_server_goal_handle",
    ],
    "transmission_interface": [
        "bidirectional_effort_joint_interface_provider",
        "bidirectional_position_joint_interface_provider",
        "bidirectional_velocity_joint_interface_provider",
        "differential_transmission",
        "differential_transmission_loader",
        "effort_joint_interface_provider",
        "four_bar_linkage_transmission",
        "four_bar_linkage_transmission_loader",
        "joint_state_interface_provider",
        "position_joint_interface_provider",
        "robot_transmissions",
        "simple_transmission",
        "simple_transmission_loader",
        "transmission",
        "transmission_info",
        "transmission_interface",
        "transmission_interface_exception",
        "transmission_interface_loader",
        "transmission_loader",
        "transmission_parser",
        "velocity_joint_interface_provider",
    ],
}
HEADERS = [f"{package}/{name}.h" for package, names in INVENTORY.items() for name in names]
SIGNATURES = sorted(path.name for path in (HERE / "signatures").glob("*.cpp"))

# Headers without ROS, neither here nor in the original.
PLAIN = [
    "control_toolbox/dither.h",
    "control_toolbox/filters.h",
    "control_toolbox/sine_sweep.h",
    "control_toolbox/sinusoid.h",
    "hardware_interface/controller_info.h",
    "hardware_interface/interface_resources.h",
    "hardware_interface/internal/demangle_symbol.h",
    "joint_limits_interface/joint_limits.h",
    "joint_limits_interface/joint_limits_interface_exception.h",
    "transmission_interface/differential_transmission.h",
    "transmission_interface/four_bar_linkage_transmission.h",
    "transmission_interface/simple_transmission.h",
    "transmission_interface/transmission.h",
    "transmission_interface/transmission_info.h",
    "transmission_interface/transmission_interface_exception.h",
]
# All others put the placeholders of boost::bind into the global namespace.
BOUND = "int number = boost::bind<int>(std::minus<int>(), _2, _1)(1, 2);\n"

# Debian puts the headers of these into separate folders.
DEBIAN = [
    "ament_index_cpp",
    "angles",
    "class_loader",
    "pluginlib",
    "rcpputils",
    "rcutils",
    "urdfdom_headers",
    "xmlrpcpp",
]


def include_folders() -> list[Path]:
    sources = sorted(ROS_CONTROL.glob("*/include")) + [ROS_CONTROL / "boost_bind_compat" / "placeholders"]
    prefixes = [Path(prefix) for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":") if prefix]
    generated = [prefix / "include" for prefix in prefixes]
    return sources + generated + [Path("/usr/include") / name for name in DEBIAN]


def compiler_errors(source: str, folder: Path) -> str:
    """The compiler's errors about a text; empty if it compiles. Cached if there is ccache.

    In a folder of this clone, ccache also knows the results of clones in other folders.
    """
    name = hashlib.sha256(source.encode()).hexdigest()[:16]
    (folder / f"{name}.cpp").write_text(source)
    command = ["ccache"] if shutil.which("ccache") else []
    command += ["/usr/bin/c++", "-std=c++17", "-O0", "-Wall", "-Wextra", "-Werror", "-c", f"{name}.cpp"]
    command += [f"-I{path}" for path in include_folders() + [HERE / "signatures"] if path.is_dir()]
    done = subprocess.run(
        command,
        cwd=folder,
        env=os.environ | {"CCACHE_BASEDIR": str(TOP), "CCACHE_NOHASHDIR": "1"},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    return done.stderr if done.returncode != 0 else ""


@pytest.fixture(scope="module")
def verdicts() -> dict[str, str]:
    """Errors of all headers and signatures. In parallel, because the compiler is slow."""
    sources = {name: f"#include <{name}>\n" * 2 + BOUND * (name not in PLAIN) for name in HEADERS}
    sources |= {name: (HERE / "signatures" / name).read_text() for name in SIGNATURES}
    folder = TOP / "out" / "headers"
    folder.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = pool.map(lambda source: compiler_errors(source, folder), sources.values())
        return dict(zip(sources, found))


@pytest.mark.parametrize("header", HEADERS)
def test_header_compiles_alone(header, verdicts):
    package = header.split("/", maxsplit=1)[0]
    assert (ROS_CONTROL / package / "include" / header).is_file(), f"{header} is missing"
    assert verdicts[header] == ""


@pytest.mark.parametrize("package", sorted(INVENTORY))
def test_every_class_and_signature_exists(package, verdicts):
    assert verdicts[f"{package}.cpp"] == ""


def test_missing_headers_and_wrong_types_are_detected(tmp_path):
    assert "no_such_header" in compiler_errors("#include <hardware_interface/no_such_header.h>\n", tmp_path)
    wrong = '#include "signature.h"\nEXPECT_TYPE(int, 1.0);\n'
    assert "static assertion failed" in compiler_errors(wrong, tmp_path)
