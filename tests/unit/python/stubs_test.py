"""Every public name has a stub with the same members and arguments, and documentation; and no stub is of a name that is gone."""
import ast
import pathlib
import re
import unittest

import vobench


def stubs():
    """{"name" or "Class.member": [argument names of each overload] or None for what is no function}"""
    tree = ast.parse((pathlib.Path(vobench.__file__).parent / "__init__.pyi").read_text())
    found = {}

    def add(prefix, node):
        if isinstance(node, ast.FunctionDef):
            arguments = [a.arg for a in node.args.posonlyargs + node.args.args + node.args.kwonlyargs if a.arg != "self"]
            is_property = any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)
            if is_property:
                found[prefix + node.name] = None
            else:
                found.setdefault(prefix + node.name, []).append(arguments)
        elif isinstance(node, ast.AnnAssign):
            found[prefix + node.target.id] = None
        elif isinstance(node, ast.ClassDef):
            if any(isinstance(base, ast.Name) and base.id == "Protocol" for base in node.bases):
                return  # of the stubs alone
            found[prefix + node.name] = None
            for member in node.body:
                add(node.name + ".", member)
    for node in tree.body:
        add("", node)
    return found


def real():
    found = {}
    for name in vobench.__all__:
        thing = getattr(vobench, name)
        found[name] = signatures(thing) if callable(thing) and not isinstance(thing, type) else None
        if isinstance(thing, type) and not issubclass(thing, Exception):
            for member, value in vars(thing).items():
                shown = not member.startswith("_") or member in ("__init__", "__len__", "__iter__", "__next__", "__bool__")
                if shown and (member != "__init__" or signatures(value)):  # without one, instances come from elsewhere
                    value = getattr(thing, member) if isinstance(value, staticmethod) else value
                    found[f"{name}.{member}"] = None if isinstance(value, property) else signatures(value)
    return found


def signatures(function):
    """Names of the arguments, as pybind11 writes them into the documentation."""
    lines = re.findall(rf"^(?:\d+\. )?{function.__name__}\((.*)\) -> ", function.__doc__ or "", re.M)
    return [[n for n in re.findall(r"(?:^|, )(\w+)(?=: )", re.sub(r"\[[^][]*(\[[^][]*\])*[^][]*\]", "", line)) if n != "self"] for line in lines]


class Stubs(unittest.TestCase):
    def test_are_those_of_the_module(self):
        written, there = stubs(), real()
        self.assertEqual(sorted(there), sorted(written))
        for name, overloads in there.items():
            unnamed = name.endswith(("__len__", "__iter__", "__next__", "__bool__"))
            if overloads is not None and not unnamed:
                self.assertEqual(overloads, written[name] if not same_frames(name) else [["frame"]] + written[name], name)
        self.assertGreater(len(there), 120)

    def test_everything_is_documented(self):
        for name in vobench.__all__:
            thing = getattr(vobench, name)
            if callable(thing):
                said = re.sub(r"\w+\(.*\) -> .*", "", thing.__doc__ or "").strip()
                self.assertGreater(len(said), 20, name)

    def test_the_words_are_those_of_the_headers(self):
        self.assertIn("renders the frames of a scenario with exact truth", vobench.Simulator.__doc__)
        self.assertIn("mid-exposure", vobench.Frame.stamp_ns.__doc__)


def same_frames(name):
    """One overload for frames in the stub is two in C++: rendered and read ones."""
    return name == "Odometry.track"


if __name__ == "__main__":
    unittest.main()
