#!/usr/bin/env python3
"""Unit test of check_interfaces.py: each limit can be exceeded."""
import unittest

from check_interfaces import table

LIST = '#include "physics/heat/heat.hpp"'
GOOD = {
    "packages/assembly/module.hpp": "class Module {\n  virtual ~Module() = default;\n  virtual void bind() = 0;\n};",
    "packages/physics/physics.hpp":
        "struct RatesFunctions {\n  bool (*exist)(const Scene&);\n};\n"
        "template <class Self>\nstruct Physics {\n  static bool is_in() { return 0; }\n};",
    "packages/physics/list.hpp": LIST,
    "packages/assembly/system.cpp": "void f() { ghosts_.exchange(x, all); }",
}
VIRTUAL, STATIC = "virtual void f();\n", "static int f() { return 0; }\n"
MEMBERS = "std::map<int, int> a_{}, b_ = f();\n"
BAD = {
    "virtual functions of Module": ("packages/assembly/module.hpp", f"struct Module {{\n{9 * VIRTUAL}}};"),
    "virtual functions of a capability of modules":
        ("packages/assembly/capabilities.hpp", f"struct A {{\n{7 * VIRTUAL}}};"),
    "functions of Physics":
        ("packages/physics/physics.hpp", f"template <class Self>\nstruct Physics {{\n{9 * STATIC}}};"),
    "functions of a group of Physics":
        ("packages/physics/physics.hpp", "struct RatesFunctions {\n" + 7 * "bool (*f)(int);\n" + "};"),
    "data members of System": ("packages/assembly/system.hpp", f"class System {{\n{11 * MEMBERS}}};"),
    "data members of a class of packages": ("packages/mesh/a.hpp", f"class A : B<int> {{\n{13 * MEMBERS}}};"),
    "lines of packages/physics / number of physics": ("packages/physics/heat/", 30 * [400 * "\n"]),
    "sources of packages/physics outside of folders": ("packages/physics/", 7 * [""]),
    "their includes of folders, except in list.hpp": ("packages/physics/a.hpp", LIST),
    "generic sources that name a physics": ("packages/io/a.cpp", "Real friction;"),
    "lines of a source of packages and apps": ("apps/plot/a.py", 501 * "\n"),
    "calls of Ghosts::exchange": ("packages/assembly/a.cpp", "void f() { ghosts_.exchange(x, all); }"),
}


def exceeded(path, content):
    added = {path: content} if isinstance(content, str) else {f"{path}{i}.cpp": text for i, text in enumerate(content)}
    return [title for title, limit, size, _ in table({**GOOD, **added}) if size > limit]


class CheckInterfaces(unittest.TestCase):
    def test_each_limit_can_be_exceeded(self):
        self.assertEqual([row[0] for row in table(GOOD)], list(BAD))
        for title, files in BAD.items():
            with self.subTest(title=title):
                self.assertEqual(exceeded(*files), [title])

    def test_small_interfaces_pass(self):
        self.assertEqual([row for row in table(GOOD) if row[2] > row[1]], [])
        self.assertEqual([row[2] for row in table(GOOD)], [1, 0, 1, 1, 0, 0, 6, 2, 0, 0, 6, 1])


if __name__ == "__main__":
    unittest.main()
