# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every header of the originals exists and compiles alone in C++14, with every class and signature.

Each header is compiled in its own file, which includes it twice; each file in `signatures/` uses what no
test of the package with the same name calls. In C++14, as packages written for the originals ask for; the
workspace itself is compiled in C++17.
"""

import hashlib
import os
import re
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ROS_CONTROL = HERE.parents[1]
TOP = ROS_CONTROL.parents[2]

# Packages whose public headers are those of the originals. A missing one breaks the build of their tests.
PACKAGES = [
    "combined_robot_hw",
    "control_toolbox",
    "controller_interface",
    "controller_manager",
    "hardware_interface",
    "joint_limits_interface",
    "joint_trajectory_controller",
    "realtime_tools",
    "transmission_interface",
]
# Without signatures of their own: controllers, and the packages of the robot, whose classes their tests use.
OTHERS = {
    "effort_controllers": [
        "joint_effort_controller",
        "joint_group_effort_controller",
        "joint_group_position_controller",
        "joint_position_controller",
        "joint_velocity_controller",
    ],
    "forward_command_controller": ["forward_command_controller", "forward_joint_group_command_controller"],
    "franka": [
        "command_types",
        "control_tools",
        "control_types",
        "duration",
        "errors",
        "exception",
        "gripper",
        "gripper_state",
        "log",
        "lowpass_filter",
        "model",
        "rate_limiting",
        "robot",
        "robot_state",
        "vacuum_gripper",
        "vacuum_gripper_state",
    ],
    "franka_control": ["franka_state_controller"],
    "franka_gripper": ["franka_gripper"],
    "franka_hw": [
        "control_mode",
        "franka_cartesian_command_interface",
        "franka_combinable_hw",
        "franka_combined_hw",
        "franka_hw",
        "franka_model_interface",
        "franka_state_interface",
        "model",
        "model_base",
        "resource_helpers",
        "services",
        "trigger_rate",
    ],
    "gripper_action_controller": ["gripper_action_controller"],
    "joint_state_controller": ["joint_state_controller"],
    "position_controllers": ["joint_group_position_controller", "joint_position_controller"],
    "trajectory_interface": ["pos_vel_acc_state", "quintic_spline_segment", "trajectory_interface"],
    "velocity_controllers": [
        "joint_group_velocity_controller",
        "joint_position_controller",
        "joint_velocity_controller",
    ],
}
HEADERS = [f"{package}/{name}.h" for package, names in OTHERS.items() for name in names]
HEADERS += [
    f"{package}/{path.name}"
    for package in PACKAGES
    for path in sorted((ROS_CONTROL / package / "include" / package).glob("*.h"))
    if not path.name.endswith("_impl.h")
]
SIGNATURES = sorted(path.name for path in (HERE / "signatures").glob("*.cpp"))

# Headers without ROS, neither here nor in the original, and one of our own.
PLAIN = [
    "realtime_tools/latest_value.h",
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
# All others of ros_control put the placeholders of boost::bind into the global namespace.
BOUND = "int number = boost::bind<int>(std::minus<int>(), _2, _1)(1, 2);\n"

# Debian puts the headers of these into separate folders.
DEBIAN = [
    "ament_index_cpp",
    "angles",
    "class_loader",
    "eigen3",
    "pluginlib",
    "rcpputils",
    "rcutils",
    "urdfdom_headers",
    "xmlrpcpp",
]


# A static constexpr member of a class is a definition in C++17 only: C++14 that refers to one does not link.
UNDEFINED_CONSTANT = re.compile(r"^ *U (\S*::(?:k[A-Z]\w*|[A-Z_]+))$", re.M)


def source_folders() -> list[Path]:
    packages = [
        ROS_CONTROL.parent / name for name in ("franka_control", "franka_gripper", "franka_hw", "libfranka")
    ]
    folders = sorted(ROS_CONTROL.glob("*/include")) + [package / "include" for package in packages]
    return [*folders, ROS_CONTROL / "boost_bind_compat" / "placeholders"]


def include_options() -> list[str]:
    prefixes = [Path(prefix) for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":") if prefix]
    own = [*source_folders(), *(prefix / "include" for prefix in prefixes), HERE / "signatures"]
    foreign = [Path("/usr/include") / name for name in DEBIAN]
    options = [f"-I{path}" for path in own if path.is_dir()]
    return options + [f"-isystem{path}" for path in foreign if path.is_dir()]


def own_errors(text: str) -> str:
    """The compiler's errors, or none if all are in the system's headers, which may need a later standard."""
    found = re.findall(r"^(\S+?):\d+:(?:\d+:)? (?:fatal )?error: ", text, re.M)
    return "" if found and all(path.startswith("/usr/") for path in found) else text


def compiler_errors(source: str, folder: Path) -> str:
    """The compiler's errors about a text in C++14; empty if it compiles and its constants link.

    Cached if there is ccache.

    In a folder of this clone, ccache also knows the results of clones in other folders.
    """
    name = hashlib.sha256(source.encode()).hexdigest()[:16]
    (folder / f"{name}.cpp").write_text(source)
    command = ["ccache"] if shutil.which("ccache") else []
    command += ["/usr/bin/c++", "-std=c++14", "-O0", "-Wall", "-Wextra", "-Werror", "-c", f"{name}.cpp"]
    command += include_options()
    done = subprocess.run(
        command,
        cwd=folder,
        env=os.environ | {"CCACHE_BASEDIR": str(TOP), "CCACHE_NOHASHDIR": "1"},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    if done.returncode != 0:
        return own_errors(done.stderr)
    symbols = subprocess.check_output(["nm", "-C", "-u", f"{name}.o"], cwd=folder, text=True, timeout=60)
    return "\n".join(f"{constant} has no definition" for constant in UNDEFINED_CONSTANT.findall(symbols))


@pytest.fixture(scope="module")
def verdicts() -> dict[str, str]:
    """Errors of all headers and signatures. In parallel, because the compiler is slow."""
    sources = {
        name: f"#include <{name}>\n" * 2 + BOUND * (name.split("/")[0] in PACKAGES and name not in PLAIN)
        for name in HEADERS
    }
    sources |= {name: (HERE / "signatures" / name).read_text() for name in SIGNATURES}
    folder = TOP / "out" / "headers"
    folder.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = pool.map(lambda source: compiler_errors(source, folder), sources.values())
        return dict(zip(sources, found))


@pytest.mark.parametrize("header", HEADERS)
def test_header_compiles_alone(header, verdicts):
    assert any((folder / header).is_file() for folder in source_folders()), f"{header} is missing"
    assert verdicts[header] == ""


@pytest.mark.parametrize("package", PACKAGES)
def test_every_class_and_signature_exists(package, verdicts):
    assert verdicts[f"{package}.cpp"] == ""


def test_missing_headers_and_wrong_types_are_detected(tmp_path):
    assert "no_such_header" in compiler_errors("#include <hardware_interface/no_such_header.h>\n", tmp_path)
    wrong = '#include "signature.h"\nEXPECT_TYPE(int, 1.0);\n'
    assert "static assertion failed" in compiler_errors(wrong, tmp_path)


def test_only_errors_of_the_system_are_excused_and_undefined_constants_found(tmp_path):
    error = "{}:5:3: error: 'shared_mutex' in namespace 'std' does not name a type\n"
    assert own_errors(error.format("/usr/include/log4cxx/logger.h")) == ""
    both = error.format("/usr/include/log4cxx/logger.h") + error.format("/clone/realtime_tools/box.h")
    assert own_errors(both) == both
    later = (
        "struct Limits {\n  static constexpr int kMax = 1;\n};\nconst int* max() { return &Limits::kMax; }\n"
    )
    assert compiler_errors(later, tmp_path) == "Limits::kMax has no definition"
    assert "c++17" in compiler_errors("inline constexpr int kMax = 1;\n", tmp_path).lower()
