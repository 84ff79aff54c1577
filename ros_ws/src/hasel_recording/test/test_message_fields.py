import pytest
from hasel_interfaces.msg import Fit, NamedParameter, SupplyState
from hasel_recording import RecordingError
from hasel_recording.message_fields import nanoseconds, plain_fields, stamp, type_of


def test_ros_message_becomes_plain_values():
    """Arrays of numbers and nested messages come out as lists and dicts."""
    fit = Fit(model="swimmer", effects=["drag"], parameters=[NamedParameter(name="slope", value=2.0)])
    fields = plain_fields(fit, type_of(fit))
    assert fields["parameters"][0]["value"] == 2.0
    assert fields["effects"] == ["drag"]
    assert plain_fields(SupplyState(current=[1.0, 2.0]), "hasel_interfaces/msg/SupplyState")["current"] == [
        1.0,
        2.0,
    ]


def test_stamp_before_zero_goes_there_and_back():
    """A time before zero has negative seconds and positive nanoseconds."""
    fields = stamp(-295_674_500)
    assert fields == {"sec": -1, "nanosec": 704_325_500}

    class Time:
        sec, nanosec = fields["sec"], fields["nanosec"]

    assert nanoseconds(Time) == -295_674_500


def test_misspelt_field_names_the_nearest():
    """A field that the type does not have is named, with the one that was meant."""
    with pytest.raises(RecordingError, match="no field 'sec_': did you mean sec"):
        plain_fields({"sec_": 1, "nanosec": 0}, "builtin_interfaces/msg/Time")


def test_missing_field_is_not_filled_in():
    """A mapping must give every field; nothing becomes zero unasked."""
    with pytest.raises(RecordingError, match="without nanosec"):
        plain_fields({"sec": 1}, "builtin_interfaces/msg/Time")


def test_array_of_wrong_length():
    """A pair of contacts given as three is refused."""
    message = plain_fields(SupplyState(), "hasel_interfaces/msg/SupplyState") | {"interlock": [1, 1, 1]}
    with pytest.raises(RecordingError, match="Found 3 values"):
        plain_fields(message, "hasel_interfaces/msg/SupplyState")
