#!/usr/bin/env python3
"""recursion.py FOLDER...: no function of the core reaches itself."""
import re
import sys

import c_source


def call_graph(folders):
    """(file, function): the functions that its body names. A name is looked for in the same file first."""
    functions = [(str(path), function) for path in c_source.sources(*folders)
                 for function in c_source.functions(path.read_text(encoding="utf-8"))]
    places = {}
    for path, function in functions:
        places.setdefault(function.name, set()).add(path)

    def resolve(path, name):
        return {(path, name)} if path in places[name] else {(place, name) for place in places[name]}

    graph = {(path, function.name): set() for path, function in functions}
    for path, function in functions:
        # A name counts with and without parentheses: a pointer to a function may be called later.
        for name in set(re.findall(r"(?<![.>\w])[A-Za-z_]\w*\b", function.body)) & set(places):
            graph[path, function.name] |= resolve(path, name)
    return graph


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
    return [f"{path}: {name}() reaches itself" for path, name in sorted(graph) if (path, name) in reach(graph, (path, name))]


if __name__ == "__main__":
    found = check(sys.argv[1:])
    print("\n".join(found) or "no function reaches itself")
    sys.exit(1 if found else 0)
