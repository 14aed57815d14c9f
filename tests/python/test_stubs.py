"""patina.pyi names what the module has, no more and no less."""
import ast
import re
from pathlib import Path

import patina

STUBS = ast.parse((Path(patina.__file__).parent / "patina.pyi").read_text())


def arguments_of(function):
    arguments = function.args
    names = [argument.arg for argument in arguments.args + arguments.kwonlyargs]
    return [name for name in names if name != "self"]


def stubbed(body, prefix=""):
    names = {}
    for node in body:
        if isinstance(node, ast.ClassDef):
            names[node.name] = None
            names.update(stubbed(node.body, node.name + "."))
        elif isinstance(node, ast.FunctionDef):
            is_property = any(getattr(each, "id", "") == "property" for each in node.decorator_list)
            names[prefix + node.name] = None if is_property else arguments_of(node)
    return names


def bound_arguments(function):
    """From pybind11's signature, the first line of the documentation."""
    signature = function.__doc__.splitlines()[0]
    return [name for name in re.findall(r"(?:\(|, )(\w+): ", signature) if name != "self" and name != "arg0"]


def bound():
    names = {}
    for name, value in vars(patina).items():
        if name.startswith("__"):
            continue
        names[name] = bound_arguments(value) if callable(value) and not isinstance(value, type) else None
        if not isinstance(value, type) or issubclass(value, Exception):
            continue
        for member, held in vars(value).items():
            if isinstance(held, property):
                names[f"{name}.{member}"] = None
            elif (held.__doc__ or "").startswith(member + "("):
                names[f"{name}.{member}"] = bound_arguments(held)
    return names


def test_the_stubs_are_those_of_the_module():
    module, stubs = bound(), stubbed(STUBS.body)
    assert sorted(module) == sorted(stubs)
    for name, arguments in module.items():
        assert arguments == stubs[name], name
