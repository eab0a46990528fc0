# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The table of operator commands, as simulated robots answer `help json`; and the one in docs/franka_sim.md.

As a program, it writes the table of the page again: python3 tests/support/operator_table.py
"""

import json
from functools import cache
from pathlib import Path

from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import FR3

PAGE = Path(__file__).resolve().parents[2] / "docs" / "franka_sim.md"
HEAD = "| line | meaning |\n|---|---|\n"


@cache
def operator_table(hand: str = "gripper") -> str:
    with FrankaSim(FR3(hand=hand)) as server:
        return server.robot.remote.send("help json")


def markdown() -> str:
    """The rows of all robots, and `help`."""
    rows = json.loads(operator_table())
    known = {row["usage"] for row in rows}
    rows += [row for row in json.loads(operator_table("vacuum")) if row["usage"] not in known]
    lines = [(row["usage"].replace("|", r"\|"), row["help"]) for row in rows]
    lines.append(("help", "lists these lines; `help NAME` explains one, `help json` is the table in JSON"))
    return HEAD + "".join(f"| `{usage}` | {text} |\n" for usage, text in lines)


def table_of_page() -> str:
    text = PAGE.read_text(encoding="utf-8")
    return HEAD + text.partition(HEAD)[2].partition("\n\n")[0] + "\n"


if __name__ == "__main__":
    PAGE.write_text(PAGE.read_text(encoding="utf-8").replace(table_of_page(), markdown()), encoding="utf-8")
