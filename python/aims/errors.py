# SPDX-License-Identifier: BSD-3-Clause
"""The errors of the package."""


class Error(ValueError):
    """Bad input: what was given, where, and what was expected, in the words of the program."""


class MissingPackage(ImportError):
    """A package that is not installed is needed for what was asked."""


def optional(name, debian, what):
    """The module `name`, or `MissingPackage`, which names the package that `what` needs."""
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError as error:
        top = name.split(".")[0]
        raise MissingPackage(
            f"{what} needs {top}, which cannot be imported ({error}); on Debian: apt install {debian}"
        ) from error
