"""A recipe for Conan 2 that packs the checkout that it is in: conan create examples/packaging/conan"""

import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, rmdir

ROOT = os.path.join("..", "..", "..")


class HnbrdfConan(ConanFile):
    name = "hnbrdf"
    version = "0.2.0"
    license = "MIT"
    description = "Hybrid neural-microfacet BRDFs: evaluate, sample, fit, export to shaders"
    topics = ("brdf", "rendering", "graphics")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fit": [True, False]}
    default_options = {"shared": False, "fit": True}

    def export_sources(self):
        root = os.path.join(self.recipe_folder, ROOT)
        for pattern in ("CMakeLists.txt", "LICENSE", "include/*", "shaders/*", "src/*"):
            copy(self, pattern, root, self.export_sources_folder)

    def configure(self):
        self.settings.rm_safe("compiler.cppstd")  # the libraries are C
        self.settings.rm_safe("compiler.libcxx")

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["HNBRDF_BUILD_FIT"] = bool(self.options.fit)
        for part in ("BUILD_CLI", "BUILD_TESTS", "BUILD_EXAMPLES", "WITH_HDF5", "WITH_OPENEXR",
                     "WITH_VULKAN", "WITH_EMBREE"):
            toolchain.cache_variables["HNBRDF_" + part] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        for folder in (("lib", "cmake"), ("lib", "pkgconfig"), ("share", "doc")):
            rmdir(self, os.path.join(self.package_folder, *folder))  # Conan makes its own

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "hnbrdf")
        parts = {"hnbrdf": []}
        if self.options.fit:
            parts.update(measured=["hnbrdf"], metrics=["measured"], fit=["measured"],
                         bake=["fit", "metrics"])
        for part, needs in parts.items():
            library = part if part == "hnbrdf" else "hnbrdf_" + part
            info = self.cpp_info.components[part]
            info.libs = [library]
            info.requires = needs
            info.set_property("cmake_target_name", "hnbrdf::" + part)
            info.set_property("pkg_config_name", library)
            if not self.options.shared:
                info.defines = ["HNBRDF_STATIC"]
            if self.settings.os in ("Linux", "FreeBSD"):
                info.system_libs = ["m"] + (["pthread"] if part in ("fit", "bake") else [])
