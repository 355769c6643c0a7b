"""Asks `measure` and compares its answers with NumPy, SciPy, statsmodels and scikit-learn.

    python tests/independent/run.py PROGRAM [WORD]

PROGRAM is the built example `independent` of the crate `measure`; with a WORD only cases whose name holds it. Prints a
line per case and at the end `# pass N` and `# fail N`, as `node --test` does.

A case is tried twice: with the answer, and with each number of the answer changed a little beyond the tolerance, one
after the other. A case that does not notice is blind, and fails.
"""

import copy
import importlib
import json
import math
import pathlib
import subprocess
import sys
import warnings

from case import Case

CASES = pathlib.Path(__file__).parent / "cases"


def cases():
    """Every case of every file in `cases`."""
    for file in sorted(CASES.glob("*.py")):
        for case in importlib.import_module(f"cases.{file.stem}").cases():
            case.name = f"{file.stem}: {case.name}"
            yield case


def difference(found, expected, case: Case, place=""):
    """What differs first, or None."""
    if isinstance(expected, dict):
        if not isinstance(found, dict) or (missing := expected.keys() - found.keys()):
            return f"{place}: found {found!r:.200}, expected the keys {sorted(expected)}"
        pairs = ((found[key], value, f"{place}.{key}") for key, value in expected.items())
    elif isinstance(expected, (list, tuple)):
        if not isinstance(found, list) or len(found) != len(expected):
            return f"{place}: found {found!r:.200}, expected {len(expected)} values"
        pairs = ((a, b, f"{place}[{i}]") for i, (a, b) in enumerate(zip(found, expected)))
    elif isinstance(expected, float) and isinstance(found, (int, float)) and not isinstance(found, bool):
        return None if case.equal(found, expected) else f"{place}: found {found!r}, expected {expected!r}"
    else:
        return None if found == expected else f"{place}: found {found!r:.200}, expected {expected!r:.200}"
    return next((problem for pair in pairs if (problem := difference(*pair[:2], case, pair[2]))), None)


def numbers(expected, place=()):
    """The places of all numbers that are compared."""
    if isinstance(expected, dict):
        for key, value in expected.items():
            yield from numbers(value, (*place, key))
    elif isinstance(expected, (list, tuple)):
        for i, value in enumerate(expected):
            yield from numbers(value, (*place, i))
    elif isinstance(expected, float):
        yield place


def blind(answer, case: Case):
    """The first number that can be wrong without being noticed, or None."""
    for place in numbers(case.expected):
        twin = [copy.deepcopy(answer)]
        inside, key = twin, 0
        for step in place:
            inside, key = inside[key], step
        inside[key] = case.broken(inside[key])
        if difference(twin[0], case.expected, case) is None:
            return place
    return None


def main():
    program, *words = sys.argv[1:]
    warnings.simplefilter("ignore")
    chosen = [case for case in cases() if all(word in case.name for word in words)]
    asked = json.dumps([{"call": case.call, "with": case.given} for case in chosen])
    done = subprocess.run([program], input=asked, capture_output=True, text=True, check=True)
    answers = json.loads(done.stdout)
    failed = 0
    for number, (case, answer) in enumerate(zip(chosen, answers, strict=True), 1):
        answer = answer if case.of is None or (isinstance(answer, dict) and "refused" in answer) else case.of(answer)
        problem = difference(answer, case.expected, case)
        if problem is None and (place := blind(answer, case)) is not None:
            problem = f"{place}: a wrong number was not noticed"
        failed += problem is not None
        print(f"{'not ok' if problem else 'ok'} {number} - {case.name}" + (f"\n    {problem}" if problem else ""))
    print(f"# pass {len(chosen) - failed}\n# fail {failed}")
    return 1 if failed or not chosen else 0


if __name__ == "__main__":
    sys.exit(main())
