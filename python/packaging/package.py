"""A package for Spack 1.0, of a checkout: spack dev-build credence@main. It has not been built yet."""

from spack.package import depends_on, license, version
from spack_repo.builtin.build_systems.cmake import CMakePackage


class Credence(CMakePackage):
    """Monte Carlo consistency studies of filters: can a filter's covariance be believed?"""

    license("BSD-3-Clause")
    version("main")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.22:", type="build")
    depends_on("eigen@3.3:")
    depends_on("boost@1.71: +program_options+math")
    depends_on("hdf5@1.10: +hl~mpi")
    depends_on("libdeflate")
    depends_on("nlohmann-json@3.7:", type="build")

    def cmake_args(self):
        return [self.define("CREDENCE_TESTS", False), self.define("CMAKE_UNITY_BUILD", True)]
