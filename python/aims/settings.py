# SPDX-License-Identifier: BSD-3-Clause
"""Settings given as dicts, as the texts that the program takes after --set."""

import json

from .errors import Error


def text_of(value, key):
    """The YAML of a value on one line: numbers, texts, bools, and lists or dicts of them."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    if hasattr(value, "tolist"):  # of NumPy
        return text_of(value.tolist(), key)
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (list, tuple)):
        try:
            return json.dumps(value)
        except TypeError as error:
            raise Error(f"{key}: expected numbers, texts, lists and dicts: {error}") from None
    raise Error(f"{key}: expected a number, a text, a bool or a list, got {type(value).__name__}")


def pairs(settings, prefix=""):
    """[("degeneracy.eta", "3.0"), ...] of {"degeneracy": {"eta": 3.0}} or {"degeneracy.eta": 3.0}."""
    found = []
    for key, value in (settings or {}).items():
        if not isinstance(key, str):
            raise Error(f"settings: expected texts as keys, got {key!r}")
        full = f"{prefix}{key}"
        if isinstance(value, dict):
            found += pairs(value, f"{full}.")
        else:
            found.append((full, text_of(value, full)))
    return found


def assignments(settings):
    """["degeneracy.eta=3.0", ...]"""
    return [f"{key}={value}" for key, value in pairs(settings)]


def specs(estimators):
    """The estimators of a call as LABEL=NAME+key=value: a name or spec, or a list or dict of them.

    In a dict, a key is a label and a value a name or a pair (name, settings).
    """
    if isinstance(estimators, str):
        return [estimators]
    if not isinstance(estimators, dict):
        return list(estimators)
    found = []
    for label, given in estimators.items():
        name, settings = given if isinstance(given, tuple) else (given, {})
        tail = "".join(f"+{key}={value}" for key, value in pairs(settings))
        found.append(f"{label}={name}{tail}" if label != name or tail else name)
    return found
