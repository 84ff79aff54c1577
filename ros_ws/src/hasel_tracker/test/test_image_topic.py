"""Images that a topic lost."""

from types import SimpleNamespace

from hasel_tracker.image_topic import ImageTopic


def test_images_that_never_came_are_counted():
    """Of 601 images at 60 per second every third is lost on the way: the gaps in the stamps tell how many."""
    topic = ImageTopic(SimpleNamespace(create_timer=lambda *_: None), "/camera/image_raw", lambda: None)
    for index in range(601):
        if index % 3 != 2:
            topic._count_lost(round(index * 1e9 / 60))
    assert topic.lost == 200
