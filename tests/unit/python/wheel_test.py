"""The wheel is one: names, hashes and sizes are right, and what it unpacks to can be imported."""
import base64
import csv
import hashlib
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

import vobench

SOURCE = pathlib.Path(os.environ["VOBENCH_SOURCE_DIR"])


class Wheel(unittest.TestCase):
    def test_holds_what_it_says(self):
        with tempfile.TemporaryDirectory() as folder:
            package = pathlib.Path(vobench.__file__).parent
            made = subprocess.run([sys.executable, SOURCE / "tools/python/wheel.py", package, vobench.__version__, folder],
                                  check=True, capture_output=True, text=True).stdout.strip()
            self.assertRegex(pathlib.Path(made).name, rf"^vobench-{vobench.__version__}-cp3\d+-cp3\d+-linux_\w+\.whl$")
            unpacked = pathlib.Path(folder) / "unpacked"
            with zipfile.ZipFile(made) as wheel:
                wheel.extractall(unpacked)
            record = unpacked / f"vobench-{vobench.__version__}.dist-info/RECORD"
            rows = list(csv.reader(record.read_text().splitlines()))
            self.assertEqual(sorted(row[0] for row in rows), sorted(str(f.relative_to(unpacked)) for f in unpacked.rglob("*") if f.is_file()))
            for name, stated, size in rows[:-1]:
                data = (unpacked / name).read_bytes()
                self.assertEqual((stated, size), ("sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode(), str(len(data))))
            said = subprocess.run([sys.executable, "-c", "import vobench; print(vobench.__file__)"], check=True, capture_output=True, text=True,
                                  cwd=folder, env={**os.environ, "PYTHONPATH": str(unpacked)}).stdout
            self.assertEqual(said.strip(), str(unpacked / "vobench/__init__.py"))


if __name__ == "__main__":
    unittest.main()
