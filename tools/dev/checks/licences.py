#!/usr/bin/env python3
"""docs/licences.md is complete and right: against tools/packages.txt, the npm lock file, Debian's copyright files and the
libraries that the built program names. Each kind of error, planted in a copy, is seen.

Usage: tools/dev/checks/licences.py PROJECT_ROOT PROGRAM
"""
import functools
import json
import pathlib
import re
import subprocess
import sys

ROOT, PROGRAM = pathlib.Path(sys.argv[1]), sys.argv[2]

# What Debian calls the licences that the tables name by their SPDX identifiers.
DEBIAN_NAMES = {
    "MIT": ("Expat", "MIT", "X11", "Expat with embedded exception"),
    "BSD-2-Clause": ("BSD-2-clause", "BSD-2"),
    "BSD-3-Clause": ("BSD-3-clause", "BSD-3-Clause", "BSD-C3", "BSD-3-Clause+CLA", "openexr", "Neither the name of the NumPy Developers"),
    "BSL-1.0": ("BSL-1.0",),
    "Apache-2.0": ("Apache-2.0", "Apache-2"),
    "Apache-2.0 WITH LLVM-exception": ("APACHE-2-LLVM-EXCEPTIONS",),
    "MPL-2.0": ("MPL-2",),
    "ISC": ("ISC",),
    "Zlib": ("zlib/libpng", "Zlib"),
    "IJG": ("BSD-BY-LC-NE",),
    "HPND": ("Custom-MIT-like",),
    "PSF-2.0": ("Python Software Foundation",),
    "Artistic-2.0": ("Artistic-2.0",),
    "GPL-2.0-only": ("GPL-2",),
    "GPL-2.0-or-later": ("version 2, or", "GPL-2+ with OpenSSL exception"),
    "GPL-3.0-or-later": ("GPL-3+-and-LGPL-3+",),
    "LGPL-3.0-or-later": ("GPL-3+-and-LGPL-3+",),
    "LGPL-2.1-or-later": ("GNU Lesser General Public",),
    "GPL-3.0-or-later WITH GCC-exception-3.1": ("GCC Runtime Library Exception",),
}


class Tables:
    def __init__(self, page):
        self.debian, self.npm, self.explained = {}, {}, []
        for line in page.splitlines():
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            if line.startswith("| `") and len(cells) == 4:
                self.debian[cells[0].strip("`")] = (cells[1], cells[2], cells[3])
            elif line.startswith("| `") and len(cells) == 3:
                self.npm[cells[0].strip("`")] = (cells[1], cells[2])
            elif len(cells) == 2 and not cells[0].startswith(("licence", "-")):
                self.explained += cells[0].split(", ")


def copyright_of(package):
    for folder in (package, package + ":amd64"):
        file = pathlib.Path("/usr/share/doc") / folder / "copyright"
        if file.exists():
            return file.read_text(encoding="utf-8", errors="replace")
    return None


def says(text, words):
    """Of all files of the package, where the copyright file can be read by machines and has a licence of them; else anywhere in it."""
    if "Format:" not in text[:200]:
        return words in text
    stars = []
    for paragraph in re.split(r"\n\s*\n", text):
        files = re.search(r"^Files:((?:.|\n[ \t])*)", paragraph, re.M)
        licence = re.search(r"^License:[ \t]*(.*)", paragraph, re.M)
        if files and licence and "*" in files.group(1).split():
            stars.append(licence.group(1).strip())
    return words in stars if stars else all(word in text for word in words.split(" AND "))


@functools.cache
def sources():
    said = subprocess.run(("dpkg-query", "-W", "-f", "${Package}\t${source:Package}\t${db:Status-Abbrev}\n"), check=True, capture_output=True, text=True)
    rows = (line.split("\t") for line in said.stdout.splitlines())
    return {name: source for name, source, status in rows if status.startswith("ii")}


def source_of(package):
    return sources().get(package)


def packages_of_program():
    said = lambda *command: subprocess.run(command, check=True, capture_output=True, text=True).stdout
    named = re.findall(r"\(NEEDED\)\s+Shared library: \[(.+)\]", said("readelf", "-d", PROGRAM))
    place = {name: str(pathlib.Path(file).resolve()) for name, file in re.findall(r"(\S+) => (/\S+)", said("ldd", PROGRAM))}
    # dpkg knows files of merged systems with or without their /usr.
    files = {name: {place[name], place[name].removeprefix("/usr")} for name in named if name in place}
    owners = subprocess.run(("dpkg", "-S", *set().union(*files.values())), capture_output=True, text=True).stdout
    owner_of = {file: package.split(":")[0] for package, file in (line.split(": ") for line in owners.splitlines())}
    packages = set()
    for name in files:
        owner = next((owner_of[file] for file in files[name] if file in owner_of), None)
        assert owner, f"{name}: of no Debian package"
        packages.add(owner)
    return packages


