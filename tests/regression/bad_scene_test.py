#!/usr/bin/env python3
"""Error messages for bad scenes, see bad_input.py."""
import os
import random
import re

from bad_input import BadInput, PUSH, replaced, setUpModule  # noqa: F401
from program import main


class Scenes(BadInput):
    def test_files(self):
        self.refuse(["absent.xml: there is no such file"], "run", "absent.xml")
        self.refuse([".: is a folder"], "run", ".")
        (self.folder / "a.xml").write_text("")
        self.refuse(["a.xml: is empty"], "run", "a.xml")
        (self.folder / "a.xml").write_text(self.scene(PUSH).read_text()[:600])
        self.refuse(["a.xml: not well-formed XML: line "], "run", "a.xml")
        (self.folder / "a.xml").write_bytes(random.Random(2).randbytes(3000))
        self.refuse(["a.xml: line 1: byte 0x", "not UTF-8"], "run", "a.xml")
        os.truncate(self.folder / "a.xml", 1 << 40)
        self.refuse(["a.xml: has 1099511627776 bytes; an XML file may have"], "run", "a.xml")
        self.refuse(["/dev/zero: is a device"], "run", "/dev/zero")
        self.assertFalse((self.folder / "output").exists())

    def test_encodings(self):
        text = self.scene(PUSH).read_text().replace('"rock"', '"r\xf8ck"')
        path = self.folder / "a.xml"
        for encoding in ("utf-8", "utf-8-sig"):
            path.write_bytes(text.encode(encoding))
            self.call("check", "a.xml")
        path.write_bytes(text.encode("latin-1"))
        self.refuse(["a.xml: line 16: byte 0xf8 is not UTF-8"], "check", "a.xml")
        path.write_bytes(text.encode("utf-16"))
        self.refuse(["a.xml: line 1: byte 0xff is not UTF-8"], "check", "a.xml")
        path.write_text(text.replace("\xf8", "&#248;"))
        self.refuse(["a.xml: line 16: has the character reference &#248;"], "check", "a.xml")
        path.write_text(text.replace("\xf8", "&oslash;"))
        self.refuse(["a.xml: not well-formed XML: line 16", "undefined entity"], "check", "a.xml")

    def test_misspelt_entry_is_reported_once(self):
        for old, new in (("displacement", "displacment"), ("friction coefficient", "friction coeficient"), ("shear modulus", "sheer modulus")):
            text = self.scene(PUSH).read_text().replace(f'name="{old}"', f'name="{new}"', 1)
            (self.folder / "a.xml").write_text(text)
            err = self.refuse([f'"{new}": unknown. Did you mean "{old}"?'], "check", "a.xml")
            self.assertEqual(err.count("\n"), 1, err)

    def test_what_regions_have_of_their_own(self):
        self.refuse_set(['Regions > bulk > "pressure": needs the section "Flow"'], "Regions.bulk.pressure=1")
        self.refuse_set(['Regions > bulk > "initial stress": has 2 values, must have 4'], "Regions.bulk.initial stress={0, 0}")
        self.refuse_set(['Regions > bulk > "initial stress": is "t"; it may depend on the position, not on t'], "Regions.bulk.initial stress={0, t, 0, 0}")

    def test_names_of_other_programs_are_known(self):
        for name, reported in (("kn", 'Did you mean "normal stiffness"?'), ("shear stiffness", 'Did you mean "tangential stiffness"?'),
                           ("K_s", 'Did you mean "tangential stiffness"?'), ("Cohesion", 'It belongs to bond "constant cohesion", "linear softening"; here it is "none"'),
                           ("JRC", 'Did you mean "joint roughness coefficient"? It belongs to friction "Barton-Choubey"'),
                           ("JCS", 'Did you mean "joint wall strength"?'), ("mu", 'Did you mean "friction coefficient"?\n'),
                           ("phi", 'Did you mean "friction angle"?\n'), ("psi", 'Did you mean "dilation angle"?\n')):
            self.refuse_set([f'joint > "{name}": unknown. ', reported], f"Materials.joint.{name}=1")

    def test_laws_of_joints(self):
        joint = "Materials.rough joint."

        def refuse(expected, *sets):
            err = self.refuse(expected, "check", self.scene("verification/joint_kinds_2d.xml"),
                              *(word for entry in sets for word in ("--set", entry)))
            self.assertEqual(err.count("\n"), 1, err)
        refuse(['rough joint > "friction": is "Barton", must be one of "Coulomb", "Barton-Choubey"'], joint + "friction=Barton")
        refuse(['rough joint > "closure": is "Linear", must be one of', 'Did you mean "linear"?'], joint + "closure=Linear")
        refuse(['rough joint > "friction angle": unknown. It belongs to friction "Coulomb", "slip weakening"; here it is "Barton-Choubey"'],
               joint + "friction angle=30")
        refuse(['planar joint > "joint wall strength": unknown. It belongs to friction "Barton-Choubey", "mobilised Barton-Choubey"; '
                'dilation "mobilised"; closure "Bandis"; here they are "Coulomb", "constant angle", "Barton-Bandis"'],
               "Materials.planar joint.joint wall strength=1e8")
        refuse(['rough joint > "maximum closure": unknown. It belongs to closure "Barton-Bandis", "Barton-Bandis with memory"; here it is "linear"'],
               joint + "maximum closure=1e-3")
        refuse(['rough joint: "largest friction angle" must not be below "residual friction angle"'], joint + "largest friction angle=20")
        refuse(['rough joint > "joint wall strength": is 0, must be positive'], joint + "joint wall strength=0")
        refuse(['joint > "normal stiffness": missing; it is required with closure "linear"'], "Materials.joint.type=joint",
               "Materials.joint.friction angle=30", "Materials.joint.closure=linear", "Fractures.planar.material=joint")
        refuse(['rough joint > "fracture energy": missing; it is required with a "tensile strength" above 0'], joint + "bond=linear softening",
               joint + "cohesion=0", joint + "tensile strength=1e6")
        refuse(['rough joint: give either "peak slip" or "joint length"'], joint + "friction=mobilised Barton-Choubey")
        refuse(['planar joint: residual friction must not be above the friction at peak'],
               *(f"Materials.planar joint.{entry}" for entry in ("friction=slip weakening", "residual friction coefficient=0.9",
                                                                 "weakening distance=1")))
        refuse(["planar joint: slip would produce energy instead of dissipating it: after a slip of 0.01 m under 1 Pa the friction bound is 0.3196 Pa, "
                "and dilation requires 0.364 Pa"],
               *(f"Materials.planar joint.{entry}" for entry in ("damage=isotropic", "damage length of friction=0.01",
                                                                 "residual part of friction=0.05", "dilation angle=20")))
        text = self.scene("verification/joint_kinds_2d.xml").read_text()
        line = '      <Parameter name="joint roughness coefficient" type="double" value="8"/>\n'
        (self.folder / "a.xml").write_text(text.replace(line, ""))
        self.refuse(['rough joint > "joint roughness coefficient": missing; it is required with friction "Barton-Choubey"'], "check",
                    "a.xml")
        self.refuse(["Sprekk > Materials > rough joint: ", '"joint roughness coefficient" = x-0.7 is -0.', "must be at least 0"], "run",
                    self.scene("verification/joint_kinds_2d.xml"), "--set", joint + "joint roughness coefficient=x-0.7", any_point=True)

    def test_steps_that_choose_themselves(self):
        self.refuse_set(['Time > "steps": is 4: not allowed with "tolerance"'], "Time.steps=4", "Time.tolerance=0.1")
        self.refuse_set(['Time > "steps": is 4: not allowed with "target Newton iterations"'], "Time.steps=4", "Time.target Newton iterations=5")
        self.refuse_set(['Time > "first step": is 1 s: needs "tolerance" or "target Newton iterations"'], "Time.first step=1")
        chosen = self.scene("poro/shut_in_2d.xml")
        for entry, words in (("tolerance=0", '"tolerance": is 0, must be between 1e-08 and 0.5'), ("tolerance=2", "must be between"),
                             ("smallest step=0", '"smallest step": is 0, must be positive'), ("target Newton iterations=0", "must be between 1 and 1000")):
            self.refuse([words], "check", chosen, "--set", f"Time.{entry}")
        self.refuse(['"smallest step": is 7200 s, must be at most the "largest step", 3600 s'], "check", chosen, "--set", "Time.smallest step=2 h", "--set", "Time.largest step=1 h")
        self.refuse(['"first step": is 60 s, must be at least the "smallest step", 3600 s'], "check", chosen, "--set", "Time.smallest step=1 h", "--set", "Time.first step=1 min")
        self.refuse(['"first step": is 7200 s, must be at most the "largest step", 3600 s'], "check", chosen, "--set", "Time.first step=2 h", "--set", "Time.largest step=1 h")
        text = self.scene("point/cyclic_shear.xml").read_text().replace('"steps" type="int"', '"target Newton iterations" type="int"')
        (self.folder / "a.xml").write_text(text)
        self.refuse(['"target Newton iterations", which needs a mesh'], "point", "a.xml")
        text = self.scene("point/cyclic_shear.xml").read_text().replace('"steps" type="int" value="8"', '"tolerance" type="double" value="0.1"')
        (self.folder / "a.xml").write_text(text)
        self.refuse(['Time: chooses steps by "tolerance", which needs a mesh or friction that depends on the slip rate; Point > "material" has friction "Coulomb"'],
                    "point", "a.xml")

    def test_friction_by_slip_rate(self):
        def refuse(expected, *sets):
            self.refuse([expected], "check", self.scene("earthquakes/spring_slider_2d.xml"), *(word for entry in sets for word in ("--set", f"Materials.joint.{entry}")))
        refuse('friction "rate and state" depends on the slip rate and requires bond "none" and damage "none"; they are "constant cohesion" and "none"',
               "bond=constant cohesion", "cohesion=1e5")
        refuse('give either "initial state" or "initial friction coefficient"', "initial friction coefficient=0.6")
        refuse('"initial slip rate": is 0, must be positive', "initial slip rate=0")
        refuse('"radiation damping": is -1, must be at least 0', "radiation damping=-1")
        refuse('depends on the slip rate and requires bond "none" and damage "none"; they are "none" and "isotropic"', "damage=isotropic",
               "damage length of friction=1e-3")
        refuse('they are "constant cohesion" and "none"', "bond=constant cohesion", "cohesion=1e5 + x")
        gouge = ("dilation=slip rate", "dilatancy coefficient=1e-4", "gouge thickness=1e-3")
        refuse('"gouge thickness": missing; it is required with dilation "slip rate"', *gouge[:2])
        self.refuse_set(['dilation "slip rate" requires friction "rate and state" or "rate and state, slip law", whose state controls the steps; it is "Coulomb"'],
                        *(f"Materials.joint.{entry}" for entry in (*gouge, "state evolution distance=1e-5", "initial slip rate=1e-9")))

    def test_events_without_faces(self):
        for scene, reason in (("performance/elastic_3d.xml", "requires fractures, and the mesh has none"),
                              ("flow/network_2d.xml", "requires deformable rock, and the rock of this scene is rigid")):
            self.refuse([f'Output > "events": {reason}'], "check", self.scene(scene), "--set", "Output.events.rate=1e-3")

    def test_types_and_lengths(self):
        moved = "Boundary conditions.moved.displacement"
        self.refuse_set(['"cells": is the array {2, 2.5}, expected integers'], "Mesh.cells={2, 2.5}")
        self.refuse_set(['"steps": is the string "many", expected an integer'], "Time.steps=many")
        self.refuse_set(["Boundary conditions > moved > \"displacement\": has 1 value, must have 2"], moved + "={0}")
        self.refuse_set(["Bulk > \"body force\": has 3 values, must have 2"], "Bulk.body force={0, 0, 0}")
        self.refuse_set(['Fractures > fracture > "fluid pressure": is infinite, must be finite'], "Fractures.fracture.fluid pressure=infinite")
        self.refuse_set(["cells", "has 1 component", "needs 2"], "Mesh.cells={2}")
        self.refuse_set(["cells", "{2000000000, 2000000000}", "may make"], "Mesh.cells={2000000000, 2000000000}")
        self.refuse([': missing; it is required: '], "check", self.scene_with(('<Parameter name="boundary" type="string" value="north"/>', "")))
        self.refuse(["scene.xml", '"end"', '"nan"', "not a number"], "check",
                    self.scene_with(('<Parameter name="end" type="double" value="1"/>', '<Parameter name="end" type="double" value="nan"/>')))

    def test_heat(self):
        def refuse(expected, *sets):
            self.refuse(expected, "check", self.scene("heat/cooling_2d.xml"), *(word for entry in sets for word in ("--set", entry)))
        surface = "Boundary conditions.surface."
        refuse(['Materials > rock > "thermal conductivity": missing; it is required with "Heat"'], "Materials.rock.thermal conductivity={}")
        refuse(['"thermal conductivity" = {-1} is not positive definite'], "Materials.rock.thermal conductivity={-1}")
        refuse(['"volumetric heat capacity": is -1, must be at least 0'], "Materials.rock.volumetric heat capacity=-1 J/(m^3*K)")
        refuse(['surface: give either "temperature" or "heat flux"'], surface + "heat flux=1")
        refuse(['"heat transfer coefficient": is -1, must be at least 0'], surface + "heat transfer coefficient=-1")
        refuse(['unknown unit "degF"'], surface + "temperature=20 degF")
        refuse(['Heat > "scheme": "rt0" takes triangles and tetrahedra'], "Heat.scheme=rt0")
        refuse(['"heat transfer coefficient" = y - 2 is -1.'], surface + "heat transfer coefficient=y - 2")
        refuse(['Materials > rock: "volumetric heat capacity" = 1-x is -', "must be at least 0"], "Materials.rock.volumetric heat capacity=1-x")
        refuse(['"volumetric heat capacity": is "t"; it may depend on the position, not on t'], "Materials.rock.volumetric heat capacity=t")
        refuse(["Heat: the level of the temperature is not determined"], surface + "heat transfer coefficient=0",
               "Materials.rock.volumetric heat capacity=0 J/(m^3*K)")
        refuse(['"error estimate": is of triangles and tetrahedra where something flows; the mesh is of quadrilaterals'], "Output.error estimate=true")
        refuse(['Heat > "fluid": needs the section "Flow"', 'Heat > "advection": needs the section "Flow"'], "Heat.fluid=water",
               "Heat.advection=second order")
        refuse(["rock: no elastic constants given, exactly two are needed where the rock deforms"], "Bulk.rigid=false")
        self.refuse_set(['moved > "temperature": needs the section "Heat"'], "Boundary conditions.moved.temperature=1")
        self.refuse_set(['Heat > "fluid heat capacity": needs the section "Flow"', 'Heat > "fluid thermal expansion": needs the section "Flow"'],
                        "Heat.fluid heat capacity=4e6", "Heat.fluid thermal expansion=5e-4")
        self.refuse_set(['Heat > "initial temperature": missing; it is required'], "Heat.source=1",
                        "Materials.rock.volumetric heat capacity=1")
        self.refuse_set(['Bulk > "rigid": leaves nothing to solve for'], "Bulk.rigid=true")

    def test_heat_with_a_fluid(self):
        def refuse(expected, *sets, scene="thm/doublet_2d.xml"):
            self.refuse(expected, "check", self.scene(scene), *(word for entry in sets for word in ("--set", entry)))
        north = "Boundary conditions.north."
        refuse(['Heat > "fluid heat capacity": missing; it is required with "Flow"'], "Heat.initial temperature=350",
               "Materials.granite.thermal conductivity={2.8}", scene="poro/injection_2d.xml")
        refuse(['Heat > "initial temperature": missing; it is required where the filling of fractures has a heat capacity'],
               "Heat.fluid heat capacity=4e6", "Materials.granite.thermal conductivity={2.8}", north + "temperature=300", scene="poro/injection_2d.xml")
        refuse(['Heat > Wells > inyector: is "inyector", must be one of "injector", "producer"'], "Heat.Wells.inyector.temperature=300")
        refuse(['"fluid heat capacity": is -1, must be at least 0'], "Heat.fluid heat capacity=-1")
        refuse(['Heat > "fluid": is "steam", must be one of "constant", "exponential", "water"'], "Heat.fluid=steam")
        refuse(['Heat > "fluid thermal expansion": is part of "fluid" = "water"'], "Heat.fluid=water")
        refuse(['Heat > "viscosity decay": requires "fluid" = "exponential"; here it is "constant"'], "Heat.viscosity decay=0.02")
        refuse(['Wells > injector > "temperature": is 200 K, must be between 273.16 and 623.15 K'], "Heat.fluid=water",
               "Heat.fluid thermal expansion=0", "Heat.Wells.injector.temperature=200")
        refuse(['Time > "scheme": is "BDF2": Heat > "advection" = "second order" requires implicit Euler'],
               "Heat.advection=second order", "Time.scheme=BDF2")
        refuse(['Heat > "heat of friction": needs fractures, and rock that deforms'], "Heat.heat of friction=true", "Flow.rigid rock=true")
        refuse(['Materials > rough joint > "thermal conductivity": is 0, must be positive'], "Materials.rough joint.thermal conductivity=0")
        refuse(['"thermal expansion": is "t"; it may depend on the position, not on t'], "Materials.granite.thermal expansion=t")
        refuse(['Boundary conditions > end: gives a "heat flux", which is one of rock, not of a "fracture"'], "Boundary conditions.end.boundary=north",
               "Boundary conditions.end.fracture=west", "Boundary conditions.end.heat flux=1")
        refuse(['gives a heat flux where "north" gives the temperature'], "Boundary conditions.more.boundary=north", "Boundary conditions.more.heat flux=1")

    def test_flow(self):
        def refuse(expected, *sets):
            self.refuse(expected, "check", self.scene("flow/source_2d.xml"), *(word for entry in sets for word in ("--set", entry)),
                        any_point=any(re.search(r"\b[xy]\b", entry.split("=", 1)[1]) for entry in sets))
        refuse(["Materials > rock: no elastic constants given, exactly two are needed where the rock deforms"], "Flow.rigid rock=false")
        refuse(['Materials > rock > "permeability": "permeability" = {-1} is not positive definite'], "Materials.rock.permeability={-1}")
        refuse(['"permeability" = {1, 1, 2} is not positive definite'], "Materials.rock.permeability={1, 1, 2}")
        refuse(['"permeability" has 4 values, must have 1, 2 or 3 in 2D'], "Materials.rock.permeability={1, 1, 0, 0}")
        refuse(['Materials > rock > "permeability": missing'], "Materials.rock.permeability={}")
        refuse(['"porosity": is -0.1, must be'], "Materials.rock.porosity=-0.1")
        refuse(['Materials > rock: give either "compressibility of pores" or "Biot modulus"'],
               "Materials.rock.compressibility of pores=0", "Materials.rock.Biot modulus=1")
        refuse(['Materials > rock > "Biot modulus": is 0, must be positive or infinite'], "Materials.rock.Biot modulus=0")
        refuse(['Materials > rock: "Biot modulus": is 11 Pa, must not be above 10 Pa, the value of "porosity" and "compressibility"'],
               "Materials.rock.Biot modulus=11", "Materials.rock.porosity=0.2", "Flow.compressibility=0.5")
        refuse(['Materials > rock: "porosity" = 0.5-x is -0.', "must be between 0 and 1"], "Materials.rock.porosity=0.5-x")
        refuse(['Materials > rock: "Biot modulus": is 11 Pa, must not be above 10 Pa at ('], "Materials.rock.Biot modulus=11", "Materials.rock.porosity=0.2+0*x",
               "Flow.compressibility=0.5")
        refuse(['"scheme"', '"mpfa"', '"mimetic"'], "Flow.scheme=mpfa")
        refuse(['Boundary conditions > west: give either "pressure" or "flux"'], "Boundary conditions.west.flux=1")
        refuse(['Boundary conditions > west: moves or loads the rock'], "Boundary conditions.west.displacement={0, 0}")
        closed = [("<ParameterList name=\"Boundary conditions\">.*?\n  </ParameterList>\n", "")]
        text = self.scene("flow/source_2d.xml").read_text()
        for pattern, new in closed:
            text = re.sub(pattern, new, text, flags=re.DOTALL)
        (self.folder / "a.xml").write_text(text)
        self.refuse(["Flow: the level of the pressure is not determined"], "check", "a.xml")
        self.refuse(['Materials > rock: "permeability" = {0.25-x} is not positive definite at x = (0.'], "check", self.scene("flow/source_2d.xml"),
                    "--set", "Materials.rock.permeability={0.25-x}", any_point=True)
        refuse(['Flow: without fractures, needs rock with a "permeability" above 0', 'Flow > "source": needs rock'], "Materials.rock.permeability={0}")
        refuse(['rock > "permeability": is "1+t"; it may depend on the position, not on t'], "Materials.rock.permeability={1+t}")
        refuse(['west > "conductance"', 'must be at least 0'], "Boundary conditions.west.conductance=-1")
        refuse(['west > "conductance": is "t"; it may depend on the position, not on t'], "Boundary conditions.west.conductance=t")
        refuse(['Bulk: prescribes a force or stress of the rock'], "Bulk.body force={1, 0}")
        (self.folder / "b.xml").write_text(self.scene(PUSH).read_text().replace('name="fracture"', 'name="intersections"'))
        self.refuse(['Fractures > "intersections": is the name of intersections'], "check", "b.xml")
        self.refuse_set(['moved > "pressure": needs the section "Flow"'], "Boundary conditions.moved.pressure=1")
        self.refuse_set(['Time > "scheme": is "BDF2": needs the section "Flow" or "Heat"'], "Time.scheme=BDF2")
        self.refuse(['"rt0" takes triangles and tetrahedra'], "run", self.scene("flow/source_2d.xml"), "--set", "Mesh.cell=quadrilateral", "--set", "Flow.scheme=rt0")

    def test_poroelasticity(self):
        def refuse(expected, *sets):
            self.refuse(expected, "check", self.scene("poro/injection_2d.xml"), *(word for entry in sets for word in ("--set", entry)),
                        any_point=any(re.search(r"\b[xy]\b", entry.split("=", 1)[1]) for entry in sets))
        refuse(['granite > "Biot coefficient": is 1.2, must be between 0 and 1'], "Materials.granite.Biot coefficient=1.2")
        refuse(['Materials > granite: "Biot coefficient" = 1.2-0*x is 1.2 at (', "must be between 0 and 1"],
               "Materials.granite.Biot coefficient=1.2-0*x")
        refuse(['middle > "fluid pressure": is computed, not given, with "Flow"'], "Fractures.middle.fluid pressure=1")
        refuse(['Output > "error estimate": is of triangles and tetrahedra where something flows'], "Output.error estimate=true", "Mesh.cell=quadrilateral")
        refuse(['middle > "cuts": needs "Flow > rigid rock"'], "Fractures.middle.cuts={east}")
        refuse(['Materials > rough joint: give either "friction coefficient" or "friction angle"'], "Materials.rough joint.friction angle=30")

    def test_channels(self):
        def refuse(expected, scene, *sets):
            self.refuse(expected, "check", self.scene(scene), *(word for entry in sets for word in ("--set", entry)))
        shaft, pipes = "Flow.Intersections.shaft.", "flow/channels_3d.xml"
        refuse(['shaft > "fractures": is "east", must be one of'], pipes, shaft + "fractures={north joint, east}")
        refuse(['shaft > "fractures": has "bedding" twice'], pipes, shaft + "fractures={bedding, bedding}")
        refuse(['shaft: give either "diameter" or "permeability times area"'], pipes, shaft + "permeability times area=1e-9")
        refuse(['shaft > "diameter": is 0, must be'], pipes, shaft + "diameter=0")
        (self.folder / "named.xml").write_text(self.scene(pipes).read_text().replace("bedding", "channels"))
        self.refuse(['Fractures > "channels": is the name of channels'], "check", "named.xml")
        refuse(["Flow > Intersections > shaft: needs a mesh in 3D"], "flow/network_2d.xml", shaft + "diameter=0.02")
        refuse(['not available with "Flow > Intersections"'], pipes, "Output.error estimate=true")

    def test_flow_in_fractures(self):
        def refuse(expected, *sets, command="check"):
            self.refuse(expected, command, self.scene("flow/network_2d.xml"), *(word for entry in sets for word in ("--set", entry)),
                        any_point=command == "run")
        joint, west = "Materials.open joint.", "Boundary conditions.west."
        refuse(['open joint > "initial aperture": is 0, and so is "residual aperture"'], joint + "initial aperture=0")
        refuse(["Materials > open joint: the hydraulic aperture is 0 at (", "must be above 0"], joint + "initial aperture=2e-4*(x>50)", command="run")
        for entry in ("tangential permeability", "normal permeability"):
            refuse([f'open joint > "{entry}": is 0, must be'], joint + entry + "=0")
        refuse(['west > "fracture": is "lon", must be one of', 'Did you mean "long"?'], west + "fracture=lon")
        refuse(['west: give either "fracture" or "region"'], west + "fracture=long", west + "region=bulk")
        refuse(['Fractures > long > "fluid pressure": is computed, not given'], "Fractures.long.fluid pressure=3e6")
        refuse(['west > "fracture": "long" does not end on "west"; it ends on "east"'], west + "fracture=long", command="run")
        refuse(['Boundary conditions > end: gives a conductance where "east" gives the pressure'], "Boundary conditions.end.boundary=east",
               "Boundary conditions.end.fracture=long", "Boundary conditions.end.pressure=1", "Boundary conditions.end.conductance=1")
        refuse(['both > "conductance": needs a "pressure"'], "Boundary conditions.both.boundary=west", "Boundary conditions.both.flux=1",
               "Boundary conditions.both.conductance=1")
        refuse(['"early(t)"', 'table "early"', "is outside of [0, 1000000]"], west + "pressure=early(t)", "Tables.early.arguments={0, 1e6}",
               "Tables.early.values={1e6, 2e6}", command="run")
        xml = self.scene_with(('      <Parameter name="friction coefficient" type="double" value="1"/>\n', ""))
        self.refuse(['Materials > joint: give either "friction coefficient" or "friction angle"'], "check", xml)
        self.refuse_set(['Fractures > fracture > "source": needs the section "Flow"'], "Fractures.fracture.source=1")
        self.refuse_set(['"fracture": not available with "displacement", "traction", "confining pressure" and "foundation stiffness"'], "Boundary conditions.moved.fracture=fracture")
        self.refuse_set(['ground > "foundation stiffness": has 3 values, must have 2, or 1 along the normal'], "Boundary conditions.ground.boundary=east", "Boundary conditions.ground.foundation stiffness={1, 1, 1}")

    def test_values_at_places(self):
        """Messages about values of expressions contain the section and readable numbers."""
        leak_off = self.scene("growth/leak_off_2d.xml")
        self.refuse(['Sprekk > Fractures > growing: "leak-off coefficient" = 1e-6*(x - 1) is -', ", must be at least 0"], "run", leak_off,
                    "--set", "Fractures.growing.leak-off coefficient=1e-6*(x - 1)", any_point=True)
        west = "Boundary conditions.west."
        self.refuse(['Sprekk > Boundary conditions > west: "conductance" = -1e-12*y is -', ", must be at least 0"], "run",
                    self.scene("flow/network_2d.xml"), "--set", west + "conductance=-1e-12*y", any_point=True)
        err = self.refuse(['bonded joint > "residual aperture": must be above 0'], "check", leak_off, "--set",
                          "Materials.bonded joint.residual aperture=0")
        self.assertEqual(err.count("aperture"), 1)

    def test_flow_in_fractures_of_impermeable_rock(self):
        def refuse(expected, scene, *sets):
            self.refuse(expected, "check", self.scene(scene), *(word for entry in sets for word in ("--set", entry)))
        impermeable = "Materials.granite.permeability={0}"
        refuse(["Flow: transport of the temperature needs rock with a \"permeability\" above 0"], "thm/doublet_2d.xml", impermeable)
        refuse(['Boundary conditions > more > "flux": without "fracture" needs rock'], "poro/injection_2d.xml", impermeable,
               "Boundary conditions.more.boundary=north", "Boundary conditions.more.flux=1e-9")

    def test_measured_loads(self):
        moved, stress = "Boundary conditions.moved.", "Bulk.in-situ stress."
        self.refuse_set(['moved: give either "displacement" or "confining pressure"'], moved + "confining pressure=1")
        self.refuse_set(['moved > "lower corner": no node of boundary', "is in the box; the nearest to its middle is at (0, 1, 0)"],
                        moved + "lower corner={0.001, 1}")
        self.refuse_set(['moved > "lower corner": has 3 values, must have 2'], moved + "lower corner={0, 1, 0}")
        self.refuse_set(['moved > "upper corner": requires a "lower corner"'], moved + "upper corner={0, 1}")
        self.refuse_set(['moved > "upper corner": [1] is 0.5, must be at least 1, the value of "lower corner"'], moved + "lower corner={0, 1}",
                        moved + "upper corner={0, 0.5}")
        self.refuse_set(['in-situ stress > "datum" (m): missing; it is required'], stress + "Sv=1")
        self.refuse_set(['in-situ stress > "azimuth": is 30 degrees; in 2D SHmax lies in the section, 90 or 270, or across it, 0 or 180'], stress + "datum=0",
                        stress + "azimuth=30")
        self.refuse_set(['Bulk: give one of "initial stress", "lithostatic stress" and "in-situ stress"'], stress + "datum=0",
                        "Bulk.initial stress={-1, -1, -1, 0}")

    def test_tables(self):
        table = ["Tables.ramp.arguments={0, 1}", "Tables.ramp.values={0, 1}"]
        self.refuse_set(["Tables > ramp: has 2 arguments but 1 value"], table[0], "Tables.ramp.values={0}")
        self.refuse_set(["Tables > ramp", "increase strictly", "argument 1 is 0"], "Tables.ramp.arguments={0, 0}", table[1])
        for value in ("nan", "inf"):
            xml = self.scene_with(("</ParameterList>\n</ParameterList>", f'''</ParameterList>
              <ParameterList name="Tables"><ParameterList name="ramp">
              <Parameter name="arguments" type="Array(double)" value="{{0, 1}}"/>
              <Parameter name="values" type="Array(double)" value="{{0, {value}}}"/>
              </ParameterList></ParameterList></ParameterList>'''))
            self.refuse(["Sprekk > Tables > ramp", f'"{value}"', "not a number"], "check", xml)
        self.refuse_set(['moved > "displacement"[0]: "ramp(t+1)" at x = (', 't = 1: table "ramp": argument 2 is outside of [0, 1]'],
                        "Boundary conditions.moved.displacement={ramp(t+1), 0}", *table, any_point=True)
        self.refuse_set(['"rmp(t)": unknown name "rmp" at position 0. Did you mean "ramp"? Allowed are'],
                        "Boundary conditions.moved.displacement={rmp(t), 0}", *table)

    def test_expressions_that_become_nan(self):
        self.refuse_set(['moved > "displacement"[1]: "0/(t-1)" at x = (', "1, 0), t = 1: is nan, must be finite"],
                        "Boundary conditions.moved.displacement={0, 0/(t-1)}", any_point=True)
        self.refuse_set(['moved > "displacement"[1]: "sqrt(x-0.3)" at x = (0, 1, 0), t = 1: is nan, must be finite'],
                        "Boundary conditions.moved.displacement={0, sqrt(x-0.3)}")
        self.refuse_set(['Bulk > "body force"[0]: "sqrt(-1-t)" at x = (0', "t = 1: is nan, must be finite"],
                        "Bulk.body force={sqrt(-1-t), 0}", any_point=True)
        self.refuse_set(['Fractures > fracture > "fluid pressure": "log(-1-t)" at x = (', "t = 1: is nan, must be finite"],
                        "Fractures.fracture.fluid pressure=log(-1-t)", any_point=True)
        self.refuse_set(['friction coefficient', "x-5", "must be at least 0"], "Materials.joint.friction coefficient=x-5",
                        "Mesh.cells={1, 2}")


    def test_numbers_with_commas(self):
        """The hint about separators occurs for numbers with commas, and not otherwise."""
        hint = "numbers have a decimal point and no separators of thousands"
        for value in ("30,000 MPa", "30 000", "30'000", "-1,5"):
            self.refuse_set([f'"shear modulus": is "{value}"', hint], f"Materials.rock.shear modulus={value}")
        self.refuse_set(['"end": is the string "1,5"', hint], "Time.end=1,5")
        err = self.refuse_set(['"soon"'], "Time.end=soon")
        self.assertNotIn(hint, err)
        xml = self.scene_with(('<Parameter name="end" type="double" value="1"/>', '<Parameter name="end" type="double" value="1,5"/>'))
        self.refuse(['"end": is "1,5", not a number', hint], "check", xml)

    def test_units(self):
        moved = "Boundary conditions.moved."
        self.refuse_set(['"30 GPs"', 'unknown unit "GPs". Did you mean "GPa"?'], "Materials.rock.shear modulus=30 GPs")
        for value in ("-10 mm*t", "t*10*mm"):
            self.refuse_set([value, "a unit can only follow a number, not be within an expression", "in SI units"],
                            moved + f"displacement={{0, {value}}}")

    def test_scene_of_the_other_kind(self):
        point = "point/cyclic_shear.xml"
        for command in ("run", "check"):
            err = self.refuse([point, "is a scene for `sprekk point`"], command, self.scene(point))
            self.assertEqual(err.count("\n"), 1, err)
        err = self.refuse([PUSH, "is a scene for `sprekk run`"], "point", self.scene(PUSH))
        self.assertEqual(err.count("\n"), 1, err)


    def test_methods_of_nox(self):
        place = "Sprekk > Solver > NOX > "
        for entry, value, words in (("Nonlinear Solver", "Trust Region Based", '"Nonlinear Solver": is the string "Trust Region Based", must be "Line Search Based"'),
                                    ("Nonlinear Solver", "Foo", 'is the string "Foo", must be "Line Search Based"'),
                                    ("Direction.Method", "Steepest Descent", '"Direction": must be absent: Sprekk computes'),
                                    ("Line Search.Method", "More'-Thuente", '"Line Search": must be absent: Sprekk computes'),
                                    ("Printing", "3", '"Printing": is the integer 3, must be a section')):
            self.refuse_set([place, words], f"Solver.NOX.{entry}={value}")
        for entry in ("Solver Options.Status Test Check Type=3",):  # checked only by NOX
            self.refuse([PUSH, "Sprekk > Solver > NOX: NOX does not take these parameters: Error"], "run", self.scene(PUSH),
                        "--set", "Solver.NOX." + entry)

    def test_entries_of_libraries_that_would_not_be_noticed(self):
        self.refuse_set(['Linear solver > Belos > "Num Blocks": is the integer -5, must be an integer, at least 1'],
                        "Solver.Linear solver.Belos.Num Blocks=-5")
        self.refuse_set(['Linear solver > MUMPS > "ICNTL(18)": cannot be set'], "Solver.Linear solver.MUMPS.ICNTL(18)=3")

    def test_characters_that_xml_forbids(self):
        for reference in ("&#0;", "&#7;"):
            (self.folder / "a.xml").write_text(self.scene(PUSH).read_text().replace('name="moved"', f'name="mo{reference}ved"'))
            self.refuse(["a.xml: line ", f"has the character reference {reference}, which XML does not allow"], "check", "a.xml")

    def test_long_values_are_not_repeated(self):
        """Messages stay short for long values."""
        many = "1+" * 50000
        for override in ("Boundary conditions.moved.displacement={0, " + many + "}", "Boundary conditions.moved.displacement={0, " + many + "t+}",
                         "Materials.rock.shear modulus=" + many, "Time.end=" + many, "Bulk.material=" + many, many, many + "=1",
                         "Solver.tolerance=1" + "0" * 50000 + " Pa", "Time.scheme=" + many):
            err = self.refuse_set([], override)
            self.assertLess(len(err), 2000, err[:2000])
            self.assertIn("... (", err)

    def test_materials_that_depend_on_the_place(self):
        self.refuse([PUSH + ": Sprekk > Materials > joint: ", '"friction coefficient" = x-0.7 is -0.', "must be at least 0"], "run",
                    self.scene(PUSH), "--set", "Materials.joint.friction coefficient=x-0.7", any_point=True)
        self.refuse([PUSH + ": Sprekk > Materials > rock: ", '"shear modulus" = x-0.7 is -0.', "must be positive"], "run",
                    self.scene(PUSH), "--set", "Materials.rock.shear modulus=x-0.7", any_point=True)

    def test_numbers_beyond_use(self):
        self.refuse_set(['Mesh > "rotation": is 1e+308, must be between -360 and 360 (unit: degree)'], "Mesh.rotation=1e308")
        self.refuse_set(['rock > "shear modulus": is 1e-320, too small for a double'], "Materials.rock.shear modulus=1e-320")
        self.refuse_set(['rock > "shear modulus": is -5, must be positive'], "Materials.rock.shear modulus=0-5")

    def test_periodic_sides(self):
        self.refuse_set(['Mesh > "periodic": has "x" twice'], "Mesh.periodic={x, x}")
        self.refuse_set(['moved > "boundary": is "north", which "periodic" connects'], "Mesh.periodic={x, y}")
        self.refuse(['Mesh file > "periodic": has "west" twice'], "check", self.scene("gmsh/crossing.xml"),
                    "--set", "Mesh file.periodic={west, east, west, north}")

    def test_reference_normals_of_a_file(self):
        for normal, n in (("{1}", "1 component"), ("{-1, 1, 0}", "3 components"), ("{-1, 1, 0, 1e6}", "4 components")):
            self.refuse([f'Mesh file > fractures > f1 > "reference normal": has {n}, needs 2'], "check",
                        self.scene("gmsh/crossing.xml"), "--set", f"Mesh file.fractures.f1.reference normal={normal}")


if __name__ == "__main__":
    main()
