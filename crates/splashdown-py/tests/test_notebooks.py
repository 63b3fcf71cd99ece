"""The notebooks in docs/notebooks, executed as they are.

With SPLASHDOWN_PICTURES=1 their figures replace those of the user guide.
"""

from __future__ import annotations

import ast
import os
import shutil
from pathlib import Path

import pytest
from conftest import REPOSITORY, optional

NOTEBOOKS = REPOSITORY / "docs/notebooks"
PICTURES = REPOSITORY / "docs/guide/src/pictures"


def executed(name: str) -> list[str]:
    """The texts of the outputs of a notebook."""
    optional("nbclient")
    optional("matplotlib")
    optional("pandas")
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "clear the outputs before you commit a notebook"
    figure = NOTEBOOKS / f"{name}.svg"
    try:
        place = {"metadata": {"path": str(NOTEBOOKS)}}
        NotebookClient(notebook, timeout=300, kernel_name="python3", resources=place).execute()
        assert figure.read_text().startswith("<?xml")
        if os.environ.get("SPLASHDOWN_PICTURES"):
            shutil.copy(figure, PICTURES / figure.name)
    finally:
        figure.unlink(missing_ok=True)
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    return [output["data"]["text/plain"] for output in outputs if output["output_type"] == "execute_result"]


def numbers(text: str) -> dict[str, float]:
    """A dictionary of NumPy numbers."""
    plain = text.replace("np.float64(", "").replace(")", "")
    found = ast.literal_eval(plain)
    assert isinstance(found, dict)
    return found


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_the_collapsing_column() -> None:
    deviations = numbers(executed("collapsing-column")[-1])
    # Ten particles across the column; the gates at full resolution are 10 % and 4 %.
    assert deviations["front"] < 0.10 and deviations["height"] < 0.08, deviations


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_viscosity() -> None:
    table = executed("viscosity")[-1]
    speeds = [float(line.split()[-1]) for line in table.splitlines()[1:]]
    assert len(speeds) == 4 and speeds == sorted(speeds, reverse=True) and speeds[0] > 1.5 * speeds[-1], table
