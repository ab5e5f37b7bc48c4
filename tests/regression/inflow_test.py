#!/usr/bin/env python3
"""Flow into rock through a boundary without a temperature: inflow_test.py PROGRAM ROOT MPIEXEC"""
import itertools

from program import ProgramTest, main

SCENE = """<ParameterList name="Sprekk">
  <ParameterList name="Mesh">
    <Parameter name="cell" type="string" value="{cell}"/>
    <Parameter name="lower corner" type="Array(double)" value="{zeros}"/>
    <Parameter name="upper corner" type="Array(double)" value="{ones}"/>
    <Parameter name="cells" type="Array(int)" value="{cells}"/>
  </ParameterList>
  <ParameterList name="Materials">
    <ParameterList name="rock">
      <Parameter name="type" type="string" value="elastic"/>
      <Parameter name="permeability" type="Array(double)" value="{{1.0}}"/>
      <Parameter name="thermal conductivity" type="Array(double)" value="{{1.0}}"/>
      <Parameter name="volumetric heat capacity" type="double" value="1.0"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Bulk">
    <Parameter name="material" type="string" value="rock"/>
  </ParameterList>
  <ParameterList name="Flow">
    <Parameter name="viscosity" type="double" value="1.0"/>
    <Parameter name="rigid rock" type="bool" value="true"/>
  </ParameterList>
  <ParameterList name="Heat">
    <Parameter name="initial temperature" type="string" value="1 + 0.5*sin(7*x)*cos(5*y)"/>
    <Parameter name="fluid heat capacity" type="double" value="1.0"/>
  </ParameterList>
  <ParameterList name="Boundary conditions">
    <ParameterList name="inflow">
      <Parameter name="boundary" type="string" value="south"/>
      <Parameter name="pressure" type="double" value="200.0"/>
    </ParameterList>
    <ParameterList name="outflow">
      <Parameter name="boundary" type="string" value="{out}"/>
      <Parameter name="pressure" type="double" value="0.0"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Time">
    <Parameter name="end" type="double" value="3.0"/>
    <Parameter name="steps" type="int" value="30"/>
  </ParameterList>
</ParameterList>
"""
# side of the outflow, cells. On triangles, bounds hold for cell Peclet numbers up to about ten only.
BOXES = {"triangle": ("north", "{10, 18}"), "quadrilateral": ("east", "{5, 9}"), "tetrahedron": ("east", "{4, 4, 4}"),
         "hexahedron": ("east", "{3, 4, 3}")}


class Inflow(ProgramTest):
    def test_has_the_local_temperature(self):
        """At a Peclet number of 200, temperatures stay within the initial values, and their span decreases below 1 %."""
        from perf.coupled.written import Written
        for (cell, (out, cells)), ranks in itertools.product(BOXES.items(), (1, 3)):
            n = cells.count(",") + 1
            scene = self.folder / "inflow.xml"
            corners = {"zeros": "{" + ", ".join(n * ["0.0"]) + "}", "ones": "{" + ", ".join(n * ["1.0"]) + "}"}
            scene.write_text(SCENE.format(cell=cell, cells=cells, out=out, **corners))
            last = Written(self.folder / "out", self.run_scene(str(scene), ranks=ranks)).states[-1]
            T = last.bulk.cell_data["temperature"]
            self.assertGreater(T.min(), 0.5, (cell, ranks))
            self.assertLess(T.max(), 1.5, (cell, ranks))
            self.assertLess(T.max() - T.min(), 1e-2, (cell, ranks))


if __name__ == "__main__":
    main()
