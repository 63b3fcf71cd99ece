"""The examples in the docstrings, and that every public item has documentation with an example."""

from __future__ import annotations

import doctest
import inspect
from pathlib import Path

import numpy
import pytest
from conftest import column

import splashdown


def items() -> dict[str, object]:
    """The public classes and functions, and the methods of the classes."""
    found: dict[str, object] = {"splashdown": splashdown}
    for name in splashdown.__all__:
        item = getattr(splashdown, name)
        if isinstance(item, str):
            continue
        found[name] = item
        if inspect.isclass(item) and not issubclass(item, BaseException):
            for inner, value in vars(item).items():
                if not inner.startswith("_") and (inspect.isdatadescriptor(value) or callable(getattr(value, "__func__", value))):
                    found[f"{name}.{inner}"] = value
    return found


ITEMS = items()


@pytest.mark.parametrize("name", ITEMS)
def test_documentation(name: str, tmp_path: Path) -> None:
    item = ITEMS[name]
    text = inspect.getdoc(getattr(item, "__func__", item)) or ""
    assert text, f"{name} has no docstring"
    is_attribute = inspect.isgetsetdescriptor(item) or inspect.ismemberdescriptor(item) or not callable(
        getattr(item, "__func__", item)
    )
    is_exception = inspect.isclass(item) and issubclass(item, BaseException)
    if name != "splashdown" and not is_attribute and not is_exception:
        assert ">>>" in text, f"{name} has no example"
    names = {
        "splashdown": splashdown,
        "numpy": numpy,
        "folder": tmp_path,
        "scene": column(),
        "simulation": splashdown.Simulation(column(), device="cpu"),
    }
    test = doctest.DocTestParser().get_doctest(text, names, name, None, None)
    report: list[str] = []
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    runner.run(test, out=report.append)
    assert runner.failures == 0, "".join(report)


def test_the_list_of_items_is_complete() -> None:
    assert {"Scene.load", "Simulation.advance", "Simulation.positions", "sweep", "surface"} <= ITEMS.keys()
    public = {name for name in vars(splashdown) if not name.startswith("_")}
    assert public - {"annotations"} <= set(splashdown.__all__), "an item is missing in __all__"
