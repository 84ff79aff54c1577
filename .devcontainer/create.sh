#!/bin/bash
# Make a container from ros:jazzy ready: system packages, Python packages, the built workspace, a sourced shell.
set -eo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
apt-get update
apt-get install -y --no-install-recommends build-essential cmake python3-venv python3-dev python3-colcon-common-extensions
rosdep update --rosdistro jazzy
rosdep install --from-paths ros_ws/src --ignore-src -y --skip-keys "mcap-ros2-support python3-rosbags-pip"
. /opt/ros/jazzy/setup.bash
make build
echo ". '$PWD/setup/environment.bash'" >>~/.bashrc
