# SPDX-License-Identifier: BSD-3-Clause
import ast
import inspect
import pathlib
import subprocess
import sys

import aims
import pytest


def test_importing_needs_nothing_of_the_simulation():
    code = "import aims; print(open('/proc/self/maps').read())"
    maps = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = [name for name in ("mujoco", "embree", "sqlite", "pagmo", "cairo") if name in maps.stdout]
    assert loaded == []


def test_every_public_name_is_documented():
    for name in aims.__all__:
        thing = getattr(aims, name)
        assert name == "__version__" or inspect.getdoc(thing), name
        if not inspect.isclass(thing):
            continue
        for member, value in inspect.getmembers(thing):
            if member.startswith("_") or not (callable(value) or isinstance(value, property)):
                continue
            if thing.__module__.startswith("aims") and not issubclass(thing, Exception):
                assert inspect.getdoc(value), f"{name}.{member}"


def test_a_missing_package_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    trajectory = aims.Trajectory([0], [[0, 0, 0]], [[0, 0, 0, 1]])
    with pytest.raises(aims.MissingPackage, match="apt install python3-pandas"):
        trajectory.frame()


def test_the_package_is_marked_as_typed():
    assert (pathlib.Path(aims.__file__).parent / "py.typed").exists()


def declared(stub):
    """{"name" or "Class.name": [parameter, ...]} of a stub file."""
    found = {}

    def visit(nodes, prefix):
        for node in nodes:
            if isinstance(node, ast.ClassDef):
                found[prefix + node.name] = None
                visit(node.body, prefix + node.name + ".")
            elif isinstance(node, ast.FunctionDef):
                names = [each.arg for each in node.args.args]
                found[prefix + node.name] = names
            elif isinstance(node, ast.ImportFrom):
                found.update({each.asname: None for each in node.names if each.asname})

    visit(ast.parse(stub.read_text()).body, "")
    return found


def test_the_stubs_declare_what_there_is():
    folder = pathlib.Path(aims.__file__).parent
    stubs = declared(folder / "__init__.pyi")
    assert set(aims.__all__) <= set(stubs)
    for name, parameters in stubs.items():
        thing = aims
        for part in name.split("."):
            thing = getattr(thing, part)
        if parameters is None or isinstance(thing, property):
            continue
        there = [each for each in inspect.signature(thing).parameters]
        assert there == [each for each in parameters if each not in ("cls",)], name


def test_the_stubs_of_the_extension_modules_name_what_they_have():
    from aims import _core, _sim

    for module in (_core, _sim):
        stub = pathlib.Path(aims.__file__).parent / f"{module.__name__.split('.')[1]}.pyi"
        for name in declared(stub):
            thing = module
            for part in name.split("."):
                assert hasattr(thing, part), name
                thing = getattr(thing, part)
