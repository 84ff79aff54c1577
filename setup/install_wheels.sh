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

# One environment may serve several checkouts: what another one needs beside is no reason to install again.
installed=.venv/requirements-installed.txt
lacking() { grep '^[^#]' <<<"$requirements" | grep -vxFf "$installed" || true; }
if [ -s "$installed" ] && [ -z "$(lacking)" ]; then
    exit
fi

echo "Installing Python packages into .venv (some minutes, 2 GB)"
if [[ " ${options[*]} " = *" --clear "* ]]; then
    "$python" -m venv "${options[@]}" .venv
fi
.venv/bin/python -m pip install --quiet --disable-pip-version-check -r <(echo "$requirements")
if [ "${ROS_DISTRO:-}" = jazzy ]; then
    echo "${AMENT_PREFIX_PATH##*:}/setup.bash" >.venv/sourced-ros
else
    .venv/bin/python setup/fix_wheel_paths.py
fi
touch .venv/COLCON_IGNORE # so that a `colcon build` around this checkout does not look into it
echo "$requirements" >"$installed"
