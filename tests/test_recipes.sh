#!/bin/sh
# test_recipes.sh SOURCE BUILD SCRATCH VERSION: the recipes of examples/packaging as far as they go without vcpkg,
# Conan and a network: the port runs with stand-ins for vcpkg's functions and configures this project with options
# that it has; the recipe runs with stand-ins for Conan's modules; versions are ours; the pkg-config sample builds
# and runs. Without python3 its parts are left out.
set -eu
source=$1 build=$2 scratch=$3 version=$4
recipes=$source/examples/packaging
unset CFLAGS LDFLAGS LD_LIBRARY_PATH PKG_CONFIG_PATH || true

fail() {
    echo "test_recipes: $*" >&2
    exit 1
}
rm -rf "$scratch"
mkdir -p "$scratch/conan/tools" "$scratch/packages/lib/cmake/hnbrdf"

# The port, as vcpkg would run it.
cat > "$scratch/vcpkg.cmake" << 'CMAKE'
cmake_minimum_required(VERSION 3.25)
function(vcpkg_check_features)
  cmake_parse_arguments(CHECK "" "OUT_FEATURE_OPTIONS" "FEATURES" ${ARGN})
  set(options "")
  while(CHECK_FEATURES)
    list(POP_FRONT CHECK_FEATURES feature option)
    file(APPEND ${CMAKE_CURRENT_BINARY_DIR}/features "${feature}\n")
    set(value OFF)
    if(feature IN_LIST FEATURES)
      set(value ON)
    endif()
    list(APPEND options -D${option}=${value})
  endwhile()
  set(${CHECK_OUT_FEATURE_OPTIONS} ${options} PARENT_SCOPE)
endfunction()
function(vcpkg_cmake_configure)
  cmake_parse_arguments(CONFIGURE "" "SOURCE_PATH" "OPTIONS" ${ARGN})
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${CONFIGURE_SOURCE_PATH} -B ${BUILT}
    ${CONFIGURE_OPTIONS} RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(failed OR text MATCHES "not used by the project")
    message(FATAL_ERROR "${text}")
  endif()
endfunction()
function(vcpkg_cmake_config_fixup)
  cmake_parse_arguments(FIXUP "" "CONFIG_PATH" "" ${ARGN})
  file(READ ${BUILT}/cmake_install.cmake text)
  if(NOT text MATCHES "${FIXUP_CONFIG_PATH}/hnbrdfConfig.cmake|${FIXUP_CONFIG_PATH}\"")
    message(FATAL_ERROR "nothing is installed to ${FIXUP_CONFIG_PATH}")
  endif()
endfunction()
function(vcpkg_install_copyright)
  cmake_parse_arguments(COPYRIGHT "" "" "FILE_LIST" ${ARGN})
  foreach(file ${COPYRIGHT_FILE_LIST})
    file(READ "${file}" text)
  endforeach()
endfunction()
function(vcpkg_cmake_install)
endfunction()
function(vcpkg_fixup_pkgconfig)
endfunction()
function(vcpkg_copy_tools)
endfunction()
set(PORT hnbrdf)
include(${PORTFILE})
CMAKE
(cd "$scratch" && cmake -DPORTFILE="$recipes/vcpkg/hnbrdf/portfile.cmake" -DFEATURES=fit -DBUILT="$scratch/built" \
    -DCURRENT_PACKAGES_DIR="$scratch/packages" -P vcpkg.cmake) > "$scratch/log" 2>&1 || {
    cat "$scratch/log" >&2
    fail "the vcpkg port"
}
grep -q 'HNBRDF_BUILD_FIT:BOOL=ON' "$scratch/built/CMakeCache.txt" || fail "the port's features do not arrive"
grep -q 'HNBRDF_BUILD_CLI:BOOL=OFF' "$scratch/built/CMakeCache.txt" || fail "the port builds the command unasked"
[ -s "$scratch/packages/share/hnbrdf/usage" ] || fail "the port installs no usage"
echo "vcpkg: configures, $(wc -l < "$scratch/features") features"

