# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A page for each ROS package: launch files, nodes, messages, services, actions and plugin classes."""

from docsite import (
    command_lines,
    cpp_api,
    descriptions,
    dynamic_parameters,
    interfaces,
    launch_files,
    nodes,
    plugins,
)
from docsite.markdown import page, plain
from docsite.packages import Package, packages
from docsite.tree import Tree


def section(title: str, parts: list[str]) -> str:
    return "\n\n".join([f"## {title}", *parts]) if parts else ""


def sections(package: Package) -> list[str]:
    """The sections of the package that are not empty."""
    launch = [
        launch_files.describe(launch_files.read_launch_file(path), package.name)
        for path in package.files("launch/**/*.launch")
    ]
    robots = [
        descriptions.describe(descriptions.read_description(path), package.name)
        for path in package.files("robots/**/*.urdf.xacro")
        if descriptions.read_description(path).arguments
    ]
    configs = [
        dynamic_parameters.describe(dynamic_parameters.read_config(path))
        for path in package.files("cfg/*.cfg")
    ]
    found = plugins.plugins_of(package)
    parts = [
        section("Launch files", launch),
        section("Plugin classes", [plugins.describe(found)] if found else []),
        section("Nodes and controllers", [nodes.describe(node) for node in nodes.nodes_of(package.name)]),
        section("Parameters at run time (dynamic_reconfigure)", configs),
        section("Robot descriptions", robots),
    ]
    for kind, title in interfaces.KINDS.items():
        files = package.files(f"{kind}/*.{kind}")
        texts = [interfaces.describe(interfaces.read_interface(path), package.name) for path in files]
        parts.append(section(title, texts))
    return [part for part in parts if part]


def further(package: Package) -> str:
    """Links to the other pages about the package."""
    links = []
    if any(header.package == package.name for header in cpp_api.public_headers()):
        links.append(f"[C++ interface](../cpp/{package.name}.md)")
    if any(program.package == package.name for program in command_lines.programs()):
        links.append(f"[command lines](../programs/{package.name}.md)")
    return f"More about it: {', '.join(links)}." if links else ""


def write_pages(tree: Tree) -> None:
    """The pages, and an index that describes each package."""
    for package in packages():
        body = page(package.name, plain(package.description), further(package), *sections(package))
        tree.write(f"reference/packages/{package.name}.md", body)
    names = "\n".join(package.name for package in packages())
    intro = (
        "Launch files, nodes, parameters, topics, services, actions and plugin classes of each ROS package."
    )
    rows = "\n".join(f"* [{each.name}]({each.name}.md): {plain(each.description)}" for each in packages())
    toctree = f"```{{toctree}}\n:hidden:\n\n{names}\n```"
    tree.write("reference/packages/index.md", page("ROS packages", intro, rows, toctree))
