#!/usr/bin/env python3
"""Size limits of vo/filter: data members of a class (inherited ones included), lines of a file, virtual functions of
Filter.

filter_size_test.py FOLDER     prints what exceeds a limit, after a self-check with planted violations
"""
import pathlib
import re
import sys
import tempfile

MOST_MEMBERS, MOST_LINES, MOST_VIRTUALS = 12, 220, 12


def without_comments(text):
    text = re.sub(r'"(\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', lambda m: '""' if m[0][0] == '"' else " ", text, flags=re.S)
    text = re.sub(r"=\s*\{\s*\}", "= 0", text)  # default arguments and initialisers
    return re.sub(r"^\s*#[^\n]*", "", text, flags=re.M)


def block_end(text, opening):
    depth = 0
    for i in range(opening, len(text)):
        depth += (text[i] == "{") - (text[i] == "}")
        if depth == 0:
            return i
    raise SystemExit(f"unbalanced braces after: {text[opening - 60:opening]}")


def without_template_arguments(text):
    while True:
        shorter = re.sub(r"<[^<>]*>", "", text)
        if shorter == text:
            return text
        text = shorter


def statements(body):
    """Declarations of a class body, without the bodies of functions and nested types."""
    start = i = 0
    while i < len(body):
        if body[i] == ";":
            yield body[start:i]
            start = i + 1
        elif body[i] == "{":
            head = body[start:i]
            i = block_end(body, i)
            if "(" in without_template_arguments(head).split("=")[0]:  # a function
                yield head
                start = i + 1
        i += 1


def count_members(body):
    count = 0
    for statement in statements(body):
        text = re.sub(r"\b(public|protected|private)\s*:", "", statement).strip()
        if not text or re.match(r"(using|friend|static|enum|class|struct|typedef|template|constexpr)\b", text):
            continue
        text = re.sub(r"\{.*\}", "", text, flags=re.S)
        text = without_template_arguments(text)
        if "(" in text.split("=")[0] or "operator" in text:  # a function
            continue
        declarators = re.sub(r"\([^()]*\)", "", re.sub(r"\([^()]*\)", "", text))
        count += declarators.count(",") + 1
    return count


def classes(text):
    """Name, bases and body of every class and struct, nested ones included."""
    for match in re.finditer(r"\b(?:class|struct)\s+((?:\w+::)*\w+)(?:\s+final)?\s*(:[^;{]*)?\{", text):
        if re.search(r"\benum\s*$", text[:match.start()]):
            continue
        end = block_end(text, match.end() - 1)
        bases = re.findall(r"(?:public|protected|private)\s+([\w:]+)", match[2] or "")
        yield match[1], bases, text[match.end():end]


def violations(folder):
    found, own, bases, virtuals = [], {}, {}, None
    for path in sorted(folder.iterdir()):
        if path.suffix not in (".h", ".cpp", ".inc"):
            continue
        text = path.read_text()
        lines = text.count("\n")
        if lines > MOST_LINES:
            found.append(f"{path.name}: {lines} lines, more than {MOST_LINES}")
        for name, parents, body in classes(without_comments(text)):
            own[name], bases[name] = count_members(body), parents
            if name == "Filter":
                virtuals = len(re.findall(r"\bvirtual\b", body))

    def members(name):
        return own.get(name, 0) + sum(members(base) for base in bases.get(name, []))

    for name in own:
        if members(name) > MOST_MEMBERS:
            found.append(f"{name}: {members(name)} data members, more than {MOST_MEMBERS}")
    if virtuals is None:
        found.append("no class Filter")
    elif virtuals > MOST_VIRTUALS:
        found.append(f"Filter: {virtuals} virtual functions, more than {MOST_VIRTUALS}")
    return found, {name: members(name) for name in own}


def planted(text):
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "filter.h").write_text(text)
        return violations(pathlib.Path(folder))[0]


def self_check():
    members = "int a_ = Zero(1, 2), b_;\n std::vector<std::pair<int, int>> c_, d_;\n Pose e_{0, 1};\n"
    members += "".join(f"const std::function<void(int)>& f{i}_;  // of (a, b)\n" for i in range(7))
    small = "class Filter { public: virtual ~Filter() = default; int f(int a, int b) const { return a; }\n enum class E { x, y };\n"
    assert planted(small + members + "};") == [], planted(small + members + "};")
    assert planted(small + members + "int more_; };") == ["Filter: 13 data members, more than 12"]
    assert planted(small + members + "};\nstruct Derived final : public Filter { double more; };") == [
        "Derived: 13 data members, more than 12"]
    assert planted(small + "".join(f"virtual void F{i}() = 0;\n" for i in range(12)) + "};") == [
        "Filter: 13 virtual functions, more than 12"]
    assert planted(small + "};" + "\n" * 219) == ["filter.h: 221 lines, more than 220"]


if __name__ == "__main__":
    self_check()
    broken, counts = violations(pathlib.Path(sys.argv[1]))
    largest = sorted(counts.items(), key=lambda item: -item[1])[:5]
    print("most data members:", ", ".join(f"{name} {count}" for name, count in largest))
    print("\n".join(broken))
    sys.exit(bool(broken))
