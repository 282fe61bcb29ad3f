"""No test lies in a folder without being built."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def forgotten(package):
    """The package's test sources that its CMakeLists.txt does not name."""
    named = set(re.findall(r"[\w/.]+_test\.cpp", (package / "CMakeLists.txt").read_text()))
    sources = {str(path.relative_to(package)) for path in package.glob("test/**/*_test.cpp")}
    return sorted(sources - named)


class RegisteredTest(unittest.TestCase):
    def test_every_test_is_named_in_its_package(self):
        packages = [path.parent for path in ROOT.glob("src/*/CMakeLists.txt")]
        self.assertTrue(any((package / "test").is_dir() for package in packages))
        found = {package.name: forgotten(package) for package in packages if forgotten(package)}
        self.assertEqual(found, {})
