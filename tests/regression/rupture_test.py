#!/usr/bin/env python3
"""Rupture by injection, and dilation by the slip rate with confined fluid: rupture_test.py PROGRAM ROOT MPIEXEC"""

import csv
import math
import xml.etree.ElementTree as xml

from program import ProgramTest, main

V0, F0 = 1e-6, 0.6  # defaults
APERTURE, STIFFNESS = 1e-4, 500e9  # m, in situ; Pa/m


def section(name, entries):
    """Section with entries of text, numbers, lists or sections."""
    node = xml.Element("ParameterList", name=name)
    for key, value in entries.items():
        if isinstance(value, dict):
            node.append(section(key, value))
        elif isinstance(value, str):
            xml.SubElement(node, "Parameter", name=key, type="string", value=value)
        else:
            kind = "string" if key == "periodic" else "int" if key == "cells" else "double"
            xml.SubElement(node, "Parameter", name=key, type=f"Array({kind})", value="{" + ", ".join(map(str, value)) + "}")
    return node


def box(lower, upper, cells, periodic=()):
    """Mesh of a box with the fault y = 0."""
    fault = {key: [corner[0], 0, *corner[2:]] for key, corner in (("lower corner", lower), ("upper corner", upper))}
    return section("Mesh", {"cell": "quadrilateral" if len(cells) == 2 else "hexahedron", "lower corner": lower, "upper corner": upper,
                            "cells": cells, "periodic": periodic, "fractures": {"fault": fault}})


class BoxTest(ProgramTest):
    def with_mesh(self, scene, mesh):
        """Writes the scene with another mesh; returns the path."""
        tree = xml.parse(self.scene(scene))
        root = tree.getroot()
        for old in [node for node in root if node.get("name") in ("Mesh file", "Mesh")]:
            root.remove(old)
        root.append(mesh)
        tree.write(self.folder / "scene.xml")
        return str(self.folder / "scene.xml")

    def near(self, value, wanted, delta, what):
        self.assertAlmostEqual(value, wanted, delta=delta, msg=what)


class Rupture(BoxTest):
    """A small version of rupture_2d.xml."""

    A, B, L, DAMPING = 0.005, 0.014, 1.8e-4, 2.85e6  # of the scene, with a longer L for larger cells
    TANGENT, DISTANCE, N = math.tan(math.radians(1)), 3e-4, 30e6

    def table(self, name, output):
        """Columns of a probe without units, one list for each."""
        rows = list(csv.reader((self.folder / output / "probes" / f"{name}.csv").read_text().splitlines()))
        return {title.partition(" [")[0]: [float(row[k]) for row in rows[1:]] for k, title in enumerate(rows[0])}

    def event(self, output):
        rows = list(csv.DictReader((self.folder / output / "events.csv").read_text().splitlines()))
        self.assertEqual(len(rows), 1)
        return {title.partition(" [")[0]: float(text) for title, text in rows[0].items() if title != "fracture"}

    def expect_laws(self, at):
        """In each step: friction, and the aperture by dilation and closure."""
        for slip, normal, shear, rate, state, aperture in zip(*(at[name] for name in (
                "slip", "traction local n", "traction local t", "slip rate", "friction state", "aperture"))):
            psi = F0 + self.B * math.log(V0 * state / self.L)
            strength = -normal * self.A * math.asinh(rate / (2 * V0) * math.exp(psi / self.A)) + self.DAMPING * rate
            self.near(abs(shear) / strength, 1, 1e-6, "friction")
            opening = self.TANGENT * self.DISTANCE * -math.expm1(-slip / self.DISTANCE) + (normal + self.N) / STIFFNESS
            self.near(aperture, APERTURE + opening, 1e-6 * APERTURE, "aperture")

    def test_aseismic_slip_turns_into_a_rupture(self):
        """Laws on a face through the rupture, number of steps, and equality on two ranks. Error estimates of the pressure
        that do not account for growing rates require many more steps."""
        scene = self.with_mesh("earthquakes/rupture_2d.xml", box((-40, -15), (40, 15), (40, 6)))
        entries = (f"Materials.fault rock.state evolution distance={self.L}", "Materials.fault rock.direct effect="
                   f"{self.A} + 0.025*min(max((abs(x) - 25)/10, 0), 1)", "Time.end=980000", "Time.tolerance=0.05", "Output.vtu=false",
                   "Output.time unit=s", "Probes.profile.line={-39, 0, 39, 0}")
        events, last = [], []
        for ranks in (1, 2):
            content = self.run_scene(scene, *entries, ranks=ranks, output=f"out_{ranks}")
            self.assertLess(len(content["steps"]), 200)
            event, at = self.event(f"out_{ranks}"), self.table("face", f"out_{ranks}")
            self.expect_laws(at)
            before = max(slip for t, slip in zip(next(iter(at.values())), at["slip"]) if t <= event["start"])
            self.assertGreater(before, 5 * self.L)
            self.assertGreater(at["slip"][-1], 2 * before)
            self.assertGreater(event["max_slip_rate"], 0.1)
            self.assertGreater(event["length"], 40)
            events.append(event)
            last.append(at["slip"][-1])
        self.near(events[1]["start"] / events[0]["start"], 1, 1e-6, "onset")
        self.near(events[1]["moment"] / events[0]["moment"], 1, 1e-3, "moment")
        self.near(last[1] / last[0], 1, 1e-3, "slip")


