"""Every message that the sources can say is quoted by a test, or stands in message_sites.txt with the reason why none can.

A message is what stands in quotes after `throw`, Reject, Complain or fail, up to the semicolon; a test quotes it when one of its own
strings has a piece of it of eight characters, or three words of it in a row, twelve characters or more. Usage: message_sites.py ROOT
"""
import pathlib
import re
import sys

SITE = re.compile(r"\bthrow (?!std::logic_error)[A-Za-z:]+\w*[({]|\b(?:Reject|Complain|fail)\(")
STRING = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def joined(text):
    """Literals that go on in the next line are one."""
    return re.sub(r'"\s*\n\s*"', "", text)


def pieces(statement):
    """What the message says, without what is put in."""
    said = [piece.strip(" :',.") for string in STRING.findall(statement) for piece in re.split(r"\{[^}]*\}", string)]
    return [piece for piece in said if len(piece) >= 8]


def messages(text):
    """(line, pieces) of each; those without a word of their own hand on what others say."""
    text = joined(text)
    for site in SITE.finditer(text):
        said = pieces(text[site.start():text.find(";", site.start())][:400])
        if said:
            yield text.count("\n", 0, site.start()) + 1, said


def quoted(said, tests):
    def runs(piece):
        words = piece.split()
        return [run for run in (" ".join(words[i:i + 3]) for i in range(len(words) - 2)) if len(run) >= 12]
    return any(piece in tests or any(run in tests for run in runs(piece)) for piece in said)


def read_excuses(file):
    """"FILE: PIECE OF THE MESSAGE: why". PIECE may be *, FILE a folder that ends in '/'."""
    excuses = []
    for number, line in enumerate(file.read_text().splitlines(), 1):
        if not line or line.startswith("#"):
            continue
        parts = line.split(": ", 2)
        assert len(parts) == 3 and len(parts[2]) > 10, f"{file.name}:{number}: is not FILE: PIECE: why"
        excuses.append([*parts, number])
    return excuses


def main(root):
    tests = ""
    for file in sorted((root / "tests").rglob("*")):
        if file.suffix in {".cpp", ".h", ".py", ".sh", ".mjs"} and file.name != "message_sites.py":
            strings = STRING.findall(joined(file.read_text())) + re.findall(r"'[^'\n]*'", file.read_text())
            tests += "\n".join(strings).replace("\\", "") + "\n"  # of regular expressions the words
    excuses, used, sites, problems = read_excuses(root / "tests/system/message_sites.txt"), set(), 0, []
    for top in ("sim", "vo", "tools"):
        for file in sorted((root / top).rglob("*")):
            if file.suffix not in {".cpp", ".h", ".inc"}:
                continue
            name = str(file.relative_to(root))
            for line, said in messages(file.read_text()):
                sites += 1
                if quoted(said, tests):
                    continue
                why = [e for e in excuses if (name == e[0] or e[0].endswith("/") and name.startswith(e[0])) and (e[1] == "*" or any(e[1] in piece for piece in said))]
                if not why:
                    problems.append(f"{name}:{line}: no test quotes '{said[0]}': add what triggers it, or why nothing can to message_sites.txt")
                used.update(e[3] for e in why)
    problems += [f"message_sites.txt:{e[3]}: nothing needs '{e[0]}: {e[1]}' any more" for e in excuses if e[3] not in used]
    # The check sees what it should: a message that nobody quotes, and one that somebody does.
    (_, unsaid), = messages('void F() { throw std::runtime_error(file + ": of a kind "\n  "that no test knows"); }')
    assert unsaid == ["of a kind that no test knows"] and not quoted(unsaid, "of a kind") and quoted(unsaid, "that no test")
    assert sites > 250, f"only {sites} messages were seen"
    print("\n".join(problems + [f"{sites} messages, {len(problems)} problems"]))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
