#!/usr/bin/env python3
"""Tests that the checker finds each violation, and none in correct sources."""
import tempfile
import unittest
from pathlib import Path

from check_reference import defect
from check_rules import check

KERNEL = "KOKKOS_INLINE_FUNCTION Real f(const View<Real*>& x) const {\n  %s\n}\n"
UNFINISHED_WORDS = ["TO" "DO", "FIX" "ME", "XX" "X", "HA" "CK"]

BAD = [  # file, text, rule
    ("packages/base/a.hpp", '#include "mesh/mesh.hpp"', "include-order"),
    ("packages/solve/a.cpp", '#include "physics/bulk.hpp"', "include-order"),
    ("packages/multigrid/a.cpp", '#include "solve/joined.hpp"', "include-order"),
    ("packages/physics/a.cpp", '#  include "solve/newton.hpp"', "include-order"),
    ("packages/laws/a.hpp", '#include "mesh/mesh.hpp"', "include-order"),
    ("packages/stray/a.hpp", '#include "base/types.hpp"', "include-order"),
    ("packages/model/a.cpp", "#include <NOX_Abstract_Group.H>", "solver-header"),
    ("apps/sprekk/main.cpp", '#include "BelosLinearProblem.hpp"', "solver-header"),
    ("packages/io/a.cpp", "void f() { g(MPI_COMM_WORLD); }", "host-only"),
    ("packages/io/a.cpp", "void f() { MPI_Init(nullptr, nullptr); }", "host-only"),
    ("packages/io/a.cpp", "void f() { Kokkos::initialize(); }", "host-only"),
    ("packages/io/a.cpp", "void f() { std::exit(1); }", "host-only"),
    ("packages/io/a.cpp", "void f() { exit (1); }", "host-only"),
    ("packages/io/a.cpp", "void f() { std::abort(); }", "host-only"),
    *[("packages/assembly/a.hpp", KERNEL % line, "kernel") for line in [
        "std::vector<Real> y;", "if (x) { std::map<int, int> m; }", "std::string s;", "auto p = new Real[3];",
        "malloc(3);", "std::cout << 1;", "auto p = x.data();", "return v->data ()[0];"]],
    ("packages/assembly/a.cpp", "void g() {\n  each(n, KOKKOS_LAMBDA(int i) { y(i) = z.data()[i]; });\n}", "kernel"),
    ("packages/assembly/a.hpp", "struct A {\n  KOKKOS_FUNCTION A(int n) : n_{n} { p_ = new int; }\n};", "kernel"),
    ("packages/laws/a.hpp", "#define DEVICE KOKKOS_INLINE_FUNCTION\nDEVICE int f() { return *new int; }", "kernel"),
    *[("packages/base/a.hpp", f"// {word}: later", "unfinished") for word in UNFINISHED_WORDS],
    ("docs/guide.md", "see /wo" "rk/shared", "self-contained"),
    ("tests/unit/a.cpp", "// an earlier ses" "sion", "self-contained"),
    ("README.md", "is" "sue #3", "self-contained"),
    ("packages/base/a.cpp", "int f() {\n  static int calls = 0;\n  return ++calls;\n}", "static-state"),
    ("packages/base/a.cpp", "namespace {\n\nstd::vector<int> cache;\n\n}", "static-state"),
    ("packages/base/a.cpp", "Real scale = 1;", "static-state"),
    ("packages/base/a.hpp", "inline int counter{0};", "static-state"),
    ("packages/base/a.hpp", "struct A {\n  static inline Map<int, Function<void()>> registry;\n};", "static-state"),
    ("packages/base/a.cpp", "thread_local Real buffer[3];", "static-state"),
    ("packages/base/a.cpp", "void f() {\n  static Thing thing(3);\n}", "static-state"),
    ("packages/base/a.cpp", "int Thing::count = 0;", "static-state"),
    ("packages/model/a.cpp", 'if (field == "face pressure") {}', "generic-room"),
    ("packages/solve/a.hpp", "// of a fluid", "generic-room"),
    ("packages/assembly/system.cpp", "// block of the displacements", "generic-room"),
    ("packages/estimate/a.hpp", "void slip();", "generic-room"),
    ("packages/physics/flow/a.cpp", "int f(Real temperature);", "physics-room"),
    ("packages/transport/wells.cpp", "// of a tracer", "physics-room"),
    ("packages/physics/heat/a.cpp", "struct Tracer;", "physics-room"),
    *[("packages/laws/a.hpp", KERNEL % line, "kernel") for line in [
        "if (x < 0) throw 1;", "SPREKK_CHECK(x > 0, \"\");", "Kokkos::deep_copy(y, x);", "fmt::print(\"\");"]],
    ("packages/assembly/a.cpp", "int f(unsigned x) { return __builtin_popcount(x); }", "compiler"),
    ("packages/fields/a.hpp", "__attribute__((flatten)) void f();", "compiler"),
    ("packages/physics/a.cpp", "struct Kernel {\n  Real operator()(int i) const { return x(i); }\n};", "functor"),
    ("packages/physics/a.cpp", "class A {\n public:\n  void f();\n private:\n  void g() { each(KOKKOS_LAMBDA(int i) {}); }\n};",
     "lambda"),
    ("packages/physics/a.cpp", "class A : B {\n  struct C { void g() { each(KOKKOS_LAMBDA(int i) {}); } };\n};", "lambda"),
    ("packages/assembly/a.cpp", "void f() {\n  sizes([&](auto n) { each(KOKKOS_LAMBDA(int i) {}); });\n}", "lambda"),
    ("packages/physics/a.cpp", "Real f(const ConstView<Real*>& x) { return x(3); }", "host-read"),
    ("packages/assembly/a.cpp", 'void f() {\n  View<Real**> x("x", n, 3);\n  for (int i = 0; i < n; ++i) x(i, 0) = 1;\n}',
     "host-read"),
    ("packages/assembly/a.cpp", "void f() {\n  const Real* p = v.data();\n  each(KOKKOS_LAMBDA(int i) { y(i) = p[i]; });\n}",
     "host-pointer"),
    ("packages/fields/a.cpp", "auto f() { return map->getNodeNumElements(); }", "trilinos-names"),
    ("tests/unit/a.cpp", "for (auto i : map->getNodeElementList()) f(i);", "trilinos-names"),
    ("packages/solve/a.cpp", "Real f(Real b) { return Kokkos::Experimental::fabs(b); }", "trilinos-names"),
]

