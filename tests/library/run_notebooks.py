"""run_notebooks.py NOTEBOOK…: runs the code cells of notebooks and compares what they say with what is stored.

A cell says what it prints and, of its last line, the value of an expression, as Jupyter has it. With
PALPATE_WRITE_PAGES set what they say is stored. No Jupyter is needed.
"""

import ast
import contextlib
import io
import json
import os
import sys
from pathlib import Path


def said_by(source: str, names: dict) -> tuple[str, str]:
    """What a cell prints, and the value of its last expression."""
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    printed, value = io.StringIO(), ""
    with contextlib.redirect_stdout(printed):
        exec(compile(tree, "cell", "exec"), names)
        if last is not None:
            result = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
            value = "" if result is None else repr(result)
    return printed.getvalue(), value


def outputs_of(printed: str, value: str, count: int) -> list[dict]:
    outputs: list[dict] = []
    if printed:
        outputs.append({"name": "stdout", "output_type": "stream", "text": printed.splitlines(keepends=True)})
    if value:
        outputs.append({"data": {"text/plain": value.splitlines(keepends=True)}, "execution_count": count,
                        "metadata": {}, "output_type": "execute_result"})
    return outputs


def run(path: Path) -> bool:
    notebook = json.loads(path.read_text())
    names: dict = {"__name__": "__main__"}
    same, count = True, 0
    for cell in notebook["cells"]:
        if cell["cell_type"] != "code":
            continue
        count += 1
        outputs = outputs_of(*said_by("".join(cell["source"]), names), count)
        if outputs != cell["outputs"]:
            same = False
            print(f"{path.name}, cell {count} says\n{json.dumps(outputs, indent=1)}\nand is stored with\n"
                  f"{json.dumps(cell['outputs'], indent=1)}")
        cell["execution_count"], cell["outputs"] = count, outputs
    if os.environ.get("PALPATE_WRITE_PAGES"):
        path.write_text(json.dumps(notebook, indent=1, sort_keys=True, ensure_ascii=False) + "\n")
        return True
    print(f"{path.name}: {count} cells")
    return same and count > 0


sys.exit(0 if all([run(Path(name)) for name in sys.argv[1:]]) and len(sys.argv) > 1 else 1)
