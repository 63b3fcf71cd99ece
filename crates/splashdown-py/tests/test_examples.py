"""The examples in the docstrings, and that every public item has one that uses it."""

from __future__ import annotations

import doctest
import inspect
import re
import types
import typing
from pathlib import Path

import pytest

import splashdown

def items(module: types.ModuleType) -> dict[str, object]:
    """The public classes, exceptions and functions of a module, and the methods and properties of the classes."""
    found: dict[str, object] = {}
    for name in module.__all__:
        item = getattr(module, name)
        if isinstance(item, str):
            continue
        found[name] = item
        if inspect.isclass(item):
            for inner, value in vars(item).items():
                is_item = inspect.isdatadescriptor(value) or callable(getattr(value, "__func__", value))
                if is_item and not inner.startswith("_"):
                    # The fields of a named tuple are in the example of the class.
                    found[f"{name}.{inner}"] = item if inner in getattr(item, "_fields", ()) else value
    return found


def documentation(item: object) -> str:
    return inspect.getdoc(getattr(item, "__func__", item)) or ""


def without_example(found: dict[str, object]) -> list[str]:
    """The items whose documentation has no example that uses them."""

    def uses(name: str) -> bool:
        examples = doctest.DocTestParser().get_examples(documentation(found[name]))
        tested = [example.source for example in examples if doctest.SKIP not in example.options]
        # A class without a constructor is used by an object of this name, such as `stats`.
        word = rf"\b{re.escape(name.split('.')[-1])}\b"
        return re.search(word, "".join(tested), re.IGNORECASE if inspect.isclass(found[name]) else 0) is not None

    return [name for name in found if not uses(name)]


ITEMS = items(splashdown)
#: Without the fields of named tuples, whose example is that of the class.
ITEMS_WITH_DOCUMENTATION = [name for name, item in ITEMS.items() if "." not in name or not inspect.isclass(item)]


@pytest.fixture(name="names", scope="module")
def names_fixture(tmp_path_factory: pytest.TempPathFactory) -> dict[str, object]:
    """What the documentation of the module defines for the examples."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("tempfile.mkdtemp", lambda: str(tmp_path_factory.mktemp("folder")))
        return run("splashdown", splashdown, {})


@pytest.mark.parametrize("name", ITEMS_WITH_DOCUMENTATION)
def test_example(name: str, names: dict[str, typing.Any], tmp_path: Path) -> None:
    fresh = {"simulation": splashdown.Simulation(names["scene"], device="cpu"), "folder": tmp_path}
    run(name, ITEMS[name], {**names, **fresh})


def run(name: str, item: object, names: dict[str, object]) -> dict[str, object]:
    """Runs the examples of an item; returns the names afterwards."""
    test = doctest.DocTestParser().get_doctest(documentation(item), names, name, None, None)
    report: list[str] = []
    runner = doctest.DocTestRunner()
    runner.run(test, out=report.append, clear_globs=False)
    assert runner.failures == 0, "".join(report)
    return test.globs


def test_every_item_has_an_example() -> None:
    assert {"Scene.load", "Simulation.advance", "Simulation.positions", "Stats.dt", "sweep", "ArrayError"} <= ITEMS.keys()
    assert without_example(ITEMS) == []
    public = {name for name in vars(splashdown) if not name.startswith("_")}
    assert public - {"annotations"} <= set(splashdown.__all__), "an item is missing in __all__"


def test_missing_examples_are_found() -> None:
    """Control: of this module, only one function, one method and one property have an example that uses them."""

    def function() -> None:
        """Does nothing.

        >>> function()
        """

    def unused() -> None:
        """Has an example of another function.

        >>> function()
        """

    def skipped() -> None:
        """Has an example that is not run.

        >>> skipped()  # doctest: +SKIP
        """

    class Class:
        """A class.

        >>> Class()
        """

        def method(self) -> None:
            """Does nothing.

            >>> Class().method()
            """

        def bare(self) -> None:
            """Does nothing."""

        @property
        def value(self) -> int:
            """A number.

            >>> Class().value
            1
            """
            return 1

        @property
        def other(self) -> int:
            return 2

    module = types.ModuleType("control")
    members = {"function": function, "unused": unused, "skipped": skipped, "Class": Class}
    vars(module).update(members, __all__=[*members])
    assert without_example(items(module)) == ["unused", "skipped", "Class.bare", "Class.other"]
