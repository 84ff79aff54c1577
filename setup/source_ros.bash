# Source the ROS 2 that .venv was made for, where that is an installed one and nothing was sourced yet.

sourced_ros=$(dirname "${BASH_SOURCE[0]}")/../.venv/sourced-ros
if [ "${ROS_DISTRO:-}" != jazzy ] && [ -f "$sourced_ros" ]; then
    . "$(cat "$sourced_ros")"
fi
unset sourced_ros
