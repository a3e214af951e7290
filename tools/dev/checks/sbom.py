#!/usr/bin/env python3
"""tools/dev/sbom prints a CycloneDX 1.5 bill of materials: what the specification requires, of the versions that are here.

Usage: tools/dev/checks/sbom.py PROJECT_ROOT BUILD_FOLDER
"""
import copy
import json
import pathlib
import re
import subprocess
import sys

ROOT, BUILD = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
TYPES = {"application", "framework", "library", "container", "platform", "operating-system", "device", "device-driver", "firmware",
         "file", "machine-learning-model", "data"}


def problems(bill):
    """Against CycloneDX 1.5's JSON schema: required fields, their types and values, references."""
    found = []

    def need(condition, what):
        if not condition:
            found.append(what)

    need(bill.get("bomFormat") == "CycloneDX", "bomFormat")
    need(bill.get("specVersion") == "1.5", "specVersion")
    need(isinstance(bill.get("version"), int) and bill["version"] >= 1, "version")
    need(re.fullmatch(r"urn:uuid:[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}", bill.get("serialNumber", "")), "serialNumber")
    allowed = {"bomFormat", "specVersion", "version", "serialNumber", "metadata", "components", "dependencies"}
    need(set(bill) <= allowed, "a field that the schema does not know")
    components = [bill.get("metadata", {}).get("component", {}), *bill.get("components", [])]
    for component in components:
        name = component.get("name", "?")
        need(component.get("type") in TYPES and isinstance(component.get("name"), str), f"{name}: type or name")
        need(component.get("scope", "required") in ("required", "optional", "excluded"), f"{name}: scope")
        need(component.get("version"), f"{name}: version")
        need(re.fullmatch(r"pkg:(deb/debian|generic)/[^@\s]+@[^\s@]+", component.get("purl", "")), f"{name}: purl")
        for choice in component.get("licenses", []):
            known = ("license" in choice and set(choice["license"]) == {"id"}) or set(choice) == {"expression"}
            need(known, f"{name}: licence")
        for digest in component.get("hashes", []):
            need(digest["alg"] == "SHA-512" and re.fullmatch("[0-9a-f]{128}", digest["content"]), f"{name}: hash")
    references = [component.get("bom-ref") for component in components]
    need(all(references) and len(set(references)) == len(references), "bom-ref missing or not unique")
    for dependency in bill.get("dependencies", []):
        need(set([dependency["ref"], *dependency["dependsOn"]]) <= set(references), "a dependency that is no component")
        need(len(set(dependency["dependsOn"])) == len(dependency["dependsOn"]), "a dependency twice")
    return found


def main():
    said = [subprocess.run((ROOT / "tools/dev/sbom", BUILD), check=True, capture_output=True, text=True).stdout for _ in range(2)]
    assert said[0] == said[1], "the same build, another bill"
    bill = json.loads(said[0])
    assert not problems(bill), problems(bill)
    by_name = {component["name"]: component for component in bill["components"]}
    for name in ("libeigen3-dev", "libopencv-core406", "libembree3-3", "libavcodec59", "libc6"):
        if subprocess.run(("dpkg-query", "-W", name), capture_output=True).returncode != 0:
            continue
        version = subprocess.run(("dpkg-query", "-W", "-f", "${Version}", name), check=True, capture_output=True, text=True).stdout
        assert by_name[name]["version"] == version, name
        assert by_name[name]["scope"] == "required", name
    assert by_name["ninja-build"]["scope"] == "excluded"
    ours = bill["dependencies"][0]["dependsOn"]
    assert any("libeigen3-dev" in reference for reference in ours) and not any("ninja" in reference for reference in ours)
    # The check itself.
    for plant in (lambda b: b.pop("specVersion"), lambda b: b["components"][1].pop("name"), lambda b: b.update(version="1"),
                  lambda b: b["components"][1].update({"bom-ref": b["components"][0]["bom-ref"]}),
                  lambda b: b["components"][0].update(type="package"), lambda b: b["dependencies"][0]["dependsOn"].append("x")):
        spoiled = copy.deepcopy(bill)
        plant(spoiled)
        assert problems(spoiled), "a planted error was not noticed"
    nothing = subprocess.run((ROOT / "tools/dev/sbom", "/nowhere"), capture_output=True, text=True)
    assert nothing.returncode == 1 and "/nowhere" in nothing.stderr and nothing.stdout == "", nothing
    print(f"{len(bill['components'])} components")


main()
