"""Scenario files as text."""


def section(text, name):
    """A section of a scenario file, as it is written there."""
    lines = text.split("\n")
    first = next(i for i, line in enumerate(lines) if line.startswith(name + ":"))
    end = next((i for i in range(first + 1, len(lines)) if lines[i] and not lines[i].startswith((" ", "#"))), len(lines))
    return "\n".join(lines[first:end]).rstrip() + "\n"