GOOD = {
    "packages/laws/a.hpp": """
struct Kernel {
  KOKKOS_INLINE_FUNCTION Real operator()(int i) const { return x(i); }
};
template <class T>
struct C {
  void f() { each(KOKKOS_LAMBDA(int i) {}); }
};
class A {
  int n = 0;
  struct B { int m; };

 public:
  void f() { each(KOKKOS_LAMBDA(int i) {}); }
  template <class T>
  void g() const { each(KOKKOS_LAMBDA(int i) {}); }
};
""",
    "packages/physics/heat/a.cpp": "int f(Real temperature);\n",
    "packages/physics/tracer/a.cpp": "struct Tracer;\n",
    "packages/physics/list.hpp": "// Heat, Tracer\n",
    "packages/physics/a.cpp": '#include "physics/a.hpp"\n#include "laws/joint.hpp"\n#include <vector>\n',
    "packages/solve/a.cpp": "#include <NOX_Solver_Generic.H>\n#include <MueLu.hpp>\n",
    "packages/assembly/a.hpp": """
// Not in kernels: std::vector, new, x.data(); and never exit(1) or std::abort.
struct Gather {
  KOKKOS_FUNCTION Real operator()(int i) const;
  KOKKOS_INLINE_FUNCTION explicit Gather(int n) : n_{n}, m_{n} { renew(n); }
  std::vector<Real> host() const { return std::vector<Real>(view.data(), view.data() + n_); }
  Real one() const {
    const View<Real*> x("x", n_);
    const auto there = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), x);
    return there(0) + rows()(1);
  }
  View<Real*> rows() const;
};
void message() { throw Error("a new std::vector: exit(1)"); }
bool on_exit_of(int f);
""",
    "packages/base/a.hpp": """
static const int a = 1;
static constexpr double b = 2;
static inline int twice(int x) { return 2 * x; }
const std::vector<std::string> names{"a"};
constexpr Real pi = 3.14;
inline constexpr int c = 3;
struct A {
  static A parse(const std::string& text, int n = 0);
  static std::function<void()> make();
  int member = 0;
};
enum class Side { minus, plus };
using Pair = std::pair<int, int>;
template class Box<double>;
namespace fs = std::filesystem;
int f(int x) {
  auto lambda = [](int y) { return static_cast<int>(y); };
  int local = lambda(x);
  return local;
}
Real operator*(const A& a, const A& b) { return 0; }
""",
    "apps/sprekk/main.cpp": '#include "model/model.hpp"\nint main() { MPI_Init(0, 0); exit(0); }\n',
    "docs/a.md": "The work is in tension; an issue of units. networks/x\n",
}


def violations(files):
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        (root / "packages").mkdir()
        for path, text in files.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text + "\n", encoding="utf-8")
        (root / "docs").mkdir(exist_ok=True)
        (root / "docs/picture.png").write_bytes(b"\x89PNG\xff\xfe")
        return check(root)


class CheckRules(unittest.TestCase):
    def test_every_violation_is_found(self):
        for path, text, rule in BAD:
            with self.subTest(path=path, text=text):
                self.assertEqual([v[2] for v in violations({path: text})], [rule])

    def test_line_is_named(self):
        text = "/* two\nlines */\n\nvoid f() { exit(1); }"
        self.assertEqual([v[:2] for v in violations({"packages/base/a.cpp": text})], [("packages/base/a.cpp", 4)])

    def test_good_sources_pass(self):
        self.assertEqual(violations(GOOD), [])

    def test_meanings_start_with_a_noun(self):
        for meaning in ("name of a boundary", "the box of cells", "Young's modulus E; typical", "two-point flux scheme"):
            self.assertEqual(defect(meaning), "", meaning)
        for meaning in ("gap", "of the fluid, with rate", "whether cells are cut", "mu of the bound", "K_n at zero traction",
                        "auto: most unknowns that", "Which step is taken", "the 2D: x, y of a line"):
            self.assertTrue(defect(meaning), meaning)


if __name__ == "__main__":
    unittest.main()
