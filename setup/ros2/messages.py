# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Messages from and to YAML, as `ros2 topic` writes them."""

import array
from importlib import import_module
from typing import Any

import numpy as np
import yaml


class NotUnderstoodError(Exception):
    """What was typed cannot be used; the message says what was expected."""


def interface(name: str, kind: str) -> type:
    """The class of `package/kind/Name` or `package/Name`. kind: msg, srv or action. Raises NotUnderstoodError."""
    package, _, last = name.strip("/").partition("/")
    try:
        return getattr(import_module(f"{package}.{kind}"), last.rpartition("/")[2])
    except (ImportError, AttributeError, ValueError):
        raise NotUnderstoodError(
            f"There is no {kind} '{name}'; expected a built one such as hasel_interfaces/{kind}/…"
        ) from None


def filled(message: Any, text: str) -> Any:
    """The message with the values of a YAML text such as "{voltage: [4000, 0]}". Raises NotUnderstoodError."""
    try:
        values = yaml.safe_load(text) if text.strip() else {}
    except yaml.YAMLError as error:
        raise NotUnderstoodError(f"'{text}' is no YAML ({str(error).splitlines()[0]})") from None
    _fill(message, {} if values is None else values)
    return message


def _fill(message: Any, values: Any) -> None:
    fields = message.get_fields_and_field_types()
    if not isinstance(values, dict):
        raise NotUnderstoodError(
            f"found {values!r}; expected the fields {', '.join(fields)} as {{name: value}}"
        )
    for name, value in values.items():
        if name not in fields:
            raise NotUnderstoodError(
                f"there is no field '{name}'; expected one of {', '.join(fields) or 'none'}"
            )
        _fill_field(message, name, value, fields[name])


def _fill_field(message: Any, name: str, value: Any, kind: str) -> None:
    present = getattr(message, name)
    if hasattr(present, "get_fields_and_field_types"):
        _fill(present, value)
        return
    if isinstance(value, list) and "/" in kind:
        member = interface(kind.removeprefix("sequence<").split("[")[0].split(",")[0].rstrip(">"), "msg")
        value = [filled(member(), yaml.safe_dump(each)) for each in value]
    try:
        setattr(message, name, _number_as(present, value))
    except (AssertionError, TypeError, ValueError, OverflowError):
        raise NotUnderstoodError(f"{name}: {value!r} was given; expected {kind}") from None


def _number_as(present: Any, value: Any) -> Any:
    """Whole numbers as floats where floats are meant."""
    if isinstance(present, np.ndarray):
        return np.array(value, dtype=present.dtype)
    if isinstance(present, float) and isinstance(value, int):
        return float(value)
    if isinstance(present, array.array) and present.typecode in "fd":
        return [float(each) for each in value]
    return value


def plain(value: Any) -> Any:
    """A message as dictionaries, lists and numbers."""
    if hasattr(value, "get_fields_and_field_types"):
        return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if isinstance(value, (np.ndarray, array.array, list, tuple)):
        return [plain(each) for each in value]
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else list(value)
    return value.item() if isinstance(value, np.generic) else value


def as_yaml(message: Any, field: str | None = None) -> str:
    """A message, or one field of it such as `header.stamp`, as YAML. Raises NotUnderstoodError."""
    value = plain(message)
    for part in field.split(".") if field else ():
        if not isinstance(value, dict) or part not in value:
            raise NotUnderstoodError(f"there is no field '{field}'")
        value = value[part]
    text = yaml.safe_dump(value, sort_keys=False, allow_unicode=True)
    return text.removesuffix("...\n")
