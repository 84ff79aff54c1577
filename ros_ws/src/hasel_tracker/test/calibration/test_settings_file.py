import pytest
from hasel_tracker.calibration.settings_file import load_settings, save_settings, settings_from
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.colour_gate import ColourRange
from hasel_tracker.tracking.tracker_settings import TrackerSettings


def test_saved_and_loaded(tmp_path):
    """A settings file gives back the same settings."""
    settings = TrackerSettings(ColourRange(40, 80, 60, 20), marker_radius_px=9.5, head="right", edge_px=5)
    save_settings(settings, tmp_path / "markers.yaml")
    assert load_settings(tmp_path / "markers.yaml") == settings


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("/**: {ros__parameters: {hue_lo: 3}}", "'hue_lo', which is not known; did you mean 'hue_low'"),
        ("/**: {ros__parameters: {head: north}}", "expected auto, left, right"),
        ("/**: {ros__parameters: {hue_low: abc}}", "wrong kind"),
        ("just text", "not a ROS 2 parameter file"),
    ],
)
def test_wrong_files_are_explained(tmp_path, text, message):
    """Unknown names, impossible values and other files are each explained."""
    path = tmp_path / "markers.yaml"
    path.write_text(text)
    with pytest.raises(TrackerError, match=message):
        load_settings(path)


def test_impossible_sizes_are_refused():
    """Contradicting sizes are named with what is expected."""
    with pytest.raises(TrackerError, match="0 < smallest < largest"):
        settings_from({"smallest_radius_px": 70.0})
    with pytest.raises(TrackerError, match="expected at least 2 px each"):
        settings_from({"edge_px": 1})
