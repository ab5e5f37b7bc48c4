"""Krylov and Newton iterations of thermo-hydro-mechanics: cold water is injected into hot rock with a network of ten fractures.

Every linear solve goes from zero to a relative residual of 1e-8."""
from perf.poro import poro

HOT, COLD = 420, 320       # K, of the rock and the injected water
HEAT_OF_FLUID = 4.2e6      # J/(m^3 K)
LENGTH = 100.0             # m, of the fractures
CONDUCTIVITY = 2.8         # W/(m K)
SIDES = ("west", "east", "south", "north", "bottom", "top")
HEAT = (f"Materials.granite.thermal conductivity={{{CONDUCTIVITY}}}", "Materials.granite.volumetric heat capacity=2.2e6", "Materials.granite.thermal expansion=8e-6",
        f"Heat.initial temperature={HOT}", f"Heat.fluid heat capacity={HEAT_OF_FLUID:g}", "Heat.fluid thermal expansion=5e-4", f"Heat.Wells.injector.temperature={COLD}",
        *(f"Boundary conditions.{side}.temperature={HOT}" for side in SIDES))
PECLET = {f"Peclet {number:g}": number for number in (1e-3, 1.0, 1e2, 1e5)}
BOUNDS = {"krylov_max": 40, "krylov_growth": 0.3, "newton_max": 8, "newton_growth": 0.3, "exponent": 1.15, "failures": 0}
QUICK = ("alike", "permeability 1e-20", "step 1e+09 s", "Peclet 0.001")


def entries(case):
    """Entries of poromechanics with heat. A Peclet number rho c Q / (lambda L) determines the conductivity lambda
    of the rock."""
    if case not in PECLET:
        return *poro.entries(case), *HEAT
    conductivity = HEAT_OF_FLUID * poro.RATE / (PECLET[case] * LENGTH)
    return *poro.entries("alike"), *HEAT, f"Materials.granite.thermal conductivity={{{conductivity:.17g}}}"


def main(words):
    return poro.measure(poro.Study("thm", __doc__, [*poro.CASES, *PECLET], QUICK, entries, BOUNDS, poro.LEVELS), words)
