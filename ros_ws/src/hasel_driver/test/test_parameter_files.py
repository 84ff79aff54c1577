"""A limit in a file must not be ignored because of the node's namespace."""

import pytest
from hasel_driver.errors import LimitError
from hasel_driver.parameter_files import check_files

SECTION = "{}:\n  ros__parameters:\n    maximum_voltage: 2000.0\n"


@pytest.mark.parametrize("name", ["/**/hasel_driver", "/**", "/hasel/hasel_driver", "hasel_tracker"])
def test_takes_what_reaches_the_node(tmp_path, name):
    """Wildcards, the full name, and sections of other nodes."""
    file = tmp_path / "rig.yaml"
    file.write_text(SECTION.format(name))
    check_files("hasel_driver", "/hasel/hasel_driver", ["--ros-args", "--params-file", str(file)])


def test_refuses_what_would_be_ignored(tmp_path):
    """The section is for the node in the root namespace; the sentence says what to write."""
    file = tmp_path / "rig.yaml"
    file.write_text(SECTION.format("hasel_driver"))
    with pytest.raises(LimitError, match=r"this node is /rig2/hasel_driver.*write /\*\*/hasel_driver there"):
        check_files("hasel_driver", "/rig2/hasel_driver", ["--ros-args", "--params-file", str(file)])


def test_takes_what_launch_writes(tmp_path):
    """A list given in a launch file comes as a tuple of Python."""
    file = tmp_path / "launch.yaml"
    file.write_text("/**:\n  ros__parameters:\n    recorded_topics: !!python/tuple\n    - ''\n")
    check_files("hasel_driver", "/hasel/hasel_driver", ["--ros-args", "--params-file", str(file)])
