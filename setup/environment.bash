# Source this file to use the workspace by hand: `. setup/environment.bash`, then python, pytest or an
# executable of `bin/ros2-run` see ROS 2, the virtual environment and the packages built into install/.

hasel_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$hasel_root/setup/source_ros.bash"

prepend() { # prepend VARIABLE FOLDER: put a folder in front of a search path, once
    local variable=$1 folder=$2
    case ":${!variable:-}:" in
        *":$folder:"*) ;;
        *) export "$variable=$folder${!variable:+:${!variable}}" ;;
    esac
}

prepend PATH "$hasel_root/.venv/bin"
if [ "${ROS_DISTRO:-}" != jazzy ]; then
    prepend AMENT_PREFIX_PATH "$hasel_root/.venv"
    prepend CMAKE_PREFIX_PATH "$hasel_root/.venv"
fi
prepend AMENT_PREFIX_PATH "$hasel_root/install"
prepend CMAKE_PREFIX_PATH "$hasel_root/install"
prepend LD_LIBRARY_PATH "$hasel_root/install/lib"
for site_packages in "$hasel_root"/.venv/lib/python3*/; do
    prepend PYTHONPATH "$hasel_root/install/lib/$(basename "$site_packages")/site-packages"
done
unset -f prepend
unset hasel_root site_packages
