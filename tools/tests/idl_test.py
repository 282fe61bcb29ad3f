"""Tests of idl/idl_to_schema.py: what it reads, and that it refuses what it does not know."""

import pathlib
import sys
import tempfile
import unittest

IDL = pathlib.Path(__file__).resolve().parents[2] / "idl"
sys.dont_write_bytecode = True
sys.path.insert(0, str(IDL))
import idl_to_schema  # noqa: E402

GOOD = """
module demo {
  module msg {
    module Light_Constants {
      const uint8 COLOUR_RED = 0;     // stop
      const uint8 COLOUR_GREEN = 2;
      const uint8 COLOUR_MIX_NONE = 1;
    };
    // A light.
    @extensibility(FINAL)
    struct Light {
      uint8 colour;         // what it shows
      uint8 colour_mix;     // how it mixes
      sequence<double> at;  // [s]
    };
  };
};
"""


def parse(text):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "demo.idl"
        path.write_text(text, encoding="utf-8")
        return idl_to_schema.parse_file(str(path))


class Constants(unittest.TestCase):
    def test_they_belong_to_the_field_that_their_name_begins_with(self):
        light, = parse(GOOD)
        self.assertEqual((light.name, light.comment), ("demo/msg/Light", "A light."))
        self.assertEqual([[(c.name, c.value, c.comment) for c in f.constants] for f in light.fields],
                         [[("COLOUR_RED", 0, "stop"), ("COLOUR_GREEN", 2, "")],
                          [("COLOUR_MIX_NONE", 1, "")], []])

    def test_they_are_emitted_with_their_field(self):
        text = idl_to_schema.emit(*idl_to_schema.order(parse(GOOD)))
        self.assertIn('kConstants0_0[] = {{"COLOUR_RED", 0}, {"COLOUR_GREEN", 2}};', text)
        self.assertIn('"what it shows", kConstants0_0},', text)
        self.assertIn('"[s]", {}},', text)

    def test_what_is_wrong_is_named_with_file_and_line(self):
        for words, old, new in [
                ("begins with the name of no field", "COLOUR_RED", "SHAPE_ROUND"),
                ("repeats the value 0", "COLOUR_GREEN = 2", "COLOUR_GREEN = 0"),
                ("its field colour is not", "uint8 colour;", "double colour;"),
                ("is not a constant like", "COLOUR_RED = 0", "COLOUR_RED = -1"),
                ("is not a constant like", "COLOUR_RED = 0", "colour_red = 0"),
                ("no struct demo/msg/Lamp", "Light_Constants", "Lamp_Constants"),
                ("is not understood", "  module msg {", "  enum Kind { A };\n  module msg {"),
                ("is not closed", "};\n};\n", "};\n")]:
            with self.subTest(new):
                with self.assertRaisesRegex(SystemExit, r"demo\.idl:\d+: .*" + words):
                    parse(GOOD.replace(old, new, 1))


class OwnMessages(unittest.TestCase):
    def test_every_octet_with_a_fixed_meaning_has_constants(self):
        structs = idl_to_schema.parse_file(str(IDL / "goshawk_msgs.idl"))
        named = {(s.name.rsplit("/", 1)[1], f.name)
                 for s in structs for f in s.fields if f.constants}
        self.assertLessEqual({("StageReport", "stage"), ("NavigatorState", "state"),
                              ("TrackingState", "mode"), ("ParameterRequest", "verb"),
                              ("ParameterAnswer", "verb"), ("VehicleStatus", "control"),
                              ("MissionState", "state"), ("OperatorCommand", "verb"),
                              ("GuardVerdict", "kind"), ("GuardVerdict", "verdict")}, named)


if __name__ == "__main__":
    unittest.main()
