"""The examples of docs/python.md run as they stand there."""
import contextlib
import io
import os
import pathlib
import re
import unittest

SOURCE = pathlib.Path(os.environ["VOBENCH_SOURCE_DIR"])


def examples():
    return re.findall(r"^```python\n(.*?)^```$", (SOURCE / "docs/python.md").read_text(), re.M | re.S)


def run(code, names):
    printed = io.StringIO()
    with contextlib.chdir(SOURCE), contextlib.redirect_stdout(printed):
        exec(compile(code, "docs/python.md", "exec"), names)
    return printed.getvalue()


class Examples(unittest.TestCase):
    def test_run_one_after_the_other(self):
        names = {}
        own_test, own_arrays, frames = examples()
        self.assertLessEqual(len([line for line in own_test.splitlines() if line]), 10)
        run(own_test, names)
        # Independent errors are no drifting ones, but honest: the reference's band is the wider.
        self.assertTrue(run(own_arrays, names).startswith("consistent: ANEES / dof "))
        rmse, _ = map(float, run(frames, names).split())
        self.assertLess(rmse, 0.1)

    def test_the_consistency_test_rejects_half_the_covariance(self):
        own_test = examples()[0].replace("return self.filter.track(stamp_ns, ids, pixels)", "return halved(self.filter.track(stamp_ns, ids, pixels))")

        def halved(estimate):
            estimate.covariance = 0.5 * estimate.covariance
            return estimate
        with self.assertRaisesRegex(AssertionError, "ANEES mean, pose"):
            run(own_test, {"halved": halved})


if __name__ == "__main__":
    unittest.main()
