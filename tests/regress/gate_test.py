"""What the gate says of figures that it is given: gate_test.py; the figures themselves are measured by bench/regress.sh."""
import contextlib
import io
import os
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench/regress"))
import baselines
import measure
import regress
import report
import sources

BARE = {"bare: instructions per step": ("count", 1000000), "bare: heap allocations per step": ("exact", 0),
        "bare: first-level misses per step": ("misses", 1000), "study bar: period": ("value", 2.0),
        "study bar: damping": ("error", 0.1)}
FUNCTIONS = {"bare": {"scatter": 600000, "gather": 399000, "seldom": 1000}}


class Gate(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.where = os.path.join(self.folder.name, "baselines")

    def call(self, figures=None, functions=None, *words):
        """Exit code and text of a run that measures these."""
        told = io.StringIO()
        command = ["regress", "gate", "program", "--no-timer", "library", "--baselines", self.where, *words]
        made = ({**BARE, **(figures or {})}, functions or FUNCTIONS, {})
        with unittest.mock.patch.object(regress, "measure_all", return_value=made), \
                unittest.mock.patch.object(sys, "argv", command), \
                contextlib.redirect_stdout(told), contextlib.redirect_stderr(told):
            return regress.main(), told.getvalue()

    def accept(self, *, figures=None, functions=None, reason="first"):
        code, told = self.call(figures, functions, "--accept", reason)
        self.assertEqual(code, 0, told)

    def test_nothing_was_accepted(self):
        code, told = self.call()
        self.assertEqual(code, 2)
        self.assertIn("--accept", told)

    def test_the_same_again(self):
        self.accept()
        code, told = self.call()
        self.assertEqual(code, 0, told)
        self.assertRegex(told, r"(\d+) of \1 figures as before")

    def test_what_is_worse(self):
        self.accept()
        for figure, worse, fine in (("bare: instructions per step", ("count", 1002100), ("count", 1001900)),
                                    ("bare: heap allocations per step", ("exact", 1), ("exact", 0)),
                                    ("bare: first-level misses per step", ("misses", 1011), ("misses", 1009)),
                                    ("study bar: period", ("value", 1.97), ("value", 1.985)),
                                    ("study bar: damping", ("error", 0.103), ("error", 0.05))):
            with self.subTest(figure):
                code, told = self.call({figure: worse})
                self.assertEqual(code, 1)
                self.assertRegex(told, "(?m)^worse +" + figure)
                self.assertEqual(self.call({figure: fine})[0], 0)

    def test_a_function_that_grew_hides_in_no_whole(self):
        self.accept()
        code, told = self.call(functions={"bare": {"scatter": 593000, "gather": 406000, "seldom": 1000}})
        self.assertEqual(code, 1)
        self.assertRegex(told, r"(?m)^worse +bare: instructions of gather.*\+1\.75 %")
        seldom = {"bare": {"scatter": 600000, "gather": 399000, "seldom": 2000}}
        self.assertEqual(self.call(functions=seldom)[0], 0)

    def test_figures_that_are_new_or_gone(self):
        self.accept(figures={"bare: blocks": ("exact", 7)})
        code, told = self.call({"bare: sorts": ("exact", 1)})
        self.assertEqual(code, 1)
        self.assertRegex(told, "(?m)^gone +bare: blocks")
        self.assertRegex(told, "(?m)^new +bare: sorts")

    def test_on_another_processor_it_may_only_tell(self):
        self.accept()
        worse = {"bare: heap allocations per step": ("exact", 1)}
        self.assertEqual(self.call(worse, None, "--tell-elsewhere")[0], 1)
        with unittest.mock.patch.object(baselines, "processor", return_value="another"):
            self.assertEqual(self.call(worse)[0], 1)
            code, told = self.call(worse, None, "--tell-elsewhere")
        self.assertEqual(code, 0)
        self.assertRegex(told, "(?m)^worse +bare: heap allocations")
        self.assertIn("another processor", told)

    def test_the_log_keeps_every_reason(self):
        self.accept()
        self.accept(figures={"bare: instructions per step": ("count", 900000)}, reason="weights stay in registers")
        log = pathlib.Path(self.where, "log.md").read_text()
        self.assertIn(": first\n", log)
        self.assertIn("weights stay in registers\n\n- bare: instructions per step: 1000000 -> 900000 (-10.00 %)", log)
        self.assertEqual([value for _, value in baselines.read_history(self.where)["bare: instructions per step"]],
                         ["1000000", "900000"])

    def test_history_says_how_far(self):
        count = lambda *changes: baselines.allowed(baselines.Figure("count", "1", list(changes)))
        self.assertEqual(count(), 0.002)
        self.assertEqual(count(1e-4, 1e-4, 1e-4, 1e-4), 0.002)
        self.assertAlmostEqual(count(0.0010, 0.0015, 0.0020, 0.0025), 0.002375 + 3 * 0.00125)  # quartiles
        self.assertEqual(count(0.01, 0.02, 0.03, 0.04), 0.01)
        self.assertEqual(baselines.allowed(baselines.Figure("exact", "1", [1.0] * 9)), 0.0)


# A program whose steps take a known processor time.
BURNS = """#!{python}
import sys, time
if "--json" in sys.argv:
    open(sys.argv[sys.argv.index("--json") + 1], "w").write('{{"ns_per_particle_step": {step}}}')
elif {fails}:
    sys.exit("no scene")
else:
    steps = int(sys.argv[sys.argv.index("--steps") + 1])
    end = time.process_time() + {step} * 1e-4 * steps
    while time.process_time() < end:
        pass
"""


class Pairs(unittest.TestCase):
    def call(self, base, head, fails=False):
        """Of programs whose steps take so much."""
        told = io.StringIO()
        with tempfile.TemporaryDirectory() as folder:
            programs = []
            for name, step in (("base", base), ("head", head)):
                programs.append(os.path.join(folder, name))
                pathlib.Path(programs[-1]).write_text(BURNS.format(python=sys.executable, step=step, fails=fails))
                os.chmod(programs[-1], 0o755)
            command = ["regress", "ab", *programs, "--only", "bare", "--pairs", "3"]
            with unittest.mock.patch.object(sys, "argv", command), contextlib.redirect_stdout(told), \
                    contextlib.redirect_stderr(told):
                return regress.main(), told.getvalue()

    def test_what_is_slower(self):
        code, told = self.call(1.0, 1.2)
        self.assertEqual(code, 1, told)
        self.assertRegex(told, r"\| bare \| 1\.\d+ \| .* \| slower \| 1\.20, 1\.20 \| 1\.00, 1\.00 on ")

    def test_what_is_faster_or_the_same(self):
        for head in (1.0, 0.8):
            code, told = self.call(1.0, head)
            self.assertEqual(code, 0, told)
            self.assertIn("| no slower |", told)

    def test_what_fails_is_not_measured(self):
        code, told = self.call(1.0, 1.0, True)
        self.assertEqual(code, 2)
        self.assertIn("no scene", told)


class Sources(unittest.TestCase):
    DIFFERENCE = ("--- a/kernels/pass/particles.cpp\n+++ b/kernels/pass/particles.cpp\n@@ -87 +87,2 @@ void advance\n-old\n+new\n"
                  "+newer\n@@ -120,3 +121,0 @@\n-gone\n--- a/gone.cpp\n+++ /dev/null\n@@ -1,2 +0,0 @@\n-x\n")

    def test_which_lines_have_changed(self):
        changed = sources.of_difference(self.DIFFERENCE)
        self.assertEqual(changed, {"kernels/pass/particles.cpp": {87, 88, 121}})
        self.assertEqual(sources.spans(changed["kernels/pass/particles.cpp"]), "87 to 88, 121")
        self.assertTrue(sources.is_changed("../../kernels/pass/particles.cpp:88", changed))
        self.assertTrue(sources.is_changed("/somewhere/kernels/pass/particles.cpp:87", changed))
        self.assertFalse(sources.is_changed("kernels/pass/particles.cpp:89", changed))
        self.assertFalse(sources.is_changed("other_kernels/pass/particles.cpp.h:88", changed))

    def test_they_are_told_first(self):
        lines = {"a.cpp:5 in advance": 9000, "kernels/pass/particles.cpp:88 in advance": 10, "b.cpp:1 in gather": 99999}
        found = report.lines_of("advance", lines, sources.of_difference(self.DIFFERENCE))
        self.assertEqual(found, [(True, 10, "kernels/pass/particles.cpp:88"), (False, 9000, "a.cpp:5")])


class Callgrind(unittest.TestCase):
    def test_what_is_called_counts_for_itself(self):
        with tempfile.NamedTemporaryFile("w", suffix=".callgrind") as file:
            file.write("events: Ir Bc\n\nfl=(1) pass.cpp\nfn=(1) repose::scatter(int)\n10 5 1\n+2 7 2\n"
                       "cfn=(2) inner\ncalls=3 40\n* 900 9\n* 1 0\n\nfn=(2)\n40 300 3\n")
            file.flush()
            functions, lines = measure.read_callgrind(file.name)
        self.assertEqual(functions["scatter(int)"], {"Ir": 13, "Bc": 3})
        self.assertEqual(functions["inner"], {"Ir": 300, "Bc": 3})
        self.assertEqual(lines["pass.cpp:12 in scatter(int)"]["Ir"], 8)

    def test_only_what_steps_took(self):
        self.assertEqual(measure.per_step({"scatter": {"Ir": 1300}, "once": {"Ir": 50}},
                                          {"scatter": {"Ir": 500}, "once": {"Ir": 50}}, 8), {"scatter": {"Ir": 100}})


if __name__ == "__main__":
    unittest.main()
