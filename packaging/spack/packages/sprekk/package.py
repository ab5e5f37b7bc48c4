from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Sprekk(CMakePackage):
    """Deformation, contact, flow and heat in fractured rock, on finite elements of Trilinos."""

    license("BSD-3-Clause")

    # No release yet: `spack dev-build sprekk@main` in a checkout.
    version("main", branch="main")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    generator("ninja")

    depends_on("mpi")
    # Tested with 13.2; names of later versions are in packages/base/trilinos_compat.hpp.
    depends_on(
        "trilinos@13.2:16"
        "+mpi+tpetra+belos+ifpack2+amesos2+muelu+nox+sacado+stratimikos+thyra+zoltan2 gotype=long_long cxxstd=17"
    )
    depends_on("metis")
    depends_on("mumps+mpi+double")
    depends_on("hdf5+mpi+hl")
    depends_on("vtk@9.1:~opengl2")
    depends_on("muparser")
    depends_on("fmt@9:")
    depends_on("nlohmann-json")
    depends_on("cli11")
    depends_on("zlib-api")

    def cmake_args(self):
        return [self.define("SPREKK_TESTS", False)]
