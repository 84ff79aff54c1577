"""`__version__` of a package, looked up when somebody asks: that takes as long as to import the package."""

from collections.abc import Callable


def lazy_version(package: str) -> Callable[[str], str]:
    """What a package takes as its `__getattr__`; of a package that was not installed the version is "unknown"."""

    def attribute(name: str) -> str:
        if name != "__version__":
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        from hasel_common.provenance import installed_version  # the while that it takes

        return installed_version(package)

    return attribute
