# Ubuntu 24.04 with ROS 2 Jazzy from apt and this stack built in it:
#   docker build -t hasel_ros2 . && docker run --rm -it hasel_ros2 ros2 run hasel_sysid improve --help
FROM ros:jazzy

SHELL ["/bin/bash", "-c"]
RUN apt-get update \
    && apt-get install -y --no-install-recommends build-essential cmake python3-venv python3-dev python3-colcon-common-extensions \
    && rm -rf /var/lib/apt/lists/*

WORKDIR /hasel_ros2
COPY . .
RUN apt-get update && rosdep update --rosdistro jazzy \
    && rosdep install --from-paths ros_ws/src --ignore-src -y \
        --skip-keys "mcap-ros2-support python3-rosbags-pip" \
    && rm -rf /var/lib/apt/lists/*
RUN . /opt/ros/jazzy/setup.bash \
    && setup/install_wheels.sh \
    && colcon build --base-paths ros_ws/src

RUN printf '%s\n' '#!/bin/bash' '. /hasel_ros2/install/setup.bash' 'exec "$@"' >/entrypoint.sh && chmod +x /entrypoint.sh
ENTRYPOINT ["/entrypoint.sh"]
CMD ["bash"]
