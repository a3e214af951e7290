"""The Python examples of the docs run as they stand there."""
import contextlib
import io
import os
import pathlib
import re
import unittest

SOURCE = pathlib.Path(os.environ["VOBENCH_SOURCE_DIR"])


def examples(page):
    return re.findall(r"^```python\n(.*?)^```$", (SOURCE / page).read_text(), re.M | re.S)


def run(code, names):
    printed = io.StringIO()
    with contextlib.chdir(SOURCE), contextlib.redirect_stdout(printed):
        exec(compile(code, "an example", "exec"), names)
    return printed.getvalue()


def lines_of(code):
    return len([line for line in code.splitlines() if line])


class Examples(unittest.TestCase):
    def test_run_one_after_the_other(self):
        names = {}
        own_test, own_arrays, frames = examples("docs/python.md")
        self.assertLessEqual(lines_of(own_test), 10)
        self.assertEqual(examples("docs/consistency.md"), [own_test])
        run(own_test, names)
        # Independent errors are no drifting ones, but honest: the reference's band is the wider.
        self.assertTrue(run(own_arrays, names).startswith("consistent: ANEES / dof "))
        rmse, _ = map(float, run(frames, names).split())
        self.assertLess(rmse, 0.1)

    def test_own_odometry_on_images(self):
        (own_odometry,) = examples("docs/your_odometry.md")
        self.assertLessEqual(lines_of(own_odometry), 10)
        names = {}
        error = float(run(own_odometry, names))
        self.assertGreater(error, 0)  # it said that it stands still
        moved = max(sum((a - b) ** 2 for a, b in zip(truth.p_WC, names["truth"][0].p_WC)) ** 0.5 for truth in names["truth"])
        self.assertAlmostEqual(error, moved, places=9)

    def test_no_page_is_forgotten(self):
        pages = {str(page.relative_to(SOURCE)) for page in SOURCE.glob("docs/*.md") if examples(page)}
        self.assertEqual(pages, {"docs/python.md", "docs/consistency.md", "docs/your_odometry.md"})

    def test_the_consistency_test_rejects_half_the_covariance(self):
        own_test = examples("docs/consistency.md")[0].replace("return self.filter.track(stamp_ns, ids, pixels)", "return halved(self.filter.track(stamp_ns, ids, pixels))")

        def halved(estimate):
            estimate.covariance = 0.5 * estimate.covariance
            return estimate
        with self.assertRaisesRegex(AssertionError, "ANEES mean, pose"):
            run(own_test, {"halved": halved})


if __name__ == "__main__":
    unittest.main()