def problems(page, packages, lock, linked):
    tables, found = Tables(page), []
    for package in sorted(set(packages) - set(tables.debian)):
        found.append(f"{package}: is in tools/packages.txt and not in the tables")
    listed_sources = {source_of(package) for package in tables.debian} - {None}
    for package in sorted(set(tables.debian) - set(packages)):
        if package not in linked:
            found.append(f"{package}: is in the tables; neither tools/packages.txt nor the program names it")
    for package in sorted(linked):
        if package not in tables.debian and source_of(package) not in listed_sources:
            found.append(f"{package}: the program links it, and its source is not in the tables")
        elif not any(row[2].startswith("linked") for name, row in tables.debian.items() if package == name or source_of(package) == source_of(name)):
            found.append(f"{package}: the program links it, the tables do not say so")
    for package, (licence, words, purpose) in tables.debian.items():
        parts = licence.split(" AND ")
        if words not in DEBIAN_NAMES.get(licence, ()) and not all(
            any(name in words for name in DEBIAN_NAMES.get(part, ())) for part in parts
        ):
            found.append(f"{package}: '{words}' is not how Debian writes {licence}")
        text = copyright_of(package)
        if text is not None and not says(text, words):
            found.append(f"{package}: its copyright file does not say '{words}'")
        for part in parts:
            if part not in tables.explained:
                found.append(f"{package}: nothing says why {part} goes with MIT")
        if purpose.startswith("linked") and source_of(package) and source_of(package) not in {source_of(p) for p in linked}:
            found.append(f"{package}: 'linked', and the program does not name it")
    npm = {}
    for path, package in lock["packages"].items():
        name = path.removeprefix("node_modules/")
        if name:
            npm[name] = package["license"]
    for name in sorted(set(npm) ^ set(tables.npm)):
        found.append(f"{name}: is in one of the npm lock file and the tables")
    for name in sorted(set(npm) & set(tables.npm)):
        if npm[name] != tables.npm[name][0]:
            found.append(f"{name}: the lock file says {npm[name]}")
        if tables.npm[name][0] not in tables.explained:
            found.append(f"{name}: nothing says why {tables.npm[name][0]} goes with MIT")
    return found


def main():
    page = (ROOT / "docs/licences.md").read_text()
    lines = (line.split("#")[0].split() for line in (ROOT / "tools/packages.txt").read_text().splitlines())
    packages = [words[0] for words in lines if words]
    lock = json.loads((ROOT / "tests/system/web/package-lock.json").read_text())
    linked = packages_of_program()
    wrong = problems(page, packages, lock, linked)
    assert not wrong, "\n".join(wrong)
    assert len(linked) > 8, linked

    def without(name):
        return re.sub(rf"^\| `{re.escape(name)}` .*\n", "", page, flags=re.M)

    other = json.loads(json.dumps(lock))
    other["packages"]["node_modules/typescript"]["license"] = "GPL-3.0-only"
    planted = {
        "a package without a row": (without("libfmt-dev"), packages, lock, linked),
        "a linked library without a row": (without("libc6"), packages, lock, linked),
        "an npm package without a row": (without("axe-core"), packages, lock, linked),
        "a row without a package": (page, [p for p in packages if p != "pngcheck"], lock, linked),
        "another npm licence": (page, packages, other, linked),
        "a licence that Debian does not name": (page.replace("| MPL-2.0 | MPL-2 |", "| MPL-2.0 | MPL-1 |"), packages, lock, linked),
        "a wrong identifier": (page.replace("| MPL-2.0 | MPL-2 |", "| MIT | MPL-2 |"), packages, lock, linked),
        "one file's licence for all files'": (page.replace("| BSD-3-Clause | openexr |", "| MIT | Expat |"), packages, lock, linked),
        "no reason": (page.replace("| MPL-2.0 | by file", "| | by file"), packages, lock, linked),
        "not linked, it says": (page.replace("linked: rays", "headers: rays"), packages, lock, linked),
        "linked, it says": (page.replace("headers: checksums", "linked: checksums"), packages, lock, linked),
    }
    for what, arguments in planted.items():
        assert arguments != (page, packages, lock, linked), what
        assert problems(*arguments), f"not noticed: {what}"
    print(f"{len(packages)} packages, {len(linked)} linked; {len(planted)} planted errors were all noticed")


main()
