"""The packages keep to the levels of docs/architecture.md: no dependency points up."""

import pathlib
import re
import unittest
import xml.etree.ElementTree as ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def levels(text):
    """{package: level} from the page's list, whose lines may continue without a level."""
    found, level = {}, None
    for line in text.splitlines():
        match = re.match(r"    (?:L(\d)\s+)?([a-z0-9_ ]+)$", line)
        if not match:
            continue
        level = int(match.group(1)) if match.group(1) else level
        for name in match.group(2).split():
            found[name] = level
    return found


def short(name):
    return name.removeprefix("goshawk_")


def dependencies(package):
    """Our own packages that a package.xml names, tests included."""
    tree = ElementTree.parse(package).getroot()
    names = [element.text.strip() for element in tree if element.tag.endswith("depend")]
    return {short(name) for name in names if name.startswith("goshawk_")}


def graph():
    files = [*ROOT.glob("src/*/package.xml"), ROOT / "idl/package.xml"]
    return {short(ElementTree.parse(f).getroot().findtext("name").strip()): dependencies(f)
            for f in files}


def includes(package):
    """Our own packages whose headers a package's product code includes."""
    folder = ROOT / "src" / f"goshawk_{package}"
    found = set()
    for path in folder.rglob("*.[ch]pp"):
        if "test" in path.relative_to(folder).parts:
            continue
        found |= set(re.findall(r'#include "goshawk/([a-z0-9_]+)/', path.read_text()))
    return found - {package}


def components():
    """{component: the package that has it}"""
    return {name: short(path.parent.name) for path in ROOT.glob("src/*/CMakeLists.txt")
            for name in re.findall(r"goshawk_component\(NAME ([a-z0-9_]+)", path.read_text())}


class LevelsTest(unittest.TestCase):
    def setUp(self):
        self.levels = levels((ROOT / "docs/architecture.md").read_text())
        self.graph = graph()

    def reachable(self, package):
        seen, new = set(), {package}
        while new:
            seen |= new
            new = set().union(*(self.graph.get(p, set()) for p in new)) - seen
        return seen

    def test_every_package_has_a_level(self):
        self.assertEqual(set(self.graph), set(self.levels))

    def test_no_dependency_points_up(self):
        up = [(package, other) for package, others in self.graph.items() for other in others
              if self.levels[other] > self.levels[package]]
        self.assertEqual(up, [])

    def test_no_package_depends_on_itself(self):
        for package, others in self.graph.items():
            for other in others:
                self.assertNotIn(package, self.reachable(other), f"{package} -> {other}")

    def test_every_include_is_a_declared_dependency(self):
        for package in self.graph:
            undeclared = (includes(package) & set(self.graph)) - self.reachable(package)
            self.assertEqual(undeclared, set(), package)

    def test_every_component_of_a_launch_file_is_a_declared_dependency(self):
        owners = components()
        for path in ROOT.glob("src/goshawk_*/launch/*.yaml"):
            package = short(path.parts[-3])
            used = set(re.findall(r"component: *([a-z0-9_]+)", path.read_text()))
            needed = {owners[component] for component in used} - {package}
            self.assertEqual(needed - self.reachable(package), set(), path)

    def test_an_arrow_that_points_up_is_found(self):
        self.graph["core"] = {"cli"}
        with self.assertRaises(AssertionError):
            self.test_no_dependency_points_up()


if __name__ == "__main__":
    unittest.main()
