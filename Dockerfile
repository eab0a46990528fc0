# syntax=docker/dockerfile:1
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
#
# Images with the Debian packages in /opt/franka_ros. docs/how_to/containers.md says how to build and run them.
#   runtime       simulates and controls robots, without windows; pictures are drawn without a display
#   development   the same, and what builds and tests own packages; the last stage, so the default
ARG RELEASE=bookworm

FROM debian:${RELEASE} AS packages
# The release decides about versions.
# hadolint ignore=DL3008
RUN apt-get update \
    && apt-get install -y --no-install-recommends ca-certificates \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /source
COPY . .
RUN --mount=type=cache,target=/ccache CCACHE_DIR=/ccache ./franka deb

FROM debian:${RELEASE}-slim AS runtime
COPY ci/install /usr/local/lib/franka/ci/install
RUN --mount=type=bind,from=packages,source=/source/dist/deb,target=/packages \
    /usr/local/lib/franka/ci/install /packages ros-franka-franka-ros libosmesa6 \
    && rm -rf /var/lib/apt/lists/* /etc/apt/sources.list.d/franka-ros.list
COPY ci/run /usr/local/lib/franka/ci/run
# A number, so that a cluster that refuses root sees that this is none.
RUN useradd --uid 1000 --create-home --home-dir /franka --shell /bin/bash franka
USER 1000:1000
WORKDIR /franka
# A container has no graphics card of its own; the name by which nodes reach each other inside of it is localhost.
ENV FRANKA_SIM_RENDERER=osmesa ROS_HOSTNAME=localhost
ENTRYPOINT ["/opt/franka_ros/env.sh"]
CMD ["bash"]

FROM runtime AS development
USER 0:0
RUN --mount=type=bind,from=packages,source=/source/dist/deb,target=/packages \
    /usr/local/lib/franka/ci/install /packages ros-franka-dev ccache git python3-pytest \
    && rm -rf /var/lib/apt/lists/* /etc/apt/sources.list.d/franka-ros.list
USER 1000:1000
