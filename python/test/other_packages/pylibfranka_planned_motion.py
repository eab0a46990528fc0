# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A motion that the robot itself plans. How many states pass meanwhile depends on the program."""

import json
import sys

from pylibfranka import AsyncPositionControlHandler, RealtimeConfig, Robot

robot = Robot(sys.argv[1], RealtimeConfig.kIgnore)
state = robot.read_once()
target = list(state.q_d)
target[6] += 0.05
configured = AsyncPositionControlHandler.configure(
    robot, AsyncPositionControlHandler.Configuration([0.5] * 7, 0.001)
)
handler = configured.handler
sent = handler.set_joint_position_target(AsyncPositionControlHandler.JointPositionTarget(target))
for _ in range(5000):
    feedback = handler.get_target_feedback()
    if feedback.status.name == "kTargetReached":
        break
handler.stop_control()
seen = {
    "configured": configured.error_message,
    "sent": [sent.was_successful, sent.error_message],
    "feedback": [int(feedback.status), feedback.error_message],
}
print(json.dumps(seen))