class Gouge(BoxTest):
    """A periodic strip with a fault of gouge that strengthens with the rate, and confined fluid. The top accelerates to
    a hundred times the initial rate. Gouge dilates, and fluid and rock share the volume."""

    SHEAR_MODULUS, HEIGHT, COMPRESSIBILITY = 30e9, 2.4, 4.5e-10
    A, B, L, RATE, N = 0.015, 0.01, 1e-5, 1e-9, 50e6
    THICKNESS, EPS = 1e-3, 1e-4

    def test_confined_fluid(self):
        for dim, ranks in ((2, 1), (2, 2), (3, 2)):
            with self.subTest(dim=dim, ranks=ranks):
                self.strip(dim, ranks)

    def strip(self, dim, ranks):
        mesh = box((0, -1.2, 0)[:dim], (1.2, 1.2, 1.2)[:dim], (3, 2, 3)[:dim], tuple("xz"[: dim - 1]))
        psi = F0 + self.B * math.log(V0 / self.RATE)
        shear = self.N * self.A * math.asinh(self.RATE / (2 * V0) * math.exp(psi / self.A))
        stress = [-self.N] * 3 + [shear] + [0] * (2 * dim - 4)
        rest = ["0"] * (dim - 1)
        joint = {"direct effect": self.A, "evolution effect": self.B, "initial state": self.L / self.RATE, "initial slip rate": self.RATE,
                 "radiation damping": 0, "closure": "linear", "normal stiffness": STIFFNESS, "reference state": "in situ",
                 "initial aperture": APERTURE, "dilation": "slip rate", "gouge thickness": self.THICKNESS, "dilatancy coefficient": self.EPS}
        entries = [f"Bulk.initial stress={{{', '.join(map(repr, stress))}}}", f"Boundary conditions.fixed.displacement={{{', '.join(['0', *rest])}}}",
                   f"Boundary conditions.moved.displacement={{{', '.join(['1e-7*t', *rest])}}}",
                   *(f"Materials.joint.{name}={value}" for name, value in joint.items()), "Materials.rock.permeability={0}",
                   f"Flow.compressibility={self.COMPRESSIBILITY}", "Flow.initial pressure=0", "Flow.viscosity=1e-3", "Time.end=1e4",
                   "Time.tolerance=2e-2", "Time.first step=1", "Output.vtu=false",
                   f"Probes.face.point={{{', '.join(['0.5', '0', '0.5'][:dim])}}}"]
        content = self.run_scene(self.with_mesh("earthquakes/spring_slider_2d.xml", mesh), *entries, ranks=ranks, output=f"strip_{dim}_{ranks}")
        opening = slip = pressure = 0
        for step in content["steps"]:
            fault = step["fractures"]["fault"]
            moved, slip = fault["mean_slip"] - slip, fault["mean_slip"]
            steady = self.THICKNESS * self.EPS * math.log(moved / (step["length"] * self.RATE))
            opening += (steady - opening) * -math.expm1(-moved / self.L)
            self.near(fault["mean_opening_by_slip_rate"], opening, 1e-6 * self.THICKNESS * self.EPS, "opening")
            pressure, normal = fault["mean_fracture_pressure"], step["single_fractures"]["mean_traction_local"][0][0] + self.N
            widening = opening + normal / STIFFNESS
            rock = -3 * self.SHEAR_MODULUS / self.HEIGHT * widening  # change of the total normal stress
            self.near(normal - pressure, rock, 1e-6 * abs(pressure) + 1, "equilibrium")
            self.near(widening + APERTURE * self.COMPRESSIBILITY * pressure, 0, 1e-2 * abs(widening) + 1e-6 * self.THICKNESS * self.EPS, "volume")
        self.assertGreater(opening, 0.9 * self.THICKNESS * self.EPS * math.log(100))
        self.assertLess(pressure, -1e5)


if __name__ == "__main__":
    main()
