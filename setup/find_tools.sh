#!/bin/sh
# Print the Python to use; where a tool is missing, say in one sentence what to install and fail.

missing() {
    echo "$1: install it with \`sudo apt install $2\` (or your system's equivalent) and run make again." >&2
    exit 1
}

case "$(pwd)" in # colcon and CMake stumble over these after ten minutes, executables when they start
    *[!A-Za-z0-9_./+@,-]*)
        echo "The folder $(pwd) has a blank or another special sign in its path: move the checkout to a plain one." >&2
        exit 1
        ;;
esac

is_usable() { # is this a working Python 3.10, 3.11 or 3.12?
    "$1" -c 'import sys; sys.exit(not (3, 10) <= sys.version_info[:2] <= (3, 12))' 2>/dev/null
}

find_python() {
    if [ "${ROS_DISTRO:-}" = jazzy ]; then
        candidates="python3.12 python3" # what ROS 2 Jazzy from apt was built for
    else
        candidates="python3.11 python3.12 python3.10 python3"
    fi
    for candidate in $candidates; do
        if is_usable "$candidate"; then
            python=$(command -v "$candidate")
            return
        fi
    done
    found=$(python3 -c 'import platform; print("Python", platform.python_version())' 2>/dev/null || echo "no Python")
    missing "Found $found, but Python 3.10, 3.11 or 3.12 is needed" "python3.11 python3.11-venv python3.11-dev"
}

python_has() { "$python" -c "$1" >/dev/null 2>&1; }

find_python
version=$("$python" -c 'import sys; print("python%d.%d" % sys.version_info[:2])')
python_has 'import ensurepip, venv' ||
    missing "$version has no venv module to make a virtual environment with" "$version-venv"
python_has 'import pathlib, sysconfig; pathlib.Path(sysconfig.get_path("include"), "Python.h").read_bytes()' ||
    missing "$version has no header files (Python.h), which the messages are compiled against" "$version-dev"
command -v "${CC:-cc}" >/dev/null || missing "No C compiler (${CC:-cc}) was found" build-essential
command -v "${CXX:-c++}" >/dev/null || missing "No C++ compiler (${CXX:-c++}) was found" build-essential
command -v cmake >/dev/null || missing "No cmake was found, which builds the messages" cmake
if [ "${ROS_DISTRO:-}" = jazzy ]; then
    command -v colcon >/dev/null ||
        missing "ROS 2 Jazzy is sourced, but no colcon was found" python3-colcon-common-extensions
fi

echo "$python"