if command -v python3 > /dev/null; then
    for module in conan/__init__ conan/tools/__init__ conan/tools/cmake conan/tools/files; do
        echo 'class ConanFile: pass
def __getattr__(name): return type(name, (), {})' > "$scratch/$module.py"
    done
    PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$scratch python3 - "$recipes" "$version" "$scratch/features" \
        "$scratch/built/CMakeCache.txt" "$source/src/parts.cmake" > "$scratch/log" 2>&1 << 'PYTHON' || {
import ast, importlib.util, json, re, sys, types
recipes, version, features, cache = sys.argv[1:5]
port = json.load(open(recipes + "/vcpkg/hnbrdf/vcpkg.json"))
assert port["name"] == "hnbrdf" and port["license"] == "MIT", "name and license of vcpkg.json"
assert port["version"] == version, f"vcpkg.json: version {port['version']}, expected {version}"
asked = open(features).read().split()
assert sorted(asked) == sorted(port["features"]), f"features: {asked} in portfile.cmake, {list(port['features'])}"
assert set(port["default-features"]) <= set(port["features"]), "default-features"
for name, feature in port["features"].items():
    assert re.fullmatch("[a-z0-9-]+", name) and feature["description"], f"feature {name}"
spec = importlib.util.spec_from_file_location("conanfile", recipes + "/conan/conanfile.py")
module = importlib.util.module_from_spec(spec)
spec.loader.exec_module(module)
recipe = module.HnbrdfConan
assert recipe.version == version, f"conanfile.py: version {recipe.version}, expected {version}"
for option, default in recipe.default_options.items():
    assert default in recipe.options[option], option
# What it sets is an option of ours.
known = set(re.findall(r"^(HNBRDF_[A-Z0-9_]+):", open(cache).read(), re.M))
values = {}
class Toolchain:
    def __init__(self, recipe): self.cache_variables = values
    def generate(self): pass
module.CMakeToolchain = Toolchain
made = recipe()
made.options = types.SimpleNamespace(shared=True, fit=True)
made.settings = types.SimpleNamespace(os="Linux")
made.generate()
assert values and set(values) <= known, f"unknown options {set(values) - known}"
# Parts and what they need, as here.
class Component(types.SimpleNamespace):
    def set_property(self, name, value): self.properties = {**getattr(self, "properties", {}), name: value}
class Information(Component):
    def __init__(self): self.components = __import__("collections").defaultdict(Component)
made.cpp_info = Information()
made.package_info()
ours = {"hnbrdf", "measured", "metrics", "fit", "bake"}
assert set(made.cpp_info.components) == ours, "components"
for name, part in made.cpp_info.components.items():
    assert set(part.requires) <= ours and part.properties["cmake_target_name"] == "hnbrdf::" + name, name
print(f"vcpkg.json, conanfile.py: version {version}, {len(ours)} parts, {len(values)} options of ours")
PYTHON
        cat "$scratch/log" >&2
        fail "vcpkg.json or conanfile.py"
    }
    cat "$scratch/log"
else
    echo "vcpkg.json, conanfile.py: left out, no python3"
fi

if command -v pkg-config > /dev/null && command -v make > /dev/null; then
    cmake --install "$build" --component development --prefix "$scratch/prefix" > "$scratch/log" || fail "installing"
    mkdir -p "$scratch/a/b"
    cp -r "$recipes/pkg-config" "$scratch/a/b/pkg-config"
    cp "$source/examples/eval.c" "$scratch/a/eval.c"
    PKG_CONFIG_PATH=$(dirname "$(find "$scratch/prefix" -name hnbrdf.pc)") \
        make -C "$scratch/a/b/pkg-config" STATIC=--static > "$scratch/log" 2>&1 || {
        cat "$scratch/log" >&2
        fail "the pkg-config sample"
    }
    "$scratch/a/b/pkg-config/eval" "$source/examples/models/rgl_32x2.safetensors" vch_silk_blue > "$scratch/log" ||
        fail "the pkg-config sample does not run"
    echo "pkg-config: $(wc -l < "$scratch/log") lines"
fi
rm -rf "$scratch"
