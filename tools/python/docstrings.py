"""Writes the comments of C++ headers as a table of documentation strings: docstrings.py ROOT HEADER... > docstrings.inc

Each entry is {"header:Name", "text"}: Name is a class, a function, or Class::member; without a name, the header's Purpose. The text of
a declaration is the comment above it, or above the group of lines that it stands in, and the one behind it.
"""
import re
import sys


def declared(line):
    """What a line declares, or None."""
    head = re.split(r" = |\{", line)[0]
    match = re.match(r"(?:class|struct|enum class|using) (\w+)", line) or re.search(r"(\w+)\(", head) or re.search(r"(\w+);?$", head.strip())
    return match and match[1]


def purpose(lines):
    text = " ".join(re.sub(r"^// ?", "", line).strip() for line in lines if line.startswith("//"))
    return re.sub(r"^Purpose:\s*", "", re.split(r"\s(?:Source|Frames|Units|Convention|Tangent|State|Cost):\s", text)[0])


def entries(lines):
    first_blank = next((i for i, line in enumerate(lines) if line.startswith("#pragma")), 0)
    yield "", purpose(lines[:first_blank])
    comment, open_comment, scope = [], False, ""
    for line in lines[first_blank:]:
        if not line.strip():
            comment, open_comment = [], False
            continue
        text, _, behind = line.strip().partition("//")
        if not text:  # a comment: of what follows
            comment = comment + [behind.strip()] if open_comment else [behind.strip()]
            open_comment = True
            continue
        if "(" not in text and not open_comment and line.startswith(" "):
            comment = []  # a member's own comment, not that of the member before
        open_comment = False
        if line.startswith("}"):
            scope = ""
        name = declared(text)
        if not name:
            continue
        qualified = f"{scope}::{name}" if line.startswith(" ") and scope else name
        said = " ".join(comment + [behind.strip()]).strip()
        if said and (not line.startswith(" ") or scope):
            yield qualified, said
        begins = re.match(r"(?:class|struct) (\w+).*\{$", line.rstrip())
        if begins:
            scope, comment = begins[1], []


def main(root, headers):
    seen = set()
    for header in headers:
        with open(f"{root}/{header}", encoding="utf-8") as file:
            for name, text in entries(file.read().splitlines()):
                key = f"{header}:{name}"
                if text and key not in seen:
                    seen.add(key)
                    print(f'{{"{key}", R"doc({text})doc"}},')


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
