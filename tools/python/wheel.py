"""Packs the package folder as a wheel: wheel.py FOLDER VERSION OUT. It is for this Python and this system's libraries, no other."""
import base64
import hashlib
import pathlib
import sys
import sysconfig
import zipfile

folder, version, out = pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3])
python = f"cp{sys.version_info.major}{sys.version_info.minor}"
tag = f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
info = f"vobench-{version}.dist-info"
contents = {f"vobench/{file.name}": file.read_bytes() for file in sorted(folder.iterdir()) if file.is_file()}
contents[f"{info}/METADATA"] = (
    f"Metadata-Version: 2.1\nName: vobench\nVersion: {version}\nSummary: Synthetic-data simulator and test bench for visual odometry\n"
    f"License: MIT\nRequires-Python: =={sys.version_info.major}.{sys.version_info.minor}.*\nRequires-Dist: numpy\n").encode()
contents[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: vobench\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()


def hashed(data):
    return "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


record = "".join(f"{name},{hashed(data)},{len(data)}\n" for name, data in contents.items()) + f"{info}/RECORD,,\n"
contents[f"{info}/RECORD"] = record.encode()
file = out / f"vobench-{version}-{tag}.whl"
with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as wheel:
    for name, data in contents.items():
        entry = zipfile.ZipInfo(name)  # of no date: the same module is the same wheel
        entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
        entry.compress_type = zipfile.ZIP_DEFLATED
        wheel.writestr(entry, data)
print(file)
