# Untested: written from Spack's documentation, never run.
from spack.package import *


class Tress(CMakePackage):
    """Testbed for rod and elastic-strand solvers."""

    license("BSD-3-Clause")
    version("1.0.0")

    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("cli11@2:", type="build")
    depends_on("nlohmann-json@3:", type="build")
    depends_on("eigen@3.4:")
    depends_on("fmt@9:")
    depends_on("gsl@2.7:")
    depends_on("hdf5~mpi")
    depends_on("intel-tbb")
    depends_on("node-js@18:", type="run")
    depends_on("python@3.11:", type=("build", "run"))
    depends_on("suite-sparse")
    depends_on("sundials@6.4:6+klu+ida+cvode+arkode~mpi")
    depends_on("tomlplusplus@3:")
    depends_on("zlib-api")

    generator("ninja")

    def cmake_args(self):
        return [
            self.define("TRESS_SUNDIALS_ROOT", self.spec["sundials"].prefix),
            self.define("TRESS_SHARED", True),
            self.define("TRESS_TESTS", False),
            self.define("TRESS_RECORD_FOLDERS", False),
        ]
