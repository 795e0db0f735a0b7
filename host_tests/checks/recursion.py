#!/usr/bin/env python3
"""recursion.py FOLDER...: no function of the core reaches itself. Names of static functions are taken as one."""
import re
import sys

import c_source


def call_graph(folders):
    bodies = {}
    for path in c_source.sources(*folders):
        for function in c_source.functions(path.read_text(encoding="utf-8")):
            bodies.setdefault(function.name, []).append(function.body)
    # A name counts with and without parentheses: a pointer to a function may be called later.
    return {name: {word for body in texts for word in re.findall(r"\b[A-Za-z_]\w*\b", body) if word in bodies}
            for name, texts in bodies.items()}


def reach(graph, start):
    seen, waiting = set(), list(graph[start])
    while waiting:
        name = waiting.pop()
        if name not in seen:
            seen.add(name)
            waiting.extend(graph[name])
    return seen


def check(folders):
    graph = call_graph(folders)
    return [f"{name}() reaches itself" for name in sorted(graph) if name in reach(graph, name)]


if __name__ == "__main__":
    found = check(sys.argv[1:])
    print("\n".join(found) or "no function reaches itself")
    sys.exit(1 if found else 0)
