#!/usr/bin/env python3
"""Random networks from statistics: network_test.py PROGRAM ROOT MPIEXEC

Statistics of large samples differ from the requested ones by less than four standard errors."""
import contextlib
import csv
import importlib.util
import io
import sys
import unittest
from dataclasses import replace
from math import erf
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "regression"))

import numpy as np  # noqa: E402
import program  # noqa: E402
from program import ROOT, ProgramTest, main  # noqa: E402


def application(name):
    spec = importlib.util.spec_from_file_location(f"sprekk_{name}", ROOT / "apps" / name / "__main__.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


sys.path[:0] = [str(ROOT / "apps" / name) for name in ("network", "mesh")]
app, mesh = application("network"), application("mesh")

import centres  # noqa: E402
import clip  # noqa: E402
import realised  # noqa: E402
import size_law  # noqa: E402
from draw import Stream  # noqa: E402
from statistics_file import read_statistics  # noqa: E402

FOLDER = ROOT / "xml/networks"
UNIT = np.array([[0.0] * 3, [1.0] * 3])
SET_3D = """seed = 3
[domain]
lower_corner = [0, 0, 0]
upper_corner = [10, 10, 10]
[sets.a]
P32 = 0.5
radius = 2
dip = 30
dip_direction = 200
kappa = 20
"""


class PartsInTheDomain(unittest.TestCase):
    def area(self, centre, pole, radius):
        pole = np.array([pole], float)
        return clip.areas(np.array([centre], float), pole / np.linalg.norm(pole), np.array([radius]), UNIT)[0]

    def test_exact_areas(self):
        r, half = 0.3, np.sqrt(0.3**2 - 0.1**2)
        segment = r**2 * np.arccos(1 / 3) - 0.1 * half  # beyond a chord at the distance 0.1
        for centre, pole, radius, area in (
                ((0.5, 0.5, 0.5), (0, 0, 1), r, np.pi * r**2), ((0.5, 0.5, 0.5), (1, 2, 3), r, np.pi * r**2),
                ((0.5, 0.5, 0), (1, 0, 0), r, np.pi * r**2 / 2), ((0, 0, 0.5), (0, 0, 1), r, np.pi * r**2 / 4),
                ((0.9, 0.5, 0.5), (0, 0, 1), r, np.pi * r**2 - segment), ((1.1, 0.5, 0.5), (0, 1, 0), r, segment),
                ((0.5, 0.5, 1.2), (0, 0, 1), r, 0), ((1.4, 0.5, 0.5), (0, 0, 1), r, 0), ((2, 2, 0.5), (0, 0, 1), 9, 1),
                ((0.5, 0.5, 0.5), (1, 0, 2), 9, np.sqrt(1.25)), ((0.5, 0.5, 0.5), (1, 1, 1), 9, 3 * np.sqrt(3) / 4)):
            with self.subTest(centre=centre, pole=pole, radius=radius):
                self.assertAlmostEqual(self.area(centre, pole, radius), area, 12)

    def test_areas_of_any_discs(self):
        """The share of 20000 evenly distributed points of each disc is accurate to about 1e-3."""
        random = np.random.default_rng(1)
        share, turn = np.sqrt((np.arange(20000) + 0.5) / 20000), np.pi * (3 - np.sqrt(5)) * np.arange(20000)
        for _ in range(100):
            centre, pole, radius = random.uniform(-0.3, 1.3, 3), random.normal(size=3), random.uniform(0.05, 0.8)
            pole /= np.linalg.norm(pole)
            first = np.cross(pole, np.eye(3)[np.argmin(abs(pole))])
            first /= np.linalg.norm(first)
            points = centre + radius * share[:, None] * (np.outer(np.cos(turn), first) + np.outer(np.sin(turn), np.cross(pole, first)))
            inside = ((points >= 0) & (points <= 1)).all(axis=1).mean()
            self.assertAlmostEqual(self.area(centre, pole, radius) / (np.pi * radius**2), inside, delta=2e-3)

    def test_lengths(self):
        along = np.array([[1, 0], [0.6, 0.8], [0, 1], [0, 1]])
        found = clip.lengths(np.array([[0.2, 0.5], [0.5, 0.5], [1, 0.5], [1.1, 0.5]]), along, np.array([1, 9, 0.5, 1]), UNIT[:, :2])
        self.assertTrue(np.allclose(found, [0.7, 1.25, 0.5, 0], atol=1e-14))


class Laws(unittest.TestCase):
    def test_sizes(self):
        """The largest difference of distribution functions has the 99.9 % bound 1.95 / sqrt(n) (Kolmogorov)."""
        n, normal = 20000, np.vectorize(lambda x: 0.5 * (1 + erf(x / np.sqrt(2))))
        for law, share in (
                (size_law.power_law(1.7, 1, 50), lambda r: (1 - r**-1.7) / (1 - 50**-1.7)),
                (size_law.power_law(0, 2, 8), lambda r: np.log(r / 2) / np.log(4)),
                (size_law.log_normal(0.4, 0.6), lambda r: normal((np.log(r) - 0.4) / 0.6)),
                (size_law.exponential(3), lambda r: 1 - np.exp(-r / 3)),
                (size_law.exponential(3, 1, 6), lambda r: (np.exp(-1 / 3) - np.exp(-r / 3)) / (np.exp(-1 / 3) - np.exp(-2)))):
            drawn = np.sort(law.draw(np.random.default_rng(5).random(n)))
            self.assertLess(abs(share(drawn) - (np.arange(n) + 0.5) / n).max(), 1.95 / np.sqrt(n))
        self.assertAlmostEqual(size_law.log_normal(0.4, 0.6).mean(), np.exp(0.58), 6)
        self.assertAlmostEqual(size_law.exponential(3).mean(), 3, 4)
        self.assertAlmostEqual(size_law.constant(2.5).draw(0.3), 2.5, 12)

    def test_mean_cosines(self):
        for kappa in (0.01, 1, 20, 1e4):
            self.assertAlmostEqual(realised.mean_cosine(kappa, 3), 1 / np.tanh(kappa) - 1 / kappa, 5)
        self.assertAlmostEqual(realised.mean_cosine(2, 2), 0.6977746579640077, 6)  # I1(2) / I0(2)

    def test_dimension_of_centres(self):
        """The share of pairs closer than r increases as r^D. The mean over ten cascades is accurate to about 0.1."""
        for dim, dimension in ((2, 1.5), (2, 2.0), (3, 2.3)):
            slopes = []
            for seed in range(10):
                random = np.random.default_rng(seed)
                x = centres.fractal(dimension, dim, random)(random, 1500)
                distance = abs(x[:, None] - x[None]).max(axis=2)[np.triu_indices(1500, 1)]
                near = [(distance < r).sum() for r in (1 / 32, 1 / 4)]
                slopes.append(np.log(near[1] / near[0]) / np.log(8))
            edge = 0.1 * dim  # near the boundary pairs are fewer
            self.assertAlmostEqual(np.mean(slopes), dimension - edge, delta=0.15 + edge)


class Networks(ProgramTest):
    def statistics(self, text):
        path = self.folder / "statistics.toml"
        path.write_text(text)
        return read_statistics(path)

    def test_large_samples_have_the_requested_statistics(self):
        for name in ("statistics_2d.toml", "statistics_3d.toml"):
            statistics = read_statistics(FOLDER / name)
            for index, one in enumerate(statistics.sets):
                with self.subTest(name=name, set=one.name):
                    many = Stream(replace(one, number=20000, intensity=None), statistics, index).fractures()
                    own = many.only(((many.centres >= statistics.box[0]) & (many.centres <= statistics.box[1])).all(axis=1))
                    deviation = np.sqrt(one.size.mean(lambda size: (size - one.size.mean()) ** 2))
                    self.assertLess(abs(own.sizes.mean() - one.size.mean()), 4 * deviation / np.sqrt(len(own)))
                    if one.alpha is not None:
                        alpha, error = size_law.fitted_alpha(own.sizes, *one.size.sizes[[0, -1]])
                        self.assertLess(abs(alpha - one.alpha), 4 * error)
                    mean, kappa, error = realised.fitted_direction(own.normals)
                    self.assertLess(abs(kappa - one.kappa), 4 * error)
                    self.assertLess(np.linalg.norm(np.cross(mean, one.mean)), 4 / np.sqrt(one.kappa * len(own)))

    def test_intensity(self):
        """The intensity is reached to half of the last fracture, and is the same near the boundary."""
        statistics = self.statistics(SET_3D)
        found = Stream(statistics.sets[0], statistics, 0).fractures()
        self.assertLess(abs(found.inside.sum() - 500), np.pi * 2**2 / 2)
        many = Stream(replace(statistics.sets[0], intensity=100), statistics, 0).fractures()
        inner = np.array([[2.5] * 3, [7.5] * 3])
        parts = clip.areas(many.centres, many.normals, many.sizes, inner)
        self.assertLess(abs(parts.sum() / 125 - 100), 4 * np.sqrt((parts**2).sum()) / 125)

    def test_apertures(self):
        law = "aperture = { alpha = 1e-4, beta = 0.5 }\n"
        statistics = self.statistics(SET_3D.replace("radius = 2", 'radius = { distribution = "exponential", mean = 2 }') + law)
        found = Stream(statistics.sets[0], statistics, 0).fractures()
        self.assertTrue(np.allclose(found.apertures, 1e-4 * np.sqrt(found.sizes), rtol=1e-12))
        statistics = self.statistics(SET_3D + "aperture = { alpha = 1e-4, sigma = 0.4 }\n")
        logs = np.log(Stream(replace(statistics.sets[0], number=10000, intensity=None), statistics, 0).fractures().apertures)
        self.assertAlmostEqual(logs.mean(), np.log(1e-4), delta=4 * 0.4 / 100)
        self.assertAlmostEqual(logs.std(), 0.4, delta=4 * 0.4 / np.sqrt(2e4))

    def test_pole_or_dip(self):
        one = self.statistics(SET_3D).sets[0]
        other = self.statistics(SET_3D.replace("dip = 30", "trend = 20").replace("dip_direction = 200", "plunge = 60")).sets[0]
        third = self.statistics(SET_3D.replace("dip_direction = 200", "strike = 110")).sets[0]
        self.assertTrue(np.allclose((other.mean, third.mean), one.mean))
        dip, direction = realised.angles(one.mean[None])
        self.assertTrue(np.allclose((dip[0], direction[0]), (30, 200)))

    def draw(self, path, *words, output="net", expect=0):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            status = app.main([str(path), "-o", str(self.folder / output), "--program", str(program.PROGRAM), *words])
        self.assertEqual(status, expect, out.getvalue() + err.getvalue())
        return err.getvalue() if expect else out.getvalue()

    def test_equal_seeds_give_equal_files(self):
        file = self.folder / "net.toml"
        file.write_text(SET_3D)
        for name, words in (("a", []), ("b", ["--seed", "3"]), ("c", ["--seed", "4"])):
            self.draw(file, "--unchecked", *words, output=name)
        a, b, c = ((self.folder / f"{name}.csv").read_text() for name in "abc")
        self.assertEqual(a, b)
        self.assertNotEqual(a, c)
        file.write_text(SET_3D + SET_3D[SET_3D.index("[sets"):].replace("sets.a", "sets.other"))
        self.draw(file, "--unchecked", output="d")
        self.assertTrue((self.folder / "d.csv").read_text().startswith(a))
        self.assertFalse(list(self.folder.glob("*.csv.*")))
        before = (self.folder / "a.xml").read_text()
        (self.folder / "a.csv").unlink()
        self.assertIn("a.xml: the file exists; remove it", self.draw(file, "--unchecked", output="a", expect=1))
        self.assertFalse((self.folder / "a.csv").exists())
        self.assertEqual((self.folder / "a.xml").read_text(), before)
        self.assertIn("none/a.csv: cannot be written", self.draw(file, "--unchecked", output="none/a", expect=1))

    def test_bad_files(self):
        for old, new, reported in (
                ("seed = 3", "seed = -3", "seed: is -3, must be a whole number of at least 0"),
                ("seed = 3", "sed = 3", "sed: is unknown; the entries here are seed, domain, sets"),
                ("seed = 3", "seed 3", "is not a file in TOML: Expected '=' after a key in a key/value pair (at line 1"),
                ("[10, 10, 10]", "[10, 10]", "domain > upper_corner: is [10, 10], must be above lower_corner, [0, 0, 0]"),
                ("[10, 10, 10]", '"ten"', "domain > upper_corner: is 'ten', must be 2 or 3 numbers of at most 1e12"),
                ("P32 = 0.5", "P32 = 0", "sets > a > P32: is 0, must be a positive number"),
                ("P32 = 0.5", "P21 = 0.5", 'sets > a: needs either "number" or "P32"'),
                ("P32 = 0.5", "P32 = 0.5\nnumber = 3", 'sets > a: needs either "number" or "P32"'),
                ("P32 = 0.5", "P32 = 1e9", "sets > a: has more than 100000 fractures; reduce the intensity"),
                ("radius = 2", "", "sets > a > radius: is missing, must be a positive number, or a section"),
                ("radius = 2", 'radius = "big"', "radius: is 'big', must be a positive number, or a section"),
                ("radius = 2", 'radius = { distribution = "normal" }',
                 'radius > distribution: is \'normal\', must be "power law" or "log-normal" or "exponential"'),
                ("radius = 2", 'radius = { distribution = "power law", alpha = 2, minimum = 3, maximum = 2 }',
                 "radius > maximum: is 2, must be above the minimum, 3"),
                ("radius = 2", 'radius = { distribution = "exponential", mean = 2, minimum = 1e6 }',
                 "sets > a > radius: has no sizes between minimum and maximum"),
                ("dip = 30", "dip = 95", "sets > a > dip: is 95, must be an angle from 0 to 90 degrees"),
                ("dip = 30", "trend = 30\nplunge = 20", "sets > a: needs either trend and plunge of the pole, or dip"),
                ("kappa = 20", "kappa = true", "sets > a > kappa: is True, must be a number from 0 to 1e6"),
                ("kappa = 20", "kappa = nan", "sets > a > kappa: is nan, must be"),
                ("kappa = 20", "kappa = 20\nfractal_dimension = 3.5", "is 3.5, must be a number above 0, at most 3"),
                ("kappa = 20", "kappa = 20\naperture = { alpha = 1e-4, power = 2 }",
                 "aperture > power: is unknown; the entries here are alpha, beta, sigma"),
                ("sets.a", 'sets."a,b"', "sets > a,b: has a name with other characters than letters"),
        ):
            with self.subTest(new=new):
                file = self.folder / "bad.toml"
                file.write_text(SET_3D.replace(old, new))
                error = self.draw(file, "--unchecked", expect=1)
                self.assertIn(f"sprekk: {file}: ", error)
                self.assertIn(reported, error)
                self.assertFalse(list(self.folder.glob("net*")))
        self.assertIn("absent.toml: cannot be read: No such file", self.draw("absent.toml", expect=1))
        file.write_text("[domain]\nlower_corner = [0, 0]\nupper_corner = [3, 3]\n"
                        "[sets.a]\nnumber = 60\nlength = 4\nstrike = 30\nkappa = 1000\n")
        self.assertIn("is too dense: more than a fifth", self.draw(file, expect=1))

    def test_examples_run(self):
        """The table has the fractures of the output, and the scene can be meshed, checked and run."""
        for dim in (2, 3):
            reported = self.draw(FOLDER / f"statistics_{dim}d.toml", output=f"net{dim}")
            scene = self.folder / f"net{dim}.xml"
            with open(self.folder / f"net{dim}.csv") as file:
                rows = list(csv.DictReader(file))
            numbers = [int(line.split()[1]) for line in reported.splitlines() if " fractures, " in line]
            self.assertEqual(len(rows), sum(numbers))
            made = ["-o", str(self.folder / f"net{dim}.msh"), "--program", str(program.PROGRAM)]
            with contextlib.redirect_stderr(io.StringIO()):
                self.assertEqual(mesh.main([str(scene), *made, "--quiet"]), 0)
            path = f"Mesh file.path={self.folder}/net{dim}.msh"
            self.call("check", scene, "--set", path)
            found = self.run_scene(str(scene), path, *(["Time.steps=1"] if dim == 3 else []), output=f"out{dim}")
            self.assertEqual(found["status"], "completed")


if __name__ == "__main__":
    main()
